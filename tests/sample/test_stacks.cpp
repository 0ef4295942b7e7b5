// Stacks of slices as samples: every kind of file gives the same grains, on any number of ranks.
#include <gtest/gtest.h>

#include <span>

#include "poreshock/files/array_file.hpp"
#include "poreshock/files/hdf5_file.hpp"
#include "stack_scenes.hpp"

namespace poreshock {
namespace {

using namespace testing;

void expect_labels(const std::string& file) {
  EXPECT_EQ(grains_at_sites(stack_scene(file, labels.size)), labelled) << file;
}

/// The labels as numbers that need 16 bits.
Voxels wide_labels() {
  Voxels wide = labels;
  for (int& v : wide.value) v *= 300;
  return wide;
}

TEST(Stacks, FoldersOfSlices) {
  for (const std::string ending : {".png", ".pgm", ".tif"}) {
    const std::string folder = place("folder" + ending);
    once([&] {
      write_slices(folder, labels, ending);
      write_bytes(folder + "/notes.txt", "nothing");
    });
    expect_labels(folder);
  }
  for (const std::string ending : {".png", ".tif"}) {
    const std::string folder = place("wide" + ending);
    once([&] { write_slices(folder, wide_labels(), ending, 0, 16); });
    expect_labels(folder);
  }
}

TEST(Stacks, PagesOfATiffFile) {
  const std::vector<TiffKind> kinds = {
      {},
      {.compression = COMPRESSION_ADOBE_DEFLATE},
      {.compression = COMPRESSION_LZW, .tile = 16},
      {.bits = 32},
      {.bits = 16, .format = SAMPLEFORMAT_INT},
      {.bits = 32, .format = SAMPLEFORMAT_IEEEFP},
      {.meaning = PHOTOMETRIC_RGB, .samples = 3},
      {.bits = 16, .meaning = PHOTOMETRIC_RGB, .samples = 3, .tile = 16}};
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const std::string file = place("pages" + std::to_string(i) + ".tif");
    once([&] { write_tiff(file, labels, kinds[i]); });
    expect_labels(file);
  }
  const std::string file = place("big.tiff");
  once([&] { write_tiff(file, wide_labels(), {.bits = 16, .tile = 32}, true); });
  expect_labels(file);
}

// Rows of a mask begin with a byte of their own; its values are 0 and 1, labels or grey.
TEST(Stacks, MasksOfOneBit) {
  Voxels mask{{11, 3, 4}, {}};
  for (int i = 0; i < 11 * 3 * 4; ++i) mask.value.push_back(i % 3 == 0 || i % 7 == 0 ? 1 : 0);
  const std::string plain = place("mask8.tif");
  once([&] { write_tiff(plain, mask); });
  const std::vector<int> expected = grains_at_sites(stack_scene(plain, mask.size));
  for (const TiffKind& kind : {TiffKind{.bits = 1},
                               {.bits = 1, .compression = COMPRESSION_CCITTFAX4},
                               {.bits = 1, .tile = 16}}) {
    const std::string file = place("mask.tif");
    once([&] { write_tiff(file, mask, kind); });
    Scene scene = stack_scene(file, mask.size);
    EXPECT_EQ(grains_at_sites(scene), expected);
    scene.sample.threshold = 0.5;
    SampleReport report;
    grains_at_sites(scene, &report);
    EXPECT_EQ(report.particles, std::count(mask.value.begin(), mask.value.end(), 1));
  }
}

// Colours are their luminance where grey values are wanted: (299 + 2 * 587 + 3 * 114)/1000 = 1.815.
TEST(Stacks, ColouredPagesHaveLuminances) {
  const std::string file = place("colour.tif");
  once([&] { write_tiff(file, labels, {.meaning = PHOTOMETRIC_RGB, .samples = 3}); });
  Scene scene = stack_scene(file, labels.size);
  scene.sample.threshold = 5.0;
  SampleReport report;
  grains_at_sites(scene, &report);
  std::int64_t solid = 0;
  for (const int v : labels.value) solid += 1815 * v / 1000 >= 5 ? 1 : 0;
  EXPECT_GT(solid, 0);
  EXPECT_EQ(report.particles, solid);
}

// Where white is the lowest number its negative counts, as the picture looks.
TEST(Stacks, WhiteIsLightInTiff) {
  const std::string file = place("white.tif");
  once([&] { write_tiff(file, labels, {.meaning = PHOTOMETRIC_MINISWHITE}); });
  expect_labels(file);
  Scene scene = stack_scene(file, labels.size);
  scene.sample.threshold = 247.0;  // 255 - 7 = 248
  scene.sample.regions = Regions::matrix;
  const std::vector<int> grains = grains_at_sites(scene);
  SampleReport report;
  grains_at_sites(scene, &report);
  std::int64_t solid = 0;
  for (const int v : labels.value) solid += 255 - v >= 247 ? 1 : 0;
  EXPECT_EQ(report.particles, solid);
}

TEST(Stacks, MetaImages) {
  const std::string bytes = all_bytes(labels.value, 8);
  const std::string wide = all_bytes(wide_labels().value, 16, true);
  once([&] {
    write_bytes(place("data.raw"), bytes);
    write_bytes(place("skipped.raw"), "head" + all_bytes(labels.value, 16));
    write_bytes(place("a.mhd"), meta_header(labels, "MET_UCHAR", "", "data.raw"));
    write_bytes(place("b.mhd"),
                meta_header(labels, "MET_USHORT", "HeaderSize = 4\n", "skipped.raw"));
    write_bytes(place("c.mhd"),
                meta_header(labels, "MET_SHORT", "HeaderSize = -1\n", "skipped.raw"));
    write_bytes(
        place("d.mha"),
        meta_header(labels, "MET_USHORT", "BinaryDataByteOrderMSB = True\n", "LOCAL") + wide);
    write_bytes(place("e.mha"),
                meta_header(labels, "MET_FLOAT", "", "LOCAL") + float_bytes(labels.value));
  });
  for (const char* name : {"a.mhd", "b.mhd", "c.mhd", "d.mha", "e.mha"}) expect_labels(place(name));
}

// Headers of both kinds may say that the numbers are compressed, beside them or after them.
TEST(Stacks, CompressedNumbers) {
  const std::string bytes = all_bytes(labels.value, 8);
  const std::string wide = all_bytes(wide_labels().value, 16, true);
  const std::size_t half = bytes.size() / 2;
  once([&] {
    write_bytes(place("z.zraw"), compressed(bytes, false));
    write_bytes(place("a.mhd"),
                meta_header(labels, "MET_UCHAR", "CompressedData = True\n", "z.zraw"));
    write_bytes(place("b.mha"),
                meta_header(labels, "MET_USHORT",
                            "CompressedData = True\nBinaryDataByteOrderMSB = True\n", "LOCAL") +
                    compressed(wide, false));
    write_bytes(place("c.nrrd"), nrrd_header(labels, "uchar", "", "gzip") + compressed(bytes));
    write_bytes(place("n.raw.gz"), compressed("head" + bytes));
    write_bytes(place("d.nhdr"),
                nrrd_header(labels, "uint8", "data file: n.raw.gz\nbyte skip: 4\n", "gz"));
    // gzip files written one after the other are one.
    write_bytes(place("e.nrrd"), nrrd_header(labels, "uchar", "", "gzip") +
                                     compressed(bytes.substr(0, half)) +
                                     compressed(bytes.substr(half)));
  });
  for (const char* name : {"a.mhd", "b.mha", "c.nrrd", "d.nhdr", "e.nrrd"})
    expect_labels(place(name));
}

// More than is worked on at once, read in any order.
TEST(Stacks, CompressedNumbersOfAnyPlace) {
  StoredArray array;
  array.file = place("long.gz");
  array.shape = {1000, 700};
  array.number = "u2";
  array.data_begin = 6;
  std::string bytes = "before";
  for (int i = 0; i < 700000; ++i) bytes += number_bytes(i % 65521, 16);
  once([&] { write_bytes(array.file, "header" + compressed(bytes)); });
  array.inflated = std::make_shared<InflatedFile>(array.file, 6);
  require_numbers(array, "row");
  for (const std::uint64_t first : {300U, 301U, 990U, 0U, 17U}) {
    const std::vector<double> rows = read_rows(array, first, 10, world);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      ASSERT_EQ(rows[i], static_cast<double>((700 * first + i) % 65521)) << first << " " << i;
    }
  }
  MPI_Barrier(world);
}

