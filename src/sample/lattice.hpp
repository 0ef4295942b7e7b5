#pragma once
// The regular lattice of particle sites over the whole domain. Sites are numbered with x fastest
// and the shock axis slowest; a layer is all sites of one coordinate along the shock axis.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "poreshock/sample/fill.hpp"

namespace poreshock {

/// Sites lie at ((i + 0.5) spacing, ...).
struct Lattice {
  int dimension = 2;
  std::array<std::int64_t, 3> sites{1, 1, 1};  ///< per axis; 1 along z in 2-D
  double spacing = 0.0;                        ///< m
  std::int64_t sample_layers = 0;              ///< layers whose sites lie below the sample's height

  int shock_axis() const { return dimension - 1; }
  std::int64_t layers() const { return sites[shock_axis()]; }
  /// Sites of one layer.
  std::int64_t layer_size() const { return sites[0] * (dimension == 3 ? sites[1] : 1); }
};

/// The lattice of a scene.
Lattice make_lattice(const Scene& scene);

/// Coordinate of site i along any axis, m.
inline double site_coordinate(const Lattice& lattice, std::int64_t i) {
  return (static_cast<double>(i) + 0.5) * lattice.spacing;
}

/// What fills a site: nothing, the sample, or body number owner - owner_first_body.
inline constexpr std::int32_t owner_none = -1;
inline constexpr std::int32_t owner_sample = 0;
inline constexpr std::int32_t owner_first_body = 1;

/// Owners of all sites in layers [first, last), from the sample block and its generated voids
/// alone.
std::vector<std::int32_t> sample_owners(const Scene& scene, const std::vector<Void>& voids,
                                        LatticeRange range);

/// Gives the sites of the range that lie in the disc or ball, images across periodic sides
/// included, to `owner`.
void give_ball(const Lattice& lattice, LatticeRange range, const std::array<bool, 2>& periodic,
               const Triple& center, double radius, std::int32_t owner,
               std::vector<std::int32_t>& owners);

/// Calls visit(index into the range's owners, position) for the sites of the range that lie in the
/// sample block.
template <class Visit>
void for_each_block_site(const Lattice& lattice, LatticeRange range, Visit&& visit) {
  const std::int64_t layer = lattice.layer_size();
  const auto shock = static_cast<std::size_t>(lattice.shock_axis());
  for (std::int64_t k = range.first; k < std::min(range.last, lattice.sample_layers); ++k) {
    for (std::int64_t i = 0; i < layer; ++i) {
      Triple point{};
      point[0] = site_coordinate(lattice, i % lattice.sites[0]);
      if (lattice.dimension == 3) point[1] = site_coordinate(lattice, i / lattice.sites[0]);
      point[shock] = site_coordinate(lattice, k);
      visit(static_cast<std::size_t>((k - range.first) * layer + i), point);
    }
  }
}

/// Distance from a surface below which a site lies on it, m: bodies that touch have sites there.
inline double surface_depth(const Lattice& lattice) {
  return 1e-3 * lattice.spacing;
}

/// Throws InputError that names the bodies and a site when a site of the lattice lies in two
/// bodies of different grains; one on the surface of both is no overlap. Works on the whole
/// lattice, the same on every rank.
void require_apart(const Scene& scene, const Lattice& lattice);

/// Gives the sites of the range that lie in the region to `owner`, and counts them; none is `left`,
/// and those of owners that are one piece with it are not `taken`.
RegionSites give_region(const Lattice& lattice, LatticeRange range, const Region& region,
                        std::int32_t owner, const std::vector<bool>& one_piece,
                        std::vector<std::int32_t>& owners);

}  // namespace poreshock
