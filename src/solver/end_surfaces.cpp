#include "poreshock/solver/end_surfaces.hpp"

#include "poreshock/sample/fill.hpp"
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

EndSurfaces find_ends(const Scene& scene) {
  EndSurfaces ends;
  const auto dimension = static_cast<std::size_t>(scene.dimension);
  const int per_cell = scene.sample.particles_per_cell;
  ends.layer = layer_sites(scene);
  for (std::size_t a = 0; a + 1 < dimension; ++a) {
    ends.area *= scene.domain.cell / per_cell;
  }
  ends.low = backing_of(scene, scene.boundary.low);
  ends.high = backing_of(scene, scene.boundary.high);
  ends.top = sample_layers(scene) - 1;
  ends.density = scene.materials[static_cast<std::size_t>(scene.sample.material)].density;
  ends.rest = scene.loading.frame[dimension - 1] - scene.loading.velocity;
  return ends;
}

template <int Dim>
void sum_ends(const Transfer& transfer, const Particles<Dim>& particles, const CellOrder& cells,
              EndSurfaces& ends) {
  const double cell = ends.forces->shape().cell;
  with_shape(transfer, [&]<class Spline>(const Spline& spline) {
    scatter<Dim>(
        spline, particles, cells,
        [&](std::uint32_t p, const Stencil<Dim, Spline>& stencil, Lanes* sums) {
          const std::int64_t at = particles.id[p] / ends.layer;
          const double speed = particles.velocity[Dim - 1][p] - ends.rest;
          const bool below = ends.low && at == 0, above = ends.high && at == ends.top;
          if (!below && !above) return;
          // The end lies half the thickness of the particle beyond its place.
          const double thickness = particles.mass[p] / (particles.density[p] * ends.area);
          const double beyond = 0.5 * thickness / cell;
          const auto push = [&](double force, double outward) {
            for (int n = 0; n < stencil_nodes<Dim, Spline>; ++n) {
              const double slope = node_slope(stencil, n, Dim - 1);
              sums[n][end_force] += force * (node_weight(stencil, n) + outward * beyond * slope);
            }
          };
          const auto stress = [&](const Backing& behind, double into) {
            const double q = particles.viscous_pressure[p] * (behind.density / ends.density);
            return backing_stress(behind, into) + front_stress(behind, into, q);
          };
          if (below) push(ends.area * stress(*ends.low, -speed), -1.0);
          if (above) push(-ends.area * stress(*ends.high, speed), 1.0);
        },
        *ends.forces);
  });
  ends.forces->exchange();
}

template void sum_ends<2>(const Transfer&, const Particles<2>&, const CellOrder&, EndSurfaces&);
template void sum_ends<3>(const Transfer&, const Particles<3>&, const CellOrder&, EndSurfaces&);

}  // namespace poreshock
