// The seal finds every damage, wherever it is, and says what is wrong.
#include <hdf5.h>

#include "output/support.hpp"
#include "poreshock/files/block_hash.hpp"
#include "poreshock/files/hdf5_file.hpp"

namespace poreshock {
namespace {

using test::contains;
using test::TemporaryFolder;
using test::thrown;

const MPI_Comm world = MPI_COMM_WORLD;

std::uint64_t hash(const std::string& text) {
  return block_hash(reinterpret_cast<const std::byte*>(text.data()), text.size());
}

TEST(BlockHash, IsXxh64) {
  EXPECT_EQ(hash(""), 0xEF46DB3751D8E999u);
  EXPECT_EQ(hash("a"), 0xD24EC4F1A98C6E5Bu);
  EXPECT_EQ(hash("abc"), 0x44BC2CF5AD770999u);
  EXPECT_EQ(hash("Nobody inspects the spammish repetition"), 0xFBCEA83C8A378BF1u);
}

/// A file of 2.4 MB: three blocks of the hash.
std::string make_file(const TemporaryFolder& folder, MPI_Comm communicator) {
  const std::string path = folder / "sealed.h5";
  constexpr std::uint64_t rows = 300000;
  Hdf5File file =
      Hdf5File::create(path, {{{"/x", NumberType::float64, {rows}, "m", {}}}, {{"kind", "test"}}},
                       communicator, Replace::yes);
  const RowRange share = equal_share(rows, communicator);
  std::vector<double> values(share.count);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = 1.0 / static_cast<double>(1 + share.first + i);
  }
  file.write<double>("/x", share.first, values);
  file.finish();
  return path;
}

TEST(Seal, IsTheSameOnAnyNumberOfRanks) {
  const TemporaryFolder folder;
  const std::string path = make_file(folder, world);
  const std::string together = test::file_bytes(path);
  MPI_Barrier(world);
  if (rank(world) == 0) {
    verify(path, MPI_COMM_SELF);
    make_file(folder, MPI_COMM_SELF);
    EXPECT_TRUE(test::file_bytes(path) == together);
  }
}

TEST(Seal, EveryFlippedByteIsFound) {
  const TemporaryFolder folder;
  const std::string path = make_file(folder, world);
  const std::uint64_t length = std::filesystem::file_size(path);
  for (const std::uint64_t at :
       {std::uint64_t{0}, std::uint64_t{9}, std::uint64_t{17}, std::uint64_t{25},
        std::uint64_t{2000}, std::uint64_t{4095}, std::uint64_t{4096}, std::uint64_t{4110},
        std::uint64_t{1} << 20, (std::uint64_t{1} << 20) + 4096, length / 2, length - 1}) {
    test::rank_zero_alone([&] { test::flip_byte(path, at); });
    const std::string text = thrown<InputError>([&] { verify(path, world); });
    EXPECT_TRUE(contains(text, path) && contains(text, "damaged")) << "byte " << at << ": " << text;
    test::rank_zero_alone([&] { test::flip_byte(path, at); });
    EXPECT_NO_THROW(verify(path, world)) << "byte " << at << " was restored";
  }
}

TEST(Seal, TruncatedForeignAndNewerFilesAreNamed) {
  const TemporaryFolder folder;
  const std::string path = make_file(folder, world);
  const auto message = [&] { return thrown<InputError>([&] { verify(path, world); }); };
  const std::uint64_t length = std::filesystem::file_size(path);
  for (const std::uint64_t shorter :
       {length - 1, length / 2, std::uint64_t{4096}, std::uint64_t{100}, std::uint64_t{0}}) {
    test::rank_zero_alone([&] { std::filesystem::resize_file(path, shorter); });
    EXPECT_TRUE(contains(message(), "truncated")) << shorter << ": " << message();
  }
  EXPECT_TRUE(
      contains(thrown<InputError>([&] { verify(folder / "none.h5", world); }), "not found"));

  test::rank_zero_alone([&] {
    const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hsize_t count = 2000;
    const hid_t space = H5Screate_simple(1, &count, nullptr);
    const hid_t data =
        H5Dcreate2(file, "x", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const std::vector<double> values(count, 1.0);
    H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(data);
    H5Sclose(space);
    H5Fclose(file);
  });
  EXPECT_TRUE(contains(message(), "not written by poreshock")) << message();

  make_file(folder, world);
  test::rank_zero_alone([&] {
    std::string bytes = test::file_bytes(path);
    bytes[8] = 2;  // the version, of which 1 is the newest
    const std::uint64_t own = hash(bytes.substr(0, 4088));
    std::memcpy(bytes.data() + 4088, &own, sizeof(own));
    std::ofstream(path, std::ios::binary) << bytes;
  });
  EXPECT_TRUE(contains(message(), "newer poreshock: format version 2")) << message();
}

}  // namespace
}  // namespace poreshock