TEST(Stacks, NrrdFiles) {
  const std::string bytes = all_bytes(labels.value, 8);
  once([&] {
    write_bytes(place("n.raw"), bytes);
    write_bytes(place("a.nrrd"), nrrd_header(labels, "uchar", "") + bytes);
    write_bytes(place("b.nrrd"), nrrd_header(labels, "unsigned short", "endian: big\n") +
                                     all_bytes(wide_labels().value, 16, true));
    write_bytes(place("c.nhdr"), nrrd_header(labels, "uint8", "data file: n.raw\n"));
    write_bytes(place("d.nrrd"), nrrd_header(labels, "int", "byte skip: -1\n") + "between" +
                                     all_bytes(labels.value, 32));
  });
  for (const char* name : {"a.nrrd", "b.nrrd", "c.nhdr", "d.nrrd"}) expect_labels(place(name));
}

TEST(Stacks, ArraysAndRawNumbers) {
  once([&] {
    write_bytes(place("a.npy"), npy_bytes(labels, "|u1", all_bytes(labels.value, 8)));
    write_bytes(place("b.npy"), npy_bytes(labels, "<u2", all_bytes(wide_labels().value, 16)));
    write_bytes(place("c.npy"), npy_bytes(labels, "<f4", float_bytes(labels.value)));
    write_bytes(place("numbers.raw"), "skip it" + all_bytes(wide_labels().value, 16, true));
  });
  for (const char* name : {"a.npy", "b.npy", "c.npy"}) expect_labels(place(name));
  Scene scene = stack_scene(place("numbers.raw"), labels.size);
  scene.sample.raw_size = {4.0, 3.0, 5.0};
  scene.sample.raw_type = "uint16";
  scene.sample.raw_big_endian = true;
  scene.sample.raw_skip = 7;
  EXPECT_EQ(grains_at_sites(scene), labelled);

  const std::string h5 = place("volume.h5");
  FileSpec spec;
  spec.datasets = {{.path = "/scan/labels",
                    .type = NumberType::uint8,
                    .shape = {5, 3, 4},
                    .unit = "1",
                    .attributes = {}}};
  Hdf5File file = Hdf5File::create(h5, spec, world, Replace::yes);
  std::vector<std::uint8_t> numbers(labels.value.begin(), labels.value.end());
  if (rank(world) > 0) numbers.clear();
  file.write<std::uint8_t>("/scan/labels", 0, std::span<const std::uint8_t>(numbers));
  file.finish();
  expect_labels(h5 + ":/scan/labels");
}

