#include "lattice.hpp"

#include "poreshock/core/error.hpp"
#include "poreshock/sample/bodies.hpp"
#include "text.hpp"

namespace poreshock {
namespace {

/// Site numbers along one axis that may lie in [low, high]; on a periodic axis not yet wrapped.
struct SiteRange {
  std::int64_t first = 0;
  std::int64_t last = -1;
};

SiteRange site_range(const Lattice& lattice, double low, double high, double least, double most) {
  // One site more on each side: the caller tests every site anyway.
  const double first = std::max(std::floor(low / lattice.spacing - 0.5), least);
  const double last = std::min(std::ceil(high / lattice.spacing - 0.5), most);
  if (!(first <= last)) return {};
  return {static_cast<std::int64_t>(first), static_cast<std::int64_t>(last)};
}

/// Calls visit(index into the range's owners, position) for all sites of the range in the box, and
/// for a few around it. Positions run on across periodic sides, sites are wrapped.
template <class Visit>
void for_each_site(const Lattice& lattice, LatticeRange range, const Triple& low,
                   const Triple& high, const std::array<bool, 2>& periodic, Visit&& visit) {
  std::array<SiteRange, 3> box{SiteRange{0, 0}, SiteRange{0, 0}, SiteRange{0, 0}};
  for (int axis = 0; axis < lattice.dimension; ++axis) {
    double least = 0.0;
    double most = static_cast<double>(lattice.sites[axis] - 1);
    if (axis == lattice.shock_axis()) {
      least = static_cast<double>(range.first);
      most = static_cast<double>(range.last - 1);
    } else if (periodic[static_cast<std::size_t>(axis)]) {
      least = static_cast<double>(-lattice.sites[axis]);
      most = static_cast<double>(2 * lattice.sites[axis] - 1);
    }
    box[axis] = site_range(lattice, low[axis], high[axis], least, most);
  }
  Triple position{};
  for (std::int64_t k = box[2].first; k <= box[2].last; ++k) {
    if (lattice.dimension == 3) position[2] = site_coordinate(lattice, k);
    for (std::int64_t j = box[1].first; j <= box[1].last; ++j) {
      position[1] = site_coordinate(lattice, j);
      const std::int64_t row =
          lattice.dimension == 2
              ? j - range.first
              : (k - range.first) * lattice.sites[1] + (j + lattice.sites[1]) % lattice.sites[1];
      for (std::int64_t i = box[0].first; i <= box[0].last; ++i) {
        position[0] = site_coordinate(lattice, i);
        visit(static_cast<std::size_t>(row * lattice.sites[0] +
                                       (i + lattice.sites[0]) % lattice.sites[0]),
              position);
      }
    }
  }
}

}  // namespace

Lattice make_lattice(const Scene& scene) {
  Lattice lattice;
  lattice.dimension = scene.dimension;
  const int per_cell = scene.sample.particles_per_cell;
  lattice.spacing = scene.domain.cell / static_cast<double>(per_cell);
  for (int axis = 0; axis < scene.dimension; ++axis) {
    lattice.sites[axis] = static_cast<std::int64_t>(scene.domain.cells[axis]) * per_cell;
  }
  if (scene.sample.kind != SampleKind::none) {
    std::int64_t& layers = lattice.sites[lattice.shock_axis()];
    layers = std::max(layers,
                      static_cast<std::int64_t>(std::ceil(scene.sample.height / lattice.spacing)));
    const auto below = [&](std::int64_t k) {
      return site_coordinate(lattice, k) < scene.sample.height;
    };
    std::int64_t& n = lattice.sample_layers;
    n = std::clamp(static_cast<std::int64_t>(scene.sample.height / lattice.spacing),
                   std::int64_t{0}, lattice.layers());
    while (n > 0 && !below(n - 1)) --n;
    while (n < lattice.layers() && below(n)) ++n;
  }
  return lattice;
}

std::int64_t layer_sites(const Scene& scene) {
  return make_lattice(scene).layer_size();
}

double layer_height(const Scene& scene, std::int64_t layer) {
  return site_coordinate(make_lattice(scene), layer);
}

std::int64_t lattice_layers(const Scene& scene) {
  return make_lattice(scene).layers();
}

std::int64_t sample_layers(const Scene& scene) {
  return make_lattice(scene).sample_layers;
}

std::vector<std::int32_t> sample_owners(const Scene& scene, const std::vector<Void>& voids,
                                        LatticeRange range) {
  const Lattice lattice = make_lattice(scene);
  const std::int64_t layers = std::max(range.last - range.first, std::int64_t{0});
  std::vector<std::int32_t> owners(static_cast<std::size_t>(layers * lattice.layer_size()),
                                   owner_none);
  const std::int64_t filled =
      std::clamp(lattice.sample_layers - range.first, std::int64_t{0}, layers);
  // Grains and images take their own sites of an empty block.
  if (!makes_grains(scene.sample) && scene.sample.kind != SampleKind::image) {
    std::fill_n(owners.begin(), filled * lattice.layer_size(), owner_sample);
  }
  for (const Void& v : voids) {
    give_ball(lattice, range, scene.domain.periodic, v.center, v.radius, owner_none, owners);
  }
  return owners;
}

void give_ball(const Lattice& lattice, LatticeRange range, const std::array<bool, 2>& periodic,
               const Triple& center, double radius, std::int32_t owner,
               std::vector<std::int32_t>& owners) {
  const Region region{.center = center, .radius = radius, .points = {}};
  const Box box = bounding_box(region);
  for_each_site(lattice, range, box.low, box.high, periodic,
                [&](std::size_t site, const Triple& position) {
                  if (contains(region, position, lattice.dimension)) owners[site] = owner;
                });
}

RegionSites give_region(const Lattice& lattice, LatticeRange range, const Region& region,
                        std::int32_t owner, const std::vector<bool>& one_piece,
                        std::vector<std::int32_t>& owners) {
  const Box box = bounding_box(region);
  const double depth = surface_depth(lattice);
  RegionSites sites;
  for_each_site(lattice, range, box.low, box.high, {false, false},
                [&](std::size_t site, const Triple& position) {
                  if (!contains(region, position, lattice.dimension)) return;
                  ++sites.inside;
                  const auto before = static_cast<std::size_t>(owners[site]);
                  const bool other = owners[site] != owner_none &&
                                     !(before < one_piece.size() && one_piece[before]);
                  if (other && lies_within(region, position, depth, lattice.dimension)) {
                    ++sites.taken;
                  }
                  owners[site] = owner;
                });
  return sites;
}

namespace {

[[noreturn]] void throw_overlap(const Scene& scene, std::size_t a, std::size_t b,
                                const Triple& position) {
  const auto body = [&](std::size_t i) {
    return "body." + std::to_string(i) + " (grain " + std::to_string(scene.bodies[i].grain) + ")";
  };
  std::string place = length_text(position[0]) + ", " + length_text(position[1]);
  if (scene.dimension == 3) place += ", " + length_text(position[2]);
  throw InputError(body(a) + " and " + body(b) + " overlap, for example at (" + place +
                   "). Allowed are bodies of different grains that at most touch. Move "
                   "one, or give both the same grain to make them one piece.");
}

}  // namespace

void require_apart(const Scene& scene, const Lattice& lattice) {
  const double depth = surface_depth(lattice);
  const int dimension = scene.dimension;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Box box_b = bounding_box(scene.bodies[b].region);
    for (std::size_t a = 0; a < b; ++a) {
      if (scene.bodies[a].grain == scene.bodies[b].grain) continue;
      Box both = bounding_box(scene.bodies[a].region);
      bool apart = false;
      for (int axis = 0; axis < scene.dimension; ++axis) {
        both.low[axis] = std::max(both.low[axis], box_b.low[axis]);
        both.high[axis] = std::min(both.high[axis], box_b.high[axis]);
        apart = apart || both.low[axis] > both.high[axis];
      }
      if (apart) continue;
      const LatticeRange all{0, lattice.layers()};
      for_each_site(lattice, all, both.low, both.high, {false, false},
                    [&](std::size_t, const Triple& position) {
                      const Region& one = scene.bodies[a].region;
                      const Region& other = scene.bodies[b].region;
                      const bool overlap = (lies_within(one, position, depth, dimension) &&
                                            lies_within(other, position, -depth, dimension)) ||
                                           (lies_within(one, position, -depth, dimension) &&
                                            lies_within(other, position, depth, dimension));
                      if (overlap) {
                        throw_overlap(scene, a, b, position);
                      }
                    });
    }
  }
}

}  // namespace poreshock
