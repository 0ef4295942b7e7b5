#pragma once
// Exact area of the part of a rectangle that discs cover.

#include <vector>

namespace poreshock {

struct Disc {
  double x = 0.0, y = 0.0;  ///< m, centre
  double radius = 0.0;      ///< m
};

/// Area (m^2) of the union of the discs inside the rectangle [0, width] x [0, height] (m). Exact
/// but for rounding: Green's theorem over the arcs of the union's edge. Not periodic: give images.
double union_area(const std::vector<Disc>& discs, double width, double height);

/// The discs that reach into the rectangle, with all their images across its periodic sides.
std::vector<Disc> with_images(const std::vector<Disc>& discs, double width, double height,
                              bool periodic_x, bool periodic_y);

}  // namespace poreshock
