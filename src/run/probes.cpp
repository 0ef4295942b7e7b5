#include "poreshock/run/probes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "poreshock/core/parallel.hpp"
#include "poreshock/material/derived.hpp"
#include "quanta.hpp"

namespace poreshock {

namespace {

/// Sums kept for a probe, in this order; the momentum takes Dim places.
enum ProbeSum : std::size_t {
  count,
  mass,
  height,
  volume,
  pressure_work,
  stress_work,
  heat,
  momentum
};

/// Sites of the lattice by the ids of the particles that started there.
template <int Dim>
struct Sites {
  explicit Sites(const Scene& scene)
      : spacing(scene.domain.cell / scene.sample.particles_per_cell) {
    for (int a = 0; a + 1 < Dim; ++a) {
      sites[a] = static_cast<std::int64_t>(scene.domain.cells[a]) * scene.sample.particles_per_cell;
      layer *= sites[a];
    }
  }
  /// Column of the lattice along the shock axis.
  std::int64_t column(std::int64_t id) const { return id % layer; }
  Vector<Dim> place(std::int64_t id) const {
    Vector<Dim> x;
    std::int64_t rest = id;
    for (int a = 0; a + 1 < Dim; ++a, rest /= sites[a - 1]) x[a] = coordinate(rest % sites[a]);
    x[Dim - 1] = coordinate(rest);
    return x;
  }
  double coordinate(std::int64_t i) const { return (static_cast<double>(i) + 0.5) * spacing; }

  std::array<std::int64_t, Dim> sites{};
  std::int64_t layer = 1;
  double spacing;
};

/// Square of the distance across the shock axis, by the nearest image, and along it if asked for.
template <int Dim>
double square_distance(const Scene& scene, const Vector<Dim>& x, const Triple& at, bool along) {
  double square = 0.0;
  for (int a = 0; a < (along ? Dim : Dim - 1); ++a) {
    double d = x[a] - at[a];
    if (a + 1 < Dim && scene.domain.periodic[a]) {
      d -= scene.domain.size[a] * std::nearbyint(d / scene.domain.size[a]);
    }
    square += d * d;
  }
  return square;
}

/// True for particles that a probe may follow.
template <int Dim>
bool is_candidate(const Probe& probe, const Scene& scene, const Vector<Dim>& start) {
  // A spot that ends on a line of sites holds them.
  const double radius = 0.5 * probe.width * (1.0 + 1e-9);
  const bool along = probe.kind == ProbeKind::particle;
  if (square_distance<Dim>(scene, start, probe.at, along) > radius * radius) return false;
  if (probe.kind != ProbeKind::interface) return true;
  const double above = start[Dim - 1] - probe.at[Dim - 1];
  return probe.faces == Facing::up ? above < 0.0 : above > 0.0;
}

/// Keeps the outermost id of every column, in the order of the columns.
template <int Dim>
void keep_outermost(Facing faces, const Sites<Dim>& sites, std::vector<std::int64_t>& ids) {
  std::sort(ids.begin(), ids.end(), [&](std::int64_t a, std::int64_t b) {
    const std::int64_t column_a = sites.column(a), column_b = sites.column(b);
    if (column_a != column_b) return column_a < column_b;
    return faces == Facing::up ? a > b : a < b;
  });
  const auto same = [&](std::int64_t a, std::int64_t b) {
    return sites.column(a) == sites.column(b);
  };
  ids.erase(std::unique(ids.begin(), ids.end(), same), ids.end());
}

/// Material of the particles of the target on all ranks; -1 when they differ. Collective.
template <int Dim>
int common_material(const Particles<Dim>& particles, const std::vector<std::int64_t>& ids,
                    MPI_Comm communicator) {
  std::vector<std::int32_t> found;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (std::binary_search(ids.begin(), ids.end(), particles.id[p]) &&
        std::find(found.begin(), found.end(), particles.material[p]) == found.end()) {
      found.push_back(particles.material[p]);
    }
  }
  const std::vector<std::int32_t> all = gather_all(found, communicator);
  const bool one = !all.empty() && std::count(all.begin(), all.end(), all[0]) == std::ssize(all);
  return one ? all[0] : -1;
}

/// Adds a particle with a weight to the sums.
template <int Dim>
void add_particle(const Simulation<Dim>& sim, std::size_t p, double weight, const Quanta& per,
                  double length, std::vector<Int128>& to) {
  const Particles<Dim>& particles = sim.particles;
  const double m = weight * particles.mass[p];
  const double v = m / particles.density[p];
  const double pressure = particles.pressure[p];
  const double temperature =
      particle_temperature<Dim>(particles, sim.materials, sim.scene.thermal, p);
  to[count] += 1;
  to[mass] += quantise(m, per.mass);
  to[height] += quantise(m * particles.position[Dim - 1][p], per.mass / length);
  to[volume] += quantise(v, per.volume);
  to[pressure_work] += quantise(v * pressure, per.energy);
  to[stress_work] += quantise(v * (pressure - particles.deviator[Dim - 1][p]), per.energy);
  to[heat] += quantise(m * temperature, per.heat);
  for (int a = 0; a < Dim; ++a) {
    to[momentum + a] += quantise(m * particles.velocity[a][p], per.momentum);
  }
}

/// Sums over the particles that a probe sees, of all ranks. Collective.
template <int Dim>
std::vector<Int128> sums_of(const Probe& probe, const ProbeTarget& target,
                            const Simulation<Dim>& sim, const Quanta& per, double length) {
  std::vector<Int128> sums(momentum + Dim);
  const Particles<Dim>& particles = sim.particles;
  if (probe.kind == ProbeKind::point) {
    const Vector<Dim> shift = grid_shift(sim);
    Triple at = probe.at;
    for (int a = 0; a < Dim; ++a) at[a] -= shift[a];
    const double inverse = 2.0 / (probe.width * probe.width);
    for (std::size_t p = 0; p < particles.size(); ++p) {
      Vector<Dim> x;
      for (int a = 0; a < Dim; ++a) x[a] = particles.position[a][p];
      const double weight = 1.0 - inverse * square_distance<Dim>(sim.scene, x, at, true);
      if (weight > 0.0) add_particle(sim, p, weight, per, length, sums);
    }
  } else if (!target.ids.empty()) {
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const std::int64_t id = particles.id[p];
      if (id < target.ids.front() || id > target.ids.back()) continue;
      if (!std::binary_search(target.ids.begin(), target.ids.end(), id)) continue;
      add_particle(sim, p, 1.0, per, length, sums);
    }
  }
  sum(sums, sim.communicator);
  return sums;
}

