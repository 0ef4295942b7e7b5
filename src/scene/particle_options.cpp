#include "poreshock/scene/particle_options.hpp"

#include "poreshock/scene/transfer_scheme.hpp"

namespace poreshock {

ParticleOptions particle_options(const Scene& scene) {
  ParticleOptions options;
  const Modes modes = scheme_of(scene.transfer.velocity).modes;
  options.affine = modes != Modes::constant;
  options.quadratic = modes == Modes::quadratic;
  options.conducted_heat = conducts_heat(scene) && scene.thermal == Thermal::paper;
  options.facing = scene.contact.self;
  for (const MaterialParameters& m : scene.materials) ask_for_columns(m, options);
  return options;
}

}  // namespace poreshock
