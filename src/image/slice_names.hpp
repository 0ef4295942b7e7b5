#pragma once
// The slices of a folder by their numbers. Private to the layer.

#include <string>
#include <vector>

namespace poreshock {

/// The PNG, PGM and TIFF files of a folder in the order of the last number in their names; other
/// files mean nothing. Adds a sentence to `problems` where names differ in more than the number,
/// where a number is missing, or where one comes twice. Throws InputError when there is no such
/// file. Not collective.
std::vector<std::string> find_slices(const std::string& folder, std::vector<std::string>& problems);

}  // namespace poreshock
