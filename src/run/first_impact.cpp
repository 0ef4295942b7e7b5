#include "first_impact.hpp"

#include <algorithm>
#include <limits>

#include "poreshock/sample/bodies.hpp"

namespace poreshock {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// A box of material that flies as one.
struct Flying {
  Box box;
  Triple velocity{};  ///< m/s
};

std::vector<Flying> flying_boxes(const Scene& scene, const SampleReport& report) {
  const auto shock = static_cast<std::size_t>(scene.dimension - 1);
  Flying sample;
  sample.box.high = scene.domain.size;
  sample.box.high[shock] = scene.sample.height;
  sample.velocity = scene.loading.frame;
  sample.velocity[shock] -= scene.loading.velocity;
  std::vector<Flying> boxes;
  if (scene.sample.kind != SampleKind::none) boxes.push_back(sample);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    if (report.bodies.at(b).left == 0) continue;
    Flying body = {bounding_box(scene.bodies[b].region), sample.velocity};
    for (std::size_t a = 0; a <= shock; ++a) {
      body.box.low[a] = std::max(body.box.low[a], 0.0);
      body.box.high[a] = std::min(body.box.high[a], scene.domain.size[a]);
      body.velocity[a] += scene.bodies[b].velocity[a];
    }
    boxes.push_back(body);
  }
  return boxes;
}

/// Time until a gap (m) closes at a speed (m/s).
double closing(double gap, double speed) {
  return speed > 0.0 ? std::max(gap, 0.0) / speed : never;
}

double hits_side(const Scene& scene, const Flying& f) {
  double first = never;
  for (int axis = 0; axis < scene.dimension; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const Side low = side_at(scene.boundary, axis, false, scene.dimension);
    const Side high = side_at(scene.boundary, axis, true, scene.dimension);
    const double own = f.velocity[a] - scene.loading.frame[a];
    if (side_law(low.kind).mirrors) {
      first = std::min(first, closing(f.box.low[a], low.velocity - own));
    }
    if (side_law(high.kind).mirrors) {
      first = std::min(first, closing(scene.domain.size[a] - f.box.high[a], own - high.velocity));
    }
  }
  return first;
}

/// When two boxes meet, the second moved by `shift` (m) along each axis.
double meets(const Flying& a, const Flying& b, const Triple& shift, int dimension) {
  double begin = 0.0, end = never;
  bool approach = false;
  for (std::size_t i = 0; i < static_cast<std::size_t>(dimension); ++i) {
    const double speed = b.velocity[i] - a.velocity[i];
    const double below = a.box.low[i] - (b.box.high[i] + shift[i]);
    const double above = a.box.high[i] - (b.box.low[i] + shift[i]);
    if (speed == 0.0) {
      if (below >= 0.0 || above <= 0.0) return never;
      continue;
    }
    approach = true;
    begin = std::max(begin, (speed > 0.0 ? below : above) / speed);
    end = std::min(end, (speed > 0.0 ? above : below) / speed);
  }
  return approach && begin < end ? begin : never;
}

double meets_any_image(const Scene& scene, const Flying& a, const Flying& b) {
  const auto images = [&](std::size_t axis) {
    return axis + 1 < static_cast<std::size_t>(scene.dimension) && scene.domain.periodic[axis] ? 1
                                                                                               : 0;
  };
  double first = never;
  for (int i = -images(0); i <= images(0); ++i) {
    for (int j = -images(1); j <= images(1); ++j) {
      const Triple shift = {i * scene.domain.size[0], j * scene.domain.size[1], 0.0};
      first = std::min(first, meets(a, b, shift, scene.dimension));
    }
  }
  return first;
}

}  // namespace

double first_impact(const Scene& scene, const SampleReport& report) {
  const std::vector<Flying> boxes = flying_boxes(scene, report);
  double first = never;
  for (const Flying& f : boxes) first = std::min(first, hits_side(scene, f));
  for (std::size_t b = 0; b < boxes.size() && first > scene.time.end; ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      first = std::min(first, meets_any_image(scene, boxes[a], boxes[b]));
    }
  }
  return first;
}

bool moves_by_itself(const Scene& scene) {
  const auto& m = scene.materials;
  const bool warms = conducts_heat(scene) && std::any_of(m.begin(), m.end(), [&](const auto& x) {
                       return x.T0 != m.front().T0;
                     });
  const bool spins = std::any_of(scene.bodies.begin(), scene.bodies.end(),
                                 [](const Body& b) { return b.spin != Triple{}; });
  return warms || spins || scene.body_force != Triple{};
}

}  // namespace poreshock
