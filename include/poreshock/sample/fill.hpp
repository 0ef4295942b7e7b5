#pragma once
// From a scene to particles: void placement, then a regular lattice of particles kept where there
// is solid. Everything is a pure function of the scene, the same on every rank.
// Also in place_voids.cpp, void_fraction.cpp, body_warnings.cpp, sample_warnings.cpp.

#include <mpi.h>

#include <cstdint>
#include <string>
#include <vector>

#include "poreshock/particles/particles.hpp"
#include "poreshock/scene/scene.hpp"

namespace poreshock {

/// A generated void; y (z in 3-D) is the shock axis.
struct Void {
  Triple center{};      ///< m, inside the domain; images across periodic sides are implied
  double radius = 0.0;  ///< m
};

/// A generated grain.
struct Grain {
  Triple center{};       ///< m; packed and Voronoi grains only
  double radius = 0.0;   ///< m; of a packed grain, or the weight of a Voronoi cell
  double measure = 0.0;  ///< m^2 in 2-D, m^3 in 3-D
  int material = 0;      ///< index into Scene::materials
};

/// Lattice sites of an explicit body or void.
struct RegionSites {
  std::int64_t inside = 0;  ///< in the domain
  std::int64_t taken = 0;   ///< of these, off its surface, that something filled before
  std::int64_t left = 0;    ///< that are its own when all bodies and voids have been placed
  bool operator==(const RegionSites&) const = default;
};

/// What a generated sample achieved. The voids and grains and what follows from them alone are the
/// same on every rank; counts are those of the lattice range that was filled, until total() has
/// summed them.
struct SampleReport {
  std::vector<Void> voids;
  std::vector<Grain> grains;             ///< grain i has the number first_grain_number(scene) + i
  double geometric_void_fraction = 0.0;  ///< of the sample block: see void_fraction
  double particle_void_fraction = 0.0;   ///< share of the block's lattice sites without a particle
  double least_gap = 0.0;                ///< m, least surface distance between two voids or grains
                                         ///< (images included); negative: overlap; infinite: no
                                         ///< pair
  std::int64_t lattice_sites = 0;        ///< in the sample block
  std::int64_t block_particles = 0;      ///< particles on sites of the sample block
  std::int64_t particles = 0;            ///< in all, bodies included
  std::int64_t islands = 0;              ///< floating pieces (overlapping voids)
  std::int64_t island_particles = 0;     ///< particles removed with them
  std::vector<RegionSites> bodies;       ///< of Scene::bodies, in their order
  std::vector<RegionSites> hollows;      ///< of Scene::voids
};

/// Places the voids of a random_voids sample (no voids for other kinds). Without overlap the void
/// fraction is met to rounding: the number of voids is the one that comes nearest to it, and one
/// common factor on all radii does the rest. The factor differs from 1 by at most 1/(4 N) for N
/// equal discs (1/(6 N) for balls), to first order. Overlapping voids meet it to 1e-12 in 2-D and
/// 1e-5 in 3-D, the same way. Few voids are placed by random sequential addition; where that ends,
/// soft voids are pushed apart and then moved at random. Whole voids lie inside the block, with
/// keep_out to the wall, to the top and to sides that are not periodic. Deterministic in the scene,
/// independent of the cell size. Throws InputError with the reason when the target cannot be
/// reached. Not collective.
std::vector<Void> place_voids(const Scene& scene);

/// Void fraction of the sample block taken by the voids (overlaps counted once), periodic sides
/// respected; parts outside the block do not count. Exact to rounding for discs and for balls that
/// do not overlap; overlapping balls to 1e-5. Not collective.
double void_fraction(const std::vector<Void>& voids, const Scene& scene);

/// Number of the first generated grain: one more than the largest of the bodies.
int first_grain_number(const Scene& scene);

/// A row (2-D) or plane (3-D) range of lattice sites along the shock axis, [first, last).
struct LatticeRange {
  std::int64_t first = 0;
  std::int64_t last = 0;
};

/// This rank's share when all ranks together take `layers` layers. Not collective.
LatticeRange own_layers(std::int64_t layers, MPI_Comm communicator);

/// Number of lattice layers along the shock axis: cells x particles_per_cell, or as many as a
/// higher sample needs.
std::int64_t lattice_layers(const Scene& scene);

/// Sites of one layer.
std::int64_t layer_sites(const Scene& scene);

/// Height of the sites of a layer, m.
double layer_height(const Scene& scene, std::int64_t layer);

/// Number of those whose sites lie below the height of the sample; 0 without one.
std::int64_t sample_layers(const Scene& scene);

/// Replaces `particles` by those whose lattice layer lies in `range`, in lattice order. Sites lie
/// at
/// ((i + 0.5) cell / particles_per_cell); a site belongs to the last body that contains it, else to
/// the generated grain, or the sample block unless a generated void contains it; explicit voids
/// empty it. Sets id (lattice
/// index, x fastest), position, velocity (loading, frame, body, spin), mass, density rho0, grain
/// and material, the APIC gradient of a body's spin, and all else zero. `report` counts this range:
/// see total(). Work grows with the sites of the range and the number of voids; only images, and
/// overlapping voids, whose floating islands are removed, need all of the sample, which the ranks
/// of `communicator` share: alone with MPI_COMM_SELF, else collective. Throws InputError as
/// place_voids does, when grains cannot be made, and when two bodies of different grains overlap.
template <int Dim>
void fill(const Scene& scene, LatticeRange range, MPI_Comm communicator, Particles<Dim>& particles,
          SampleReport& report);

/// The particles of a range of layers again, of a sample that fill() has placed: of one block,
/// random voids that do not overlap, or packed grains, without bodies. Not collective.
template <int Dim>
void fill_layers(const Scene& scene, const SampleReport& placed, LatticeRange range,
                 Particles<Dim>& particles);

/// The report of the whole sample from the reports of all ranks' ranges. Throws InputError on every
/// rank when the scene makes no particle at all. Collective.
SampleReport total(const SampleReport& report, MPI_Comm communicator);

/// Plain sentences about bodies and voids that can hardly be meant: outside of the domain, cut by
/// it, without a particle, in the place of others, self-crossing, or of one grain and different
/// velocities. `report` is that of the whole sample. Not collective.
std::vector<std::string> body_warnings(const Scene& scene, const SampleReport& report);

/// Plain sentences about what a sample leaves unresolved: voids of few cells, thin ligaments, radii
/// that differ from those asked for, removed islands. `report` is that of the whole sample. Not
/// collective.
std::vector<std::string> sample_warnings(const Scene& scene, const SampleReport& report);

}  // namespace poreshock
