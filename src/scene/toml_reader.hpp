#pragma once
// Reads the keys of one TOML table, checks each against its rule and remembers which keys exist.
// Also in toml_lists.cpp.

#include <toml++/toml.h>

#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "poreshock/scene/scene.hpp"
#include "report.hpp"
#include "rules.hpp"

namespace poreshock::scene_text {

/// One table while it is read. Every member takes a key and fills a value when the key is there and
/// allowed; otherwise the value keeps its default and the problem goes to the report. `finish`
/// reports the keys that nothing asked for.
class TomlReader {
 public:
  TomlReader(const toml::table& table, std::string path, Report& report)
      : table_(table), path_(std::move(path)), report_(report) {}

  void number(const char* key, double& value, const NumberRule& rule);
  void number(const char* key, std::optional<double>& value, const NumberRule& rule);
  void whole(const char* key, std::int64_t& value, const NumberRule& rule);
  void flag(const char* key, bool& value, const Rule& rule);
  void text(const char* key, std::string& value, const Rule& rule);

  /// One of the allowed names (any, when none is listed); false when there is no such name.
  bool name(const char* key, std::string& value, const std::vector<std::string>& allowed,
            const Rule& rule);
  /// A list of different names.
  void names(const char* key, std::vector<std::string>& value,
             const std::vector<std::string>& allowed, const Rule& rule);

  /// An array of as many numbers as one of `counts` says; `count` is set to it.
  void numbers(const char* key, Triple& value, int& count, std::initializer_list<int> counts,
               const NumberRule& rule);
  /// An array of `count` numbers.
  void vector(const char* key, Triple& value, int count, const NumberRule& rule);
  /// A list of points in the plane, at least three.
  void points(const char* key, std::vector<Triple>& value, const NumberRule& rule);

  /// One flag for all of `count` axes or an array of one per axis.
  void flags(const char* key, std::array<bool, 2>& value, int count, const Rule& rule);
  /// One kind for all axes that are not periodic or an array of one per axis.
  void sides(const char* key, std::array<SideKind, 2>& value, const std::array<bool, 2>& periodic,
             int count, const Rule& rule);
  /// Thresholds of the named fields: a list, a range or quantiles for one field, else a table by
  /// field name.
  void thresholds(const char* key, const std::vector<std::string>& fields,
                  std::vector<MorphologyField>& value, const Rule& rule);
  /// Thresholds of hot spots, written the same way, for some or all of the fields.
  void hot_spots(const char* key, std::vector<MorphologyField>& fields, const Rule& rule);

  /// Whether the table holds any of the keys.
  bool gives_any(std::initializer_list<const char*> keys) const;

  /// Sets a default that follows from keys read before.
  template <typename Value>
  void fallback(Value& value, const Value& follows) {
    value = follows;
  }

  /// A table; without one its keys take their defaults.
  template <typename Visit>
  void table(const char* key, const Rule&, Visit visit) {
    static const toml::table empty;
    const toml::node* node = find(key);
    if (node != nullptr && !is_table(*node, key)) return;
    TomlReader inner(node != nullptr ? *node->as_table() : empty, path_of(key), report_);
    visit(inner);
    inner.finish();
  }

  /// A table, or a bare text that stands for a table with the one key `text_key`.
  template <typename Visit>
  void table_or_text(const char* key, const char* text_key, const Rule& rule, Visit visit) {
    const toml::node* node = find(key);
    if (node == nullptr || !node->is_string()) return table(key, rule, visit);
    static const toml::table empty;
    TomlReader inner(empty, path_of(key), report_);
    inner.short_key_ = text_key;
    inner.short_node_ = node;
    visit(inner);
  }

  /// An array of tables; visit(reader, item) fills each new item.
  template <typename Item, typename Visit>
  void tables(const char* key, std::vector<Item>& items, const Rule&, Visit visit) {
    const toml::node* node = find(key);
    if (node == nullptr || !is_array_of_tables(*node, key)) return;
    for (const toml::node& element : *node->as_array()) {
      const std::string path = path_of(key) + "." + std::to_string(items.size());
      report_.origins[path] = origin_of(element);
      TomlReader inner(*element.as_table(), path, report_);
      visit(inner, items.emplace_back());
      inner.finish();
    }
  }

  /// Accepts keys nothing asked for, where a wrong key hides which ones are allowed.
  void skip_unknown() { skips_unknown_ = true; }

  /// Reports every key of the table that nothing asked for.
  void finish();

 private:
  std::string path_of(const std::string& key) const;
  static Origin origin_of(const toml::node& node);
  const toml::node* find(const std::string& key);
  const toml::node* find(const char* key, Need need, const std::string& allowed);
  bool is_table(const toml::node& node, const std::string& key);
  bool is_array_of_tables(const toml::node& node, const std::string& key);
  void refuse(const toml::node& node, const std::string& key, const std::string& allowed);
  bool read_number(const toml::node& node, const std::string& key, const NumberRule& rule,
                   double& value);
  bool read_name(const toml::node& node, const std::string& key,
                 const std::vector<std::string>& allowed, std::string& value);
  const toml::array* one_per_axis(const toml::node& node, const std::string& key, int count,
                                  const std::string& allowed);
  void read_points(const toml::array& array, const std::string& key, const NumberRule& rule,
                   std::vector<Triple>& value);
  bool read_levels(const toml::node& node, const std::string& key, std::vector<double>& levels);
  bool read_list(const toml::array& array, const std::string& key, std::vector<double>& levels);
  bool read_range(const toml::table& table, const std::string& key, std::vector<double>& levels);
  bool read_thresholds(const toml::node& node, const std::string& key, MorphologyField& field);
  bool read_hot_spots(const toml::node& node, const std::string& key, MorphologyField& field);
  using ReadLevels = bool (TomlReader::*)(const toml::node&, const std::string&, MorphologyField&);
  void read_levels_by_field(const toml::node& node, const std::string& key, Need each,
                            ReadLevels read, std::vector<MorphologyField>& fields);

  const toml::table& table_;
  std::string path_;
  Report& report_;
  std::vector<std::string> known_;
  bool skips_unknown_ = false;
  std::string short_key_;
  const toml::node* short_node_ = nullptr;
};

}  // namespace poreshock::scene_text
