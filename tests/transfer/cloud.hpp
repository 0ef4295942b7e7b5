#pragma once
// A cloud of random particles known to every rank, and the slab of it that one rank holds.

#include <bit>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "poreshock/core/parallel.hpp"
#include "poreshock/core/shape.hpp"
#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/particles/cell_order.hpp"
#include "poreshock/particles/particles.hpp"
#include "poreshock/transfer/grid_to_particles.hpp"
#include "poreshock/transfer/node_lanes.hpp"
#include "poreshock/transfer/step_data.hpp"
#include "poreshock/transfer/sweep.hpp"
#include "support/shuffle.hpp"

namespace poreshock::test {

inline const MPI_Comm world = MPI_COMM_WORLD;

/// All particles of a test, the one with id p at index p.
template <int Dim>
struct Cloud {
  GridShape shape;
  Transfer transfer;
  Particles<Dim> particles;
};

/// Scheme and sides of a test.
struct Choice {
  ShapeFunction shape;
  VelocityTransfer velocity;
  bool periodic;
};

/// All that suit each other: FLIP with both kinds of sides, others with one of them in turn.
inline const std::vector<Choice> all_choices = [] {
  std::vector<Choice> choices;
  for (const ShapeFunction shape : shape_functions) {
    for (const TransferScheme& scheme : transfer_schemes) {
      if (!suits(scheme, shape)) continue;
      choices.push_back({shape, scheme.velocity, choices.size() % 2 == 0});
      if (scheme.velocity != VelocityTransfer::flip) continue;
      choices.push_back({shape, scheme.velocity, choices.size() % 2 == 0});
    }
  }
  return choices;
}();

inline std::string name(const Choice& choice) {
  const std::string_view shape = of_shape(choice.shape, [](const auto& s) { return s.name; });
  return std::string(shape) + " " + std::string(scheme_of(choice.velocity).name) +
         (choice.periodic ? " periodic" : "");
}

inline constexpr double half_length = 0.25;  // cells

template <int Dim>
GridShape cloud_grid(const Choice& choice) {
  Scene scene;
  scene.dimension = Dim;
  scene.domain.cell = 1e-5;
  scene.domain.cells = Dim == 2 ? std::array<int, 3>{7, 12, 0} : std::array<int, 3>{6, 5, 10};
  scene.domain.periodic = {choice.periodic, choice.periodic};
  scene.transfer.shape = choice.shape;
  scene.transfer.half_length = half_length;
  return make_grid_shape(scene);
}

/// Random particles in the whole domain but two rows of cells, some on cell edges and centres;
/// aluminium under 10 GPa, up to 500 m/s, gradients up to 1e7 1/s, second modes up to 100 m/s.
template <int Dim>
Cloud<Dim> make_cloud(const Choice& choice) {
  Cloud<Dim> cloud;
  cloud.shape = cloud_grid<Dim>(choice);
  cloud.transfer.shape = choice.shape;
  cloud.transfer.velocity = choice.velocity;
  cloud.transfer.half_length = half_length;
  Particles<Dim>& particles = cloud.particles;
  const Modes modes = scheme_of(choice.velocity).modes;
  particles.options.affine = modes != Modes::constant;
  particles.options.quadratic = modes == Modes::quadratic;
  const std::size_t count = Dim == 2 ? 300 : 500;
  resize(particles, count);
  reference::Random random{2010};
  const auto between = [&](double low, double high) {
    return low + (high - low) * random.uniform();
  };
  const double cell = cloud.shape.cell;
  for (std::size_t p = 0; p < count; ++p) {
    particles.id[p] = static_cast<std::int64_t>(p);
    particles.grain[p] = random.below(2);
    for (int a = 0; a < Dim; ++a) {
      const int cells = cloud.shape.nodes[a] - 3;
      double s = cells * random.uniform();
      if (a + 1 == Dim && s >= 4.0 && s < 6.0) s -= 4.0;
      // A hat has no slope on a cell edge.
      const double offset = choice.shape == ShapeFunction::linear ? 0.25 : 0.0;
      if (random.below(20) == 0) s = 0.5 * std::floor(2.0 * s) + offset;
      particles.position[a][p] = s * cell;
      particles.velocity[a][p] = between(-500.0, 500.0);
    }
    for (auto& column : particles.affine) {
      if (!column.empty()) column[p] = between(-1e7, 1e7);
    }
    for (auto& column : particles.quadratic) {
      if (!column.empty()) column[p] = between(-100.0, 100.0);
    }
    particles.density[p] = between(2000.0, 4000.0);
    particles.mass[p] = between(0.5, 1.5) * 2700.0 * std::pow(cell, Dim) / 4.0;
    particles.pressure[p] = between(-1e9, 1e10);
    particles.viscous_pressure[p] = between(0.0, 1e9);
    for (auto& column : particles.deviator) column[p] = between(-1e9, 1e9);
  }
  return cloud;
}

/// What one rank needs for the transfers of a step.
template <int Dim>
struct Slab {
  std::unique_ptr<SlabGrid> grid;
  Particles<Dim> particles;
  CellOrder cells;
  StepData<Dim> step;
  TransferReport report;
};

/// Lowest stencil node of a particle along an axis.
template <int Dim>
int stencil_base(const Cloud<Dim>& cloud, int axis, std::size_t p) {
  const double s = cloud.particles.position[axis][p] * (1.0 / cloud.shape.cell);
  return poreshock::stencil_base(cloud.shape.stencil, s, cloud.shape.nodes[axis]);
}

/// The slab of this rank, with its particles stored in the order `storage` of the cloud.
/// Collective.
template <int Dim>
Slab<Dim> make_slab(const Cloud<Dim>& cloud, const std::vector<std::uint32_t>& storage,
                    MPI_Comm communicator) {
  Slab<Dim> slab;
  std::vector<double> weights(static_cast<std::size_t>(cloud.shape.rows), 0.0);
  for (const std::uint32_t p : storage) weights[stencil_base(cloud, Dim - 1, p)] += 1.0;
  const std::vector<int> starts =
      partition_rows(weights, size(communicator), slab_limits(cloud.shape));
  slab.grid = std::make_unique<SlabGrid>(cloud.shape, starts, communicator);
  std::vector<std::uint32_t> mine, cell;
  for (const std::uint32_t p : storage) {
    const int row = stencil_base(cloud, Dim - 1, p);
    if (slab.grid->owner(row) != rank(communicator)) continue;
    int index = row - slab.grid->first_row();
    for (int a = Dim - 2; a >= 0; --a)
      index = index * cloud.shape.nodes[a] + stencil_base(cloud, a, p);
    mine.push_back(p);
    cell.push_back(static_cast<std::uint32_t>(index));
  }
  slab.particles = cloud.particles;
  reorder(mine, slab.particles);
  const int rows = slab.grid->last_row() - slab.grid->first_row();
  sort_by_cell(cell, static_cast<std::size_t>(rows) * cloud.shape.row_size, slab.particles.grain,
               slab.particles.id, slab.cells);
  return slab;
}

/// Brings the ordered results of a gather over all rows into the order of storage.
template <int Dim>
void store_like_particles(Slab<Dim>& slab) {
  const auto bring = [&](std::vector<double>& column) {
    const std::vector<double> ordered = column;
    for (std::size_t k = 0; k < ordered.size(); ++k) column[slab.cells.order[k]] = ordered[k];
  };
  for (auto& column : slab.step.gradient) bring(column);
  for (auto& column : slab.step.rate) bring(column);
  bring(slab.step.heat);
  bring(slab.step.viscous_linear);
  bring(slab.step.viscous_quadratic);
}

/// The same, stored in the order of ids.
template <int Dim>
Slab<Dim> make_slab(const Cloud<Dim>& cloud, MPI_Comm communicator) {
  return make_slab(cloud, natural_order(cloud.particles.size()), communicator);
}

/// The column of all particles of the cloud in the order of ids, bit for bit, on every rank.
/// Collective.
template <int Dim>
std::vector<double> by_id(const Particles<Dim>& local, const std::vector<double>& column,
                          std::size_t count, MPI_Comm communicator) {
  std::vector<std::int64_t> bits(count, 0);
  for (std::size_t p = 0; p < local.size(); ++p) {
    bits[static_cast<std::size_t>(local.id[p])] = std::bit_cast<std::int64_t>(column[p]);
  }
  sum(bits, communicator);
  std::vector<double> values;
  for (const std::int64_t word : bits) values.push_back(std::bit_cast<double>(word));
  return values;
}

/// The cloud's particles as the slabs hold them now, on every rank. Collective.
template <int Dim>
Particles<Dim> all_particles(const Cloud<Dim>& cloud, const Slab<Dim>& slab,
                             MPI_Comm communicator) {
  Particles<Dim> all = cloud.particles;
  const auto collect = [&](const auto& local, auto& columns) {
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (!columns[k].empty())
        columns[k] = by_id(slab.particles, local[k], all.size(), communicator);
    }
  };
  collect(slab.particles.position, all.position);
  collect(slab.particles.velocity, all.velocity);
  collect(slab.particles.affine, all.affine);
  collect(slab.particles.quadratic, all.quadratic);
  return all;
}

}  // namespace poreshock::test
