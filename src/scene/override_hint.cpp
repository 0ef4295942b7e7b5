#include "override_hint.hpp"

#include <toml++/toml.h>

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

bool ends_word(char c) {
  return std::string("=,[]{}\"'").find(c) != std::string::npos;
}

/// Quotes around every word that is neither quoted, nor a key of a table, nor a name of TOML.
std::string with_quotes(const std::string& value) {
  std::string result;
  char quote = 0;
  for (std::size_t i = 0; i < value.size();) {
    const char c = value[i];
    const bool within = quote != 0;
    if (within || !(is_letter(c) || c == '/' || c == '.')) {
      if (c == quote) {
        quote = 0;
      } else if (!within && (c == '"' || c == '\'')) {
        quote = c;
      }
      // A number takes its exponent along.
      const std::size_t first = i++;
      if (!within && std::isdigit(static_cast<unsigned char>(c)) != 0) {
        while (i < value.size() && !ends_word(value[i]) && value[i] != ' ') ++i;
      }
      result.append(value, first, i - first);
      continue;
    }
    std::size_t end = i;
    while (end < value.size() && !ends_word(value[end])) ++end;
    std::string word = value.substr(i, end - i);
    const std::size_t blanks = word.size() - (word.find_last_not_of(' ') + 1);
    word.resize(word.size() - blanks);
    const bool key = end < value.size() && value[end] == '=';
    const bool name = word == "true" || word == "false" || word == "inf" || word == "nan";
    result.append(key || name ? word : '"' + word + '"').append(blanks, ' ');
    i = end;
  }
  return result;
}

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
  const std::string tables = with_ranges(value);
  // A range of small numbers reads as a time of the day.
  if (tables == value && is_toml(text)) return "";
  const std::string quoted = with_quotes(tables);
  std::string written = key + quoted;
  std::string what;
  if (tables != value) what = "found a range, allowed {from, to, step}";
  if (quoted != tables) {
    what.append(what.empty() ? "" : "; ").append("found a text without quotes");
  }
  if (!is_toml(written)) {
    written = key + '[' + quoted + ']';
    what.append(what.empty() ? "" : "; ").append("found a list without brackets");
  }
  if (!is_toml(written)) return "";
  return what + "; write --set '" + written + "'";
}

}  // namespace poreshock::scene_text
