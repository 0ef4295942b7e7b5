#pragma once
// Counts of white cells and domains written as plainly as possible: one threshold at a time, one
// cell at a time, domains by flood fill. Slow, and independent of the code under test.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "poreshock/morphology/minkowski.hpp"

namespace poreshock::reference {

/// A whole map; 3-D when depth says so, pixel maps have depth 1 along y and rows along z.
struct Image {
  int width = 0;   ///< x
  int depth = 1;   ///< y, 1 in 2-D
  int height = 0;  ///< rows or layers
  bool periodic = false;
  bool periodic_y = false;
  std::vector<double> values;
  std::vector<std::uint8_t> solid;

  std::size_t size() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(depth) *
           static_cast<std::size_t>(height);
  }
};

/// Index of a voxel after wrapping, or -1 outside the map.
inline std::ptrdiff_t index_of(const Image& image, int x, int y, int z) {
  if (image.periodic) x = (x + image.width) % image.width;
  if (image.periodic_y) y = (y + image.depth) % image.depth;
  const bool inside =
      x >= 0 && x < image.width && y >= 0 && y < image.depth && z >= 0 && z < image.height;
  return inside ? x + std::ptrdiff_t{image.width} * (y + std::ptrdiff_t{image.depth} * z) : -1;
}

inline bool is_white(const Image& image, double threshold, int x, int y, int z) {
  const std::ptrdiff_t i = index_of(image, x, y, z);
  if (i < 0) return false;
  const auto at = static_cast<std::size_t>(i);
  return image.solid[at] != 0 && image.values[at] >= threshold;
}

/// What lies on the two sides of an edge or face.
enum class Side { frame, with_void, inside };

inline Side side_of(const Image& image, std::ptrdiff_t a, std::ptrdiff_t b) {
  if (a < 0 || b < 0) return Side::frame;
  const bool both = image.solid[static_cast<std::size_t>(a)] != 0 &&
                    image.solid[static_cast<std::size_t>(b)] != 0;
  return both ? Side::inside : Side::with_void;
}

/// One entry of every array more, all zero.
template <class Counts>
void push_zeros(Counts& counts) {
  for_each_count(counts, [](std::string_view, auto& array) { array.push_back(0); });
}

template <class Counts>
void count_material(const Image& image, Counts& counts) {
  for (const std::uint8_t solid : image.solid) counts.pixels += solid != 0 ? 1 : 0;
}

/// Counts of a pixel map (depth 1).
inline PixelCounts count_pixels_plainly(const Image& image, std::span<const double> thresholds) {
  PixelCounts counts;
  count_material(image, counts);
  // Grid lines at x = 0 ... lines_x - 1; the last one is the first where x wraps.
  const int lines = image.periodic ? image.width : image.width + 1;
  for (const double th : thresholds) {
    push_zeros(counts);
    const auto white = [&](int x, int z) { return is_white(image, th, x, 0, z); };
    const auto edge = [&](int xa, int za, int xb, int zb) {
      const bool a = white(xa, za);
      const bool b = white(xb, zb);
      if (a || b) ++counts.E.back();
      if (a == b) return;
      const Side side = side_of(image, index_of(image, xa, 0, za), index_of(image, xb, 0, zb));
      ++(side == Side::frame       ? counts.B_frame
         : side == Side::with_void ? counts.B_void
                                   : counts.B_int)
            .back();
      if (side == Side::inside && za != zb) ++counts.B_axial.back();
    };
    const auto diagonal = [&](int xa, int za, int xb, int zb) {
      const Side side = side_of(image, index_of(image, xa, 0, za), index_of(image, xb, 0, zb));
      if (side == Side::inside && white(xa, za) != white(xb, zb)) ++counts.D_int.back();
    };
    for (int z = 0; z < image.height; ++z) {
      for (int x = 0; x < image.width; ++x) counts.F.back() += white(x, z) ? 1 : 0;
      for (int x = 0; x < lines; ++x) edge(x - 1, z, x, z);
    }
    for (int z = 0; z <= image.height; ++z) {
      for (int x = 0; x < image.width; ++x) edge(x, z - 1, x, z);
      for (int x = 0; x < lines; ++x) {
        const bool p = white(x - 1, z - 1), q = white(x, z - 1), r = white(x - 1, z),
                   s = white(x, z);
        counts.V.back() += p || q || r || s ? 1 : 0;
        counts.V4.back() += p && q && r && s ? 1 : 0;
        counts.D.back() += (p || s ? 1 : 0) + (q || r ? 1 : 0);
        diagonal(x - 1, z - 1, x, z);
        diagonal(x, z - 1, x - 1, z);
      }
    }
  }
  return counts;
}

