// Maps on the lattice of the particles: every value on its site, whichever rank holds the particle.

#include "poreshock/morphology/lattice_map.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/morphology/analysis.hpp"
#include "support/images.hpp"

namespace {

using namespace poreshock;
using namespace poreshock::reference;

const MPI_Comm world = MPI_COMM_WORLD;

/// The image as particles in a random order, dealt out at random.
struct Dealt {
  std::vector<std::int64_t> id;
  std::vector<double> value, number;
};

Dealt deal(const Image& image, Random& random) {
  std::vector<std::size_t> order(image.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  for (std::size_t i = order.size(); i > 1; --i) {
    std::swap(order[i - 1], order[static_cast<std::size_t>(random.below(static_cast<int>(i)))]);
  }
  Dealt dealt;
  for (const std::size_t i : order) {
    const bool mine = random.below(size(world)) == rank(world);
    if (!mine || image.solid[i] == 0) continue;
    dealt.id.push_back(static_cast<std::int64_t>(i));
    dealt.value.push_back(image.values[i]);
    dealt.number.push_back(static_cast<double>(i));
  }
  return dealt;
}

template <int Dim>
void check(const Image& image, const PixelLayout<Dim>& layout, Random& random) {
  const Dealt dealt = deal(image, random);
  const PixelGrid<Dim> grid(world, layout);
  const PixelField<Dim> map = place_on_lattice<Dim>(dealt.id, {dealt.value, dealt.number}, grid);
  ASSERT_EQ(map.values.size(), 2u);
  const std::size_t first = static_cast<std::size_t>(grid.first_row()) * grid.row_size();
  const std::size_t stored =
      static_cast<std::size_t>(map.rows + (map.last ? 0 : 1)) * grid.row_size();
  for (std::size_t i = 0; i < stored; ++i) {
    ASSERT_EQ(map.solid[i], image.solid[first + i]) << first + i;
    if (map.solid[i] == 0) {
      EXPECT_TRUE(std::isnan(map.values[0][i]));
      continue;
    }
    EXPECT_EQ(map.values[0][i], image.values[first + i]);
    EXPECT_EQ(map.values[1][i], static_cast<double>(first + i));
  }
}

TEST(LatticeMap, EveryValueOnItsSite) {
  Random random{31};
  for (int n = 0; n < 10; ++n) {
    const int width = 1 + random.below(9);
    const int depth = 1 + random.below(5);
    const int height = 4 + random.below(20);
    check<2>(random_image(Texture::noise, {width, 1, height}, {true, false}, 0.2, random),
             {{width, height}, 1e-6, {true}}, random);
    check<3>(random_image(Texture::noise, {width, depth, height}, {true, false}, 0.2, random),
             {{width, depth, height}, 1e-6, {true, false}}, random);
  }
}

TEST(LatticeMap, CountsAreThoseOfTheImage) {
  Random random{32};
  const Image image = random_image(Texture::ties, {20, 1, 17}, {true, false}, 0.1, random);
  const Dealt dealt = deal(image, random);
  const PixelGrid<2> grid(world, {{20, 17}, 1e-6, {true}});
  const std::vector<double> thresholds = {0.25, 0.5, 0.75};
  const PixelField<2> map = place_on_lattice<2>(dealt.id, {dealt.value}, grid);
  EXPECT_TRUE(count(map, 0, thresholds, world) == count_pixels_plainly(image, thresholds));
}

TEST(LatticeMap, NumbersOutsideAreRefused) {
  const PixelGrid<2> grid(world, {{4, 6}, 1e-6, {true}});
  const std::vector<std::int64_t> id = {rank(world) == 0 ? std::int64_t{24} : std::int64_t{3}};
  const std::vector<double> value = {1.0};
  EXPECT_THROW(place_on_lattice<2>(id, {value}, grid), InputError);
}

}  // namespace
