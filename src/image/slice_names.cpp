#include "slice_names.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>

#include "poreshock/core/error.hpp"

namespace poreshock {
namespace {

/// A file name around its last number.
struct SliceName {
  std::string before, after;
  std::int64_t number = -1;  ///< -1 without any
  std::string name;
};

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

SliceName split(const std::string& name) {
  constexpr std::size_t most_digits = 15;
  const std::size_t stem = name.rfind('.');
  std::size_t end = stem;
  while (end > 0 && !is_digit(name[end - 1])) --end;
  std::size_t begin = end;
  while (begin > 0 && end - begin < most_digits && is_digit(name[begin - 1])) --begin;
  if (begin == end) return {name.substr(0, stem), name.substr(stem), -1, name};
  return {name.substr(0, begin), name.substr(end), std::stoll(name.substr(begin, end - begin)),
          name};
}

bool is_picture(const std::filesystem::path& file) {
  std::string kind = file.extension().string();
  std::transform(kind.begin(), kind.end(), kind.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return kind == ".png" || kind == ".pgm" || kind == ".tif" || kind == ".tiff";
}

/// What is missing or twice between two numbers that follow each other.
void check_step(const SliceName& last, const SliceName& next, const std::string& folder,
                std::vector<std::string>& problems) {
  const std::int64_t step = next.number - last.number;
  if (step == 1) return;
  const std::string between = "between " + last.name + " and " + next.name;
  if (step == 0) {
    problems.push_back(folder + ": slice " + std::to_string(next.number) + " is there twice, " +
                       last.name + " and " + next.name + ". Allowed is one of each number");
    return;
  }
  const std::string first = std::to_string(last.number + 1);
  problems.push_back(folder + ": " +
                     (step == 2
                          ? "slice " + first + " is"
                          : "slices " + first + " to " + std::to_string(next.number - 1) + " are") +
                     " missing " + between + ". Allowed are numbers without a gap");
}

}  // namespace

std::vector<std::string> find_slices(const std::string& folder,
                                     std::vector<std::string>& problems) {
  std::vector<SliceName> slices;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (is_picture(entry.path())) slices.push_back(split(entry.path().filename().string()));
  }
  if (slices.empty()) {
    throw InputError("sample.image: " + folder +
                     ": has no slice in it. Allowed are PNG, PGM or TIFF files with a number in "
                     "their names, such as slice_0001.png.");
  }
  std::sort(slices.begin(), slices.end(), [](const SliceName& a, const SliceName& b) {
    return a.number != b.number ? a.number < b.number : a.name < b.name;
  });
  std::vector<std::string> paths;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    const SliceName& slice = slices[i];
    const SliceName& first = slices.back();  // one without a number sorts first
    paths.push_back((std::filesystem::path(folder) / slice.name).string());
    if (slices.size() == 1) break;
    if (slice.number < 0 || slice.before != first.before || slice.after != first.after) {
      problems.push_back(folder + ": " + slice.name + " does not belong to " + first.before +
                         "..." + first.after +
                         ". Allowed are names that differ in their last number only");
    } else if (i > 0 && slices[i - 1].number >= 0) {
      check_step(slices[i - 1], slice, folder, problems);
    }
  }
  return paths;
}

}  // namespace poreshock
