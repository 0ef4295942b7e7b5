"""Runs that are harmed while they go: everything ends in time with a message, and nothing on disk is lost."""
import os
import re
import shutil
import signal
import subprocess
import time
import unittest

import h5py

from faults import SECONDS, FaultTest, poison, tell
from program import PROGRAM

SHIM = os.environ.get("PORESHOCK_FAULT_MEMORY", "")


class KilledRank(FaultTest):
    def test_in_the_middle_of_a_step(self):
        run = self.start("step", ranks=3)
        run.wait_for(lambda: self.rows("step") > 12)
        os.kill(run.rank(1), signal.SIGKILL)
        result = run.finish(SECONDS)
        self.assertEqual(result.code, 137, str(result))
        self.assertIn("exited on signal 9", result.errors)
        self.assert_checkpoints_intact("step")
        self.assert_continues("step", ranks=2)
        tell("a rank dies", "kill -9 of rank 1 of 3 in the middle of a step",
             re.search(r"mpirun noticed [^.]*\.", re.sub(r"\s+", " ", result.errors))[0])

    def test_in_the_middle_of_a_checkpoint(self):
        """Killed when the unfinished file is there; again if it was finished all the same."""
        caught = False
        for attempt in range(10):
            name = f"checkpoint{attempt}"
            run = self.start(name, "--set", "checkpoint.every_steps=50")
            victim = run.rank(1)
            run.wait_for(lambda: self.rows(name) > 12)
            folder = self.folder / name
            run.wait_for(lambda: any(part.endswith(".part") for part in os.listdir(folder) if part.startswith("check")))
            os.kill(victim, signal.SIGKILL)
            result = run.finish(SECONDS)
            self.assertEqual(result.code, 137, str(result))
            caught = any(folder.glob("checkpoint_*.part"))
            if caught:
                break
        self.assertTrue(caught, "no checkpoint was caught in the middle")
        self.assert_checkpoints_intact(name)
        self.assert_continues(name)
        tell("a rank dies", "kill -9 of rank 1 of 2 while a checkpoint is half written",
             re.search(r"mpirun noticed [^.]*\.", re.sub(r"\s+", " ", result.errors))[0])


class FullDisk(FaultTest):
    def harm(self, name, disk, *arguments, but=0, rows=12):
        """A run whose disk is full, but for some bytes, once its history has so many rows."""
        run = self.start(f"{disk.folder.name}/{name}", *arguments)
        run.wait_for(lambda: self.rows(f"{disk.folder.name}/{name}") > rows)
        disk.fill(but)
        return run

    def test_records_wait_and_are_written_when_there_is_room(self):
        disk = self.disk(24)
        run = self.harm("out", disk, "--set", "checkpoint.every_steps=0")
        run.wait_for(lambda: "is left out" in run.errors() and "wait in memory" in run.errors())
        disk.make_room()
        result = run.finish(120)
        self.assertEqual(result.code, 0, str(result))
        self.assertIn("the disk takes files again: ", result.errors)
        left_out = re.findall(r"^left out: (snapshot_\d{6}\.h5)$", result.output, re.M)
        self.assertGreater(len(left_out), 0)
        self.assertEqual(re.search("checksum .*", result.output)[0], re.search("checksum .*", self.whole[0])[0])
        self.assert_records_whole(f"{disk.folder.name}/out", left_out)
        tell("disk full", "a disk that is full while records are written, with room again later",
             result.errors.splitlines()[0] + " ... " + result.errors.splitlines()[-1],
             "the snapshots of that time (named); nothing else")

    def test_checkpoint_is_tried_again(self):
        disk = self.disk(24)
        # Room for records, not for a checkpoint of ten times their size.
        run = self.harm("out", disk, "--set", "output.snapshot=0", "--set", "morphology.every=100e-9", but=200_000)
        run.wait_for(lambda: "tries again at the next checkpoint" in run.errors())
        disk.make_room()
        result = run.finish(120)
        self.assertEqual(result.code, 0, str(result))
        self.assertRegex(result.errors, r"cannot take \d{6} bytes for \S*/checkpoint_\d{9}\.h5\.part: no space left")
        self.assertEqual(sorted(path.name for path in (disk.folder / "out").glob("checkpoint_*")),
                         [f"checkpoint_{step:09d}.h5" for step in (350, 400, 450)])
        self.assert_checkpoints_intact(f"{disk.folder.name}/out")
        said = next(line for line in result.errors.splitlines() if "tries again at the next checkpoint" in line)
        tell("disk full", "a disk that is full while a checkpoint is due, with room again later", said)

    def test_full_to_the_end(self):
        disk = self.disk(24)
        run = self.harm("out", disk)
        result = run.finish(120)
        self.assertEqual(result.code, 4, str(result))
        said = re.search(r"^poreshock: (the end is reached, but its last records cannot be written: .*)$", result.errors, re.M)
        self.assertIsNotNone(said, str(result))
        self.assert_checkpoints_intact(f"{disk.folder.name}/out")
        disk.make_room()
        self.assert_continues(f"{disk.folder.name}/out")
        tell("disk full", "a disk that stays full to the end of the run", said[1])

    def test_full_at_the_wall_time_limit(self):
        disk = self.disk(24)
        # Early, so that a busy machine comes as far before the time is over.
        run = self.harm("out", disk, "--set", "time.max_steps=0", "--set", "time.end=1e-3", "--set",
                        "checkpoint.every_steps=5", "--wall-time", "12", rows=2)
        result = run.finish(12 + SECONDS)
        self.assertEqual(result.code, 4, str(result))
        said = re.search(r"^poreshock: (asked to stop, but no checkpoint can be written: .*)$", result.errors, re.M)
        self.assertIsNotNone(said, str(result))
        self.assert_checkpoints_intact(f"{disk.folder.name}/out")
        disk.make_room()
        self.assert_continues(f"{disk.folder.name}/out")
        tell("disk full", "a disk that is full when the wall time is over", said[1],
             "the steps since the newest checkpoint; nothing on disk")


