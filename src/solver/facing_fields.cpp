#include "poreshock/transfer/facing.hpp"
#include "poreshock/transfer/node_lanes.hpp"
#include "poreshock/transfer/surfaces.hpp"
#include "split_fields.hpp"

namespace poreshock {

template <int Dim>
void mark_surfaces(Simulation<Dim>& sim) {
  if (!sim.scene.contact.self) return;
  SlabGrid& grid = *sim.grid;
  scatter_surfaces(sim.particles, sim.cells, sim.scene.transfer, grid);
  grid.exchange();
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    for (int i = 0; i < grid.shape().row_size; ++i) {
      grid.row(row)[i][SurfaceLane<Dim>::volume] /=
          node_capacity(grid.shape(), sim.scene.transfer, row, i);
    }
  }
  grid.fill_periodic_images();
  find_facing(sim.cells, sim.scene.transfer, grid, sim.particles);
}

template <int Dim>
void split_by_facing(Simulation<Dim>& sim) {
  GrainFields& all = sim.grain_fields;
  make_fields(facing_quarters, sim);
  const auto& facing = sim.particles.facing;
  split(
      sim.cells, [&](std::uint32_t p) { return facing_quarter(facing[0][p], facing[1][p]); }, all);
  for (const VelocityField& f : all.fields) {
    scatter_surfaces(sim.particles, f.cells, sim.scene.transfer, *f.surfaces);
    f.surfaces->exchange();
  }
  all.sides = find_sides(grids_of(all, &VelocityField::surfaces));
}

void join_fields(const GrainFields& fields) {
  if (!fields.sides.empty()) join_sides(fields.sides, grids_of(fields, &VelocityField::grid));
}

void spread_fields(const GrainFields& fields) {
  if (!fields.sides.empty()) spread_sides(fields.sides, grids_of(fields, &VelocityField::grid));
}

template void mark_surfaces<2>(Simulation<2>&);
template void mark_surfaces<3>(Simulation<3>&);
template void split_by_facing<2>(Simulation<2>&);
template void split_by_facing<3>(Simulation<3>&);

}  // namespace poreshock
