#include "toml_reader.hpp"

#include <algorithm>

namespace poreshock::scene_text {
namespace {

/// What a node holds, as a message shows it.
std::string found_text(const toml::node& node) {
  if (const auto* text = node.as_string()) return '"' + text->get() + '"';
  if (const auto* number = node.as_integer()) return std::to_string(number->get());
  if (const auto* number = node.as_floating_point()) return number_text(number->get());
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  if (const auto* array = node.as_array()) {
    return "an array of " + std::to_string(array->size());
  }
  return node.is_table() ? "a table" : "a date or time";
}

}  // namespace

std::string TomlReader::path_of(const std::string& key) const {
  return path_.empty() ? key : path_ + "." + key;
}

Origin TomlReader::origin_of(const toml::node& node) {
  const toml::source_region& source = node.source();
  return {source.path ? *source.path : std::string("scene"), source.begin.line,
          source.begin.column};
}

const toml::node* TomlReader::find(const std::string& key) {
  known_.push_back(key);
  const toml::node* node = table_.get(key);
  if (short_node_ != nullptr && key == short_key_) node = short_node_;
  if (node != nullptr) report_.origins[path_of(key)] = origin_of(*node);
  return node;
}

const toml::node* TomlReader::find(const char* key, Need need, const std::string& allowed) {
  const toml::node* node = find(key);
  if (node == nullptr && need == Need::required) {
    add_problem(path_of(key), "missing, give " + allowed, report_);
  }
  return node;
}

void TomlReader::refuse(const toml::node& node, const std::string& key,
                        const std::string& allowed) {
  add_problem_at(origin_of(node), path_of(key),
                 "found " + found_text(node) + ", allowed " + allowed, report_);
}

bool TomlReader::is_table(const toml::node& node, const std::string& key) {
  if (node.is_table()) return true;
  refuse(node, key, "a table [" + path_of(key) + "]");
  return false;
}

bool TomlReader::is_array_of_tables(const toml::node& node, const std::string& key) {
  const toml::array* array = node.as_array();
  const auto holds_table = [](const toml::node& element) { return element.is_table(); };
  if (array != nullptr && std::all_of(array->begin(), array->end(), holds_table)) return true;
  refuse(node, key, "tables that each begin with [[" + path_of(key) + "]]");
  return false;
}

void TomlReader::finish() {
  if (skips_unknown_) return;
  for (const auto& [key, node] : table_) {
    const std::string name(key.str());
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    std::string allowed;
    for (const std::string& other : known_) allowed += (allowed.empty() ? "" : ", ") + other;
    const bool table = path_.empty() && (node.is_table() || node.is_array_of_tables());
    const toml::source_region& source = key.source();
    const Origin origin{source.path ? *source.path : std::string("scene"), source.begin.line,
                        source.begin.column};
    add_problem_at(origin, path_of(name),
                   std::string(table ? "unknown table" : "unknown key") + ", allowed " + allowed +
                       hint(name, known_),
                   report_);
  }
}

bool TomlReader::gives_any(std::initializer_list<const char*> keys) const {
  return std::any_of(keys.begin(), keys.end(),
                     [&](const char* key) { return table_.contains(key); });
}

bool TomlReader::read_number(const toml::node& node, const std::string& key, const NumberRule& rule,
                             double& value) {
  const std::optional<double> number =
      node.is_number() ? node.value<double>() : std::optional<double>();
  if (number && in_range(rule.range, *number)) {
    value = *number;
    return true;
  }
  refuse(node, key, allowed_numbers("a number", rule));
  return false;
}

void TomlReader::number(const char* key, double& value, const NumberRule& rule) {
  const toml::node* node = find(key, rule.need, allowed_numbers("a number", rule));
  if (node != nullptr) read_number(*node, key, rule, value);
}

void TomlReader::number(const char* key, std::optional<double>& value, const NumberRule& rule) {
  const toml::node* node = find(key, rule.need, allowed_numbers("a number", rule));
  double number = 0.0;
  if (node != nullptr && read_number(*node, key, rule, number)) value = number;
}

void TomlReader::whole(const char* key, std::int64_t& value, const NumberRule& rule) {
  const std::string allowed = allowed_numbers("a whole number", rule);
  const toml::node* node = find(key, rule.need, allowed);
  if (node == nullptr) return;
  const auto* number = node->as_integer();
  if (number != nullptr && in_range(rule.range, static_cast<double>(number->get()))) {
    value = number->get();
  } else {
    refuse(*node, key, allowed);
  }
}

void TomlReader::flag(const char* key, bool& value, const Rule& rule) {
  const toml::node* node = find(key, rule.need, "true or false");
  if (node == nullptr) return;
  if (const auto* flag = node->as_boolean()) {
    value = flag->get();
  } else {
    refuse(*node, key, "true or false");
  }
}

void TomlReader::text(const char* key, std::string& value, const Rule& rule) {
  const bool required = rule.need == Need::required;
  const std::string allowed = required ? "a text that is not empty" : "a text";
  const toml::node* node = find(key, rule.need, allowed);
  if (node == nullptr) return;
  const auto* text = node->as_string();
  if (text != nullptr && !(required && text->get().empty())) {
    value = text->get();
  } else {
    refuse(*node, key, allowed);
  }
}

bool TomlReader::read_name(const toml::node& node, const std::string& key,
                           const std::vector<std::string>& allowed, std::string& value) {
  const auto* text = node.as_string();
  const bool known =
      text != nullptr &&
      (allowed.empty() || std::find(allowed.begin(), allowed.end(), text->get()) != allowed.end());
  if (!known) {
    refuse(node, key,
           allowed.empty()
               ? std::string("a name")
               : allowed_names(allowed) + (text != nullptr ? hint(text->get(), allowed) : ""));
    return false;
  }
  value = text->get();
  return true;
}

bool TomlReader::name(const char* key, std::string& value, const std::vector<std::string>& allowed,
                      const Rule& rule) {
  const toml::node* node = find(key, rule.need, allowed_names(allowed));
  if (node == nullptr) return rule.need == Need::optional;
  return read_name(*node, key, allowed, value);
}

void TomlReader::names(const char* key, std::vector<std::string>& value,
                       const std::vector<std::string>& allowed, const Rule& rule) {
  const std::string wanted = "an array of names out of " + allowed_names(allowed);
  const toml::node* node = find(key, rule.need, wanted);
  if (node == nullptr) return;
  const toml::array* array = node->as_array();
  if (array == nullptr) return refuse(*node, key, wanted);
  value.clear();
  for (const toml::node& element : *array) {
    std::string name;
    if (!read_name(element, key, allowed, name)) continue;
    if (std::find(value.begin(), value.end(), name) == value.end()) {
      value.push_back(name);
    } else {
      refuse(element, key, "each name once");
    }
  }
}

}  // namespace poreshock::scene_text
