#include "end_surfaces.hpp"

#include <algorithm>
#include <optional>

#include "poreshock/physics/transmit.hpp"
#include "poreshock/sample/fill.hpp"
#include "poreshock/scene/transfer_scheme.hpp"
#include "poreshock/transfer/sweep.hpp"

namespace poreshock {

namespace {

/// The material behind a side; none where there is none.
std::optional<Backing> backing_of(const Scene& scene, const Side& side) {
  for (const MaterialParameters& m : scene.materials) {
    if (m.name == side.behind) return make_backing(m);
  }
  return std::nullopt;
}

}  // namespace

template <int Dim>
void sum_ends(Simulation<Dim>& sim) {
  const Scene& scene = sim.scene;
  const int per_cell = scene.sample.particles_per_cell;
  std::int64_t layer = 1;
  double area = 1.0;
  for (std::size_t a = 0; a + 1 < Dim; ++a) {
    layer *= static_cast<std::int64_t>(scene.domain.cells[a]) * per_cell;
    area *= scene.domain.cell / per_cell;
  }
  const std::optional<Backing> low = backing_of(scene, scene.boundary.low);
  const std::optional<Backing> high = backing_of(scene, scene.boundary.high);
  const std::int64_t top = sample_layers(scene) - 1;
  const double rest = scene.loading.frame[Dim - 1] - scene.loading.velocity;
  with_shape(scene.transfer, [&]<class Spline>(const Spline& spline) {
    scatter<Dim>(
        spline, sim.particles, sim.cells,
        [&](std::uint32_t p, const Stencil<Dim, Spline>& stencil, Lanes* sums) {
          const std::int64_t at = sim.particles.id[p] / layer;
          const double speed = sim.particles.velocity[Dim - 1][p] - rest;
          const bool below = low && at == 0, above = high && at == top;
          if (!below && !above) return;
          // The end lies half the thickness of the particle beyond its place.
          const double thickness = sim.particles.mass[p] / (sim.particles.density[p] * area);
          const double beyond = 0.5 * thickness / scene.domain.cell;
          const auto push = [&](double force, double outward) {
            for (int n = 0; n < stencil_nodes<Dim, Spline>; ++n) {
              const double slope = node_slope(stencil, n, Dim - 1);
              sums[n][end_force] += force * (node_weight(stencil, n) + outward * beyond * slope);
            }
          };
          if (below) push(area * backing_stress(*low, -speed), -1.0);
          if (above) push(-area * backing_stress(*high, speed), 1.0);
        },
        *sim.ends);
  });
  sim.ends->exchange();
}

template void sum_ends<2>(Simulation<2>&);
template void sum_ends<3>(Simulation<3>&);

}  // namespace poreshock
