// Counts of random sets whose means on the lattice of the pixels are known exactly, at any
// resolution: Poisson discs (the Boolean model, Stoyan, Kendall and Mecke 1995) and a smoothed,
// thresholded Gaussian noise. Every mean is compared within 4.5 standard errors of the mean of many
// images.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "support/images.hpp"

namespace {

using namespace poreshock;
using namespace poreshock::reference;

/// Chances that 1, 2 neighbouring, 2 diagonal and 4 pixels of a square are all black.
struct Black {
  double one, two, diagonal, four;
};

/// A statistic of many images.
struct Mean {
  double sum = 0.0, squares = 0.0;
  int count = 0;

  void add(double value) {
    sum += value;
    squares += value * value;
    ++count;
  }
  /// Distance from `expected` in standard errors.
  double score(double expected) const {
    const double mean = sum / count;
    const double variance = (squares / count - mean * mean) * count / (count - 1.0);
    return (mean - expected) / std::sqrt(variance / count);
  }
};

/// Compares images on a cylinder of W x H pixels with the means that follow from the chances.
class Expectation {
 public:
  void add(const Image& image, double threshold) {
    width_ = image.width;
    height_ = image.height;
    const double thresholds[] = {threshold};
    const PixelCounts c = count_whole(image, thresholds);
    faces_.add(static_cast<double>(c.F[0]));
    sides_.add(static_cast<double>(c.B_int[0]));
    axial_.add(static_cast<double>(c.B_axial[0]));
    diagonals_.add(static_cast<double>(c.D_int[0]));
    chi_.add(static_cast<double>(c.V[0] - c.E[0] + c.F[0]));
  }

  void check(const Black& black) const {
    const double across = width_ * height_, up = width_ * (height_ - 1.0), frame = 2.0 * width_;
    EXPECT_LT(std::abs(faces_.score(across * (1.0 - black.one))), 4.5);
    EXPECT_LT(std::abs(sides_.score(2.0 * (across + up) * (black.one - black.two))), 4.5);
    EXPECT_LT(std::abs(axial_.score(2.0 * up * (black.one - black.two))), 4.5);
    EXPECT_LT(std::abs(diagonals_.score(4.0 * up * (black.one - black.diagonal))), 4.5);
    const double vertices = up * (1.0 - black.four) + frame * (1.0 - black.two);
    const double edges = (across + up) * (1.0 - black.two) + frame * (1.0 - black.one);
    EXPECT_LT(std::abs(chi_.score(vertices - edges + across * (1.0 - black.one))), 4.5);
  }

 private:
  int width_ = 0, height_ = 0;
  Mean faces_, sides_, axial_, diagonals_, chi_;
};

Image blank(int width, int height) {
  Image image;
  image.width = width;
  image.height = height;
  image.periodic = true;
  image.values.assign(image.size(), 0.0);
  image.solid.assign(image.size(), 1);
  return image;
}

/// A Poisson number by counting exponential gaps.
int poisson(double mean, Random& random) {
  int count = 0;
  for (double gap = -std::log(1.0 - random.uniform()); gap < mean; ++count)
    gap -= std::log(1.0 - random.uniform());
  return count;
}

/// Discs of radius R, `density` per pixel, in white on black; x wraps.
Image discs(int width, int height, double radius, double density, Random& random) {
  Image image = blank(width, height);
  const double margin = radius + 1.0;
  const int count = poisson(density * width * (height + 2.0 * margin), random);
  for (int n = 0; n < count; ++n) {
    const double cx = width * random.uniform();
    const double cz = (height + 2.0 * margin) * random.uniform() - margin - 0.5;
    for (int z = std::max(0, static_cast<int>(cz - margin));
         z < std::min(height, static_cast<int>(cz + margin) + 1); ++z) {
      for (int x = static_cast<int>(std::floor(cx - margin)); x <= cx + margin; ++x) {
        if (std::hypot(x - cx, z - cz) > radius) continue;
        const int place = (x + width) % width + width * z;
        image.values[static_cast<std::size_t>(place)] = 1.0;
      }
    }
  }
  return image;
}

/// Area of the union of two discs whose centres are `apart`.
double union_of_two(double radius, double apart) {
  const double half = 0.5 * apart;
  const double strip =
      half * std::sqrt(radius * radius - half * half) + radius * radius * std::asin(half / radius);
  return std::numbers::pi * radius * radius + 2.0 * strip;
}

TEST(RandomSets, PoissonDiscsHaveTheirExactMeans) {
  Random random{101};
  for (const auto& [radius, density] :
       {std::array{1.5, 0.08}, std::array{3.2, 0.02}, std::array{6.0, 0.01}}) {
    Expectation expectation;
    for (int n = 0; n < 60; ++n) expectation.add(discs(90, 70, radius, density, random), 0.5);
    const double one = std::numbers::pi * radius * radius;
    const double two = union_of_two(radius, 1.0);
    const auto black = [d = density](double area) { return std::exp(-d * area); };
    SCOPED_TRACE(radius);
    expectation.check({black(one), black(two), black(union_of_two(radius, std::numbers::sqrt2)),
                       black(2.0 * two - one + 1.0)});
  }
}

/// Nodes and weights of Gauss and Legendre with 8 points on -1 ... 1, the positive half.
constexpr std::array<double, 4> node = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                        0.9602898564975363};
constexpr std::array<double, 4> weight = {0.3626837833783620, 0.3137066458778873,
                                          0.2223810344533745, 0.1012285362903763};