/// Blocks of 2 x 2 pixels in which two white pixels touch in the corner only, for one threshold.
inline std::int64_t count_ambiguous_blocks(const Image& image, double th) {
  std::int64_t count = 0;
  const int lines = image.periodic ? image.width : image.width + 1;
  for (int z = 0; z <= image.height; ++z) {
    for (int x = 0; x < lines; ++x) {
      const bool p = is_white(image, th, x - 1, 0, z - 1), q = is_white(image, th, x, 0, z - 1);
      const bool r = is_white(image, th, x - 1, 0, z), s = is_white(image, th, x, 0, z);
      count += p == s && q == r && p != q ? 1 : 0;
    }
  }
  return count;
}

/// White domains, black domains that touch the frame or not, and whether a white domain winds.
struct Domains {
  int white = 0;
  int black_inside = 0;
  int black_touching = 0;
  bool winds = false;
};

/// Labels one colour of a pixel map by flood fill that also unrolls x: a pixel reached with two
/// different displacements lies on a path around the cylinder.
class FloodFill {
 public:
  FloodFill(const Image& image, double threshold, bool colour, bool corners)
      : image_(image),
        threshold_(threshold),
        colour_(colour),
        corners_(corners),
        seen_(image.size(), std::numeric_limits<int>::min()) {
    for (int z = 0; z < image.height; ++z) {
      for (int x = 0; x < image.width; ++x) {
        if (takes(x, z) && seen_[at(x, z)] == std::numeric_limits<int>::min()) fill(x, z);
      }
    }
  }

  int inside = 0;    ///< domains without a pixel on the frame
  int touching = 0;  ///< domains with one
  bool winds = false;

 private:
  std::size_t at(int x, int z) const { return static_cast<std::size_t>(index_of(image_, x, 0, z)); }
  bool takes(int x, int z) const {
    return index_of(image_, x, 0, z) >= 0 && is_white(image_, threshold_, x, 0, z) == colour_;
  }

  void fill(int start_x, int start_z) {
    bool touches = false;
    std::vector<std::pair<int, int>> stack = {{start_x, start_z}};  // unrolled x
    seen_[at(start_x, start_z)] = start_x;
    while (!stack.empty()) {
      const auto [x, z] = stack.back();
      stack.pop_back();
      const int folded = ((x % image_.width) + image_.width) % image_.width;
      touches = touches || z == 0 || z == image_.height - 1;
      touches = touches || (!image_.periodic && (folded == 0 || folded == image_.width - 1));
      for (int dz = -1; dz <= 1; ++dz) {
        for (int dx = -1; dx <= 1; ++dx) {
          if ((dx == 0 && dz == 0) || (dx != 0 && dz != 0 && !corners_)) continue;
          if (!image_.periodic && (folded + dx < 0 || folded + dx >= image_.width)) continue;
          if (!takes(folded + dx, z + dz)) continue;
          int& seen = seen_[at(folded + dx, z + dz)];
          if (seen == std::numeric_limits<int>::min()) {
            seen = x + dx;
            stack.emplace_back(x + dx, z + dz);
          } else if (seen != x + dx) {
            winds = true;
          }
        }
      }
    }
    ++(touches ? touching : inside);
  }

  const Image& image_;
  double threshold_;
  bool colour_;
  bool corners_;
  std::vector<int> seen_;
};

/// Domains of a pixel map; white joins over corners (8) or not (4), black the other way round.
inline Domains label_domains(const Image& image, double threshold, bool white_corners) {
  const FloodFill white(image, threshold, true, white_corners);
  const FloodFill black(image, threshold, false, !white_corners);
  return {white.inside + white.touching, black.inside, black.touching, white.winds};
}

/// White cells around one corner of the lattice, `extent` giving which of the axes they span.
struct Around {
  bool any = false;
  bool all = true;
};

