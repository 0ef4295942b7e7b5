#pragma once
// Writes one TOML table, every key with its unit and prose as a comment.

#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "poreshock/scene/scene.hpp"
#include "rules.hpp"

namespace poreshock::scene_text {

/// The writing counterpart of TomlReader: the same members, which take values instead of filling
/// them.
class TomlWriter {
 public:
  explicit TomlWriter(std::string path = "") : path_(std::move(path)) {}

  void number(const char* key, double value, const NumberRule& rule);
  void number(const char* key, const std::optional<double>& value, const NumberRule& rule);
  void whole(const char* key, std::int64_t value, const NumberRule& rule);
  void flag(const char* key, bool value, const Rule& rule);
  void text(const char* key, const std::string& value, const Rule& rule);
  bool name(const char* key, const std::string& value, const std::vector<std::string>& allowed,
            const Rule& rule);
  void names(const char* key, const std::vector<std::string>& value,
             const std::vector<std::string>& allowed, const Rule& rule);
  void numbers(const char* key, const Triple& value, int count, std::initializer_list<int> counts,
               const NumberRule& rule);
  void vector(const char* key, const Triple& value, int count, const NumberRule& rule);
  void points(const char* key, const std::vector<Triple>& value, const NumberRule& rule);
  void flags(const char* key, const std::array<bool, 2>& value, int count, const Rule& rule);
  void sides(const char* key, const std::array<SideKind, 2>& value,
             const std::array<bool, 2>& periodic, int count, const Rule& rule);
  void thresholds(const char* key, const std::vector<std::string>& names,
                  const std::vector<MorphologyField>& value, const Rule& rule);
  void hot_spots(const char* key, const std::vector<MorphologyField>& fields, const Rule& rule);

  template <typename Value>
  void fallback(const Value&, const Value&) {}
  void skip_unknown() {}
  bool gives_any(std::initializer_list<const char*>) const { return true; }

  template <typename Visit>
  void table(const char* key, const Rule& rule, Visit visit) {
    TomlWriter inner(path_of(key));
    visit(inner);
    add_section(path_of(key), false, rule.about, inner);
  }

  template <typename Visit>
  void table_or_text(const char* key, const char*, const Rule& rule, Visit visit) {
    TomlWriter inner;
    visit(inner);
    add(key, inner.inline_text(), rule.about);
  }

  template <typename Item, typename Visit>
  void tables(const char* key, std::vector<Item>& items, const Rule& rule, Visit visit) {
    for (Item& item : items) {
      TomlWriter inner(path_of(key));
      visit(inner, item);
      add_section(path_of(key), true, rule.about, inner);
    }
  }

  /// All keys, then all tables.
  std::string document() const;

 private:
  struct Entry {
    std::string key;
    std::string value;
    std::string comment;
  };

  std::string path_of(const std::string& key) const;
  void add(const std::string& key, const std::string& value, const std::string& comment);
  void add_section(const std::string& path, bool repeated, const std::string& about,
                   const TomlWriter& inner);
  void add_levels(const char* key, std::vector<double> MorphologyField::*levels,
                  const std::vector<MorphologyField>& fields, const Rule& rule);
  std::string inline_text() const;

  std::string path_;
  std::vector<Entry> entries_;
  std::string sections_;
};

}  // namespace poreshock::scene_text
