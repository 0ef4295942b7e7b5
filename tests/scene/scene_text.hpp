#pragma once
// Scenes as text for the tests, and the problems of a scene as text.

#include <string>
#include <vector>

#include "poreshock/core/error.hpp"
#include "poreshock/scene/read_scene.hpp"

namespace poreshock {

/// A complete small scene in 2-D without its [domain] table, which takes `domain_lines` instead;
/// the given lines begin at line 2, `more` follows after the last line.
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

/// What a user reads about a scene called s.toml; empty when it is good.
inline std::string problems(const std::string& text,
                            const std::vector<std::string>& overrides = {}) {
  try {
    parse_scene(text, "s.toml", overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// The same about a small good scene after one override.
inline std::string override_problems(const std::string& change) {
  return problems(small_scene(), {change});
}

/// Nearly every key in 2-D.
inline const std::string rich_2d = R"(
title = "a \"quoted\" \\ title	with a tab"
thermal = "paper"
[domain]
size = [1e-4, 3e-4]
cell = 1e-5
[boundary]
low = { kind = "wall", velocity = -12.3456789012345678 }
high = { kind = "wall", velocity = -12.3456789012345678 }
lateral = "symmetry"
[[material]]
name = "aluminium"
density = 2700
young = 69e9
poisson = 0.33
yield = 120e6
hardening = 384e6
kinematic_share = 0.1
plastic_heat = "dissipation"
c0 = 5350
lambda = 1.34
gamma = 2.0
cv = 880
conductivity = 237
T0 = 293.15
spall = 1e9
[[material]]
name = "water"
density = 1000
young = 0
poisson = 0
yield = 0
c0 = 1480
lambda = 1.75
gamma = 0.5
cv = 4186
[sample]
kind = "random_voids"
material = "water"
height = 1.9e-4
porosity = 0.123456789
void_radius = 7e-6
void_spread = 0.3
ligament = 1e-6
keep_out = 2e-6
seed = 9223372036854775807
particles_per_cell = 3
[[body]]
shape = "disc"
center = [5e-5, 2.5e-4]
radius = 2e-5
material = "water"
grain = 3
velocity = [1, -2]
spin = 1e5
[[body]]
shape = "polygon"
points = [[0, 2e-4], [1e-5, 2e-4], [0, 2.1e-4]]
[[body]]
shape = "ring"
center = [5e-5, 2.5e-4]
inner = 2.1e-5
outer = 2.2e-5
[[void]]
shape = "box"
low = [0, 0]
high = [1e-5, 1e-5]
[loading]
velocity = 1100
frame = [0.1, 0.3]
[body_force]
acceleration = [0, -9.81]
[transfer]
shape = "quadratic"
velocity = "flip"
damping = 0.3
[viscosity]
limited = false
linear = 0.4
quadratic = 1.5
[conduction]
on = true
[time]
end = 1e-7
cfl = 0.3
max_steps = 1000000000000
[output]
beat = 1e-9
snapshot = 1e-8
history = 3e-9
fields = ["stress", "id"]
precision = "single"
[morphology]
every = 2e-9
pixel = 5e-6
fields = ["pressure", "temperature"]
thresholds = { temperature = { from = 310, to = 320, step = 0.1 }, pressure = [-1e9, 0, 1e9] }
domains = true
hot_spots = { temperature = [400, 500] }
[profile]
every = 6e-9
[checkpoint]
every_steps = 5
every_time = 4e-9
every_wall = 600
keep = 7
)";

/// Everything that differs in 3-D.
inline const std::string rich_3d = R"(
[domain]
size = [1e-4, 8e-5, 3e-4]
cell = 1e-5
periodic = [true, false]
[boundary]
low = "symmetry"
lateral = ["periodic", "wall"]
[[material]]
name = "aluminium"
density = 2700
young = 69e9
poisson = 0.33
yield = 120e6
c0 = 5350
lambda = 1.34
gamma = 2.0
cv = 880
[[body]]
shape = "ball"
center = [5e-5, 4e-5, 1e-4]
radius = 3e-5
velocity = [1, 2, 3]
spin = [4, 5, 6]
[[body]]
shape = "box"
low = [0, 0, 2e-4]
high = [1e-5, 1e-5, 2.5e-4]
[[void]]
shape = "shell"
center = [5e-5, 4e-5, 1e-4]
inner = 1e-5
outer = 2e-5
[loading]
frame = [1, 2, 3]
[time]
end = 1e-7
)";

}  // namespace poreshock
