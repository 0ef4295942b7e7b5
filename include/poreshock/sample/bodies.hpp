#pragma once
// Geometry of explicit bodies and voids.

#include "poreshock/scene/scene.hpp"

namespace poreshock {

/// Opposite corners, m.
struct Box {
  Triple low{}, high{};
};

/// Smallest box around the region; low above high for a polygon without corners.
Box bounding_box(const Region& region);

/// True when the point lies in the closed region. dimension 2 ignores the third coordinate.
bool contains(const Region& region, const Triple& point, int dimension);

/// True when the point lies in the region, farther than `depth` (m) from its surface; with a
/// negative depth also when it lies outside, less than that away.
bool lies_within(const Region& region, const Triple& point, double depth, int dimension);

/// Centroid of the region, m.
Triple centroid(const Region& region, int dimension);

/// True when two bodies have one velocity field: the same velocity and spin, about the same point.
bool move_alike(const Body& a, const Body& b, int dimension);

/// Area (2-D, m^2) or volume (3-D, m^3) of the region.
double measure(const Region& region, int dimension);

}  // namespace poreshock
