#include "poreshock/solver/grain_fields.hpp"

#include <algorithm>
#include <limits>

#include "crowded_grains.hpp"
#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/solver/simulation.hpp"
#include "poreshock/transfer/grid_to_particles.hpp"
#include "poreshock/transfer/node_lanes.hpp"
#include "poreshock/transfer/node_points.hpp"
#include "poreshock/transfer/surfaces.hpp"
#include "poreshock/transfer/sweep.hpp"

namespace poreshock {

namespace {

template <int Dim>
std::vector<GrainCell> grain_cells(const Simulation<Dim>& sim) {
  std::vector<GrainCell> cells;
  for_each_run(
      sim.particles, sim.cells, *sim.grid, all_rows(*sim.grid),
      [&](int row, int lateral, const std::uint32_t* first, const std::uint32_t*) {
        cells.push_back({row, lateral, sim.particles.grain[*first]});
      },
      [](int) {});
  return cells;
}

/// Gives each colour the nodes that its particles reach where they are awake.
void mark_colours(const std::vector<CellRun>& runs, const std::vector<std::int8_t>& colours,
                  RowRange awake, const SlabGrid& grid, NodeLayout& layout) {
  const GridShape& shape = grid.shape();
  const int w = shape.stencil, lines = shape.dimension == 3 ? w : 1;
  for (const CellRun& r : runs) {
    if (r.row < awake.first || r.row >= awake.last) continue;
    const int colour = colours[static_cast<std::size_t>(r.grain)];
    const int first = std::max(r.row, grid.first_row());
    for (int row = first; row < std::min(r.row + w, grid.node_end()); ++row) {
      for (int y = r.y; y < r.y + lines; ++y) {
        const int line = y * shape.nodes[0];
        mark_nodes(colour, row, line + r.first, line + r.last + w, layout);
      }
    }
  }
}

/// Surfaces of all fields at the nodes they share; the particles around those nodes where normals
/// come from them.
template <int Dim>
NodePoints<Dim> find_surfaces(Simulation<Dim>& sim) {
  GrainFields& all = sim.grain_fields;
  SlabGrid& surfaces = *all.surfaces;
  all.shared = shared_nodes(*sim.grid, MotionLane<Dim>::mass);
  const ChosenCells near = cells_at(all.shared, surfaces);
  scatter_surfaces(sim.particles, sim.cells, near, sim.scene.transfer, surfaces);
  surfaces.exchange();
  if (!all.sides.empty()) join_sides(all.sides, surfaces);
  if (sim.scene.contact.normal != ContactNormal::regression) return {};
  std::vector<CellPoint<Dim>> points =
      collect_points<Dim>(sim.particles, sim.cells, near, *sim.grid);
  exchange_points<Dim>(*sim.grid, points);
  return points_at_nodes<Dim>(points, all.shared, *sim.grid);
}

template <int Dim>
ContactSettings contact_settings(double dt, const Simulation<Dim>& sim) {
  return {.friction = sim.scene.contact.friction,
          .gap_test = sim.scene.contact.gap == GapTest::volume,
          .cell = sim.scene.domain.cell,
          .kept = 1.0 - lost_share(sim.scene.transfer, sim.sound_speed, sim.scene.domain.cell, dt),
          .capacity = 0.0};
}

}  // namespace

void release_fields(GrainFields& fields) {
  fields.surfaces.reset();
  fields.shared.clear();
  fields.sides.clear();
}

template <int Dim>
void find_grains(Simulation<Dim>& sim) {
  std::int32_t limits[2] = {0, 0};  // of -number and number
  if (sim.particles.size() > 0) {
    const auto [least, most] =
        std::minmax_element(sim.particles.grain.begin(), sim.particles.grain.end());
    limits[0] = -*least, limits[1] = *most;
  } else {
    limits[0] = limits[1] = std::numeric_limits<std::int32_t>::min();
  }
  if (follows_front(sim.scene) && !sim.sample.grains.empty()) {
    // Those above the window will come.
    const std::size_t last = first_grain_number(sim.scene) + sim.sample.grains.size() - 1;
    limits[1] = std::max(limits[1], static_cast<std::int32_t>(last));
  }
  check_mpi(MPI_Allreduce(MPI_IN_PLACE, limits, 2, MPI_INT32_T, MPI_MAX, sim.communicator),
            "MPI_Allreduce of grain numbers");
  const bool self = sim.scene.contact.self;
  if (-limits[0] == limits[1]) {
    if (self) sim.grain_fields.faces.emplace(sim.scene.transfer);
    return;
  }
  if (self) {
    throw InputError(
        "contact.self: found true in a scene of several grains. Allowed is false: there each grain "
        "has one velocity field and none is left for its other side. Set contact.self = false, or "
        "give all bodies the same grain.");
  }
  sim.grain_fields.grains = limits[1] + 1;
  sim.grain_fields.faces.emplace(sim.scene.transfer);
}

template <int Dim>
void split_by_colour(Simulation<Dim>& sim) {
  GrainFields& all = sim.grain_fields;
  if (sim.scene.contact.self) return split_by_facing(sim);
  if (all.grains == 0) return;
  // Two grains share a node when their cells are less than a stencil apart. What a grain adds to
  // a node does not depend on its colour, so colours may change from step to step.
  SlabGrid& grid = *sim.grid;
  const int reach = grid.shape().stencil - 1;
  const std::vector<CellRun> runs = cell_runs(grain_cells(sim), reach, grid);
  try {
    all.colours = colour_grains(all.grains, near_grains(runs, reach, grid));
  } catch (const StateError& crowd) {
    throw_crowded(crowd, sim);
  }
  const int fields = 1 + *std::max_element(all.colours.begin(), all.colours.end());
  sim.cells.field = all.colours;
  if (fields == 1) {
    release_fields(all);
    if (grid.fields() > 1) grid.take_fields(1);
    return;
  }
  grid.take_fields(fields, [&](NodeLayout& layout) {
    mark_colours(runs, all.colours, sim.cells.awake, grid, layout);
  });
  if (!all.surfaces) all.surfaces = grid.sibling();
}

template <int Dim>
std::vector<std::int32_t> particle_colours(const Simulation<Dim>& sim) {
  const Particles<Dim>& particles = sim.particles;
  std::vector<std::int32_t> colours;
  if (!has_contact(sim)) return colours;
  colours.reserve(particles.size());
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (sim.scene.contact.self) {
      colours.push_back(facing_quarter(particles.facing[0][p], particles.facing[1][p]));
    } else {
      const std::vector<std::int8_t>& of_grain = sim.grain_fields.colours;
      colours.push_back(of_grain.empty() ? 0
                                         : of_grain[static_cast<std::size_t>(particles.grain[p])]);
    }
  }
  return colours;
}