// Pictures in two dimensions may be TIFF files and arrays too, the last row lowest.
TEST(Stacks, FlatImagesOfTheNewKinds) {
  if (size(world) > 1) return;
  const std::vector<int> picture = {7, 7, 0, 7, 0, 0, 0, 9, 7, 9, 9, 9};
  const Voxels flat{{4, 3, 1}, picture};
  std::string npy = npy_bytes(flat, "|u1", all_bytes(picture, 8));
  npy.replace(npy.find("(1, 3, 4)"), 9, "(3, 4)   ");
  Voxels two = flat;
  two.size[2] = 2;
  two.value.insert(two.value.end(), picture.begin(), picture.end());
  for (const std::string& file : {write_tiff("flat.tif", flat), write_bytes("flat.npy", npy)}) {
    Scene scene = grain_scene(SampleKind::image, 0.0);
    scene.domain.cell = scene.sample.pixel = edge;
    scene.sample.particles_per_cell = 1;
    scene.domain.cells = {4, 5, 0};
    scene.domain.size = {4.0 * edge, 5.0 * edge, 0.0};
    scene.sample.height = 3.0 * edge;
    scene.sample.image = file;
    const Filled<2> made = filled<2>(scene);
    std::vector<int> grains(12, 0);
    for (std::size_t p = 0; p < made.particles.size(); ++p) {
      grains[static_cast<std::size_t>(made.particles.id[p])] = made.particles.grain[p];
    }
    EXPECT_EQ(grains, (std::vector<int>{1, 2, 2, 2, 0, 0, 0, 2, 3, 3, 0, 3})) << file;
    scene.sample.image = write_tiff("two.tif", two);
    expect_words(error_of(scene), {"two.tif: has 2 pages, where one is allowed"});
  }
}

}  // namespace
}  // namespace poreshock