inline Around look_around(const Image& image, double th, std::array<int, 3> corner,
                          std::array<int, 3> extent) {
  Around result;
  for (int dz = -extent[2]; dz <= 0; ++dz) {
    for (int dy = -extent[1]; dy <= 0; ++dy) {
      for (int dx = -extent[0]; dx <= 0; ++dx) {
        const bool white = is_white(image, th, corner[0] + dx, corner[1] + dy, corner[2] + dz);
        result.any = result.any || white;
        result.all = result.all && white;
      }
    }
  }
  return result;
}

/// Counts of a voxel map.
inline VoxelCounts count_voxels_plainly(const Image& image, std::span<const double> thresholds) {
  VoxelCounts counts;
  count_material(image, counts);
  const std::array<int, 3> pixels = {image.width, image.depth, image.height};
  const std::array<bool, 3> wraps = {image.periodic, image.periodic_y, false};
  for (const double th : thresholds) {
    push_zeros(counts);
    // A cell spans voxels on both sides along the axes in `extent`, where it lies on a grid plane.
    for (int kind = 0; kind < 8; ++kind) {
      const std::array<int, 3> extent = {kind & 1, (kind >> 1) & 1, (kind >> 2) & 1};
      const int planes = extent[0] + extent[1] + extent[2];
      std::array<int, 3> end{};
      for (std::size_t a = 0; a < 3; ++a)
        end[a] = pixels[a] + (extent[a] == 1 && !wraps[a] ? 1 : 0);
      for (int z = 0; z < end[2]; ++z) {
        for (int y = 0; y < end[1]; ++y) {
          for (int x = 0; x < end[0]; ++x) {
            const Around around = look_around(image, th, {x, y, z}, extent);
            if (planes == 0) counts.C.back() += around.any ? 1 : 0;
            if (planes == 1) counts.F.back() += around.any ? 1 : 0;
            if (planes == 2) counts.E.back() += around.any ? 1 : 0;
            if (planes == 3) counts.V.back() += around.any ? 1 : 0;
            if (planes == 2) counts.E4.back() += around.all ? 1 : 0;
            if (planes == 3) counts.V8.back() += around.all ? 1 : 0;
            if (planes != 1 || around.any == around.all) continue;
            const Side side = side_of(image, index_of(image, x, y, z),
                                      index_of(image, x - extent[0], y - extent[1], z - extent[2]));
            ++(side == Side::frame       ? counts.S_frame
               : side == Side::with_void ? counts.S_void
                                         : counts.S_int)
                  .back();
            if (side == Side::inside && extent[2] == 1) ++counts.S_axial.back();
          }
        }
      }
    }
  }
  return counts;
}

/// Rows first ... first + rows - 1 of an image as a block, with storage for the row above.
template <class Block>
struct StoredBlock {
  std::vector<double> values;
  std::vector<std::uint8_t> solid;
  Block block;
};

/// Cuts a block out. Above the last row stands rubbish that must be ignored.
template <class Block>
StoredBlock<Block> cut(const Image& image, int first, int rows) {
  StoredBlock<Block> result;
  const auto layer = static_cast<std::ptrdiff_t>(image.width) * image.depth;
  const bool last = first + rows == image.height;
  const std::ptrdiff_t end = (first + rows + (last ? 0 : 1)) * layer;
  result.values.assign(image.values.begin() + first * layer, image.values.begin() + end);
  result.solid.assign(image.solid.begin() + first * layer, image.solid.begin() + end);
  if (last) {
    result.values.resize(result.values.size() + static_cast<std::size_t>(layer), 1e300);
    result.solid.resize(result.values.size(), 1);
  }
  Block& block = result.block;
  block.first = first == 0;
  block.last = last;
  if constexpr (std::is_same_v<Block, PixelBlock>) {
    block.width = image.width;
    block.rows = rows;
    block.periodic = image.periodic;
  } else {
    block.width = {image.width, image.depth};
    block.layers = rows;
    block.periodic = {image.periodic, image.periodic_y};
  }
  block.values = result.values;
  block.solid = result.solid;
  return result;
}

inline PixelCounts count_whole(const Image& image, std::span<const double> thresholds) {
  return count_pixels(cut<PixelBlock>(image, 0, image.height).block, thresholds);
}

inline VoxelCounts count_whole_voxels(const Image& image, std::span<const double> thresholds) {
  return count_voxels(cut<VoxelBlock>(image, 0, image.height).block, thresholds);
}

}  // namespace poreshock::reference
