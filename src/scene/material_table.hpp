#pragma once
// The keys of a material.

#include <string>
#include <vector>

#include "poreshock/material/library.hpp"
#include "poreshock/scene/scene.hpp"
#include "rules.hpp"

namespace poreshock::scene_text {

inline constexpr Range exponent_range{.low = 0.0, .high = 1.0, .above_low = true};

template <typename Visitor>
void visit_johnson_cook(Visitor& visitor, JohnsonCookParameters& p, Need need) {
  visitor.number("yield", p.yield, {positive, "Pa", "A", need});
  visitor.number("hardening", p.hardening, {not_negative, "Pa", "B", need});
  visitor.number("exponent", p.exponent, {exponent_range, "", "n of the plastic strain", need});
  visitor.number("rate", p.rate, {not_negative, "", "C, rise per e-fold of the strain rate", need});
  visitor.number("reference_rate", p.reference_rate,
                 {positive, "1/s", "strain rate from which on C counts"});
  visitor.number("softening", p.softening, {positive, "", "m of the temperature", need});
  visitor.number("melting", p.melting, {positive, "K", "temperature without strength", need});
  visitor.number("reference_temperature", p.reference_temperature,
                 {positive, "K", "temperature from which on it softens"});
}

template <typename Visitor>
void visit_steinberg_guinan(Visitor& visitor, SteinbergGuinanParameters& p, Need need) {
  visitor.number("yield", p.yield, {positive, "Pa", "Y0", need});
  visitor.number("hardening", p.hardening, {not_negative, "", "beta", need});
  visitor.number("exponent", p.exponent, {exponent_range, "", "n of the plastic strain", need});
  visitor.number("initial_strain", p.initial_strain, {not_negative, "", "plastic strain before"});
  visitor.number("limit", p.limit, {positive, "Pa", "Ymax, at no pressure", need});
  visitor.number("pressure_rise", p.pressure_rise,
                 {not_negative, "1/Pa", "A, relative rise of the shear modulus", need});
  visitor.number("temperature_fall", p.temperature_fall,
                 {not_negative, "1/K", "B, relative fall of the shear modulus", need});
  visitor.number("reference_temperature", p.reference_temperature,
                 {positive, "K", "temperature of Y0"});
}

/// The yield stress by one of the strength models.
template <typename Visitor>
void visit_strength(Visitor& visitor, MaterialParameters& material, bool known) {
  const Names<StrengthModel> models{{"linear", StrengthModel::linear},
                                    {"johnson_cook", StrengthModel::johnson_cook},
                                    {"steinberg_guinan", StrengthModel::steinberg_guinan}};
  const Names<PlasticHeat> heats{{"work", PlasticHeat::work},
                                 {"dissipation", PlasticHeat::dissipation}};
  choice(visitor, "strength", material.strength, models, {"how the yield stress changes"});
  const bool has = known && has_strength(material, material.strength);
  const Need need = has ? Need::optional : Need::required;
  if (material.strength == StrengthModel::johnson_cook) {
    visitor.table("johnson_cook",
                  {"(A + B ep^n) (1 + C ln(rate/reference_rate)) (1 - T*^m), T* = 1 at melting."},
                  [&](auto& inner) { visit_johnson_cook(inner, material.johnson_cook, need); });
    return;
  }
  if (material.strength == StrengthModel::steinberg_guinan) {
    visitor.table(
        "steinberg_guinan",
        {"min(Y0 (1 + beta ep)^n, Ymax) (1 + A P/(rho/rho0)^(1/3) - B (T - reference))."},
        [&](auto& inner) { visit_steinberg_guinan(inner, material.steinberg_guinan, need); });
    return;
  }
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
  visitor.number("spall", material.spall, {not_negative, "Pa", "tension it fails at; 0 = never"});
  visit_melting(visitor, material, known);
}

}  // namespace poreshock::scene_text
