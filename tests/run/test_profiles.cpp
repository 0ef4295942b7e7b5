// Averages over rows of cells against plain sums, closed forms and symmetries; the shock front.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "poreshock/material/derived.hpp"
#include "poreshock/run/profiles.hpp"
#include "poreshock/scene/transfer_scheme.hpp"
#include "poreshock/solver/ledger.hpp"
#include "support/runs.hpp"

namespace poreshock::test {
namespace {

const std::vector<std::string> names = {
    "solid_fraction", "density",     "pressure",      "stress",          "temperature",
    "plastic_strain", "fluctuation", "momentum_flux", "velocity across", "velocity along"};

std::vector<std::vector<double>> columns(const Profile& p, int dimension) {
  return {p.solid_fraction, p.density,
          p.pressure,       p.stress,
          p.temperature,    p.plastic_strain,
          p.fluctuation,    p.momentum_flux,
          p.velocity[0],    p.velocity[static_cast<std::size_t>(dimension - 1)]};
}

template <int Dim>
Profile profile_of(const Simulation<Dim>& sim) {
  std::int64_t floored = 0;
  return measure_profile(sim, floored);
}

/// Sums of doubles over all particles of all ranks, row after row: weight, then weight x value.
/// weight(p, share) and value(p, row) are those of the particle p.
template <int Dim, class Weight, class Value>
std::vector<double> plain_mean(const Simulation<Dim>& sim, Weight&& weight, Value&& value) {
  const double cell = sim.scene.domain.cell;
  const auto rows = static_cast<std::size_t>(sim.scene.domain.cells[Dim - 1]);
  std::vector<double> sums(2 * rows);
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    const double spacing = cell / sim.scene.sample.particles_per_cell;
    const double volume = sim.particles.mass[p] / sim.particles.density[p];
    const double length = std::min(cell, volume / std::pow(spacing, Dim - 1));
    const double y = sim.particles.position[Dim - 1][p];
    for (std::size_t j = 0; j < rows; ++j) {
      const double low = j == 0 ? -1.0 : cell * static_cast<double>(j);
      const double high = j + 1 == rows ? 1.0 : cell * static_cast<double>(j + 1);
      const double overlap = std::min(high, y + 0.5 * length) - std::max(low, y - 0.5 * length);
      if (overlap <= 0.0) continue;
      sums[2 * j] += weight(p) * overlap / length;
      sums[2 * j + 1] += weight(p) * overlap / length * value(p, j);
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM,
                sim.communicator);
  std::vector<double> mean(rows);
  for (std::size_t j = 0; j < rows; ++j) mean[j] = sums[2 * j + 1] / sums[2 * j];
  return mean;
}

/// The same averages, computed the plain way.
template <int Dim>
Profile plain_profile(const Simulation<Dim>& sim) {
  const Particles<Dim>& particles = sim.particles;
  std::vector<double> T;
  derive_field<Dim>("temperature", particles, sim.materials, sim.scene.thermal, T);
  const auto mass = [&](std::size_t p) { return particles.mass[p]; };
  const auto volume = [&](std::size_t p) { return particles.mass[p] / particles.density[p]; };
  const auto mean = [&](auto weight, const std::vector<double>& column) {
    return plain_mean(sim, weight, [&](std::size_t p, std::size_t) { return column[p]; });
  };
  Profile profile;
  profile.density = mean(volume, particles.density);
  profile.pressure = mean(volume, particles.pressure);
  profile.stress = plain_mean(sim, volume, [&](std::size_t p, std::size_t) {
    return particles.pressure[p] - particles.deviator[Dim - 1][p];
  });
  profile.temperature = mean(mass, T);
  profile.plastic_strain = mean(mass, particles.plastic_strain);
  for (std::size_t a = 0; a < Dim; ++a) profile.velocity[a] = mean(mass, particles.velocity[a]);
  const double inertia = affine_inertia(sim.scene.transfer, sim.scene.domain.cell);
  profile.fluctuation = plain_mean(sim, mass, [&](std::size_t p, std::size_t j) {
    double square = 0.0;
    for (std::size_t a = 0; a < Dim; ++a) {
      square += std::pow(particles.velocity[a][p] - profile.velocity[a][j], 2.0);
    }
    for (const auto& column : particles.affine) {
      if (inertia > 0.0) square += inertia * column[p] * column[p];
    }
    if (particles.options.quadratic) {
      for (const auto& column : particles.quadratic) square += column[p] * column[p];
    }
    return 0.5 * square;
  });
  profile.momentum_flux = plain_mean(sim, volume, [&](std::size_t p, std::size_t j) {
    constexpr std::size_t along = Dim - 1;
    double square = std::pow(particles.velocity[along][p] - profile.velocity[along][j], 2.0);
    for (std::size_t k = 0; k < Dim && inertia > 0.0; ++k) {
      square += inertia * std::pow(particles.affine[along * Dim + k][p], 2.0);
    }
    constexpr std::size_t second = second_modes<Dim>;
    for (std::size_t k = 0; k < second && particles.options.quadratic; ++k) {
      square += std::pow(particles.quadratic[along * second + k][p], 2.0);
    }
    return particles.pressure[p] - particles.deviator[along][p] + particles.viscous_pressure[p] +
           particles.density[p] * square;
  });
  return profile;
}

/// Largest difference, relative to the largest value; rows without a number must be the same.
double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double difference = 0.0, scale = 0.0;
  for (std::size_t j = 0; j < a.size(); ++j) {
    if (std::isnan(a[j]) && std::isnan(b[j])) continue;
    difference = std::isnan(a[j] - b[j]) ? HUGE_VAL : std::max(difference, std::abs(a[j] - b[j]));
    scale = std::max(scale, std::abs(b[j]));
  }
  return difference / scale;
}

template <int Dim>
void expect_plain_sums(const Simulation<Dim>& sim) {
  const auto found = columns(profile_of(sim), Dim);
  auto plain = columns(plain_profile(sim), Dim);
  for (std::size_t k = 1; k < names.size(); ++k) {
    for (std::size_t j = 0; j < found[0].size(); ++j) {
      if (found[0][j] < least_solid_fraction) plain[k][j] = std::nan("");
    }
    EXPECT_LT(distance(found[k], plain[k]), 1e-12) << names[k];
  }
}

TEST(Profiles, AreThePlainSumsOverParticles) {
  for (const auto& changes : {std::vector<std::string>{}, {"transfer.velocity=flip"}}) {
    Simulation<2> sim = start<2>(scene_of(porous_text(), changes), MPI_COMM_WORLD);
    advance_to(200, 0, sim);
    expect_plain_sums(sim);
  }
  Simulation<3> sim = start<3>(scene_of(balls_text()), MPI_COMM_WORLD);
  advance_to(40, 0, sim);
  expect_plain_sums(sim);
}

TEST(Profiles, SolidFractionsAddUpToTheSolidVolume) {
  Simulation<2> sim = start<2>(scene_of(porous_text()), MPI_COMM_WORLD);
  for (const std::int64_t step : {0, 200}) {
    advance_to(step, 0, sim);
    double solid = 0.0, found = 0.0;
    for (std::size_t p = 0; p < sim.particles.size(); ++p) {
      solid += sim.particles.mass[p] / sim.particles.density[p];
    }
    MPI_Allreduce(MPI_IN_PLACE, &solid, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    for (const double fraction : profile_of(sim).solid_fraction) found += fraction * 0.2e-3 * 10e-6;
    EXPECT_NEAR(found / solid, 1.0, 1e-12);
  }
}

/// Block of 20 x 38 cells without voids, 2 x 2 particles a cell.
const std::vector<std::string> solid_block = {"sample.kind=solid", "sample.height=0.38e-3",
                                              "loading.frame=[250.0, 700.0]"};

TEST(Profiles, UniformStateIsExact) {
  const Profile profile =
      profile_of(start<2>(scene_of(porous_text(), solid_block), MPI_COMM_WORLD));
  ASSERT_EQ(profile.height.size(), 44u);
  for (std::size_t j = 0; j < 44; ++j) {
    EXPECT_DOUBLE_EQ(profile.height[j], (static_cast<double>(j) + 0.5) * 10e-6);
    if (j >= 38) {
      EXPECT_EQ(profile.solid_fraction[j], 0.0);
      EXPECT_TRUE(std::isnan(profile.density[j]) && std::isnan(profile.velocity[1][j]) &&
                  std::isnan(profile.fluctuation[j]));
      continue;
    }
    EXPECT_NEAR(profile.solid_fraction[j], 1.0, 1e-12);
    EXPECT_NEAR(profile.density[j] / 2700.0, 1.0, 1e-14);
    EXPECT_NEAR(profile.temperature[j] / 300.0, 1.0, 1e-14);
    EXPECT_NEAR(profile.velocity[0][j] / 250.0, 1.0, 1e-14);
    EXPECT_NEAR(profile.velocity[1][j] / -400.0, 1.0, 1e-14);
    EXPECT_EQ(profile.pressure[j], 0.0);
    EXPECT_EQ(profile.plastic_strain[j], 0.0);
    // Not the difference of two large energies.
    EXPECT_LT(profile.fluctuation[j], 1e-20);
  }
  EXPECT_TRUE(profile.velocity[2].empty());
  EXPECT_TRUE(std::isnan(profile.front));
}

TEST(Profiles, CompressionAlongTheAxisLeavesNoGaps) {
  Simulation<2> sim = start<2>(scene_of(porous_text(), solid_block), MPI_COMM_SELF);
  constexpr double compression = 0.8392;
  for (double& y : sim.particles.position[1]) y *= compression;
  for (double& density : sim.particles.density) density /= compression;
  const Profile profile = profile_of(sim);
  // The block ends at 31.89 cells.
  for (std::size_t j = 0; j < 31; ++j) EXPECT_NEAR(profile.solid_fraction[j], 1.0, 1e-12) << j;
  EXPECT_NEAR(profile.solid_fraction[31], 38.0 * compression - 31.0, 1e-12);
  EXPECT_EQ(profile.solid_fraction[32], 0.0);
}

TEST(Profiles, SameBitsOnAllRanks) {
  const auto words_on = [](int ranks) {
    std::vector<std::uint64_t> words;
    on_ranks(ranks, [&](MPI_Comm part) {
      Simulation<2> sim = start<2>(scene_of(porous_text()), part);
      advance_to(150, ranks == 3 ? 70 : 0, sim);
      const Profile profile = profile_of(sim);
      for (const auto& column : columns(profile, 2)) {
        for (const double x : column) words.push_back(std::bit_cast<std::uint64_t>(x));
      }
      words.push_back(std::bit_cast<std::uint64_t>(profile.front));
      words.push_back(std::bit_cast<std::uint64_t>(profile.width));
      EXPECT_TRUE(std::isfinite(profile.front) && std::isfinite(profile.width));
    });
    return words;
  };
  const auto alone = words_on(1);
  for (int ranks = 2; ranks <= size(MPI_COMM_WORLD); ++ranks) {
    const auto together = words_on(ranks);
    // Ranks that took no part hold nothing.
    EXPECT_TRUE(rank(MPI_COMM_WORLD) != 0 || together == alone) << ranks << " ranks";
  }
}

TEST(Profiles, MovingWallShowsTheSameShock) {
  const auto profile_with = [](const std::vector<std::string>& changes) {
    Simulation<2> sim = start<2>(scene_of(porous_text(), changes), MPI_COMM_WORLD);
    advance_to(150, 0, sim);
    const Profile profile = profile_of(sim);
    EXPECT_DOUBLE_EQ(profile.shift, changes.empty() ? 0.0 : 1100.0 * sim.clock.time);
    return profile;
  };
  const Profile falling = profile_with({});
  const Profile pushed =
      profile_with({"loading.velocity=0.0", "boundary.low={kind='wall', velocity=1100.0}"});
  EXPECT_NEAR(pushed.front / falling.front, 1.0, 1e-9);
  EXPECT_LT(distance(pushed.stress, falling.stress), 1e-8);
  EXPECT_LT(distance(pushed.fluctuation, falling.fluctuation), 1e-8);
}

std::vector<double> heights(std::size_t rows) {
  std::vector<double> height(rows);
  for (std::size_t j = 0; j < rows; ++j) height[j] = 2.0 * static_cast<double>(j) + 1.0;
  return height;
}

TEST(FindFront, LinearRampIsExact) {
  // u = 1 up to height 5, 0 from height 13 on, linear between: 0.9 at 5.8, 0.5 at 9, 0.1 at 12.2.
  const std::vector<double> velocity = {0, 0, 0, -25, -50, -75, -100, -100, -100};
  const Front front = find_front(heights(9), velocity, -100.0, 0.0);
  EXPECT_DOUBLE_EQ(front.position, 9.0);
  EXPECT_DOUBLE_EQ(front.width, 12.2 - 5.8);
}

TEST(FindFront, HighestCrossingCountsAndEmptyRowsAreSkipped) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  // Noise below the front passes every level again; the rows at 9 and 17 hold no material.
  const std::vector<double> velocity = {0, -60, -5, -95, none, 0, -100, -100, none};
  const Front front = find_front(heights(9), velocity, -100.0, 0.0);
  EXPECT_DOUBLE_EQ(front.position, 12.0);
  EXPECT_DOUBLE_EQ(front.width, 12.8 - 11.2);
}

TEST(FindFront, NoneWithoutAShock) {
  const std::vector<double> swept = {0, 0, -5, 30}, partly = {-30, -40, -60, -100};
  EXPECT_TRUE(std::isnan(find_front(heights(4), swept, -100.0, 0.0).position));
  EXPECT_TRUE(std::isnan(find_front(heights(4), partly, -100.0, -100.0).position));
  EXPECT_TRUE(std::isnan(find_front({}, {}, -100.0, 0.0).position));
  // Half of the velocity is reached, nine tenths are not.
  const Front front = find_front(heights(4), partly, -100.0, 0.0);
  EXPECT_DOUBLE_EQ(front.position, 4.0);
  EXPECT_TRUE(std::isnan(front.width));
}

}  // namespace
}  // namespace poreshock::test
