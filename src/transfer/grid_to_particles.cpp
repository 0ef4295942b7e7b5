#include "poreshock/transfer/grid_to_particles.hpp"

#include "moments.hpp"

namespace poreshock {

namespace {

/// Eight particles in canonical order; an incomplete group repeats its last one.
struct Group {
  std::array<std::uint32_t, lane_count> particles;
  int count;          ///< distinct ones
  std::size_t place;  ///< of the first, from the first particle of the sweep
};

inline Lanes load(const std::vector<double>& column, const Group& group) {
  double values[lane_count];
  for (int n = 0; n < lane_count; ++n) values[n] = column[group.particles[n]];
  return *reinterpret_cast<const Lanes*>(values);
}

inline void store(const Lanes& lanes, const Group& group, std::vector<double>& column) {
  double values[lane_count];
  *reinterpret_cast<Lanes*>(values) = lanes;
  double* const target = column.data();
  for (int n = 0; n < lane_count; ++n) target[group.particles[n]] = values[n];
}

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

/// Velocity by APIC; returns the kinetic energy per mass the projection onto (v, C) loses.
template <int Dim, class Spline>
inline Lanes apply_apic(const GroupMoments<Dim>& m, double cell, const Group& group,
                        Particles<Dim>& particles) {
  using Lane = MotionLane<Dim>;
  Lanes kept{}, spin{};
  const double scale = Spline::inverse_inertia / cell;  // moments are in cells
  for (int a = 0; a < Dim; ++a) {
    const Lanes v = m.value[Lane::end_velocity + a];
    store(v, group, particles.velocity[a]);
    kept += v * v;
    for (int k = 0; k < Dim; ++k) {
      const Lanes moment = m.moment[k][Lane::end_velocity + a];
      store(scale * moment, group, particles.affine[a * Dim + k]);
      spin += moment * moment;
    }
  }
  return m.value[Lane::kinetic] - 0.5 * (kept + Spline::inverse_inertia * spin);
}

/// Velocity by PIC; returns the kinetic energy per mass the interpolation loses.
template <int Dim>
inline Lanes apply_pic(const GroupMoments<Dim>& m, const Group& group, Particles<Dim>& particles) {
  Lanes kept{};
  for (int a = 0; a < Dim; ++a) {
    const Lanes v = m.value[MotionLane<Dim>::end_velocity + a];
    store(v, group, particles.velocity[a]);
    kept += v * v;
  }
  return m.value[MotionLane<Dim>::kinetic] - 0.5 * kept;
}

/// Velocity by FLIP with damping towards the grid; returns the kinetic energy per mass it loses.
template <int Dim>
inline Lanes apply_flip(const GroupMoments<Dim>& m, double damped, const Group& group,
                        Particles<Dim>& particles) {
  using Lane = MotionLane<Dim>;
  Lanes increment2{}, noise2{}, product{};
  for (int a = 0; a < Dim; ++a) {
    const Lanes start = m.value[Lane::start_velocity + a];
    const Lanes end = m.value[Lane::end_velocity + a];
    const Lanes old = load(particles.velocity[a], group);
    const Lanes increment = end - start;
    const Lanes noise = old - start;
    increment2 += increment * increment;
    noise2 += noise * noise;
    product += start * end;
    store((1.0 - damped) * (old + increment) + damped * end, group, particles.velocity[a]);
  }
  return m.value[Lane::kinetic] - 0.5 * increment2 +
         damped * ((1.0 - 0.5 * damped) * noise2 - product);
}

/// What the sweep needs besides particles and nodes.
template <int Dim>
struct Motion {
  double damped;
  Vector<Dim> grid_velocity;
  double dt, inverse_quantum;
  const SlabGrid* averages;  ///< null without averaging
  double averaging;          ///< share
};

template <int Dim>
inline void store_gradients(const GroupMoments<Dim>& m, const Motion<Dim>& motion,
                            const Group& group, StepData<Dim>& step) {
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
  if (motion.averages == nullptr) return;
  Lanes end{}, mid{};
  for (int a = 0; a < Dim; ++a) {
    end += m.gradient[a][Lane::end_velocity + a];
    mid += middle[a][a];
  }
  const double share = motion.averaging;
  store_ordered((1.0 - share) * end + share * m.dilatation_end, group, step.dilatation_end);
  store_ordered((1.0 - share) * mid + share * m.dilatation_mid, group, step.dilatation_mid);
}

template <int Dim, VelocityTransfer Velocity, class Spline>
inline Lanes update_velocity(const GroupMoments<Dim>& m, double cell, double damped,
                             const Group& group, Particles<Dim>& particles) {
  if constexpr (Velocity == VelocityTransfer::apic) {
    return apply_apic<Dim, Spline>(m, cell, group, particles);
  } else if constexpr (Velocity == VelocityTransfer::pic) {
    return apply_pic<Dim>(m, group, particles);
  } else {
    return apply_flip<Dim>(m, damped, group, particles);
  }
}

/// Moves the particles of a group; returns the heat of the filter, quanta.
template <int Dim, VelocityTransfer Velocity, class Spline>
inline Int128 move_group(const GroupMoments<Dim>& m, double cell, const Motion<Dim>& motion,
                         const Group& group, Particles<Dim>& particles, StepData<Dim>& step) {
  using Lane = MotionLane<Dim>;
  const Lanes lost =
      update_velocity<Dim, Velocity, Spline>(m, cell, motion.damped, group, particles);
  for (int a = 0; a < Dim; ++a) {
    const Lanes v = m.value[Lane::end_velocity + a];
    const Lanes x = load(particles.position[a], group);
    store(x + motion.dt * (v - motion.grid_velocity[a]), group, particles.position[a]);
  }
  store_gradients<Dim>(m, motion, group, step);
  store_ordered(m.value[Lane::heat] + lost, group, step.heat);
  const Lanes heat = load(particles.mass, group) * lost;
  Int128 quanta = 0;
  for (int n = 0; n < group.count; ++n) quanta += quantise(heat[n], motion.inverse_quantum);
  return quanta;
}

// Flattened: a call per value would cost more than the arithmetic.
template <int Dim, VelocityTransfer Velocity, class Spline>
[[gnu::flatten]] void sweep(const Spline& spline, const SlabGrid& grid, const CellOrder& cells,
                            RowRange rows, const Motion<Dim>& motion, Particles<Dim>& particles,
                            StepData<Dim>& step, Int128& filter_heat) {
  constexpr bool affine = Velocity == VelocityTransfer::apic;
  const GridShape& shape = grid.shape();
  const double cell = shape.cell;
  const double inverse_cell = 1.0 / cell;
  std::array<Moments<Dim>, lane_count> pending;
  std::array<Lanes, lane_count> averages{};  // 3-D only
  Group group{};
  const auto finish_group = [&] {
    for (int n = group.count; n < lane_count; ++n) {
      pending[n] = pending[group.count - 1];
      averages[n] = averages[group.count - 1];
      group.particles[n] = group.particles[group.count - 1];
    }
    auto m = group_moments<Dim, Spline, affine>(pending.data(), inverse_cell);
    take_averages<Dim, Spline>(averages, m);
    filter_heat += move_group<Dim, Velocity, Spline>(m, cell, motion, group, particles, step);
    group.place += group.count;
    group.count = 0;
  };
  gather_with<Dim, Spline>(
      [&](std::uint32_t p, const std::array<int, Dim>& base) {
        auto w = point_weights<Dim>(spline, particles, p, base, inverse_cell);
        if constexpr (Dim == 3) {
          if (motion.averages != nullptr) {
            w.averages = motion.averages->row(base[2]) + base[1] * shape.nodes[0] + base[0];
          }
        }
        return w;
      },
      particles, cells, grid, rows,
      [&](std::uint32_t p, const PointWeights<Dim>& w, const Lanes* nodes) {
        group.particles[group.count] = p;
        if constexpr (Dim == 3) {
          if (w.averages != nullptr) averages[group.count] = averages_at<Spline>(w, shape);
        }
        pending[group.count] = scaled_moments<Dim, Spline, affine>(w, nodes);
        if (++group.count == lane_count) finish_group();
      });
  if (group.count > 0) finish_group();
}

}  // namespace

template <int Dim>
void prepare_gather(const Transfer& transfer, double damped, SlabGrid& grid) {
  using Lane = MotionLane<Dim>;
  const bool end_energy = projects(transfer.velocity);
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    Lanes* nodes = grid.row(row);
    for (int i = 0; i < grid.shape().row_size; ++i) {
      double end2 = 0.0, increment2 = 0.0, product = 0.0;
      for (int a = 0; a < Dim; ++a) {
        const double start = nodes[i][Lane::start_velocity + a];
        const double end = nodes[i][Lane::end_velocity + a];
        end2 += end * end;
        increment2 += (end - start) * (end - start);
        product += start * end;
      }
      nodes[i][Lane::kinetic] = end_energy ? 0.5 * end2 : 0.5 * increment2 + damped * product;
    }
  }
  grid.fill_periodic_images();
}

