#include "poreshock/physics/heat.hpp"

#include <algorithm>
#include <limits>

#include "poreshock/material/derived.hpp"
#include "poreshock/transfer/sweep.hpp"

namespace poreshock {

namespace {

/// Calls visit(n, N, grad N) for all nodes of a stencil; gradients are per cell.
template <int Dim, class Spline, class Visit>
inline void for_each_weight(const Stencil<Dim, Spline>& s, Visit&& visit) {
  constexpr int w = Spline::width;
  const auto& x = s.axis[0];
  const auto& y = s.axis[1];
  for (int j = 0; j < w; ++j) {
    for (int i = 0; i < w; ++i) {
      const double value = x.value[i] * y.value[j];
      const double along_x = x.slope[i] * y.value[j], along_y = x.value[i] * y.slope[j];
      if constexpr (Dim == 2) {
        visit(j * w + i, value, std::array<double, 2>{along_x, along_y});
      } else {
        const auto& z = s.axis[2];
        for (int k = 0; k < w; ++k) {
          visit((k * w + j) * w + i, value * z.value[k],
                std::array<double, 3>{along_x * z.value[k], along_y * z.value[k],
                                      value * z.slope[k]});
        }
      }
    }
  }
}

/// Turns the energies of all nodes into temperatures; empty nodes stay zero. Fills the periodic
/// images.
void divide_by_capacity(SlabGrid& grid) {
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    Lanes* nodes = grid.row(row);
    for (int i = 0; i < grid.shape().row_size; ++i) {
      const double capacity = nodes[i][HeatLane::capacity];
      if (capacity > 0.0) nodes[i] = nodes[i] / capacity;
    }
  }
  grid.fill_periodic_images();
}

/// Nodal temperatures from the particles. Collective.
template <int Dim, class Spline>
void collect_temperature(const std::vector<Material>& materials, Thermal thermal,
                         const CellOrder& cells, const Particles<Dim>& particles, SlabGrid& grid) {
  scatter<Dim>(
      Spline{}, particles, cells,
      [&](std::uint32_t p, const Stencil<Dim, Spline>& stencil, Lanes* sums) {
        const auto material = static_cast<std::size_t>(particles.material[p]);
        const double capacity = particles.mass[p] * materials[material].eos.cv;
        const double T = particle_temperature<Dim>(particles, materials, thermal, p);
        const Lanes sum{capacity, capacity * T};
        for_each_weight<Dim, Spline>(
            stencil, [&](int n, double value, const auto&) { sums[n] += value * sum; });
      },
      grid);
  grid.exchange();
  divide_by_capacity(grid);
}

/// Gradient of the nodal temperature at the particles, and their excess over it.
template <int Dim, class Spline>
void take_gradient(const std::vector<Material>& materials, Thermal thermal, const CellOrder& cells,
                   const SlabGrid& grid, const Particles<Dim>& particles, HeatFlow<Dim>& scratch) {
  const double inverse_cell = 1.0 / grid.shape().cell;
  for (auto& column : scratch.gradient) column.resize(particles.size());
  scratch.excess.resize(particles.size());
  gather<Dim>(
      Spline{}, particles, cells, grid,
      [&](std::uint32_t p, const Stencil<Dim, Spline>& stencil, const Lanes* nodes) {
        std::array<double, Dim> sum{};
        double mean = 0.0;
        for_each_weight<Dim, Spline>(stencil, [&](int n, double value, const auto& gradient) {
          const double T = nodes[n][HeatLane::temperature];
          mean += value * T;
          for (int a = 0; a < Dim; ++a) sum[a] += gradient[a] * T;
        });
        for (int a = 0; a < Dim; ++a) scratch.gradient[a][p] = inverse_cell * sum[a];
        scratch.excess[p] = particle_temperature<Dim>(particles, materials, thermal, p) - mean;
      });
}

/// Rise of the nodal temperatures by what particles hand over; their excess becomes the share that
/// they hand over. Collective.
template <int Dim, class Spline>
void collect_heat(const std::vector<Material>& materials, const CellOrder& cells, double dt,
                  const Particles<Dim>& particles, HeatFlow<Dim>& scratch, SlabGrid& grid) {
  const double inverse_cell = 1.0 / grid.shape().cell;
  const double excess_rate = 2.0 * Spline::inverse_inertia * (inverse_cell * inverse_cell);
  scatter<Dim>(
      Spline{}, particles, cells,
      [&](std::uint32_t p, const Stencil<Dim, Spline>& stencil, Lanes* sums) {
        const Material& m = materials[static_cast<std::size_t>(particles.material[p])];
        const double solid = m.eos.density;
        const double density = particles.density[p] > solid ? particles.density[p] : solid;
        const double conductance = dt * m.conductivity * (particles.mass[p] / density);
        const double capacity = particles.mass[p] * m.eos.cv;
        scratch.excess[p] *= excess_rate * conductance / capacity;
        std::array<double, Dim> flow;
        for (int a = 0; a < Dim; ++a) {
          flow[a] = conductance * inverse_cell * scratch.gradient[a][p];
        }
        for_each_weight<Dim, Spline>(stencil, [&](int n, double value, const auto& gradient) {
          double heat = capacity * value * scratch.excess[p];
          for (int a = 0; a < Dim; ++a) heat -= flow[a] * gradient[a];
          sums[n] += Lanes{capacity * value, heat};
        });
      },
      grid);
  grid.exchange();
  divide_by_capacity(grid);
}

/// Particles take their share of the rise and lose what they handed over; returns the quanta they
/// gain.
template <int Dim, class Spline>
Int128 take_heat(const std::vector<Material>& materials, const CellOrder& cells,
                 double inverse_quantum, const SlabGrid& grid, const HeatFlow<Dim>& scratch,
                 Particles<Dim>& particles) {
  const bool separate = particles.options.conducted_heat;
  Int128 sum = 0;
  gather<Dim>(Spline{}, particles, cells, grid,
              [&](std::uint32_t p, const Stencil<Dim, Spline>& stencil, const Lanes* nodes) {
                double rise = -scratch.excess[p];
                for_each_weight<Dim, Spline>(stencil, [&](int n, double value, const auto&) {
                  rise += value * nodes[n][HeatLane::temperature];
                });
                const double heat =
                    materials[static_cast<std::size_t>(particles.material[p])].eos.cv * rise;
                particles.internal_energy[p] += heat;
                if (separate) particles.conducted_heat[p] += heat;
                sum += quantise(particles.mass[p] * heat, inverse_quantum);
              });
  return sum;
}

}  // namespace

