#include "poreshock/app/reference.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include "poreshock/core/error.hpp"
#include "poreshock/material/library.hpp"
#include "poreshock/scene/keys.hpp"

namespace poreshock {

namespace {

std::string strengths(const MaterialParameters& material) {
  std::string text = "linear";
  for_each_flow_law(material, [&](StrengthModel model, const auto& law) {
    if (has_strength(material, model)) text.append(", ").append(law.name);
  });
  return text;
}

std::string describe(const LibraryMaterial& material) {
  return material.parameters.name + "\n  " + material.about +
         "\n  strength: " + strengths(material.parameters) + "\n  source: " + material.source +
         "\n";
}

std::string known_names() {
  std::string names;
  for (const LibraryMaterial& m : material_library()) {
    names.append(names.empty() ? "" : ", ").append(m.parameters.name);
  }
  return names;
}

/// Text of a cell of a Markdown table.
std::string cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) {
    text.insert(at, 1, '\\');
  }
  return text;
}

}  // namespace

std::string describe_materials(const std::string& name) {
  if (name.empty()) {
    std::string text;
    for (const LibraryMaterial& m : material_library()) text += describe(m);
    return text + "\nname = \"copper\" in [[material]] takes all of one; other keys override it.\n";
  }
  const LibraryMaterial* material = library_material(name);
  if (material == nullptr) {
    throw InputError("found the material \"" + name + "\", allowed " + known_names());
  }
  MaterialParameters linear = material->parameters;
  std::string text = "# " + material->about + "\n# source: " + material->source + "\n";
  text += write_material(linear);
  for_each_flow_law(linear, [&](StrengthModel model, const auto& law) {
    if (!has_strength(linear, model)) return;
    MaterialParameters other = linear;
    other.strength = model;
    const std::string all = write_material(other);
    text += "\n# with strength = \"" + std::string(law.name) + "\"" + all.substr(all.find("\n\n"));
  });
  return text;
}

std::string describe_keys() {
  std::vector<std::string> tables;
  std::map<std::string, std::string> rows;
  for (const SceneKey& key : scene_keys()) {
    const std::string table =
        key.table.empty() ? "At the top of a scene"
                          : (key.repeated ? "`[[" + key.table + "]]`" : "`[" + key.table + "]`");
    if (!rows.contains(table)) tables.push_back(table);
    rows[table] += "| `" + key.key + "` | " + cell(key.standard) + " | " + cell(key.allowed) +
                   " | " + cell(key.about) + " |\n";
  }
  std::string text;
  for (const std::string& table : tables) {
    text += (text.empty() ? "### " : "\n### ") + table +
            "\n\n| key | default | allowed | meaning |\n|---|---|---|---|\n" + rows[table];
  }
  return text;
}

}  // namespace poreshock
