// Keys of probes: what they mean and what users read about mistakes.
#include <gtest/gtest.h>

#include <string>

#include "scene_text.hpp"

namespace poreshock {
namespace {

TEST(ProbeKeys, Defaults) {
  const Scene scene = parse_scene(small_scene("[[probe]]\nname = \"a\"\nat = [5e-5]\n"), "s.toml");
  ASSERT_EQ(scene.probes.size(), 1u);
  const Probe& probe = scene.probes[0];
  EXPECT_EQ(probe.kind, ProbeKind::surface);
  EXPECT_EQ(probe.at[0], 5e-5);
  EXPECT_EQ(probe.width, 1e-5);
  EXPECT_EQ(probe.faces, Facing::up);
  EXPECT_EQ(probe.every, Cadence::step);
  EXPECT_EQ(parse_scene(write_scene(scene), "again"), scene);
}

TEST(ProbeKeys, Mistakes) {
  EXPECT_EQ(problems(small_scene("[[probe]]\nname = \"a b\"\nat = [2e-4]\nwidth = 5e-6\n"
                                 "[[probe]]\nname = \"c\"\nkind = \"point\"\nat = [0, -1]\n"
                                 "[[probe]]\nname = \"c\"\nkind = \"particle\"\nat = [0, 3e-4]\n")),
            "s.toml:19:8: probe.0.name: found \"a b\", allowed 1 to 40 letters, digits, _ and -: "
            "it is part of a file name\n"
            "s.toml:20:6: probe.0.at: found 0.0002 m along x, allowed 0 to domain.size = 0.0001 m\n"
            "s.toml:21:9: probe.0.width: found 5e-06 m, allowed at least domain.cell = 1e-05 m: "
            "nothing finer is resolved\n"
            "s.toml:27:8: probe.2.name: found \"c\" again, allowed a name of its own for each "
            "probe\n"
            "s.toml:29:6: probe.2.at: found 0.0003 m along y, allowed 0 to domain.size = 0.0002 m");
  EXPECT_EQ(problems(small_scene("[[probe]]\nname = \"a\"\nat = [0, 0]\n")),
            "s.toml:20:6: probe.0.at: found an array of 2, allowed an array of 1 number (m)");
}

}  // namespace
}  // namespace poreshock
