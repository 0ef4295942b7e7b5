#pragma once
// What a file holds, in words.

#include <string>

namespace poreshock {

/// Text of several lines on any file of ours: kind, time, step, version, whether its seal is
/// intact, datasets with shapes and units; for history.csv its columns and rows. InputError when
/// the file cannot be read or is of another kind. Not collective: call on one rank.
std::string describe(const std::string& path);

}  // namespace poreshock
