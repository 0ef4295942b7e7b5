#include "poreshock/scene/compare_scenes.hpp"

#include <set>
#include <string_view>
#include <type_traits>

#include "document.hpp"
#include "poreshock/scene/read_scene.hpp"

namespace poreshock {
namespace {

void compare(const toml::node* a, const toml::node* b, const std::string& path,
             std::vector<std::string>& keys);

void compare_tables(const toml::table& a, const toml::table& b, const std::string& path,
                    std::vector<std::string>& keys) {
  std::set<std::string> names;
  for (auto&& [key, node] : a) names.emplace(key.str());
  for (auto&& [key, node] : b) names.emplace(key.str());
  for (const std::string& name : names) {
    compare(a.get(name), b.get(name), path.empty() ? name : path + "." + name, keys);
  }
}

bool same_value(const toml::node& a, const toml::node& b) {
  return a.visit([&](const auto& value) {
    const auto* other = b.as<std::remove_cvref_t<decltype(value)>>();
    return other != nullptr && value == *other;
  });
}

void compare(const toml::node* a, const toml::node* b, const std::string& path,
             std::vector<std::string>& keys) {
  if (a != nullptr && b != nullptr) {
    if (a->is_table() && b->is_table()) {
      compare_tables(*a->as_table(), *b->as_table(), path, keys);
      return;
    }
    const toml::array* rows = a->as_array();
    const toml::array* others = b->as_array();
    if (a->is_array_of_tables() && b->is_array_of_tables() && rows->size() == others->size()) {
      for (std::size_t i = 0; i < rows->size(); ++i) {
        compare(rows->get(i), others->get(i), path + "." + std::to_string(i), keys);
      }
      return;
    }
    if (same_value(*a, *b)) return;
  }
  keys.push_back(path);
}

}  // namespace

std::vector<std::string> different_keys(const Scene& a, const Scene& b) {
  std::vector<std::string> keys;
  compare_tables(toml::parse(write_scene(a)), toml::parse(write_scene(b)), "", keys);
  return keys;
}

}  // namespace poreshock
