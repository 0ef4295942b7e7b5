#include "grains.hpp"

#include <algorithm>
#include <cmath>

#include "random.hpp"

namespace poreshock {

GrainLayout place_grains(const Scene& scene, LatticeRange range, MPI_Comm communicator) {
  GrainLayout layout;
  switch (scene.sample.kind) {
    case SampleKind::packed_grains:
      layout = pack_grains(scene);
      break;
    case SampleKind::voronoi_grains:
      layout = divide_into_grains(scene);
      break;
    case SampleKind::image:
      layout = grains_of_image(scene, range, communicator);
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

/// Gives the solid sites of an image to its grains, or all to the sample where it has none.
void give_image(const Scene& scene, const GrainLayout& layout, std::int32_t first_owner,
                std::vector<std::int32_t>& owners) {
  const std::int64_t row_length = make_lattice(scene).sites[0];
  for (std::int64_t row = 0; row < layout.sites.rows(); ++row) {
    const auto r = static_cast<std::size_t>(row);
    for (std::size_t n = layout.sites.row_start[r]; n < layout.sites.row_start[r + 1]; ++n) {
      const Run& run = layout.sites.runs[n];
      const auto begin = owners.begin() + row * row_length;
      std::fill(begin + run.begin, begin + run.end,
                layout.grains.empty() ? owner_sample : first_owner + run.region);
    }
  }
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
  if (scene.sample.kind == SampleKind::image) give_image(scene, layout, first_owner, owners);
}

}  // namespace poreshock
