// The one list of columns, and all that is derived from it.
#include <gtest/gtest.h>

#include <cstddef>
#include <set>

#include "particles/numbered.hpp"

namespace poreshock {
namespace {

using test::first_wrong_number;
using test::numbered_particles;

constexpr ParticleOptions everything{true, true, true, true, true, true};

template <int Dim>
std::vector<std::string> column_names(ParticleOptions options) {
  Particles<Dim> particles;
  particles.options = options;
  std::vector<std::string> names;
  for_each_column(particles, [&](std::string_view name, int component, auto&) {
    names.push_back(std::string(name) + (component < 0 ? "" : std::to_string(component)));
  });
  return names;
}

template <int Dim>
void expect_every_member_is_listed() {
  // All members but the options are vectors of one size: counting bytes finds a forgotten one.
  Particles<Dim> particles;
  const auto* begin = reinterpret_cast<const std::byte*>(&particles);
  const auto* first = reinterpret_cast<const std::byte*>(&particles.id);
  const std::size_t members =
      (sizeof(particles) - static_cast<std::size_t>(first - begin)) / sizeof(std::vector<double>);
  const std::vector<std::string> names = column_names<Dim>(everything);
  EXPECT_EQ(names.size(), members);
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), members);
}

TEST(Columns, ListCoversEveryMemberOnce) {
  expect_every_member_is_listed<2>();
  expect_every_member_is_listed<3>();
}

TEST(Columns, HaveTheOrderOfTheCheckpointFormat) {
  EXPECT_EQ(column_names<2>(everything), (std::vector<std::string>{"id",
                                                                   "grain",
                                                                   "material",
                                                                   "position0",
                                                                   "position1",
                                                                   "velocity0",
                                                                   "velocity1",
                                                                   "affine0",
                                                                   "affine1",
                                                                   "affine2",
                                                                   "affine3",
                                                                   "quadratic0",
                                                                   "quadratic1",
                                                                   "quadratic2",
                                                                   "quadratic3",
                                                                   "quadratic4",
                                                                   "quadratic5",
                                                                   "mass",
                                                                   "density",
                                                                   "pressure",
                                                                   "viscous_pressure",
                                                                   "internal_energy",
                                                                   "plastic_strain",
                                                                   "plastic_work",
                                                                   "deviator0",
                                                                   "deviator1",
                                                                   "deviator2",
                                                                   "deviator3",
                                                                   "back_stress0",
                                                                   "back_stress1",
                                                                   "back_stress2",
                                                                   "back_stress3",
                                                                   "conducted_heat",
                                                                   "failed",
                                                                   "facing0",
                                                                   "facing1"}));
  EXPECT_EQ(column_names<3>(everything).size(), 3u + 3u + 3u + 9u + 18u + 7u + 6u + 6u + 2u + 3u);
}

TEST(Columns, OfUnusedOptionsAreLeftOut) {
  for (const std::string& name : column_names<3>({false, false, false, false, false})) {
    for (const char* unused : {"affine", "quadratic", "back_stress", "conducted_heat", "failed"}) {
      EXPECT_EQ(name.find(unused), std::string::npos);
    }
  }
  Particles<2> particles;
  particles.options = {false, false, false};
  resize(particles, 5);
  EXPECT_EQ(particles.affine[3].size(), 0u);
  EXPECT_EQ(particles.quadratic[5].size(), 0u);
  EXPECT_EQ(particles.back_stress[0].size(), 0u);
  EXPECT_EQ(particles.deviator[3].size(), 5u);
}

TEST(Columns, ResizeKeepsWhatIsThereAndAddsZeros) {
  Particles<3> particles = numbered_particles<3>(everything, {4, 5, 6});
  resize(particles, 5);
  EXPECT_EQ(particles.size(), 5u);
  for_each_column(particles, [](std::string_view name, int, const auto& column) {
    ASSERT_EQ(column.size(), 5u) << name;
    EXPECT_TRUE(column[3] == 0 && column[4] == 0) << name;
  });
  resize(particles, 2);
  EXPECT_EQ(particles.id, (std::vector<std::int64_t>{4, 5}));
  EXPECT_EQ(first_wrong_number(particles), "");
}

TEST(Columns, ReorderMovesWholeParticles) {
  Particles<2> particles = numbered_particles<2>(everything, {10, 11, 12, 13, 14});
  reorder({4, 0, 3, 1, 2}, particles);
  EXPECT_EQ(particles.id, (std::vector<std::int64_t>{14, 10, 13, 11, 12}));
  EXPECT_EQ(first_wrong_number(particles), "");
  reorder({3, 0}, particles);
  EXPECT_EQ(particles.id, (std::vector<std::int64_t>{11, 14}));
  EXPECT_EQ(first_wrong_number(particles), "");
}

TEST(Columns, ReorderKeepsTheFirstInPlace) {
  Particles<3> particles = numbered_particles<3>(everything, {10, 11, 12, 13, 14});
  reorder({4, 2, 3}, particles, 2);
  EXPECT_EQ(particles.id, (std::vector<std::int64_t>{10, 11, 14, 12, 13}));
  EXPECT_EQ(first_wrong_number(particles), "");
  reorder({4}, particles, 1);
  EXPECT_EQ(particles.id, (std::vector<std::int64_t>{10, 13}));
  EXPECT_EQ(first_wrong_number(particles), "");
}

template <int Dim>
void expect_packing_keeps_every_bit(ParticleOptions options, std::size_t bytes) {
  const Particles<Dim> source = numbered_particles<Dim>(options, {7, 3, 900, -2, 8});
  EXPECT_EQ(bytes_per_particle(source), bytes);
  std::vector<std::byte> buffer(3);
  pack(source, {4, 1, 3}, buffer);
  pack(source, {0}, buffer);
  ASSERT_EQ(buffer.size(), 3 + 4 * bytes);
  Particles<Dim> target = numbered_particles<Dim>(options, {1});
  unpack(buffer.data() + 3, 3, target);
  unpack(buffer.data() + 3 + 3 * bytes, 1, target);
  unpack(buffer.data(), 0, target);
  EXPECT_EQ(target.id, (std::vector<std::int64_t>{1, 8, 3, -2, 7}));
  EXPECT_EQ(first_wrong_number(target), "");
}

TEST(Columns, PackingKeepsEveryBit) {
  expect_packing_keeps_every_bit<2>({false, false, false}, 16 + 8 * (2 + 2 + 7 + 4));
  expect_packing_keeps_every_bit<2>({true, false, false}, 16 + 8 * (2 + 2 + 4 + 7 + 4));
  expect_packing_keeps_every_bit<2>({true, true, false}, 16 + 8 * (2 + 2 + 4 + 6 + 7 + 4));
  expect_packing_keeps_every_bit<3>({true, true, true}, 16 + 8 * (3 + 3 + 9 + 18 + 7 + 6 + 6));
  expect_packing_keeps_every_bit<2>({false, false, false, true, true},
                                    20 + 8 * (2 + 2 + 7 + 4 + 1));
}

}  // namespace
}  // namespace poreshock
