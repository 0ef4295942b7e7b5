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
#include "split_fields.hpp"

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

/// The particles of the chosen cells.
void choose_cells(const CellOrder& all, const std::vector<bool>& chosen, CellOrder& result) {
  result.order.clear();
  result.awake = all.awake;
  result.start.resize(all.start.size());
  for (std::size_t c = 0; c + 1 < all.start.size(); ++c) {
    result.start[c] = static_cast<std::uint32_t>(result.order.size());
    if (!chosen[c]) continue;
    result.order.insert(result.order.end(), all.order.begin() + all.start[c],
                        all.order.begin() + all.start[c + 1]);
  }
  result.start.back() = static_cast<std::uint32_t>(result.order.size());
}

/// True for the stencil cells of this slab that reach a shared node.
std::vector<bool> cells_at(const std::vector<bool>& shared, const SlabGrid& grid) {
  const GridShape& shape = grid.shape();
  const int width = shape.row_size, rows = grid.last_row() - grid.first_row(), w = shape.stencil;
  std::vector<bool> cells(static_cast<std::size_t>(rows) * width, false);
  const int planes = shape.dimension == 3 ? w : 1;
  for (int row = 0; row < grid.node_end() - grid.first_row(); ++row) {
    for (int i = 0; i < width; ++i) {
      const std::size_t node = static_cast<std::size_t>(row) * width + original_node(shape, i);
      if (!shared[node]) continue;
      for (int k = 0; k < w; ++k) {
        if (row - k < 0 || row - k >= rows) continue;
        for (int j = 0; j < planes; ++j) {
          for (int l = 0; l < w; ++l) {
            const int lateral = i - j * shape.nodes[0] - l;
            if (lateral < 0 || i % shape.nodes[0] < l) continue;
            cells[static_cast<std::size_t>(row - k) * width + lateral] = true;
          }
        }
      }
    }
  }
  return cells;
}

/// The fields that may collide: all, or the two sides of self-contact.
std::vector<ContactField> contact_fields(const GrainFields& all) {
  std::vector<ContactField> fields;
  for (const VelocityField& f : all.fields) {
    if (!all.sides.empty() && fields.size() == 2) break;
    fields.push_back({f.grid, f.surfaces});
  }
  return fields;
}

/// What collisions need: the fields that may collide, and the particles around the nodes they share
/// where normals come from them.
template <int Dim>
struct Surfaces {
  std::vector<ContactField> fields;
  NodePoints<Dim> points;
};

/// Surfaces of all fields at the nodes they share.
template <int Dim>
Surfaces<Dim> find_surfaces(Simulation<Dim>& sim) {
  GrainFields& all = sim.grain_fields;
  Surfaces<Dim> surfaces = {contact_fields(all), {}};
  all.shared = shared_nodes(surfaces.fields, MotionLane<Dim>::mass);
  const std::vector<bool> near = cells_at(all.shared, *sim.grid);
  CellOrder chosen;
  for (const VelocityField& f : all.fields) {
    choose_cells(f.cells, near, chosen);
    scatter_surfaces(sim.particles, chosen, sim.scene.transfer, *f.surfaces);
    f.surfaces->exchange();
  }
  if (!all.sides.empty()) join_sides(all.sides, grids_of(all, &VelocityField::surfaces));
  if (sim.scene.contact.normal == ContactNormal::regression) {
    choose_cells(sim.cells, near, chosen);
    std::vector<CellPoint<Dim>> points =
        collect_points<Dim>(sim.particles, chosen, all.colours, *sim.grid);
    exchange_points<Dim>(*sim.grid, points);
    surfaces.points = points_at_nodes<Dim>(points, all.shared, *sim.grid);
  }
  return surfaces;
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

std::vector<FieldView> velocity_fields(const CellOrder& cells, SlabGrid& grid,
                                       const GrainFields& fields) {
  if (fields.fields.empty()) return {{&cells, &grid}};
  std::vector<FieldView> views;
  for (const VelocityField& field : fields.fields) views.push_back({&field.cells, field.grid});
  return views;
}

std::int64_t contact_nodes(const GrainFields& fields) {
  return fields.fields.empty() ? 0 : std::ranges::count(fields.shared, true);
}

void release_fields(GrainFields& fields) {
  fields.fields.clear();
  fields.grids.clear();
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
  const int reach = sim.grid->shape().stencil - 1;
  const std::vector<GrainPair> near = near_grains(grain_cells(sim), reach, *sim.grid);
  try {
    all.colours = colour_grains(all.grains, near);
  } catch (const StateError& crowd) {
    throw_crowded(crowd, sim);
  }
  make_fields(1 + *std::max_element(all.colours.begin(), all.colours.end()), sim);
  if (all.fields.empty()) return;
  split(
      sim.cells,
      [&](std::uint32_t p) {
        return all.colours[static_cast<std::size_t>(sim.particles.grain[p])];
      },
      all);
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
  if (all.fields.empty()) return;
  const Surfaces<Dim> surfaces = find_surfaces(sim);
  all.summary =
      collide_grains<Dim>(surfaces.fields, all.shared, sim.scene, contact_settings(dt, sim),
                          *all.faces, surfaces.points, sim.ledger.nodes);
}

template <int Dim>
void finish_contact(Simulation<Dim>& sim) {
  const GrainFields& all = sim.grain_fields;
  if (all.fields.empty()) return;
  const std::vector<ContactField> fields = contact_fields(all);
  settle_contact_heat<Dim>(fields, all.shared, sim.scene.boundary, sim.ledger.nodes);
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
