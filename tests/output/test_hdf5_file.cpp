// The shared file: what is written is read, on any distribution; failures reach every rank.
#include <fcntl.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/statvfs.h>

#include <numeric>

#include "files/hdf5_handle.hpp"
#include "output/support.hpp"
#include "poreshock/files/block_hash.hpp"
#include "poreshock/files/hdf5_file.hpp"
#include "poreshock/files/posix_file.hpp"

namespace poreshock {
namespace {

using test::contains;
using test::TemporaryFolder;
using test::thrown;

const MPI_Comm world = MPI_COMM_WORLD;

FileSpec small_spec(std::uint64_t rows) {
  return {{{"/a/vector", NumberType::float64, {rows, 3}, "m", {{"note", "three"}}},
           {"/a/count", NumberType::int64, {rows}, "1", {}},
           {"/b/deep/single", NumberType::float32, {rows}, "K", {}},
           {"/b/grain", NumberType::int32, {rows}, "1", {}},
           {"/mask", NumberType::uint8, {rows}, "1", {}},
           {"/empty", NumberType::float64, {0}, "Pa", {}}},
          {{"kind", "test"}, {"time", 1.0 / 3.0}, {"step", std::int64_t{1} << 40}}};
}

TEST(Hdf5File, EveryTypeComesBackFromUnevenRanks) {
  const TemporaryFolder folder;
  // Rank r brings 5 r rows: rank 0 none.
  const auto mine = 5 * static_cast<std::uint64_t>(rank(world));
  const RowRange rows = rows_in_rank_order(mine, world);
  ASSERT_EQ(rows.total, static_cast<std::uint64_t>(5 * size(world) * (size(world) - 1) / 2));
  std::vector<double> vectors(3 * mine);
  std::vector<std::int64_t> counts(mine);
  std::vector<float> singles(mine);
  std::vector<std::int32_t> grains(mine);
  std::vector<std::uint8_t> mask(mine);
  for (std::uint64_t i = 0; i < mine; ++i) {
    const auto row = static_cast<double>(rows.first + i);
    for (std::uint64_t c = 0; c < 3; ++c) vectors[3 * i + c] = row / 3.0 + static_cast<double>(c);
    counts[i] = static_cast<std::int64_t>(rows.first + i) - (std::int64_t{1} << 60);
    singles[i] = static_cast<float>(row) / 7.0f;
    grains[i] = -static_cast<std::int32_t>(rows.first + i);
    mask[i] = static_cast<std::uint8_t>(200 + i);
  }
  const std::string path = folder / "shared.h5";
  {
    Hdf5File file = Hdf5File::create(path, small_spec(rows.total), world);
    EXPECT_FALSE(std::filesystem::exists(path)) << "the final name must wait for finish()";
    // 40-byte pieces: one row of vectors at a time, ranks with different numbers of pieces.
    file.write<double>("/a/vector", rows.first, vectors, 40);
    file.write<std::int64_t>("/a/count", rows.first, counts);
    file.write<float>("/b/deep/single", rows.first, singles);
    file.write<std::int32_t>("/b/grain", rows.first, grains);
    file.write<std::uint8_t>("/mask", rows.first, mask);
    file.write<double>("/empty", 0, {});
    file.finish();
  }
  verify(path, world);
  Hdf5File file = Hdf5File::open(path, world);
  EXPECT_EQ(file.text("kind"), "test");
  EXPECT_EQ(file.number("time"), 1.0 / 3.0);
  EXPECT_EQ(file.integer("step"), std::int64_t{1} << 40);
  EXPECT_EQ(std::get<std::string>(*file.attribute("note", "/a/vector")), "three");
  EXPECT_FALSE(file.attribute("absent"));
  ASSERT_EQ(file.datasets().size(), 6u);
  EXPECT_EQ(file.dataset("/b/deep/single").unit, "K");
  EXPECT_EQ(file.dataset("/a/vector").shape, (std::vector<std::uint64_t>{rows.total, 3}));
  EXPECT_EQ(file.read_all<double>("/empty").size(), 0u);
  // Every rank reads another share than it wrote.
  const RowRange share = equal_share(rows.total, world);
  std::vector<double> read(3 * share.count, -1.0);
  file.read<double>("/a/vector", share.first, std::span<double>(read), 50);
  std::vector<double> converted(share.count, -1.0);
  file.read<double>("/b/deep/single", share.first, std::span<double>(converted));
  for (std::uint64_t i = 0; i < share.count; ++i) {
    const auto row = static_cast<double>(share.first + i);
    for (std::uint64_t c = 0; c < 3; ++c) {
      EXPECT_EQ(read[3 * i + c], row / 3.0 + static_cast<double>(c));
    }
    EXPECT_EQ(converted[i], static_cast<double>(static_cast<float>(row) / 7.0f));
  }
  const auto all = file.read_all<std::int64_t>("/a/count");
  const auto all_grains = file.read_all<std::int32_t>("/b/grain");
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i], static_cast<std::int64_t>(i) - (std::int64_t{1} << 60));
    EXPECT_EQ(all_grains[i], -static_cast<std::int32_t>(i));
  }
}

