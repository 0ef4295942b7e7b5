// Arrays of numbers, values per axis and thresholds.
#include <algorithm>
#include <cmath>

#include "poreshock/scene/levels.hpp"
#include "toml_reader.hpp"

namespace poreshock::scene_text {
namespace {

const NumberRule level_rule{any_number, "", "", Need::required};

/// Keys of thresholds themselves, and so no name of a field.
bool is_levels_key(std::string_view key) {
  return key == "from" || key == "to" || key == "step" || key == "quantiles";
}

}  // namespace

void TomlReader::numbers(const char* key, Triple& value, int& count,
                         std::initializer_list<int> counts, const NumberRule& rule) {
  std::string allowed = "an array of ";
  for (const int n : counts) allowed += (n == *counts.begin() ? "" : " or ") + std::to_string(n);
  allowed = allowed_numbers(allowed + (*(counts.end() - 1) == 1 ? " number" : " numbers"), rule);
  const toml::node* node = find(key, rule.need, allowed);
  if (node == nullptr) return;
  const toml::array* array = node->as_array();
  const int size = array != nullptr ? static_cast<int>(array->size()) : 0;
  if (std::find(counts.begin(), counts.end(), size) == counts.end()) {
    return refuse(*node, key, allowed);
  }
  count = size;
  for (int i = 0; i < size; ++i) read_number(*array->get(i), key, rule, value[i]);
}

void TomlReader::vector(const char* key, Triple& value, int count, const NumberRule& rule) {
  // With a wrong domain.size the dimension is a guess: then both counts are taken.
  if (has_problem(report_, "domain.size")) return numbers(key, value, count, {2, 3}, rule);
  numbers(key, value, count, {count}, rule);
}

void TomlReader::points(const char* key, std::vector<Triple>& value, const NumberRule& rule) {
  const std::string allowed =
      allowed_numbers("at least 3 points, each an array of 2 numbers", rule);
  const toml::node* node = find(key, rule.need, allowed);
  if (node == nullptr) return;
  const toml::array* array = node->as_array();
  if (array == nullptr || array->size() < 3) return refuse(*node, key, allowed);
  for (const toml::node& point : *array) {
    const toml::array* pair = point.as_array();
    if (pair == nullptr || pair->size() != 2) {
      refuse(point, key, "an array of 2 numbers");
      continue;
    }
    Triple& corner = value.emplace_back();
    for (int i = 0; i < 2; ++i) read_number(*pair->get(i), key, rule, corner[i]);
  }
}

const toml::array* TomlReader::one_per_axis(const toml::node& node, const std::string& key,
                                            int count, const std::string& allowed) {
  const toml::array* array = node.as_array();
  if (array != nullptr && static_cast<int>(array->size()) == count) return array;
  if (array == nullptr || !has_problem(report_, "domain.size")) {
    refuse(
        node, key,
        allowed + ", or an array with one of them per lateral axis, here " + std::to_string(count));
  }
  return nullptr;
}

void TomlReader::flags(const char* key, std::array<bool, 2>& value, int count, const Rule& rule) {
  const toml::node* node = find(key, rule.need, "true or false");
  if (node == nullptr) return;
  if (const auto* flag = node->as_boolean()) {
    for (int axis = 0; axis < count; ++axis) value[axis] = flag->get();
    return;
  }
  const toml::array* array = one_per_axis(*node, key, count, "true or false");
  for (int axis = 0; array != nullptr && axis < count; ++axis) {
    if (const auto* flag = array->get(axis)->as_boolean()) {
      value[axis] = flag->get();
    } else {
      refuse(*array->get(axis), key, "true or false");
    }
  }
}

void TomlReader::sides(const char* key, std::array<SideKind, 2>& value,
                       const std::array<bool, 2>& periodic, int count, const Rule&) {
  const Names<SideKind> names = names_of_sides();
  const std::vector<std::string> kinds = texts_of(names);
  const auto read = [&](const toml::node& node, int axis) {
    const std::vector<std::string> fixed{std::string(side_law(SideKind::periodic).name)};
    std::string name;
    if (!read_name(node, key, periodic[axis] ? fixed : kinds, name) || periodic[axis]) return;
    value[axis] = names[std::find(kinds.begin(), kinds.end(), name) - kinds.begin()].second;
  };
  for (int axis = 0; axis < count; ++axis) {
    if (periodic[axis]) value[axis] = SideKind::periodic;
  }
  const toml::node* node = find(key);
  if (node == nullptr) return;
  if (!node->is_string()) {
    const toml::array* array = one_per_axis(*node, key, count, allowed_names(kinds));
    for (int axis = 0; array != nullptr && axis < count; ++axis) read(*array->get(axis), axis);
    return;
  }
  bool used = false;
  for (int axis = 0; axis < count; ++axis) {
    if (periodic[axis]) continue;
    read(*node, axis);
    used = true;
    if (has_problem(report_, path_of(key))) return;
  }
  if (!used && node->as_string()->get() != "periodic")
    refuse(*node, key, "only with an axis for which domain.periodic is false");
}

bool TomlReader::read_list(const toml::array& array, const std::string& key,
                           std::vector<double>& levels) {
  bool good = true;
  for (const toml::node& element : array) {
    double level = 0.0;
    if (!read_number(element, key, level_rule, level)) {
      good = false;
    } else if (!levels.empty() && !(level > levels.back())) {
      refuse(element, key, "numbers in ascending order, here > " + plain_number(levels.back()));
      good = false;
    } else {
      levels.push_back(level);
    }
  }
  return good;
}

bool TomlReader::read_range(const toml::table& table, const std::string& key,
                            std::vector<double>& levels) {
  double from = 0.0;
  double to = 0.0;
  double step = 0.0;
  const std::size_t before = report_.problems.size();
  TomlReader inner(table, path_of(key), report_);
  inner.number("from", from, {any_number, "", "lowest threshold", Need::required});
  inner.number("to", to, {any_number, "", "highest threshold", Need::required});
  inner.number("step", step, {positive, "", "distance of thresholds", Need::required});
  inner.finish();
  if (report_.problems.size() > before) return false;
  if (const auto range = levels_between(from, to, step)) {
    levels = *range;
    return true;
  }
  add_problem(path_of(key),
              "found from " + plain_number(from) + " to " + plain_number(to) + " by " +
                  plain_number(step) + ", allowed to >= from and at most 65534 thresholds",
              report_);
  return false;
}

bool TomlReader::read_levels(const toml::node& node, const std::string& key,
                             std::vector<double>& levels) {
  if (const toml::table* table = node.as_table()) return read_range(*table, key, levels);
  const toml::array* array = node.as_array();
  if (array != nullptr && !array->empty() &&
      static_cast<double>(array->size()) <= most_thresholds) {
    return read_list(*array, key, levels);
  }
  refuse(node, key, "1 to 65534 numbers in ascending order, or {from = , to = , step = }");
  return false;
}

bool TomlReader::read_thresholds(const toml::node& node, const std::string& key,
                                 MorphologyField& field) {
  const toml::table* table = node.as_table();
  if (table == nullptr || !table->contains("quantiles")) {
    return read_levels(node, key, field.thresholds);
  }
  const std::size_t before = report_.problems.size();
  TomlReader inner(*table, path_of(key), report_);
  if (inner.read_levels(*inner.find("quantiles"), "quantiles", field.quantiles)) {
    const double wrong =
        field.quantiles.front() < 0.0 ? field.quantiles.front() : field.quantiles.back();
    if (wrong < 0.0 || wrong > 1.0) {
      add_problem(inner.path_of("quantiles"),
                  "found " + plain_number(wrong) + ", allowed shares of the material from 0 to 1",
                  report_);
    }
  }
  inner.finish();
  return report_.problems.size() == before;
}

bool TomlReader::read_hot_spots(const toml::node& node, const std::string& key,
                                MorphologyField& field) {
  return read_levels(node, key, field.hot_spots);
}

void TomlReader::read_levels_by_field(const toml::node& node, const std::string& key, Need each,
                                      ReadLevels read, std::vector<MorphologyField>& fields) {
  const toml::table* table = node.as_table();
  const bool by_field =
      table != nullptr && std::none_of(table->begin(), table->end(),
                                       [](auto&& e) { return is_levels_key(e.first.str()); });
  if (by_field) {
    TomlReader inner(*table, path_of(key), report_);
    if (has_problem(report_, path_of("fields"))) inner.skip_unknown();
    for (MorphologyField& field : fields) {
      const toml::node* own = inner.find(field.name.c_str(), each,
                                         "its thresholds, or take it out of morphology.fields");
      if (own != nullptr) (inner.*read)(*own, field.name, field);
    }
    inner.finish();
  } else if (fields.size() == 1) {
    (this->*read)(node, key, fields[0]);
  } else if (!has_problem(report_, path_of("fields"))) {
    add_problem(path_of(key),
                fields.empty() ? "found thresholds, but morphology.fields names no field"
                               : "found thresholds of one field, allowed a table by field name, "
                                 "because morphology.fields names " +
                                     std::to_string(fields.size()),
                report_);
  }
}

void TomlReader::thresholds(const char* key, const std::vector<std::string>& fields,
                            std::vector<MorphologyField>& value, const Rule&) {
  value.clear();
  for (const std::string& field : fields) value.push_back({field});
  const Need need = fields.empty() ? Need::optional : Need::required;
  const toml::node* node = find(
      key, need,
      "numbers in ascending order, {from = , to = , step = } or {quantiles = }, by field name if "
      "several");
  if (node == nullptr) return;
  read_levels_by_field(*node, key, Need::required, &TomlReader::read_thresholds, value);
}

void TomlReader::hot_spots(const char* key, std::vector<MorphologyField>& fields, const Rule&) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  read_levels_by_field(*node, key, Need::optional, &TomlReader::read_hot_spots, fields);
}

}  // namespace poreshock::scene_text
