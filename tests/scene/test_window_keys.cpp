// A domain that follows the front: what it needs is told at once.
#include <gtest/gtest.h>

#include "scene_text.hpp"

namespace poreshock {
namespace {

/// Domain of 10 x 128 cells below a higher sample.
std::string window_scene(const std::string& more = "") {
  return scene_with("size = [1e-4, 1.28e-3]\ncell = 1e-5\nperiodic = true\n",
                    "follow = \"front\"\n[boundary]\nlow = \"wall\"\n" + more);
}

TEST(Window, AllowsASampleHigherThanTheDomain) {
  const std::vector<std::string> high = {"sample.height=20e-3"};
  EXPECT_EQ(problems(window_scene(), high), "");
  const std::string refused = problems(window_scene(), {high.front(), "time.follow=nothing"});
  EXPECT_NE(refused.find("allowed up to the domain height of 0.00128 m, or more with time.follow = "
                         "\"front\""),
            std::string::npos)
      << refused;
}

TEST(Window, NamesEveryProbeThatLooksAtMaterial) {
  const std::string text = problems(
      window_scene(
          "[[probe]]\nname = \"a\"\nat = [5e-5]\n[[probe]]\nname = \"b\"\nkind = "
          "\"point\"\nat = [5e-5, 1e-4]\n[[probe]]\nname = \"c\"\nkind = \"particle\"\nat = "
          "[5e-5, 1e-4]\n"),
      {"sample.height=20e-3"});
  EXPECT_NE(text.find("probe.0.kind: found \"surface\", allowed with time.follow"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("probe.2.kind: found \"particle\""), std::string::npos) << text;
  EXPECT_EQ(text.find("probe.1"), std::string::npos) << text;
}

TEST(Window, NamesAllThatItCannotFollow) {
  const std::string text =
      problems(window_scene("[conduction]\non = true\n[[void]]\nshape = \"disc\"\ncenter = [5e-5, "
                            "5e-5]\nradius = 1e-5\n"),
               {"boundary.low=free", "sample.kind=random_voids", "sample.void_radius=1e-5",
                "sample.porosity=0.1", "sample.overlap=true", "domain.size=[1e-4, 1.27e-3]",
                "sample.height=1e-3"});
  for (const char* part : {"at least 128 cells", "boundary.low = \"wall\"", "without overlap",
                           "without [[body]]", "conduction"}) {
    EXPECT_NE(text.find(std::string("time.follow: found \"front\", allowed only ")),
              std::string::npos)
        << text;
    EXPECT_NE(text.find(part), std::string::npos) << part << " is not in:\n" << text;
  }
}

}  // namespace
}  // namespace poreshock
