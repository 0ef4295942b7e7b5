// Heat conduction against closed forms: a step that spreads as erfc, waves that decay between
// insulated ends and periodic sides, and the contact temperature of two materials.
#include <gtest/gtest.h>

#include "physics/heat_block.hpp"

namespace poreshock::test {
namespace {

double diffusivity(const MaterialParameters& m) {
  return m.conductivity / (m.density * m.cv);
}

/// Root mean square and largest error of a field, K.
struct Errors {
  double rms = 0.0, largest = 0.0;
};

/// Conducts from T(p, 0) to T(p, end) in so many steps, each a stable one. Collective.
template <int Dim>
Errors errors(const std::vector<MaterialParameters>& all, double end, int steps,
              const std::function<double(std::size_t, double)>& T, Cloud<Dim>& block) {
  set_temperature<Dim>(
      all, [&](std::size_t p) { return T(p, 0.0); }, block.particles);
  Slab<Dim> slab = make_slab(block, world);
  const std::vector<Material> materials = made(all);
  const double limit = conduction_limit(materials, block.transfer.shape, Dim, block.shape.cell);
  EXPECT_LT(end / steps, limit);
  conduct<Dim>(all, Thermal::conserving, block.transfer.shape, end / steps, steps, slab);
  std::array<double, 2> sums{};
  Errors result;
  for (std::size_t p = 0; p < slab.particles.size(); ++p) {
    const double error =
        particle_temperature<Dim>(slab.particles, materials, Thermal::conserving, p) -
        T(static_cast<std::size_t>(slab.particles.id[p]), end);
    sums[0] += 1.0;
    sums[1] += error * error;
    result.largest = std::max(result.largest, std::abs(error));
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 2, MPI_DOUBLE, MPI_SUM, world);
  MPI_Allreduce(MPI_IN_PLACE, &result.largest, 1, MPI_DOUBLE, MPI_MAX, world);
  result.rms = std::sqrt(sums[1] / sums[0]);
  return result;
}

constexpr double width = 1e-5;  ///< m, sqrt(4 a t) at the end

/// A sharp step of 200 K between two rows of particles, `cells` cells per diffusion length.
Errors step_errors(int cells, ShapeFunction shape) {
  const MaterialParameters m = reference::aluminium();
  Cloud<2> block = lattice<2>({4, 16 * cells, 0}, width / cells, 2, shape, true);
  const auto T = [&](std::size_t p, double t) {
    const double y = block.particles.position[1][p] - 8.0 * width;
    return 400.0 + 100.0 * std::erfc(y / std::sqrt(4.0 * diffusivity(m) * t + 1e-30));
  };
  return errors<2>({m}, width * width / (4.0 * diffusivity(m)), 4 * cells * cells, T, block);
}

TEST(HeatProfiles, StepSpreadsAsErfcToSecondOrder) {
  for (const ShapeFunction shape : {ShapeFunction::quadratic, ShapeFunction::cubic}) {
    const Errors coarse = step_errors(4, shape), fine = step_errors(8, shape);
    EXPECT_GT(std::log2(coarse.rms / fine.rms), 1.8);
    EXPECT_GT(std::log2(coarse.largest / fine.largest), 1.8);
    // Of a step of 200 K.
    EXPECT_LT(fine.rms, 0.015);
    EXPECT_LT(fine.largest, 0.05);
  }
}

/// One wave along each axis: periodic sides, insulated ends.
template <int Dim>
double wave_error(int cells, ShapeFunction shape) {
  const MaterialParameters m = reference::aluminium();
  const double length = 4e-5;
  const std::array<int, 3> count = Dim == 2 ? std::array<int, 3>{cells, 2 * cells, 0}
                                            : std::array<int, 3>{cells, cells, 2 * cells};
  Cloud<Dim> block = lattice<Dim>(count, length / cells, 2, shape, true);
  double k2 = 0.0;
  std::array<double, Dim> k;
  for (int a = 0; a < Dim; ++a) {
    k[a] = (a + 1 < Dim ? 2.0 : 0.5) * 3.14159265358979323846 / length;
    k2 += k[a] * k[a];
  }
  const auto T = [&](std::size_t p, double t) {
    double wave = 100.0 * std::exp(-diffusivity(m) * k2 * t);
    for (int a = 0; a < Dim; ++a) wave *= std::cos(k[a] * block.particles.position[a][p]);
    return 500.0 + wave;
  };
  return errors<Dim>({m}, 1.0 / (diffusivity(m) * k2), cells * cells / 2, T, block).largest;
}

TEST(HeatProfiles, WavesDecayBetweenInsulatedEnds) {
  for (const ShapeFunction shape : {ShapeFunction::quadratic, ShapeFunction::cubic}) {
    const double coarse = wave_error<2>(8, shape), fine = wave_error<2>(16, shape);
    EXPECT_GT(std::log2(coarse / fine), 1.8);
    // Of an amplitude of 100 K.
    EXPECT_LT(fine, 0.2);
    EXPECT_LT(wave_error<3>(8, shape), 1.0);
  }
}

/// Two half spaces that touch at once take the contact temperature of their effusivities:
/// T = Tc + (T1 - Tc) erf(|y| / sqrt(4 a1 t)) on the first side, likewise on the other.
Errors contact_errors(int cells, ShapeFunction shape) {
  MaterialParameters good = reference::aluminium(), poor = good;
  poor.conductivity = 50.0;
  poor.cv = 500.0;
  const double end = width * width / (4.0 * diffusivity(good));
  Cloud<2> block = lattice<2>({4, 16 * cells, 0}, width / cells, 2, shape, true);
  const auto effusivity = [](const MaterialParameters& m) {
    return std::sqrt(m.conductivity * m.density * m.cv);
  };
  const double contact =
      (effusivity(good) * 500.0 + effusivity(poor) * 300.0) / (effusivity(good) + effusivity(poor));
  for (std::size_t p = 0; p < block.particles.size(); ++p) {
    block.particles.material[p] = block.particles.position[1][p] < 8.0 * width ? 0 : 1;
  }
  const auto T = [&](std::size_t p, double t) {
    const bool first = block.particles.material[p] == 0;
    const double y = std::abs(block.particles.position[1][p] - 8.0 * width);
    return contact +
           ((first ? 500.0 : 300.0) - contact) *
               std::erf(y / std::sqrt(4.0 * diffusivity(first ? good : poor) * t + 1e-30));
  };
  return errors<2>({good, poor}, end, 4 * cells * cells, T, block);
}

TEST(HeatProfiles, TwoMaterialsTakeTheContactTemperature) {
  for (const ShapeFunction shape : {ShapeFunction::quadratic, ShapeFunction::cubic}) {
    const Errors coarse = contact_errors(8, shape), fine = contact_errors(16, shape);
    // The gradient jumps at the contact, which no spline can: first order, one cell of the steeper
    // gradient (5.9 K at 16 cells) at most.
    EXPECT_GT(std::log2(coarse.largest / fine.largest), 0.8);
    EXPECT_LT(fine.largest, 5.9);
    EXPECT_LT(fine.rms, 1.0);
  }
}

}  // namespace
}  // namespace poreshock::test
