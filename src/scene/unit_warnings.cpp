#include "unit_warnings.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "poreshock/core/text.hpp"
#include "poreshock/material/library.hpp"
#include "rules.hpp"

namespace poreshock::scene_text {
namespace {

/// Another unit that a number may have been written in.
struct Unit {
  const char* name;
  double size;  ///< in SI
};

/// A key of a material that solids have within a decade of those in the library.
struct SolidKey {
  const char* key;
  const char* unit;
  double MaterialParameters::*value;
  Unit other;
};

constexpr SolidKey density_key = {
    "density", "kg/m^3", &MaterialParameters::density, {"g/cm^3", 1e3}};
constexpr SolidKey sound_key = {"c0", "m/s", &MaterialParameters::c0, {"km/s", 1e3}};
constexpr SolidKey heat_key = {"cv", "J/(kg K)", &MaterialParameters::cv, {"J/(g K)", 1e3}};

/// The least and the greatest value in the library.
std::pair<double, double> library_range(const SolidKey& key) {
  double low = INFINITY, high = 0.0;
  for (const LibraryMaterial& m : material_library()) {
    low = std::min(low, m.parameters.*key.value);
    high = std::max(high, m.parameters.*key.value);
  }
  return {low, high};
}

bool is_solid(const SolidKey& key, double value) {
  constexpr double decade = 10.0;
  const auto [low, high] = library_range(key);
  return value >= low / decade && value <= high * decade;
}

/// What was most likely meant, in SI.
double meant(const SolidKey& key, const MaterialParameters& m) {
  const double value = m.*key.value;
  return !is_solid(key, value) && is_solid(key, value * key.other.size) ? value * key.other.size
                                                                        : value;
}

std::string found(const std::string& key, double value, const std::string& unit) {
  return key + " = " + significant<4>(value) + " " + unit;
}

/// "; in GPa it is 6.9e+10 Pa" for the first unit that makes the value fit; else nothing.
template <class Fits>
std::string in_other_unit(double value, const std::string& si, std::initializer_list<Unit> units,
                          Fits&& fits) {
  for (const Unit& unit : units) {
    if (!fits(value * unit.size)) continue;
    return std::string(" If it is in ") + unit.name + ", write " +
           significant<4>(value * unit.size) + " (" + si + ").";
  }
  return "";
}

void warn_solid(const SolidKey& key, const MaterialParameters& m, const std::string& path,
                std::vector<std::string>& warnings) {
  const double value = m.*key.value;
  const auto [low, high] = library_range(key);
  const std::string name = found(path + key.key, value, key.unit);
  if (!is_solid(key, value)) {
    warnings.push_back(
        name + " is far from any solid: the library has " + significant<4>(low) + " to " +
        significant<4>(high) + "; all numbers are SI." +
        in_other_unit(value, key.unit, {key.other}, [&](double x) { return is_solid(key, x); }));
    return;
  }
  constexpr double far = 3.0;
  const LibraryMaterial* own = library_material(m.name);
  if (own == nullptr) return;
  const double ratio = value / own->parameters.*key.value;
  if (ratio < far && ratio > 1.0 / far) return;
  warnings.push_back(name + " is far from that of " + m.name + " in the library, " +
                     significant<4>(own->parameters.*key.value) +
                     "; all numbers are SI. Correct it, or give the material another name.");
}

void warn_young(const MaterialParameters& m, double modulus, const std::string& path,
                std::vector<std::string>& warnings) {
  constexpr double softest = 1e-5, stiffest = 10.0;
  const double share = m.young / modulus;
  if (!(m.young > 0.0) || (share > softest && share < stiffest)) return;
  warnings.push_back(
      found(path + "young", m.young, "Pa") + " does not go with a bulk modulus density c0^2 of " +
      significant<4>(modulus) + " Pa; all numbers are SI." +
      in_other_unit(m.young, "Pa", {{"MPa", 1e6}, {"GPa", 1e9}, {"kbar", 1e8}, {"Mbar", 1e11}},
                    [&](double x) { return x > 0.03 * modulus && x < 3.0 * modulus; }));
}

void warn_stress(const std::string& key, double stress, double modulus,
                 std::vector<std::string>& warnings) {
  constexpr double weakest = 1e-7;
  if (!(stress > 0.0) || stress > weakest * modulus) return;
  warnings.push_back(found(key, stress, "Pa") + " is only " + significant<4>(stress / modulus) +
                     " of the bulk modulus; all numbers are SI." +
                     in_other_unit(stress, "Pa", {{"MPa", 1e6}, {"GPa", 1e9}}, [&](double x) {
                       return x > 3e-5 * modulus && x < 0.3 * modulus;
                     }));
}

void warn_material(const MaterialParameters& m, const std::string& path,
                   std::vector<std::string>& warnings) {
  for (const SolidKey& key : {density_key, sound_key, heat_key}) {
    warn_solid(key, m, path, warnings);
  }
  const double c0 = meant(sound_key, m);
  const double modulus = meant(density_key, m) * c0 * c0;
  warn_young(m, modulus, path, warnings);
  const auto stress = [&](const std::string& key, double value) {
    warn_stress(path + key, value, modulus, warnings);
  };
  stress("spall", m.spall);
  if (m.strength == StrengthModel::linear) {
    stress("yield", m.yield);
    stress("hardening", m.hardening);
  }
  for_each_flow_law(m, [&](StrengthModel model, const auto& law) {
    if (model != m.strength) return;
    for (const auto& key : law.keys()) {
      if (std::string_view(key.unit) != "Pa") continue;
      stress(std::string(law.name) + "." + key.name, law.*key.value);
    }
  });
}

/// Fastest sound of the scene's materials as they were most likely meant, m/s.
double fastest_sound(const Scene& scene) {
  double c0 = 0.0;
  for (const MaterialParameters& m : scene.materials) c0 = std::max(c0, meant(sound_key, m));
  return c0;
}

void warn_velocity(const std::string& key, double velocity, const Scene& scene,
                   std::vector<std::string>& warnings) {
  constexpr double slow = 2e-3, fast = 10.0;
  const double c0 = fastest_sound(scene), v = std::fabs(velocity);
  const std::string name = found(key, velocity, "m/s");
  if (v > fast * c0) {
    warnings.push_back(name + " is " + significant<4>(v / c0) +
                       " times the sound speed; all numbers are SI. Correct it, or c0.");
  }
  const double cells = v * scene.time.end / scene.domain.cell;
  if (!(v > 0.0) || v > slow * c0 || cells > 1.0) return;
  warnings.push_back(name + " is only " + significant<4>(v / c0) + " of the sound speed and " +
                     significant<4>(cells) + " cells until time.end; all numbers are SI." +
                     in_other_unit(velocity, "m/s", {{"km/s", 1e3}}, [&](double x) {
                       return std::fabs(x) > 1e-2 * c0 && std::fabs(x) < fast * c0;
                     }));
}

void warn_velocities(const Scene& scene, std::vector<std::string>& warnings) {
  warn_velocity("loading.velocity", scene.loading.velocity, scene, warnings);
  warn_velocity("boundary.low.velocity", scene.boundary.low.velocity, scene, warnings);
  warn_velocity("boundary.high.velocity", scene.boundary.high.velocity, scene, warnings);
  constexpr std::size_t most = 3;
  const std::size_t before = warnings.size();
  for (std::size_t b = 0; b < scene.bodies.size() && warnings.size() < before + most; ++b) {
    const Triple& v = scene.bodies[b].velocity;
    warn_velocity("body." + std::to_string(b) + ".velocity",
                  std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]), scene, warnings);
  }
}

