#include "poreshock/solver/check_state.hpp"

#include <cmath>
#include <type_traits>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"

namespace poreshock {

namespace {

/// Particles of a rank that no run can have, by what is wrong with them.
struct Unsound {
  std::int64_t numbers = 0, places = 0, masses = 0, materials = 0;
};

template <int Dim>
std::int64_t numbers_not_finite(const Particles<Dim>& particles) {
  std::int64_t count = 0;
  for_each_column(particles, [&](std::string_view, int, const auto& column) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(column[0])>, double>) {
      for (const double x : column) count += std::isfinite(x) ? 0 : 1;
    }
  });
  return count;
}

template <int Dim>
Unsound count_unsound(const Simulation<Dim>& sim) {
  const Scene& scene = sim.scene;
  const Particles<Dim>& particles = sim.particles;
  const double bottom = sim.window.first * scene.domain.cell;
  Unsound found;
  found.numbers = numbers_not_finite(particles);
  const auto materials = static_cast<std::int32_t>(scene.materials.size());
  for (std::size_t p = 0; p < particles.size(); ++p) {
    bool inside = true;
    for (int a = 0; a < Dim; ++a) {
      const double x = particles.position[a][p], low = a + 1 < Dim ? 0.0 : bottom;
      inside = inside && x >= low && x <= low + scene.domain.size[a];
    }
    if (!inside) ++found.places;
    if (!(particles.mass[p] > 0.0 && particles.density[p] > 0.0)) ++found.masses;
    if (particles.material[p] < 0 || particles.material[p] >= materials) ++found.materials;
  }
  return found;
}

bool sound_clock(const RunState& state) {
  return state.step >= 0 && state.beat >= 0 && std::isfinite(state.time) && state.time >= 0.0 &&
         std::isfinite(state.last_dt) && state.last_dt >= 0.0;
}

}  // namespace

template <int Dim>
std::string unsound_particles(const Simulation<Dim>& sim) {
  const Unsound mine = count_unsound(sim);
  std::vector<std::int64_t> counts = {mine.numbers, mine.places, mine.masses, mine.materials};
  sum(counts, sim.communicator);
  std::string found;
  const auto add = [&](std::int64_t count, const char* what) {
    if (count == 0) return;
    found += (found.empty() ? "" : ", ") + std::to_string(count) + " " + what;
  };
  add(counts[0], "numbers that are not finite");
  add(counts[1], "particles outside the domain");
  add(counts[2], "particles without mass or density");
  add(counts[3], "particles of a material that the scene does not have");
  return found;
}

template <int Dim>
void require_sound_state(const std::string& path, const Simulation<Dim>& sim,
                         const ParticleOptions& expected, const RunState& state) {
  std::string found = unsound_particles(sim);
  if (!sound_clock(state)) found += found.empty() ? "a clock before zero" : ", a clock before zero";
  if (expected != sim.particles.options) {
    found += std::string(found.empty() ? "" : ", ") + "columns that do not fit the scene";
  }
  if (found.empty()) return;
  throw InputError(path + ": its state is not one of this scene: found " + found +
                   "; restart from another checkpoint");
}

template std::string unsound_particles<2>(const Simulation<2>&);
template std::string unsound_particles<3>(const Simulation<3>&);
template void require_sound_state<2>(const std::string&, const Simulation<2>&,
                                     const ParticleOptions&, const RunState&);
template void require_sound_state<3>(const std::string&, const Simulation<3>&,
                                     const ParticleOptions&, const RunState&);

}  // namespace poreshock
