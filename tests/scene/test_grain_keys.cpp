// Keys of grains, contact and friction of walls: what is refused, and the way back through text.
#include <gtest/gtest.h>

#include "parsed_scene.hpp"
#include "scene_text.hpp"

namespace poreshock {
namespace {

std::string grain_problems(const std::string& lines) {
  std::string text = small_scene();
  const std::string kind = "kind = \"solid\"\n";
  text.replace(text.find(kind), kind.size(), lines);
  return problems(text);
}

TEST(GrainKeys, PackedGrainsNeedASizeAndAPossibleVoidFraction) {
  EXPECT_EQ(grain_problems("kind = \"packed_grains\"\n"),
            "s.toml:14:1: sample.grain_radius: missing, give a number > 0 (m) with kind = "
            "\"packed_grains\"\n"
            "s.toml:14:1: sample.porosity: missing, give a void fraction from 0.14 to 0.95 with "
            "kind = \"packed_grains\": denser grains are jammed; use \"voronoi_grains\"");
  EXPECT_EQ(grain_problems("kind = \"packed_grains\"\ngrain_radius = 2e-5\nporosity = 0.3\n"), "");
}

/// The transfer of a scene with these lines for its sample.
Transfer transfer_with(const std::string& sample, const std::string& more = {}) {
  std::string text = small_scene();
  const std::string kind = "kind = \"solid\"\n";
  text.replace(text.find(kind), kind.size(), sample);
  return parse(text + more).transfer;
}

TEST(GrainKeys, GrainsHaveATransferOfTheirOwn) {
  const std::string solid = "kind = \"solid\"\n";
  const std::string packed = "kind = \"packed_grains\"\ngrain_radius = 2e-5\nporosity = 0.3\n";
  const std::string disc = "\n[[body]]\nshape = \"disc\"\ncenter = [5e-5, 1e-4]\nradius = 1e-5\n";
  EXPECT_EQ(transfer_with(solid).gradient, Gradient::slopes);
  EXPECT_EQ(transfer_with(solid).damping, 0.05);
  EXPECT_EQ(transfer_with(solid, disc).gradient, Gradient::slopes);
  EXPECT_EQ(transfer_with(solid, disc + "grain = 1\n").gradient, Gradient::moments);
  EXPECT_EQ(transfer_with(solid, disc + "grain = 1\n").damping, 0.05);
  EXPECT_EQ(transfer_with(packed).gradient, Gradient::moments);
  EXPECT_EQ(transfer_with(packed).damping, 0.01);
  const std::string hats = "\n[transfer]\nshape = \"linear\"\n";
  EXPECT_EQ(transfer_with(packed, hats).gradient, Gradient::slopes);
}

TEST(GrainKeys, VoronoiGrainsTakeTheirGapFromThePorosity) {
  const std::string start = "kind = \"voronoi_grains\"\ngrain_radius = 2e-5\n";
  EXPECT_EQ(grain_problems(start + "porosity = 0.6\n"),
            "s.toml:17:12: sample.porosity: found a void fraction of 0.6, allowed a void fraction "
            "> 0 and <= 0.5 with kind = \"voronoi_grains\"");
  EXPECT_EQ(grain_problems(start + "porosity = 0.1\ngrain_gap = 1e-6\n"),
            "s.toml:18:13: sample.grain_gap: found 1e-06 m, allowed 0 with kind = "
            "\"voronoi_grains\": their gap follows from porosity");
}

TEST(GrainKeys, ImageNeedsAFileAndAPixel) {
  EXPECT_EQ(grain_problems("kind = \"image\"\n"),
            "s.toml:14:1: sample.image: missing, give the path of a PNG, TIFF or PGM file or of an "
            "array\n"
            "s.toml:14:1: sample.pixel: missing, give a number > 0 (m), the side of a pixel or "
            "voxel of the image");
}

TEST(GrainKeys, RawImagesNeedTheirSize) {
  const std::string start = "kind = \"image\"\npixel = 1e-6\nimage = \"scan.raw\"\n";
  EXPECT_EQ(grain_problems(start),
            "s.toml:14:1: sample.raw_size: missing, give whole numbers from 1 to 1e9, voxels along "
            "each axis, with scan.raw");
  EXPECT_EQ(
      grain_problems(start + "raw_size = [10, 20.5]\nraw_type = \"uint12\"\n"),
      "s.toml:18:12: sample.raw_size: found 10, 20.5 ..., allowed whole numbers from 1 to "
      "1e9, voxels along each axis\n"
      "s.toml:19:12: sample.raw_type: found \"uint12\", allowed \"uint8\", \"int8\", "
      "\"uint16\", \"int16\", \"uint32\", \"int32\", \"float32\" or \"float64\", did you mean "
      "\"uint16\"?");
  EXPECT_EQ(grain_problems(start + "raw_size = [10, 20]\nregions = \"matrix\"\n"), "");
  EXPECT_EQ(
      grain_problems(start + "raw_size = [10, 20]\nregions = \"matrix\"\n"
                             "mixture = [{ material = \"aluminium\", fraction = 1.0 }]\n"),
      "s.toml:20:12: sample.mixture.0: found a mixture, allowed with a sample of grains only");
}

TEST(GrainKeys, MixturesNameMaterialsAndSumToOne) {
  const std::string grains = "kind = \"packed_grains\"\ngrain_radius = 2e-5\nporosity = 0.3\n";
  EXPECT_EQ(grain_problems(grains + "mixture = [{ material = \"aluminium\", fraction = 0.9 }]\n"),
            "s.toml:18:49: sample.mixture.0.fraction: found fractions that sum to 0.9, allowed a "
            "sum of 1");
  EXPECT_EQ(grain_problems(grains + "mixture = [{ material = \"tin\", fraction = 1.0 }]\n"),
            "s.toml:18:25: sample.mixture.0.material: found \"tin\", allowed \"aluminium\"");
  EXPECT_EQ(
      grain_problems(
          "kind = \"solid\"\nmixture = [{ material = \"aluminium\", fraction = 1.0 }]\n"),
      "s.toml:16:12: sample.mixture.0: found a mixture, allowed with a sample of grains only");
}

TEST(GrainKeys, FrictionBelongsToWalls) {
  EXPECT_EQ(problems(small_scene("[boundary]\nlow = { kind = \"free\", friction = 0.5 }\n")),
            "s.toml:19:35: boundary.low.friction: found 0.5, allowed only with kind = \"wall\"");
  EXPECT_EQ(problems(small_scene("[contact]\nfriction = -0.1\n")),
            "s.toml:19:12: contact.friction: found -0.1, allowed a number >= 0");
  EXPECT_EQ(problems(small_scene("[contact]\ngap = \"volumes\"\n")),
            "s.toml:19:7: contact.gap: found \"volumes\", allowed \"volume\" or \"none\", did you "
            "mean \"volume\"?");
  EXPECT_EQ(problems(small_scene("[contact]\nself = true\nnormal = \"regression\"\n")),
            "s.toml:19:8: contact.self: found true, allowed false with contact.normal = "
            "\"regression\": that parts grains, not sides of one");
}

TEST(GrainKeys, SurviveTheWayThroughText) {
  const std::string text = small_scene(
      "[contact]\nfriction = 0.25\ngap = \"none\"\nnormal = \"regression\"\n"
      "[boundary]\nlow = { kind = \"wall\", friction = 0.5 }\n"
      "[[sample.mixture]]\nmaterial = \"aluminium\"\nfraction = 1.0\n");
  std::string grains = text;
  const std::string kind = "kind = \"solid\"\n";
  grains.replace(
      grains.find(kind), kind.size(),
      "kind = \"image\"\nimage = \"a.png\"\npixel = 1e-6\nthreshold = -99.5\n"
      "raw_size = [12, 34]\nraw_type = \"int16\"\nraw_big_endian = true\nraw_skip = 512\n"
      "grain_spread = 0.1\nislands = \"grains\"\n");
  const Scene scene = parse_scene(grains, "s.toml");
  EXPECT_EQ(scene.contact.friction, 0.25);
  EXPECT_EQ(scene.contact.gap, GapTest::none);
  EXPECT_EQ(scene.contact.normal, ContactNormal::regression);
  EXPECT_EQ(scene.boundary.low.friction, 0.5);
  EXPECT_EQ(scene.sample.image, "a.png");
  EXPECT_EQ(scene.sample.threshold, -99.5);
  EXPECT_EQ(scene.sample.raw_size, (Triple{12.0, 34.0, 0.0}));
  EXPECT_EQ(scene.sample.raw_type, "int16");
  EXPECT_TRUE(scene.sample.raw_big_endian);
  EXPECT_EQ(scene.sample.raw_skip, 512);
  ASSERT_EQ(scene.sample.mixture.size(), 1U);
  EXPECT_EQ(scene.sample.mixture[0].fraction, 1.0);
  EXPECT_EQ(scene.sample.islands, Islands::grains);
  EXPECT_EQ(parse_scene(write_scene(scene), "t.toml"), scene);
}

}  // namespace
}  // namespace poreshock
