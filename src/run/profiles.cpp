#include "poreshock/run/profiles.hpp"

#include <algorithm>
#include <cmath>

#include "poreshock/material/derived.hpp"
#include "poreshock/scene/transfer_scheme.hpp"
#include "quanta.hpp"

namespace poreshock {

namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

/// Sums kept for each row, in this order; the momentum takes Dim places.
enum RowSum : std::size_t {
  mass,
  volume,
  pressure_work,
  stress_work,
  viscous_work,
  heat,
  strain,
  momentum
};

/// Kinetic energy of the deviation from the mean velocity of a row: of all components, and of the
/// one along the shock axis.
enum FluctuationSum : std::size_t { all_axes, shock_axis, fluctuation_sum_count };

/// Where a particle lies: its rows and the share of it in the lower one.
struct Place {
  std::size_t row = 0;
  std::size_t next = 0;  ///< the row above, or `row` again
  double share = 1.0;    ///< of `row`
};

/// What the places of all particles share.
struct PlaceScales {
  double inverse_area;   ///< 1/m^(Dim-1), of the face of a particle of the lattice
  double inverse_cell;   ///< 1/m
  double low, last_row;  ///< of the domain
};

template <int Dim>
PlaceScales place_scales(const Simulation<Dim>& sim) {
  const Scene& scene = sim.scene;
  const double spacing = scene.domain.cell / scene.sample.particles_per_cell;
  return {1.0 / (Dim == 2 ? spacing : spacing * spacing), 1.0 / scene.domain.cell,
          static_cast<double>(sim.window.first),
          static_cast<double>(scene.domain.cells[Dim - 1] - 1)};
}

/// Place of a particle. It fills an interval of the shock axis around its position, as long as a
/// particle of the lattice that was compressed along this axis only, at most a cell. What lies
/// beyond the ends of the domain belongs to the end rows.
template <int Dim>
Place place_of(const Particles<Dim>& particles, std::size_t p, const PlaceScales& scales) {
  const double volume = particles.mass[p] / particles.density[p];
  const double length = std::min(1.0, volume * scales.inverse_area * scales.inverse_cell);
  const double low = particles.position[Dim - 1][p] * scales.inverse_cell - 0.5 * length;
  const double row = std::floor(low);
  const double inside = row - scales.low;
  return {static_cast<std::size_t>(std::clamp(inside, 0.0, scales.last_row)),
          static_cast<std::size_t>(std::clamp(inside + 1.0, 0.0, scales.last_row)),
          std::min(1.0, (row + 1.0 - low) / length)};
}

/// Adds the particle p with weight `share` to the sums of one row.
template <int Dim>
void add_particle(const Particles<Dim>& particles, std::size_t p, double share, double temperature,
                  const Quanta& per, Int128* to) {
  const double m = share * particles.mass[p];
  const double v = m / particles.density[p];
  const double pressure = particles.pressure[p];
  to[mass] += quantise(m, per.mass);
  to[volume] += quantise(v, per.volume);
  to[pressure_work] += quantise(v * pressure, per.energy);
  to[stress_work] += quantise(v * (pressure - particles.deviator[Dim - 1][p]), per.energy);
  to[viscous_work] += quantise(v * particles.viscous_pressure[p], per.energy);
  to[heat] += quantise(m * temperature, per.heat);
  to[strain] += quantise(m * particles.plastic_strain[p], per.mass);
  for (int a = 0; a < Dim; ++a) {
    to[momentum + a] += quantise(m * particles.velocity[a][p], per.momentum);
  }
}

/// Sums over the particles of all ranks, row after row. Collective.
template <int Dim>
std::vector<Int128> row_sums(const Simulation<Dim>& sim, const std::vector<double>& temperature,
                             const Quanta& per) {
  const PlaceScales scales = place_scales(sim);
  constexpr std::size_t count = momentum + Dim;
  std::vector<Int128> sums(count * static_cast<std::size_t>(sim.scene.domain.cells[Dim - 1]));
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    const auto [row, next, share] = place_of(sim.particles, p, scales);
    add_particle(sim.particles, p, share, temperature[p], per, &sums[count * row]);
    if (share == 1.0) continue;
    add_particle(sim.particles, p, 1.0 - share, temperature[p], per, &sums[count * next]);
  }
  sum(sums, sim.communicator);
  return sums;
}

/// Kinetic energies of the deviation from the mean velocities of the rows, row after row.
/// Collective.
template <int Dim>
std::vector<Int128> fluctuation_sums(const Simulation<Dim>& sim,
                                     const std::array<std::vector<double>, 3>& mean,
                                     const Quanta& per) {
  const PlaceScales scales = place_scales(sim);
  const double inertia = affine_inertia(sim.scene.transfer, sim.scene.domain.cell);
  const Particles<Dim>& particles = sim.particles;
  std::vector<Int128> sums(fluctuation_sum_count * mean[0].size());
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const std::array<double, Dim> modes = mode_squares(particles, inertia, p);
    const auto add = [&](std::size_t row, double share) {
      if (std::isnan(mean[0][row])) return;
      const double half_mass = 0.5 * (share * particles.mass[p]);
      double square = 0.0, along = 0.0;
      for (std::size_t a = 0; a < Dim; ++a) {
        const double deviation = particles.velocity[a][p] - mean[a][row];
        along = modes[a] + deviation * deviation;
        square += along;
      }
      Int128* const to = &sums[fluctuation_sum_count * row];
      to[all_axes] += quantise(half_mass * square, per.energy);
      to[shock_axis] += quantise(half_mass * along, per.energy);
    };
    const Place place = place_of(particles, p, scales);
    add(place.row, place.share);
    if (place.share < 1.0) add(place.next, 1.0 - place.share);
  }
  sum(sums, sim.communicator);
  return sums;
}

