#pragma once
// Domains of a map by flood fill, one pixel at a time on the whole map. Slow, and independent of
// the code under test.

#include <algorithm>
#include <cmath>
#include <vector>

#include "poreshock/morphology/domains.hpp"
#include "support/pixel_reference.hpp"

namespace poreshock::reference {

/// A domain in coordinates that run on across periodic sides.
struct PlainDomain {
  std::int64_t pixels = 0;
  std::int64_t first = 0;
  double peak = -INFINITY;
  double sum = 0.0;
  std::array<std::int64_t, 3> position_sum{};
  std::array<std::int64_t, 3> low{};
  std::array<std::int64_t, 3> high{};
  std::array<bool, 2> winds{};
  bool on_frame = false;
};

/// Whether a pixel is material of the given colour.
inline bool has_colour(const Image& image, std::ptrdiff_t i, double threshold, bool white) {
  const auto at = static_cast<std::size_t>(i);
  return i >= 0 && image.solid[at] != 0 && (image.values[at] >= threshold) == white;
}

/// All domains of one colour, in the order of their first pixels.
class PlainDomains {
 public:
  PlainDomains(const Image& image, double threshold, bool white, bool corners)
      : image_(image),
        threshold_(threshold),
        white_(white),
        corners_(corners),
        seen_(image.size(), std::array<int, 3>{}),
        taken_(image.size(), 0) {
    for (int z = 0; z < image.height; ++z) {
      for (int y = 0; y < image.depth; ++y) {
        for (int x = 0; x < image.width; ++x) {
          const std::ptrdiff_t i = index_of(image, x, y, z);
          if (taken_[static_cast<std::size_t>(i)] == 0 && has_colour(image, i, threshold, white)) {
            fill(i, {x, y, z});
          }
        }
      }
    }
  }

  std::vector<PlainDomain> domains;

 private:
  void fill(std::ptrdiff_t start, std::array<int, 3> place) {
    domains.emplace_back();
    domains.back().first = start;
    domains.back().low = {place[0], place[1], place[2]};
    domains.back().high = domains.back().low;
    std::vector<std::array<int, 3>> stack = {place};
    take(start, place);
    while (!stack.empty()) {
      const std::array<int, 3> at = stack.back();
      stack.pop_back();
      for (int dz = -1; dz <= 1; ++dz) {
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) visit(at, {dx, dy, dz}, stack);
        }
      }
    }
  }

  void visit(std::array<int, 3> at, std::array<int, 3> step,
             std::vector<std::array<int, 3>>& stack) {
    const int away = std::abs(step[0]) + std::abs(step[1]) + std::abs(step[2]);
    if (away == 0 || (away > 1 && !corners_)) return;
    const std::array<int, 3> to = {at[0] + step[0], at[1] + step[1], at[2] + step[2]};
    const std::ptrdiff_t i = folded(to);
    if (!has_colour(image_, i, threshold_, white_)) return;
    if (taken_[static_cast<std::size_t>(i)] == 0) {
      take(i, to);
      stack.push_back(to);
      return;
    }
    const auto& seen = seen_[static_cast<std::size_t>(i)];
    for (std::size_t axis = 0; axis < 2; ++axis) {
      if (seen[axis] != to[axis]) domains.back().winds[axis] = true;
    }
  }

  /// Index of a pixel whose lateral coordinates may have run on for many maps; -1 outside.
  std::ptrdiff_t folded(std::array<int, 3> at) const {
    const auto fold = [](int x, int n) { return ((x % n) + n) % n; };
    if (image_.periodic) at[0] = fold(at[0], image_.width);
    if (image_.periodic_y) at[1] = fold(at[1], image_.depth);
    return index_of(image_, at[0], at[1], at[2]);
  }

  void take(std::ptrdiff_t i, std::array<int, 3> at) {
    const auto pixel = static_cast<std::size_t>(i);
    taken_[pixel] = 1;
    seen_[pixel] = at;
    PlainDomain& domain = domains.back();
    ++domain.pixels;
    domain.peak = std::max(domain.peak, image_.values[pixel]);
    domain.sum += image_.values[pixel];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      domain.position_sum[axis] += at[axis];
      domain.low[axis] = std::min<std::int64_t>(domain.low[axis], at[axis]);
      domain.high[axis] = std::max<std::int64_t>(domain.high[axis], at[axis]);
    }
    const auto end = [](int x, int n) { return x == 0 || x == n - 1; };
    domain.on_frame = domain.on_frame || end(at[2], image_.height) ||
                      (!image_.periodic && end(at[0], image_.width)) ||
                      (image_.depth > 1 && !image_.periodic_y && end(at[1], image_.depth));
  }

  const Image& image_;
  double threshold_;
  bool white_;
  bool corners_;
  std::vector<std::array<int, 3>> seen_;
  std::vector<std::uint8_t> taken_;
};

/// Domain counts of a whole map, one threshold after the other.
inline DomainCounts count_domains_plainly(const Image& image, std::span<const double> thresholds,
                                          Joining joining) {
  DomainCounts counts;
  for (const std::uint8_t solid : image.solid) counts.pixels += solid != 0 ? 1 : 0;
  const auto winds = [](const PlainDomain& d) { return d.winds[0] || d.winds[1]; };
  for (const double threshold : thresholds) {
    const PlainDomains white(image, threshold, true, joining == Joining::corners);
    const PlainDomains black(image, threshold, false, joining == Joining::faces);
    const auto number = [](const PlainDomains& all, auto is) {
      return static_cast<std::int64_t>(std::count_if(all.domains.begin(), all.domains.end(), is));
    };
    counts.n_W.push_back(static_cast<std::int64_t>(white.domains.size()));
    counts.n_B.push_back(static_cast<std::int64_t>(black.domains.size()));
    counts.n_B_frame.push_back(number(black, [](const PlainDomain& d) { return d.on_frame; }));
    counts.white_winding.push_back(number(white, winds));
    counts.black_winding.push_back(number(black, winds));
  }
  return counts;
}

/// The rows of one rank of a map whose rows are dealt out to `ranks` ranks, unevenly.
template <int Dim>
PixelField<Dim> deal_out(const Image& image, int rank, int ranks) {
  // Every rank gets one row; the rest goes to the ranks by thirds.
  std::vector<int> starts = {0};
  const int rest = image.height - ranks;
  for (int r = 1; r <= ranks; ++r) {
    const int share = r == ranks ? rest : rest * ((r * r) % 7) / 7;
    starts.push_back(std::max(starts.back() + 1, r + share));
  }
  for (int r = ranks; r > 0; --r) {
    starts[static_cast<std::size_t>(r)] =
        std::min(starts[static_cast<std::size_t>(r)], image.height - (ranks - r));
  }
  const auto at = static_cast<std::size_t>(rank);
  PixelField<Dim> map;
  if constexpr (Dim == 2) {
    map.layout = {{image.width, image.height}, 1.0, {image.periodic}};
  } else {
    map.layout = {
        {image.width, image.depth, image.height}, 1.0, {image.periodic, image.periodic_y}};
  }
  using Block = MapBlock<Dim>;
  map.rows = starts[at + 1] - starts[at];
  auto cut_out = cut<Block>(image, starts[at], map.rows);
  map.first = rank == 0;
  map.last = rank == ranks - 1;
  map.values = {std::move(cut_out.values)};
  map.solid = std::move(cut_out.solid);
  return map;
}

}  // namespace poreshock::reference
