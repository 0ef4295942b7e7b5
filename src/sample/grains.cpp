#include "grains.hpp"

#include <algorithm>
#include <cmath>

#include "random.hpp"

namespace poreshock {

GrainLayout place_grains(const Scene& scene) {
  GrainLayout layout;
  switch (scene.sample.kind) {
    case SampleKind::packed_grains:
      layout = pack_grains(scene);
      break;
    case SampleKind::voronoi_grains:
      layout = divide_into_grains(scene);
      break;
    case SampleKind::image:
      layout = grains_of_image(scene);
      break;
    default:
      return layout;
  }
  assign_materials(scene.sample, layout.grains);
  return layout;
}

void assign_materials(const Sample& sample, std::vector<Grain>& grains) {
  for (Grain& grain : grains) grain.material = sample.material;
  if (sample.mixture.empty()) return;
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t g = 0; g < grains.size(); ++g) {
    order.emplace_back(uniforms(sample.seed, RandomStream::material, g, 0)[0], g);
  }
  std::sort(order.begin(), order.end());
  std::vector<double> given(sample.mixture.size(), 0.0);
  double all = 0.0;
  for (const auto& [random, g] : order) {
    all += grains[g].measure;
    std::size_t chosen = 0;
    double worst = -INFINITY;
    for (std::size_t m = 0; m < given.size(); ++m) {
      const double behind = sample.mixture[m].fraction * all - given[m];
      if (behind > worst) worst = behind, chosen = m;
    }
    given[chosen] += grains[g].measure;
    grains[g].material = sample.mixture[chosen].material;
  }
}

namespace {

/// Index of the image's grain at a point, -1 = void.
std::int32_t image_grain(const GrainImage& image, double pixel, const Triple& point) {
  const auto clamp = [](double x, std::int64_t count) {
    return std::clamp(static_cast<std::int64_t>(std::floor(x)), std::int64_t{0}, count - 1);
  };
  const std::int64_t row = clamp(point[1] / pixel, image.rows);
  return image.grain[static_cast<std::size_t>(row * image.columns +
                                              clamp(point[0] / pixel, image.columns))];
}

void give_discs(const Scene& scene, const GrainLayout& layout, LatticeRange range,
                std::int32_t first_owner, std::vector<std::int32_t>& owners) {
  const Lattice lattice = make_lattice(scene);
  for (std::size_t g = 0; g < layout.grains.size(); ++g) {
    give_ball(lattice, range, scene.domain.periodic, layout.grains[g].center,
              layout.grains[g].radius, first_owner + static_cast<std::int32_t>(g), owners);
  }
}

}  // namespace

void give_grains(const Scene& scene, const GrainLayout& layout, LatticeRange range,
                 std::int32_t first_owner, std::vector<std::int32_t>& owners) {
  if (scene.sample.kind == SampleKind::packed_grains) {
    return give_discs(scene, layout, range, first_owner, owners);
  }
  if (scene.sample.kind == SampleKind::voronoi_grains) {
    return give_cells(scene, layout, range, first_owner, owners);
  }
  if (scene.sample.kind != SampleKind::image) return;
  for_each_block_site(make_lattice(scene), range, [&](std::size_t site, const Triple& point) {
    const std::int32_t grain = image_grain(layout.image, scene.sample.pixel, point);
    if (grain >= 0) owners[site] = first_owner + grain;
  });
}

}  // namespace poreshock
