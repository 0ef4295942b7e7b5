// Standing waves of small amplitude against linear elasticity, and their decay.

#include <numeric>

#include "verification/states.hpp"

namespace poreshock::test {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double wavelength = 1e-3;
constexpr double courant = 0.3;

struct Scheme {
  const char* name;
  std::vector<std::string> overrides;
};

const Scheme polyflip{"polyflip", with_transfer(VelocityTransfer::polyflip)};
const Scheme cubic_apic{"cubic_apic", {}};
const Scheme cubic_flip{"cubic_flip", {"transfer.velocity=flip"}};
const Scheme quadratic_apic{"quadratic_apic", {"transfer.shape=quadratic"}};
const Scheme quadratic_flip{"quadratic_flip",
                            {"transfer.shape=quadratic", "transfer.velocity=flip"}};
const Scheme quadratic_aflip{"quadratic_aflip",
                             with_transfer(VelocityTransfer::aflip, {"transfer.shape=quadratic"})};

/// One wavelength along the periodic x axis, eight rows between symmetry planes.
Simulation<2> periodic_strip(int cells, double frame, const Scheme& scheme) {
  const double cell = wavelength / cells;
  std::vector<std::string> overrides = scheme.overrides;
  for (std::string text :
       {"domain.size=[" + digits(wavelength) + ", " + digits(8 * cell) + "]",
        "domain.cell=" + digits(cell), "loading.frame=[" + digits(frame) + ", 0.0]",
        std::string("material.0.yield=1e30")}) {
    overrides.push_back(std::move(text));
  }
  const std::string text = std::string(R"(
[domain]
size = [1.0, 1.0]
cell = 0.1
periodic = true
[boundary]
low = "symmetry"
high = "symmetry"
[sample]
kind = "solid"
[viscosity]
linear = 0.0
quadratic = 0.0
[time]
end = 1.0
)") + aluminium_text;
  return start<2>(plain_scene_of(text, overrides), MPI_COMM_SELF);
}

/// u = amplitude sin(k X) sin(w t): at t = 0 straight and free of stress.
struct StandingWave {
  double amplitude, k, w, frame;

  double displacement(double X, double t) const {
    return amplitude * std::sin(k * X) * std::sin(w * t);
  }
  double velocity(double X, double t) const {
    return frame + amplitude * w * std::sin(k * X) * std::cos(w * t);
  }
  /// The velocities of the scheme belong to the middles of the steps.
  void start_at(double t, Simulation<2>& sim) const {
    set_motion(
        [&](const Plane& x) {
          return Motion{{velocity(x[0], t), 0.0},
                        {amplitude * w * k * std::cos(k * x[0]) * std::cos(w * t), 0.0, 0.0, 0.0}};
        },
        sim);
  }
};

StandingWave wave_of(double strain, double frame, const Simulation<2>& sim) {
  const double k = 2.0 * pi / wavelength;
  return {strain / k, k, longitudinal_sound_speed(sim.materials[0]) * k, frame};
}

double rounded_step(const StandingWave& wave, int cells, double periods, std::int64_t& steps) {
  steps = std::llround(std::ceil(periods * cells / courant));
  return periods * 2.0 * pi / wave.w / static_cast<double>(steps);
}

struct WaveError {
  double position, velocity;
};

/// Root mean square errors relative to the amplitudes, after nine eighths of a period.
WaveError wave_error(int cells, double frame, const Scheme& scheme) {
  Simulation<2> sim = periodic_strip(cells, frame, scheme);
  const StandingWave wave = wave_of(1e-6, frame, sim);
  std::int64_t steps = 0;
  const double dt = rounded_step(wave, cells, 1.125, steps);
  wave.start_at(-0.5 * dt, sim);
  step_by(dt, steps, sim);
  const double t = dt * static_cast<double>(steps);
  WaveError error{0.0, 0.0};
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    const double X = site(sim, p)[0];
    const double moved = sim.particles.position[0][p] - X - frame * t;
    const double du = moved - wavelength * std::round(moved / wavelength) - wave.displacement(X, t);
    const double dv = sim.particles.velocity[0][p] - wave.velocity(X, t - 0.5 * dt);
    error.position += du * du;
    error.velocity += dv * dv;
  }
  const double count = static_cast<double>(sim.particles.size());
  return {std::sqrt(error.position / count) / wave.amplitude,
          std::sqrt(error.velocity / count) / (wave.amplitude * wave.w)};
}

