#include "poreshock/sample/bodies.hpp"

#include <algorithm>
#include <cmath>

#include "block.hpp"
#include "poreshock/core/error.hpp"

namespace poreshock {
namespace {

double squared_radius(const Region& region, const Triple& point, int dimension) {
  double square = 0.0;
  for (int axis = 0; axis < dimension; ++axis) {
    const double d = point[axis] - region.center[axis];
    square += d * d;
  }
  return square;
}

/// Twice the signed area of the triangle a b p.
double turn(const Triple& a, const Triple& b, const Triple& p) {
  return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

bool on_edge(const Triple& a, const Triple& b, const Triple& p) {
  const bool within = p[0] >= std::min(a[0], b[0]) && p[0] <= std::max(a[0], b[0]) &&
                      p[1] >= std::min(a[1], b[1]) && p[1] <= std::max(a[1], b[1]);
  return within && turn(a, b, p) == 0.0;
}

/// Even-odd rule; points on an edge are inside.
bool in_polygon(const std::vector<Triple>& points, const Triple& p) {
  bool inside = false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Triple& a = points[i];
    const Triple& b = points[(i + 1) % points.size()];
    if (on_edge(a, b, p)) return true;
    if ((a[1] > p[1]) == (b[1] > p[1])) continue;
    // The edge crosses the level of p; p is left of it when it turns the way the edge climbs.
    if ((turn(a, b, p) > 0.0) == (b[1] > a[1])) inside = !inside;
  }
  return inside;
}

double squared_distance_to_edge(const Triple& a, const Triple& b, const Triple& p) {
  const double x = b[0] - a[0], y = b[1] - a[1];
  const double square = x * x + y * y;
  const double along = (p[0] - a[0]) * x + (p[1] - a[1]) * y;
  const double t = square > 0.0 ? std::clamp(along / square, 0.0, 1.0) : 0.0;
  const double dx = a[0] + t * x - p[0], dy = a[1] + t * y - p[1];
  return dx * dx + dy * dy;
}

bool is_near_edge(const std::vector<Triple>& points, const Triple& p, double distance) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Triple& next = points[(i + 1) % points.size()];
    if (squared_distance_to_edge(points[i], next, p) <= distance * distance) return true;
  }
  return false;
}

void require_flat(int dimension) {
  if (dimension == 2) return;
  throw InputError(
      "A polygon was found in a 3-D scene. Allowed are ball, box and shell. "
      "Use one of them.");
}

/// Signed area and centroid of a polygon, from triangles with its first corner.
struct PolygonMoments {
  double area = 0.0;
  Triple centroid{};
};

PolygonMoments polygon_moments(const std::vector<Triple>& points) {
  PolygonMoments result;
  if (points.empty()) return result;
  const Triple& origin = points.front();
  double sum_x = 0.0, sum_y = 0.0;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Triple& a = points[i];
    const Triple& b = points[i + 1];
    const double area = 0.5 * turn(origin, a, b);
    result.area += area;
    sum_x += area * ((a[0] - origin[0]) + (b[0] - origin[0])) / 3.0;
    sum_y += area * ((a[1] - origin[1]) + (b[1] - origin[1])) / 3.0;
  }
  result.centroid = origin;
  if (result.area != 0.0) {
    result.centroid[0] += sum_x / result.area;
    result.centroid[1] += sum_y / result.area;
  }
  return result;
}

}  // namespace

Box bounding_box(const Region& region) {
  if (region.shape == BodyShape::box) return {region.low, region.high};
  Box box;
  if (region.shape == BodyShape::polygon) {
    if (region.points.empty()) return {{1.0, 1.0, 1.0}, {0.0, 0.0, 0.0}};
    box.low = box.high = region.points.front();
    for (const Triple& p : region.points) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::min(box.low[axis], p[axis]);
        box.high[axis] = std::max(box.high[axis], p[axis]);
      }
    }
    return box;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = region.center[axis] - region.radius;
    box.high[axis] = region.center[axis] + region.radius;
  }
  return box;
}

bool contains(const Region& region, const Triple& point, int dimension) {
  switch (region.shape) {
    case BodyShape::disc:
      return squared_radius(region, point, dimension) <= region.radius * region.radius;
    case BodyShape::ring: {
      const double square = squared_radius(region, point, dimension);
      return square <= region.radius * region.radius &&
             square >= region.inner_radius * region.inner_radius;
    }
    case BodyShape::box:
      for (int axis = 0; axis < dimension; ++axis) {
        if (point[axis] < region.low[axis] || point[axis] > region.high[axis]) return false;
      }
      return true;
    case BodyShape::polygon:
      require_flat(dimension);
      return in_polygon(region.points, point);
  }
  return false;
}

bool lies_within(const Region& region, const Triple& point, double depth, int dimension) {
  switch (region.shape) {
    case BodyShape::disc:
    case BodyShape::ring: {
      const double radius = std::sqrt(squared_radius(region, point, dimension));
      return radius < region.radius - depth &&
             (region.shape == BodyShape::disc || radius > region.inner_radius + depth);
    }
    case BodyShape::box:
      for (int axis = 0; axis < dimension; ++axis) {
        if (point[axis] <= region.low[axis] + depth) return false;
        if (point[axis] >= region.high[axis] - depth) return false;
      }
      return true;
    case BodyShape::polygon:
      require_flat(dimension);
      return depth < 0.0
                 ? in_polygon(region.points, point) || is_near_edge(region.points, point, -depth)
                 : in_polygon(region.points, point) && !is_near_edge(region.points, point, depth);
  }
  return false;
}

Triple centroid(const Region& region, int dimension) {
  switch (region.shape) {
    case BodyShape::disc:
    case BodyShape::ring:
      return region.center;
    case BodyShape::box: {
      Triple result{};
      for (int axis = 0; axis < dimension; ++axis) {
        result[axis] = 0.5 * (region.low[axis] + region.high[axis]);
      }
      return result;
    }
    case BodyShape::polygon:
      require_flat(dimension);
      return polygon_moments(region.points).centroid;
  }
  return {};
}

bool move_alike(const Body& a, const Body& b, int dimension) {
  if (a.velocity != b.velocity || a.spin != b.spin) return false;
  return a.spin == Triple{} || centroid(a.region, dimension) == centroid(b.region, dimension);
}

double measure(const Region& region, int dimension) {
  switch (region.shape) {
    case BodyShape::disc:
      return ball_measure(region.radius, dimension);
    case BodyShape::ring:
      return ball_measure(region.radius, dimension) - ball_measure(region.inner_radius, dimension);
    case BodyShape::box: {
      double result = 1.0;
      for (int axis = 0; axis < dimension; ++axis) result *= region.high[axis] - region.low[axis];
      return result;
    }
    case BodyShape::polygon:
      require_flat(dimension);
      return std::fabs(polygon_moments(region.points).area);
  }
  return 0.0;
}

}  // namespace poreshock
