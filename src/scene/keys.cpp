#include "poreshock/scene/keys.hpp"

#include "key_lister.hpp"
#include "material_table.hpp"
#include "tables.hpp"
#include "toml_writer.hpp"

namespace poreshock {
namespace scene_text {
namespace {

bool governs_others(const std::string& key) {
  return key == "shape" || key == "strength";
}

}  // namespace

void KeyLister::add(const std::string& key, const std::string& value, const std::string& allowed,
                    const std::string& about, Need need) {
  const bool follows = std::exchange(follows_, false);
  const bool known = std::any_of(keys_.begin(), keys_.end(), [&](const SceneKey& other) {
    return other.table == table_ && other.key == key;
  });
  if (known) return;
  const std::string standard = need == Need::required ? "required" : (follows ? "" : value);
  keys_.push_back({table_, repeated_, key, standard, allowed, about});
}

void KeyLister::number(const char* key, double value, const NumberRule& rule) {
  add(key, plain_number(value), allowed_numbers("a number", rule), rule.about, rule.need);
}

void KeyLister::number(const char* key, const std::optional<double>& value,
                       const NumberRule& rule) {
  add(key, value ? plain_number(*value) : "", allowed_numbers("a number", rule), rule.about,
      rule.need);
}

void KeyLister::whole(const char* key, std::int64_t value, const NumberRule& rule) {
  add(key, std::to_string(value), allowed_numbers("a whole number", rule), rule.about, rule.need);
}

void KeyLister::flag(const char* key, bool value, const Rule& rule) {
  add(key, value ? "true" : "false", "true or false", rule.about, rule.need);
}

void KeyLister::text(const char* key, const std::string&, const Rule& rule) {
  add(key, "", "a text", rule.about, rule.need);
}

bool KeyLister::name(const char* key, std::string& value, const std::vector<std::string>& allowed,
                     const Rule& rule) {
  add(key, value.empty() ? "" : '"' + value + '"',
      allowed.empty() ? "a name" : allowed_names(allowed), rule.about, rule.need);
  if (governs_others(key)) value = allowed[std::min(variant_, allowed.size() - 1)];
  return true;
}

void KeyLister::names(const char* key, const std::vector<std::string>&,
                      const std::vector<std::string>& allowed, const Rule& rule) {
  add(key, "", "an array of names out of " + allowed_names(allowed), rule.about, rule.need);
}

void KeyLister::numbers(const char* key, const Triple&, int, std::initializer_list<int>,
                        const NumberRule& rule) {
  add(key, "", allowed_numbers("an array of 2 or 3 numbers", rule), rule.about, rule.need);
}

void KeyLister::vector(const char* key, const Triple&, int, const NumberRule& rule) {
  add(key, "0", allowed_numbers("an array, one number per axis", rule), rule.about, rule.need);
}

void KeyLister::points(const char* key, const std::vector<Triple>&, const NumberRule& rule) {
  add(key, "", allowed_numbers("an array of points", rule), rule.about, rule.need);
}

void KeyLister::flags(const char* key, const std::array<bool, 2>&, int, const Rule& rule) {
  add(key, "false", "true or false", rule.about, rule.need);
}

void KeyLister::sides(const char* key, const std::array<SideKind, 2>&, const std::array<bool, 2>&,
                      int, const Rule& rule) {
  add(key, "\"free\"", allowed_names({"free", "wall", "symmetry"}), rule.about, rule.need);
}

void KeyLister::thresholds(const char* key, const std::vector<std::string>&,
                           const std::vector<MorphologyField>&, const Rule& rule) {
  add(key, "", "an array, {from = , to = , step = }, or a table of these by field", rule.about,
      rule.need);
}

void KeyLister::hot_spots(const char* key, const std::vector<MorphologyField>&, const Rule& rule) {
  add(key, "", "likewise", rule.about, rule.need);
}

}  // namespace scene_text

std::vector<SceneKey> scene_keys() {
  std::vector<SceneKey> keys;
  Scene scene;
  scene_text::KeyLister lister("", false, 0, keys);
  scene_text::visit_scene(lister, scene);
  return keys;
}

std::string write_material(const MaterialParameters& material) {
  MaterialParameters copy = material;
  scene_text::TomlWriter writer("material");
  scene_text::visit_material(writer, copy);
  return "[[material]]\n" + writer.document();
}

}  // namespace poreshock
