// Shape functions: the sums that make transfers conserve, the formulas, and the stencil cell.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "poreshock/core/shape.hpp"
#include "support/random_numbers.hpp"
#include "support/scalar_transfer.hpp"

namespace poreshock {
namespace {

/// Points of a domain of 12 cells: random ones, whole and half cells, and their neighbours.
std::vector<double> sample_points() {
  std::vector<double> points;
  reference::Random random{11};
  for (int k = 0; k < 1000; ++k) points.push_back(12.0 * random.uniform());
  for (int k = 0; k < 24; ++k) {
    points.push_back(0.5 * k);
    points.push_back(std::nextafter(0.5 * k, 13.0));
    points.push_back(std::nextafter(0.5 * k + 0.5, 0.0));
  }
  return points;
}

template <class Spline>
int base_of(double s) {
  return stencil_base(Spline::width, s);
}

template <class Spline>
class Shape : public ::testing::Test {};
template <class... Type>
::testing::Types<Type...> list_of(const std::tuple<Type...>&);
TYPED_TEST_SUITE(Shape, decltype(list_of(ShapeFunctions{})));

/// The same shape as the reference names it.
template <class Type>
GridShape named_shape() {
  GridShape shape;
  shape.half_length = 0.25;
  shape.function = Type::kind;
  return shape;
}

TYPED_TEST(Shape, SumsToOneAndPlacesTheParticle) {
  for (const double s : sample_points()) {
    const int base = base_of<TypeParam>(s);
    const auto w = axis_weights(TypeParam{}, s, base);
    double one = 0.0, first = 0.0, second = 0.0, place = 0.0;
    double slope = 0.0, slope_first = 0.0, slope_second = 0.0;
    for (int i = 0; i < TypeParam::width; ++i) {
      EXPECT_GE(w.value[i], 0.0) << s;
      EXPECT_NEAR(w.offset[i], (base + i - 1) - s, 1e-15) << s;
      one += w.value[i];
      first += w.value[i] * w.offset[i];
      second += w.value[i] * w.offset[i] * w.offset[i];
      place += w.value[i] * (base + i - 1);
      slope += w.slope[i];
      slope_first += w.slope[i] * w.offset[i];
      slope_second += w.slope[i] * w.offset[i] * w.offset[i];
    }
    EXPECT_NEAR(one, 1.0, 1e-15) << s;
    EXPECT_NEAR(first, 0.0, 1e-15) << s;
    EXPECT_NEAR(place, s, 1e-15 * std::max(s, 1.0)) << s;
    EXPECT_NEAR(slope, 0.0, 1e-15) << s;
    EXPECT_NEAR(slope_first, 1.0, 1e-15) << s;
    if constexpr (has_inertia<TypeParam>) {
      constexpr double inertia = TypeParam::width == 3 ? 1.0 / 4.0 : 1.0 / 3.0;
      EXPECT_EQ(1.0 / TypeParam::inverse_inertia, inertia);
      EXPECT_NEAR(second, inertia, 1e-15) << s;
      EXPECT_NEAR(slope_second, 0.0, 1e-15) << s;
    }
  }
}

TYPED_TEST(Shape, StiffnessIsTheMostOfAllPlaces) {
  if constexpr (has_inertia<TypeParam>) {
    double most = 0.0;
    for (int k = 0; k <= 1000; ++k) {
      const double s = 7.0 + k / 1000.0;
      const auto w = axis_weights(TypeParam{}, s, base_of<TypeParam>(s));
      double sum = 0.0;
      for (int i = 0; i < TypeParam::width; ++i) {
        if (w.value[i] > 0.0) sum += w.slope[i] * w.slope[i] / w.value[i];
      }
      most = std::max(most, sum);
    }
    EXPECT_LE(most, TypeParam::stiffness * (1.0 + 1e-12));
    EXPECT_GT(most, 0.995 * TypeParam::stiffness);
  }
}

TYPED_TEST(Shape, IsThatOfTheTextbook) {
  const GridShape shape = named_shape<TypeParam>();
  for (const double s : sample_points()) {
    const int base = base_of<TypeParam>(s);
    const auto w = axis_weights(TypeParam{}, s, base);
    for (int i = 0; i < TypeParam::width; ++i) {
      const double r = s - (base + i - 1);
      EXPECT_NEAR(w.value[i], reference::spline(shape, r), 1e-15) << s;
      EXPECT_NEAR(w.slope[i], reference::spline_slope(shape, r), 1e-15) << s;
    }
  }
}

// The gradient of linear fields is exact with them, and forces sum to zero.
TYPED_TEST(Shape, FirstMomentsMayStandForSlopes) {
  if constexpr (has_inertia<TypeParam>) {
    TypeParam spline;
    spline.gradient = Gradient::moments;
    constexpr double inertia = TypeParam::width == 3 ? 1.0 / 4.0 : 1.0 / 3.0;
    const GridShape shape = named_shape<TypeParam>();
    for (const double s : sample_points()) {
      const int base = base_of<TypeParam>(s);
      const auto w = axis_weights(spline, s, base);
      double sum = 0.0, first = 0.0;
      for (int i = 0; i < TypeParam::width; ++i) {
        const double r = s - (base + i - 1);
        EXPECT_NEAR(w.value[i], reference::spline(shape, r), 1e-15) << s;
        EXPECT_NEAR(w.slope[i], -r * reference::spline(shape, r) / inertia, 4e-15) << s;
        sum += w.slope[i];
        first += w.slope[i] * w.offset[i];
      }
      EXPECT_NEAR(sum, 0.0, 4e-15) << s;
      EXPECT_NEAR(first, 1.0, 4e-15) << s;
    }
  }
}

TYPED_TEST(Shape, SlopeIsTheDerivativeOfTheValue) {
  constexpr double h = 1e-5;
  reference::Random random{4};
  for (int k = 0; k < 1000; ++k) {
    // Away from the joints, where the third derivative jumps.
    const double s = random.below(12) + 0.5 * random.below(2) + 0.001 + 0.248 * random.uniform();
    const int base = base_of<TypeParam>(s);
    const auto low = axis_weights(TypeParam{}, s - h, base);
    const auto middle = axis_weights(TypeParam{}, s, base);
    const auto high = axis_weights(TypeParam{}, s + h, base);
    for (int i = 0; i < TypeParam::width; ++i) {
      EXPECT_NEAR(middle.slope[i], (high.value[i] - low.value[i]) / (2.0 * h), 1e-10) << s;
    }
  }
}

TYPED_TEST(Shape, IsContinuousWhereTheStencilChanges) {
  for (int cell = 1; cell < 11; ++cell) {
    const double s = TypeParam::width % 2 == 0 ? cell : cell + 0.5;
    const int base = base_of<TypeParam>(s);
    const double before = std::nextafter(s, 0.0);
    ASSERT_EQ(base_of<TypeParam>(before), base - 1);
    const auto here = axis_weights(TypeParam{}, s, base);
    const auto there = axis_weights(TypeParam{}, before, base - 1);
    EXPECT_NEAR(there.value[0], 0.0, 2e-15);
    EXPECT_NEAR(here.value[TypeParam::width - 1], 0.0, 1e-15);
    for (int i = 0; i + 1 < TypeParam::width; ++i) {
      EXPECT_NEAR(here.value[i], there.value[i + 1], 2e-15);
      if (TypeParam::smoothness > 0) {
        EXPECT_NEAR(here.slope[i], there.slope[i + 1], 4e-15);
      }
    }
  }
}

TEST(StencilCell, OfTheQuadraticSplineChangesAtHalfCells) {
  EXPECT_EQ(base_of<QuadraticSpline>(0.0), 0);
  EXPECT_EQ(base_of<QuadraticSpline>(std::nextafter(0.5, 0.0)), 0);
  EXPECT_EQ(base_of<QuadraticSpline>(0.5), 1);
  EXPECT_EQ(base_of<QuadraticSpline>(1.0), 1);
  EXPECT_EQ(base_of<QuadraticSpline>(std::nextafter(1.5, 0.0)), 1);
  EXPECT_EQ(base_of<QuadraticSpline>(1.5), 2);
  EXPECT_EQ(base_of<QuadraticSpline>(1000.5), 1001);
  EXPECT_EQ(base_of<QuadraticSpline>(std::nextafter(1000.5, 0.0)), 1000);
}

TEST(StencilCell, OfTheHatChangesAtWholeCells) {
  EXPECT_EQ(base_of<LinearHat>(0.0), 1);
  EXPECT_EQ(base_of<LinearHat>(std::nextafter(1.0, 0.0)), 1);
  EXPECT_EQ(base_of<LinearHat>(1.0), 2);
}

TEST(StencilCell, OfTheCubicSplineChangesAtWholeCells) {
  EXPECT_EQ(base_of<CubicSpline>(0.0), 0);
  EXPECT_EQ(base_of<CubicSpline>(std::nextafter(1.0, 0.0)), 0);
  EXPECT_EQ(base_of<CubicSpline>(1.0), 1);
  EXPECT_EQ(base_of<CubicSpline>(1.5), 1);
  EXPECT_EQ(base_of<CubicSpline>(1000.0), 1000);
  EXPECT_EQ(base_of<CubicSpline>(std::nextafter(1000.0, 0.0)), 999);
}

TYPED_TEST(Shape, TellsWhichMomentsAreConstant) {
  const auto moment = [](double s, int order) {
    const int base = base_of<TypeParam>(s);
    const auto w = axis_weights(TypeParam{}, s, base);
    double sum = 0.0;
    for (int i = 0; i < TypeParam::width; ++i) sum += w.value[i] * std::pow(w.offset[i], order);
    return sum;
  };
  for (int order = 0; order <= TypeParam::constant_moments + 1; ++order) {
    double change = 0.0;
    for (const double s : sample_points()) {
      change = std::max(change, std::abs(moment(s, order) - moment(5.0, order)));
    }
    if (order <= TypeParam::constant_moments) {
      EXPECT_LE(change, 2e-15) << order;
    } else {
      EXPECT_GE(change, 0.02) << order;
    }
  }
}

// The function of a node one cell inside a plane, summed beyond the plane.
TYPED_TEST(Shape, TellsWhatLiesBeyondAPlane) {
  constexpr int steps = 4000;
  double beyond = 0.0;
  for (int k = 0; k < steps; ++k) {
    const double s = 9.0 - (k + 0.5) / steps;  // node 11 lies at 10, the plane at 9
    const int base = base_of<TypeParam>(s);
    const int node = 11 - base;
    if (node >= TypeParam::width) continue;
    beyond += axis_weights(TypeParam{}, s, base).value[static_cast<std::size_t>(node)] / steps;
  }
  EXPECT_NEAR(TypeParam{}.share_beyond(), beyond, 1e-7);
}

TYPED_TEST(Shape, StencilStaysOnTheGridInTheWholeDomain) {
  constexpr int cells = 12, nodes = cells + 3;
  for (const double s : sample_points()) {
    const int base = base_of<TypeParam>(s);
    EXPECT_GE(base, 0) << s;
    EXPECT_LE(base + TypeParam::width, nodes) << s;
  }
}

}  // namespace
}  // namespace poreshock
