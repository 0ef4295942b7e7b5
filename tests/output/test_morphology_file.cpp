// Morphology records: one small file each, merged in order at the end.
#include "poreshock/output/morphology_file.hpp"

#include "output/support.hpp"
#include "poreshock/output/block_hash.hpp"
#include "poreshock/output/hdf5_file.hpp"

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

void write_record(const TemporaryFolder& folder, std::int64_t record,
                  double first_threshold = 400.0) {
  write_morphology(folder / morphology_name(record),
                   {record, 100 * record, 1e-8 * static_cast<double>(record), "scene"},
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
  EXPECT_TRUE(
      contains(thrown<SystemError>([&] {
                 write_morphology(folder / morphology_name(3), {3, 0, 0.0, ""}, records, world);
               }),
               "F has 2 values for 3 thresholds"));
}

}  // namespace
}  // namespace poreshock
