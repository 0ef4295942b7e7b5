// Images and arrays with any damage: each is refused with a message that names it, or is read.
#include <gtest/gtest.h>

#include "fuzz/case_watch.hpp"
#include "fuzz/mutate.hpp"
#include "output/support.hpp"
#include "poreshock/core/error.hpp"
#include "poreshock/files/array_file.hpp"
#include "poreshock/image/image.hpp"
#include "poreshock/image/stack.hpp"
#include "sample/filled.hpp"
#include "sample/stack_files.hpp"

namespace poreshock {
namespace {

using namespace testing;

constexpr int columns = 24, rows = 17;

/// Samples of three grains in a void, `channels` of each pixel, up to `most`.
std::vector<int> picture(int channels, int most) {
  std::vector<int> samples;
  for (int p = 0; p < columns * rows; ++p) {
    const int grain = (p % columns) / 8 + 1;
    const bool solid = p / columns % 8 > 1 && p % 8 > 1;
    for (int c = 0; c < channels; ++c) samples.push_back(solid ? most * grain / 3 : 0);
  }
  return samples;
}

/// The bytes of images of every kind.
std::vector<std::string> images() {
  const std::vector<png_color> palette = {{90, 180, 240}, {200, 10, 10}, {0, 0, 0}, {9, 99, 9}};
  const std::vector<PngKind> kinds = {
      {.bits = 1},
      {.bits = 8, .interlaced = true},
      {.bits = 16},
      {.bits = 2, .colour_type = PNG_COLOR_TYPE_PALETTE, .palette = palette},
      {.colour_type = PNG_COLOR_TYPE_PALETTE, .palette = palette, .opacity = {0, 255, 7}},
      {.colour_type = PNG_COLOR_TYPE_GRAY_ALPHA},
      {.colour_type = PNG_COLOR_TYPE_RGB},
      {.bits = 16, .colour_type = PNG_COLOR_TYPE_RGB_ALPHA, .interlaced = true}};
  std::vector<std::string> all;
  for (const PngKind& kind : kinds) {
    const int most = kind.palette.empty() ? (1 << kind.bits) - 1 : 3;
    all.push_back(
        read_bytes(write_png("image.fuzz", columns, rows, picture(channels_of(kind), most), kind)));
  }
  for (const TiffKind& kind : {TiffKind{}, TiffKind{.compression = COMPRESSION_ADOBE_DEFLATE},
                               TiffKind{.bits = 16, .compression = COMPRESSION_LZW, .tile = 16}}) {
    const Voxels flat{{columns, rows, 1}, picture(1, 255)};
    all.push_back(read_bytes(write_tiff("image.fuzz.tif", flat, kind)));
  }
  all.push_back(read_bytes(write_pgm("image.fuzz", columns, rows, picture(1, 255))));
  all.push_back(read_bytes(write_text_pgm("image.fuzz", columns, rows, picture(1, 255))));
  return all;
}

bool is_png(const std::string& bytes) {
  return bytes.size() > 8 && bytes[1] == 'P';
}

std::uint32_t number_at(const std::string& bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t b = 0; b < 4; ++b) {
    number = number * 256 + static_cast<unsigned char>(bytes[at + b]);
  }
  return number;
}

std::uint32_t check_sum(const std::string& bytes, std::size_t begin, std::size_t count) {
  std::uint32_t crc = ~std::uint32_t{0};
  for (std::size_t i = begin; i < begin + count; ++i) {
    crc ^= static_cast<unsigned char>(bytes[i]);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xedb88320U : 0U);
  }
  return ~crc;
}

/// Makes the check sums of all whole chunks right, so that damage gets past them.
void seal_chunks(std::string& bytes) {
  std::size_t at = 8;
  while (at + 12 <= bytes.size()) {
    const std::size_t length = number_at(bytes, at);
    if (length > bytes.size() - at - 12) return;
    const std::uint32_t crc = check_sum(bytes, at + 4, length + 4);
    for (std::size_t b = 0; b < 4; ++b) {
      bytes[at + 8 + length + b] = static_cast<char>(crc >> (24 - 8 * b));
    }
    at += length + 12;
  }
}

/// One to three changes, some of them in the header, where they do most.
std::string damaged_image(test::Mutator& mutator, std::string bytes) {
  const bool png = is_png(bytes);
  const std::size_t changes = 1 + mutator.below(3);
  for (std::size_t i = 0; i < changes && !bytes.empty(); ++i) {
    if (mutator.below(3) > 0) {
      mutator.file(bytes);
    } else if (png) {
      const std::size_t at = 16 + mutator.below(60);
      if (at < bytes.size()) bytes[at] = static_cast<char>(mutator.below(256));
    } else {
      mutator.beginning(bytes, std::min<std::size_t>(bytes.size(), 32));
    }
  }
  if (png && mutator.below(4) > 0) seal_chunks(bytes);
  return bytes;
}

/// The sample of a small image, as large as the image says.
void make_sample(const Image& image, const std::string& path, bool grey) {
  if (image.columns * image.rows > 4096) return;
  Scene scene = grain_scene(SampleKind::image, 0.0);
  scene.domain.cell = scene.sample.pixel = 10e-6;
  scene.domain.cells = {static_cast<int>(image.columns), static_cast<int>(image.rows) + 4, 0};
  for (int axis = 0; axis < 2; ++axis) scene.domain.size[axis] = scene.domain.cells[axis] * 10e-6;
  scene.sample.height = static_cast<double>(image.rows) * 10e-6;
  scene.sample.image = path;
  if (grey) scene.sample.threshold = 100.0;
  const std::string text = error_of(scene);
  EXPECT_TRUE(text.empty() || text.find(path) != std::string::npos) << text;
}

