#include "poreshock/scene/read_scene.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "check_scene.hpp"
#include "document.hpp"
#include "poreshock/core/error.hpp"
#include "tables.hpp"
#include "toml_reader.hpp"

namespace poreshock {
namespace {

[[noreturn]] void refuse_file(const std::string& path, const std::string& reason) {
  throw InputError(path + ": cannot be read (" + reason +
                   "), give the path of a scene file such as input/porous_aluminium.toml");
}

std::string file_text(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) refuse_file(path, "it is a folder");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse_file(path, std::strerror(errno));
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (file.bad()) refuse_file(path, std::strerror(errno));
  return text;
}

}  // namespace

Scene parse_scene(const std::string& text, const std::string& name,
                  const std::vector<std::string>& overrides) {
  Scene scene;
  scene_text::Report report;
  report.origins[""] = {name};
  if (const auto document = scene_text::parse_document(text, name, overrides, report)) {
    scene_text::TomlReader reader(*document, "", report);
    scene_text::visit_scene(reader, scene);
    reader.finish();
    scene_text::resolve(scene, report);
    scene_text::check_scene(scene, report);
  }
  if (!report.problems.empty()) throw InputError(scene_text::report_text(report));
  return scene;
}

Scene read_scene(const std::string& path, const std::vector<std::string>& overrides) {
  Scene scene = parse_scene(file_text(path), path, overrides);
  // The resolved scene is stored elsewhere: the image must still be found from there.
  if (!scene.sample.image.empty()) {
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    scene.sample.image =
        std::filesystem::absolute(folder / scene.sample.image).lexically_normal().string();
  }
  return scene;
}

}  // namespace poreshock
