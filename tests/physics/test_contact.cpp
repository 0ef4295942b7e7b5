// Contact at one node: impulses, friction, gaps and their energy against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "poreshock/physics/contact.hpp"
#include "poreshock/scene/transfer_scheme.hpp"
#include "support/random_numbers.hpp"

namespace {

using namespace poreshock;

constexpr double cell = 1e-5;

Transfer transfer_of(ShapeFunction shape) {
  Transfer transfer;
  transfer.shape = shape;
  transfer.half_length = 0.25;
  return transfer;
}

const FaceTable& cubic_faces() {
  static const FaceTable faces(transfer_of(ShapeFunction::cubic));
  return faces;
}

ContactSettings settings_of(double friction, int dimension = 2) {
  return {.friction = friction,
          .gap_test = true,
          .cell = cell,
          .kept = 0.9,
          .capacity = std::pow(cell, dimension)};
}

/// Two grains that fill the node, with their face across y: a below, b above.
std::vector<NodeGrain<2>> touching(double ma, double mb, const Vector<2>& va, const Vector<2>& vb) {
  const double face = 2.0 / 3.0 * cell;
  NodeGrain<2> a{.mass = ma, .start = va, .end = va, .volume = 0.5 * cell * cell};
  NodeGrain<2> b{.mass = mb, .start = vb, .end = vb, .volume = 0.5 * cell * cell};
  a.gradient = {0.0, face};
  b.gradient = {0.0, -face};
  a.place = {0.0, -0.4 * cell};
  b.place = {0.0, 0.4 * cell};
  return {a, b};
}

template <int Dim>
double kinetic(const std::vector<NodeGrain<Dim>>& grains) {
  double sum = 0.0;
  for (const auto& g : grains) sum += 0.5 * g.mass * g.end.squaredNorm();
  return sum;
}

template <int Dim>
Vector<Dim> momentum(const std::vector<NodeGrain<Dim>>& grains) {
  Vector<Dim> sum = Vector<Dim>::Zero();
  for (const auto& g : grains) sum += g.mass * g.end;
  return sum;
}

TEST(Contact, WithoutFrictionTheNormalVelocitiesMeetWithoutHeat) {
  auto grains = touching(1e-6, 3e-6, {7.0, 100.0}, {-5.0, -300.0});
  grains[1].end = {-5.0, -500.0};
  const ContactReport report = resolve_contact<2>(grains, settings_of(0.0), cubic_faces());
  for (const auto& g : grains) {
    EXPECT_NEAR(g.start[1], -200.0, 1e-12);
    EXPECT_NEAR(g.end[1], -350.0, 1e-12);
    EXPECT_EQ(g.heat, 0.0);
  }
  EXPECT_EQ(grains[0].end[0], 7.0);
  EXPECT_EQ(grains[1].end[0], -5.0);
  EXPECT_EQ(report.pairs, 1);
  EXPECT_EQ(report.least_gap, 0.0);
  EXPECT_EQ(report.impact_heat, 0.0);
  EXPECT_EQ(report.friction_heat, 0.0);
}

// Beside a wall the start velocities stay, and the impulse heats: m_r |g| g / 2.
TEST(Contact, BesideAWallImpulsesHeat) {
  auto grains = touching(1e-6, 3e-6, {7.0, 100.0}, {-5.0, -300.0});
  ContactSettings settings = settings_of(0.0);
  settings.mirrored = true, settings.kept = 0.0;
  const ContactReport report = resolve_contact<2>(grains, settings, cubic_faces());
  EXPECT_EQ(grains[0].start[1], 100.0);
  EXPECT_NEAR(grains[0].end[1], -200.0, 1e-12);
  EXPECT_NEAR(report.impact_heat, 0.5 * 0.75e-6 * 400.0 * 400.0, 1e-15);
  EXPECT_NEAR(grains[1].heat, 0.75 * report.impact_heat, 1e-15);
}

TEST(Contact, GrainsThatPartAreLeftAlone) {
  auto grains = touching(1e-6, 3e-6, {7.0, -100.0}, {-5.0, -99.0});
  const ContactReport report = resolve_contact<2>(grains, settings_of(0.5), cubic_faces());
  EXPECT_EQ(grains[0].end, Vector<2>(7.0, -100.0));
  EXPECT_EQ(grains[1].end, Vector<2>(-5.0, -99.0));
  EXPECT_EQ(report.pairs, 0);
}

// Impulses after Bardenhagen et al. 2000: slip while m_red v_t > mu N, with the impulse N that the
// particles get, else stick: then the slip of the start stays on the particles too.
TEST(Contact, FrictionIsCoulombs) {
  const double reduced = 0.75e-6;
  for (const double kept : {0.0, 0.9}) {
    for (const double friction : {0.1, 0.5, 0.6, 2.0, 1e30}) {
      auto grains = touching(1e-6, 3e-6, {120.0, 200.0}, {0.0, 0.0});
      ContactSettings settings = settings_of(friction);
      settings.kept = kept;
      const ContactReport report = resolve_contact<2>(grains, settings, cubic_faces());
      EXPECT_NEAR(grains[0].end[1], 50.0, 1e-11);
      if (friction * 200.0 * (1.0 - kept) >= 120.0) {
        EXPECT_NEAR(grains[0].end[0], grains[1].end[0], 1e-11);
        EXPECT_NEAR(grains[0].start[0], grains[1].start[0], 1e-11);
        EXPECT_EQ(report.friction_heat, 0.0);
        continue;
      }
      const double rub = friction * reduced * 200.0 * (1.0 - kept);
      EXPECT_NEAR(grains[0].end[0], 120.0 - rub / 1e-6, 1e-11);
      EXPECT_NEAR(grains[1].end[0], rub / 3e-6, 1e-11);
      EXPECT_EQ(grains[0].start[0], 120.0);
      const double slip = 120.0 - rub / reduced, heat = rub * 0.5 * (120.0 + slip);
      EXPECT_NEAR(report.friction_heat, heat, 1e-12 * heat);
      EXPECT_NEAR(grains[0].heat, 0.5 * heat, 1e-12 * heat);
      EXPECT_EQ(grains[0].heat, grains[1].heat);
    }
  }
}

// What does not touch does not collide, however fast it closes.
TEST(Contact, GapsClose) {
  auto grains = touching(1e-6, 1e-6, {0.0, 1500.0}, {0.0, -1500.0});
  for (auto& g : grains) g.volume *= 0.9;
  auto same = grains;
  // The face stands on the node: density 2/3 per cell of width.
  const double gap = 0.1 * cell * 1.5 - touching_gap(0.0, 0.0) * cell;
  const ContactReport report = resolve_contact<2>(grains, settings_of(0.0), cubic_faces());
  EXPECT_NEAR(report.least_gap, gap, 1e-3 * gap);
  EXPECT_EQ(report.pairs, 0);
  EXPECT_EQ(grains[0].end, same[0].end);
  ContactSettings untested = settings_of(0.0);
  untested.gap_test = false;
  resolve_contact<2>(grains, untested, cubic_faces());
  EXPECT_NEAR(grains[0].end[1], grains[1].end[1], 1e-12);
}

template <int Dim>
std::vector<NodeGrain<Dim>> random_grains(reference::Random& random, int count) {
  std::vector<NodeGrain<Dim>> grains(static_cast<std::size_t>(count));
  const double full = std::pow(cell, Dim);
  for (auto& g : grains) {
    // Masses over six decades.
    g.mass = 1e-6 * std::pow(10.0, -6.0 * random.uniform());
    g.volume = full * random.uniform();
    for (int a = 0; a < Dim; ++a) {
      g.start[a] = 2000.0 * (random.uniform() - 0.5);
      g.end[a] = 2000.0 * (random.uniform() - 0.5);
      g.gradient[a] = full / cell * (random.uniform() - 0.5);
      g.place[a] = cell * (random.uniform() - 0.5);
    }
  }
  return grains;
}

template <int Dim>
double product(const std::vector<NodeGrain<Dim>>& grains, const auto& u, const auto& v) {
  double sum = 0.0;
  for (std::size_t g = 0; g < grains.size(); ++g) sum += grains[g].mass * u(g).dot(v(g));
  return sum;
}

template <int Dim>
void collide_random_grains(double friction, bool mirrored) {
  reference::Random random{friction > 0.0 ? 11U : 5U};
  for (int n = 0; n < 3000; ++n) {
    std::vector<NodeGrain<Dim>> now = random_grains<Dim>(random, 2 + n % 5);
    const std::vector<NodeGrain<Dim>> before = now;
    ContactSettings settings = settings_of(friction, Dim);
    settings.mirrored = mirrored;
    if (mirrored) settings.kept = 0.0;
    const ContactReport report = resolve_contact<Dim>(now, settings, cubic_faces());
    double heat = 0.0;
    for (const auto& g : now) heat += g.heat;
    using Velocity = Vector<Dim>;
    const auto taken = [&](std::size_t g) -> Velocity { return before[g].start - now[g].start; };
    const auto push = [&](std::size_t g) -> Velocity {
      return now[g].end - before[g].end + taken(g);
    };
    const auto middle = [&](std::size_t g) -> Velocity {
      return 0.5 * (now[g].start + now[g].end);
    };
    const auto end = [&](std::size_t g) { return now[g].end; };
    const auto start = [&](std::size_t g) { return now[g].start; };
    const double energy = kinetic(before);
    const auto one = [](int axis) {
      return [axis](std::size_t) -> Velocity { return Velocity::Unit(axis); };
    };
    for (int a = 0; a < Dim; ++a) {
      const double scale = std::sqrt(2.0 * energy * product(now, one(a), one(a)));
      ASSERT_NEAR(product(now, push, one(a)), 0.0, 1e-13 * scale);
      ASSERT_NEAR(product(now, taken, one(a)), 0.0, 1e-13 * scale);
    }
    // The impulses take the heat and nothing else, and what the start loses is orthogonal.
    ASSERT_NEAR(product(now, push, middle), -heat, 1e-11 * energy);
    ASSERT_NEAR(product(now, taken, end), 0.0, 1e-11 * energy);
    ASSERT_NEAR(product(now, taken, start), 0.0, 1e-11 * energy);
    ASSERT_NEAR(heat, report.friction_heat + report.impact_heat, 1e-12 * energy);
    ASSERT_GE(report.friction_heat, -1e-12 * energy);
    ASSERT_EQ(report.impact_heat != 0.0, mirrored && report.pairs > 0);
  }
}

// Two to six grains with any normals: momentum stays, energy closes, friction heats.
TEST(Contact, ManyGrainsKeepMomentumAndEnergy) {
  for (const double friction : {0.0, 0.3, 5.0, 1e30}) {
    for (const bool mirrored : {false, true}) {
      collide_random_grains<2>(friction, mirrored);
      collide_random_grains<3>(friction, mirrored);
    }
  }
}

// The corner of four: diagonal pairs push as well, and the cross at rest stays at rest.
TEST(Contact, FourGrainsAtACorner) {
  std::vector<NodeGrain<2>> grains(4);
  for (int g = 0; g < 4; ++g) {
    const Vector<2> outward(g % 2 == 0 ? -1.0 : 1.0, g < 2 ? -1.0 : 1.0);
    grains[static_cast<std::size_t>(g)] = {.mass = 1e-6,
                                           .start = -100.0 * outward,
                                           .end = -100.0 * outward,
                                           .volume = 0.25 * cell * cell,
                                           .gradient = -outward * (cell / 3.0),
                                           .place = outward * (0.4 * cell)};
  }
  const std::vector<NodeGrain<2>> before = grains;
  const ContactReport report = resolve_contact<2>(grains, settings_of(0.2), cubic_faces());
  EXPECT_LE(momentum(grains).norm(), 1e-13 * 4e-4);
  for (const auto& g : grains) EXPECT_LE(g.end.norm(), 0.02 * 141.4);
  EXPECT_EQ(report.impact_heat, 0.0);
  auto resting = before;
  for (auto& g : resting) g.start = g.end = {3.0, 4.0};
  const ContactReport still = resolve_contact<2>(resting, settings_of(0.2), cubic_faces());
  EXPECT_EQ(still.pairs, 0);
  for (const auto& g : resting) EXPECT_EQ(g.end, Vector<2>(3.0, 4.0));
}

// A pressure that is the same in grains which fill a node pulls each along its gradient, and moves
// none against another: at a corner of three, of four, and of any shape.
TEST(Contact, UniformPressureMovesNoGrainsThatFillTheNode) {
  reference::Random random{17U};
  for (int n = 0; n < 300; ++n) {
    const int count = 3 + n % 2;
    std::vector<NodeGrain<2>> grains(static_cast<std::size_t>(count));
    Vector<2> rest = Vector<2>::Zero();
    double left = cell * cell;
    for (int g = 0; g < count; ++g) {
      // Sectors of the node, their outward gradients roughly against their places.
      const double angle = 2.0 * std::numbers::pi * (g + 0.5 * random.uniform()) / count;
      NodeGrain<2>& grain = grains[static_cast<std::size_t>(g)];
      grain.volume = g + 1 < count ? cell * cell / count * (0.6 + 0.7 * random.uniform()) : left;
      left -= grain.volume;
      grain.mass = 2700.0 * grain.volume;
      grain.gradient = g + 1 < count
                           ? Vector<2>(-0.5 * cell * std::cos(angle), -0.5 * cell * std::sin(angle))
                           : rest;
      rest -= grain.gradient;
      grain.end = grain.gradient * (10e9 * 3e-10 / grain.mass);  // 10 GPa for one step
    }
    double fastest = 0.0;
    for (const auto& g : grains) fastest = std::max(fastest, g.end.norm());
    ContactSettings settings = settings_of(0.0);
    settings.gap_test = false;  // the sectors are not those of real faces
    resolve_contact<2>(grains, settings, cubic_faces());
    for (const auto& g : grains) ASSERT_LE(g.end.norm(), 0.01 * fastest) << "case " << n;
  }
}

double gap_of(const std::vector<NodeGrain<2>>& grains) {
  return pair_gap<2>(grains[0], grains[1], {0.0, 1.0}, fill_of<2>(grains), settings_of(0.0),
                     cubic_faces());
}

TEST(Contact, StrainedGrainsTouchEarlier) {
  EXPECT_DOUBLE_EQ(touching_gap(0.0, 0.0), 0.05);
  EXPECT_DOUBLE_EQ(touching_gap(0.05, 0.0), 0.1);
  EXPECT_DOUBLE_EQ(touching_gap(3.0, 0.0), 0.15);
  auto grains = touching(1e-6, 1e-6, {0.0, 250.0}, {0.0, -250.0});
  for (auto& g : grains) g.volume *= 0.9;
  const double fresh = gap_of(grains);
  for (auto& g : grains) g.strain = 0.05;
  EXPECT_NEAR(gap_of(grains), fresh - 0.05 * cell, 1e-12 * cell);
  for (auto& g : grains) g.strain = 1.0;
  EXPECT_NEAR(gap_of(grains), std::max(fresh - 0.1 * cell, 0.0), 1e-12 * cell);
}

// Strained faces that stand at an angle touch where the gap half a cell ahead is closed.
TEST(Contact, WedgesTouchEarlier) {
  EXPECT_DOUBLE_EQ(touching_gap(0.0, 1.0), 0.05);
  EXPECT_DOUBLE_EQ(touching_gap(0.05, 0.4), 0.2);
  EXPECT_DOUBLE_EQ(touching_gap(3.0, 0.4), 0.35);
  auto grains = touching(1e-6, 1e-6, {0.0, 250.0}, {0.0, -250.0});
  for (auto& g : grains) {
    g.volume *= 0.8;
    g.strain = 1.0;
  }
  const double parallel = gap_of(grains);
  for (auto& g : grains) g.gradient[0] = 0.02 * cell;
  const double wedge = 0.04 * cell / (2.0 / 3.0 * cell);
  EXPECT_NEAR(gap_of(grains), parallel - 0.5 * wedge * cell, 1e-12 * cell);
}

// One particle has no face: the line between the two takes its place, without friction.
TEST(Contact, GrainsWithoutFacesPushAlongTheirDistance) {
  auto grains = touching(1e-9, 1e-6, {30.0, 40.0}, {0.0, 0.0});
  for (auto& g : grains) g.gradient.setZero();
  const ContactReport report = resolve_contact<2>(grains, settings_of(0.5), cubic_faces());
  EXPECT_EQ(report.pairs, 1);
  EXPECT_EQ(grains[0].end[0], 30.0);
  EXPECT_NEAR(grains[0].end[1], grains[1].end[1], 1e-12);
  for (auto& g : grains) g.place.setZero();
  auto same = grains;
  EXPECT_EQ(resolve_contact<2>(grains, settings_of(0.5), cubic_faces()).pairs, 0);
  EXPECT_EQ(grains[0].end, same[0].end);
}

TEST(FaceTable, HoldsTheShapeFunctionByItsIntegral) {
  EXPECT_NEAR(cubic_faces().density(0.5), 2.0 / 3.0, 1e-9);
  EXPECT_NEAR(FaceTable(transfer_of(ShapeFunction::quadratic)).density(0.5), 0.75, 1e-9);
  EXPECT_NEAR(FaceTable(transfer_of(ShapeFunction::linear)).density(0.5), 1.0, 1e-9);
  // GIMP: the hat averaged over half a cell, 1 - l/2 at its middle.
  EXPECT_NEAR(FaceTable(transfer_of(ShapeFunction::gimp)).density(0.5), 0.875, 1e-9);
  // Tail of the cubic spline: u^4/24 against u^3/6.
  for (const double u : {0.1, 0.3, 0.6, 0.99}) {
    EXPECT_NEAR(cubic_faces().density(std::pow(u, 4) / 24.0), u * u * u / 6.0, 2e-4 * u);
    EXPECT_NEAR(cubic_faces().density(1.0 - std::pow(u, 4) / 24.0), u * u * u / 6.0, 2e-4 * u);
  }
  EXPECT_NEAR(cubic_faces().density(0.0), 0.0, 1e-12);
}

/// Volume and slope of a body at a node from particles that fill [low, high] of the normal and the
/// share `side` of the other axis, two per cell, cubic.
NodeGrain<2> slab(double low, double high, double side) {
  NodeGrain<2> g{.mass = 1e-6};
  const CubicSpline spline;
  for (int k = 0; low + 0.5 * k < high - 1e-9; ++k) {
    const double s = 10.0 + low + 0.25 + 0.5 * k;
    const int index = 11 - stencil_base(CubicSpline::width, s);
    if (index < 0 || index > 3) continue;
    const auto w = axis_weights(spline, s, stencil_base(CubicSpline::width, s));
    g.volume += 0.5 * w.value[index] * side * cell * cell;
    // The slope is that of the node's weight against the particle's place.
    g.gradient[1] += 0.5 * w.slope[index] * side * cell;
  }
  return g;
}

// Flat faces at any phase of the grid: touching faces touch, a gap of up to half a cell is found
// within a fifth where the faces are near the node, and never taken for less than two thirds of
// itself. At a free edge, which leaves half of the node empty, faces touch within a tenth of a
// cell.
TEST(PairGap, FlatFacesAtAnyPhase) {
  for (const double side : {1.0, 0.5}) {
    const bool edge = side < 1.0;
    for (double phase = -1.0; phase <= 1.0; phase += 0.05) {
      for (const double gap : {0.0, 0.1, 0.2, 0.5}) {
        const auto a = slab(phase - 0.5 * gap - 6.0, phase - 0.5 * gap, side);
        const auto b = slab(phase + 0.5 * gap, phase + 0.5 * gap + 6.0, side);
        const double found = gap_of({a, b}) / cell;
        const double margin = touching_gap(0.0, 0.0);
        SCOPED_TRACE(::testing::Message()
                     << "phase " << phase << " gap " << gap << " side " << side);
        if (gap == 0.0) {
          EXPECT_LE(found, edge ? 0.2 : 0.0);
          continue;
        }
        EXPECT_GE(found + margin, gap * 2.0 / 3.0);
        if (std::fabs(phase) < 0.5) {
          EXPECT_NEAR(found + margin, gap, edge ? 0.1 + 1.5 * gap : 0.2 * gap);
        }
      }
    }
  }
}

}  // namespace
