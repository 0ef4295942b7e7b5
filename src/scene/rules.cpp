#include "rules.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

namespace poreshock::scene_text {
bool in_range(const Range& range, double number) {
  if (!std::isfinite(number)) return false;
  const bool low = range.above_low ? number > range.low : number >= range.low;
  const bool high = range.below_high ? number < range.high : number <= range.high;
  return low && high;
}

std::string allowed_numbers(const std::string& noun, const NumberRule& rule) {
  const Range& range = rule.range;
  const bool low = std::isfinite(range.low);
  const bool high = std::isfinite(range.high);
  std::string text = noun;
  if (low && high && !range.above_low && !range.below_high) {
    text += " from " + plain_number(range.low) + " to " + plain_number(range.high);
  } else {
    if (low) text += (range.above_low ? " > " : " >= ") + plain_number(range.low);
    if (low && high) text += " and";
    if (high) text += (range.below_high ? " < " : " <= ") + plain_number(range.high);
  }
  return rule.unit.empty() ? text : text + " (" + rule.unit + ")";
}

std::string allowed_names(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " or " : ", ";
    text += '"' + names[i] + '"';
  }
  return text;
}

std::string plain_number(double number) {
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number,
                                    std::chars_format::general, 12);
  return {buffer.data(), result.ptr};
}

std::string number_text(double number) {
  if (std::isnan(number)) return "nan";
  if (std::isinf(number)) return number > 0.0 ? "inf" : "-inf";
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number);
  std::string text(buffer.data(), result.ptr);
  // Without a point or an exponent TOML would read an integer, which may not hold the number.
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

}  // namespace poreshock::scene_text
