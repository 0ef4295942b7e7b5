#include <cmath>

#include "block.hpp"
#include "grains.hpp"
#include "image_sites.hpp"
#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/image/stack.hpp"
#include "text.hpp"

namespace poreshock {
namespace {

Stack find_stack(const Scene& scene, MPI_Comm communicator) {
  const Sample& sample = scene.sample;
  std::optional<RawLayout> raw;
  if (sample.raw_size[0] > 0.0) {
    raw.emplace();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      raw->size[axis] = static_cast<std::int64_t>(sample.raw_size[axis]);
    }
    const std::string& type = sample.raw_type;  // such as uint16
    const std::size_t digits = type.find_first_of("0123456789");
    raw->number = type.substr(0, 1) + std::to_string(std::stoi(type.substr(digits)) / 8);
    raw->big_endian = sample.raw_big_endian;
    raw->skip = sample.raw_skip;
  }
  return find_stack(sample.image, scene.dimension, sample.threshold.has_value(), raw, communicator);
}

/// Says where the image is not as large as the block that it fills.
void check_extents(const Scene& scene, const Stack& stack, std::vector<std::string>& problems) {
  const bool deep = scene.dimension == 3;
  const std::array<const char*, 3> counted{"columns", "rows", "slices"};
  const std::array<const char*, 3> lengths{"the domain's width", "the domain's depth",
                                           "sample.height"};
  const double edge = scene.sample.pixel;
  const Block block = sample_block(scene);
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(scene.dimension); ++axis) {
    const bool shock = axis + 1 == static_cast<std::size_t>(scene.dimension);
    // A stack with a gap has the wrong height because of that.
    if (shock && deep && !stack.problems.empty()) continue;
    const double extent = static_cast<double>(stack.size[axis]) * edge;
    if (std::fabs(extent - block.size[axis]) <= 1e-9 * block.size[axis]) continue;
    problems.push_back(stack.name + ": has " + std::to_string(stack.size[axis]) + " " +
                       counted[axis] + " of sample.pixel = " + length_text(edge) + ", " +
                       length_text(extent) + " in all, but " + lengths[shock ? 2 : axis] + " is " +
                       length_text(block.size[axis]) + ". Allowed is the same length. Set " +
                       (shock ? "sample.height" : "domain.size") + " or sample.pixel");
  }
}

/// Throws InputError with the problems of all ranks, as many as can be read at a glance.
/// Collective.
void require_no_problem(const std::vector<std::string>& problems, MPI_Comm communicator) {
  constexpr std::int64_t most = 20;
  std::vector<char> own;
  for (const std::string& problem : problems) {
    const std::string line = "sample.image: " + problem + ".\n";
    own.insert(own.end(), line.begin(), line.end());
  }
  const std::vector<char> all = gather_all(own, communicator);
  std::string text;
  std::int64_t lines = 0;
  for (const char c : all) {
    if (lines < most) text += c;
    if (c == '\n') ++lines;
  }
  if (lines == 0) return;
  if (lines > most) text += "and " + std::to_string(lines - most) + " more such problems.\n";
  text.pop_back();
  throw InputError(text);
}

/// Runs of solid voxels in the rank's share of the layers; what is wrong with them goes to
/// `problems`. Collective.
SolidVoxels read_voxels(const Scene& scene, const Stack& stack, MPI_Comm communicator,
                        std::vector<std::string>& problems) {
  const std::optional<double> threshold = scene.sample.threshold;
  const bool one = threshold.has_value() || scene.sample.regions == Regions::matrix;
  SolidVoxels voxels{
      stack.size, scene.sample.pixel, 0, own_layers(stack.layers(), communicator), {}};
  const std::int64_t at_once = layers_at_once(stack);
  const std::int64_t own = voxels.layers.last - voxels.layers.first;
  // Every rank takes part in every reading.
  const int readings = largest(static_cast<int>((own + at_once - 1) / at_once), communicator);
  for (int reading = 0; reading < readings; ++reading) {
    const std::int64_t first =
        std::min(voxels.layers.first + reading * at_once, voxels.layers.last);
    const std::int64_t count = std::min(at_once, voxels.layers.last - first);
    std::vector<double> values = read_layers(stack, first, count, communicator, problems);
    for (double& value : values) {
      // Not a number is no material in either.
      const bool solid = threshold ? value >= *threshold : !std::isnan(value) && value != 0.0;
      value = !solid ? 0.0 : (one ? 1.0 : value);
    }
    append_runs(
        values, stack.size[0], [](double value) { return value != 0.0; }, voxels.runs);
  }
  for (const Run& run : voxels.runs.runs) voxels.solid += run.end - run.begin;
  voxels.solid = sum(voxels.solid, communicator);
  return voxels;
}

void require_solid(const Scene& scene, const SolidVoxels& voxels) {
  if (voxels.solid > 0) return;
  throw InputError(
      "sample.image: " + scene.sample.image + ": has no solid " +
      (scene.dimension == 3 ? "voxel" : "pixel") + ". Allowed is at least one " +
      (scene.sample.threshold ? "of sample.threshold or more." : "with a label other than 0."));
}

}  // namespace

GrainLayout grains_of_image(const Scene& scene, LatticeRange range, MPI_Comm communicator) {
  const Stack stack = find_stack(scene, communicator);
  std::vector<std::string> problems;
  if (rank(communicator) == 0) {  // what all know is said once
    problems = stack.problems;
    check_extents(scene, stack, problems);
  }
  SolidVoxels voxels = read_voxels(scene, stack, communicator, problems);
  require_no_problem(problems, communicator);
  require_solid(scene, voxels);
  GrainLayout layout;
  const RowOrder order = row_order(voxels.size, scene.dimension, scene.domain.periodic);
  if (scene.sample.regions == Regions::grains) {
    double measure = 1.0;
    for (int axis = 0; axis < scene.dimension; ++axis) measure *= voxels.edge;
    for (const ConnectedRegion& region :
         find_regions(order, voxels.layers.first, communicator, voxels.runs)) {
      layout.grains.push_back({.measure = static_cast<double>(region.cells) * measure});
    }
  }
  const std::int64_t all = stack.layers() * stack.layer_size();
  layout.void_fraction = 1.0 - static_cast<double>(voxels.solid) / static_cast<double>(all);
  layout.sites = solid_sites(make_lattice(scene), voxels, range, communicator);
  return layout;
}

}  // namespace poreshock
