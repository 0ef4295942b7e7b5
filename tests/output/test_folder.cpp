// The output folder: nothing of the user's is lost, nothing of ours is mixed up.
#include "poreshock/output/folder.hpp"

#include "output/support.hpp"
#include "poreshock/files/posix_file.hpp"
#include "poreshock/output/info.hpp"
#include "poreshock/output/timings.hpp"
#include "poreshock/scene/read_scene.hpp"

namespace poreshock {
namespace {

using test::contains;
using test::file_bytes;
using test::TemporaryFolder;
using test::thrown;

const MPI_Comm world = MPI_COMM_WORLD;

void touch(const std::string& path) {
  std::ofstream(path) << "x";
}

TEST(OutputFolder, IsMadeWithItsParents) {
  const TemporaryFolder folder;
  auto lock = prepare_output_folder(folder / "a/b", false, false, world);
  EXPECT_EQ(lock != nullptr, rank(world) == 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "a/b/poreshock.lock"));
  MPI_Barrier(world);
  lock.reset();
  MPI_Barrier(world);
  EXPECT_TRUE(std::filesystem::is_empty(folder / "a/b"));
  MPI_Barrier(world);
  // An empty one is as good as none.
  lock = prepare_output_folder(folder / "a/b", false, false, world);
}

TEST(OutputFolder, OneThatIsInUseIsRefused) {
  const TemporaryFolder folder;
  const auto lock = prepare_output_folder(folder / "out", false, false, world);
  for (const bool force : {false, true}) {
    const std::string text =
        thrown<InputError>([&] { require_output_folder(folder / "out", force, !force, world); });
    for (const std::string part : {"in use by a run on host ", ", process ", ", started 2",
                                   "poreshock.lock", "wait for its end"}) {
      EXPECT_TRUE(contains(text, part)) << text;
    }
  }
}

/// Writes a lock as another process left it, with one line changed.
void leave_lock(const std::string& folder, const std::string& key, const std::string& value) {
  const std::string path = folder + "/poreshock.lock";
  std::string text;
  {
    const FolderLock lock(folder);
    text = read_text(path);
  }
  const std::size_t at = text.find(key + " ");
  text.replace(at, text.find('\n', at) - at, key + " " + value);
  std::ofstream(path) << text;
}

TEST(FolderLock, KnowsWhoIsNoMore) {
  const TemporaryFolder folder;
  test::rank_zero_alone([&] {
    const std::string path = folder / "poreshock.lock";
    // This very process, without flock(2): as over a file system that has none.
    leave_lock(folder.path(), "started", "2026-01-01 00:00:00 UTC");
    EXPECT_TRUE(contains(thrown<InputError>([&] { const FolderLock lock(folder.path()); }),
                         "started 2026-01-01 00:00:00 UTC"));
    std::filesystem::remove(path);
    leave_lock(folder.path(), "host", "elsewhere");
    const std::string text = thrown<InputError>([&] { const FolderLock lock(folder.path()); });
    EXPECT_TRUE(contains(text, "host elsewhere, process ")) << text;
    EXPECT_TRUE(contains(text, "remove its lock with: rm " + path)) << text;
    std::filesystem::remove(path);
    std::ofstream(path).close();  // of a process that was killed at once
    EXPECT_TRUE(contains(thrown<InputError>([&] { const FolderLock lock(folder.path()); }),
                         "host unknown"));
    std::filesystem::remove(path);
    for (const std::string key : {"process", "ticks", "boot"}) {
      leave_lock(folder.path(), key, key == "process" ? "4194305" : "1");
      { const FolderLock lock(folder.path()); }
      EXPECT_FALSE(std::filesystem::exists(path)) << key;
    }
  });
}

TEST(FolderLock, LeavesThatOfAnotherRunAlone) {
  const TemporaryFolder folder;
  test::rank_zero_alone([&] {
    const std::string path = folder / "poreshock.lock";
    auto lock = std::make_unique<FolderLock>(folder.path());
    std::filesystem::remove(path);
    std::ofstream(path) << "host elsewhere\n";
    lock.reset();
    EXPECT_TRUE(std::filesystem::exists(path));
  });
}

TEST(OutputFolder, SceneOfTheUserIsKept) {
  const TemporaryFolder folder;
  test::rank_zero_alone([&] { touch(folder / "scene.toml"); });
  for (const bool force : {false, true}) {
    EXPECT_TRUE(contains(thrown<InputError>([&] {
                           (void)prepare_output_folder(folder.path(), force, !force, world);
                         }),
                         "its scene.toml was not written by a run"));
    EXPECT_EQ(file_bytes(folder / "scene.toml"), "x");
  }
}

TEST(OutputFolder, ExistingOneIsRefused) {
  const TemporaryFolder folder;
  test::rank_zero_alone([&] { touch(folder / "notes.txt"); });
  const std::string text =
      thrown<InputError>([&] { (void)prepare_output_folder(folder.path(), false, false, world); });
  EXPECT_TRUE(contains(text, folder.path()) && contains(text, "--force") &&
              contains(text, "--restart"))
      << text;
  test::rank_zero_alone([&] { touch(folder / "file"); });
  for (const bool force : {false, true}) {
    EXPECT_TRUE(contains(thrown<InputError>([&] {
                           (void)prepare_output_folder(folder / "file", force, false, world);
                         }),
                         "not a folder"));
    EXPECT_TRUE(contains(thrown<InputError>([&] {
                           (void)prepare_output_folder(folder / "file/below", force, false, world);
                         }),
                         "cannot be made"));
  }
}

TEST(OutputFolder, UnwritableOneIsRefused) {
  const std::string text =
      thrown<InputError>([] { (void)prepare_output_folder("/proc/self", true, false, world); });
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
    std::ofstream(folder / "scene.toml") << resolved_scene_mark;
  });
  (void)prepare_output_folder(folder.path(), false, true, world);
  for (const std::string& name : ours) EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
  for (const std::string& name : unfinished) {
    EXPECT_FALSE(std::filesystem::exists(folder / name)) << name;
  }
  MPI_Barrier(world);
  (void)prepare_output_folder(folder.path(), true, false, world);
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
  timings.warnings = {"a \"b\" \\ c", "two\nlines"};
  write_timings(folder / "timings.json", timings, world);
  const std::string check =
      "import json,sys; t = json.load(open(sys.argv[1])); "
      "assert t['ranks'] == int(sys.argv[2]) and t['wall_seconds'] == 2.5 and t['steps'] == 10; "
      "assert t['particle_steps'] == 12345678901 and t['rate_per_core'] is None; "
      "p = t['phases'][0]; assert p['name'] == 'stress' and p['min'] == 1 and p['calls'] == 5; "
      "q = chr(34); assert t['warnings'] == ['a ' + q + 'b' + q + ' ' + chr(92) + ' c', 'two "
      "lines']";
  if (rank(world) == 0) {
    const std::string command = "/usr/bin/python3 -c \"" + check + "\" " +
                                (folder / "timings.json") + " " + std::to_string(size(world));
    EXPECT_EQ(std::system(command.c_str()), 0);
    EXPECT_TRUE(contains(describe(folder / "timings.json"), "timings of a run"));
  }
}

}  // namespace
}  // namespace poreshock
