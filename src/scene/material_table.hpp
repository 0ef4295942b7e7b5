#pragma once
// The keys of a material.

#include <string>
#include <vector>

#include "poreshock/material/library.hpp"
#include "poreshock/scene/scene.hpp"
#include "rules.hpp"

namespace poreshock::scene_text {

/// The yield stress by one of the strength models.
template <typename Visitor>
void visit_strength(Visitor& visitor, MaterialParameters& material, bool known) {
  Names<StrengthModel> models{{"linear", StrengthModel::linear}};
  for_each_flow_law(material, [&](StrengthModel model, const auto& law) {
    models.emplace_back(law.name, model);
  });
  const Names<PlasticHeat> heats{{"work", PlasticHeat::work},
                                 {"dissipation", PlasticHeat::dissipation}};
  choice(visitor, "strength", material.strength, models, {"how the yield stress changes"});
  const bool has = known && has_strength(material, material.strength);
  const Need need = has ? Need::optional : Need::required;
  for_each_flow_law(material, [&](StrengthModel model, auto& law) {
    if (material.strength != model) return;
    visitor.table(law.name, {law.about}, [&](auto& inner) {
      for (const auto& key : law.keys()) {
        inner.number(key.name, law.*key.value,
                     {key.range, key.unit, key.about, key.required ? need : Need::optional});
      }
    });
  });
  if (material.strength != StrengthModel::linear) return;
  visitor.number("yield", material.yield, {not_negative, "Pa", "initial yield stress", need});
  visitor.number("hardening", material.hardening,
                 {not_negative, "Pa", "rise of the yield stress per plastic strain"});
  visitor.number("kinematic_share", material.kinematic_share,
                 {share, "", "of the hardening: 0 isotropic, 1 kinematic"});
  choice(visitor, "plastic_heat", material.plastic_heat, heats,
         {"all plastic work is heat, or all but what the back stress stores"});
}

template <typename Visitor>
void visit_melting(Visitor& visitor, MaterialParameters& material, bool known) {
  const Names<MeltingLaw> laws{{"none", MeltingLaw::none},
                               {"lindemann", MeltingLaw::lindemann},
                               {"simon_glatzel", MeltingLaw::simon_glatzel}};
  choice(visitor, "melting", material.melting, laws,
         {"none: stays solid at any temperature; else its melt curve; conserving mode only"});
  if (material.melting == MeltingLaw::none) return;
  MeltParameters& melt = material.melt;
  const Need need = known && melt.latent_heat > 0.0 ? Need::optional : Need::required;
  visitor.table(
      "melt",
      {"T_m = temperature (rho/rho_0)^(2 (gamma - 1/3)), lindemann, or temperature (1 + "
       "P/pressure)^(1/exponent), simon_glatzel."},
      [&](auto& inner) {
        inner.number("temperature", melt.temperature, {positive, "K", "at no pressure", need});
        inner.number(
            "latent_heat", melt.latent_heat,
            {positive, "J/kg", "taken up while the temperature stays on the melt curve", need});
        if (material.melting != MeltingLaw::simon_glatzel) return;
        inner.number("pressure", melt.pressure,
                     {positive, "Pa", "a of simon_glatzel", Need::required});
        inner.number("exponent", melt.exponent,
                     {positive, "", "c of simon_glatzel", Need::required});
      });
}

/// The name; without numbers of its own (`own`) the material must have one of the library.
template <typename Visitor>
void visit_name(Visitor& visitor, bool own, std::string& name) {
  const Rule rule{"other tables refer to it; a name of the library stands for its numbers",
                  Need::required};
  if (own) return visitor.text("name", name, rule);
  std::vector<std::string> names;
  for (const LibraryMaterial& m : material_library()) names.push_back(m.parameters.name);
  visitor.name("name", name, names, rule);
}

template <typename Visitor>
void visit_material(Visitor& visitor, MaterialParameters& material) {
  constexpr Range up_to_20{.low = 0.0, .high = 20.0};
  constexpr Range below_half{.low = 0.0, .high = 0.5, .below_high = true};
  const bool own =
      visitor.gives_any({"density", "young", "poisson", "c0", "lambda", "gamma", "cv"});
  visit_name(visitor, own, material.name);
  const LibraryMaterial* library = library_material(material.name);
  const bool known = library != nullptr;
  if (known) visitor.fallback(material, library->parameters);
  if (!own && !known) {
    visitor.skip_unknown();
    return;
  }
  const Need need = known ? Need::optional : Need::required;
  visitor.name("model", material.model, {"j2_mie_gruneisen"},
               {"J2 plasticity with a Mie-Grueneisen equation of state"});
  visitor.number("density", material.density,
                 {positive, "kg/m^3", "of the solid without voids", need});
  visitor.number("young", material.young,
                 {not_negative, "Pa", "with poisson the shear modulus; 0 = a fluid", need});
  visitor.number("poisson", material.poisson, {below_half, "", "Poisson's ratio", need});
  visit_strength(visitor, material, known);
  visitor.number("c0", material.c0,
                 {positive, "m/s", "bulk sound speed, of Us = c0 + lambda Up", need});
  visitor.number("lambda", material.lambda,
                 {{.low = 1.0, .high = 20.0}, "", "slope of Us = c0 + lambda Up", need});
  visitor.number("gamma", material.gamma, {up_to_20, "", "Grueneisen coefficient, constant", need});
  visitor.number("cv", material.cv, {positive, "J/(kg K)", "specific heat", need});
  visitor.number("conductivity", material.conductivity,
                 {not_negative, "W/(m K)", "of heat; used with heat conduction only"});
  visitor.number("T0", material.T0, {positive, "K", "initial temperature"});
  visitor.number("spall", material.spall, {not_negative, "Pa", "tension it opens at; 0 = never"});
  visitor.number(
      "spall_time", material.spall_time,
      {not_negative, "s", "for which it opens before it fails; 0 = while sound crosses 32 cells"});
  visit_melting(visitor, material, known);
}

}  // namespace poreshock::scene_text
