#pragma once
// Scenes as they are read, and written back.

#include <gtest/gtest.h>

#include "scene_text.hpp"

namespace poreshock {

inline Scene parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_scene(text, "s.toml", overrides);
}

/// Expects that the written scene reads back as the same and writes the same text again.
inline void expect_round_trip(const Scene& scene) {
  const std::string text = write_scene(scene);
  const Scene again = parse_scene(text, "written");
  EXPECT_TRUE(again == scene) << text;
  EXPECT_EQ(write_scene(again), text);
}

}  // namespace poreshock