class OutputFolderGone(FaultTest):
    def test_removed(self):
        run = self.start("removed")
        run.wait_for(lambda: self.rows("removed") > 12)
        # Out of the way first: a file made meanwhile would keep the folder.
        (self.folder / "removed").rename(self.folder / "gone")
        shutil.rmtree(self.folder / "gone", ignore_errors=True)
        result = run.finish(SECONDS)
        self.assertEqual(result.code, 4, str(result))
        self.assertIn("the end is reached, but its last records cannot be written: ", result.errors)
        self.assertIn("No such file or directory", result.errors)
        tell("output folder removed", "rm -r of the folder while the run goes",
             result.errors.splitlines()[0], "what was removed; the run computes on and says so")

    def test_moved_away_and_back(self):
        run = self.start("moved")
        run.wait_for(lambda: self.rows("moved") > 12)
        (self.folder / "moved").rename(self.folder / "aside")
        run.wait_for(lambda: "wait in memory" in run.errors())
        (self.folder / "aside").rename(self.folder / "moved")
        result = run.finish(120)
        self.assertEqual(result.code, 0, str(result))
        left_out = re.findall(r"^left out: (snapshot_\d{6}\.h5)$", result.output, re.M)
        self.assert_records_whole("moved", left_out)
        tell("output folder moved", "the folder is moved away and back while the run goes",
             result.errors.splitlines()[0], "the snapshots of that time (named), if any")

    def test_remounted_read_only(self):
        disk = self.disk(24)
        name = f"{disk.folder.name}/out"
        run = self.start(name)
        run.wait_for(lambda: self.rows(name) > 12)
        # The open history keeps a file system from becoming read-only; a bind mount has rights of its own.
        done = subprocess.run(["bash", "-c", f"mount --bind {disk.folder} {disk.folder} && "
                               f"mount -o remount,bind,ro {disk.folder}"], check=False, capture_output=True, text=True)
        if done.returncode != 0:
            self.skipTest(f"no bind mount: {done.stderr.strip()}")
        self.addCleanup(subprocess.run, ["umount", "-l", disk.folder], check=False, capture_output=True)
        result = run.finish(SECONDS)
        self.assertEqual(result.code, 4, str(result))
        self.assertIn("Read-only file system", result.errors)
        subprocess.run(["umount", disk.folder], check=True)
        self.assert_checkpoints_intact(name)
        self.assert_continues(name)
        tell("output folder read-only", "mount -o remount,ro while the run goes", result.errors.splitlines()[0])


