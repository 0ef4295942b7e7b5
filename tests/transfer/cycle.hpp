#pragma once
// One way to the nodes and back, and what particles have in total.

#include "poreshock/core/fixed_point.hpp"
#include "poreshock/transfer/grid_to_particles.hpp"
#include "poreshock/transfer/particles_to_grid.hpp"
#include "poreshock/transfer/sweep.hpp"
#include "transfer/cloud.hpp"
#include "transfer/motion.hpp"

namespace poreshock::test {

inline constexpr double time_step = 2e-9;  // s, in which sound crosses a cell

/// Sound crosses a cell of the clouds in one step.
inline double cycle_loss(const Transfer& transfer) {
  return lost_share(transfer, 5000.0, 1e-5, time_step);
}

/// How particles move in a cycle of length dt; the share lost is always that of time_step.
template <int Dim>
ParticleMotion<Dim> cycle_motion(const Transfer& transfer, double dt) {
  ParticleMotion<Dim> motion;
  motion.dt = dt;
  motion.lost = cycle_loss(transfer);
  motion.limited = transfer.shape == ShapeFunction::cubic;
  return motion;
}

/// Particles to nodes, a kick of every node, and back, on the slabs of a communicator. Returns what
/// the nodes gained in total. Collective.
template <int Dim, class Kick>
NodeGain<Dim> transfer_cycle(const Cloud<Dim>& cloud, const ParticleMotion<Dim>& motion,
                             Kick&& kick, MPI_Comm communicator, Slab<Dim>& slab) {
  particles_to_grid(slab.particles, slab.cells, cloud.transfer, *slab.grid);
  slab.grid->exchange();
  NodeGain<Dim> gain = kick_nodes<Dim>(kick, *slab.grid);
  MPI_Allreduce(MPI_IN_PLACE, &gain.work, 1, MPI_DOUBLE, MPI_SUM, communicator);
  MPI_Allreduce(MPI_IN_PLACE, gain.impulse.data(), Dim, MPI_DOUBLE, MPI_SUM, communicator);
  prepare_gather<Dim>(motion.lost, *slab.grid);
  slab.report += grid_to_particles<Dim>(*slab.grid, slab.cells, all_rows(*slab.grid),
                                        cloud.transfer, motion, slab.particles, slab.step);
  store_like_particles(slab);
  return gain;
}

/// The same over time_step.
template <int Dim, class Kick>
NodeGain<Dim> transfer_cycle(const Cloud<Dim>& cloud, Kick&& kick, MPI_Comm communicator,
                             Slab<Dim>& slab) {
  return transfer_cycle(cloud, cycle_motion<Dim>(cloud.transfer, time_step), kick, communicator,
                        slab);
}

/// Leaves the nodes alone.
template <int Dim>
Vector<Dim> no_kick(int) {
  return Vector<Dim>::Zero();
}

/// Up to 100 m/s in a direction that follows from the node.
template <int Dim>
Vector<Dim> random_kick(int node) {
  reference::Random random{static_cast<std::uint64_t>(node)};
  Vector<Dim> kick;
  for (int a = 0; a < Dim; ++a) kick[a] = 200.0 * random.uniform() - 100.0;
  return kick;
}

/// Kinetic energy with all modes, J.
template <int Dim>
double kinetic_energy(const GridShape& shape, const Particles<Dim>& particles) {
  long double energy = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    double squares = reference::velocity(particles, p).squaredNorm() +
                     reference::inertia(shape) * reference::affine(particles, p).squaredNorm();
    for (const auto& column : particles.quadratic) {
      if (!column.empty()) squares += column[p] * column[p];
    }
    energy += 0.5 * particles.mass[p] * squares;
  }
  return static_cast<double>(energy);
}

/// Sum of mass times a number per mass.
inline double total(const std::vector<double>& mass, const std::vector<double>& per_mass) {
  long double sum = 0.0;
  for (std::size_t p = 0; p < mass.size(); ++p) sum += mass[p] * per_mass[p];
  return static_cast<double>(sum);
}

/// kg m/s
template <int Dim>
Vector<Dim> momentum(const Particles<Dim>& particles) {
  Vector<Dim> sum;
  for (int a = 0; a < Dim; ++a) sum[a] = total(particles.mass, particles.velocity[a]);
  return sum;
}

/// x v^T - v x^T summed over mass, with the spin of affine particles, kg m^2/s.
template <int Dim>
Matrix<Dim> angular_momentum(const GridShape& shape, const Particles<Dim>& particles) {
  Matrix<Dim> sum = Matrix<Dim>::Zero();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Matrix<Dim> product =
        reference::position(particles, p) * reference::velocity(particles, p).transpose() +
        reference::inertia(shape) * reference::affine(particles, p).transpose();
    sum += particles.mass[p] * (product - product.transpose());
  }
  return sum;
}

}  // namespace poreshock::test
