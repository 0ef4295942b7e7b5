#include "poreshock/scene/keys.hpp"

#include "material_table.hpp"
#include "tables.hpp"
#include "toml_writer.hpp"

namespace poreshock {

std::vector<SceneKey> scene_keys() {
  std::vector<SceneKey> keys;
  Scene scene;
  scene_text::TomlWriter lister("", false, 0, keys);
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
