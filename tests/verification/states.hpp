#pragma once
// Initial states made by code, a bare loop of equal steps, and what is read off the particles. All
// in plane strain; runs of these tests are small and stay on one rank.

#include <array>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "poreshock/material/derived.hpp"
#include "poreshock/run/checksum.hpp"
#include "poreshock/scene/transfer_scheme.hpp"
#include "support/runs.hpp"
#include "verification/verify.hpp"

namespace poreshock::test {

using Plane = std::array<double, 2>;

/// Velocity (m/s) and its gradient dv_i/dx_j (1/s, row major) at one place.
struct Motion {
  Plane velocity{};
  std::array<double, 4> gradient{};
};

/// Overrides that give a plain scene a velocity transfer with its own damping, and more.
inline std::vector<std::string> with_transfer(VelocityTransfer velocity,
                                              std::vector<std::string> more = {}) {
  const TransferScheme& scheme = scheme_of(velocity);
  more.push_back("transfer.velocity=" + std::string(scheme.name));
  more.push_back("transfer.damping=" + digits(scheme.damping));
  return more;
}

/// Overrides that turn a plain scene into one of the default scheme.
inline std::vector<std::string> default_scheme() {
  const Viscosity viscosity;
  return with_transfer(VelocityTransfer::aflip,
                       {"viscosity.limited=true", "viscosity.linear=" + digits(viscosity.linear),
                        "viscosity.quadratic=" + digits(viscosity.quadratic)});
}

/// A solid block of 4 mm on cells of 10 um that falls onto a wall: the keys of its material but
/// the table's header, impact velocity (m/s) and end (s).
inline std::string falling_block(const std::string& material, const std::string& velocity,
                                 const std::string& end) {
  return R"(
[domain]
size = [40e-6, 4.2e-3]
cell = 10e-6
periodic = true
[boundary]
low = "wall"
[sample]
kind = "solid"
height = 4e-3
[loading]
velocity = )" +
         velocity + "\n[time]\nend = " + end + "\n[[material]]\n" + material;
}

inline Plane position(const Simulation<2>& sim, std::size_t p) {
  return {sim.particles.position[0][p], sim.particles.position[1][p]};
}

/// Where the particle was at the start, m: its id is the number of its lattice site.
inline Plane site(const Simulation<2>& sim, std::size_t p) {
  const int per_cell = sim.scene.sample.particles_per_cell;
  const std::int64_t width = std::int64_t{sim.scene.domain.cells[0]} * per_cell;
  const double spacing = sim.scene.domain.cell / per_cell;
  const std::int64_t id = sim.particles.id[p];
  return {(static_cast<double>(id % width) + 0.5) * spacing,
          (static_cast<double>(id / width) + 0.5) * spacing};
}

/// Gives every particle the motion that field(x) -> Motion has at its position.
template <class Field>
void set_motion(Field&& field, Simulation<2>& sim) {
  Particles<2>& particles = sim.particles;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Motion motion = field(position(sim, p));
    for (int a = 0; a < 2; ++a) particles.velocity[a][p] = motion.velocity[a];
    if (!particles.options.affine) continue;
    for (int k = 0; k < 4; ++k) particles.affine[k][p] = motion.gradient[k];
  }
}

/// One step of length dt, s. Collective.
inline void step_by(double dt, Simulation<2>& sim) {
  advance(sim, dt);
  ++sim.clock.step;
  sim.clock.time += dt;
  migrate(sim);
}

/// Equal steps of length dt, s; fails the test when a state goes bad. Collective.
inline void step_by(double dt, std::int64_t steps, Simulation<2>& sim) {
  for (std::int64_t k = 0; k < steps; ++k) {
    step_by(dt, sim);
    ASSERT_EQ(sim.clock.bad, 0) << "state gone bad at step " << sim.clock.step;
  }
}

/// Storage index of every particle id.
inline std::unordered_map<std::int64_t, std::size_t> index_by_id(const Simulation<2>& sim) {
  std::unordered_map<std::int64_t, std::size_t> index;
  for (std::size_t p = 0; p < sim.particles.size(); ++p) index[sim.particles.id[p]] = p;
  return index;
}

inline const Material& first_material(const Simulation<2>& sim) {
  return sim.materials.front();
}

/// Density (kg/m^3) at which the reference curve has pressure p (Pa); small compressions only.
inline double density_at(const MieGruneisen& eos, double p) {
  double eta = p / eos.bulk;
  for (int k = 0; k < 50; ++k) {
    const ReferencePoint r = reference_point(eos, eta);
    eta -= (r.pressure - p) / r.pressure_slope;
  }
  return eos.density / (1.0 - eta);
}

/// Von Mises stress of particle p, Pa.
inline double von_mises(const Particles<2>& particles, std::size_t p) {
  SymmetricTensor<2> s;
  for (int k = 0; k < 4; ++k) s[k] = particles.deviator[k][p];
  return std::sqrt(1.5 * contract<2>(s, s));
}

}  // namespace poreshock::test
