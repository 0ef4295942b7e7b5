// The output folder: nothing of the user's is lost, nothing of ours is mixed up.
#include "poreshock/output/folder.hpp"

#include "output/support.hpp"
#include "poreshock/output/info.hpp"
#include "poreshock/output/posix_file.hpp"
#include "poreshock/output/timings.hpp"

namespace poreshock {
namespace {

using test::contains;
using test::TemporaryFolder;
using test::thrown;

const MPI_Comm world = MPI_COMM_WORLD;

void touch(const std::string& path) {
  std::ofstream(path) << "x";
}

TEST(OutputFolder, IsMadeWithItsParents) {
  const TemporaryFolder folder;
  prepare_output_folder(folder / "a/b", false, false, world);
  EXPECT_TRUE(std::filesystem::is_empty(folder / "a/b"));
}

TEST(OutputFolder, ExistingOneIsRefused) {
  const TemporaryFolder folder;
  const std::string text =
      thrown<InputError>([&] { prepare_output_folder(folder.path(), false, false, world); });
  EXPECT_TRUE(contains(text, folder.path()) && contains(text, "--force") &&
              contains(text, "--restart"))
      << text;
  test::rank_zero_alone([&] { touch(folder / "file"); });
  for (const bool force : {false, true}) {
    EXPECT_TRUE(contains(
        thrown<InputError>([&] { prepare_output_folder(folder / "file", force, false, world); }),
        "not a folder"));
    EXPECT_TRUE(contains(thrown<InputError>([&] {
                           prepare_output_folder(folder / "file/below", force, false, world);
                         }),
                         "cannot be made"));
  }
}

TEST(OutputFolder, UnwritableOneIsRefused) {
  const std::string text =
      thrown<InputError>([] { prepare_output_folder("/proc/self", true, false, world); });
  EXPECT_TRUE(contains(text, "/proc/self") && contains(text, "not writable")) << text;
}

TEST(OutputFolder, ForceRemovesOurFilesOnlyAndRestartNone) {
  const TemporaryFolder folder;
  const std::vector<std::string> ours = {
      "scene.toml",          "history.csv",  "snapshot_000001.h5",   "snapshots.xdmf",
      "morphology.h5",       "timings.json", "morphology_000003.h5", "checkpoint_000000010.h5",
      "snapshot_1234567.h5", "failed.h5",    "report.html",          "pictures/a.png"};
  const std::vector<std::string> foreign = {"notes.txt", "snapshot_best.h5", "my_scene.toml",
                                            "data/run.h5"};
  const std::vector<std::string> unfinished = {"snapshot_000002.h5.part",
                                               "checkpoint_000000011.h5.part"};
  test::rank_zero_alone([&] {
    std::filesystem::create_directory(folder / "pictures");
    std::filesystem::create_directory(folder / "data");
    for (const auto* list : {&ours, &foreign, &unfinished}) {
      for (const std::string& name : *list) touch(folder / name);
    }
  });
  prepare_output_folder(folder.path(), false, true, world);
  for (const std::string& name : ours) EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
  for (const std::string& name : unfinished) {
    EXPECT_FALSE(std::filesystem::exists(folder / name)) << name;
  }
  MPI_Barrier(world);
  prepare_output_folder(folder.path(), true, false, world);
  for (const std::string& name : ours) EXPECT_FALSE(std::filesystem::exists(folder / name)) << name;
  for (const std::string& name : foreign) {
    EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
  }
}

TEST(OutputFolder, RecordsToBeWrittenAgainAreRemoved) {
  const TemporaryFolder folder;
  test::rank_zero_alone([&] {
    for (const std::int64_t record : {4, 5, 6}) {
      touch(folder / numbered_name("snapshot_", record, 6, ".h5"));
      touch(folder / numbered_name("morphology_", record, 6, ".h5"));
    }
    touch(folder / numbered_name("checkpoint_", 6, 9, ".h5"));
  });
  remove_records_from(folder.path(), 5, world);
  EXPECT_EQ(numbered_files(folder.path(), "snapshot_", 6, ".h5").size(), 1u);
  EXPECT_EQ(numbered_files(folder.path(), "morphology_", 6, ".h5").size(), 1u);
  EXPECT_EQ(numbered_files(folder.path(), "checkpoint_", 9, ".h5").size(), 1u);
}

TEST(WriteText, ReplacesTheWholeFile) {
  const TemporaryFolder folder;
  test::rank_zero_alone([&] {
    write_text(folder / "scene.toml", std::string(100000, 'a'));
    write_text(folder / "scene.toml", "short\n");
  });
  EXPECT_EQ(read_text(folder / "scene.toml"), "short\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "scene.toml.part"));
  EXPECT_THROW(read_text(folder / "none"), InputError);
}

TEST(Timings, AreJsonAndGatherAllRanks) {
  const TemporaryFolder folder;
  PhaseTable table;
  table.seconds[static_cast<std::size_t>(PhaseName::stress)] = 1.0 + rank(world);
  table.calls[static_cast<std::size_t>(PhaseName::stress)] = 5;
  Timings timings;
  timings.ranks = size(world);
  timings.wall_seconds = 2.5;
  timings.steps = 10;
  timings.particle_steps = 12345678901;
  timings.rate_per_core = std::numeric_limits<double>::infinity();
  timings.phases = gather_phases(table, world);
  ASSERT_EQ(timings.phases.size(), 1u);
  EXPECT_EQ(timings.phases[0].name, "stress");
  EXPECT_EQ(timings.phases[0].min, 1.0);
  EXPECT_EQ(timings.phases[0].max, static_cast<double>(size(world)));
  EXPECT_EQ(timings.phases[0].avg, 0.5 * (1 + size(world)));
  write_timings(folder / "timings.json", timings, world);
  const std::string check =
      "import json,sys; t = json.load(open(sys.argv[1])); "
      "assert t['ranks'] == int(sys.argv[2]) and t['wall_seconds'] == 2.5 and t['steps'] == 10; "
      "assert t['particle_steps'] == 12345678901 and t['rate_per_core'] is None; "
      "p = t['phases'][0]; assert p['name'] == 'stress' and p['min'] == 1 and p['calls'] == 5";
  if (rank(world) == 0) {
    const std::string command = "/usr/bin/python3 -c \"" + check + "\" " +
                                (folder / "timings.json") + " " + std::to_string(size(world));
    EXPECT_EQ(std::system(command.c_str()), 0);
    EXPECT_TRUE(contains(describe(folder / "timings.json"), "timings of a run"));
  }
}

}  // namespace
}  // namespace poreshock
