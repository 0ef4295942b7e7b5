#pragma once
// The domains of one colour in a slab while one pixel after the other turns to that colour. Private
// to the layer.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "disjoint_sets.hpp"
#include "slab.hpp"

namespace poreshock {

/// What is known of a domain.
inline constexpr std::uint8_t mark_winds = 1;
inline constexpr std::uint8_t mark_frame = 2;
inline constexpr std::uint32_t nowhere = std::numeric_limits<std::uint32_t>::max();

/// What changes at each level of a sweep; the numbers of domains are its running sums.
struct Changes {
  std::vector<std::int64_t> pixels, joins, winding, touching;

  explicit Changes(std::size_t levels)
      : pixels(levels, 0), joins(levels, 0), winding(levels, 0), touching(levels, 0) {}
};

/// Adds a domain with these marks to the changes, or takes it away (sign -1).
inline void count_marks(std::uint8_t marks, int sign, std::size_t level, Changes& changes) {
  if ((marks & mark_winds) != 0) changes.winding[level] += sign;
  if ((marks & mark_frame) != 0) changes.touching[level] += sign;
}

/// News of domains that reach a border between two ranks: two of its pixels are joined, or (a == b)
/// the domain of one has got marks. Pixels of the borders are numbered over all borders.
struct BorderEvent {
  std::int32_t level;
  std::uint32_t a, b;
  Crossings step;
  std::uint32_t marks;
};

/// Which of eight active neighbours a pixel has to join, as bits, for every pattern of them. Bit k
/// stands for the k-th around the pixel: right, up right, up, ... The others already belong to the
/// domain of one of these, because they touch one another.
inline std::array<std::uint8_t, 256> needed_joins(bool corners) {
  std::array<std::uint8_t, 256> needed{};
  for (unsigned pattern = 0; pattern < 256; ++pattern) {
    const auto active = [&](unsigned k) { return (pattern >> (k % 8) & 1) != 0; };
    for (unsigned k = 0; k < 8; ++k) {
      const bool face = k % 2 == 0;
      if (!active(k) || (!face && !corners)) continue;
      // The neighbour before this one in the circle that touches it, if there is one.
      const bool touches_before =
          corners ? active(k + 7) || (face && active(k + 6)) : active(k + 6) && active(k + 7);
      if (!touches_before) needed[pattern] |= static_cast<std::uint8_t>(1 << k);
    }
    // A closed circle has no first one.
    const unsigned any = corners ? pattern : pattern & 0x55;
    if (needed[pattern] == 0 && any != 0)
      needed[pattern] = static_cast<std::uint8_t>(any & (~any + 1));
  }
  return needed;
}

/// Domains of one slab while pixels turn, level by level. Domains without a pixel on a border are
/// counted here; of the others only the joins that no other rank can undo.
class Sweep {
 public:
  Changes changes;
  std::vector<BorderEvent> events;

  Sweep(const Slab& slab, bool corners, std::uint32_t first_border, std::size_t levels)
      : changes(levels),
        slab_(slab),
        corners_(corners),
        reach_y_(slab.ny > 1 || slab.periodic_y ? 1 : 0),
        needed_(needed_joins(corners)),
        first_border_(first_border),
        sets_(slab.stored_size()),
        active_(slab.stored_size(), 0),
        marks_(slab.stored_size(), 0),
        border_(slab.stored_size(), nowhere) {}

  void turn(std::uint32_t pixel, std::size_t level) {
    const int x = static_cast<int>(pixel % static_cast<std::uint32_t>(slab_.nx));
    const std::uint32_t row = pixel / static_cast<std::uint32_t>(slab_.nx);
    const int y = static_cast<int>(row % static_cast<std::uint32_t>(slab_.ny));
    const int z = static_cast<int>(row / static_cast<std::uint32_t>(slab_.ny));
    active_[pixel] = 1;
    marks_[pixel] = on_frame(x, y, z) ? mark_frame : std::uint8_t{0};
    if (z < slab_.layers) ++changes.pixels[level];
    if (on_border(z)) border_[pixel] = pixel;
    if (marks_[pixel] != 0) tell(pixel, 0, marks_[pixel], level);
    if (reach_y_ == 0 && x > 0 && x + 1 < slab_.nx && z > 0 && z + 1 < slab_.layers) {
      join_inside(pixel, level);
      return;
    }
    for (int dz = -1; dz <= 1; ++dz) {
      // Edges within the upper neighbour's row are counted there.
      if (z + dz < 0 || z + dz >= slab_.stored || (z >= slab_.layers && dz == 0)) continue;
      for (int dy = -reach_y_; dy <= reach_y_; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const int away = (dx != 0 ? 1 : 0) + (dy != 0 ? 1 : 0) + (dz != 0 ? 1 : 0);
          if (away == 0 || (away > 1 && !corners_)) continue;
          join_neighbour(pixel, {x + dx, y + dy, z + dz}, level);
        }
      }
    }
  }

