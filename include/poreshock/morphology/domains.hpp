#pragma once
// Connected domains of a thresholded map: how many there are at every threshold, and what each hot
// one is like at one threshold. Also in count_domains.cpp, hot_spots.cpp.
//
// White (hot) pixels are material pixels with value >= threshold, black (cold) ones are the other
// material pixels, NaN included. Void pixels belong to no domain. White and black join by dual
// neighbourhoods, so that a closed path of one colour separates the other. A domain winds when it
// joins itself across a periodic side. All numbers are the same on any number of ranks.

#include <mpi.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "poreshock/morphology/pixel_map.hpp"

namespace poreshock {

/// Neighbourhoods of white pixels. Black ones have the other.
enum class Joining {
  corners,  ///< white 8 in 2-D, 26 in 3-D; black 4, 6
  faces     ///< white 4, 6; black 8, 26
};

/// Numbers of domains for K ascending thresholds; every array has K entries. On a map without voids
/// and with white joining over corners these hold exactly, w being 1 where white_winding > 0, else
/// 0: n_W - (n_B - n_B_frame) - w = V - E + F in 2-D.
struct DomainCounts {
  std::int64_t pixels = 0;                  ///< material pixels N
  std::vector<std::int64_t> n_W;            ///< white domains
  std::vector<std::int64_t> n_B;            ///< black domains
  std::vector<std::int64_t> n_B_frame;      ///< black domains with a pixel on the frame of the map
  std::vector<std::int64_t> white_winding;  ///< white domains that wind
  std::vector<std::int64_t> black_winding;  ///< black domains that wind
};

/// Counts the domains of one field at all thresholds in one sweep per colour over the sorted
/// pixels, on every rank. Between the ranks goes at most one edge per pixel of a slab's first and
/// last row, joined on rank 0. Throws InputError when thresholds descend or are NaN. Collective;
/// ghost row filled.
/// Kruskal, Proc. Am. Math. Soc. 7 (1956) 48: the edges that join two domains form a spanning
/// forest; domains = pixels - edges of the forest.
template <int Dim>
DomainCounts count_domains(const PixelField<Dim>& map, std::size_t field,
                           std::span<const double> thresholds, Joining joining,
                           MPI_Comm communicator);

/// The Euler characteristic as counted domains, (n_W - n_B)/N per threshold; zero when N = 0. It
/// differs from (V - E + F)/N by black domains on the frame, by winding and, with voids, by what
/// the voids separate. Not collective.
std::vector<double> chi_of_domains(const DomainCounts& counts);

/// One white domain. Lengths are in pixels, from the low corner of the map.
template <int Dim>
struct HotSpot {
  std::int64_t pixels = 0;
  double peak = 0.0;                     ///< largest value, in the unit of the field
  double mean = 0.0;                     ///< of the values, rounded to 2^-31 of the map's largest
  std::array<double, Dim> centroid{};    ///< on the map; NaN along an axis around which it winds
  std::array<std::int64_t, Dim> low{};   ///< first pixel along each axis, on the map
  std::array<std::int64_t, Dim> size{};  ///< pixels spanned along each axis; past a periodic side
                                         ///< low + size exceeds the map
  std::array<bool, Dim - 1> winds{};     ///< around each lateral axis
  std::int64_t first = 0;                ///< number of its first pixel, x fastest
};

/// All white domains at one threshold, largest first, then by first pixel; on rank 0, empty
/// elsewhere. Labels runs of white pixels, row by row. Collective; ghost row filled.
template <int Dim>
std::vector<HotSpot<Dim>> find_hot_spots(const PixelField<Dim>& map, std::size_t field,
                                         double threshold, Joining joining, MPI_Comm communicator);

}  // namespace poreshock
