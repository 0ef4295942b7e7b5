#include "poreshock/material/library.hpp"

#include <algorithm>

namespace poreshock {

namespace {

MaterialParameters paper_aluminium() {
  MaterialParameters m;
  m.density = 2700.0;
  m.young = 69.0e9;
  m.poisson = 0.33;
  m.yield = 120.0e6;
  m.hardening = 384.0e6;
  m.c0 = 5350.0;
  m.lambda = 1.34;
  m.gamma = 2.0;
  m.cv = 880.0;
  m.conductivity = 237.0;
  return m;
}

MaterialParameters aluminium_6061_t6() {
  MaterialParameters m;
  m.density = 2703.0;
  m.young = 73.4e9;  // G0 = 27.6 GPa
  m.poisson = 0.33;
  m.yield = 290.0e6;
  m.johnson_cook = {324.0e6, 114.0e6, 0.42, 0.002, 1.0, 1.34, 925.0, 294.0};
  m.steinberg_guinan = {290.0e6, 125.0, 0.10, 0.0, 680.0e6, 65.2e-12, 6.16e-4, 300.0};
  m.c0 = 5240.0;
  m.lambda = 1.40;
  m.gamma = 1.97;
  m.cv = 885.0;
  m.conductivity = 167.0;
  return m;
}

MaterialParameters copper() {
  MaterialParameters m;
  m.density = 8930.0;
  m.young = 127.8e9;  // G0 = 47.7 GPa
  m.poisson = 0.34;
  m.yield = 120.0e6;
  m.johnson_cook = {90.0e6, 292.0e6, 0.31, 0.025, 1.0, 1.09, 1356.0, 294.0};
  m.steinberg_guinan = {120.0e6, 36.0, 0.45, 0.0, 640.0e6, 28.3e-12, 3.77e-4, 300.0};
  m.c0 = 3940.0;
  m.lambda = 1.489;
  m.gamma = 2.02;
  m.cv = 383.0;
  m.conductivity = 401.0;
  return m;
}

MaterialParameters tungsten() {
  MaterialParameters m;
  m.density = 19300.0;
  m.young = 409.6e9;  // G0 = 160 GPa
  m.poisson = 0.28;
  m.yield = 2.2e9;
  m.steinberg_guinan = {2.2e9, 24.0, 0.19, 0.0, 4.0e9, 9.38e-12, 1.38e-4, 300.0};
  m.c0 = 4030.0;
  m.lambda = 1.237;
  m.gamma = 1.67;
  m.cv = 129.0;
  m.conductivity = 174.0;
  return m;
}

MaterialParameters pmma() {
  MaterialParameters m;
  m.density = 1186.0;
  m.young = 6.2e9;  // G0 = 2.33 GPa
  m.poisson = 0.33;
  m.yield = 420.0e6;
  m.c0 = 2598.0;
  m.lambda = 1.516;
  m.gamma = 0.97;
  m.cv = 1466.0;
  m.conductivity = 0.19;
  return m;
}

MaterialParameters hmx() {
  MaterialParameters m;
  m.density = 1900.0;
  m.young = 28.8e9;  // G0 = 12 GPa
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
      entry("paper_aluminium", paper_aluminium(),
            "aluminium of \"Temperature pattern dynamics in shocked porous materials\"",
            "the paper; c0 and lambda are those of 6061 in Marsh, LASL Shock Hugoniot Data, 1980"),
      entry("aluminium_6061_t6", aluminium_6061_t6(), "aluminium alloy 6061-T6",
            "elasticity, yield, Us-up and steinberg_guinan: Steinberg, Cochran & Guinan, J. Appl. "
            "Phys. 51 (1980) 1498, and Steinberg, LLNL UCRL-MA-106439, 1996; johnson_cook: Lesuer, "
            "Kay & LeBlanc, LLNL UCRL-JC-134118, 2001"),
      entry("copper", copper(), "copper, oxygen-free, high conductivity",
            "elasticity, yield, Us-up and steinberg_guinan: Steinberg, Cochran & Guinan 1980; "
            "Us-up also Marsh 1980; johnson_cook: Johnson & Cook, 7th Int. Symp. Ballistics, 1983"),
      entry("tungsten", tungsten(), "tungsten",
            "elasticity, yield, Us-up and steinberg_guinan: Steinberg, Cochran & Guinan 1980 and "
            "Steinberg 1996; Us-up also Marsh 1980"),
      entry("pmma", pmma(), "polymethyl methacrylate",
            "Us-up, gamma and sound speeds: Marsh 1980; yield: from the elastic limit, Barker & "
            "Hollenbach, J. Appl. Phys. 41 (1970) 4208, within 10 %"),
      entry("hmx", hmx(), "a solid like the explosive HMX, without reaction",
            "mesoscale models after Menikoff, J. Appl. Phys. 90 (2001) 1754; published c0 range "
            "from 2650 to 3070 m/s, lambda from 1.8 to 2.4 and yield from 130 to 370 MPa"),
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
  switch (model) {
    case StrengthModel::linear:
      return true;
    case StrengthModel::johnson_cook:
      return material.johnson_cook != JohnsonCookParameters{};
    case StrengthModel::steinberg_guinan:
      return material.steinberg_guinan != SteinbergGuinanParameters{};
  }
  return false;
}

}  // namespace poreshock