TEST(Hdf5File, SharesOfRowsAreContiguousAndEqual) {
  for (const std::uint64_t total : {0u, 1u, 2u, 7u, 12u}) {
    const RowRange share = equal_share(total, world);
    const RowRange order = rows_in_rank_order(share.count, world);
    EXPECT_EQ(order.first, share.first);
    EXPECT_EQ(order.total, total);
    const auto ranks = static_cast<std::uint64_t>(size(world));
    EXPECT_GE(share.count, total / ranks);
    EXPECT_LE(share.count, total / ranks + 1);
  }
}

TEST(Hdf5File, LongTextsAndRepeatedWritingGiveTheSameBytes) {
  const TemporaryFolder folder;
  FileSpec spec = small_spec(4);
  spec.attributes.push_back({"scene", std::string(200000, 'x') + "end"});
  std::string bytes;
  for (const char* name : {"one.h5", "two.h5"}) {
    Hdf5File file = Hdf5File::create(folder / name, spec, world);
    const RowRange share = equal_share(4, world);
    std::vector<std::int64_t> values(share.count);
    std::iota(values.begin(), values.end(), static_cast<std::int64_t>(share.first));
    file.write<std::int64_t>("/a/count", share.first, values);
    file.finish();
    const std::string now = test::file_bytes(folder / name);
    EXPECT_TRUE(bytes.empty() || bytes == now);
    bytes = now;
  }
  Hdf5File file = Hdf5File::open(folder / "one.h5", world);
  EXPECT_EQ(file.text("scene"), std::string(200000, 'x') + "end");
}

TEST(Hdf5File, ExistingFileIsReplacedOnlyWhenAsked) {
  const TemporaryFolder folder;
  const std::string path = folder / "once.h5";
  Hdf5File::create(path, small_spec(1), world).finish();
  const std::string text =
      thrown<SystemError>([&] { Hdf5File::create(path, small_spec(2), world); });
  EXPECT_TRUE(contains(text, path) && contains(text, "exists already")) << text;
  {
    Hdf5File file = Hdf5File::open(path, world);
    EXPECT_EQ(file.dataset("/a/count").rows(), 1u);
  }
  Hdf5File::create(path, small_spec(2), world, Replace::yes).finish();
  Hdf5File file = Hdf5File::open(path, world);
  EXPECT_EQ(file.dataset("/a/count").rows(), 2u);
}

TEST(Hdf5File, UnfinishedFileLeavesNothingBehind) {
  const TemporaryFolder folder;
  { Hdf5File file = Hdf5File::create(folder / "half.h5", small_spec(3), world); }
  MPI_Barrier(world);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Hdf5File, WrongRequestsFailOnAllRanks) {
  const TemporaryFolder folder;
  const std::string path = folder / "small.h5";
  Hdf5File::create(path, small_spec(2), world).finish();
  Hdf5File file = Hdf5File::open(path, world);
  EXPECT_TRUE(contains(thrown<InputError>([&] { file.read_all<double>("/a/none"); }), "/a/none"));
  EXPECT_TRUE(contains(thrown<InputError>([&] { file.text("time"); }), "time"));
  // Only the last rank asks for rows that are not there; the others must hear of it.
  const bool last = rank(world) == size(world) - 1;
  std::vector<std::int64_t> values(last ? 3 : 0);
  const std::string text = thrown<SystemError>(
      [&] { file.read<std::int64_t>("/a/count", 0, std::span<std::int64_t>(values)); });
  EXPECT_TRUE(contains(text, "has 2 rows of 1 numbers; asked for 3")) << text;
}

TEST(Hdf5File, UnreadableFilesAreNamed) {
  const TemporaryFolder folder;
  test::rank_zero_alone([&] {
    std::ofstream(folder / "text.h5") << "no HDF5 at all, but long enough to look into";
    std::ofstream(folder / "empty.h5");
  });
  const auto message = [&](const std::string& name) {
    return thrown<InputError>([&] { Hdf5File::open(folder / name, world); });
  };
  EXPECT_TRUE(contains(message("absent.h5"), "not found"));
  EXPECT_TRUE(contains(message("text.h5"), "not an HDF5 file"));
  EXPECT_TRUE(contains(message("empty.h5"), "not an HDF5 file"));
  EXPECT_TRUE(contains(message("."), "folder"));
  Hdf5File::create(folder / "cut.h5", small_spec(1000), world).finish();
  test::rank_zero_alone([&] { std::filesystem::resize_file(folder / "cut.h5", 20000); });
  EXPECT_TRUE(contains(message("cut.h5"), "truncated"));
}

