// Morphology records: one small file each, merged in order at the end.
#include "poreshock/output/morphology_file.hpp"

#include "output/support.hpp"
#include "poreshock/files/block_hash.hpp"
#include "poreshock/files/hdf5_file.hpp"

namespace poreshock {
namespace {

using test::contains;
using test::TemporaryFolder;
using test::thrown;

const MPI_Comm world = MPI_COMM_WORLD;

std::vector<MorphologyRecord> sample_records(std::int64_t record, double first_threshold = 400.0) {
  MorphologyRecord temperature;
  temperature.field = "temperature";
  temperature.unit = "K";
  temperature.threshold = {first_threshold, 500.0, 600.0};
  temperature.pixels = 1000 + record;
  temperature.counts = {{"F", {10 * record, 5, 1}}, {"E", {20, 10, record}}};
  temperature.functionals = {{"A", {0.5, 0.25 / static_cast<double>(record + 1), 0.0}}};
  MorphologyRecord pressure = temperature;
  pressure.field = "pressure";
  pressure.unit = "Pa";
  pressure.threshold = {1e9};
  pressure.counts = {{"F", {record}}};
  pressure.functionals = {{"chi", {-0.125}}};
  return {temperature, pressure};
}

RecordStamp stamp_of(std::int64_t record) {
  return {record, 100 * record, 1e-8 * static_cast<double>(record), "scene", {{"pixel", 2e-6}}};
}

void write_record(const TemporaryFolder& folder, std::int64_t record,
                  double first_threshold = 400.0) {
  write_morphology(folder / morphology_name(record), stamp_of(record),
                   sample_records(record, first_threshold), world);
}

TEST(MorphologyFile, OneRecord) {
  const TemporaryFolder folder;
  write_record(folder, 7);
  const std::string path = folder / "morphology_000007.h5";
  verify(path, world);
  Hdf5File file = Hdf5File::open(path, world);
  EXPECT_EQ(file.text("kind"), "morphology");
  EXPECT_EQ(file.text("scene"), "scene");
  EXPECT_EQ(file.integer("step"), 700);
  EXPECT_EQ(file.number("time"), 7e-8);
  EXPECT_EQ(file.dataset("/temperature/F").shape, (std::vector<std::uint64_t>{1, 3}));
  EXPECT_EQ(file.dataset("/temperature/F").type, NumberType::int64);
  EXPECT_EQ(file.dataset("/temperature/threshold").unit, "K");
  EXPECT_EQ(file.read_all<std::int64_t>("/temperature/F"), (std::vector<std::int64_t>{70, 5, 1}));
  EXPECT_EQ(file.read_all<double>("/pressure/threshold"), (std::vector<double>{1e9}));
  EXPECT_EQ(file.read_all<std::int64_t>("/pressure/pixels"), (std::vector<std::int64_t>{1007}));
  EXPECT_EQ(file.read_all<double>("/pressure/time"), (std::vector<double>{7e-8}));
}

TEST(MorphologyFile, MergedInOrderAndExtendedLater) {
  const TemporaryFolder folder;
  EXPECT_EQ(collect_morphology(folder.path(), world), 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "morphology.h5"));
  for (const std::int64_t record : {1000000, 2, 10}) write_record(folder, record);
  EXPECT_EQ(collect_morphology(folder.path(), world), 3);
  EXPECT_FALSE(std::filesystem::exists(folder / morphology_name(2)));
  const std::string path = folder / "morphology.h5";
  {
    Hdf5File file = Hdf5File::open(path, world);
    EXPECT_EQ(file.dataset("/temperature/F").shape, (std::vector<std::uint64_t>{3, 3}));
    EXPECT_EQ(file.read_all<std::int64_t>("/temperature/record"),
              (std::vector<std::int64_t>{2, 10, 1000000}));
    EXPECT_EQ(file.read_all<std::int64_t>("/temperature/F"),
              (std::vector<std::int64_t>{20, 5, 1, 100, 5, 1, 10000000, 5, 1}));
    EXPECT_EQ(file.read_all<double>("/temperature/A")[4], 0.25 / 11.0);
    EXPECT_EQ(file.read_all<std::int64_t>("/pressure/step"),
              (std::vector<std::int64_t>{200, 1000, 100000000}));
    EXPECT_EQ(file.number("time"), 1e-8 * 1000000.0);
  }
  // A restarted run measured record 10 again and went on to 11.
  write_record(folder, 10);
  write_record(folder, 11);
  EXPECT_EQ(collect_morphology(folder.path(), world), 2);
  verify(path, world);
  Hdf5File file = Hdf5File::open(path, world);
  EXPECT_EQ(file.read_all<std::int64_t>("/pressure/record"),
            (std::vector<std::int64_t>{2, 10, 11, 1000000}));
  EXPECT_EQ(file.read_all<std::int64_t>("/pressure/F"),
            (std::vector<std::int64_t>{2, 10, 11, 1000000}));
}

TEST(MorphologyFile, WhatDoesNotFitIsRefusedAndKept) {
  const TemporaryFolder folder;
  write_record(folder, 1);
  write_record(folder, 2, 450.0);
  const std::string text = thrown<InputError>([&] { collect_morphology(folder.path(), world); });
  EXPECT_TRUE(contains(text, "morphology_000002.h5") && contains(text, "temperature")) << text;
  EXPECT_TRUE(std::filesystem::exists(folder / morphology_name(1)));
  EXPECT_TRUE(std::filesystem::exists(folder / morphology_name(2)));
  write_record(folder, 2);
  test::rank_zero_alone([&] { test::flip_byte(folder / morphology_name(2), 6000); });
  EXPECT_TRUE(
      contains(thrown<InputError>([&] { collect_morphology(folder.path(), world); }), "damaged"));
  auto records = sample_records(3);
  records[0].counts[0].second.pop_back();
  EXPECT_TRUE(contains(thrown<SystemError>([&] {
                         write_morphology(folder / morphology_name(3),
                                          {3, 0, 0.0, "", {{"pixel", 0.0}}}, records, world);
                       }),
                       "F has 2 values for 3 thresholds"));
}

/// As many hot spots as the number of the record says, none in record 0.
void write_spots(const TemporaryFolder& folder, std::int64_t record) {
  std::vector<MorphologyRecord> records = sample_records(record);
  SpotColumn pixels{"pixels", "1", SpotColumn::Kind::integers};
  SpotColumn centroid{"centroid", "m", SpotColumn::Kind::numbers, 2};
  for (std::int64_t spot = 0; spot < record; ++spot) {
    pixels.integers.push_back(10 * record + spot);
    centroid.numbers.insert(centroid.numbers.end(), {static_cast<double>(spot), -0.5});
  }
  records[0].spots = static_cast<std::size_t>(record);
  records[0].spot_columns = {pixels, centroid};
  write_morphology(folder / morphology_name(record), stamp_of(record), records, world);
}

TEST(MorphologyFile, HotSpotsOfAllRecordsFollowEachOther) {
  const TemporaryFolder folder;
  write_spots(folder, 3);
  EXPECT_EQ(collect_morphology(folder.path(), world), 1);
  for (const std::int64_t record : {0, 2, 4}) write_spots(folder, record);
  EXPECT_EQ(collect_morphology(folder.path(), world), 3);
  const std::string path = folder / "morphology.h5";
  const auto expect = [&](const std::vector<std::int64_t>& records,
                          const std::vector<std::int64_t>& pixels) {
    Hdf5File file = Hdf5File::open(path, world);
    EXPECT_EQ(file.read_all<std::int64_t>("/temperature/domains/record"), records);
    EXPECT_EQ(file.read_all<std::int64_t>("/temperature/domains/pixels"), pixels);
    EXPECT_EQ(file.dataset("/temperature/domains/centroid").shape,
              (std::vector<std::uint64_t>{records.size(), 2}));
  };
  expect({2, 2, 3, 3, 3, 4, 4, 4, 4}, {20, 21, 30, 31, 32, 40, 41, 42, 43});
  remove_morphology_from(folder.path(), 3, world);
  expect({2, 2}, {20, 21});
  std::vector<MorphologyRecord> records = sample_records(5);
  records[0].spots = 2;
  records[0].spot_columns = {{"pixels", "1", SpotColumn::Kind::integers, 1, {}, {7}}};
  EXPECT_TRUE(contains(thrown<SystemError>([&] {
                         write_morphology(folder / morphology_name(5), stamp_of(5), records, world);
                       }),
                       "pixels has 1 values for 2 hot spots"));
}

TEST(MorphologyFile, CurvesReadBack) {
  const TemporaryFolder folder;
  for (const std::int64_t record : {2, 7}) write_record(folder, record);
  const std::string early =
      thrown<InputError>([&] { read_morphology(folder.path(), "temperature", world); });
  EXPECT_TRUE(contains(early, "morphology.h5: not found")) << early;
  collect_morphology(folder.path(), world);
  const MorphologyCurves curves = read_morphology(folder.path(), "temperature", world);
  EXPECT_EQ(curves.unit, "K");
  EXPECT_EQ(curves.pixel, 2e-6);
  EXPECT_EQ(curves.threshold, (std::vector<double>{400.0, 500.0, 600.0}));
  EXPECT_EQ(curves.time, (std::vector<double>{2e-8, 7e-8}));
  ASSERT_EQ(curves.functionals.size(), 1u);
  EXPECT_EQ(curves.functionals.at("A"),
            (std::vector<double>{0.5, 0.25 / 3.0, 0.0, 0.5, 0.25 / 8.0, 0.0}));
  const std::string field =
      thrown<InputError>([&] { read_morphology(folder / "morphology.h5", "speed", world); });
  EXPECT_TRUE(contains(field, "no morphology of \"speed\", allowed pressure, temperature"))
      << field;
}

}  // namespace
}  // namespace poreshock
