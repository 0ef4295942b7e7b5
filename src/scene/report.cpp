#include "report.hpp"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <tuple>

namespace poreshock::scene_text {
namespace {

bool is_override(const Origin& origin) {
  return origin.source.starts_with("--set ");
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// Levenshtein distance: insertions, deletions and substitutions of one letter.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row[b.size()];
}

}  // namespace

void add_problem(const std::string& path, const std::string& text, Report& report) {
  std::string place = path;
  while (!report.origins.contains(place) && !place.empty()) {
    const std::size_t dot = place.rfind('.');
    place.resize(dot == std::string::npos ? 0 : dot);
  }
  add_problem_at(report.origins[place], path, text, report);
}

void add_problem_at(const Origin& origin, const std::string& path, const std::string& text,
                    Report& report) {
  report.problems.push_back({origin, path, text});
}

bool has_problem(const Report& report, const std::string& path) {
  return std::any_of(report.problems.begin(), report.problems.end(), [&](const Problem& problem) {
    return problem.path == path || problem.path.starts_with(path + ".") ||
           path.starts_with(problem.path + ".");
  });
}

std::string report_text(const Report& report) {
  std::vector<Problem> problems = report.problems;
  const auto order = [](const Problem& p) {
    const bool last = is_override(p.origin);
    return std::tuple(last, last ? 0 : p.origin.line, last ? 0 : p.origin.column);
  };
  std::stable_sort(problems.begin(), problems.end(),
                   [&](const Problem& a, const Problem& b) { return order(a) < order(b); });
  std::string text;
  for (const Problem& problem : problems) {
    if (!text.empty()) text += '\n';
    text += problem.origin.source + ":";
    if (!is_override(problem.origin)) {
      text +=
          std::to_string(problem.origin.line) + ":" + std::to_string(problem.origin.column) + ":";
    }
    text += " ";
    if (!problem.path.empty()) text += problem.path + ": ";
    text += problem.text;
  }
  return text;
}

std::string hint(const std::string& name, const std::vector<std::string>& allowed) {
  std::string best;
  std::size_t least = name.size() + 1;
  for (const std::string& candidate : allowed) {
    const std::size_t changes = distance(lower(name), lower(candidate));
    if (changes < least) {
      least = changes;
      best = candidate;
    }
  }
  // More changes than a third of the letters is another word, not a slip.
  if (best.empty() || least > std::max<std::size_t>(1, (name.size() + 1) / 3)) return "";
  return ", did you mean \"" + best + "\"?";
}

}  // namespace poreshock::scene_text
