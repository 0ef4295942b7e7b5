// Snapshots say what the particles are, to our reader, to the plain HDF5 library and to h5py.
#include <hdf5.h>

#include <cmath>
#include <cstdlib>

#include "output/scenes.hpp"
#include "output/support.hpp"
#include "poreshock/files/block_hash.hpp"
#include "poreshock/files/hdf5_file.hpp"
#include "poreshock/material/derived.hpp"
#include "poreshock/output/info.hpp"
#include "poreshock/output/snapshot.hpp"
#include "poreshock/output/xdmf.hpp"

namespace poreshock {
namespace {

using test::contains;
using test::TemporaryFolder;

const MPI_Comm world = MPI_COMM_WORLD;
const std::string scene_text = "title = \"snapshot\"\n";

/// Row `row` of the whole sample has numbers that depend on `row` only.
template <int Dim>
Particles<Dim> physical_particles(std::int64_t first, std::int64_t count) {
  Particles<Dim> p =
      test::made_up_particles<Dim>(first, count, {.affine = true, .quadratic = true});
  for (std::size_t i = 0; i < p.size(); ++i) {
    const auto row = static_cast<double>(first + static_cast<std::int64_t>(i));
    p.density[i] = 2785.0 + 10.0 * row;
    p.internal_energy[i] = 1000.0 * row;
    p.pressure[i] = 1e6 * row;
    for (std::size_t a = 0; a < Dim; ++a) {
      p.position[a][i] = 0.125 * row + static_cast<double>(a);
      p.velocity[a][i] = row - 2.0 * static_cast<double>(a);
    }
    for (std::size_t c = 0; c < p.deviator.size(); ++c) {
      p.deviator[c][i] = 1e5 * static_cast<double>(c + 1) + row;
    }
    for (std::size_t c = 0; c < p.affine.size(); ++c) p.affine[c][i] = static_cast<double>(c) + row;
    for (std::size_t c = 0; c < p.quadratic.size(); ++c) {
      p.quadratic[c][i] = 0.5 * static_cast<double>(c) - row;
    }
  }
  return p;
}

constexpr std::int64_t total = 13;

/// Writes a snapshot; this rank brings the rows of `share`.
template <int Dim>
std::int64_t write(const std::string& path, const Scene& scene, std::int64_t record, double time,
                   const RowRange& share = equal_share(total, world)) {
  const auto particles = physical_particles<Dim>(static_cast<std::int64_t>(share.first),
                                                 static_cast<std::int64_t>(share.count));
  const auto materials = test::small_materials();
  SnapshotInput<Dim> input{scene, scene_text, materials, particles};
  input.record = record;
  input.step = 100 * record;
  input.time = time;
  input.shift = Vector<Dim>::Constant(-0.25);
  return write_snapshot(path, input, world);
}

/// Reads a dataset with the plain library.
std::vector<double> plain_read(const std::string& path, const char* name) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT);
  const hid_t space = H5Dget_space(dataset);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  EXPECT_GE(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  H5Sclose(space);
  H5Dclose(dataset);
  H5Fclose(file);
  return values;
}

template <int Dim>
void check_columns(ShapeFunction shape, double inertia) {
  const TemporaryFolder folder;
  Scene scene = test::small_scene(Dim);
  scene.transfer.shape = shape;
  const std::string path = folder / snapshot_name(4);
  EXPECT_EQ(write<Dim>(path, scene, 4, 2e-8), 0);
  verify(path, world);
  const auto p = physical_particles<Dim>(0, total);
  std::vector<double> temperature;
  derive_field("temperature", p, test::small_materials(), scene.thermal, temperature);
  const auto position = plain_read(path, "/particles/position");
  const auto stress = plain_read(path, "/particles/stress");
  const auto kinetic = plain_read(path, "/particles/kinetic_energy");
  EXPECT_EQ(plain_read(path, "/particles/temperature"), temperature);
  EXPECT_EQ(plain_read(path, "/particles/density"), p.density);
  EXPECT_EQ(plain_read(path, "/particles/mass"), p.mass);
  ASSERT_EQ(position.size(), static_cast<std::size_t>(total * Dim));
  ASSERT_EQ(stress.size(), static_cast<std::size_t>(total * symmetric_size<Dim>));
  for (std::size_t i = 0; i < p.size(); ++i) {
    double velocity = 0.0;
    double gradient = 0.0, second = 0.0;
    for (std::size_t a = 0; a < Dim; ++a) {
      EXPECT_EQ(position[i * Dim + a], p.position[a][i] - 0.25);
      velocity += p.velocity[a][i] * p.velocity[a][i];
    }
    for (const auto& c : p.affine) gradient += c[i] * c[i];
    for (const auto& c : p.quadratic) second += c[i] * c[i];
    EXPECT_DOUBLE_EQ(kinetic[i], 0.5 * velocity + 0.5 * inertia * gradient + 0.5 * second);
    for (std::size_t c = 0; c < symmetric_size<Dim>; ++c) {
      const double expected = p.deviator[c][i] - (c < 3 ? p.pressure[i] : 0.0);
      EXPECT_EQ(stress[i * symmetric_size<Dim> + c], expected);
    }
  }
}

TEST(Snapshot, ColumnsInPlaneStrain) {
  check_columns<2>(ShapeFunction::cubic, 0.25 / 3.0);
}
TEST(Snapshot, ColumnsInThreeDimensions) {
  check_columns<3>(ShapeFunction::quadratic, 0.25 / 4.0);
}

TEST(Snapshot, ARankWithManyParticlesWritesInPiecesTheOthersTakePartIn) {
  constexpr std::uint64_t many = 150000, few = 7;
  const auto ranks = static_cast<std::uint64_t>(size(world));
  const auto me = static_cast<std::uint64_t>(rank(world));
  const bool last = me + 1 == ranks;
  const RowRange share = {few * me, last ? many : few, few * (ranks - 1) + many};
  const TemporaryFolder folder;
  const std::string path = folder / snapshot_name(1);
  write<2>(path, test::small_scene(2), 1, 0.0, share);
  const auto density = plain_read(path, "/particles/density");
  const auto velocity = plain_read(path, "/particles/velocity");
  ASSERT_EQ(density.size(), share.total);
  ASSERT_EQ(velocity.size(), 2 * share.total);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < density.size(); ++i) {
    const auto row = static_cast<double>(i);
    wrong += density[i] != 2785.0 + 10.0 * row || velocity[2 * i] != row ||
             velocity[2 * i + 1] != row - 2.0;
  }
  EXPECT_EQ(wrong, 0U);
}

