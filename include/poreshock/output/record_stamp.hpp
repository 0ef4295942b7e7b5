#pragma once
// What every record of a run says about its time.

#include <cstdint>
#include <map>
#include <string>

namespace poreshock {

/// When and from what a record was measured.
struct RecordStamp {
  std::int64_t record = 0;
  std::int64_t step = 0;
  double time = 0.0;  ///< s
  std::string scene_text;
  std::map<std::string, double> numbers{};  ///< further attributes of the file
};

}  // namespace poreshock
