// Profile records: one small file each, merged in order at the end.
#include "output/support.hpp"
#include "poreshock/files/block_hash.hpp"
#include "poreshock/files/hdf5_file.hpp"
#include "poreshock/output/folder.hpp"
#include "poreshock/output/profile_file.hpp"

namespace poreshock {
namespace {

using test::contains;
using test::TemporaryFolder;
using test::thrown;

const MPI_Comm world = MPI_COMM_WORLD;

Profile sample_profile(std::int64_t record, std::size_t rows = 3) {
  const auto value = static_cast<double>(record);
  const std::vector<double> column(rows, value);
  Profile profile;
  profile.shift = 0.5 * value;
  for (std::size_t j = 0; j < rows; ++j) profile.height.push_back(static_cast<double>(j) + 0.5);
  profile.solid_fraction = profile.density = profile.pressure = column;
  profile.stress = profile.momentum_flux = profile.temperature = column;
  profile.plastic_strain = profile.fluctuation = column;
  profile.velocity[0] = profile.velocity[1] = column;
  profile.density.back() = std::nan("");
  profile.front = 10.0 * value;
  return profile;
}

void write_record(const TemporaryFolder& folder, std::int64_t record, std::size_t rows = 3) {
  write_profile(folder / profile_name(record),
                {record, 100 * record, 1e-8 * static_cast<double>(record), "scene"},
                sample_profile(record, rows), world);
}

TEST(ProfileFile, OneRecord) {
  const TemporaryFolder folder;
  write_record(folder, 7);
  const std::string path = folder / "profile_000007.h5";
  verify(path, world);
  Hdf5File file = Hdf5File::open(path, world);
  EXPECT_EQ(file.text("kind"), "profile");
  EXPECT_EQ(file.integer("record"), 7);
  EXPECT_EQ(file.dataset("/row/stress").shape, (std::vector<std::uint64_t>{1, 3}));
  EXPECT_EQ(file.dataset("/row/stress").unit, "Pa");
  EXPECT_EQ(file.dataset("/row/fluctuation").unit, "J/kg");
  EXPECT_EQ(file.read_all<double>("/row/height"), (std::vector<double>{0.5, 1.5, 2.5}));
  EXPECT_EQ(file.read_all<double>("/row/shift"), (std::vector<double>{3.5}));
  EXPECT_TRUE(std::isnan(file.read_all<double>("/row/density")[2]));
  EXPECT_EQ(file.read_all<double>("/front/position"), (std::vector<double>{70.0}));
  EXPECT_TRUE(std::isnan(file.read_all<double>("/front/width")[0]));
  // Two velocities in plane strain.
  EXPECT_EQ(file.datasets().size(), 5u + 10u + 5u);
}

TEST(ProfileFile, MergedInOrderAndTakenBack) {
  const TemporaryFolder folder;
  for (const std::int64_t record : {12, 2, 10}) write_record(folder, record);
  EXPECT_EQ(collect_profiles(folder.path(), world), 3);
  const auto records = [&] {
    Hdf5File file = Hdf5File::open(folder / "profiles.h5", world);
    EXPECT_EQ(file.read_all<std::int64_t>("/row/record"),
              file.read_all<std::int64_t>("/front/record"));
    const auto front = file.read_all<double>("/front/position");
    std::vector<std::int64_t> found;
    for (const double x : front) found.push_back(static_cast<std::int64_t>(x / 10.0));
    EXPECT_EQ(file.read_all<double>("/row/velocity_y").size(), 3 * found.size());
    EXPECT_EQ(found, file.read_all<std::int64_t>("/row/record"));
    return found;
  };
  EXPECT_EQ(records(), (std::vector<std::int64_t>{2, 10, 12}));
  remove_profiles_from(folder.path(), 10, world);
  EXPECT_EQ(records(), (std::vector<std::int64_t>{2}));
  write_record(folder, 11);
  EXPECT_EQ(collect_profiles(folder.path(), world), 1);
  EXPECT_EQ(records(), (std::vector<std::int64_t>{2, 11}));
  verify(folder / "profiles.h5", world);
  remove_profiles_from(folder.path(), 0, world);
  EXPECT_FALSE(std::filesystem::exists(folder / "profiles.h5"));
}

TEST(ProfileFile, LateRecordsGoOnRestart) {
  const TemporaryFolder folder;
  for (const std::int64_t record : {1, 2, 3}) write_record(folder, record);
  remove_records_from(folder.path(), 3, world);
  EXPECT_TRUE(std::filesystem::exists(folder / profile_name(2)));
  EXPECT_FALSE(std::filesystem::exists(folder / profile_name(3)));
}

TEST(ProfileFile, OtherRowsAreRefusedAndKept) {
  const TemporaryFolder folder;
  write_record(folder, 1);
  write_record(folder, 2, 4);
  const std::string text = thrown<InputError>([&] { collect_profiles(folder.path(), world); });
  EXPECT_TRUE(contains(text, "profile_000002.h5: cannot be merged, the heights or curves of row"))
      << text;
  EXPECT_TRUE(std::filesystem::exists(folder / profile_name(1)));
}

}  // namespace
}  // namespace poreshock
