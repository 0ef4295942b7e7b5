// Twelve typical mistakes, each made in a scene that comes with the program: the message says where
// it is and what to write instead.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>

#include "scene_text.hpp"

namespace poreshock {
namespace {

/// A line of the scene by its beginning, what stands there by mistake, and what the user reads.
struct Mistake {
  std::string beginning, instead, message;
};

/// The problems of the scene with one line replaced; `NN` in a message is the number of the line.
void expect_message(const Mistake& mistake) {
  std::ifstream file(std::string(PORESHOCK_SOURCE_DIR) + "/input/porous_aluminium.toml");
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const std::size_t at = text.find("\n" + mistake.beginning);
  ASSERT_NE(at, std::string::npos) << mistake.beginning;
  const std::size_t end = text.find('\n', at + 1);
  const std::string wrong = text.substr(0, at + 1) + mistake.instead + text.substr(end);
  const auto line =
      std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n') + 2;
  std::string message = mistake.message;
  const std::size_t place = message.find("NN");
  if (place != std::string::npos) message.replace(place, 2, std::to_string(line));
  const std::string found = problems(wrong);
  EXPECT_NE(found.find("s.toml:" + message), std::string::npos)
      << "after: " << mistake.instead << "\nread:  " << found << "\nwanted: " << message;
}

TEST(Mistakes, EachSaysWhatToWrite) {
  const Mistake mistakes[] = {
      {"cell = ", "cell = 5",  // micrometres
       "NN:8: domain.cell: found 5 m, allowed up to a quarter of domain.size, here 0.0002 m; "
       "10 um are 10e-6"},
      {"end = ", "end = 500",  // nanoseconds
       "NN:7: time.end: found 500 s, allowed up to 1e9 times output.beat = 5 s; 100 ns are 100e-9"},
      {"porosity = ", "porosity = 20",  // per cent
       "NN:12: sample.porosity: found a void fraction of 20, allowed a void fraction > 0 and <= "
       "0.65 "
       "with kind = \"random_voids\""},
      {"porosity = ", "porosty = 0.2",
       "NN:1: sample.porosty: unknown key, allowed kind, material, "},
      {"velocity = 1100", "velocity = \"1100 m/s\"",
       "NN:12: loading.velocity: found \"1100 m/s\", allowed a number >= 0 (m/s)"},
      {"size = ", "size = [0.8e-3, 1.803e-3]",
       "NN:8: domain.size: found 0.001803 m along y, allowed whole multiples of domain.cell = "
       "4e-06 m"},
      {"kind = ", "kind = random_voids",
       "NN:8: not valid TOML: Error while parsing value: could not determine value type; a text "
       "stands in quotes"},
      {"material = ", "material = \"aluminum\"",
       "NN:12: sample.material: found \"aluminum\", allowed \"aluminium\", did you mean "
       "\"aluminium\"?"},
      {"low = ", "low = \"Wall\"",
       "NN:7: boundary.low.kind: found \"Wall\", allowed \"wall\", \"free\" or \"symmetry\", did "
       "you "
       "mean \"wall\"?"},
      {"density = ", "", "18:1: material.0.density: missing, give a number > 0 (kg/m^3)"},
      {"snapshot = ", "snapshot = 12e-9",
       "NN:12: output.snapshot: found 1.2e-08 s, allowed 0 or whole multiples of output.beat = "
       "5e-09 "
       "s"},
      {"thresholds = ", "thresholds = [900, 600]",
       "NN:20: morphology.thresholds: found 600, allowed numbers in ascending order, here > 900"},
  };
  for (const Mistake& mistake : mistakes) expect_message(mistake);
}

}  // namespace
}  // namespace poreshock