TEST(Snapshot, SubsetAndSinglePrecision) {
  const TemporaryFolder folder;
  Scene scene = test::small_scene(2);
  scene.output.fields = {"temperature", "grain"};
  scene.output.precision = Precision::single_precision;
  const std::string path = folder / snapshot_name(0);
  write<2>(path, scene, 0, 0.0);
  Hdf5File file = Hdf5File::open(path, world);
  std::vector<std::string> names;
  for (const DatasetInfo& info : file.datasets()) names.push_back(info.path);
  EXPECT_EQ(names,
            (std::vector<std::string>{"/particles/grain", "/particles/id", "/particles/position",
                                      "/particles/temperature", "/slabs/owner"}));
  EXPECT_EQ(file.dataset("/particles/id").type, NumberType::int64);
  EXPECT_EQ(file.dataset("/particles/grain").type, NumberType::int32);
  EXPECT_EQ(file.dataset("/particles/position").type, NumberType::float32);
  EXPECT_EQ(file.read_all<std::int64_t>("/particles/id"), physical_particles<2>(0, total).id);
  // Each particle names the rank that wrote it; rows stand in the order of the ranks.
  const std::vector<std::int32_t> owner = file.read_all<std::int32_t>("/slabs/owner");
  EXPECT_TRUE(std::is_sorted(owner.begin(), owner.end()));
  EXPECT_EQ(owner.front(), 0);
  EXPECT_EQ(owner.back(), size(world) - 1);
}

