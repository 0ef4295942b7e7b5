#include "poreshock/scene/levels.hpp"

#include <charconv>
#include <cmath>

namespace poreshock {
namespace {

double to_fifteen_digits(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof(text), value, std::chars_format::general, 15);
  double result = value;
  std::from_chars(text, end.ptr, result);
  return result;
}

}  // namespace

std::optional<std::vector<double>> levels_between(double from, double to, double step) {
  const double steps = (to - from) / step;
  if (!(step > 0.0 && steps >= 0.0 && steps < most_thresholds)) return std::nullopt;
  // The small share takes up the rounding of the division, so that `to` itself is not lost.
  const int count = static_cast<int>(std::floor(steps + 1e-6)) + 1;
  std::vector<double> levels = {from};
  for (int i = 1; i < count; ++i) levels.push_back(to_fifteen_digits(from + i * step));
  return levels;
}

}  // namespace poreshock
