// Stacks that are damaged or do not fit: all that is wrong is said at once, with the slice.
#include <gtest/gtest.h>

#include <algorithm>

#include "stack_scenes.hpp"

namespace poreshock {
namespace {

using namespace testing;

TEST(StackErrors, SlicesThatAreMissingOrOddAreAllNamed) {
  const std::string folder = place("damaged");
  Voxels voxels = balls({4, 3, 24}, 3.0);
  for (int& v : voxels.value) v %= 250;
  once([&] {
    write_slices(folder, voxels, ".png", 1);
    std::filesystem::remove(folder + "/scan2_7.png");
    std::filesystem::remove(folder + "/scan2_12.png");
    std::filesystem::remove(folder + "/scan2_13.png");
    write_png(folder + "/scan2_3.png", 5, 3, std::vector<int>(15, 1), 8);
    write_png(folder + "/scan2_20.png", 4, 3, std::vector<int>(12, 1), 16);
    const std::string bytes = read_bytes(folder + "/scan2_9.png");
    write_bytes(folder + "/scan2_9.png", bytes.substr(0, bytes.size() / 2));
    write_png(folder + "/scan2_010.png", 4, 3, std::vector<int>(12, 1), 8);
    write_png(folder + "/preview.png", 4, 3, std::vector<int>(12, 1), 8);
  });
  Scene scene = stack_scene(folder, {4, 3, 24});
  scene.domain.size[0] = 5.0 * edge;
  const std::string text = refusal(scene);
  expect_words(text,
               {"slice 7 is missing between scan2_6.png and scan2_8.png",
                "slices 12 to 13 are missing between scan2_11.png and scan2_14.png",
                "slice 10 is there twice, scan2_010.png and scan2_10.png",
                "preview.png does not belong to scan2_....png", "has 4 columns of sample.pixel",
                "scan2_3.png: slice 4 of 23 has 5 x 3 pixels of 8 bits, allowed are 4 x 3 "
                "pixels of 8 bits as in the first",
                "scan2_20.png: slice 19 of 23 has 4 x 3 pixels of 16 bits",
                "scan2_9.png: slice 9 of 23 is a damaged PNG file", "ends too early"});
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 7) << text;
  std::filesystem::create_directories(place("empty"));
  expect_words(refusal(stack_scene(place("empty"), {4, 3, 5})), {"empty: has no slice in it"});
  expect_words(refusal(stack_scene(place("absent"), {4, 3, 5})), {"absent: is no stack of slices"});
}

TEST(StackErrors, PagesThatAreMissingOrOddAreNamed) {
  const std::string file = place("odd.tif");
  once([&] {
    write_tiff(file, labels);
    write_page(file, "a", 4, 4, std::vector<int>(16, 1), {});
    write_page(file, "a", 4, 3, std::vector<int>(12, 1), {.bits = 16});
    write_page(file, "a", 4, 3, std::vector<int>(12, 1), {});
  });
  expect_words(refusal(stack_scene(file, {4, 3, 8})),
               {"odd.tif: page 6 of 8 has 4 x 4 pixels of 8 bits, allowed are 4 x 3",
                "odd.tif: page 7 of 8 has 4 x 3 pixels of 16 bits"});
  const std::string cut = place("cut.tif");
  once([&] {
    const std::string bytes = read_bytes(write_tiff(place("whole.tif"), labels));
    write_bytes(cut, bytes.substr(0, bytes.size() * 3 / 5));
  });
  expect_words(refusal(stack_scene(cut, labels.size)),
               {"cut.tif: is a damaged TIFF file: page 4 cannot be found"});
  const std::string hidden = place("hidden.tif");
  once([&] {
    write_page(hidden, "w", 4, 3, std::vector<int>(12, 1),
               {.description = "ImageJ=1.53t\nimages=5\nslices=5\n"});
  });
  expect_words(refusal(stack_scene(hidden, labels.size)), {"stack of ImageJ"});
}

TEST(StackErrors, BadHeadersAreNamed) {
  const std::string bytes = all_bytes(labels.value, 8);
  const auto refused = [&](const std::string& name, const std::string& content,
                           const std::vector<std::string>& words) {
    const std::string file = place(name);
    once([&] { write_bytes(file, content); });
    const std::string text = refusal(stack_scene(file, labels.size));
    expect_words(text, words);
    EXPECT_EQ(text.find("sample.image: " + place("")), 0U) << text;
    MPI_Barrier(world);
  };
  refused("type.mhd", meta_header(labels, "MET_LONG_DOUBLE", "BinaryData = False\n", "data.raw"),
          {"ElementType = MET_LONG_DOUBLE, allowed is one of MET_", "BinaryData = False"});
  refused("flat.mhd", "NDims = 2\nDimSize = 4 3\nElementType = MET_UCHAR\n",
          {"NDims = 2, allowed is 3", "DimSize = 4 3, allowed is 3 whole numbers",
           "no ElementDataFile"});
  refused("edges.mha", meta_header(labels, "MET_UCHAR", "", "LOCAL").replace(54, 3, "0.7") + bytes,
          {"ElementSpacing", "equal edges"});
  refused("short.mha", meta_header(labels, "MET_UCHAR", "", "LOCAL") + bytes.substr(0, 40),
          {"it ends in slice 4 of 5", "5 x 3 x 4 numbers of 1 bytes"});
  refused("long.nrrd", nrrd_header(labels, "uchar", "") + bytes + "more",
          {"4 more than its numbers need"});
  refused("text.nrrd", "NRRD0005\ntype: uchar\ndimension: 3\nsizes: 4 3 x\nencoding: ascii\n\n",
          {"encoding = ascii, allowed is raw or gzip", "sizes = 4 3 x"});
  refused("odd.nrrd", "nothing", {"does not begin with NRRD000"});
  refused("lost.nhdr", nrrd_header(labels, "uchar", "data file: nowhere.raw\n"), {"nowhere.raw"});
  refused("cut.npy", npy_bytes(labels, "|u1", bytes.substr(0, 59)), {"it ends in slice 5 of 5"});
  refused("half.npy", npy_bytes(labels, "<f4", std::string(240, '\x3f')),
          {"slice 1 has the value 0.7", "labels are whole numbers", "sample.threshold"});
  const Voxels other{{4, 3, 4}, std::vector<int>(48, 1)};
  refused("other.npy", npy_bytes(other, "|u1", all_bytes(other.value, 8)),
          {"has 4 slices of sample.pixel = 2e-05 m", "sample.height is 0.0001 m"});
}

TEST(StackErrors, CompressedNumbersThatAreDamagedAreNamed) {
  const std::string bytes = all_bytes(labels.value, 8);
  const auto refused = [&](const std::string& content, const std::vector<std::string>& words) {
    const std::string file = place("packed.nrrd");
    once([&] { write_bytes(file, content); });
    expect_words(refusal(stack_scene(file, labels.size)), words);
    MPI_Barrier(world);
  };
  const std::string header = nrrd_header(labels, "uchar", "", "gzip");
  const std::string whole = compressed(bytes);
  refused(header + compressed(bytes.substr(0, 40)), {"it ends in slice 4 of 5", "has 40 bytes"});
  refused(header + whole.substr(0, whole.size() / 2),
          {"it ends in slice", "the compressed bytes end too early"});
  refused(header + bytes,
          {"it ends in slice 1 of 5", "the compressed bytes are damaged: incorrect header check"});
  refused(header + compressed(bytes + "more"), {"more than its numbers need"});
  std::string wrong_sum = whole;
  wrong_sum[whole.size() - 6] = static_cast<char>(wrong_sum[whole.size() - 6] ^ 1);
  refused(header + wrong_sum, {"the compressed bytes are damaged: incorrect data check"});
  refused(nrrd_header(labels, "uchar", "byte skip: -1\n", "gzip") + whole,
          {"byte skip = -1, allowed is a whole number of bytes, not -1"});
}

TEST(StackErrors, RawNumbersOfAnotherSizeAreRefused) {
  const std::string file = place("size.raw");
  once([&] { write_bytes(file, all_bytes(labels.value, 8)); });
  Scene scene = stack_scene(file, labels.size);
  scene.sample.raw_size = {4.0, 3.0, 5.0};
  scene.sample.raw_type = "uint16";
  expect_words(refusal(scene), {"size.raw: has 60 bytes, it ends in slice 3 of 5"});
  scene.sample.raw_type = "uint8";
  scene.sample.raw_skip = 1;
  expect_words(refusal(scene), {"it ends in slice 5 of 5", "after byte 1"});
}

}  // namespace
}  // namespace poreshock
