#include "poreshock/material/library.hpp"

#include <algorithm>

namespace poreshock {

namespace {

// Where each constant comes from. "1996" is Steinberg, Equation of state and strength properties of
// selected materials, LLNL UCRL-MA-106439, change 1. Compared with independent transcriptions of
// the sources; what could not be compared is marked "unchecked": take it from the source named
// before anything hangs on it. Steinberg's heat capacities, taken as cv, are at constant pressure:
// 3 to 5 % more. Conductivities are handbook values at room temperature.

// Of pure aluminium: Dinsdale, SGTE data for pure elements, CALPHAD 15 (1991) 317. Its latent heat
// is that of his Gibbs energies, G_liquid - G_solid = 11005.029 - 11.841867 T + 7.934e-20 T^7:
// 10711 J/mol. The melt curve is Lindemann's, from the material's own gamma.
constexpr MeltParameters aluminium_melt{933.47, 397.0e3, 0.0, 0.0};

MaterialParameters paper_aluminium() {
  MaterialParameters m;
  m.density = 2700.0;
  m.young = 69.0e9;
  m.poisson = 0.33;
  m.yield = 120.0e6;
  m.hardening = 384.0e6;
  m.c0 = 5350.0;    // this and the next two: 6061 in Meyers, Dynamic behavior of materials, 1994,
  m.lambda = 1.34;  // from Marsh, pp. 181-182
  m.gamma = 2.0;
  m.cv = 880.0;
  m.melt = aluminium_melt;
  m.conductivity = 237.0;
  return m;
}

MaterialParameters aluminium_6061_t6() {
  MaterialParameters m;
  m.density = 2703.0;  // 1996, as all that has no other source
  m.young = 73.4e9;    // G0 = 27.6 GPa
  m.poisson = 0.33;    // handbook
  m.yield = 290.0e6;
  // Lesuer, Kay & LeBlanc 2001, table 1; melting: lower than the 933.6 K of pure aluminium that
  // others put there, unchecked.
  m.johnson_cook = {324.0e6, 114.0e6, 0.42, 0.002, 1.0, 1.34, 925.0, 294.0};
  m.steinberg_guinan = {290.0e6, 125.0, 0.10, 0.0, 680.0e6, 65.2e-12, 6.16e-4, 300.0};
  m.c0 = 5240.0;
  m.lambda = 1.40;
  m.gamma = 1.97;
  m.cv = 885.0;
  m.melt = aluminium_melt;
  m.conductivity = 167.0;
  return m;
}

MaterialParameters copper() {
  MaterialParameters m;
  m.density = 8930.0;  // 1996, half hard, as all that has no other source
  m.young = 127.8e9;   // G0 = 47.7 GPa
  m.poisson = 0.34;    // handbook
  m.yield = 120.0e6;
  // Johnson & Cook 1983, annealed.
  m.johnson_cook = {90.0e6, 292.0e6, 0.31, 0.025, 1.0, 1.09, 1356.0, 294.0};
  m.steinberg_guinan = {120.0e6, 36.0, 0.45, 0.0, 640.0e6, 28.3e-12, 3.77e-4, 300.0};
  m.c0 = 3940.0;
  m.lambda = 1.489;
  m.gamma = 2.02;
  m.cv = 383.0;
  // Pure copper, Dinsdale 1991: 12964.735 - 9.511904 T - 5.8489e-21 T^7, so 13263 J/mol.
  m.melt = {1357.77, 208.7e3};
  m.conductivity = 401.0;
  return m;
}

MaterialParameters tungsten() {
  MaterialParameters m;
  m.density = 19300.0;  // 1996
  m.young = 409.6e9;    // G0 = 160 GPa, 1996, unchecked
  m.poisson = 0.28;     // handbook
  m.yield = 2.2e9;      // 1996, unchecked
  // 1996; all but the limit unchecked. The alloy with 3.5 % Ni and 1.5 % Fe has G0 = 145 GPa, 1.87
  // GPa, 7.7, 0.13, 4.0 GPa, 10.3e-12/Pa and 1.52e-4/K there.
  m.steinberg_guinan = {2.2e9, 24.0, 0.19, 0.0, 4.0e9, 9.38e-12, 1.38e-4, 300.0};
  m.c0 = 4030.0;  // this and the next two: 1996, the same for the alloy; McQueen et al. 1970 have
  m.lambda = 1.237;  // 4029 m/s, 1.237 and gamma 1.54
  m.gamma = 1.67;
  m.cv = 129.0;  // 1996
  m.conductivity = 174.0;
  return m;
}

MaterialParameters magnesium_az31b() {
  MaterialParameters m;
  m.density = 1780.0;  // 1996, as all that has no other source
  m.young = 43.0e9;    // G0 = 16.5 GPa
  m.poisson = 0.303;   // that of this G0 and the bulk modulus density x c0^2
  m.yield = 190.0e6;
  m.steinberg_guinan = {190.0e6, 1100.0, 0.12, 0.0, 480.0e6, 103.0e-12, 5.09e-4, 300.0};
  m.c0 = 4520.0;
  m.lambda = 1.242;
  m.gamma = 1.54;
  m.cv = 999.0;
  m.conductivity = 156.0;  // pure magnesium; unchecked
  return m;
}

MaterialParameters steel_304() {
  MaterialParameters m;
  m.density = 7896.0;  // McQueen et al. 1970, as all that has no other source
  m.young = 199.9e9;   // G0 = 77 GPa, 1996
  m.poisson = 0.298;   // that of this G0 and the bulk modulus density x c0^2
  m.yield = 340.0e6;   // 1996
  m.steinberg_guinan = {340.0e6, 43.0, 0.35, 0.0, 2.5e9, 26.0e-12, 4.5e-4, 300.0};  // 1996
  m.c0 = 4569.0;
  m.lambda = 1.490;
  m.gamma = 2.17;
  m.cv = 441.3;
  m.conductivity = 16.3;
  return m;
}

MaterialParameters pmma() {
  MaterialParameters m;
  m.density = 1186.0;  // Marsh
  m.young = 6.2e9;     // G0 = 2.33 GPa, density x (1401 m/s)^2, Marsh, unchecked
  m.poisson = 0.33;
  m.yield = 420.0e6;  // Barker & Hollenbach, within 10 %, unchecked
  m.c0 = 2598.0;      // Marsh, unchecked; McQueen et al. 1970 have 2572 m/s and 1.536: the same
  m.lambda = 1.516;   // shock speeds within 1 % up to 3 km/s
  m.gamma = 0.97;     // McQueen et al. 1970
  m.cv = 1466.0;      // they have 1469
  m.conductivity = 0.19;
  return m;
}

MaterialParameters hmx() {
  MaterialParameters m;
  m.density = 1900.0;  // this and gamma: Benson & Conley, Modelling Simul. Mater. Sci. Eng. 7
                       // (1999) 333, who take G0 = 10 GPa and yield = 600 MPa
  m.young = 28.8e9;    // G0 = 12 GPa, Menikoff, unchecked, as all that follows
  m.poisson = 0.20;
  m.yield = 370.0e6;
  m.c0 = 2650.0;
  m.lambda = 2.38;
  m.gamma = 1.1;
  m.cv = 1500.0;
  m.conductivity = 0.5;
  return m;
}

LibraryMaterial entry(const char* name, MaterialParameters parameters, const char* about,
                      const char* source) {
  parameters.name = name;
  return {std::move(parameters), about, source};
}

}  // namespace

const std::vector<LibraryMaterial>& material_library() {
  static const std::vector<LibraryMaterial> library = {
      entry(
          "paper_aluminium", paper_aluminium(),
          "aluminium of \"Temperature pattern dynamics in shocked porous materials\"",
          "the paper; c0, lambda and gamma are those of 6061: Marsh, LASL Shock Hugoniot Data, "
          "1980, in Meyers, Dynamic Behavior of Materials, 1994. Checked. Melt: Dinsdale, CALPHAD "
          "15 (1991) 317, pure aluminium, checked"),
      entry("aluminium_6061_t6", aluminium_6061_t6(), "aluminium alloy 6061-T6",
            "Steinberg, LLNL UCRL-MA-106439, change 1, 1996 (shear modulus, yield, Us-up, gamma, "
            "cv, steinberg_guinan); Lesuer, Kay & LeBlanc, LLNL UCRL-JC-134118, 2001 "
            "(johnson_cook). Checked but for the melting temperature of johnson_cook. Melt: "
            "Dinsdale, CALPHAD 15 (1991) 317, pure aluminium, checked"),
      entry("copper", copper(), "copper, oxygen-free, high conductivity",
            "Steinberg 1996 (shear modulus, yield, Us-up, gamma, cv, steinberg_guinan, half "
            "hard); Johnson & Cook, 7th Int. Symp. Ballistics, 1983 (johnson_cook, annealed). "
            "Checked. Melt: Dinsdale, CALPHAD 15 (1991) 317, checked"),
      entry("tungsten", tungsten(), "tungsten",
            "Steinberg 1996. Checked: density, Us-up, gamma, cv and the limit of the flow stress; "
            "not checked: shear modulus, yield and the rest of steinberg_guinan"),
      entry("magnesium_az31b", magnesium_az31b(), "magnesium alloy AZ31B-H24",
            "Steinberg 1996 (density, shear modulus, yield, Us-up, gamma, cv, steinberg_guinan). "
            "Checked against one transcription, whose copper is that of others; conductivity not "
            "checked"),
      entry(
          "steel_304", steel_304(), "stainless steel 304",
          "McQueen et al. in Kinslow, High-Velocity Impact Phenomena, 1970 (density, Us-up, gamma, "
          "cv); Steinberg 1996 (shear modulus, yield, steinberg_guinan). Each checked against one "
          "transcription, of which the first has the tungsten and PMMA of others"),
      entry("pmma", pmma(), "polymethyl methacrylate",
            "Marsh 1980 (density, Us-up, sound speeds; not checked, but within 1 % of McQueen et "
            "al. in Kinslow, High-Velocity Impact Phenomena, 1970); McQueen et al. 1970 (gamma, "
            "cv; checked); yield from the elastic limit, Barker & Hollenbach, J. Appl. Phys. 41 "
            "(1970) 4208, within 10 %, not checked"),
      entry("hmx", hmx(), "a solid like the explosive HMX, without reaction",
            "mesoscale models after Menikoff, J. Appl. Phys. 90 (2001) 1754, not checked; density "
            "and gamma also Benson & Conley, Modelling Simul. Mater. Sci. Eng. 7 (1999) 333. "
            "Published c0 range from 2650 to 3070 m/s, lambda from 1.8 to 2.4, shear modulus from "
            "10 to 12 GPa and yield from 130 to 600 MPa"),
  };
  return library;
}

const LibraryMaterial* library_material(std::string_view name) {
  const auto& all = material_library();
  const auto found = std::find_if(
      all.begin(), all.end(), [&](const LibraryMaterial& m) { return m.parameters.name == name; });
  return found == all.end() ? nullptr : &*found;
}

bool has_strength(const MaterialParameters& material, StrengthModel model) {
  bool has = model == StrengthModel::linear;
  for_each_flow_law(material, [&]<class Law>(StrengthModel law, const Law& parameters) {
    if (law == model) has = parameters != Law{};
  });
  return has;
}

}  // namespace poreshock