template <int Dim>
ProbeRow row_of(const std::vector<Int128>& sums, const Simulation<Dim>& sim, const Quanta& per,
                double length) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const auto value = [&](std::size_t k, double inverse) {
    return static_cast<double>(sums[k]) / inverse;
  };
  ProbeRow row;
  row.time = sim.clock.time;
  row.step = sim.clock.step;
  row.mass = value(mass, per.mass);
  const double m = row.mass > 0.0 ? row.mass : none;
  const double v = row.mass > 0.0 ? value(volume, per.volume) : none;
  row.height = value(height, per.mass / length) / m + grid_shift(sim)[Dim - 1];
  row.pressure = value(pressure_work, per.energy) / v;
  row.stress = value(stress_work, per.energy) / v;
  row.temperature = value(heat, per.heat) / m;
  for (std::size_t a = 0; a < Dim; ++a) {
    row.velocity[a] = value(momentum + a, per.momentum) / m;
  }
  return row;
}

}  // namespace

template <int Dim>
ProbeTarget find_target(const Probe& probe, const Simulation<Dim>& sim) {
  ProbeTarget target;
  if (probe.kind == ProbeKind::point) return target;
  const Sites<Dim> sites(sim.scene);
  for (const std::int64_t id : sim.particles.id) {
    if (is_candidate<Dim>(probe, sim.scene, sites.place(id))) target.ids.push_back(id);
  }
  const bool outer = probe.kind != ProbeKind::particle;
  if (outer) keep_outermost(probe.faces, sites, target.ids);
  target.ids = gather_all(target.ids, sim.communicator);
  if (outer) keep_outermost(probe.faces, sites, target.ids);
  std::sort(target.ids.begin(), target.ids.end());
  target.material = common_material(sim.particles, target.ids, sim.communicator);
  return target;
}

template <int Dim>
ProbeRow look(const Probe& probe, const Simulation<Dim>& sim, ProbeTarget& target) {
  const Quanta per = make_quanta(sim.ledger, sim.materials, sim.scene);
  const double length = power_of_two_below(sim.scene.domain.size[Dim - 1]);
  std::vector<Int128> sums = sums_of(probe, target, sim, per, length);
  if (probe.kind != ProbeKind::point && sums[count] < std::ssize(target.ids)) {
    const int material = target.material;
    target = find_target(probe, sim);
    target.material = material;
    sums = sums_of(probe, target, sim, per, length);
  }
  return row_of(sums, sim, per, length);
}

template ProbeTarget find_target<2>(const Probe&, const Simulation<2>&);
template ProbeTarget find_target<3>(const Probe&, const Simulation<3>&);
template ProbeRow look<2>(const Probe&, const Simulation<2>&, ProbeTarget&);
template ProbeRow look<3>(const Probe&, const Simulation<3>&, ProbeTarget&);

}  // namespace poreshock