template <int Dim>
void collide(double dt, Simulation<Dim>& sim) {
  GrainFields& all = sim.grain_fields;
  all.summary = {};
  if (sim.grid->fields() == 1) return;
  const NodePoints<Dim> points = find_surfaces(sim);
  all.summary =
      collide_grains<Dim>({*sim.grid, *all.surfaces}, all.shared, sim.scene,
                          contact_settings(dt, sim), *all.faces, points, sim.ledger.nodes);
}

template <int Dim>
void finish_contact(Simulation<Dim>& sim) {
  const GrainFields& all = sim.grain_fields;
  if (sim.grid->fields() == 1) return;
  settle_contact_heat<Dim>({*sim.grid, *all.surfaces}, all.shared, sim.scene.boundary,
                           sim.ledger.nodes);
}

template <int Dim>
ContactRow contact_row(const Simulation<Dim>& sim) {
  const ContactSummary& own = sim.grain_fields.summary;
  std::int64_t counts[2] = {own.nodes, own.crowded_nodes};
  double largest[3] = {-own.least_gap, own.penetration, own.residual};
  check_mpi(MPI_Allreduce(MPI_IN_PLACE, counts, 2, MPI_INT64_T, MPI_SUM, sim.communicator),
            "MPI_Allreduce of contact nodes");
  check_mpi(MPI_Allreduce(MPI_IN_PLACE, largest, 3, MPI_DOUBLE, MPI_MAX, sim.communicator),
            "MPI_Allreduce of gaps");
  return {counts[0], counts[1], -largest[0], largest[1], largest[2]};
}

template ContactRow contact_row<2>(const Simulation<2>&);
template ContactRow contact_row<3>(const Simulation<3>&);
template std::vector<std::int32_t> particle_colours<2>(const Simulation<2>&);
template std::vector<std::int32_t> particle_colours<3>(const Simulation<3>&);
template void find_grains<2>(Simulation<2>&);
template void find_grains<3>(Simulation<3>&);
template void split_by_colour<2>(Simulation<2>&);
template void split_by_colour<3>(Simulation<3>&);
template void collide<2>(double, Simulation<2>&);
template void collide<3>(double, Simulation<3>&);
template void finish_contact<2>(Simulation<2>&);
template void finish_contact<3>(Simulation<3>&);

}  // namespace poreshock