TEST(Hdf5File, MissingFolderIsASystemError) {
  const TemporaryFolder folder;
  const std::string path = folder / "none/file.h5";
  const std::string text =
      thrown<SystemError>([&] { Hdf5File::create(path, small_spec(1), world); });
  EXPECT_TRUE(contains(text, "No such file")) << text;
}

/// A small file system of its own, mounted by rank 0 and taken away at the end. Collective.
class SmallDisk {
 public:
  explicit SmallDisk(const std::string& path) : path_(path) {
    int error = 0;
    if (rank(world) == 0) {
      std::filesystem::create_directory(path);
      error = mount("tmpfs", path.c_str(), "tmpfs", 0, "size=256k") == 0 ? 0 : errno;
    }
    error_ = largest(error, world);
  }
  ~SmallDisk() {
    MPI_Barrier(world);
    if (rank(world) == 0 && error_ == 0) umount2(path_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  int error() const { return error_; }

 private:
  std::string path_;
  int error_ = 0;
};

/// Takes all of a disk but some bytes, in whole pages. Serial.
void fill_disk(const std::string& folder, std::uint64_t but) {
  const FileDescriptor fill(folder + "/fill", O_RDWR | O_CREAT | O_TRUNC);
  struct statvfs disk {};
  ASSERT_EQ(statvfs(folder.c_str(), &disk), 0);
  ASSERT_EQ(posix_fallocate(fill.get(), 0, static_cast<off_t>(disk.f_bavail * disk.f_bsize - but)),
            0);
}

TEST(DiskFull, IsFoundBeforeAnyRankWrites) {
  const TemporaryFolder folder;
  const SmallDisk disk(folder / "disk");
  if (disk.error() != 0) GTEST_SKIP() << "cannot mount a tmpfs: " << std::strerror(disk.error());
  const std::string path = folder / "disk/big.h5";
  const FileSpec big{{{"/x", NumberType::float64, {100000}, "m", {}}}, {}};
  const std::string text = thrown<SystemError>([&] { Hdf5File::create(path, big, world); });
  EXPECT_TRUE(contains(text, path) && contains(text, "no space left")) << text;
  EXPECT_TRUE(std::filesystem::is_empty(folder / "disk")) << "the partial file must go";
  MPI_Barrier(world);
  // The program goes on: a file that fits is written and is whole.
  Hdf5File::create(folder / "disk/small.h5", small_spec(10), world).finish();
  verify(folder / "disk/small.h5", world);
  test::rank_zero_alone([&] { fill_disk(folder / "disk", 0); });
  thrown<SystemError>([&] { Hdf5File::create(path, small_spec(1), world); });
  if (rank(world) == 0) {
    EXPECT_TRUE(contains(thrown<SystemError>([&] { write_text(folder / "disk/t.json", "text"); }),
                         "no space left"));
    EXPECT_FALSE(std::filesystem::exists(folder / "disk/t.json.part"));
  }
}

TEST(DiskFull, FileSizeLimitIsAnErrorAndNotASignal) {
  const TemporaryFolder folder;
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  if (rank(world) == 0) {
    const rlimit limit{100000, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  }
  const FileSpec big{{{"/x", NumberType::float64, {100000}, "m", {}}}, {}};
  const std::string text =
      thrown<SystemError>([&] { Hdf5File::create(folder / "big.h5", big, world); });
  if (rank(world) == 0) setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_TRUE(contains(text, "file size limit")) << text;
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(DiskFull, AFileThatCannotBeWrittenIsClosedForGood) {
  const TemporaryFolder folder;
  const SmallDisk disk(folder / "disk");
  if (disk.error() != 0) GTEST_SKIP() << "cannot mount a tmpfs: " << std::strerror(disk.error());
  if (rank(world) != 0) return;
  quiet_hdf5();
  const std::string path = folder / "disk/cut.h5";
  create_serially(path, small_spec(10));
  const std::uint64_t whole = std::filesystem::file_size(path);
  // Wherever the room ends: in the first block, between the tables, in the last one.
  for (std::uint64_t room = 0; room + 4096 < whole; room += 4096) {
    std::filesystem::remove(path);
    fill_disk(folder / "disk", room);
    const std::string text = thrown<SystemError>([&] { create_serially(path, small_spec(10)); });
    EXPECT_TRUE(contains(text, path) && contains(text, "o space left")) << room << ": " << text;
    // What is still open here would be taken down again at the end of the program.
    EXPECT_EQ(H5Fget_obj_count(H5F_OBJ_ALL, H5F_OBJ_ALL), 0) << room;
  }
}

}  // namespace
}  // namespace poreshock