template <int Dim>
void conduct_heat(const std::vector<Material>& materials, const HeatSettings& settings,
                  const CellOrder& cells, SlabGrid& grid, HeatFlow<Dim>& scratch,
                  Particles<Dim>& particles, Int128& gained) {
  of_shape(settings.shape, [&]<class Shape>(const Shape&) {
    if constexpr (has_inertia<Shape>) {
      collect_temperature<Dim, Shape>(materials, settings.thermal, cells, particles, grid);
      take_gradient<Dim, Shape>(materials, settings.thermal, cells, grid, particles, scratch);
      collect_heat<Dim, Shape>(materials, cells, settings.dt, particles, scratch, grid);
      gained += take_heat<Dim, Shape>(materials, cells, settings.inverse_energy_quantum, grid,
                                      scratch, particles);
    }
  });
}

double conduction_limit(const std::vector<Material>& materials, ShapeFunction shape, int dimension,
                        double cell) {
  double diffusivity = 0.0;
  for (const Material& m : materials) {
    diffusivity = std::max(diffusivity, m.conductivity / (m.eos.density * m.eos.cv));
  }
  if (!(diffusivity > 0.0)) return std::numeric_limits<double>::infinity();
  const double spread = of_shape(shape, []<class Shape>(const Shape&) {
    if constexpr (has_inertia<Shape>) return Shape::stiffness;
    return 0.0;
  });
  return cell * cell / (dimension * spread * diffusivity);
}

template void conduct_heat<2>(const std::vector<Material>&, const HeatSettings&, const CellOrder&,
                              SlabGrid&, HeatFlow<2>&, Particles<2>&, Int128&);
template void conduct_heat<3>(const std::vector<Material>&, const HeatSettings&, const CellOrder&,
                              SlabGrid&, HeatFlow<3>&, Particles<3>&, Int128&);

}  // namespace poreshock