 private:
  /// Joins where all eight neighbours lie in owned rows and no side is crossed, in 2-D.
  void join_inside(std::uint32_t pixel, std::size_t level) {
    const std::int64_t nx = slab_.nx;
    const std::array<std::int64_t, 8> around = {1, nx + 1, nx, nx - 1, -1, -nx - 1, -nx, 1 - nx};
    unsigned pattern = 0;
    for (std::size_t k = 0; k < 8; ++k) {
      pattern |= static_cast<unsigned>(active_[static_cast<std::size_t>(pixel + around[k])]) << k;
    }
    for (unsigned left = needed_[pattern]; left != 0; left &= left - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(left));
      join(pixel, static_cast<std::uint32_t>(pixel + around[k]), {}, level);
    }
  }

  bool on_frame(int x, int y, int z) const {
    return (slab_.first && z == 0) || (slab_.last && z == slab_.layers - 1) ||
           (!slab_.periodic_x && (x == 0 || x == slab_.nx - 1)) ||
           (slab_.ny > 1 && !slab_.periodic_y && (y == 0 || y == slab_.ny - 1));
  }

  bool on_border(int z) const { return (z == 0 && !slab_.first) || z >= slab_.layers; }

  /// Number of a border pixel over all borders.
  std::uint32_t border_number(std::uint32_t pixel) const {
    const auto layer = static_cast<std::uint32_t>(slab_.layer_size());
    const auto owned = static_cast<std::uint32_t>(slab_.layers) * layer;
    return first_border_ + (pixel < owned ? pixel - layer : pixel - owned);
  }

  void join_neighbour(std::uint32_t pixel, std::array<int, 3> at, std::size_t level) {
    Crossings step;
    if (at[0] < 0 || at[0] >= slab_.nx) {
      if (!slab_.periodic_x) return;
      step.x = at[0] < 0 ? -1 : 1;
      at[0] -= step.x * slab_.nx;
    }
    if (at[1] < 0 || at[1] >= slab_.ny) {
      if (!slab_.periodic_y) return;
      step.y = at[1] < 0 ? -1 : 1;
      at[1] -= step.y * slab_.ny;
    }
    const auto other = static_cast<std::uint32_t>(
        (static_cast<std::size_t>(at[2]) * static_cast<std::size_t>(slab_.ny) +
         static_cast<std::size_t>(at[1])) *
            static_cast<std::size_t>(slab_.nx) +
        static_cast<std::size_t>(at[0]));
    if (active_[other] != 0) join(pixel, other, step, level);
  }

  void join(std::uint32_t a, std::uint32_t b, Crossings step, std::size_t level) {
    const DisjointSets::Joined joined = sets_.join(a, b, step);
    const std::uint32_t root = joined.root;
    const std::uint32_t absorbed = joined.absorbed;
    if (root == absorbed) {
      if (joined.winding == Crossings{} || (marks_[root] & mark_winds) != 0) return;
      marks_[root] |= mark_winds;
      tell(root, marks_[root] ^ mark_winds, marks_[root], level);
      return;
    }
    const std::uint8_t before = marks_[root];
    const auto together = static_cast<std::uint8_t>(before | marks_[absorbed]);
    if (border_[root] != nowhere && border_[absorbed] != nowhere) {
      add_edge(border_[root], border_[absorbed], level);
    } else {
      ++changes.joins[level];
      const bool absorbed_at_border = border_[absorbed] != nowhere;
      // The one without a border, if any, is no longer counted here on its own.
      const std::uint8_t inner = absorbed_at_border ? before : marks_[absorbed];
      const std::uint8_t outer = absorbed_at_border ? marks_[absorbed] : before;
      count_marks(inner, -1, level, changes);
      if (absorbed_at_border) border_[root] = border_[absorbed];
      if (together != outer) tell(root, outer, together, level);
    }
    marks_[root] = together;
  }

  /// The marks of a domain have changed.
  void tell(std::uint32_t root, int before, int after, std::size_t level) {
    if (border_[root] == nowhere) {
      count_marks(static_cast<std::uint8_t>(before), -1, level, changes);
      count_marks(static_cast<std::uint8_t>(after), 1, level, changes);
      return;
    }
    const std::uint32_t number = border_number(border_[root]);
    events.push_back(
        {static_cast<std::int32_t>(level), number, number, {}, static_cast<std::uint32_t>(after)});
  }

  void add_edge(std::uint32_t a, std::uint32_t b, std::size_t level) {
    const Crossings step = sets_.find(b).from_root - sets_.find(a).from_root;
    events.push_back(
        {static_cast<std::int32_t>(level), border_number(a), border_number(b), step, 0});
  }

  const Slab& slab_;
  bool corners_;
  int reach_y_;
  std::array<std::uint8_t, 256> needed_;
  std::uint32_t first_border_;
  DisjointSets sets_;
  std::vector<std::uint8_t> active_;
  std::vector<std::uint8_t> marks_;    // of the domain, at its root
  std::vector<std::uint32_t> border_;  // a pixel of the domain on a border, at its root
};

}  // namespace poreshock
