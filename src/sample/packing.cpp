#include "packing.hpp"

#include <algorithm>
#include <cmath>

#include "cell_list.hpp"
#include "random.hpp"

namespace poreshock {

double largest_contact(const Packing& packing) {
  double largest = 0.0;
  for (const Void& v : packing.voids) largest = std::max(largest, v.radius);
  return 2.0 * largest + packing.ligament;
}

double crowding(const Packing& packing) {
  double taken = 0.0;
  for (const Void& v : packing.voids) {
    taken += ball_measure(v.radius + 0.5 * packing.ligament, packing.block.dimension);
  }
  double open = 1.0;
  for (int axis = 0; axis < packing.block.dimension; ++axis) {
    // The half ligament around a void may reach into the keep-out layer.
    const double lost =
        packing.block.periodic[axis] ? 0.0 : 2.0 * packing.keep_out - packing.ligament;
    open *= packing.block.size[axis] - lost;
  }
  return taken / open;
}

Triple random_centre(const Packing& packing, std::size_t index, std::uint32_t draw) {
  const std::array<double, 4> u = uniforms(packing.seed, RandomStream::position, index, draw);
  Triple centre{};
  for (int axis = 0; axis < packing.block.dimension; ++axis) {
    const AxisRange range =
        centre_range(packing.block, packing.keep_out, packing.voids[index].radius, axis);
    centre[axis] = range.low + u[axis] * (range.high - range.low);
  }
  return centre;
}

bool add_in_sequence(Packing& packing) {
  std::vector<Void>& voids = packing.voids;
  CellList cells = make_cell_list(packing.block, largest_contact(packing), voids.size());
  std::size_t trials_left = 200 * voids.size() + 10000;
  bool all_free = true;
  for (std::size_t i = 0; i < voids.size(); ++i) {
    bool taken = true;
    for (std::uint32_t draw = 0; taken; ++draw) {
      voids[i].center = random_centre(packing, i, draw);
      if (trials_left == 0) break;
      --trials_left;
      taken = any_near(cells, voids[i].center, [&](int j) {
        const Void& other = voids[static_cast<std::size_t>(j)];
        const double contact = contact_distance(packing, voids[i], other);
        return squared_distance(packing.block, voids[i].center, other.center) < contact * contact;
      });
    }
    if (taken) all_free = false;
    insert(voids[i].center, static_cast<int>(i), cells);
  }
  return all_free;
}

double fitting_scale(const Packing& packing) {
  const Neighbours near = find_neighbours(packing, 1.0, 0.0);
  double scale = 1.0;
  for (std::size_t i = 0; i < packing.voids.size(); ++i) {
    const Void& a = packing.voids[i];
    for (std::size_t n = near.start[i]; n < near.start[i + 1]; ++n) {
      const Void& b = packing.voids[static_cast<std::size_t>(near.item[n])];
      const double distance = std::sqrt(squared_distance(packing.block, a.center, b.center));
      scale = std::min(scale, (distance - packing.ligament) / (a.radius + b.radius));
    }
  }
  return std::max(scale, 0.0);
}

Neighbours find_neighbours(const Packing& packing, double stretch, double skin) {
  const std::vector<Void>& voids = packing.voids;
  CellList cells =
      make_cell_list(packing.block, stretch * largest_contact(packing) + skin, voids.size());
  Neighbours result;
  result.skin = skin;
  result.start.push_back(0);
  for (std::size_t i = 0; i < voids.size(); ++i) {
    result.reference.push_back(voids[i].center);
    insert(voids[i].center, static_cast<int>(i), cells);
  }
  for (std::size_t i = 0; i < voids.size(); ++i) {
    any_near(cells, voids[i].center, [&](int j) {
      const Void& other = voids[static_cast<std::size_t>(j)];
      const double reach = stretch * contact_distance(packing, voids[i], other) + skin;
      const bool near =
          static_cast<std::size_t>(j) != i &&
          squared_distance(packing.block, voids[i].center, other.center) < reach * reach;
      if (near) result.item.push_back(j);
      return false;
    });
    result.start.push_back(result.item.size());
  }
  return result;
}

}  // namespace poreshock
