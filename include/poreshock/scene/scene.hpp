#pragma once
// A scene: everything a run is told, as plain data in SI units. Read and checked in read_scene.
// Arrays of three hold x, y(, z); in 2-D the third entry is unused. The shock axis is the last one.

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "poreshock/material/material.hpp"
#include "poreshock/scene/sides.hpp"
#include "poreshock/scene/transfer_scheme.hpp"

namespace poreshock {

using Triple = std::array<double, 3>;

enum class SampleKind { none, solid, random_voids, packed_grains, voronoi_grains, image };
enum class Islands { removed, grains };  ///< what becomes of floating pieces
enum class Regions { grains, matrix };   ///< what the connected regions of an image are
enum class GapTest { volume, none };
enum class ContactNormal { gradients, regression };
enum class PorosityDefinition { void_fraction, distension_minus_1 };
enum class BodyShape { disc, box, ring, polygon };  // ball, box, shell in 3-D
enum class MapLattice { eulerian, lagrangian };
enum class MapVoids { black, white, fill, exclude };
enum class BoundaryLength { pixels, isoline };
enum class Precision { double_precision, single_precision };
enum class ProbeKind { point, particle, surface, interface };
enum class Facing { up, down };
enum class Cadence { step, beat };
enum class Follow { nothing, front };

/// The block of background cells.
struct Domain {
  Triple size{};                   ///< m, whole multiples of cell
  double cell = 0.0;               ///< m
  std::array<int, 3> cells{};      ///< derived: size / cell
  std::array<bool, 2> periodic{};  ///< per lateral axis (x; x and y in 3-D)
  bool operator==(const Domain&) const = default;
};

/// A closed region of space. 2-D: disc, box, ring, polygon; 3-D: disc is a ball, ring a shell.
struct Region {
  BodyShape shape = BodyShape::disc;
  Triple center{};             ///< m: disc, ring
  double radius = 0.0;         ///< m: disc; outer radius of a ring
  double inner_radius = 0.0;   ///< m: ring
  Triple low{}, high{};        ///< m: box corners
  std::vector<Triple> points;  ///< m: polygon corners in order (2-D only)
  bool operator==(const Region&) const = default;
};

/// A piece of material placed explicitly.
struct Body {
  Region region;
  int material = 0;  ///< index into Scene::materials
  int grain = 0;
  Triple velocity{};  ///< m/s, added to the loading velocity
  Triple spin{};      ///< rad/s about the region's centroid; 2-D uses z only
  bool operator==(const Body&) const = default;
};

/// A material of generated grains.
struct MixturePart {
  int material = 0;       ///< index into Scene::materials
  double fraction = 0.0;  ///< share of the volume of all grains; the shares of a mixture sum to 1
  bool operator==(const MixturePart&) const = default;
};

/// A generated block of material from the low wall up to `height`, over the whole width.
struct Sample {
  SampleKind kind = SampleKind::none;
  int material = 0;       ///< index into Scene::materials
  double height = 0.0;    ///< m; above the domain only where that follows the front
  double porosity = 0.0;  ///< target void fraction (after porosity_definition is applied)
  PorosityDefinition porosity_definition = PorosityDefinition::void_fraction;
  double void_radius = 0.0;  ///< m, median radius
  double void_spread = 0.0;  ///< standard deviation of ln(radius); 0 = equal
  double ligament = 0.0;     ///< m, least solid between two voids (not with overlap)
  double keep_out = 0.0;     ///< m, least solid between a void and the wall or the top
  bool overlap = false;
  Islands islands = Islands::removed;  ///< floating pieces between overlapping voids
  double grain_radius = 0.0;           ///< m, median radius; of Voronoi grains: of the equal disc
  double grain_spread = 0.0;           ///< standard deviation of ln(radius); 0 = equal
  double grain_gap = 0.0;              ///< m, least gap between two packed grains
  std::string image;                   ///< path of a picture (2-D) or of a stack of slices (3-D)
  double pixel = 0.0;                  ///< m, side of a pixel or voxel of the image
  std::optional<double> threshold;     ///< grey value from which on a pixel is solid; else labels
  Regions regions = Regions::grains;   ///< of the image
  Triple raw_size{};                   ///< voxels along each axis of a raw image; 0 = not raw
  std::string raw_type = "uint8";      ///< its numbers
  bool raw_big_endian = false;
  std::int64_t raw_skip = 0;         ///< bytes before its numbers
  std::vector<MixturePart> mixture;  ///< materials of the grains; empty: `material`
  std::uint64_t seed = 1;
  int particles_per_cell = 2;  ///< per direction; also used for bodies
  bool operator==(const Sample&) const = default;
};

struct Loading {
  double velocity = 0.0;  ///< m/s towards the low wall
  Triple frame{};         ///< m/s, added to everything, walls included
  bool operator==(const Loading&) const = default;
};

struct Viscosity {
  double linear = 1.0;
  double quadratic = 5.0;
  bool limited = true;  ///< acts only where the velocity jumps; cubic splines only
  bool operator==(const Viscosity&) const = default;
};

struct Conduction {
  bool on = false;  ///< heat flows between particles
  bool operator==(const Conduction&) const = default;
};

/// Contact between grains, and of a grain with itself.
struct Contact {
  double friction = 0.0;          ///< coefficient of Coulomb friction
  GapTest gap = GapTest::volume;  ///< contact only where the grains fill the space of a node
  ContactNormal normal = ContactNormal::gradients;
  bool self = false;  ///< opposite walls of one grain meet as two grains do
  bool operator==(const Contact&) const = default;
};

struct TimeControl {
  double end = 0.0;  ///< s
  double cfl = 1.0;
  std::int64_t max_steps = 0;       ///< 0 = no limit
  bool sleep = true;                ///< rows that no wave has reached only move
  Follow follow = Follow::nothing;  ///< front: the domain is a window that moves along
  bool operator==(const TimeControl&) const = default;
};

struct Output {
  double beat = 5e-9;               ///< s; steps land on its multiples
  double snapshot = 0.0;            ///< s between snapshots, 0 = only first and last
  double history = 0.0;             ///< s between history rows, derived default: beat
  std::vector<std::string> fields;  ///< particle datasets of a snapshot; default all
  Precision precision = Precision::double_precision;
  bool operator==(const Output&) const = default;
};

struct MorphologyField {
  std::string name;  ///< temperature, pressure, density, speed, von_mises, plastic_strain,
                     ///< molten
  std::vector<double> thresholds{};  ///< in the unit of the field, ascending
  std::vector<double> hot_spots{};   ///< thresholds at which every hot domain is listed
  std::vector<double> quantiles{};   ///< instead of thresholds: shares of the material, 0 ... 1,
                                     ///< ascending, colder than each threshold
  bool operator==(const MorphologyField&) const = default;
};

struct Morphology {
  double every = 0.0;  ///< s, 0 = off
  double pixel = 0.0;  ///< m, cell times a power of two (2^-3 ... 2^3); the site if lagrangian
  std::vector<MorphologyField> fields;
  MapLattice lattice = MapLattice::eulerian;  ///< pixels in space, or sites of the initial lattice
  MapVoids voids = MapVoids::black;           ///< in the Euler characteristic
  BoundaryLength length = BoundaryLength::pixels;  ///< isoline: interpolated ones (3-D: areas) too
  bool domains = false;                            ///< count hot and cold domains at all thresholds
  bool operator==(const Morphology&) const = default;
};

/// Averages over rows of cells along the shock axis.
struct ProfileOutput {
  double every = 0.0;  ///< s, 0 = off; derived default: output.snapshot
  bool operator==(const ProfileOutput&) const = default;
};

/// A place whose motion and state are recorded as a trace.
struct Probe {
  std::string name;
  ProbeKind kind = ProbeKind::surface;
  Triple at{};  ///< m: of a point in the laboratory, of others at the start; no height of a surface
  double width = 0.0;         ///< m, of the spot that is averaged over
  Facing faces = Facing::up;  ///< surface or interface: up means that its material lies below
  Cadence every = Cadence::step;
  bool operator==(const Probe&) const = default;
};

struct Checkpoint {
  std::int64_t every_steps = 0;  ///< 0 = off
  double every_time = 0.0;       ///< s of simulated time, 0 = off
  double every_wall = 0.0;       ///< s of wall time, 0 = off
  int keep = 2;
  bool operator==(const Checkpoint&) const = default;
};

struct Scene {
  std::string title;
  int dimension = 2;
  Thermal thermal = Thermal::conserving;
  Domain domain;
  Boundary boundary;
  std::vector<MaterialParameters> materials;
  Sample sample;
  std::vector<Body> bodies;
  std::vector<Region> voids;
  Loading loading;
  Triple body_force{};  ///< m/s^2
  Transfer transfer;
  Viscosity viscosity;
  Conduction conduction;
  Contact contact;
  TimeControl time;
  Output output;
  Morphology morphology;
  ProfileOutput profile;
  std::vector<Probe> probes;
  Checkpoint checkpoint;
  bool operator==(const Scene&) const = default;
};

/// True when heat conduction is on and some material conducts.
inline bool conducts_heat(const Scene& scene) {
  return scene.conduction.on &&
         std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const MaterialParameters& m) { return m.conductivity > 0.0; });
}