class BadRank(FaultTest):
    def change_a_mass(self, name, factor):
        """What a run on 3 ranks says when the mass of one particle of rank 2 changes in its memory, and ends with code 3."""
        if not os.access(f"/proc/{os.getpid()}/mem", os.W_OK):
            self.skipTest("the memory of a process cannot be written here")
        run = self.start(name, ranks=3)
        # Between two checkpoints: none is being written.
        run.wait_for(lambda: self.rows(name) > 8)
        with h5py.File(self.folder / "whole/snapshot_000000.h5") as file:
            mass = float(file["particles/mass"][0])
        self.assertGreater(poison(run.rank(2), mass, factor * mass), 0)
        begin = time.monotonic()
        result = run.finish(SECONDS)
        self.assertEqual(result.code, 3, str(result))
        said = re.search(r"^poreshock: (at step .*)$", result.errors, re.M)
        self.assertIsNotNone(said, str(result))
        self.assertLess(time.monotonic() - begin, SECONDS)
        self.assertIn("content   intact\n", self.succeed("info", f"{name}/failed.h5").output)
        (self.folder / name / "failed.h5").unlink()
        return said[1]

    def test_not_a_number_in_one_particle(self):
        said = self.change_a_mass("nan", float("nan"))
        # A particle asleep shows in the balance of energy only, or when a checkpoint is made.
        self.assertRegex(said, "not finite|the energy is .* J/m, it was")
        if any((self.folder / "nan").glob("checkpoint_*")):
            self.assert_continues("nan")
        tell("NaN", "NaN written into the memory of one of 3 ranks, the mass of one particle", said)

    def test_a_wrong_number_in_one_particle(self):
        """Finite, so that only the balance of energy can tell."""
        said = self.change_a_mass("heavy", 1.5)
        self.assertRegex(said, r"the energy is \S+ J/m, it was \S+ J/m at the start")
        tell("wrong number", "the mass of one particle made 1.5 times as large in the memory of one of 3 ranks", said,
             "the records since the one before")

    def start_short_of_memory(self, name, *arguments):
        """A run on 3 ranks; after `run.take_memory()` rank 1 gets no more memory in large pieces."""
        if not SHIM or "libasan" in subprocess.run(["ldd", PROGRAM], capture_output=True, text=True, check=True).stdout:
            self.skipTest("the memory of a rank cannot be taken away under a sanitizer")
        preload = f'if [[ $OMPI_COMM_WORLD_RANK == 1 ]]; then export LD_PRELOAD="{SHIM}"; fi; exec "$@"'
        run = self.start(name, *arguments, ranks=3, wrapper=("bash", "-c", preload, "bash"),
                         environment={"PORESHOCK_FAULT_BYTES": "1000"})
        victim = run.rank(1)
        run.wait_for(lambda: self.rows(name) > 12)
        return run, victim

    def assert_thrown(self, name, run):
        result = run.finish(SECONDS)
        self.assertEqual(result.code, 4, str(result))
        self.assertRegex(result.errors, "out of memory|std::bad_alloc")
        self.assert_checkpoints_intact(name)

    def test_a_rank_that_throws(self):
        run, victim = self.start_short_of_memory("throws")
        os.kill(victim, signal.SIGRTMIN)
        self.assert_thrown("throws", run)
        self.assertIn("poreshock: rank 1: out of memory: ", run.errors())
        self.assert_continues("throws", ranks=2)
        tell("a rank throws", "memory refused to rank 1 of 3 while the others wait for it",
             "poreshock: rank 1: out of memory: use more nodes, larger cells or fewer particles per cell")

    def test_a_rank_that_throws_while_all_write_a_file(self):
        """Harmed when the unfinished snapshot is there; again if it was finished all the same."""
        caught = False
        for attempt in range(10):
            name = f"opened{attempt}"
            run, victim = self.start_short_of_memory(name, "--set", "output.snapshot=2.5e-9", "--set", "morphology.every=0")
            folder = self.folder / name
            run.wait_for(lambda: any(part.startswith("snapshot") and part.endswith(".part") for part in os.listdir(folder)))
            os.kill(victim, signal.SIGRTMIN)
            self.assert_thrown(name, run)
            caught = any(folder.glob("snapshot_*.part"))
            if caught:
                break
        self.assertTrue(caught, "no snapshot was caught in the middle")
        self.run_scene("scene.toml", name, "--restart", "latest")
        self.assertEqual(list(folder.glob("*.part")), [])
        tell("a rank throws", "memory refused to rank 1 of 3 while all write a snapshot together",
             "poreshock: rank 1: out of memory: use more nodes, larger cells or fewer particles per cell")


if __name__ == "__main__":
    unittest.main()