void converge_at_rest_and_moving(const Scheme& scheme) {
  const std::string name = std::string("elastic_wave_") + scheme.name;
  std::vector<WaveError> rest, moving;
  for (const int cells : {32, 64, 128}) {
    rest.push_back(wave_error(cells, 0.0, scheme));
    moving.push_back(wave_error(cells, 1000.0, scheme));
  }
  for (std::size_t i = 0; i + 1 < rest.size(); ++i) {
    const std::string suffix = i == 0 ? "_32_64" : "_64_128";
    verify_at_least(name, "position_order" + suffix, order(rest[i].position, rest[i + 1].position),
                    1.8);
    verify_at_least(name, "velocity_order" + suffix, order(rest[i].velocity, rest[i + 1].velocity),
                    1.8);
    record(name, "moving_velocity_order" + suffix,
           order(moving[i].velocity, moving[i + 1].velocity));
  }
  record(name, "position_error_128", rest[2].position);
  record(name, "velocity_error_128", rest[2].velocity);
  verify_at_most(name, "moving_position_ratio_128", moving[2].position / rest[2].position, 2.0);
  verify_at_most(name, "moving_velocity_ratio_128", moving[2].velocity / rest[2].velocity, 2.0);
}

TEST(StandingWave, PolyFlipConverges) {
  converge_at_rest_and_moving(polyflip);
}

TEST(StandingWave, CubicApicConverges) {
  converge_at_rest_and_moving(cubic_apic);
}

TEST(StandingWave, CubicFlipConverges) {
  converge_at_rest_and_moving(cubic_flip);
}

/// All modes of the velocity by particle id, times the roots of their shares in the kinetic energy.
std::unordered_map<std::int64_t, std::array<double, 12>> motions(const Simulation<2>& sim) {
  std::unordered_map<std::int64_t, std::array<double, 12>> result;
  const Particles<2>& q = sim.particles;
  const double arm = std::sqrt(affine_inertia(sim.scene.transfer, sim.scene.domain.cell));
  for (std::size_t p = 0; p < q.size(); ++p) {
    auto& m = result[q.id[p]];
    for (int a = 0; a < 2; ++a) m[a] = q.velocity[a][p];
    for (std::size_t k = 0; k < 4 && q.options.affine; ++k) m[2 + k] = arm * q.affine[k][p];
    for (std::size_t k = 0; k < 6 && q.options.quadratic; ++k) m[6 + k] = q.quadratic[k][p];
  }
  return result;
}

/// Strain energy of the particles: deviator and reference curve, J.
double strain_energy(const Simulation<2>& sim) {
  const Material& m = first_material(sim);
  double energy = 0.0;
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    const double density = sim.particles.density[p];
    const double q = von_mises(sim.particles, p);
    energy +=
        sim.particles.mass[p] * (m.deviatoric_energy(q * q / 1.5, density) +
                                 reference_point(m.eos, 1.0 - m.eos.density / density).energy);
  }
  return energy;
}

/// Takes one step; returns the mechanical energy at its start: the kinetic energy is the product of
/// the velocities half a step before and after, which a leapfrog conserves exactly.
double mechanical_energy(double dt, Simulation<2>& sim) {
  const auto before = motions(sim);
  const double strain = strain_energy(sim);
  step_by(dt, sim);
  const auto after = motions(sim);
  const auto index = index_by_id(sim);
  double kinetic = 0.0;
  for (const auto& [id, v] : before) {
    const auto& w = after.at(id);
    const double product = std::inner_product(v.begin(), v.end(), w.begin(), 0.0);
    kinetic += 0.5 * sim.particles.mass[index.at(id)] * product;
  }
  return kinetic + strain;
}

/// Relative change of the mechanical energy over ten periods.
double vibration_change(int cells, const Scheme& scheme, double& ledger_error) {
  Simulation<2> sim = periodic_strip(cells, 0.0, scheme);
  const StandingWave wave = wave_of(3e-4, 0.0, sim);
  std::int64_t steps = 0;
  const double dt = rounded_step(wave, cells, 10.0, steps);
  wave.start_at(-0.5 * dt, sim);
  const double total = stock(sim).total;
  const double first = mechanical_energy(dt, sim);
  step_by(dt, steps - 1, sim);
  const double last = mechanical_energy(dt, sim);
  ledger_error = std::max(ledger_error, std::abs(stock(sim).total / total - 1.0));
  return last / first - 1.0;
}

class Vibration : public ::testing::TestWithParam<Scheme> {};

TEST_P(Vibration, GainsNoEnergyInTenPeriods) {
  const Scheme& scheme = GetParam();
  const std::string name = std::string("vibration_") + scheme.name;
  double ledger = 0.0;
  const double coarse = vibration_change(32, scheme, ledger);
  const double fine = vibration_change(64, scheme, ledger);
  verify_at_most(name, "energy_change_32", coarse, 1e-3);
  verify_at_most(name, "energy_change_64", fine, 1e-3);
  if (std::string(scheme.name) == "polyflip") {
    // A hundredth and less of what the others lose, and no longer of their order.
    verify_known_shortfall(name, "loss_ratio_64_32", fine / coarse, 1.0 / 7.0, 0.3);
  } else {
    verify_at_most(name, "loss_ratio_64_32", fine / coarse, 1.0 / 7.0);
  }
  verify_at_most(name, "ledger", ledger, 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Schemes, Vibration,
                         ::testing::Values(polyflip, cubic_apic, cubic_flip, quadratic_aflip,
                                           quadratic_apic, quadratic_flip),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace poreshock::test
