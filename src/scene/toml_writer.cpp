#include "toml_writer.hpp"

#include <algorithm>
#include <cstdio>

namespace poreshock::scene_text {
namespace {

constexpr std::size_t comment_column = 44;
constexpr std::size_t numbers_per_line = 10;

std::string quoted_text(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += std::string("\\") + c;
    } else if (code < 0x20 || code == 0x7f) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04X", code);
      result += escape;
    } else {
      result += c;
    }
  }
  return result + '"';
}

std::string flag_text(bool flag) {
  return flag ? "true" : "false";
}

/// "unit, about", either of which may be empty.
std::string comment_of(const NumberRule& rule) {
  if (rule.unit.empty()) return rule.about;
  return rule.about.empty() ? rule.unit : rule.unit + ", " + rule.about;
}

/// [a, b, ...] of count texts; long lists go over several lines.
template <typename Text>
std::string list_text(std::size_t count, Text text) {
  const bool is_long = count > numbers_per_line;
  std::string result = "[";
  for (std::size_t i = 0; i < count; ++i) {
    if (is_long && i % numbers_per_line == 0) result += "\n  ";
    result += text(i);
    if (i + 1 < count) result += (is_long && (i + 1) % numbers_per_line == 0) ? "," : ", ";
  }
  return result + (is_long ? "\n]" : "]");
}

/// Empty without levels.
std::string levels_text(const std::vector<double>& levels) {
  if (levels.empty()) return "";
  return list_text(levels.size(), [&](std::size_t i) { return number_text(levels[i]); });
}

std::string thresholds_text(const MorphologyField& field) {
  if (field.quantiles.empty()) return levels_text(field.thresholds);
  return "{ quantiles = " + levels_text(field.quantiles) + " }";
}

std::string triple_text(const Triple& value, int count) {
  return list_text(static_cast<std::size_t>(count),
                   [&](std::size_t axis) { return number_text(value[axis]); });
}

bool governs_others(const std::string& key) {
  return key == "shape" || key == "strength" || key == "melting";
}

}  // namespace

std::string TomlWriter::path_of(const std::string& key) const {
  return path_.empty() ? key : path_ + "." + key;
}

void TomlWriter::add(const std::string& key, Words words, const NumberRule& rule) {
  if (keys_ != nullptr) return list(key, words, rule.about, rule.need);
  entries_.push_back({key, std::move(words.value), comment_of(rule)});
}

void TomlWriter::add(const std::string& key, Words words, const Rule& rule) {
  if (keys_ != nullptr) return list(key, words, rule.about, rule.need);
  entries_.push_back({key, std::move(words.value), rule.about});
}

void TomlWriter::list(const std::string& key, const Words& words, const std::string& about,
                      Need need) {
  const bool follows = std::exchange(follows_, false);
  const bool known = std::any_of(keys_->begin(), keys_->end(), [&](const SceneKey& other) {
    return other.table == path_ && other.key == key;
  });
  if (known) return;
  const std::string standard =
      need == Need::required ? "required" : (follows ? "" : words.standard);
  keys_->push_back({path_, repeated_, key, standard, words.allowed, about});
}

void TomlWriter::add_section(const std::string& path, bool repeated, const std::string& about,
                             const TomlWriter& inner) {
  sections_ += "\n";
  if (!about.empty()) sections_ += "# " + about + "\n";
  sections_ += repeated ? "[[" : "[";
  sections_ += path;
  sections_ += repeated ? "]]\n" : "]\n";
  sections_ += inner.document();
}

std::string TomlWriter::inline_text() const {
  std::string text;
  for (const Entry& entry : entries_) {
    text += (text.empty() ? "{ " : ", ") + entry.key + " = " + entry.value;
  }
  return text + " }";
}

std::string TomlWriter::document() const {
  std::string text;
  for (const Entry& entry : entries_) {
    std::string line = entry.key;
    line.append(" = ").append(entry.value);
    if (entry.comment.empty()) {
      text += line + "\n";
    } else if (line.find('\n') != std::string::npos) {
      text += "# " + entry.comment + "\n" + line + "\n";
    } else {
      if (line.size() < comment_column) line.resize(comment_column, ' ');
      text += line + "  # " + entry.comment + "\n";
    }
  }
  return text + sections_;
}

void TomlWriter::number(const char* key, double value, const NumberRule& rule) {
  add(key, {number_text(value), plain_number(value), allowed_numbers("a number", rule)}, rule);
}

