#include "union_area.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cell_list.hpp"

namespace poreshock {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

struct Interval {
  double begin = 0.0;
  double end = 0.0;
};

/// Adds the angles centre - half ... centre + half, brought into [0, 2 pi).
void cover(double centre, double half, std::vector<Interval>& covered) {
  double begin = centre - half;
  if (begin < 0.0) begin += two_pi;
  if (begin >= two_pi) begin -= two_pi;
  const double end = begin + 2.0 * half;
  if (end <= two_pi) {
    covered.push_back({begin, end});
  } else {
    covered.push_back({begin, two_pi});
    covered.push_back({0.0, end - two_pi});
  }
}

double safe_acos(double x) {
  return std::acos(std::clamp(x, -1.0, 1.0));
}

/// Covers the angles whose points lie beyond a straight side at `distance` from the centre along
/// the outward direction `normal` (angle).
void cover_beyond(double distance, double radius, double normal, std::vector<Interval>& covered) {
  if (distance >= radius) return;
  cover(normal, safe_acos(distance / radius), covered);
}

/// Covers the angles of disc i that lie inside disc j; returns true when that is all of them.
bool cover_inside(const std::vector<Disc>& discs, std::size_t i, std::size_t j,
                  std::vector<Interval>& covered) {
  const Disc& a = discs[i];
  const Disc& b = discs[j];
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double distance = std::sqrt(dx * dx + dy * dy);
  if (distance >= a.radius + b.radius) return false;
  if (distance + a.radius <= b.radius) {
    // Of two equal discs in one place the first stays.
    return distance > 0.0 || a.radius < b.radius || j < i;
  }
  if (distance + b.radius <= a.radius) return false;
  const double square = distance * distance + (a.radius * a.radius - b.radius * b.radius);
  cover(std::atan2(dy, dx), safe_acos(square / (2.0 * distance * a.radius)), covered);
  return false;
}

/// Integral of -y dx along the arc from angle begin to end.
double arc_area(const Disc& disc, double begin, double end) {
  const double r = disc.radius;
  const double level = disc.y * r * (std::cos(begin) - std::cos(end));
  const double sector =
      0.5 * (r * r) * ((end - begin) - 0.5 * (std::sin(2.0 * end) - std::sin(2.0 * begin)));
  return level + sector;
}

/// The same integral over all angles that are not covered.
double free_arcs_area(const Disc& disc, std::vector<Interval>& covered) {
  if (covered.empty()) return std::numbers::pi * (disc.radius * disc.radius);
  std::sort(covered.begin(), covered.end(),
            [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
  double area = 0.0;
  double reached = 0.0;
  for (const Interval& c : covered) {
    if (c.begin > reached) area += arc_area(disc, reached, c.begin);
    reached = std::max(reached, c.end);
  }
  if (reached < two_pi) area += arc_area(disc, reached, two_pi);
  return area;
}

/// Covered length of the rectangle's top side.
double covered_top(const std::vector<Disc>& discs, double width, double height) {
  std::vector<Interval> covered;
  for (const Disc& d : discs) {
    const double up = height - d.y;
    if (std::fabs(up) >= d.radius) continue;
    const double half = std::sqrt(d.radius * d.radius - up * up);
    covered.push_back({std::max(d.x - half, 0.0), std::min(d.x + half, width)});
  }
  std::sort(covered.begin(), covered.end(),
            [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
  double length = 0.0;
  double reached = 0.0;
  for (const Interval& c : covered) {
    // The second test drops images that lie beside the rectangle.
    if (c.end <= reached || c.end <= c.begin) continue;
    length += c.end - std::max(c.begin, reached);
    reached = c.end;
  }
  return length;
}

}  // namespace

double union_area(const std::vector<Disc>& discs, double width, double height) {
  double largest = 0.0;
  for (const Disc& d : discs) largest = std::max(largest, d.radius);
  if (largest <= 0.0) return 0.0;
  const Block rectangle{.dimension = 2, .size = {width, height, 0.0}, .periodic = {}};
  CellList cells = make_cell_list(rectangle, 2.0 * largest, discs.size());
  for (std::size_t i = 0; i < discs.size(); ++i) {
    insert({discs[i].x, discs[i].y, 0.0}, static_cast<int>(i), cells);
  }
  // -y dx vanishes on the bottom and on the upright sides, so only arcs and the top count.
  double area = height * covered_top(discs, width, height);
  std::vector<Interval> covered;
  for (std::size_t i = 0; i < discs.size(); ++i) {
    const Disc& d = discs[i];
    covered.clear();
    const bool hidden = any_near(cells, {d.x, d.y, 0.0}, [&](int j) {
      return static_cast<std::size_t>(j) != i &&
             cover_inside(discs, i, static_cast<std::size_t>(j), covered);
    });
    if (hidden) continue;
    cover_beyond(width - d.x, d.radius, 0.0, covered);
    cover_beyond(height - d.y, d.radius, 0.5 * std::numbers::pi, covered);
    cover_beyond(d.x, d.radius, std::numbers::pi, covered);
    cover_beyond(d.y, d.radius, 1.5 * std::numbers::pi, covered);
    area += free_arcs_area(d, covered);
  }
  return area;
}

std::vector<Disc> with_images(const std::vector<Disc>& discs, double width, double height,
                              bool periodic_x, bool periodic_y) {
  std::vector<Disc> result;
  result.reserve(discs.size() + discs.size() / 4);
  const int most_x = periodic_x ? 1 : 0;
  const int most_y = periodic_y ? 1 : 0;
  for (const Disc& d : discs) {
    for (int j = -most_y; j <= most_y; ++j) {
      for (int i = -most_x; i <= most_x; ++i) {
        const Disc image{d.x + i * width, d.y + j * height, d.radius};
        const bool inside = image.x + d.radius > 0.0 && image.x - d.radius < width &&
                            image.y + d.radius > 0.0 && image.y - d.radius < height;
        if (inside) result.push_back(image);
      }
    }
  }
  return result;
}

}  // namespace poreshock
