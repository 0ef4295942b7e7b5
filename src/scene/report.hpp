#pragma once
// All problems of a scene, collected while it is read and shown together.

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <string>
#include <vector>

namespace poreshock::scene_text {

/// Where something was written: a file with line and column, or an override "--set key=value".
struct Origin {
  std::string source;
  std::uint32_t line = 1;
  std::uint32_t column = 1;
};

/// One thing to correct.
struct Problem {
  Origin origin;
  std::string path;  ///< key with its tables, for example material.0.density
  std::string text;  ///< what was found, what is allowed
};

/// Problems found so far, and where each key that was read stands. The path "" is the whole scene.
struct Report {
  std::map<std::string, Origin> origins;
  std::vector<Problem> problems;
};

/// Adds a problem of a key at the place of the key or, when it was not given, of its table.
void add_problem(const std::string& path, const std::string& text, Report& report);

/// Adds a problem of a key at a given place.
void add_problem_at(const Origin& origin, const std::string& path, const std::string& text,
                    Report& report);

/// True when the key, anything inside it or a table around it has a problem.
bool has_problem(const Report& report, const std::string& path);

/// One line per problem, file:line:column: key: text, in the order of the file, overrides last.
std::string report_text(const Report& report);

/// The text ", did you mean "x"?" for the allowed name nearest to `name`; empty when none is near.
std::string hint(const std::string& name, const std::vector<std::string>& allowed);

/// Text of a problem of a key that was given with a wrong value, or not given at all.
inline std::string wrong(const Report& report, const char* path, const std::string& found,
                         const std::string& allowed) {
  if (!report.origins.contains(path)) return "missing, give " + allowed;
  return "found " + found + ", allowed " + allowed;
}

/// True when none of the paths has a problem.
inline bool good(const Report& report, std::initializer_list<const char*> paths) {
  return std::none_of(paths.begin(), paths.end(),
                      [&](const char* path) { return has_problem(report, path); });
}

}  // namespace poreshock::scene_text
