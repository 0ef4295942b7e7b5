#pragma once
// Private to output: the root attributes every file of ours has.

#include <cstdint>
#include <string>
#include <vector>

#include "poreshock/core/parallel.hpp"
#include "poreshock/files/hdf5_file.hpp"

namespace poreshock {

inline std::vector<Attribute> root_attributes(const std::string& kind, double time,
                                              std::int64_t step, const std::string& scene_text) {
  return {{"kind", kind},         {"time", time},           {"step", step},
          {"version", version()}, {"revision", revision()}, {"scene", scene_text}};
}

}  // namespace poreshock
