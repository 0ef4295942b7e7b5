#include <algorithm>
#include <cmath>
#include <limits>

#include "cell_list.hpp"
#include "grains.hpp"
#include "packing.hpp"
#include "poreshock/core/error.hpp"
#include "text.hpp"

namespace poreshock {
namespace {

/// Share of the space that the discs or balls around the centres take, whose radii weight the
/// cells.
double centre_share(int dimension) {
  return dimension == 2 ? 0.6 : 0.4;
}

/// Centres with their weights, and the cells that find them.
struct Diagram {
  Block block;
  std::vector<Grain> grains;
  CellList cells;
  double cutoff = 0.0;   ///< m, within which `cells` finds everything
  double largest = 0.0;  ///< m, radius
};

Diagram make_diagram(const Block& block, const std::vector<Grain>& grains) {
  Diagram diagram{.block = block, .grains = grains, .cells = {}};
  for (const Grain& g : grains) diagram.largest = std::max(diagram.largest, g.radius);
  diagram.cutoff = 4.0 * diagram.largest;
  diagram.cells = make_cell_list(block, diagram.cutoff, grains.size());
  for (std::size_t g = 0; g < grains.size(); ++g) {
    insert(grains[g].center, static_cast<int>(g), diagram.cells);
  }
  return diagram;
}

/// A point's cell and how far inside it lies.
struct CellPlace {
  std::int32_t grain = -1;
  double depth = std::numeric_limits<double>::infinity();  ///< m, to the nearest cell face
};

/// Power of a point: squared distance less squared radius; smallest in its own cell.
struct Candidate {
  double power = 0.0;
  std::int32_t grain = -1;
  Triple towards{};  ///< m, from the point to the nearest image of the centre
};

Candidate candidate(const Diagram& diagram, const Triple& point, std::size_t g) {
  const Grain& grain = diagram.grains[g];
  const Triple d = separation(diagram.block, point, grain.center);
  const double square = (d[0] * d[0] + d[1] * d[1]) + d[2] * d[2];
  return {square - grain.radius * grain.radius, static_cast<std::int32_t>(g), d};
}

CellPlace place_among(const std::vector<Candidate>& near) {
  const Candidate* own = nullptr;
  for (const Candidate& c : near) {
    const bool nearer =
        own == nullptr || c.power < own->power || (c.power == own->power && c.grain < own->grain);
    if (nearer) own = &c;
  }
  CellPlace place;
  if (own == nullptr) return place;
  place.grain = own->grain;
  for (const Candidate& c : near) {
    if (c.grain == own->grain) continue;
    double square = 0.0;
    for (std::size_t a = 0; a < 3; ++a) {
      square += (c.towards[a] - own->towards[a]) * (c.towards[a] - own->towards[a]);
    }
    place.depth = std::min(place.depth, (c.power - own->power) / (2.0 * std::sqrt(square)));
  }
  return place;
}

CellPlace find_place(const Diagram& diagram, const Triple& point, std::vector<Candidate>& near) {
  near.clear();
  any_near(diagram.cells, point, [&](int g) {
    near.push_back(candidate(diagram, point, static_cast<std::size_t>(g)));
    return false;
  });
  const CellPlace place = place_among(near);
  // A centre beyond the cutoff has at least this power and this face distance.
  const double beyond = diagram.cutoff * diagram.cutoff - diagram.largest * diagram.largest;
  double own = std::numeric_limits<double>::infinity();
  for (const Candidate& c : near) own = std::min(own, c.power);
  const double reach =
      diagram.cutoff + std::sqrt(std::max(own + diagram.largest * diagram.largest, 0.0));
  const bool sure =
      place.grain >= 0 && own < beyond && place.depth <= (beyond - own) / (2.0 * reach);
  if (sure || near.size() == diagram.grains.size()) return place;
  near.clear();
  for (std::size_t g = 0; g < diagram.grains.size(); ++g) {
    near.push_back(candidate(diagram, point, g));
  }
  return place_among(near);
}

/// A lattice of points over the block, fine against the grains, for measuring volumes.
struct Quadrature {
  std::array<std::int64_t, 3> points{1, 1, 1};
  Triple spacing{};
};

Quadrature make_quadrature(const Block& block, std::size_t grains) {
  constexpr double most_points = 2.0e6;
  const double per_grain =
      std::clamp(most_points / static_cast<double>(grains), 64.0, block.dimension == 2 ? 2e3 : 8e3);
  const double all = per_grain * static_cast<double>(grains);
  const double spacing =
      std::pow(block_measure(block) / all, 1.0 / static_cast<double>(block.dimension));
  Quadrature q;
  for (int axis = 0; axis < block.dimension; ++axis) {
    q.points[axis] = static_cast<std::int64_t>(std::ceil(block.size[axis] / spacing));
    q.spacing[axis] = block.size[axis] / static_cast<double>(q.points[axis]);
  }
  return q;
}

template <class Visit>
void for_each_point(const Quadrature& q, Visit&& visit) {
  Triple point{};
  for (std::int64_t k = 0; k < q.points[2]; ++k) {
    point[2] = (static_cast<double>(k) + 0.5) * q.spacing[2];
    for (std::int64_t j = 0; j < q.points[1]; ++j) {
      point[1] = (static_cast<double>(j) + 0.5) * q.spacing[1];
      for (std::int64_t i = 0; i < q.points[0]; ++i) {
        point[0] = (static_cast<double>(i) + 0.5) * q.spacing[0];
        visit(point);
      }
    }
  }
}

/// The gap at which the void fraction is met, and the measures of the grains it leaves.
void find_gap(const Diagram& diagram, double porosity, GrainLayout& layout) {
  const Quadrature q = make_quadrature(diagram.block, diagram.grains.size());
  std::vector<double> depth;
  std::vector<CellPlace> places;
  std::vector<Candidate> near;
  for_each_point(q, [&](const Triple& point) {
    places.push_back(find_place(diagram, point, near));
    depth.push_back(places.back().depth);
  });
  const auto nth = static_cast<std::ptrdiff_t>(porosity * static_cast<double>(depth.size()));
  std::nth_element(depth.begin(), depth.begin() + nth, depth.end());
  const double half_gap = depth[static_cast<std::size_t>(nth)];
  const double each = block_measure(diagram.block) / static_cast<double>(places.size());
  double solid = 0.0;
  for (const CellPlace& place : places) {
    if (place.depth < half_gap) continue;
    layout.grains[static_cast<std::size_t>(place.grain)].measure += each;
    solid += 1.0;
  }
  layout.gap = 2.0 * half_gap;
  layout.void_fraction = 1.0 - solid / static_cast<double>(places.size());
}

}  // namespace

GrainLayout divide_into_grains(const Scene& scene) {
  Packing packing = grain_packing(scene, 1.0);
  const double shrink =
      std::pow(centre_share(scene.dimension), 1.0 / static_cast<double>(scene.dimension));
  for (Void& v : packing.voids) v.radius *= shrink;
  if (!add_in_sequence(packing) && !relax(packing)) {
    throw InputError("sample.grain_radius = " + length_text(scene.sample.grain_radius) +
                     ": the centres of " + std::to_string(packing.voids.size()) +
                     " Voronoi grains could not be spread over the sample block. Lower "
                     "sample.grain_radius or sample.keep_out.");
  }
  shake(packing);
  GrainLayout layout;
  for (const Void& v : packing.voids)
    layout.grains.push_back({.center = v.center, .radius = v.radius});
  find_gap(make_diagram(packing.block, layout.grains), scene.sample.porosity, layout);
  return layout;
}

void give_cells(const Scene& scene, const GrainLayout& layout, LatticeRange range,
                std::int32_t first_owner, std::vector<std::int32_t>& owners) {
  const Diagram diagram = make_diagram(sample_block(scene), layout.grains);
  std::vector<Candidate> near;
  for_each_block_site(make_lattice(scene), range, [&](std::size_t site, const Triple& point) {
    const CellPlace place = find_place(diagram, point, near);
    if (place.depth >= 0.5 * layout.gap) owners[site] = first_owner + place.grain;
  });
}

}  // namespace poreshock
