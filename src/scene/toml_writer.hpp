#pragma once
// Writes one TOML table, every key with its unit and prose as a comment, or lists its keys.

#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "poreshock/scene/keys.hpp"
#include "poreshock/scene/scene.hpp"
#include "rules.hpp"

namespace poreshock::scene_text {

/// The writing counterpart of TomlReader: the same members, which take values instead of filling
/// them. One that was given a list adds the keys to it instead of writing them.
class TomlWriter {
 public:
  explicit TomlWriter(std::string path = "") : path_(std::move(path)) {}
  /// Lists the keys of a table, each once. Keys on which others depend take their variant-th
  /// allowed name; a table inside is visited once per variant.
  TomlWriter(std::string path, bool repeated, std::size_t variant, std::vector<SceneKey>& keys)
      : path_(std::move(path)), repeated_(repeated), variant_(variant), keys_(&keys) {}

  void number(const char* key, double value, const NumberRule& rule);
  void number(const char* key, const std::optional<double>& value, const NumberRule& rule);
  void whole(const char* key, std::int64_t value, const NumberRule& rule);
  void flag(const char* key, bool value, const Rule& rule);
  void text(const char* key, const std::string& value, const Rule& rule);
  bool name(const char* key, std::string& value, const std::vector<std::string>& allowed,
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

  /// A default that follows from other keys is not a number to list.
  template <typename Value>
  void fallback(const Value&, const Value&) {
    follows_ = true;
  }
  void skip_unknown() {}
  bool gives_any(std::initializer_list<const char*>) const { return true; }

  template <typename Visit>
  void table(const char* key, const Rule& rule, Visit visit) {
    if (keys_ != nullptr) return list_table(key, false, visit);
    TomlWriter inner(path_of(key));
    visit(inner);
    add_section(path_of(key), false, rule.about, inner);
  }

  template <typename Visit>
  void table_or_text(const char* key, const char*, const Rule& rule, Visit visit) {
    if (keys_ != nullptr) return list_table(key, false, visit);
    TomlWriter inner;
    visit(inner);
    entries_.push_back({key, inner.inline_text(), rule.about});
  }

  template <typename Item, typename Visit>
  void tables(const char* key, std::vector<Item>& items, const Rule& rule, Visit visit) {
    if (keys_ != nullptr) {
      Item item{};
      return list_table(key, true, [&](TomlWriter& inner) { visit(inner, item); });
    }
    for (Item& item : items) {
      TomlWriter inner(path_of(key));
      visit(inner, item);
      add_section(path_of(key), true, rule.about, inner);
    }
  }

  /// All keys, then all tables.
  std::string document() const;

 private:
  static constexpr std::size_t most_variants = 4;

  struct Entry {
    std::string key;
    std::string value;
    std::string comment;
  };

  /// A key in words: its value as TOML, its default in a list of keys and what is allowed.
  struct Words {
    std::string value;
    std::string standard;
    std::string allowed;
  };

  std::string path_of(const std::string& key) const;
  void add(const std::string& key, Words words, const NumberRule& rule);
  void add(const std::string& key, Words words, const Rule& rule);
  void list(const std::string& key, const Words& words, const std::string& about, Need need);
  void add_section(const std::string& path, bool repeated, const std::string& about,
                   const TomlWriter& inner);
  void add_levels(const char* key, std::string (*levels)(const MorphologyField&),
                  const std::vector<MorphologyField>& fields, const Rule& rule);
  std::string inline_text() const;

  template <typename Visit>
  void list_table(const char* key, bool repeated, Visit visit) {
    for (std::size_t variant = 0; variant < most_variants; ++variant) {
      TomlWriter inner(path_of(key), repeated, variant, *keys_);
      visit(inner);
    }
  }

  std::string path_;
  std::vector<Entry> entries_;
  std::string sections_;
  bool repeated_ = false;  ///< this and what follows only where it lists
  std::size_t variant_ = 0;
  bool follows_ = false;
  std::vector<SceneKey>* keys_ = nullptr;
};

}  // namespace poreshock::scene_text
