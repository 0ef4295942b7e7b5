// Grains of images: what a file says, in all the ways it can, and what is said about bad ones.
#include <gtest/gtest.h>

#include <optional>

#include "filled.hpp"
#include "image_files.hpp"

namespace poreshock {
namespace {

using namespace testing;

Scene image_scene(const std::string& file, double pixel) {
  Scene scene = grain_scene(SampleKind::image, 0.0);
  scene.domain.size = {4.0 * pixel, 8.0 * pixel, 0.0};
  scene.domain.cell = 0.5 * pixel;
  scene.domain.cells = {8, 16, 0};
  scene.sample.height = 3.0 * pixel;
  scene.sample.pixel = pixel;
  scene.sample.image = file;
  return scene;
}

/// Grain number at the centre of each pixel, top row first, 0 = void.
std::vector<int> grain_picture(const Scene& scene) {
  const Filled<2> made = filled<2>(scene);
  std::vector<int> picture(12, 0);
  for (std::size_t p = 0; p < made.particles.size(); ++p) {
    const int x = static_cast<int>(made.particles.position[0][p] / scene.sample.pixel);
    const int y = static_cast<int>(made.particles.position[1][p] / scene.sample.pixel);
    picture[static_cast<std::size_t>((2 - y) * 4 + x)] = made.particles.grain[p];
  }
  EXPECT_EQ(made.particles.size() % 16, 0U);
  return picture;
}

// One grain per connected region of a label; the ends of a row meet across the periodic side.
TEST(ImageGrains, OneForEachConnectedRegion) {
  const std::vector<int> labels = {7, 7, 0, 7,  //
                                   0, 0, 0, 9,  //
                                   7, 9, 9, 9};
  const std::vector<int> periodic = {3, 3, 0, 3,  //
                                     0, 0, 0, 2,  //
                                     1, 2, 2, 2};
  const std::vector<int> open = {3, 3, 0, 4,  //
                                 0, 0, 0, 2,  //
                                 1, 2, 2, 2};
  for (const std::string& file :
       {write_pgm("labels.pgm", 4, 3, labels), write_text_pgm("t.pgm", 4, 3, labels),
        write_png("labels.png", 4, 3, labels, 8), write_png("labels16.png", 4, 3, labels, 16)}) {
    Scene scene = image_scene(file, 20e-6);
    EXPECT_EQ(grain_picture(scene), periodic) << file;
    scene.domain.periodic = {false, false};
    EXPECT_EQ(grain_picture(scene), open) << file;
  }
}

TEST(ImageGrains, ThresholdJoinsGreyValues) {
  const std::vector<int> grey = {200, 90,  10,  120,  //
                                 10,  30,  99,  10,   //
                                 150, 100, 101, 255};
  Scene scene = image_scene(write_png("grey.png", 4, 3, grey, 8), 20e-6);
  scene.sample.threshold = 100.0;
  EXPECT_EQ(grain_picture(scene), (std::vector<int>{2, 0, 0, 2, 0, 0, 0, 0, 1, 1, 1, 1}));
  EXPECT_NEAR(filled<2>(scene).report.geometric_void_fraction, 0.5, 1e-15);
  scene.sample.threshold = 256.0;
  expect_words(error_of(scene), {"grey.png", "no solid pixel", "sample.threshold"});
}

/// Labels of a picture, and the grains that follow from them.
const std::vector<int> some_labels = {7, 7, 0, 7,  //
                                      0, 0, 0, 9,  //
                                      7, 9, 9, 9};
const std::vector<int> some_grains = {3, 3, 0, 3,  //
                                      0, 0, 0, 2,  //
                                      1, 2, 2, 2};

std::vector<int> picture_of(const std::string& file, std::optional<double> threshold = {}) {
  Scene scene = image_scene(file, 20e-6);
  scene.sample.threshold = threshold;
  return grain_picture(scene);
}

// The number in the palette is the label, whatever its colour; with a threshold the colour counts.
TEST(ImageGrains, PaletteHoldsLabels) {
  std::vector<png_color> palette(16, {200, 10, 10});
  palette[0] = {90, 180, 240};
  palette[7] = {0, 0, 0};
  for (const int bits : {4, 8}) {
    for (const bool interlaced : {false, true}) {
      const std::string file = write_png("palette.png", 4, 3, some_labels,
                                         {.bits = bits,
                                          .colour_type = PNG_COLOR_TYPE_PALETTE,
                                          .palette = palette,
                                          .interlaced = interlaced});
      EXPECT_EQ(picture_of(file), some_grains) << bits;
      // Luminance 0 of label 7, 164 of label 0, 66 of label 9.
      EXPECT_EQ(picture_of(file, 100.0), (std::vector<int>{0, 0, 1, 0, 1, 1, 1, 0, 0, 0, 0, 0}));
      EXPECT_EQ(picture_of(file, 66.0), (std::vector<int>{0, 0, 1, 0, 1, 1, 1, 1, 0, 1, 1, 1}));
    }
  }
  // The last colours of the palette are missing.
  palette.resize(8);
  const std::string file = write_png("few.png", 4, 3, some_labels,
                                     {.colour_type = PNG_COLOR_TYPE_PALETTE, .palette = palette});
  expect_words(error_of(image_scene(file, 20e-6)), {"few.png", "colour 9 of a palette of 8"});
}

/// Samples of a picture in which every material pixel is `solid`, every other one `clear`.
std::vector<int> painted(const std::vector<int>& solid, const std::vector<int>& clear) {
  std::vector<int> samples;
  for (const int label : some_labels) {
    const std::vector<int>& pixel = label == 0 ? clear : solid;
    samples.insert(samples.end(), pixel.begin(), pixel.end());
  }
  return samples;
}

// White on transparent white, in every way that a PNG has to say it.
TEST(ImageGrains, WhatIsTransparentIsVoid) {
  const auto expect = [&](const std::string& file) {
    // The first column of row 2 and the last one touch: all is one grain across the period.
    Scene scene = image_scene(file, 20e-6);
    for (const std::optional<double> threshold : {std::optional<double>{}, {128.0}, {-1.0}}) {
      scene.sample.threshold = threshold;
      const std::vector<int> grains = grain_picture(scene);
      for (std::size_t i = 0; i < grains.size(); ++i) {
        EXPECT_EQ(grains[i] != 0, some_labels[i] != 0) << file << " pixel " << i;
      }
    }
  };
  const int most = 65535;
  expect(write_png("ga.png", 4, 3, painted({255, 255}, {255, 0}),
                   {.colour_type = PNG_COLOR_TYPE_GRAY_ALPHA}));
  expect(write_png("ga16.png", 4, 3, painted({most, 32768}, {most, 32767}),
                   {.bits = 16, .colour_type = PNG_COLOR_TYPE_GRAY_ALPHA}));
  expect(write_png("rgba.png", 4, 3, painted({255, 255, 255, 128}, {255, 255, 255, 127}),
                   {.colour_type = PNG_COLOR_TYPE_RGB_ALPHA}));
  expect(write_png("rgba16.png", 4, 3, painted({most, most, most, most}, {most, most, most, 0}),
                   {.bits = 16, .colour_type = PNG_COLOR_TYPE_RGB_ALPHA}));
  png_color_16 clear{};
  clear.gray = 254;
  expect(write_png("key.png", 4, 3, painted({255}, {254}), {.clear = &clear}));
  clear.red = clear.green = 255;
  clear.blue = 254;
  expect(write_png("key_rgb.png", 4, 3, painted({255, 255, 255}, {255, 255, 254}),
                   {.colour_type = PNG_COLOR_TYPE_RGB, .clear = &clear}));
  expect(write_png("key_palette.png", 4, 3, painted({1}, {2}),
                   {.bits = 2,
                    .colour_type = PNG_COLOR_TYPE_PALETTE,
                    .palette = std::vector<png_color>(4, {255, 255, 255}),
                    .opacity = {255, 255, 0}}));
}

// The labels of the file that is 4 x 3: raw, and with 16 bits.
TEST(ImageGrains, HeadersOfRawGreyMaps) {
  std::string raw, wide;
  for (const int label : some_labels) {
    raw += static_cast<char>(label);
    wide += std::string(1, '\0') + static_cast<char>(label);
  }
  const auto expect = [](const std::string& bytes) {
    EXPECT_EQ(picture_of(write_bytes("raw.pgm", bytes)), some_grains) << bytes;
  };
  for (const std::string end : {"\n", " ", "\t", "\r\n", "\n# a comment\n", " # a comment\n",
                                "\r\n# one\r\n# another\r\n", "\n#\n", " #\r"}) {
    expect("P5\n4 3\n255" + end + raw);
    expect("P5 # c\r\n4 3 #\r\n65535" + end + wide);
  }
  expect("P5\n4 3\n255\n" + raw + "\n");
  expect("P5\n4 3\n255\n" + raw + "\r\n \n");
  // Where the first values look like the end of a header, the length tells that they do not.
  std::vector<int> odd = {13, 10, 35, 10, 35, 32, 10, 10, 10, 13, 35, 35};
  const std::vector<int> plain = picture_of(write_text_pgm("odd_plain.pgm", 4, 3, odd));
  EXPECT_EQ(picture_of(write_pgm("odd.pgm", 4, 3, odd)), plain);
}

// A byte too many or too few may be one that shifts all others: never taken for a picture.
TEST(ImageGrains, ShiftedGreyMapsAreRefused) {
  const std::string raw(12, 'x');
  const auto refused = [](const std::string& bytes, const std::vector<std::string>& words) {
    expect_words(error_of(image_scene(write_bytes("shifted.pgm", bytes), 20e-6)), words);
  };
  refused("P5\n4 3\n255\n" + raw + "y", {"13 bytes after its PGM header", "need 12"});
  refused("P5\n4 3\n255\n\n" + raw, {"13 bytes after its PGM header", "need 12"});
  refused("P5\r\n4 3\r\n255\r\n" + raw.substr(1), {"no grey value", "row 2, column 3"});
  refused("P5\n4 3\n255\n" + raw + "P5\n4 3\n255\n" + raw, {"35 bytes", "as one image"});
  refused("P5\n4 3\n255\n# comment\n" + raw + "\n", {"as one image"});
  refused("P5\n4 3\n255x" + raw, {"no white space after its PGM header"});
  refused("P2 2 2 15 1 2 3 4 5", {"goes on after its 2 x 2 grey values"});
  refused("P2 2 2 15 1 2 3 4 P2", {"goes on after its 2 x 2 grey values"});
}

TEST(ImageGrains, OneGrainOrNoVoidIsSaid) {
  const auto warning = [](const std::vector<int>& values, std::optional<double> threshold) {
    Scene scene = image_scene(write_text_pgm("warned.pgm", 4, 3, values), 20e-6);
    scene.sample.threshold = threshold;
    const std::vector<std::string> all = sample_warnings(scene, filled<2>(scene).report);
    return !all.empty() && all[0].find("came out as") != std::string::npos ? all[0] : "";
  };
  const std::vector<int> one = {5, 5, 0, 0, 5, 5, 0, 0, 5, 5, 0, 0};
  expect_words(warning(one, {}), {"warned.pgm came out as one grain", "a label of its own"});
  expect_words(warning(one, 3.0), {"came out as one grain", "sample.threshold"});
  expect_words(warning(std::vector<int>(12, 4), {}), {"came out as solid all over", "label 0"});
  expect_words(warning(one, 0.0), {"came out as solid all over", "sample.threshold; raise it"});
  EXPECT_EQ(warning(some_labels, {}), "");
  EXPECT_EQ(warning({5, 5, 0, 3, 5, 5, 0, 3, 5, 5, 0, 3}, {}), "");
}

TEST(ImageGrains, BadImagesAreNamed) {
  const auto refused = [](const std::string& file) { return error_of(image_scene(file, 20e-6)); };
  expect_words(refused("absent.png"), {"sample.image: absent.png", "cannot be opened"});
  expect_words(refused(write_bytes("text.png", "no image")),
               {"text.png", "neither a PNG, nor a TIFF, nor a PGM file"});
  const std::vector<int> labels(12, 5);
  std::string bytes = read_bytes(write_png("cut.png", 4, 3, labels, 8));
  write_bytes("cut.png", bytes.substr(0, bytes.size() / 2));
  expect_words(refused("cut.png"), {"cut.png", "damaged PNG file", "ends too early"});
  write_bytes("cut.pgm", "P5 4 3 255\nabc");
  expect_words(refused("cut.pgm"), {"cut.pgm", "row 0, column 3"});
  write_bytes("high.pgm", "P2 2 2 15 1 2 3 16");
  expect_words(refused("high.pgm"), {"high.pgm", "0 to 15", "row 1, column 1"});
  write_bytes("huge.pgm", "P5 100000 100000 255\n");
  expect_words(refused("huge.pgm"), {"huge.pgm", "100000 x 100000"});
  const std::string file = write_png("small.png", 3, 3, std::vector<int>(9, 1), 8);
  expect_words(refused(file), {"3 columns of sample.pixel = 2e-05 m", "8e-05 m", "domain.size"});
}

}  // namespace
}  // namespace poreshock