void TomlWriter::number(const char* key, const std::optional<double>& value,
                        const NumberRule& rule) {
  if (value) return number(key, *value, rule);
  // TOML has no empty value: a key that is not set becomes a comment.
  const std::string name = keys_ != nullptr ? key : std::string("# ") + key;
  add(name, {"", "", allowed_numbers("a number", rule)}, rule);
}

void TomlWriter::whole(const char* key, std::int64_t value, const NumberRule& rule) {
  const std::string text = std::to_string(value);
  add(key, {text, text, allowed_numbers("a whole number", rule)}, rule);
}

void TomlWriter::flag(const char* key, bool value, const Rule& rule) {
  add(key, {flag_text(value), flag_text(value), "true or false"}, rule);
}

void TomlWriter::text(const char* key, const std::string& value, const Rule& rule) {
  add(key, {quoted_text(value), "", "a text"}, rule);
}

bool TomlWriter::name(const char* key, std::string& value, const std::vector<std::string>& allowed,
                      const Rule& rule) {
  add(key,
      {quoted_text(value), value.empty() ? "" : quoted_text(value),
       allowed.empty() ? "a name" : allowed_names(allowed)},
      rule);
  if (keys_ != nullptr && governs_others(key)) {
    value = allowed[std::min(variant_, allowed.size() - 1)];
  }
  return true;
}

void TomlWriter::names(const char* key, const std::vector<std::string>& value,
                       const std::vector<std::string>& allowed, const Rule& rule) {
  add(key,
      {list_text(value.size(), [&](std::size_t i) { return quoted_text(value[i]); }), "",
       "an array of names out of " + allowed_names(allowed)},
      rule);
}

void TomlWriter::numbers(const char* key, const Triple& value, int count,
                         std::initializer_list<int>, const NumberRule& rule) {
  add(key, {triple_text(value, count), "", allowed_numbers("an array of 2 or 3 numbers", rule)},
      rule);
}

void TomlWriter::vector(const char* key, const Triple& value, int count, const NumberRule& rule) {
  add(key, {triple_text(value, count), "0", allowed_numbers("an array, one number per axis", rule)},
      rule);
}

void TomlWriter::points(const char* key, const std::vector<Triple>& value, const NumberRule& rule) {
  const auto text = [&](std::size_t i) { return triple_text(value[i], 2); };
  add(key, {list_text(value.size(), text), "", allowed_numbers("an array of points", rule)}, rule);
}

void TomlWriter::flags(const char* key, const std::array<bool, 2>& value, int count,
                       const Rule& rule) {
  const auto text = [&](std::size_t i) { return flag_text(value[i]); };
  add(key, {list_text(static_cast<std::size_t>(count), text), "false", "true or false"}, rule);
}

void TomlWriter::sides(const char* key, const std::array<SideKind, 2>& value,
                       const std::array<bool, 2>&, int count, const Rule& rule) {
  const auto text = [&](std::size_t i) {
    return allowed_names({std::string(side_law(value[i]).name)});
  };
  add(key,
      {list_text(static_cast<std::size_t>(count), text), "\"free\"",
       allowed_names(texts_of(names_of_sides()))},
      rule);
}

void TomlWriter::add_levels(const char* key, std::string (*levels)(const MorphologyField&),
                            const std::vector<MorphologyField>& fields, const Rule& rule) {
  TomlWriter inner(path_of(key));
  for (const MorphologyField& field : fields) {
    const std::string own = levels(field);
    if (!own.empty()) inner.entries_.push_back({field.name, own, ""});
  }
  if (!inner.entries_.empty()) add_section(path_of(key), false, rule.about, inner);
}

void TomlWriter::thresholds(const char* key, const std::vector<std::string>&,
                            const std::vector<MorphologyField>& value, const Rule& rule) {
  constexpr const char* allowed =
      "an array, {from = , to = , step = }, {quantiles = }, or a table of these by field";
  if (keys_ != nullptr) return list(key, {"", "", allowed}, rule.about, rule.need);
  add_levels(key, thresholds_text, value, rule);
}

void TomlWriter::hot_spots(const char* key, const std::vector<MorphologyField>& fields,
                           const Rule& rule) {
  if (keys_ != nullptr) return list(key, {"", "", "likewise"}, rule.about, rule.need);
  const auto text = [](const MorphologyField& field) { return levels_text(field.hot_spots); };
  add_levels(key, text, fields, rule);
}

}  // namespace poreshock::scene_text