/// True where the state before the first wave is one of uniform motion without stress that nothing
/// but waves from the ends changes, so that rows may sleep.
inline bool can_sleep(const Scene& scene) {
  for (const double a : scene.body_force) {
    if (a != 0.0) return false;
  }
  for (int a = 0; a + 1 < scene.dimension; ++a) {
    if (side_law(scene.boundary.lateral[a]).mirrors) return false;
  }
  for (const MaterialParameters& material : scene.materials) {
    if (scene.conduction.on && material.T0 != scene.materials.front().T0) return false;
  }
  return scene.time.sleep;
}

/// True when the domain is a window that moves with the front over a longer sample.
inline bool follows_front(const Scene& scene) {
  return scene.time.follow == Follow::front;
}

/// True for samples that are made of grains.
inline bool makes_grains(const Sample& sample) {
  return sample.kind == SampleKind::packed_grains || sample.kind == SampleKind::voronoi_grains ||
         (sample.kind == SampleKind::image && sample.regions == Regions::grains);
}

/// True when there may be several grains.
inline bool has_grains(const Scene& scene) {
  if (makes_grains(scene.sample) || scene.sample.islands == Islands::grains) return true;
  return std::any_of(scene.bodies.begin(), scene.bodies.end(), [&](const Body& body) {
    return body.grain != (scene.sample.kind == SampleKind::none ? scene.bodies.front().grain : 0);
  });
}

/// True when waves leave the sample into material behind one of its ends.
inline bool has_ends(const Scene& scene) {
  return !scene.boundary.low.behind.empty() || !scene.boundary.high.behind.empty();
}

/// True when some material melts.
inline bool can_melt(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const MaterialParameters& m) { return m.melting != MeltingLaw::none; });
}

}  // namespace poreshock
