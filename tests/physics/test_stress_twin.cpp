// The vectorised update against its scalar twin, and that it does not depend on how particles are
// stored.

#include <numeric>

#include "physics/particle_states.hpp"
#include "poreshock/material/library.hpp"
#include "support/scalar_stress.hpp"

namespace {

using namespace poreshock;
using namespace poreshock::test;

constexpr double dt = 4.0e-10;

/// Unlike materials: the paper's aluminium, a copper with mixed hardening, a fluid, and two whose
/// flow stress depends on rate, temperature and pressure.
std::vector<MaterialParameters> parameters(PlasticHeat heat, double spall = 0.0) {
  MaterialParameters aluminium = reference::aluminium();
  MaterialParameters copper = aluminium;
  copper.density = 3000.0;  // so that the same random states suit it
  copper.c0 = 3940.0;
  copper.lambda = 1.489;
  copper.young = 124.0e9;
  copper.poisson = 0.34;
  copper.yield = 90.0e6;
  copper.hardening = 500.0e6;
  copper.kinematic_share = 0.4;
  copper.cv = 385.0;
  MaterialParameters fluid = aluminium;
  fluid.young = fluid.yield = fluid.hardening = 0.0;
  fluid.gamma = 1.6;
  MaterialParameters cook = library_material("copper")->parameters, guinan = cook;
  cook.density = guinan.density = 2900.0;
  cook.strength = StrengthModel::johnson_cook;
  guinan.strength = StrengthModel::steinberg_guinan;
  std::vector<MaterialParameters> all = {aluminium, copper, fluid, cook, guinan};
  for (MaterialParameters& p : all) p.plastic_heat = heat;
  for (MaterialParameters& p : all) p.spall = p.young > 0.0 ? spall : 0.0;  // the fluid cannot fail
  return all;
}

/// Tension at which the materials fail here, over their strength: some open and some fail.
constexpr double early = 5.0;

std::vector<Material> make_materials(const std::vector<MaterialParameters>& all) {
  std::vector<Material> materials;
  for (const MaterialParameters& p : all) materials.push_back(make_material(p));
  for (Material& m : materials) m.opened_tension = early * m.spall;
  return materials;
}

template <int Dim>
Eigen::Matrix3d matrix(const SymmetricTensor<Dim>& t) {
  const double yz = Dim == 3 ? t[symmetric_size<Dim> - 2] : 0.0;
  const double zx = Dim == 3 ? t[symmetric_size<Dim> - 1] : 0.0;
  return Eigen::Matrix3d{{t[0], t[3], zx}, {t[3], t[1], yz}, {zx, yz, t[2]}};
}

template <int Dim>
reference::PointState state_of(const Particles<Dim>& p, std::size_t i) {
  reference::PointState s{p.density[i],
                          p.pressure[i],
                          p.viscous_pressure[i],
                          p.internal_energy[i],
                          p.plastic_strain[i],
                          p.plastic_work[i],
                          matrix<Dim>(tensor_of<Dim>(p.deviator, i))};
  if (p.options.back_stress) s.back_stress = matrix<Dim>(tensor_of<Dim>(p.back_stress, i));
  s.failed = p.options.failed && p.failed[i] > 0;
  return s;
}

template <int Dim>
reference::PointMotion motion_of(const Points<Dim>& points, const Vector<Dim>& grid_velocity,
                                 std::size_t i) {
  reference::PointMotion motion;
  const StepData<Dim>& step = points.step;
  for (int a = 0; a < Dim; ++a) {
    for (int b = 0; b < Dim; ++b) motion.gradient(a, b) = step.gradient[a * Dim + b][i];
    motion.rate(a, a) = step.rate[a][i];
    motion.speed =
        std::max(motion.speed, std::abs(points.particles.velocity[a][i] - grid_velocity[a]));
  }
  motion.rate(0, 1) = motion.rate(1, 0) = step.rate[Dim][i];
  if constexpr (Dim == 3) {
    motion.rate(1, 2) = motion.rate(2, 1) = step.rate[4][i];
    motion.rate(2, 0) = motion.rate(0, 2) = step.rate[5][i];
  }
  motion.heat = step.heat[i];
  motion.linear = step.viscous_linear[i];
  motion.quadratic = step.viscous_quadratic[i];
  return motion;
}

/// `strain_error` bounds the error of the strain; it moves the stress by the shear modulus, and the
/// energies by stress times strain. On top a strain is rounded to 2^-53.
template <int Dim>
void expect_same_state(const reference::PointState& expected, const reference::Solid& solid,
                       double strain_error, const Particles<Dim>& p, std::size_t i) {
  const reference::PointState found = state_of<Dim>(p, i);
  const double stress = 1e-13 * 1e8 + (strain_error + 1e-15) * 2.0 * solid.shear;
  const double energy = (strain_error + 1e-15) * 3.0e8 / solid.density;
  EXPECT_NEAR(found.density, expected.density, 1e-13 * expected.density);
  EXPECT_NEAR(found.energy, expected.energy, 1e-13 * 6.0e5);
  EXPECT_NEAR(found.plastic_strain, expected.plastic_strain, 1e-13 + strain_error);
  EXPECT_NEAR(found.plastic_work, expected.plastic_work, 1e-13 * 1.0e4 + energy);
  EXPECT_LT((found.deviator - expected.deviator).norm(), stress);
  EXPECT_LT((found.back_stress - expected.back_stress).norm(), stress);
  EXPECT_EQ(found.failed, expected.failed);
  EXPECT_NEAR(found.pressure, expected.pressure,
              1e-13 * solid.bulk() + solid.gamma * expected.density * energy);
  EXPECT_NEAR(found.viscous_pressure, expected.viscous_pressure,
              (1e-13 + 0.02 * strain_error) * (1e8 + expected.viscous_pressure));
}

/// Makes every fifth particle a failed one.
template <int Dim>
void fail_some(Particles<Dim>& p) {
  p.options.failed = true;
  resize(p, p.size());
  for (std::size_t i = 0; i < p.size(); i += 5) {
    p.failed[i] = 1;
    for (auto& column : p.deviator) column[i] = 0.0;
    for (auto& column : p.back_stress) {
      if (!column.empty()) column[i] = 0.0;
    }
  }
}

/// The flow stress of the twin at the state of the start of a step; none with linear hardening.
std::function<double(double, double)> flow_at_start(const MaterialParameters& m, Thermal thermal,
                                                    const reference::PointState& s) {
  if (m.strength == StrengthModel::linear) return {};
  const reference::Solid solid = reference::solid(m);
  const double v = 1.0 / s.density;
  const double heat = s.energy - s.deviator.squaredNorm() / (4.0 * solid.shear) * v;
  double T = thermal == Thermal::conserving
                 ? reference::temperature(solid, v, heat)
                 : reference::curve_temperature(solid, v) + s.plastic_work / solid.cv;
  if (m.spall > 0.0) {
    // What has opened is at the volume at which its solid bears its strength, failed no pressure.
    const double c = thermal == Thermal::conserving ? 1.0 + 0.5 * m.gamma : 1.0;
    const double w = thermal == Thermal::conserving ? heat : s.plastic_work;
    const MieGruneisen law = make_mie_gruneisen(m.density, m.c0, m.lambda, m.gamma, m.cv, m.T0);
    const double eta = eta_in_tension(law, c, w, s.failed ? 0.0 : m.spall);
    const double at = (1.0 - std::max(1.0 - m.density * v, eta)) / m.density;
    T = thermal == Thermal::conserving ? reference::temperature(solid, at, w)
                                       : reference::curve_temperature(solid, at) + w / solid.cv;
  }
  if (m.strength == StrengthModel::johnson_cook) return reference::johnson_cook(m.johnson_cook, T);
  return reference::steinberg_guinan(m.steinberg_guinan, s.pressure, s.density / m.density, T);
}

/// A flow stress takes its temperature from a table with errors of 1e-6 K, that is 1 Pa.
double twin_error(const MaterialParameters& m, double strain_error) {
  return m.strength == StrengthModel::linear ? strain_error : strain_error + 2e-11;
}

template <int Dim>
void compare_with_twin(Thermal thermal, bool kinematic, PlasticHeat heat, double spall,
                       double strain, double strain_error) {
  const std::vector<MaterialParameters> all = parameters(heat, spall);
  const std::vector<Material> materials = make_materials(all);
  StressSettings<Dim> settings = settings_of<Dim>(thermal);
  settings.grid_velocity[Dim - 1] = 700.0;
  settings.viscosity = {0.5, 1.7, true};
  reference::Random random{7};
  // Without the column the kinematic material may not take part.
  Points<Dim> points = random_points<Dim>(300, materials, kinematic, strain, dt, random);
  for (std::int32_t& m : points.particles.material) m = !kinematic && m == 1 ? 0 : m;
  if (spall > 0.0) fail_some(points.particles);
  // Only linear hardening has a back stress.
  for (std::size_t i = 0; kinematic && i < 300; ++i) {
    if (points.particles.material[i] < 3) continue;
    for (auto& column : points.particles.back_stress) column[i] = 0.0;
  }

  std::vector<reference::PointState> expected;
  double dt_limit = 1.0, viscous_heat = 0.0;
  int yielding = 0, elastic = 0, failing = 0, opening = 0;
  const bool conserving = thermal == Thermal::conserving;
  for (std::size_t i = 0; i < 300; ++i) {
    const MaterialParameters& m = all[static_cast<std::size_t>(points.particles.material[i])];
    reference::StressLaw law{reference::solid(m), conserving, heat == PlasticHeat::work, 0.5, 1.7};
    law.cell = settings.cell, law.cfl = settings.cfl;
    if (m.spall > 0.0) law.spall = m.spall, law.opened = early * m.spall;
    reference::PointState state = state_of<Dim>(points.particles, i);
    law.flow = flow_at_start(m, thermal, state);
    const double before = state.plastic_strain;
    const bool failed = state.failed;
    const auto report =
        reference::advance_point(law, motion_of<Dim>(points, settings.grid_velocity, i), dt, state);
    (state.plastic_strain > before ? yielding : elastic) += 1;
    failing += state.failed && !failed ? 1 : 0;
    opening += state.pressure == -law.spall ? 1 : 0;
    dt_limit = std::min(dt_limit, report.dt_limit);
    viscous_heat += points.particles.mass[i] * report.viscous_heat;
    expected.push_back(state);
  }
  EXPECT_GT(yielding, 20);
  EXPECT_GT(elastic, 20);
  EXPECT_TRUE(spall > 0.0 ? failing > 10 && opening > 10 : failing + opening == 0);

  const StressReport report = update<Dim>(materials, settings, dt, points);
  for (std::size_t i = 0; i < 300; ++i) {
    const MaterialParameters& m = all[static_cast<std::size_t>(points.particles.material[i])];
    expect_same_state<Dim>(expected[i], reference::solid(m), twin_error(m, strain_error),
                           points.particles, i);
  }
  EXPECT_EQ(report.bad, 0);
  EXPECT_EQ(report.compression_guard, 0);
  EXPECT_EQ(report.sound_speed_guard, 0);
  EXPECT_NEAR(report.dt_limit, dt_limit, 1e-13 * dt_limit);
  EXPECT_NEAR(static_cast<double>(report.viscous_heat) / settings.inverse_energy_quantum,
              viscous_heat, 300.0 / settings.inverse_energy_quantum);
}

template <int Dim>
void compare_all_modes(double strain, double strain_error) {
  for (const Thermal thermal : {Thermal::paper, Thermal::conserving}) {
    for (const bool kinematic : {false, true}) {
      for (const PlasticHeat heat : {PlasticHeat::work, PlasticHeat::dissipation}) {
        for (const double spall : {0.0, 1e9}) {
          compare_with_twin<Dim>(thermal, kinematic, heat, spall, strain, strain_error);
        }
      }
    }
  }
}

TEST(StressTwin, PlaneStrain) {
  compare_all_modes<2>(2.0e-3, 0.0);
}

TEST(StressTwin, Space) {
  compare_all_modes<3>(2.0e-3, 0.0);
}

// The logarithm is a rational function of z, of relative error 0.023 z^6. In the plane z is the
// difference of the principal strains (half of it counts, twice), in space each of the three.
TEST(StressTwin, LargeStepsInThePlane) {
  compare_all_modes<2>(0.03, std::sqrt(2.0) * 0.5 * 0.023 * std::pow(0.09, 7));
}

TEST(StressTwin, LargeStepsInSpace) {
  compare_all_modes<3>(0.02, std::sqrt(3.0) * 0.023 * std::pow(0.065, 7));
}

/// Every particle comes out with the same bits alone and among others, in any order.
template <int Dim>
void storage_does_not_matter(std::size_t count, bool kinematic, Thermal thermal) {
  const std::vector<Material> materials = make_materials(parameters(PlasticHeat::work));
  const StressSettings<Dim> settings = settings_of<Dim>(thermal);
  reference::Random random{count};
  const Points<Dim> start = random_points<Dim>(count, materials, kinematic, 0.02, dt, random);
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  for (std::size_t k = count; k > 1; --k) {
    std::swap(order[k - 1], order[static_cast<std::size_t>(random.below(static_cast<int>(k)))]);
  }
  const auto picked = [&](const std::vector<std::uint32_t>& indices) {
    Points<Dim> points(indices.size(), kinematic);
    points.particles = start.particles;
    reorder(indices, points.particles);
    const auto pick = [&](const std::vector<double>& from, std::vector<double>& to) {
      for (std::size_t k = 0; k < to.size(); ++k) to[k] = from[indices[k]];
    };
    for (int k = 0; k < Dim * Dim; ++k) pick(start.step.gradient[k], points.step.gradient[k]);
    for (int k = 0; k < rate_size<Dim>; ++k) pick(start.step.rate[k], points.step.rate[k]);
    pick(start.step.heat, points.step.heat);
    pick(start.step.viscous_linear, points.step.viscous_linear);
    pick(start.step.viscous_quadratic, points.step.viscous_quadratic);
    return points;
  };
  Points<Dim> shuffled = picked(order);
  const StressReport all = update<Dim>(materials, settings, dt, shuffled);
  StressReport alone;
  alone.dt_limit = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < count; ++k) {
    Points<Dim> one = picked({order[k]});
    const StressReport report = update<Dim>(materials, settings, dt, one);
    EXPECT_EQ(bits_of<Dim>(one.particles, 0), bits_of<Dim>(shuffled.particles, k))
        << "particle " << order[k] << " at place " << k << " of " << count;
    alone.dt_limit = std::min(alone.dt_limit, report.dt_limit);
    alone.viscous_heat += report.viscous_heat;
  }
  EXPECT_EQ(all.dt_limit, alone.dt_limit);
  EXPECT_TRUE(all.viscous_heat == alone.viscous_heat);
  EXPECT_EQ(all.bad, 0);
}

