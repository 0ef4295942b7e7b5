#pragma once
// Scenes as text for the tests.

#include <string>

/// A complete small scene in 2-D without its [domain] table, which takes `domain_lines` instead; the
/// given lines begin at line 2, `more` follows after the last line.
inline std::string scene_with(const std::string& domain_lines, const std::string& more = "") {
  return "[domain]\n" + domain_lines +
         "[[material]]\n"
         "name = \"aluminium\"\n"
         "density = 2700\n"
         "young = 69e9\n"
         "poisson = 0.33\n"
         "yield = 120e6\n"
         "c0 = 5350\n"
         "lambda = 1.34\n"
         "gamma = 2.0\n"
         "cv = 880\n"
         "[sample]\n"
         "kind = \"solid\"\n"
         "[time]\n"
         "end = 1e-7\n" +
         more;
}

/// The lines of a [domain] of 10 x 20 cells; two lines.
inline const std::string good_domain = "size = [1e-4, 2e-4]\ncell = 1e-5\n";

/// A complete small scene; `more` begins at line 18.
inline std::string small_scene(const std::string& more = "") {
  return scene_with(good_domain, more);
}