TEST(Snapshot, ColumnsOfPhysicsInUse) {
  const TemporaryFolder folder;
  const std::string path = folder / snapshot_name(0);
  const Scene scene = test::small_scene(2);
  const auto materials = test::small_materials();
  Particles<2> particles = physical_particles<2>(3 * rank(world), 3);
  const SnapshotInput<2> input{scene, scene_text, materials, particles};
  const auto holds = [&](const char* name) {
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const bool there = H5Lexists(file, name, H5P_DEFAULT) > 0;
    H5Fclose(file);
    return there;
  };
  write_snapshot(path, input, world);
  EXPECT_FALSE(holds("/particles/failed"));
  EXPECT_FALSE(holds("/particles/conducted_heat"));
  MPI_Barrier(world);
  particles.options.failed = particles.options.conducted_heat = true;
  resize(particles, particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    particles.failed[i] = particles.id[i] % 2 == 0 ? 1 : 0;
    particles.conducted_heat[i] = -5.0 * static_cast<double>(particles.id[i]);
  }
  write_snapshot(path, input, world);
  const std::vector<double> ids = plain_read(path, "/particles/id");
  const std::vector<double> failed = plain_read(path, "/particles/failed");
  const std::vector<double> heat = plain_read(path, "/particles/conducted_heat");
  ASSERT_EQ(ids.size(), static_cast<std::size_t>(3 * size(world)));
  for (std::size_t i = 0; i < ids.size(); ++i) {
    EXPECT_EQ(failed[i], std::fmod(ids[i], 2.0) == 0.0 ? 1.0 : 0.0);
    EXPECT_EQ(heat[i], -5.0 * ids[i]);
  }
}

TEST(Snapshot, FlooredTemperaturesAreCountedOverTheRanks) {
  const TemporaryFolder folder;
  Scene scene = test::small_scene(2);
  auto particles = physical_particles<2>(0, 2);
  particles.internal_energy = {-1e9, 0.0};
  const auto materials = test::small_materials();
  const SnapshotInput<2> input{scene, scene_text, materials, particles};
  const std::string path = folder / "failed.h5";
  EXPECT_EQ(write_snapshot(path, input, world), size(world));
  Hdf5File file = Hdf5File::open(path, world);
  EXPECT_EQ(*file.attribute("set_to_floor", "/particles/temperature"),
            AttributeValue(std::int64_t{size(world)}));
  EXPECT_EQ(file.read_all<double>("/particles/temperature")[0], 1.0);
}

TEST(Snapshot, PythonAndTheTimeSeriesAgree) {
  const TemporaryFolder folder;
  const Scene scene = test::small_scene(2);
  write<2>(folder / snapshot_name(0), scene, 0, 0.0);
  write<2>(folder / snapshot_name(3), scene, 3, 1.5e-8);
  write<2>(folder / snapshot_name(1000000), scene, 1000000, 0.1);
  test::rank_zero_alone([&] { std::ofstream(folder / "snapshot_000009.h5") << "not HDF5"; });
  write_xdmf(folder.path(), world);
  if (rank(world) == 0) {
    const std::string command = std::string("/usr/bin/python3 ") + PORESHOCK_TEST_FOLDER +
                                "/read_snapshots.py " + folder.path();
    EXPECT_EQ(std::system(command.c_str()), 0);
    const std::string text = describe(folder / "snapshots.xdmf");
    EXPECT_TRUE(contains(text, "3 snapshots")) << text;
  }
}

TEST(Info, DescribesASnapshot) {
  const TemporaryFolder folder;
  const std::string path = folder / snapshot_name(2);
  write<3>(path, test::small_scene(3), 2, 1e-8);
  if (rank(world) != 0) return;
  const std::string text = describe(path);
  for (const char* part : {"snapshot of poreshock", "intact", "1e-08 s", "200", "conserving",
                           "/particles/stress", "13 x 6  Pa", "float64  13  kg/m^3", "int64"}) {
    EXPECT_TRUE(contains(text, part)) << part << " is missing in\n" << text;
  }
  test::flip_byte(path, std::filesystem::file_size(path) / 2);
  EXPECT_TRUE(contains(describe(path), "damaged")) << describe(path);
  EXPECT_TRUE(
      contains(test::thrown<InputError>([&] { describe(folder / "none.h5"); }), "not found"));
  EXPECT_TRUE(
      contains(test::thrown<InputError>([&] { describe(folder / "none.csv"); }), "not found"));
}

}  // namespace
}  // namespace poreshock
