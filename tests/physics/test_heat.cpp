// One step of heat conduction: the kernel against plain loops, its balance, its stable step and its
// independence of the ranks.
#include <gtest/gtest.h>

#include "physics/heat_block.hpp"
#include "support/scalar_heat.hpp"

namespace poreshock::test {
namespace {

/// Aluminium, a poor conductor of other specific heat, and a solid that does not conduct.
std::vector<MaterialParameters> three_materials() {
  MaterialParameters poor = reference::aluminium();
  poor.density = 3000.0;
  poor.conductivity = 90.0;
  poor.cv = 450.0;
  MaterialParameters insulator = reference::aluminium();
  insulator.conductivity = 0.0;
  return {reference::aluminium(), poor, insulator};
}

/// The random cloud of the transfer tests, of three materials and temperatures of 300 to 1000 K.
template <int Dim>
Cloud<Dim> hot_cloud(const Choice& choice, bool conducted_heat) {
  Cloud<Dim> cloud = make_cloud<Dim>(choice);
  Particles<Dim>& p = cloud.particles;
  p.options.conducted_heat = conducted_heat;
  resize(p, p.size());
  reference::Random random{77};
  for (std::size_t i = 0; i < p.size(); ++i) {
    p.material[i] = random.below(3);
    p.internal_energy[i] = 6e5 * random.uniform();
    p.plastic_work[i] = 6e5 * random.uniform();
  }
  return cloud;
}

constexpr double dt = 1e-8;

/// Heat flows on B-splines only.
bool on_splines(const Choice& choice) {
  return choice.shape == ShapeFunction::quadratic || choice.shape == ShapeFunction::cubic;
}

template <int Dim>
void compare(const Choice& choice, Thermal thermal) {
  SCOPED_TRACE(name(choice) + ", " + std::to_string(Dim) + "-D");
  const std::vector<MaterialParameters> all = three_materials();
  const std::vector<Material> materials = made(all);
  const Cloud<Dim> cloud = hot_cloud<Dim>(choice, thermal == Thermal::paper);
  std::vector<double> T;
  for (std::size_t p = 0; p < cloud.particles.size(); ++p) {
    T.push_back(particle_temperature<Dim>(cloud.particles, materials, thermal, p));
  }
  const auto expected = reference::conducted_heat<Dim>(cloud.shape, cloud.particles, all, T, dt);
  Slab<Dim> slab = make_slab(cloud, world);
  conduct<Dim>(all, thermal, choice.shape, dt, 1, slab);
  const auto energy =
      by_id(slab.particles, slab.particles.internal_energy, cloud.particles.size(), world);
  double largest = 0.0;
  for (const double h : expected) largest = std::max(largest, std::abs(h));
  EXPECT_GT(largest, 1e3);
  for (std::size_t p = 0; p < expected.size(); ++p) {
    // The energy it is added to is rounded too.
    EXPECT_NEAR(energy[p] - cloud.particles.internal_energy[p], expected[p],
                1e-12 * largest + 1e-15 * 6e5)
        << p;
  }
  for (std::size_t p = 0; p < slab.particles.conducted_heat.size(); ++p) {
    const auto id = static_cast<std::size_t>(slab.particles.id[p]);
    EXPECT_NEAR(slab.particles.conducted_heat[p], expected[id], 1e-12 * largest);
  }
}

TEST(HeatConduction, FollowsTheFormulas) {
  for (const Choice& choice : all_choices) {
    if (!on_splines(choice)) continue;
    compare<2>(choice, Thermal::conserving);
    compare<3>(choice, Thermal::paper);
  }
}

TEST(HeatConduction, GainsNothingInAll) {
  for (const Choice& choice : all_choices) {
    if (!on_splines(choice)) continue;
    const Cloud<2> cloud = hot_cloud<2>(choice, true);
    Slab<2> slab = make_slab(cloud, world);
    const double gained = conduct<2>(three_materials(), Thermal::paper, choice.shape, dt, 1, slab);
    const auto heat =
        by_id(slab.particles, slab.particles.conducted_heat, cloud.particles.size(), world);
    double sum = 0.0, moved = 0.0;
    for (std::size_t p = 0; p < heat.size(); ++p) {
      sum += cloud.particles.mass[p] * heat[p];
      moved += std::abs(cloud.particles.mass[p] * heat[p]);
    }
    EXPECT_GT(moved, 0.0);
    EXPECT_LT(std::abs(sum), 1e-14 * moved) << name(choice);
    EXPECT_LT(std::abs(gained), 1e-14 * moved) << name(choice);
  }
}

TEST(HeatConduction, UniformTemperatureStays) {
  Cloud<2> block = lattice<2>({6, 12, 0}, 1e-5, 2, ShapeFunction::cubic, true);
  const std::vector<MaterialParameters> all = {reference::aluminium()};
  set_temperature<2>(
      all, [](std::size_t) { return 900.0; }, block.particles);
  Slab<2> slab = make_slab(block, world);
  conduct<2>(all, Thermal::conserving, ShapeFunction::cubic, 1e-7, 100, slab);
  for (const double e : slab.particles.internal_energy) EXPECT_NEAR(e, 880.0 * 600.0, 1e-7);
}

/// Energies after ten steps, in the order of ids.
template <int Dim>
std::vector<double> energies(const Cloud<Dim>& cloud, const std::vector<std::uint32_t>& storage,
                             MPI_Comm communicator) {
  Slab<Dim> slab = make_slab(cloud, storage, communicator);
  conduct<Dim>(three_materials(), Thermal::paper, cloud.transfer.shape, dt, 10, slab);
  return by_id(slab.particles, slab.particles.internal_energy, cloud.particles.size(),
               communicator);
}

TEST(HeatConduction, SameBitsOnAnyRanksInAnyStorage) {
  for (const Choice& choice : all_choices) {
    if (!on_splines(choice)) continue;
    SCOPED_TRACE(name(choice));
    const Cloud<2> plane = hot_cloud<2>(choice, true);
    const auto order = natural_order(plane.particles.size());
    const auto alone = energies(plane, order, MPI_COMM_SELF);
    EXPECT_EQ(energies(plane, order, world), alone);
    EXPECT_EQ(energies(plane, shuffled(plane.particles.size(), 3), world), alone);
    const Cloud<3> space = hot_cloud<3>(choice, true);
    const auto all = natural_order(space.particles.size());
    EXPECT_EQ(energies(space, all, world), energies(space, all, MPI_COMM_SELF));
  }
}

/// Sum of m c_v (T - mean)^2: conduction can only lower it.
template <int Dim>
double unevenness(const std::vector<MaterialParameters>& all, const Slab<Dim>& slab) {
  const std::vector<Material> materials = made(all);
  std::array<double, 3> sums{};
  for (std::size_t p = 0; p < slab.particles.size(); ++p) {
    const double c =
        slab.particles.mass[p] * all[static_cast<std::size_t>(slab.particles.material[p])].cv;
    const double T = particle_temperature<Dim>(slab.particles, materials, Thermal::conserving, p);
    sums[0] += c;
    sums[1] += c * T;
    sums[2] += c * T * T;
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 3, MPI_DOUBLE, MPI_SUM, world);
  return sums[2] - sums[1] * sums[1] / sums[0];
}

/// Ratio of the unevenness after 20 steps and before, at a multiple of the stable step.
template <int Dim>
double growth(const Cloud<Dim>& cloud, double multiple) {
  const std::vector<MaterialParameters> all = three_materials();
  Slab<Dim> slab = make_slab(cloud, world);
  const double limit = conduction_limit(made(all), cloud.transfer.shape, Dim, cloud.shape.cell);
  const double before = unevenness(all, slab);
  double worst = 0.0, last = before;
  for (int n = 0; n < 20; ++n) {
    conduct<Dim>(all, Thermal::conserving, cloud.transfer.shape, multiple * limit, 1, slab);
    const double now = unevenness(all, slab);
    worst = std::max(worst, now / last);
    last = now;
  }
  // Below the limit every single step lowers it.
  if (multiple <= 1.0) {
    EXPECT_LT(worst, 1.0 + 1e-12);
  }
  return last / before;
}

TEST(ConductionLimit, IsStableForAnyArrangement) {
  for (const Choice& choice : all_choices) {
    if (!on_splines(choice)) continue;
    SCOPED_TRACE(name(choice));
    EXPECT_LT(growth(hot_cloud<2>(choice, false), 1.0), 0.7);
    if (choice.velocity == VelocityTransfer::flip) {
      EXPECT_LT(growth(hot_cloud<3>(choice, false), 1.0), 0.7);
    }
  }
}

TEST(ConductionLimit, IsNotIdle) {
  for (const ShapeFunction shape : {ShapeFunction::quadratic, ShapeFunction::cubic}) {
    Cloud<2> block = lattice<2>({6, 14, 0}, 1e-5, 2, shape, true);
    reference::Random random{5};
    set_temperature<2>(
        three_materials(), [&](std::size_t) { return 400.0 + 200.0 * random.uniform(); },
        block.particles);
    EXPECT_LT(growth(block, 1.0), 0.01);
    EXPECT_GT(growth(block, 3.5), 1e3);
  }
}

TEST(ConductionLimit, BoundsTheSplines) {
  // sum (dN/dx)^2/N over a stencil, and 2/D, both per cell^2.
  const auto largest = []<class Spline>(Spline) {
    double most = 0.0;
    for (int k = 0; k < 100000; ++k) {
      const double s = 3.0 + (k + 0.5) * 1e-5;
      const auto w = axis_weights(Spline{}, s, poreshock::stencil_base(Spline::width, s));
      double sum = 0.0;
      for (int n = 0; n < Spline::width; ++n) sum += w.slope[n] * w.slope[n] / w.value[n];
      most = std::max(most, sum);
    }
    return most;
  };
  const MaterialParameters m = reference::aluminium();
  const double a = m.conductivity / (m.density * m.cv);
  EXPECT_NEAR(a, 9.97e-5, 1e-7);
  const auto per_cell2 = [&](ShapeFunction shape, int dimension) {
    return 1e-10 / (dimension * a * conduction_limit(made({m}), shape, dimension, 1e-5));
  };
  EXPECT_NEAR(largest(QuadraticSpline{}), 6.0, 1e-3);
  EXPECT_NEAR(largest(CubicSpline{}), 3.137, 1e-3);
  for (const int dimension : {2, 3}) {
    EXPECT_NEAR(per_cell2(ShapeFunction::quadratic, dimension), 6.0, 1e-12);
    EXPECT_NEAR(per_cell2(ShapeFunction::cubic, dimension), 3.14, 1e-12);
  }
  EXPECT_EQ(conduction_limit(made({three_materials()[2]}), ShapeFunction::cubic, 2, 1e-5),
            std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace poreshock::test
