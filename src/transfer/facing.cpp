#include "poreshock/transfer/facing.hpp"

#include <algorithm>
#include <cmath>

#include "poreshock/transfer/blocks.hpp"
#include "poreshock/transfer/sweep.hpp"

namespace poreshock {

namespace {

constexpr double least_emptiness = 0.02;  // less is noise of the lattice of particles
constexpr double least_slope = 1.0e-9;    // per cell; less is rounding
constexpr int passes = 2;                 // of the average; two cells or more each way

/// Turns sums of volume, lane 0, and volume x number into averages; empty nodes stay zero. Fills
/// the periodic images.
void divide_by_volume(SlabGrid& averages) {
  for (int row = averages.first_row(); row < averages.node_end(); ++row) {
    Lanes* nodes = averages.row(row);
    for (int i = 0; i < averages.shape().row_size; ++i) {
      const double volume = nodes[i][0];
      if (volume > 0.0) nodes[i] = nodes[i] / volume;
    }
  }
  averages.fill_periodic_images();
}

/// Volume-weighted average of a number per particle, to the nodes: lane 1. Collective.
template <int Dim, class Spline>
void average_to_nodes(const Spline& spline, const Particles<Dim>& particles, const CellOrder& cells,
                      const std::vector<double>& field, SlabGrid& grid) {
  scatter_values<Dim, 2>(
      spline, particles, cells,
      [&](std::uint32_t p) {
        const double volume = particles.mass[p] / particles.density[p];
        return std::array<double, 2>{volume, volume * field[p]};
      },
      grid);
  grid.exchange();
  divide_by_volume(grid);
}

/// One lane of the nodes at the particles.
template <int Dim, class Spline>
void take_values(const Spline& spline, const Particles<Dim>& particles, const CellOrder& cells,
                 const SlabGrid& grid, int lane, std::vector<double>& values) {
  gather<Dim>(spline, particles, cells, grid,
              [&](std::uint32_t p, const Stencil<Dim, Spline>& stencil, const Lanes* nodes) {
                double sum = 0.0;
                for (int n = 0; n < stencil_nodes<Dim, Spline>; ++n) {
                  sum += node_weight<Dim, Spline>(stencil, n) * nodes[n][lane];
                }
                values[p] = sum;
              });
}

/// Direction of the gradient of lane 1 at the particles.
template <int Dim, class Spline>
void take_directions(const Spline& spline, const CellOrder& cells, const SlabGrid& grid,
                     Particles<Dim>& particles) {
  gather<Dim>(spline, particles, cells, grid,
              [&](std::uint32_t p, const Stencil<Dim, Spline>& stencil, const Lanes* nodes) {
                std::array<double, Dim> slope{};
                double square = 0.0;
                for (int a = 0; a < Dim; ++a) {
                  for (int n = 0; n < stencil_nodes<Dim, Spline>; ++n) {
                    slope[a] += node_slope<Dim, Spline>(stencil, n, a) * nodes[n][1];
                  }
                  square += slope[a] * slope[a];
                }
                const double length = std::sqrt(square);
                const bool faces = length > least_slope;
                for (int a = 0; a < Dim; ++a) {
                  particles.facing[a][p] = faces ? slope[a] / length : 0.0;
                }
              });
}

}  // namespace

template <int Dim>
void find_facing(const CellOrder& cells, const Transfer& transfer, SlabGrid& grid,
                 Particles<Dim>& particles) {
  std::vector<double> field(particles.size());
  with_shape(transfer, [&](const auto& spline) {
    take_values<Dim>(spline, particles, cells, grid, 0, field);
    for (double& x : field) x = 1.0 - x > least_emptiness ? 1.0 - x : 0.0;
    for (int pass = 0; pass < passes; ++pass) {
      average_to_nodes<Dim>(spline, particles, cells, field, grid);
      take_values<Dim>(spline, particles, cells, grid, 1, field);
    }
    take_directions<Dim>(spline, cells, grid, particles);
  });
}

template <>
void turn_facing<2>(const std::array<std::vector<double>, 4>& gradient, double dt,
                    std::span<const std::uint32_t> places, Particles<2>& particles) {
  for (std::size_t k = 0; k < places.size(); ++k) {
    const std::uint32_t p = places[k];
    const double x = particles.facing[0][p], y = particles.facing[1][p];
    if (x == 0.0 && y == 0.0) continue;
    // The inverse of a 2 x 2 matrix, but for its determinant, has the same numbers in other places.
    const double fx = (1.0 + dt * gradient[3][k]) * x - dt * gradient[2][k] * y;
    const double fy = (1.0 + dt * gradient[0][k]) * y - dt * gradient[1][k] * x;
    const double length = std::sqrt(fx * fx + fy * fy);
    if (!(length > 0.0)) continue;
    particles.facing[0][p] = fx / length;
    particles.facing[1][p] = fy / length;
  }
}

// A scene in 3-D has no self-contact.
template <>
void turn_facing<3>(const std::array<std::vector<double>, 9>&, double,
                    std::span<const std::uint32_t>, Particles<3>&) {}

template void find_facing<2>(const CellOrder&, const Transfer&, SlabGrid&, Particles<2>&);
template void find_facing<3>(const CellOrder&, const Transfer&, SlabGrid&, Particles<3>&);

}  // namespace poreshock
