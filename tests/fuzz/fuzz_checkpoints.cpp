// Checkpoints with any damage: each is refused, the good one beside them is found.
#include <hdf5.h>

#include "fuzz/mutate.hpp"
#include "output/support.hpp"
#include "poreshock/files/block_hash.hpp"
#include "poreshock/output/checkpoint.hpp"
#include "poreshock/scene/read_scene.hpp"
#include "poreshock/solver/start.hpp"
#include "support/runs.hpp"

namespace poreshock {
namespace {

using test::TemporaryFolder;
const MPI_Comm self = MPI_COMM_SELF;

/// A checkpoint of a small run after a few steps.
std::string make_checkpoint(const TemporaryFolder& folder, const Scene& scene) {
  Simulation<2> sim = start<2>(scene, self);
  for (int step = 0; step < 5; ++step) {
    const double dt = next_time_step(scene, sim.clock);
    advance(sim, dt);
    tick(scene, dt, sim.clock);
    agree_on_step(false, sim.clock, self);
    migrate(sim);
  }
  const std::string path = folder / checkpoint_name(5);
  write_checkpoint(path, sim.scene_text, run_state(sim), sim.particles, self);
  return path;
}

void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

TEST(Fuzz, DamagedCheckpointsAreRefused) {
  const TemporaryFolder folder;
  const Scene scene = test::scene_of(test::porous_text());
  const std::string good = make_checkpoint(folder, scene);
  const std::string bytes = test::file_bytes(good);
  const std::string path = folder / checkpoint_name(6);
  const std::uint64_t count = test::fuzz_count("PORESHOCK_FUZZ_CHECKPOINTS", 100);
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    test::Mutator mutator(seed);
    std::string damaged = bytes;
    mutator.file(damaged);
    write_bytes(path, damaged);
    const std::string text = test::thrown<InputError>([&] { resume<2>(scene, path, self); });
    ASSERT_TRUE(test::contains(text, path)) << "case " << seed << ": " << text;
    std::string note;
    ASSERT_EQ(latest_checkpoint(folder.path(), self, note), good) << "case " << seed;
    ASSERT_TRUE(test::contains(note, path)) << "case " << seed << ": " << note;
  }
  EXPECT_NO_THROW(resume<2>(scene, good, self));
  std::printf("%llu damaged checkpoints: all refused\n", static_cast<unsigned long long>(count));
}

/// Writes one number of a dataset and seals the file again, as if it had been written so.
template <class T>
void set_number(const std::string& path, const char* dataset, hid_t type, std::size_t at, T value) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t data = H5Dopen2(file, dataset, H5P_DEFAULT);
  const hid_t space = H5Dget_space(data);
  std::vector<T> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  values.at(at) = value;
  EXPECT_GE(H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  H5Sclose(space);
  H5Dclose(data);
  H5Fclose(file);
  write_seal(path, false, self);
}

TEST(Fuzz, SealedNonsenseIsRefused) {
  const TemporaryFolder folder;
  const Scene scene = test::scene_of(test::porous_text());
  const std::string path = make_checkpoint(folder, scene);
  const std::string bytes = test::file_bytes(path);
  const auto refusal = [&](const char* dataset, double value) {
    write_bytes(path, bytes);
    set_number(path, dataset, H5T_NATIVE_DOUBLE, 7, value);
    return test::thrown<InputError>([&] { resume<2>(scene, path, self); });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const char* dataset :
       {"/particles/velocity_0", "/particles/mass", "/particles/deviator_3"}) {
    const std::string text = refusal(dataset, nan);
    EXPECT_TRUE(test::contains(text, "found 1 numbers that are not finite")) << text;
  }
  for (const double place : {-1e-3, 1e3, 1e300}) {
    const std::string text = refusal("/particles/position_1", place);
    EXPECT_TRUE(test::contains(text, "found 1 particles outside the domain")) << text;
  }
  std::string text = refusal("/particles/density", -2700.0);
  EXPECT_TRUE(test::contains(text, "found 1 particles without mass or density")) << text;
  write_bytes(path, bytes);
  set_number(path, "/particles/material", H5T_NATIVE_INT32, 3, std::int32_t{1});
  text = test::thrown<InputError>([&] { resume<2>(scene, path, self); });
  EXPECT_TRUE(test::contains(text, "1 particles of a material that the scene does not have"))
      << text;
}

}  // namespace
}  // namespace poreshock
