#pragma once
// The sample block as its voids see it: a box, periodic across some lateral sides.

#include <array>
#include <vector>

#include "poreshock/sample/fill.hpp"

namespace poreshock {

/// The block [0, size] that the sample fills; the last axis in use is the shock axis.
struct Block {
  int dimension = 2;
  Triple size{};                   ///< m; the shock axis holds the height
  std::array<bool, 3> periodic{};  ///< never along the shock axis
};

/// Range of coordinates along one axis, m.
struct AxisRange {
  double low = 0.0;
  double high = 0.0;
};

/// The block of a scene's sample.
Block sample_block(const Scene& scene);

/// Area (2-D, m^2) or volume (3-D, m^3) of the block.
double block_measure(const Block& block);

/// Area of a disc (2-D, m^2) or volume of a ball (3-D, m^3).
double ball_measure(double radius, int dimension);

/// Sum of the measures of voids, each on its own, m^2 or m^3; compensated, so that a hundred
/// thousand equal voids are summed to the last bits.
double summed_measure(const std::vector<Void>& voids, int dimension);

/// Where the centre of a void of this radius may lie along an axis, m: anywhere on a periodic axis,
/// else with keep_out between its surface and both sides. Empty (high < low) when it cannot fit.
AxisRange centre_range(const Block& block, double keep_out, double radius, int axis);

/// The same point with its periodic coordinates in [0, size).
Triple wrap(const Block& block, Triple point);

/// Vector from `from` to the nearest image of `to`, m; both points inside the block.
Triple separation(const Block& block, const Triple& from, const Triple& to);

/// Square of the distance to the nearest image, m^2.
double squared_distance(const Block& block, const Triple& from, const Triple& to);

/// Least distance between the surfaces of two voids, images across periodic sides (its own too)
/// included, m; negative where they overlap, infinite when there is no pair at all.
double least_gap(const std::vector<Void>& voids, const Block& block);

/// Exact void fraction of the block; see void_fraction(voids, scene).
double void_fraction(const std::vector<Void>& voids, const Block& block);

}  // namespace poreshock
