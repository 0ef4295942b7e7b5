"""Exit 2: an output folder that cannot be used; and nothing that was there before is lost."""
import os
import unittest

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