/// Integral over 0 ... end in four pieces.
template <class Function>
double integrate(double end, Function f) {
  double sum = 0.0;
  for (int piece = 0; piece < 4; ++piece) {
    const double half = 0.125 * end, middle = (2 * piece + 1) * half;
    for (std::size_t k = 0; k < 4; ++k)
      sum += half * weight[k] * (f(middle - half * node[k]) + f(middle + half * node[k]));
  }
  return sum;
}

double below(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

/// P(X < a, Y < b) of standard normal numbers of correlation r (Plackett, Biometrika 41 (1954)
/// 351).
double both_below(double a, double b, double r) {
  const double integral = integrate(std::asin(r), [&](double t) {
    const double c = std::cos(t);
    return std::exp(-(a * a + b * b - 2.0 * a * b * std::sin(t)) / (2.0 * c * c));
  });
  return below(a) * below(b) + integral / (2.0 * std::numbers::pi);
}

/// Chance that two numbers are below `nu` when two others are `nu`; correlations between the pairs:
/// r of the given ones, s of the others, p and q of the first of the others with them, and q and p
/// of the second.
double rest_below(double nu, double r, double s, double p, double q) {
  const double mean = nu * (p + q) / (1.0 + r);
  const double variance = 1.0 - (p * p + q * q - 2.0 * r * p * q) / (1.0 - r * r);
  const double covariance = s - (2.0 * p * q - r * (p * p + q * q)) / (1.0 - r * r);
  const double a = (nu - mean) / std::sqrt(variance);
  return both_below(a, a, covariance / variance);
}

/// P(all four pixels of a square < nu), by Plackett's identity along correlations t times the true
/// ones: x and z of neighbours, d of diagonals.
double four_below(double nu, double x, double z, double d) {
  const auto pair = [&](double t, double r, double p, double q) {
    const double c = t * r;
    const double density =
        std::exp(-nu * nu / (1.0 + c)) / (2.0 * std::numbers::pi * std::sqrt(1.0 - c * c));
    return 2.0 * r * density * rest_below(nu, c, c, t * p, t * q);
  };
  const double grown = integrate(
      1.0, [&](double t) { return pair(t, x, z, d) + pair(t, z, x, d) + pair(t, d, x, z); });
  return std::pow(below(nu), 4) + grown;
}

/// A number with the normal distribution (Box and Muller).
double normal(Random& random) {
  return std::sqrt(-2.0 * std::log(1.0 - random.uniform())) *
         std::cos(2.0 * std::numbers::pi * random.uniform());
}

/// Noise smoothed by the weights along both axes, with variance 1; x wraps.
Image smoothed(int width, int height, const std::vector<double>& weights, Random& random) {
  const int reach = static_cast<int>(weights.size());
  double scale = 0.0;
  for (const double w : weights) scale += w * w;
  std::vector<double> noise(static_cast<std::size_t>(width * (height + reach)));
  for (double& value : noise) value = normal(random);
  Image image = blank(width, height);
  for (int z = 0; z < height; ++z) {
    for (int x = 0; x < width; ++x) {
      double sum = 0.0;
      for (int j = 0; j < reach; ++j) {
        for (int i = 0; i < reach; ++i) {
          const int place = (x + i) % width + width * (z + j);
          sum += weights[static_cast<std::size_t>(i)] * weights[static_cast<std::size_t>(j)] *
                 noise[static_cast<std::size_t>(place)];
        }
      }
      const int place = x + width * z;
      image.values[static_cast<std::size_t>(place)] = sum / scale;
    }
  }
  return image;
}

TEST(RandomSets, SmoothedNoiseHasItsExactMeans) {
  EXPECT_NEAR(four_below(0.0, 0.0, 0.0, 0.0), 1.0 / 16.0, 1e-12);
  // Rows that know nothing of one another.
  EXPECT_NEAR(four_below(0.5, 0.6, 0.0, 0.0), std::pow(both_below(0.5, 0.5, 0.6), 2), 1e-9);
  Random random{202};
  for (const std::vector<double>& weights :
       {std::vector<double>{1, 2, 1}, std::vector<double>{1, 4, 6, 4, 1}}) {
    double squares = 0.0, products = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      squares += weights[i] * weights[i];
      if (i + 1 < weights.size()) products += weights[i] * weights[i + 1];
    }
    const double r = products / squares;
    std::array<Expectation, 3> expectation;
    constexpr std::array<double, 3> levels = {-0.5, 0.0, 1.2};
    for (int n = 0; n < 60; ++n) {
      const Image image = smoothed(80, 64, weights, random);
      for (std::size_t k = 0; k < levels.size(); ++k) expectation[k].add(image, levels[k]);
    }
    for (std::size_t k = 0; k < levels.size(); ++k) {
      const double nu = levels[k];
      SCOPED_TRACE(nu);
      expectation[k].check({below(nu), both_below(nu, nu, r), both_below(nu, nu, r * r),
                            four_below(nu, r, r, r * r)});
    }
  }
}

}  // namespace
