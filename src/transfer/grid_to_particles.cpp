#include "poreshock/transfer/grid_to_particles.hpp"

#include <bit>

#include "jump_limiter.hpp"
#include "lane_particles.hpp"
#include "velocity_modes.hpp"

namespace poreshock {

namespace {

/// Eight particles in canonical order; an incomplete group repeats its last one.
struct Group {
  LaneParticles particles;
  int count;          ///< distinct ones
  std::size_t place;  ///< of the first, from the first particle of the sweep
};

/// Stores the results of a group side by side.
inline void store_ordered(const Lanes& lanes, const Group& group, std::vector<double>& column) {
  double values[lane_count];
  *reinterpret_cast<Lanes*>(values) = lanes;
  double* const target = column.data() + group.place;
  if (group.count == lane_count) {
    *reinterpret_cast<Lanes*>(target) = lanes;
  } else {
    std::copy(values, values + group.count, target);
  }
}

template <int Dim, Modes M, class Spline>
inline ModeLanes<Dim, M> load_modes(const Group& group, double cell, const ModeNorms<Dim, M>& norm,
                                    const Particles<Dim>& particles) {
  ModeLanes<Dim, M> c;
  for (int a = 0; a < Dim; ++a) {
    c[0][a] = load(particles.velocity[a], group.particles);
    if constexpr (M != Modes::constant) {
      for (int k = 0; k < Dim; ++k)
        c[1 + k][a] = cell * load(particles.affine[a * Dim + k], group.particles);
    }
    if constexpr (M == Modes::quadratic) {
      for (int k = 0; k < second_modes<Dim>; ++k) {
        const auto& column = particles.quadratic[a * second_modes<Dim> + k];
        const Lanes amplitude = load(column, group.particles);
        c[1 + Dim + k][a] =
            k < Dim ? norm.inverse_root[k] * amplitude : Spline::inverse_inertia * amplitude;
      }
    }
  }
  return c;
}

template <int Dim, Modes M, class Spline>
inline void store_modes(const ModeLanes<Dim, M>& c, const Group& group, double cell,
                        const ModeNorms<Dim, M>& norm, Particles<Dim>& particles) {
  for (int a = 0; a < Dim; ++a) {
    store(c[0][a], group.particles, particles.velocity[a]);
    if constexpr (M != Modes::constant) {
      for (int k = 0; k < Dim; ++k) {
        store((1.0 / cell) * c[1 + k][a], group.particles, particles.affine[a * Dim + k]);
      }
    }
    if constexpr (M == Modes::quadratic) {
      for (int k = 0; k < second_modes<Dim>; ++k) {
        const Lanes mode = c[1 + Dim + k][a];
        store(k < Dim ? norm.root[k] * mode : (1.0 / Spline::inverse_inertia) * mode,
              group.particles, particles.quadratic[a * second_modes<Dim> + k]);
      }
    }
  }
}

template <int Dim, Modes M>
inline void store_gradients(const GroupMoments<Dim, M>& m, const Group& group,
                            StepData<Dim>& step) {
  using Lane = MotionLane<Dim>;
  std::array<std::array<Lanes, Dim>, Dim> middle;
  for (int a = 0; a < Dim; ++a) {
    for (int k = 0; k < Dim; ++k) {
      const Lanes end = m.gradient[k][Lane::end_velocity + a];
      store_ordered(end, group, step.gradient[a * Dim + k]);
      middle[a][k] = 0.5 * (m.gradient[k][Lane::start_velocity + a] + end);
    }
  }
  const auto rate = symmetric_part<Dim>(middle);
  for (int k = 0; k < rate_size<Dim>; ++k) store_ordered(rate[k], group, step.rate[k]);
}

/// Gives the particles of a group their new modes; returns the heat of the transfer, J/kg.
template <int Dim, Modes M, Keeps Kept, class Spline>
inline Lanes update_modes(const GroupMoments<Dim, M>& m, double cell,
                          const ParticleMotion<Dim>& motion, const Group& group,
                          Particles<Dim>& particles, TransferReport& report) {
  using Lane = MotionLane<Dim>;
  double inertia = 1.0;
  if constexpr (M != Modes::constant) inertia = 1.0 / Spline::inverse_inertia;
  const ModeNorms<Dim, M> norm = mode_norms<Dim, M>(inertia, m.local);
  const ModeLanes<Dim, M> old = load_modes<Dim, M, Spline>(group, cell, norm, particles);
  const ModeLanes<Dim, M> start = mode_moments<Dim, M>(m, inertia, norm, Lane::start_velocity);
  const ModeLanes<Dim, M> end = mode_moments<Dim, M>(m, inertia, norm, Lane::end_velocity);
  Lanes heat =
      transfer_heat<Dim, M, Kept>(old, start, end, norm, m.value[Lane::kinetic], motion.lost);
  ModeLanes<Dim, M> modes = new_modes<Dim, M, Kept>(old, start, end, motion.lost);
  if constexpr (M != Modes::constant && Kept == Keeps::velocity) {
    report.shortened +=
        shorten<Dim, M>(norm, group.count, modes, motion.least_heat - Lanes{}, heat);
  }
  if constexpr (M != Modes::constant && Kept == Keeps::all) {
    turn_affine<Dim, M>(m.gradient, motion.dt, modes);
  }
  store_modes<Dim, M, Spline>(modes, group, cell, norm, particles);
  return heat;
}

/// Counts what the heat of a group adds to the report: rounding of the energies that cancel in it
/// is no negative heat.
template <int Dim, Modes M>
inline void book_heat(const Lanes& heat, const GroupMoments<Dim, M>& m, const Lanes& mass,
                      const ParticleMotion<Dim>& motion, const Group& group,
                      TransferReport& report) {
  using Lane = MotionLane<Dim>;
  Lanes square = m.value[Lane::kinetic];
  for (int a = 0; a < Dim; ++a) {
    square += m.value[Lane::end_velocity + a] * m.value[Lane::end_velocity + a];
  }
  const Lanes zero{}, least = zero - (1e-12 * square + (motion.least_heat - zero));
  report.negative += std::popcount(bits_less(heat, least) & first_bits(group.count));
  report.heat += sum_of_quanta(mass * heat, group.count, motion.inverse_energy_quantum);
}

/// Compresses particles whose nodes grains overfill, as far as their heat pays for it; returns what
/// it pays, J/kg.
template <int Dim, Modes M>
inline Lanes squeeze(const GroupMoments<Dim, M>& m, const Lanes& heat,
                     const ParticleMotion<Dim>& motion, const Group& group,
                     const Particles<Dim>& particles, StepData<Dim>& step) {
  using Lane = MotionLane<Dim>;
  const Lanes zero{};
  // Work of a strain s: (p/rho + c^2 s/2) s.
  const Lanes start =
      load(particles.pressure, group.particles) / load(particles.density, group.particles);
  const Lanes purse = larger(zero, heat);
  const Lanes affordable =
      (2.0 * purse) / (start + square_root(start * start + (2.0 * motion.stiffness) * purse));
  const Lanes wanted = motion.squeezed * m.value[Lane::overfill];
  const Lanes least = where_less(affordable, wanted, affordable, wanted);
  const Lanes strain = where_less(zero, start, least, zero);
  const Lanes paid = (start + (0.5 * motion.stiffness) * strain) * strain;
  for (int a = 0; a < Dim; ++a) {
    const Lanes rate = (1.0 / (Dim * motion.dt)) * strain;
    store_ordered(m.gradient[a][Lane::end_velocity + a] - rate, group, step.gradient[a * Dim + a]);
  }
  return paid;
}

/// Moves the particles of a group.
template <int Dim, Modes M, Keeps Kept, class Spline>
inline void move_group(const GroupMoments<Dim, M>& m, double cell,
                       const ParticleMotion<Dim>& motion, const Group& group,
                       Particles<Dim>& particles, StepData<Dim>& step, TransferReport& report) {
  using Lane = MotionLane<Dim>;
  const Lanes heat = update_modes<Dim, M, Kept, Spline>(m, cell, motion, group, particles, report);
  for (int a = 0; a < Dim; ++a) {
    const Lanes v = m.value[Lane::end_velocity + a];
    const Lanes x = load(particles.position[a], group.particles);
    store(x + motion.dt * (v - motion.grid_velocity[a]), group.particles, particles.position[a]);
  }
  store_gradients<Dim, M>(m, group, step);
  if constexpr (shows_jumps<Spline>) {
    if (motion.limited) {
      const ViscousShares shares = viscous_shares<Dim, M>(m);
      store_ordered(shares.linear, group, step.viscous_linear);
      store_ordered(shares.quadratic, group, step.viscous_quadratic);
    }
  }
  const Lanes mass = load(particles.mass, group.particles);
  const Lanes all_heat = m.value[Lane::heat] + heat;
  store_ordered(all_heat, group, step.heat);
  if constexpr (shows_overfill<Dim>) {
    if (motion.squeezed > 0.0) {
      const Lanes paid = squeeze<Dim, M>(m, all_heat, motion, group, particles, step);
      report.squeezing += sum_of_quanta(mass * paid, group.count, motion.inverse_energy_quantum);
    }
  }
  book_heat<Dim, M>(heat, m, mass, motion, group, report);
}

// Flattened: a call per value would cost more than the arithmetic.
template <int Dim, Modes M, Keeps Kept, class Spline>
[[gnu::flatten]] TransferReport sweep(const Spline& spline, const SlabGrid& grid,
                                      const CellOrder& cells, RowRange rows,
                                      const ParticleMotion<Dim>& motion, Particles<Dim>& particles,
                                      StepData<Dim>& step) {
  TransferReport report;
  const double cell = grid.shape().cell;
  const double inverse_cell = 1.0 / cell;
  std::array<Moments<Dim, M, shows_jumps<Spline>>, lane_count> pending;
  Group group{};
  const auto finish_group = [&] {
    auto& [index, adjacent] = group.particles;
    for (int n = group.count; n < lane_count; ++n) {
      pending[n] = pending[group.count - 1];
      index[n] = index[group.count - 1];
    }
    adjacent = group.count == lane_count;
    for (std::uint32_t n = 1; n < lane_count; ++n) {
      adjacent = adjacent && index[n] == index[0] + n;
    }
    GroupMoments<Dim, M> m;
    group_moments<Dim, Spline, M>(pending.data(), inverse_cell, m);
    move_group<Dim, M, Kept, Spline>(m, cell, motion, group, particles, step, report);
    group.place += group.count;
    group.count = 0;
  };
  gather_with<Dim, Spline, PointWeights<Dim>>(
      [&](std::uint32_t p, const std::array<int, Dim>& base, PointWeights<Dim>& w) {
        set_point_weights<Dim>(spline, particles, p, base, inverse_cell, w);
      },
      particles, cells, grid, rows,
      [&](std::uint32_t p, const PointWeights<Dim>& w, const Lanes* nodes) {
        group.particles.index[group.count] = p;
        take_moments<Dim, Spline, M>(w, nodes, pending[group.count]);
        if (++group.count == lane_count) finish_group();
      });
  if (group.count > 0) finish_group();
  return report;
}

/// Share that decays in a step, at a rate by which it does while sound crosses a cell.
double decayed_share(double rate, double sound_speed, double cell, double dt) {
  const double x = rate * sound_speed * dt / cell;
  return x / (1.0 + x);
}

}  // namespace

TransferReport& TransferReport::operator+=(const TransferReport& other) {
  heat += other.heat;
  squeezing += other.squeezing;
  negative += other.negative;
  shortened += other.shortened;
  return *this;
}

double lost_share(const Transfer& transfer, double sound_speed, double cell, double dt) {
  if (scheme_of(transfer.velocity).keeps == Keeps::nothing) return 1.0;
  return decayed_share(transfer.damping, sound_speed, cell, dt);
}

double squeezed_share(double sound_speed, double cell, double dt) {
  return decayed_share(0.5, sound_speed, cell, dt);
}

template <int Dim>
void prepare_gather(double lost, SlabGrid& grid) {
  using Lane = MotionLane<Dim>;
  const Lanes* const last = grid.nodes_from(grid.node_end());
  for (Lanes* node = grid.nodes_from(grid.first_row()); node != last; ++node) {
    double increment2 = 0.0, product = 0.0;
    for (int a = 0; a < Dim; ++a) {
      const double start = (*node)[Lane::start_velocity + a];
      const double end = (*node)[Lane::end_velocity + a];
      increment2 += (end - start) * (end - start);
      product += start * end;
    }
    (*node)[Lane::kinetic] = 0.5 * increment2 + lost * product;
  }
  grid.fill_periodic_images();
}

template <int Dim>
TransferReport grid_to_particles(const SlabGrid& grid, const CellOrder& cells, RowRange rows,
                                 const Transfer& transfer, const ParticleMotion<Dim>& how,
                                 Particles<Dim>& particles, StepData<Dim>& step) {
  TransferReport report;
  resize_ordered(first_place(cells, grid, rows.last) - first_place(cells, grid, rows.first), step);
  with_scheme(transfer, [&]<Modes M, Keeps Kept, class Spline>(const Spline& spline) {
    report = sweep<Dim, M, Kept>(spline, grid, cells, rows, how, particles, step);
  });
  return report;
}

template void prepare_gather<2>(double, SlabGrid&);
template void prepare_gather<3>(double, SlabGrid&);
template TransferReport grid_to_particles<2>(const SlabGrid&, const CellOrder&, RowRange,
                                             const Transfer&, const ParticleMotion<2>&,
                                             Particles<2>&, StepData<2>&);
template TransferReport grid_to_particles<3>(const SlabGrid&, const CellOrder&, RowRange,
                                             const Transfer&, const ParticleMotion<3>&,
                                             Particles<3>&, StepData<3>&);

}  // namespace poreshock
