#pragma once
// What a key of a scene may hold: range, unit and prose. A rule stands in tables.hpp beside the
// member it fills; the reader checks with it, the writer takes its comments from it.

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "poreshock/core/range.hpp"
#include "poreshock/scene/scene.hpp"

namespace poreshock::scene_text {

inline constexpr Range any_number{};
inline constexpr Range share{.low = 0.0, .high = 1.0};

enum class Need { optional, required };

/// Rule of a number or of a list of numbers.
struct NumberRule {
  Range range;
  std::string unit;  ///< empty for pure numbers
  std::string about;
  Need need = Need::optional;
};

/// Rule of everything else.
struct Rule {
  std::string about;
  Need need = Need::optional;
};

/// Names of the values of an enumeration as they stand in a scene.
template <typename Enum>
using Names = std::vector<std::pair<std::string, Enum>>;

/// The sides that a scene may choose; periodic ones follow from the domain.
inline Names<SideKind> names_of_sides() {
  Names<SideKind> names;
  for (const SideLaw& law : side_laws) {
    if (!law.wraps) names.emplace_back(law.name, law.kind);
  }
  return names;
}

/// The name of a value.
template <typename Enum>
std::string name_in(const Names<Enum>& names, Enum value) {
  for (const auto& [text, meaning] : names) {
    if (meaning == value) return text;
  }
  return "";
}

/// True when the number is finite and inside the range.
bool in_range(const Range& range, double number);

/// The allowed numbers in words, for example "a number > 0 (m)"; `noun` is "a number" or such.
std::string allowed_numbers(const std::string& noun, const NumberRule& rule);

/// The allowed names in words, for example "\"disc\", \"box\" or \"ring\"".
std::string allowed_names(const std::vector<std::string>& names);

/// All names of an enumeration.
template <typename Enum>
std::vector<std::string> texts_of(const Names<Enum>& names) {
  std::vector<std::string> texts;
  for (const auto& [text, meaning] : names) texts.push_back(text);
  return texts;
}

/// A number in prose, with at most 12 digits: 4 rather than 4.0.
std::string plain_number(double number);

/// Shortest text that reads back as the same number, with a point or an exponent.
std::string number_text(double number);

/// A whole number of any type; its limits are those of the rule and of the type.
template <typename Visitor, typename Integer>
void integer(Visitor& visitor, const char* key, Integer& value, NumberRule rule) {
  if constexpr (sizeof(Integer) < sizeof(std::int64_t)) {
    constexpr double most = std::numeric_limits<Integer>::max();
    rule.range.high = rule.range.high < most ? rule.range.high : most;
  }
  auto number = static_cast<std::int64_t>(value);
  visitor.whole(key, number, rule);
  value = static_cast<Integer>(number);
}

/// A value of an enumeration by name; false when the scene holds no allowed name.
template <typename Visitor, typename Enum>
bool choice(Visitor& visitor, const char* key, Enum& value, const Names<Enum>& names,
            const Rule& rule) {
  std::string name = name_in(names, value);
  if (!visitor.name(key, name, texts_of(names), rule)) return false;
  for (const auto& [text, meaning] : names) {
    if (text == name) value = meaning;
  }
  return true;
}

}  // namespace poreshock::scene_text
