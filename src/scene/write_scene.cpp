#include "poreshock/scene/read_scene.hpp"
#include "tables.hpp"
#include "toml_writer.hpp"

namespace poreshock {

std::string write_scene(const Scene& scene) {
  scene_text::TomlWriter writer;
  Scene copy = scene;
  scene_text::visit_scene(writer, copy);
  return std::string(resolved_scene_mark) + ": every key, SI units.\n" + writer.document();
}

}  // namespace poreshock