TEST(StressStorage, AnyNumberOfParticlesInAnyOrder) {
  for (std::size_t count = 1; count <= 40; ++count) {
    const Thermal thermal = count % 2 == 0 ? Thermal::paper : Thermal::conserving;
    storage_does_not_matter<2>(count, count % 4 < 2, thermal);
    storage_does_not_matter<3>(count, count % 4 < 2, thermal);
  }
}

// More than one block of the inner loop, and one material only: full vectors and remainders.
TEST(StressStorage, SeveralBlocks) {
  storage_does_not_matter<2>(700, true, Thermal::conserving);
  storage_does_not_matter<3>(300, false, Thermal::conserving);
  const std::vector<Material> materials = {make_material(reference::aluminium())};
  const StressSettings<2> settings = settings_of<2>(Thermal::conserving);
  reference::Random random{99};
  const Points<2> start = random_points<2>(523, materials, false, 0.02, dt, random);
  Points<2> together = start;
  update<2>(materials, settings, dt, together);
  for (std::size_t i = 0; i < 523; ++i) {
    Points<2> one(1, false);
    one.particles = start.particles;
    reorder({static_cast<std::uint32_t>(i)}, one.particles);
    for (int k = 0; k < 4; ++k) one.step.gradient[k][0] = start.step.gradient[k][i];
    for (int k = 0; k < 3; ++k) one.step.rate[k][0] = start.step.rate[k][i];
    one.step.heat[0] = start.step.heat[i];
    one.step.viscous_linear[0] = start.step.viscous_linear[i];
    one.step.viscous_quadratic[0] = start.step.viscous_quadratic[i];
    update<2>(materials, settings, dt, one);
    EXPECT_EQ(bits_of<2>(one.particles, 0), bits_of<2>(together.particles, i)) << i;
  }
}

}  // namespace
