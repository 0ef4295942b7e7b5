#pragma once
// Lists the keys of the tables instead of reading or writing them.

#include <algorithm>
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

/// A visitor like TomlReader and TomlWriter. Keys on which others depend take their variant-th
/// allowed name; a table that holds one is visited once per variant.
class KeyLister {
 public:
  KeyLister(std::string table, bool repeated, std::size_t variant, std::vector<SceneKey>& keys)
      : table_(std::move(table)), repeated_(repeated), variant_(variant), keys_(keys) {}

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

  /// A default that follows from other keys is not a number to show.
  template <typename Value>
  void fallback(const Value&, const Value&) {
    follows_ = true;
  }
  void skip_unknown() {}
  bool gives_any(std::initializer_list<const char*>) const { return true; }

  template <typename Visit>
  void table(const char* key, const Rule&, Visit visit) {
    visit_variants(path_of(key), false, visit);
  }

  template <typename Visit>
  void table_or_text(const char* key, const char*, const Rule&, Visit visit) {
    visit_variants(path_of(key), false, visit);
  }

  template <typename Item, typename Visit>
  void tables(const char* key, std::vector<Item>&, const Rule&, Visit visit) {
    Item item{};
    visit_variants(path_of(key), true, [&](KeyLister& inner) { visit(inner, item); });
  }

 private:
  static constexpr std::size_t most_variants = 4;

  std::string path_of(const std::string& key) const {
    return table_.empty() ? key : table_ + "." + key;
  }
  void add(const std::string& key, const std::string& value, const std::string& allowed,
           const std::string& about, Need need = Need::optional);

  template <typename Visit>
  void visit_variants(const std::string& table, bool repeated, Visit visit) {
    for (std::size_t variant = 0; variant < most_variants; ++variant) {
      KeyLister inner(table, repeated, variant, keys_);
      visit(inner);
    }
  }

  std::string table_;
  bool repeated_;
  std::size_t variant_;
  bool follows_ = false;
  std::vector<SceneKey>& keys_;
};

}  // namespace poreshock::scene_text
