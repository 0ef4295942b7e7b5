#include "poreshock/material/derived.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "poreshock/core/error.hpp"

namespace poreshock {

namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 7> units = {
    {{"temperature", "K"},
     {"pressure", "Pa"},
     {"density", "kg/m^3"},
     {"speed", "m/s"},
     {"von_mises", "Pa"},
     {"plastic_strain", "1"},
     {"molten", "1"}}};

template <int Dim>
double square(const std::array<std::vector<double>, symmetric_size<Dim>>& tensor, std::size_t i) {
  SymmetricTensor<Dim> value;
  for (std::size_t c = 0; c < value.size(); ++c) value[c] = tensor[c][i];
  return contract<Dim>(value, value);
}

template <int Dim>
std::int64_t temperatures(const Particles<Dim>& p, const std::vector<Material>& materials,
                          Thermal thermal, std::vector<double>& out) {
  std::int64_t floored = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    // The reference curve is a table: a density that is not a number must not index it.
    if (!(p.density[i] > 0.0)) {
      out[i] = std::numeric_limits<double>::quiet_NaN();
      continue;
    }
    const double value = particle_temperature<Dim>(p, materials, thermal, i);
    floored += value < temperature_floor;
    out[i] = value < temperature_floor ? temperature_floor : value;
  }
  return floored;
}

template <int Dim>
void molten_shares(const Particles<Dim>& p, const std::vector<Material>& materials, Thermal thermal,
                   std::vector<double>& out) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    out[i] = p.density[i] > 0.0 ? particle_phase<Dim>(p, materials, thermal, i).molten
                                : std::numeric_limits<double>::quiet_NaN();
  }
}

template <int Dim>
void speeds(const Particles<Dim>& p, std::vector<double>& out) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    double sum = 0.0;
    for (const auto& component : p.velocity) sum += component[i] * component[i];
    out[i] = std::sqrt(sum);
  }
}

}  // namespace

std::string_view derived_unit(std::string_view name) {
  std::string known;
  for (const auto& [field, unit] : units) {
    if (field == name) return unit;
    known += (known.empty() ? "" : ", ") + std::string(field);
  }
  throw InputError("unknown field \"" + std::string(name) + "\": allowed are " + known);
}

template <int Dim>
MaterialPhase particle_phase(const Particles<Dim>& p, const std::vector<Material>& materials,
                             Thermal thermal, std::size_t i) {
  const ThermalState state{p.density[i],
                           p.internal_energy[i],
                           p.plastic_work[i],
                           p.options.conducted_heat ? p.conducted_heat[i] : 0.0,
                           square<Dim>(p.deviator, i),
                           p.options.back_stress ? square<Dim>(p.back_stress, i) : 0.0,
                           p.options.failed && p.failed[i] > 0};
  return material_phase(materials[static_cast<std::size_t>(p.material[i])], thermal, state);
}

template <int Dim>
std::int64_t derive_field(std::string_view name, const Particles<Dim>& particles,
                          const std::vector<Material>& materials, Thermal thermal,
                          std::vector<double>& out) {
  derived_unit(name);
  out.resize(particles.size());
  if (name == "temperature") return temperatures(particles, materials, thermal, out);
  if (name == "pressure") out = particles.pressure;
  if (name == "density") out = particles.density;
  if (name == "plastic_strain") out = particles.plastic_strain;
  if (name == "speed") speeds(particles, out);
  if (name == "molten") molten_shares(particles, materials, thermal, out);
  if (name == "von_mises") {
    for (std::size_t i = 0; i < particles.size(); ++i) {
      out[i] = std::sqrt(1.5 * square<Dim>(particles.deviator, i));
    }
  }
  return 0;
}

template MaterialPhase particle_phase<2>(const Particles<2>&, const std::vector<Material>&, Thermal,
                                         std::size_t);
template MaterialPhase particle_phase<3>(const Particles<3>&, const std::vector<Material>&, Thermal,
                                         std::size_t);
template std::int64_t derive_field<2>(std::string_view, const Particles<2>&,
                                      const std::vector<Material>&, Thermal, std::vector<double>&);
template std::int64_t derive_field<3>(std::string_view, const Particles<3>&,
                                      const std::vector<Material>&, Thermal, std::vector<double>&);

}  // namespace poreshock
