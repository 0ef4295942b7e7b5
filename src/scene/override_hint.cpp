#include "override_hint.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <regex>

namespace poreshock::scene_text {
namespace {

const std::string number = "([-+]?[0-9][-+0-9.eE_]*)";

/// FROM:TO:STEP, or FROM:TO whose step the user has yet to choose, as tables.
std::string with_ranges(const std::string& value) {
  const std::regex whole(number + "(?::|\\.\\.)" + number + "(?::|\\.\\.)" + number);
  const std::regex open("^\\s*" + number + "(?::|\\.\\.)" + number + "\\s*$");
  const std::string stepped = std::regex_replace(value, whole, "{from = $1, to = $2, step = $3}");
  return std::regex_replace(stepped, open, "{from = $1, to = $2, step = 10}");
}

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Takes a value apart and puts quotes around its words.
class Quoter {
 public:
  explicit Quoter(const std::string& value) : value_(value) {}

  std::string quoted() {
    while (at_ < value_.size()) {
      const char c = value_[at_];
      if (c == '"' || c == '\'') {
        take(std::min(value_.size(), value_.find(c, at_ + 1)) + 1 - at_);
      } else if (is_letter(c) || c == '/' || c == '.') {
        word();
      } else if (std::isdigit(static_cast<unsigned char>(c)) != 0) {
        take(std::max<std::size_t>(1, length()));  // with its exponent
      } else {
        if (c == '{') ++tables_;
        if (c == '}') --tables_;
        take(1);
      }
    }
    return result_;
  }

 private:
  /// Letters until something of TOML; an equals sign is that in a table only.
  std::size_t length() const {
    const std::size_t end = value_.find_first_of(tables_ > 0 ? "=,[]{}\"'" : ",[]{}\"'", at_);
    const std::string word = value_.substr(at_, std::min(end, value_.size()) - at_);
    return word.find_last_not_of(' ') + 1;
  }

  void take(std::size_t count) {
    result_.append(value_, at_, count);
    at_ += count;
  }

  void word() {
    const std::string text = value_.substr(at_, length());
    const std::size_t next = value_.find_first_not_of(' ', at_ + text.size());
    const bool key = tables_ > 0 && next != std::string::npos && value_[next] == '=';
    const bool name = text == "true" || text == "false" || text == "inf" || text == "nan";
    result_ += key || name ? text : '"' + text + '"';
    at_ += text.size();
  }

  const std::string& value_;
  std::size_t at_ = 0;
  int tables_ = 0;
  std::string result_;
};

bool is_toml(const std::string& text) {
  try {
    return !toml::parse(text).empty();
  } catch (const toml::parse_error&) {
    return false;
  }
}

}  // namespace

std::string override_hint(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string key = text.substr(0, equals + 1);
  const std::string value = text.substr(equals + 1);
  // A range of small numbers is a time of the day to TOML.
  const bool quotes = value.find_first_of("\"'") != std::string::npos;
  if (is_toml(text) && (quotes || with_ranges(value) == value)) return "";
  // Prose may hold anything.
  if (key.ends_with("title=") || key.ends_with("image=")) {
    return "found a text without quotes; write --set '" + key + '"' + value + "\"'";
  }
  const std::string tables = with_ranges(value);
  const bool range = tables != value;
  if (range && key.find("thresholds") == std::string::npos &&
      key.find("hot_spots") == std::string::npos) {
    return "found a range, allowed one value; tools/sweep runs a scene with several";
  }
  const std::string quoted = Quoter(tables).quoted();
  std::string written = key + quoted;
  std::string what = range ? "found a range, allowed {from, to, step}" : "";
  const auto add = [&](const char* found) { what.append(what.empty() ? "" : "; ").append(found); };
  if (quoted != tables) add("found a text without quotes");
  if (!is_toml(written)) {
    written = key + '[' + quoted + ']';
    add("found a list without brackets");
  }
  return is_toml(written) ? what + "; write --set '" + written + "'" : "";
}

}  // namespace poreshock::scene_text