template <int Dim>
void grid_to_particles(const SlabGrid& grid, const SlabGrid* averages, const CellOrder& cells,
                       RowRange rows, const Transfer& transfer, const Vector<Dim>& grid_velocity,
                       double dt, double inverse_quantum, Particles<Dim>& particles,
                       StepData<Dim>& step, Int128& filter_heat) {
  const Motion<Dim> motion = {
      damped_share(transfer, dt), grid_velocity, dt, inverse_quantum, averages, transfer.averaging};
  resize_ordered(first_place(cells, grid, rows.last) - first_place(cells, grid, rows.first),
                 averages != nullptr, step);
  with_shape(transfer, [&]<class Spline>(const Spline& spline) {
    if constexpr (is_spline<Spline>) {
      if (transfer.velocity == VelocityTransfer::apic) {
        return sweep<Dim, VelocityTransfer::apic>(spline, grid, cells, rows, motion, particles,
                                                  step, filter_heat);
      }
      if (transfer.velocity == VelocityTransfer::pic) {
        return sweep<Dim, VelocityTransfer::pic>(spline, grid, cells, rows, motion, particles, step,
                                                 filter_heat);
      }
    }
    sweep<Dim, VelocityTransfer::flip>(spline, grid, cells, rows, motion, particles, step,
                                       filter_heat);
  });
}

template void prepare_gather<2>(const Transfer&, double, SlabGrid&);
template void prepare_gather<3>(const Transfer&, double, SlabGrid&);
template void grid_to_particles<2>(const SlabGrid&, const SlabGrid*, const CellOrder&, RowRange,
                                   const Transfer&, const Vector<2>&, double, double, Particles<2>&,
                                   StepData<2>&, Int128&);
template void grid_to_particles<3>(const SlabGrid&, const SlabGrid*, const CellOrder&, RowRange,
                                   const Transfer&, const Vector<3>&, double, double, Particles<3>&,
                                   StepData<3>&, Int128&);

}  // namespace poreshock
