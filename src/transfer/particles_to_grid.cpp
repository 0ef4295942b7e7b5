#include "poreshock/transfer/particles_to_grid.hpp"

#include "poreshock/transfer/node_lanes.hpp"
#include "poreshock/transfer/sweep.hpp"

namespace poreshock {

namespace {

/// Which kinetic energy of its particles a node sums: FLIP and FMPM lose none on the way, PIC that
/// of v_p, APIC that of v_p + C_p d.
enum class KineticEnergy { none, plain, affine };

/// What one particle gives to a node at offset d with weight N and slope dN, linear in both:
/// N (constant + sum_k linear_k d_k) + sum_k dN_k force_k, plus the affine kinetic energy,
/// quadratic in d, which stands in the kinetic lane of `quadratic`.
template <int Dim>
struct Contribution {
  Lanes constant;
  std::array<Lanes, Dim> linear;
  std::array<Lanes, Dim> force;
  std::array<std::array<Lanes, Dim>, Dim> quadratic;  ///< m C_k . C_l / 2
};

/// A node's sums from their parts. Built at once: writing single lanes would go through memory.
template <int Dim>
inline Lanes sum_lanes(double mass, const std::array<double, Dim>& momentum,
                       const std::array<double, Dim>& force, double kinetic) {
  if constexpr (Dim == 2) {
    return Lanes{mass, momentum[0], momentum[1], force[0], force[1], kinetic, 0.0, 0.0};
  } else {
    return Lanes{mass,     momentum[0], momentum[1], momentum[2],
                 force[0], force[1],    force[2],    kinetic};
  }
}

template <int Dim>
inline int symmetric_index(int a, int b) {
  constexpr int plane[2][2] = {{0, 3}, {3, 1}};
  constexpr int space[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
  if constexpr (Dim == 2) {
    return plane[a][b];
  } else {
    return space[a][b];
  }
}

template <int Dim, KineticEnergy Kinetic>
inline Contribution<Dim> contribution(const Particles<Dim>& particles, std::uint32_t p,
                                      double pressure, double cell) {
  constexpr std::array<double, Dim> none{};
  Contribution<Dim> c{};
  const double m = particles.mass[p];
  const double volume_per_cell = m / (particles.density[p] * cell);  // slopes are per cell
  std::array<double, Dim> v, momentum;
  double speed2 = 0.0;
  for (int a = 0; a < Dim; ++a) {
    v[a] = particles.velocity[a][p];
    momentum[a] = m * v[a];
    speed2 += v[a] * v[a];
  }
  c.constant =
      sum_lanes<Dim>(m, momentum, none, Kinetic != KineticEnergy::none ? 0.5 * m * speed2 : 0.0);
  if constexpr (Kinetic == KineticEnergy::affine) {
    std::array<std::array<double, Dim>, Dim> column;  // C_k in velocity per cell
    for (int k = 0; k < Dim; ++k) {
      double along = 0.0;
      for (int a = 0; a < Dim; ++a) {
        column[k][a] = particles.affine[a * Dim + k][p] * cell;
        momentum[a] = m * column[k][a];
        along += v[a] * column[k][a];
      }
      c.linear[k] = sum_lanes<Dim>(0.0, momentum, none, m * along);
    }
    for (int k = 0; k < Dim; ++k) {
      for (int l = 0; l < Dim; ++l) {
        double product = 0.0;
        for (int a = 0; a < Dim; ++a) product += column[k][a] * column[l][a];
        c.quadratic[k][l] = sum_lanes<Dim>(0.0, none, none, 0.5 * m * product);
      }
    }
  }
  for (int k = 0; k < Dim; ++k) {
    std::array<double, Dim> force;
    for (int a = 0; a < Dim; ++a) {
      double stress = particles.deviator[symmetric_index<Dim>(a, k)][p];
      if (a == k) stress -= pressure;
      force[a] = -volume_per_cell * stress;  // eq 14
    }
    c.force[k] = sum_lanes<Dim>(0.0, none, force, 0.0);
  }
  return c;
}

template <class Spline, bool Affine>
inline void accumulate(const Contribution<2>& c, const Stencil<2, Spline>& s, Lanes* sums) {
  constexpr int w = Spline::width;
  const AxisWeights<w>& x = s.axis[0];
  const AxisWeights<w>& y = s.axis[1];
  // Per row of nodes: the slope for the force lanes, the squared offset for the kinetic lane.
  Lanes factor[w];
  for (int j = 0; j < w; ++j) {
    const double square = y.value[j] * (y.offset[j] * y.offset[j]);
    factor[j] = sum_lanes<2>(0.0, {0.0, 0.0}, {y.slope[j], y.slope[j]}, square);
  }
  const Lanes last = Affine ? c.force[1] + c.quadratic[1][1] : c.force[1];
#pragma GCC unroll 4
  for (int i = 0; i < w; ++i) {
    Lanes even = x.value[i] * c.constant + x.slope[i] * c.force[0];
    Lanes odd{};
    if constexpr (Affine) {
      const double moment = x.value[i] * x.offset[i];
      even += moment * (c.linear[0] + x.offset[i] * c.quadratic[0][0]);
      odd = x.value[i] * c.linear[1] + (2.0 * moment) * c.quadratic[0][1];
    }
    const Lanes end = x.value[i] * last;
#pragma GCC unroll 4
    for (int j = 0; j < w; ++j) {
      Lanes sum = y.value[j] * even + factor[j] * end;
      if constexpr (Affine) sum += (y.value[j] * y.offset[j]) * odd;
      sums[j * w + i] += sum;
    }
  }
}

template <class Spline, bool Affine>
inline void accumulate(const Contribution<3>& c, const Stencil<3, Spline>& s, Lanes* sums) {
  constexpr int w = Spline::width;
  for (int k = 0; k < w; ++k) {
    for (int j = 0; j < w; ++j) {
      const double yz = s.axis[1].value[j] * s.axis[2].value[k];
      const double dy = s.axis[1].offset[j], dz = s.axis[2].offset[k];
      Lanes even = c.constant;
      Lanes cross{};
      if constexpr (Affine) {
        even += dy * c.linear[1] + dz * c.linear[2];
        even += (dy * dy) * c.quadratic[1][1] + (dz * dz) * c.quadratic[2][2] +
                (2.0 * (dy * dz)) * c.quadratic[1][2];
        cross = c.linear[0] + (2.0 * dy) * c.quadratic[0][1] + (2.0 * dz) * c.quadratic[0][2];
      }
      const Lanes slope = (s.axis[1].slope[j] * s.axis[2].value[k]) * c.force[1] +
                          (s.axis[1].value[j] * s.axis[2].slope[k]) * c.force[2];
      for (int i = 0; i < w; ++i) {
        Lanes sum = even;
        if constexpr (Affine) {
          const double dx = s.axis[0].offset[i];
          sum += dx * (cross + dx * c.quadratic[0][0]);
        }
        sums[(k * w + j) * w + i] += (s.axis[0].value[i] * yz) * sum + s.axis[0].value[i] * slope +
                                     (s.axis[0].slope[i] * yz) * c.force[0];
      }
    }
  }
}

template <int Dim, KineticEnergy Kinetic, class Spline>
void sweep(const Spline& spline, const Particles<Dim>& particles, const CellOrder& cells,
           const StepData<Dim>& step, bool averaging, SlabGrid& grid) {
  const double cell = grid.shape().cell;
  scatter<Dim>(
      spline, particles, cells,
      [&](std::uint32_t p, const Stencil<Dim, Spline>& stencil, Lanes* sums) {
        const double pressure = averaging ? step.averaged_pressure[p]
                                          : particles.pressure[p] + particles.viscous_pressure[p];
        accumulate<Spline, Kinetic == KineticEnergy::affine>(
            contribution<Dim, Kinetic>(particles, p, pressure, cell), stencil, sums);
      },
      grid);
}

}  // namespace

template <int Dim>
void particles_to_grid(const Particles<Dim>& particles, const CellOrder& cells,
                       const Transfer& transfer, const StepData<Dim>& step, SlabGrid& grid) {
  const bool averaging = transfer.averaging > 0.0;
  with_shape(transfer, [&]<class Spline>(const Spline& spline) {
    if constexpr (is_spline<Spline>) {
      if (transfer.velocity == VelocityTransfer::apic) {
        return sweep<Dim, KineticEnergy::affine>(spline, particles, cells, step, averaging, grid);
      }
      if (transfer.velocity == VelocityTransfer::pic) {
        return sweep<Dim, KineticEnergy::plain>(spline, particles, cells, step, averaging, grid);
      }
    }
    sweep<Dim, KineticEnergy::none>(spline, particles, cells, step, averaging, grid);
  });
}

template void particles_to_grid<2>(const Particles<2>&, const CellOrder&, const Transfer&,
                                   const StepData<2>&, SlabGrid&);
template void particles_to_grid<3>(const Particles<3>&, const CellOrder&, const Transfer&,
                                   const StepData<3>&, SlabGrid&);

}  // namespace poreshock
