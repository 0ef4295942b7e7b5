// A run goes on from a checkpoint with every bit, on any number of ranks, and never from a bad one.
#include <hdf5.h>

#include <array>

#include "output/support.hpp"
#include "poreshock/files/block_hash.hpp"
#include "poreshock/files/hdf5_file.hpp"
#include "poreshock/output/checkpoint.hpp"

namespace poreshock {
namespace {

using test::contains;
using test::made_up_particles;
using test::TemporaryFolder;
using test::thrown;

const MPI_Comm world = MPI_COMM_WORLD;

const RunState sample_state = {
    123456789, 1.0 / 3.0, 1e-11 / 7.0, 41, 12, {std::int64_t{1} << 62, -5, 0}, 0.1};
const std::string sample_scene = "title = \"checkpoint\"\n[domain]\ncell = 1e-6\n";

/// The first `ranks` ranks of the world; null on the others. Collective.
MPI_Comm first_ranks(int ranks) {
  MPI_Comm part = MPI_COMM_NULL;
  MPI_Comm_split(world, rank(world) < ranks ? 0 : MPI_UNDEFINED, rank(world), &part);
  return part;
}

/// Rows a writer brings: the first of several ranks none at all, the others unequal shares.
std::array<std::int64_t, 2> uneven_rows(std::int64_t total, MPI_Comm communicator) {
  const std::int64_t ranks = size(communicator);
  const std::int64_t r = rank(communicator);
  if (ranks == 1) return {0, total};
  const auto start = [&](std::int64_t q) {
    return q <= 1 ? 0 : total * (q - 1) * q / (ranks * (ranks - 1));
  };
  return {start(r), start(r + 1) - start(r)};
}

template <int Dim>
void write_sample(const std::string& path, std::int64_t total, ParticleOptions options,
                  MPI_Comm communicator) {
  const auto [first, count] = uneven_rows(total, communicator);
  write_checkpoint(path, sample_scene, sample_state, made_up_particles<Dim>(first, count, options),
                   communicator);
}

template <int Dim>
void round_trip(ParticleOptions options) {
  const TemporaryFolder folder;
  constexpr std::int64_t total = 23;
  std::string reference;
  for (int writers = 1; writers <= size(world); ++writers) {
    const std::string path = folder / checkpoint_name(writers);
    MPI_Comm part = first_ranks(writers);
    if (part != MPI_COMM_NULL) {
      write_sample<Dim>(path, total, options, part);
      MPI_Comm_free(&part);
    }
    MPI_Barrier(world);
    const std::string bytes = test::file_bytes(path);
    if (reference.empty()) reference = bytes;
    EXPECT_TRUE(bytes == reference) << writers << " writers gave another file than one";
    for (int readers = 1; readers <= size(world); ++readers) {
      part = first_ranks(readers);
      if (part == MPI_COMM_NULL) continue;
      std::string scene;
      RunState state;
      Particles<Dim> particles;
      read_checkpoint(path, part, scene, state, particles);
      EXPECT_EQ(scene, sample_scene);
      EXPECT_EQ(state, sample_state);
      EXPECT_EQ(particles.options.affine, options.affine);
      EXPECT_EQ(particles.options.quadratic, options.quadratic);
      EXPECT_EQ(particles.options.back_stress, options.back_stress);
      EXPECT_EQ(particles.options.conducted_heat, options.conducted_heat);
      EXPECT_EQ(particles.options.failed, options.failed);
      EXPECT_EQ(particles.options.facing, options.facing);
      const RowRange share = equal_share(total, part);
      const auto expected = made_up_particles<Dim>(static_cast<std::int64_t>(share.first),
                                                   static_cast<std::int64_t>(share.count), options);
      EXPECT_TRUE(test::same_bits(particles, expected)) << writers << " to " << readers;
      MPI_Comm_free(&part);
    }
    MPI_Barrier(world);
  }
}

TEST(Checkpoint, AnyRanksToAnyRanksPlaneStrain) {
  round_trip<2>({.affine = true});
  round_trip<2>({.affine = true, .quadratic = true});
}
TEST(Checkpoint, AnyRanksToAnyRanksThreeDimensions) {
  round_trip<3>({.affine = false, .back_stress = true});
  round_trip<3>({.affine = true, .quadratic = true});
}

TEST(Checkpoint, AnyRanksToAnyRanksOptionalColumns) {
  round_trip<2>({.affine = false, .conducted_heat = true, .failed = true, .facing = true});
}

TEST(Checkpoint, NoParticlesAtAll) {
  const TemporaryFolder folder;
  const std::string path = folder / checkpoint_name(0);
  write_sample<2>(path, 0, {}, world);
  std::string scene;
  RunState state;
  Particles<2> particles = made_up_particles<2>(0, 4, {});
  read_checkpoint(path, world, scene, state, particles);
  EXPECT_EQ(particles.size(), 0u);
  EXPECT_EQ(state, sample_state);
}

std::string refusal(const std::string& path) {
  return thrown<InputError>([&] {
    std::string scene;
    RunState state;
    Particles<2> particles;
    read_checkpoint(path, world, scene, state, particles);
  });
}

TEST(Checkpoint, BadFilesAreRefusedWithTheReason) {
  const TemporaryFolder folder;
  const std::string path = folder / checkpoint_name(7);
  EXPECT_TRUE(contains(refusal(path), "not found"));
  write_sample<3>(path, 5, {}, world);
  EXPECT_EQ(checkpoint_header(path, world).dimension, 3);
  EXPECT_TRUE(contains(refusal(path), "3-D")) << refusal(path);
  write_sample<2>(path, 500, {}, world);
  const CheckpointHeader header = checkpoint_header(path, world);
  EXPECT_EQ(header.dimension, 2);
  EXPECT_EQ(header.particles, 500);
  EXPECT_EQ(header.step, sample_state.step);
  EXPECT_EQ(header.time, sample_state.time);
  EXPECT_EQ(header.scene_text, sample_scene);
  test::rank_zero_alone([&] { test::flip_byte(path, std::filesystem::file_size(path) / 2 + 3); });
  EXPECT_TRUE(contains(refusal(path), "damaged")) << refusal(path);
  write_sample<2>(path, 500, {}, world);
  test::rank_zero_alone(
      [&] { std::filesystem::resize_file(path, std::filesystem::file_size(path) - 8); });
  EXPECT_TRUE(contains(refusal(path), "truncated")) << refusal(path);
  Hdf5File::create(path, {{}, {{"kind", "snapshot"}}}, world, Replace::yes).finish();
  EXPECT_TRUE(contains(refusal(path), "not a checkpoint")) << refusal(path);
}

TEST(Checkpoint, NewerFormatIsRefused) {
  const TemporaryFolder folder;
  const std::string path = folder / checkpoint_name(7);
  write_sample<2>(path, 5, {}, world);
  test::rank_zero_alone([&] {
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hid_t attribute = H5Aopen(file, "format", H5P_DEFAULT);
    const std::int64_t newer = 2;
    EXPECT_GE(H5Awrite(attribute, H5T_NATIVE_INT64, &newer), 0);
    H5Aclose(attribute);
    H5Fclose(file);
  });
  write_seal(path, true, world);
  EXPECT_TRUE(contains(refusal(path), "newer poreshock")) << refusal(path);
}

TEST(Checkpoint, LatestFallsBackToAGoodOne) {
  const TemporaryFolder folder;
  std::string note = "old";
  EXPECT_TRUE(contains(thrown<InputError>([&] { latest_checkpoint(folder.path(), world, note); }),
                       "no usable"));
  for (const std::int64_t step : {999L, 1000L, 20000000000L}) {
    write_sample<2>(folder / checkpoint_name(step), 50, {}, world);
  }
  EXPECT_EQ(latest_checkpoint(folder.path(), world, note), folder / "checkpoint_20000000000.h5");
  EXPECT_EQ(note, "");
  test::rank_zero_alone([&] { test::flip_byte(folder / checkpoint_name(20000000000), 9000); });
  EXPECT_EQ(latest_checkpoint(folder.path(), world, note), folder / "checkpoint_000001000.h5");
  EXPECT_TRUE(contains(note, "checkpoint_20000000000.h5") && contains(note, "damaged")) << note;
  test::rank_zero_alone(
      [&] { std::filesystem::resize_file(folder / checkpoint_name(1000), 5000); });
  EXPECT_EQ(latest_checkpoint(folder.path(), world, note), folder / "checkpoint_000000999.h5");
  EXPECT_EQ(std::count(note.begin(), note.end(), '\n'), 1) << note;
}

TEST(Checkpoint, PruningKeepsTheNewest) {
  const TemporaryFolder folder;
  test::rank_zero_alone([&] {
    for (const std::int64_t step : {5, 40, 300, 1000000000}) {
      std::ofstream(folder / checkpoint_name(step)) << step;
    }
    std::ofstream(folder / "checkpoint_mine.h5") << "a user's file";
  });
  prune_checkpoints(folder.path(), 2, world);
  EXPECT_FALSE(std::filesystem::exists(folder / checkpoint_name(5)));
  EXPECT_FALSE(std::filesystem::exists(folder / checkpoint_name(40)));
  EXPECT_TRUE(std::filesystem::exists(folder / checkpoint_name(300)));
  EXPECT_TRUE(std::filesystem::exists(folder / checkpoint_name(1000000000)));
  MPI_Barrier(world);
  prune_checkpoints(folder.path(), 0, world);
  EXPECT_FALSE(std::filesystem::exists(folder / checkpoint_name(300)));
  EXPECT_TRUE(std::filesystem::exists(folder / checkpoint_name(1000000000)));
  EXPECT_TRUE(std::filesystem::exists(folder / "checkpoint_mine.h5"));
}

}  // namespace
}  // namespace poreshock
