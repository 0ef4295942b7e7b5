#pragma once
// Counts of a thresholded pixel or voxel map for all thresholds in one pass, and the Minkowski
// functionals that follow from them. Conventions: white means value >= threshold, white joins over
// corners (8 neighbours in 2-D, 26 in 3-D), void pixels are black and not part of the material, N
// is the number of material pixels. Outside the map everything is black. A NaN value is black.
// Also in count_pixels.cpp, count_voxels.cpp.
//
// Max rule: a cell (edge, vertex, diagonal) is white when one of the pixels that share it is white.
// Min rule: a cell is white when all of them are. The rank of a pixel is the number of thresholds
// that its value reaches, so the rank of a cell is the max or min of the ranks of its pixels, and
// one histogram of ranks per kind of cell holds the counts for every threshold.
//
// Blocks and ownership: a block holds whole rows (3-D: layers) of the map and owns its pixels, the
// edges towards +x and +y and the vertex (+x, +y) of each, in 3-D the faces, edges and vertex on
// the high side of each voxel. `first` adds the low frame, a side that is not periodic adds its low
// frame in every block. So the counts of the blocks of any tiling add up to those of the map.
//
// Michielsen and De Raedt, Phys. Rep. 347 (2001) 461: functionals from counts of cells.

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace poreshock {

/// A block of whole pixel rows of a global map, with one extra row above it from the neighbour.
/// Pixel rows follow the shock axis. Values are row-major, width pixels a row.
struct PixelBlock {
  int width = 0;
  int rows = 0;                    ///< rows owned; a block without rows counts as nothing
  bool periodic = false;           ///< x wraps
  bool first = false;              ///< lowest rows of the global map are here
  bool last = false;               ///< highest rows of the global map are here
  std::span<const double> values;  ///< (rows + 1) x width; the last row is the neighbour's first
                                   ///< row, ignored where `last` is set
  std::span<const std::uint8_t> solid;  ///< same shape, 1 = material, 0 = void
};

/// Counts for K ascending thresholds; every array has K entries. These hold exactly:
/// B_int + B_void + B_frame = 2E - 4F; white-white edges = 4F - E;
/// chi8 = V - E + F; chi4 = E - 3F + V4; chi4 - chi8 = ambiguous 2x2 blocks (two white pixels that
/// meet in a corner only).
struct PixelCounts {
  std::int64_t pixels = 0;       ///< material pixels N
  std::vector<std::int64_t> F;   ///< white pixels
  std::vector<std::int64_t> E;   ///< edges of white pixels (max rule), frame included
  std::vector<std::int64_t> V;   ///< vertices of white pixels (max rule), frame included
  std::vector<std::int64_t> V4;  ///< vertices all of whose four pixels are white (min rule); none
                                 ///< on the frame
  std::vector<std::int64_t> D;   ///< diagonal pairs with a white pixel (max rule): every vertex,
                                 ///< frame included, has two diagonals of two pixels each
  std::vector<std::int64_t> B_int;    ///< white-black edges between two material pixels
  std::vector<std::int64_t> B_void;   ///< white-void edges
  std::vector<std::int64_t> B_frame;  ///< white edges on the frame of the map
  std::vector<std::int64_t> B_axial;  ///< those of B_int that a line along the shock axis crosses
  std::vector<std::int64_t> D_int;    ///< white-black diagonal pairs of two material pixels
};

/// Counts of one block in one pass. Blocks of a tiling add up to the counts of the whole map.
/// Throws InputError when thresholds descend or are NaN, or when the spans do not fit the block.
/// Not collective.
PixelCounts count_pixels(const PixelBlock& block, std::span<const double> thresholds);

/// Adds b to a, element by element; an empty a becomes b. Not collective.
void add(const PixelCounts& b, PixelCounts& a);

/// Minkowski functionals per material pixel.
struct Minkowski {
  std::vector<double> A, L, L_crofton, chi, chi4;
};

/// A = F/N, L = B_int/N, L_crofton = pi/8 (B_int + D_int/sqrt(2))/N, chi = (V-E+F)/N, chi4 =
/// (E-3F+V4)/N; all zero when N = 0. L is 4/pi too long for boundaries without direction; L_crofton
/// counts crossings of lines in four directions and is within -5.4 ... +2.4 % for straight ones.
/// Ohser and Muecklich, Statistical Analysis of Microstructures (2000). Not collective.
Minkowski functionals(const PixelCounts& counts);

/// A block of whole voxel layers of a global map, with one extra layer above it from the neighbour.
/// Layers follow the shock axis z. Values run over x fastest, then y, then z.
struct VoxelBlock {
  std::array<int, 2> width{};      ///< voxels along x and y
  int layers = 0;                  ///< layers owned; a block without layers counts as nothing
  std::array<bool, 2> periodic{};  ///< x wraps, y wraps
  bool first = false;              ///< lowest layers of the global map are here
  bool last = false;               ///< highest layers of the global map are here
  std::span<const double> values;  ///< (layers + 1) x width[1] x width[0]; the last layer is the
                                   ///< neighbour's first, ignored where `last` is set
  std::span<const std::uint8_t> solid;  ///< same shape, 1 = material, 0 = void
};

/// Counts for K ascending thresholds; every array has K entries. These hold exactly:
/// S_int + S_void + S_frame = 2F - 6C; white-white faces = 6C - F;
/// chi26 = -C + F - E + V; chi6 = F - 5C + E4 - V8.
struct VoxelCounts {
  std::int64_t pixels = 0;            ///< material voxels N
  std::vector<std::int64_t> C;        ///< white voxels
  std::vector<std::int64_t> F;        ///< faces of white voxels (max rule), frame included
  std::vector<std::int64_t> E;        ///< edges of white voxels (max rule), frame included
  std::vector<std::int64_t> V;        ///< vertices of white voxels (max rule), frame included
  std::vector<std::int64_t> E4;       ///< edges all of whose four voxels are white (min rule)
  std::vector<std::int64_t> V8;       ///< vertices all of whose eight voxels are white (min rule)
  std::vector<std::int64_t> S_int;    ///< white-black faces between two material voxels
  std::vector<std::int64_t> S_void;   ///< white-void faces
  std::vector<std::int64_t> S_frame;  ///< white faces on the frame of the map
  std::vector<std::int64_t> S_axial;  ///< those of S_int that a line along the shock axis crosses
};

/// Counts of one block in one pass. Blocks of a tiling add up to the counts of the whole map.
/// Throws InputError when thresholds descend or are NaN, or when the spans do not fit the block.
/// Not collective.
VoxelCounts count_voxels(const VoxelBlock& block, std::span<const double> thresholds);

/// Adds b to a, element by element; an empty a becomes b. Not collective.
void add(const VoxelCounts& b, VoxelCounts& a);

/// Minkowski functionals per material voxel.
struct Minkowski3 {
  std::vector<double> V, S, S_crofton, M, chi, chi6;
};

/// V = C/N, S = S_int/N, S_crofton = 2/3 S (right for surfaces without direction), M = (3C-2F+E)/N
/// (first intrinsic volume: 3 for one voxel; its integral of mean curvature is pi times this), chi
/// = (-C+F-E+V)/N, chi6 = (F-5C+E4-V8)/N; all zero when N = 0. Not collective.
Minkowski3 functionals(const VoxelCounts& counts);

/// Pixels in 2-D, voxels in 3-D.
template <int Dim>
using MapBlock = std::conditional_t<Dim == 2, PixelBlock, VoxelBlock>;
template <int Dim>
using MapCounts = std::conditional_t<Dim == 2, PixelCounts, VoxelCounts>;
template <int Dim>
using MapFunctionals = std::conditional_t<Dim == 2, Minkowski, Minkowski3>;

/// Whether two counts hold the same numbers.
bool operator==(const PixelCounts& a, const PixelCounts& b);
bool operator==(const VoxelCounts& a, const VoxelCounts& b);

/// Calls visit(name, array) for every array of the counts, always in the same order; the names are
/// those of the output files. Counts is a const or mutable PixelCounts or VoxelCounts.
template <class Counts, class Visitor>
void for_each_count(Counts& counts, Visitor&& visit) {
  if constexpr (std::is_same_v<std::remove_const_t<Counts>, PixelCounts>) {
    visit(std::string_view("F"), counts.F);
    visit(std::string_view("E"), counts.E);
    visit(std::string_view("V"), counts.V);
    visit(std::string_view("V4"), counts.V4);
    visit(std::string_view("D"), counts.D);
    visit(std::string_view("B_int"), counts.B_int);
    visit(std::string_view("B_void"), counts.B_void);
    visit(std::string_view("B_frame"), counts.B_frame);
    visit(std::string_view("B_axial"), counts.B_axial);
    visit(std::string_view("D_int"), counts.D_int);
  } else {
    visit(std::string_view("C"), counts.C);
    visit(std::string_view("F"), counts.F);
    visit(std::string_view("E"), counts.E);
    visit(std::string_view("V"), counts.V);
    visit(std::string_view("E4"), counts.E4);
    visit(std::string_view("V8"), counts.V8);
    visit(std::string_view("S_int"), counts.S_int);
    visit(std::string_view("S_void"), counts.S_void);
    visit(std::string_view("S_frame"), counts.S_frame);
    visit(std::string_view("S_axial"), counts.S_axial);
  }
}

}  // namespace poreshock
