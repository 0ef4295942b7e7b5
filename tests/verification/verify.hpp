#pragma once
// Lines of the verification table. Every figure is printed as
//   VERIFY <case> <figure> <value> <bar> <pass|fail>
// with the bar as "<=0.001", ">=1.8" or "|.|<=0.02" (of the absolute value), so that a table can be
// collected from the output of the tests; a figure that is only recorded has the bar "none" and
// passes.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "poreshock/core/parallel.hpp"

namespace poreshock::test {

/// One row of the table, printed by rank 0; names without blanks.
inline void print_figure(const std::string& name, const std::string& figure, double value,
                         const std::string& bar, bool passed) {
  if (rank(MPI_COMM_WORLD) != 0) return;
  std::printf("VERIFY %s %s %.6g %s %s\n", name.c_str(), figure.c_str(), value, bar.c_str(),
              passed ? "pass" : "fail");
  std::fflush(stdout);
}

inline std::string bar_text(const char* relation, double bar) {
  char text[40];
  std::snprintf(text, sizeof text, "%s%.6g", relation, bar);
  return text;
}

/// Prints the figure and fails the test unless value <= bar.
inline void verify_at_most(const std::string& name, const std::string& figure, double value,
                           double bar) {
  print_figure(name, figure, value, bar_text("<=", bar), value <= bar);
  EXPECT_LE(value, bar) << name << ": " << figure;
}

/// Prints the figure and fails the test unless value >= bar.
inline void verify_at_least(const std::string& name, const std::string& figure, double value,
                            double bar) {
  print_figure(name, figure, value, bar_text(">=", bar), value >= bar);
  EXPECT_GE(value, bar) << name << ": " << figure;
}

/// Verifies |value / exact - 1| <= bar; the signed relative error is what the table shows.
inline void verify_relative(const std::string& name, const std::string& figure, double value,
                            double exact, double bar) {
  const double error = value / exact - 1.0;
  const bool passed = std::abs(error) <= bar;
  print_figure(name, figure + "_error", error, bar_text("|.|<=", bar), passed);
  EXPECT_TRUE(passed) << name << ": " << figure << " is " << value << ", exact " << exact;
}

/// For a figure that misses its bar and is known to: the table says so ("fail"), the test fails
/// only when it gets worse than `known`, or meets the bar, so that the shortfall is taken off the
/// list.
inline void verify_known_shortfall(const std::string& name, const std::string& figure, double value,
                                   double bar, double known) {
  print_figure(name, figure, value, bar_text("<=", bar), value <= bar);
  EXPECT_LE(value, known) << name << ": " << figure << " is worse than it was";
  EXPECT_GT(value, bar) << name << ": " << figure << " now meets its bar; verify it as such";
}

/// Prints a figure that has no bar; it must be finite.
inline void record(const std::string& name, const std::string& figure, double value) {
  print_figure(name, figure, value, "none", std::isfinite(value));
  EXPECT_TRUE(std::isfinite(value)) << name << ": " << figure;
}

/// A number as a scene states it, all digits.
inline std::string digits(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

/// Order of convergence between an error and the one at half the cell size.
inline double order(double coarse, double fine) {
  return std::log2(coarse / fine);
}

}  // namespace poreshock::test