template <int Dim>
void resize(std::size_t rows, Profile& profile) {
  for (auto* column : {&profile.density, &profile.pressure, &profile.stress, &profile.momentum_flux,
                       &profile.temperature, &profile.plastic_strain, &profile.fluctuation}) {
    column->assign(rows, no_value);
  }
  for (std::size_t a = 0; a < Dim; ++a) profile.velocity[a].assign(rows, no_value);
  profile.height.assign(rows, 0.0);
  profile.solid_fraction.assign(rows, 0.0);
}

template <int Dim>
void divide_sums(const std::vector<Int128>& sums, const Quanta& per, double row_volume,
                 Profile& profile) {
  for (std::size_t j = 0; j < profile.height.size(); ++j) {
    const Int128* from = &sums[(momentum + Dim) * j];
    const double m = static_cast<double>(from[mass]) / per.mass;
    const double v = static_cast<double>(from[volume]) / per.volume;
    profile.solid_fraction[j] = v / row_volume;
    if (profile.solid_fraction[j] < least_solid_fraction) continue;
    profile.density[j] = m / v;
    profile.pressure[j] = static_cast<double>(from[pressure_work]) / per.energy / v;
    profile.stress[j] = static_cast<double>(from[stress_work]) / per.energy / v;
    profile.momentum_flux[j] =
        static_cast<double>(from[stress_work] + from[viscous_work]) / per.energy / v;
    profile.temperature[j] = static_cast<double>(from[heat]) / per.heat / m;
    profile.plastic_strain[j] = static_cast<double>(from[strain]) / per.mass / m;
    for (std::size_t a = 0; a < Dim; ++a) {
      profile.velocity[a][j] = static_cast<double>(from[momentum + a]) / per.momentum / m;
    }
  }
}

/// Front of the shock that the plane at the low side drives into material that
/// comes with the velocity of the loading.
Front wall_front(const Scene& scene, const Profile& profile) {
  const Side& low = scene.boundary.low;
  if (!side_law(low.kind).mirrors) return {no_value, no_value};
  const auto axis = static_cast<std::size_t>(scene.dimension - 1);
  const double frame = scene.loading.frame[axis];
  return find_front(profile.height, profile.velocity[axis], frame - scene.loading.velocity,
                    frame + low.velocity);
}

/// Height at which u first reaches `level` coming down from the top; rows are top to bottom.
double crossing(const std::vector<std::array<double, 2>>& rows, double level) {
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const auto& [height, u] = rows[i];
    if (!(u >= level)) continue;
    const auto& [height_above, u_above] = rows[i - 1];
    return height_above + (level - u_above) / (u - u_above) * (height - height_above);
  }
  return no_value;
}

}  // namespace

Front find_front(const std::vector<double>& height, const std::vector<double>& velocity,
                 double ahead, double behind) {
  constexpr double toe = 0.1, middle = 0.5, shoulder = 0.9;
  const Front none = {no_value, no_value};
  if (!(behind > ahead)) return none;
  std::vector<std::array<double, 2>> rows;
  for (std::size_t j = height.size(); j-- > 0;) {
    if (std::isnan(velocity[j])) continue;
    rows.push_back({height[j], (velocity[j] - ahead) / (behind - ahead)});
  }
  if (rows.empty() || rows[0][1] >= toe) return none;
  return {crossing(rows, middle), crossing(rows, toe) - crossing(rows, shoulder)};
}

template <int Dim>
Profile measure_profile(const Simulation<Dim>& sim, std::int64_t& floored) {
  const Domain& domain = sim.scene.domain;
  const int rows = domain.cells[Dim - 1];
  double row_volume = domain.cell;
  for (std::size_t a = 0; a + 1 < Dim; ++a) row_volume *= domain.size[a];
  const Quanta per = make_quanta(sim.ledger, sim.materials, sim.scene);
  std::vector<double> temperature;
  floored = derive_field<Dim>("temperature", sim.particles, sim.materials, sim.scene.thermal,
                              temperature);
  Profile profile;
  resize<Dim>(static_cast<std::size_t>(rows), profile);
  profile.shift = low_corner(sim)[Dim - 1];
  for (int j = 0; j < rows; ++j)
    profile.height[static_cast<std::size_t>(j)] = (j + 0.5) * domain.cell;
  divide_sums<Dim>(row_sums(sim, temperature, per), per, row_volume, profile);
  const std::vector<Int128> kinetic = fluctuation_sums(sim, profile.velocity, per);
  for (std::size_t j = 0; j < profile.height.size(); ++j) {
    const Int128* from = &kinetic[fluctuation_sum_count * j];
    const double v = profile.solid_fraction[j] * row_volume;
    profile.fluctuation[j] =
        static_cast<double>(from[all_axes]) / per.energy / (profile.density[j] * v);
    profile.momentum_flux[j] += 2.0 * static_cast<double>(from[shock_axis]) / per.energy / v;
  }
  const Front front = wall_front(sim.scene, profile);
  profile.front = front.position;
  profile.width = front.width;
  return profile;
}

template Profile measure_profile<2>(const Simulation<2>&, std::int64_t&);
template Profile measure_profile<3>(const Simulation<3>&, std::int64_t&);

}  // namespace poreshock
