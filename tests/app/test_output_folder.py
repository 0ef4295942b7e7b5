"""Exit 2: an output folder that cannot be used; and nothing that was there before is lost."""
import os
import re
import signal
import socket
import unittest

from faults import Running
from program import POROUS, ProgramTest, closing_lines

SHORT = ("--set", "time.end=2.5e-9", "--set", "morphology.every=2.5e-9", "--set", "output.snapshot=0")


class OutputFolder(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write("porous.toml", POROUS)
        cls.first = cls.run_scene("porous.toml", "out", *SHORT)
        for name in ("notes.txt", "snapshot_best.h5", "my_scene.toml"):
            cls.write(f"out/{name}", f"the user's {name}\n")

    def refuse_folder(self, message, output, *arguments, ranks=1):
        before = self.contents(".")
        self.refuse(f"output folder {message}", "run", "porous.toml", "--output", output, *arguments, ranks=ranks)
        self.assertEqual(self.contents("."), before)

    def test_existing_folder_is_kept(self):
        self.refuse_folder("out: exists already; choose another with --output, overwrite it with --force, or go on "
                           "from a checkpoint in it with --restart latest", "out", ranks=2)

    def test_empty_folder_is_taken(self):
        for command in (["run", "porous.toml", *SHORT], ["sample", "porous.toml"]):
            (self.folder / f"empty-{command[0]}").mkdir()
            self.succeed(*command, "--output", f"empty-{command[0]}")
            self.assertTrue((self.folder / f"empty-{command[0]}/snapshot_000000.h5").exists())

    def test_scene_of_the_user_is_never_replaced(self):
        (self.folder / "own").mkdir()
        self.write("own/scene.toml", POROUS)
        told = ("own: its scene.toml was not written by a run, which would put its own in the place; choose another folder "
                "with --output, or rename that file")
        for arguments in ([], ["--force"], ["--restart", "latest"], ["--restart", "own/checkpoint_000000025.h5"]):
            before = self.contents(".")
            for name in ("own/scene.toml", "porous.toml"):
                message = self.message(2, "run", name, "--output", "own", *arguments)
                self.assertTrue(message == f"output folder {told}" or "checkpoint" in message, message)
            self.assertEqual(self.contents("."), before)
        for command in (["sample", "own/scene.toml"], ["analyze", "out/snapshot_000000.h5", "--thresholds", "300"]):
            self.refuse(f"output folder {told}", *command, "--output", "own", "--force")

    def test_resolved_scene_with_comments_stays(self):
        self.run_scene("porous.toml", "noted", "--set", "time.max_steps=30", "--set", "time.end=20e-9")
        scene = self.folder / "noted/scene.toml"
        noted = scene.read_text().replace("max_steps = 30 ", "max_steps = 35 ") + "# a remark\n"
        scene.write_text(noted)
        self.run_scene("noted/scene.toml", "noted", "--restart", "latest")
        self.assertEqual(scene.read_text(), noted)
        self.run_scene("noted/scene.toml", "noted", "--restart", "latest", "--set", "time.max_steps=36")
        self.assertIn("max_steps = 36 ", scene.read_text())

    def test_file_in_the_way(self):
        self.write("file", "a file\n")
        self.refuse_folder("file: exists and is not a folder; choose another name", "file", "--force")
        self.refuse_folder("file/below: cannot be made: Not a directory", "file/below")

    def test_place_that_cannot_be_written(self):
        self.refuse_folder("/proc/poreshock: cannot be made: No such file or directory", "/proc/poreshock", ranks=2)
        message = self.message(2, "run", "porous.toml", "--output", "/proc/self", "--force")
        self.assertTrue(message.startswith("output folder /proc/self: not writable: "), message)

    @unittest.skipIf(os.geteuid() == 0, "permissions do not bind the superuser")
    def test_folder_without_permission(self):
        (self.folder / "closed").mkdir(mode=0o500)
        self.refuse_folder("closed/out: cannot be made: Permission denied", "closed/out")

    def test_missing_parents_are_made(self):
        self.assertEqual(closing_lines(self.run_scene("porous.toml", "a/b/c", *SHORT)), closing_lines(self.first))
        self.assertTrue((self.folder / "a/b/c/history.csv").exists())

    def test_force_replaces_our_files_only(self):
        self.run_scene("porous.toml", "forced", "--set", "time.end=7.5e-9")
        theirs = {name: (self.folder / "out" / name).read_bytes()
                  for name in ("notes.txt", "snapshot_best.h5", "my_scene.toml")}
        for name, content in theirs.items():
            (self.folder / "forced" / name).write_bytes(content)
        (self.folder / "forced/snapshot_000099.h5.part").write_bytes(b"of a run that was killed")
        self.run_scene("porous.toml", "forced", "--force", *SHORT)
        self.assertEqual(sorted(path.name for path in (self.folder / "forced").iterdir()),
                         sorted(path.name for path in (self.folder / "out").iterdir()))
        for name, content in theirs.items():
            self.assertEqual((self.folder / "forced" / name).read_bytes(), content)
        self.assertEqual((self.folder / "forced/history.csv").read_bytes(),
                         (self.folder / "out/history.csv").read_bytes())

    def test_force_loses_nothing_when_the_new_run_cannot_begin(self):
        before = self.contents("out")
        for change in ("sample.porosity=0.6", "sample.void_radius=-1"):
            for command in ("run", "sample"):
                self.message(2, command, "porous.toml", "--output", "out", "--force", "--set", change)
                self.assertEqual(self.contents("out"), before)
        low = ("--set", "domain.size=[0.2e-3, 0.09e-3]", "--set", "sample.height=0.09e-3")
        message = self.message(2, "run", "porous.toml", "--output", "out", "--force", *low, ranks=4)
        self.assertIn("4 ranks need at least", message)
        self.assertEqual(self.contents("out"), before)


class Lock(ProgramTest):
    """One run at a time in a folder."""

    def start(self, *arguments):
        run = Running(self.command("run", "long.toml", "--quiet", *arguments, ranks=2), self.folder)
        self.addCleanup(run.stop)
        return run

    def test_folder_in_use(self):
        self.write("long.toml", POROUS.replace("end = 20e-9", "end = 10e-6"))
        lock, history = self.folder / "busy/poreshock.lock", self.folder / "busy/history.csv"
        run = self.start("--output", "busy")
        run.wait_for(lambda: any((self.folder / "busy").glob("checkpoint_*.h5")))
        told = (rf"^output folder busy: in use by a run on host {re.escape(socket.gethostname())}, process {run.rank(0)}, started "
                r"20\d\d-\d\d-\d\d \d\d:\d\d:\d\d UTC \(busy/poreshock\.lock\); wait for its end, or choose another folder with "
                r"--output$")
        for command in (["run", "long.toml"], ["run", "long.toml", "--force"], ["run", "long.toml", "--restart", "latest"],
                        ["sample", "long.toml", "--force"], ["analyze", "busy/snapshot_000000.h5", "--thresholds", "300", "--force"]):
            self.assertRegex(self.message(2, *command, "--output", "busy"), told)
        os.kill(run.rank(1), signal.SIGUSR1)
        self.assertEqual(run.finish(30).code, 0)
        self.assertFalse(lock.exists())
        rows = history.read_bytes().count(b"\n")
        # A run killed with -9 leaves its lock, which the next one tells of and takes away.
        run = self.start("--output", "busy", "--restart", "latest")
        run.wait_for(lambda: history.read_bytes().count(b"\n") > rows)
        os.kill(run.rank(0), signal.SIGKILL)
        run.finish(30)
        self.assertTrue(lock.exists())
        result = self.succeed("run", "long.toml", "--quiet", "--output", "busy", "--restart", "latest", "--wall-time", "0.1")
        self.assertRegex(result.errors, r"warning: the lock of a run on host \S+, process \d+, started \S+ \S+ UTC, which is no more, is "
                                        r"removed \(busy/poreshock\.lock\)")
        self.assertFalse(lock.exists())
        # One from another host cannot be asked.
        lock.write_text("host elsewhere\nprocess 1\nstarted 2026-01-01 00:00:00 UTC\n")
        message = self.message(2, "run", "long.toml", "--output", "busy", "--restart", "latest")
        self.assertIn("a run on host elsewhere, process 1, started 2026-01-01 00:00:00 UTC, which cannot be asked from host ", message)
        self.assertTrue(message.endswith("If it is no more, remove its lock with: rm busy/poreshock.lock"), message)