TEST(Fuzz, ImagesAreRefusedWithAReasonOrRead) {
  const std::vector<std::string> originals = images();
  const test::CaseWatch watch;
  const std::uint64_t count = test::fuzz_count("PORESHOCK_FUZZ_IMAGES", 400);
  std::uint64_t refused = 0, read = 0;
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    test::Mutator mutator(seed);
    const std::string bytes = damaged_image(mutator, mutator.pick(originals));
    const std::string path = write_bytes("image.fuzz", bytes);
    watch.begin(seed);
    for (const bool grey : {false, true}) {
      try {
        const Image image = read_image(path, grey);
        ASSERT_EQ(image.value.size(), static_cast<std::size_t>(image.columns * image.rows)) << seed;
        make_sample(image, path, grey);
        ++read;
      } catch (const InputError& error) {
        ASSERT_NE(std::string(error.what()).find("sample.image: " + path + ": "), std::string::npos)
            << "case " << seed << ": " << error.what();
        ++refused;
      } catch (const std::exception& error) {
        FAIL() << "case " << seed << ", another exception: " << error.what();
      }
    }
    watch.end();
  }
  std::printf("%llu mutated images, each read twice: %llu times refused, %llu read\n",
              static_cast<unsigned long long>(count), static_cast<unsigned long long>(refused),
              static_cast<unsigned long long>(read));
  EXPECT_GT(refused, count / 4);
  EXPECT_GT(read, count / 10);
}

/// Stacks in files of every kind that has a header, by the ending of their names.
std::vector<std::pair<std::string, std::string>> stacks() {
  const Voxels voxels{{4, 3, 5}, std::vector<int>(60, 3)};
  const std::string bytes = all_bytes(voxels.value, 8);
  return {{".mha", meta_header(voxels, "MET_UCHAR", "HeaderSize = -1\n", "LOCAL") + bytes},
          {".mhd", meta_header(voxels, "MET_UCHAR", "", "stack.fuzz.mhd")},
          {".nrrd", nrrd_header(voxels, "uchar", "byte skip: -1\nendian: little\n") + bytes},
          {".nrrd", nrrd_header(voxels, "uchar", "", "gzip") + compressed(bytes)},
          {".tif", read_bytes(write_tiff("stack.fuzz.tif", voxels))},
          {".npy", npy_bytes(voxels, "|u1", bytes)}};
}

TEST(Fuzz, StacksAreRefusedWithAReasonOrRead) {
  const auto originals = stacks();
  const test::CaseWatch watch;
  const std::uint64_t count = test::fuzz_count("PORESHOCK_FUZZ_IMAGES", 400);
  std::uint64_t refused = 0, read = 0;
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    test::Mutator mutator(seed);
    const auto& [ending, original] = originals[mutator.below(originals.size())];
    std::string bytes = original;
    mutator.below(2) == 0 ? mutator.file(bytes) : mutator.beginning(bytes, bytes.size());
    const std::string path = write_bytes("stack.fuzz" + ending, bytes);
    watch.begin(seed);
    std::vector<std::string> problems;
    try {
      const Stack stack = find_stack(path, 3, false, {}, MPI_COMM_SELF);
      if (stack.layers() * stack.layer_size() < 100000) {
        read_layers(stack, 0, stack.layers(), MPI_COMM_SELF, problems);
      }
      problems.empty() ? ++read : ++refused;
    } catch (const InputError& error) {
      ASSERT_EQ(std::string(error.what()).find("sample.image: "), 0U)
          << "case " << seed << ": " << error.what();
      ++refused;
    } catch (const std::exception& error) {
      FAIL() << "case " << seed << ", another exception: " << error.what();
    }
    watch.end();
  }
  EXPECT_GT(refused, count / 4);
  EXPECT_GT(read, count / 10);
}

/// An array as numpy.save writes it.
std::string array_bytes() {
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (3, 4), }";
  header.resize(117, ' ');
  header += '\n';
  return std::string("\x93NUMPY\x01\0", 8) + static_cast<char>(header.size()) + '\0' + header +
         std::string(48, '\x3f');
}

TEST(Fuzz, ArraysAreRefusedWithAReasonOrRead) {
  const std::string path = "array.fuzz.npy";
  const test::CaseWatch watch;
  const std::uint64_t count = test::fuzz_count("PORESHOCK_FUZZ_IMAGES", 400);
  std::uint64_t refused = 0, read = 0;
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    test::Mutator mutator(seed);
    std::string bytes = array_bytes();
    mutator.below(2) == 0 ? mutator.file(bytes) : mutator.beginning(bytes, 128);
    write_bytes(path, bytes);
    watch.begin(seed);
    try {
      const StoredArray array = find_array(path, MPI_COMM_SELF);
      if (!array.shape.empty()) read_rows(array, 0, array.shape[0], MPI_COMM_SELF);
      ++read;
    } catch (const InputError& error) {
      ASSERT_EQ(std::string(error.what()).find(path + ": "), 0U)
          << "case " << seed << ": " << error.what();
      ++refused;
    } catch (const std::exception& error) {
      FAIL() << "case " << seed << ", another exception: " << error.what();
    }
    watch.end();
  }
  EXPECT_GT(refused, count / 4);
  EXPECT_GT(read, count / 10);
}

}  // namespace
}  // namespace poreshock