/// Lengths and times against each other: a run in which sound gets nowhere, or everywhere too
/// often.
void warn_scales(const Scene& scene, std::vector<std::string>& warnings) {
  constexpr double largest_cell = 0.1, most_crossings = 100.0;
  const double cell = scene.domain.cell, path = fastest_sound(scene) * scene.time.end;
  const double size =
      *std::max_element(scene.domain.size.begin(), scene.domain.size.begin() + scene.dimension);
  const std::string units = "; all numbers are SI: 10 um are 10e-6, 100 ns are 100e-9. Correct ";
  if (cell > largest_cell) {
    warnings.push_back(found("domain.cell", cell, "m") + units + "it, or domain.size.");
  }
  if (path < cell) {
    warnings.push_back("Sound gets only " + significant<4>(path / cell) + " cells far until " +
                       found("time.end", scene.time.end, "s") + units +
                       "time.end, domain.cell or c0.");
  }
  if (path > most_crossings * size) {
    warnings.push_back("Sound crosses the domain " + significant<4>(path / size) + " times until " +
                       found("time.end", scene.time.end, "s") + units +
                       "time.end, domain.size or c0.");
  }
}

}  // namespace

void warn_units(const Scene& scene, std::vector<std::string>& warnings) {
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    warn_material(scene.materials[i], "material." + std::to_string(i) + ".", warnings);
  }
  warn_velocities(scene, warnings);
  warn_scales(scene, warnings);
}

}  // namespace poreshock::scene_text
