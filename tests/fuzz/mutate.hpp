#pragma once
// Changes to texts and files that a user, an editor or a broken disk could make, from one seed.

#include <array>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace poreshock::test {

/// Number of cases: an environment variable, or `few` without it.
inline std::uint64_t fuzz_count(const char* variable, std::uint64_t few) {
  const char* text = std::getenv(variable);
  return text != nullptr ? std::strtoull(text, nullptr, 10) : few;
}

class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}

  /// A number from 0 to count - 1.
  std::size_t below(std::size_t count) { return count == 0 ? 0 : random_() % count; }

  template <class List>
  const auto& pick(const List& list) {
    return list[below(list.size())];
  }

  /// One to four changes to a scene; `other` lends lines.
  std::string scene(std::string text, const std::string& other) {
    const std::size_t changes = 1 + below(4);
    for (std::size_t i = 0; i < changes; ++i) {
      switch (below(8)) {
        case 0:
        case 1:
        case 2:
        case 3:
          replace_value(text);
          break;
        case 4:
          change_lines(text, other);
          break;
        case 5:
          change_bytes(text);
          break;
        case 6:
          replace_digits(text);
          break;
        default:
          replace_word(text);
      }
    }
    return text;
  }

  /// Changes bytes or numbers of the text with which a file begins.
  void beginning(std::string& bytes, std::size_t length) {
    std::string text = bytes.substr(0, length);
    below(2) == 0 ? change_bytes(text) : replace_digits(text);
    bytes.replace(0, length, text);
  }

  /// Flips, cuts, lengthens or fills a part of a file.
  void file(std::string& bytes) {
    switch (below(6)) {
      case 0:
        bytes.resize(below(bytes.size()));
        break;
      case 1:
        bytes.append(1 + below(5000), static_cast<char>(below(256)));
        break;
      case 2: {
        const std::size_t at = below(bytes.size());
        const std::size_t end = std::min(bytes.size(), at + 1 + below(4096));
        const char byte = static_cast<char>(below(256));
        bool changed = false;
        for (std::size_t i = at; i < end; ++i) {
          changed = changed || bytes[i] != byte;
          bytes[i] = byte;
        }
        if (!changed) bytes[at] = static_cast<char>(bytes[at] ^ 1);
        break;
      }
      default:
        bytes[below(bytes.size())] ^= static_cast<char>(1 << below(8));
    }
  }

 private:
  static constexpr std::array<std::string_view, 42> values = {"nan",
                                                              "inf",
                                                              "-inf",
                                                              "0",
                                                              "0.0",
                                                              "-0.0",
                                                              "1",
                                                              "-1",
                                                              "1e308",
                                                              "-1e308",
                                                              "1e-308",
                                                              "5e-324",
                                                              "1e400",
                                                              "9223372036854775807",
                                                              "-9223372036854775808",
                                                              "99999999999999999999",
                                                              "2147483648",
                                                              "4294967296",
                                                              "1e-30",
                                                              "1e30",
                                                              "1e9",
                                                              "1e-9",
                                                              "0x10",
                                                              "true",
                                                              "false",
                                                              "\"\"",
                                                              "\"wall\"",
                                                              "\"none\"",
                                                              "\"\\u0000\"",
                                                              "[]",
                                                              "[0]",
                                                              "[1e-4, 1e-4, 1e-4]",
                                                              "[nan, nan]",
                                                              "{}",
                                                              "{kind = \"wall\"}",
                                                              "1979-05-27",
                                                              "[[]]",
                                                              "[1, \"a\"]",
                                                              "'literal'",
                                                              "0.5",
                                                              "1e-6",
                                                              "3"};
  static constexpr std::array<std::string_view, 23> words = {
      "wall",      "free",     "symmetry",   "solid", "random_voids", "none",  "linear", "gimp",
      "quadratic", "cubic",    "flip",       "apic",  "pic",          "aflip", "iapic",  "polypic",
      "polyflip",  "ipolypic", "lagrangian", "paper", "conserving",   "disc",  "polygon"};

  static std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
  }

  static std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text.append(line).append("\n");
    return text;
  }

  void replace_value(std::string& text) {
    std::vector<std::string> lines = lines_of(text);
    for (int tries = 0; tries < 20 && !lines.empty(); ++tries) {
      std::string& line = lines[below(lines.size())];
      const std::size_t equals = line.find('=');
      if (equals == std::string::npos || line.starts_with('#')) continue;
      line = line.substr(0, equals + 1) + " " + std::string(pick(values));
      break;
    }
    text = joined(lines);
  }

  void change_lines(std::string& text, const std::string& other) {
    std::vector<std::string> lines = lines_of(text);
    const std::vector<std::string> lent = lines_of(other);
    if (lines.empty() || lent.empty()) return;
    const auto at = lines.begin() + static_cast<std::ptrdiff_t>(below(lines.size()));
    switch (below(4)) {
      case 0:
        lines.erase(at);
        break;
      case 1:
        lines.insert(at, std::string(*at));
        break;
      case 2:
        lines.insert(at, pick(lent));
        break;
      default:
        std::swap(*at, lines[below(lines.size())]);
    }
    text = joined(lines);
  }

  void change_bytes(std::string& text) {
    if (text.empty()) return;
    const std::size_t at = below(text.size());
    switch (below(5)) {
      case 0:
        text[at] = static_cast<char>(below(256));
        break;
      case 1:
        text.erase(at, 1 + below(20));
        break;
      case 2:
        text.insert(at, 1 + below(3), "[]{}=\"'#.,\n\\\0e-"[below(16)]);
        break;
      case 3:
        text.resize(at);
        break;
      default:
        text.insert(at, std::string(1 + below(2000), "[{(\""[below(4)]));
    }
  }

  void replace_digits(std::string& text) {
    const std::size_t start = below(text.size());
    const std::size_t at = text.find_first_of("0123456789", start);
    if (at == std::string::npos) return;
    const std::size_t end = std::min(text.find_first_not_of("0123456789.", at), text.size());
    text.replace(at, end - at,
                 below(2) == 0 ? std::to_string(below(1000)) : std::string(pick(values)));
  }

  void replace_word(std::string& text) {
    const std::size_t at = text.find('"', below(text.size()));
    if (at == std::string::npos) return;
    const std::size_t end = text.find('"', at + 1);
    if (end == std::string::npos) return;
    text.replace(at + 1, end - at - 1, pick(words));
  }

  std::mt19937_64 random_;
};

}  // namespace poreshock::test
