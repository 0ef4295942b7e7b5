#include "poreshock/solver/simulation.hpp"
#include "poreshock/transfer/facing.hpp"
#include "poreshock/transfer/node_lanes.hpp"
#include "poreshock/transfer/surfaces.hpp"

namespace poreshock {

template <int Dim>
void mark_surfaces(Simulation<Dim>& sim) {
  if (!sim.scene.contact.self) return;
  SlabGrid& grid = *sim.grid;
  scatter_surfaces(sim.particles, sim.cells, {}, sim.scene.transfer, grid);
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
  SlabGrid& grid = *sim.grid;
  sim.cells.field = {0, 1, 2, 3};
  if (!all.surfaces) {
    grid.take_fields(facing_quarters);
    all.surfaces = grid.sibling();
  }
  scatter_surfaces(sim.particles, sim.cells, {}, sim.scene.transfer, *all.surfaces);
  all.surfaces->exchange();
  all.sides = find_sides(*all.surfaces);
}

template void mark_surfaces<2>(Simulation<2>&);
template void mark_surfaces<3>(Simulation<3>&);
template void split_by_facing<2>(Simulation<2>&);
template void split_by_facing<3>(Simulation<3>&);

}  // namespace poreshock
