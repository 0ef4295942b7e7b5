"""Exit 2: a checkpoint a run cannot go on from; and what the folder holds is kept."""
import shutil

import h5py

from faults import tell
from program import BALLS, DISC, POROUS, ProgramTest, flip_byte


class RefusedRestart(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write("porous.toml", POROUS)
        cls.write("disc.toml", DISC)
        cls.write("balls.toml", BALLS)
        cls.run_scene("porous.toml", "out", "--set", "time.max_steps=30", ranks=2)
        cls.checkpoint = "out/checkpoint_000000025.h5"
        cls.whole = (cls.folder / cls.checkpoint).read_bytes()

    def tearDown(self):
        (self.folder / self.checkpoint).write_bytes(self.whole)

    def refuse_restart(self, message, restart, *arguments, scene="porous.toml", output="out", ranks=1):
        before = self.contents(".")
        self.refuse(message, "run", scene, "--output", output, "--restart", restart, *arguments, ranks=ranks)
        self.assertEqual(self.contents("."), before)

    def test_foreign_file(self):
        shutil.copy(self.folder / "out/snapshot_000000.h5", self.folder / "out/copy.h5")
        self.refuse_restart("out/copy.h5: not a checkpoint of poreshock", "out/copy.h5", ranks=2)
        self.write("out/text.h5", "not HDF5\n")
        self.refuse_restart("out/text.h5: not a file of poreshock, or truncated: it has 9 bytes, its header alone takes 4096",
                            "out/text.h5")

    def test_missing_file(self):
        self.refuse_restart("out/none.h5: not found, or not a file", "out/none.h5", ranks=3)
        self.refuse_restart("out: not found, or not a file", "out")

    def test_truncated_checkpoint(self):
        (self.folder / self.checkpoint).write_bytes(self.whole[:-1000])
        size = len(self.whole)
        said = f"{self.checkpoint}: truncated or extended: it has {size - 1000} bytes, its header says {size}"
        self.refuse_restart(said, self.checkpoint, ranks=2)
        tell("damaged checkpoint", "the last 1000 bytes cut off", said)

    def test_flipped_byte(self):
        for at in (0, 9, 40, 3000, 4095, 4100, len(self.whole) // 2, len(self.whole) - 1):
            (self.folder / self.checkpoint).write_bytes(self.whole)
            flip_byte(self.folder / self.checkpoint, at)
            said = (f"{self.checkpoint}: damaged: its content does not match the hash in its header" if at >= 4096 else
                    f"{self.checkpoint}: damaged: its header does not match the header's own hash" if at >= 8 else
                    f"{self.checkpoint}: damaged, its first 8 bytes are not the mark of poreshock files")
            self.refuse_restart(said, self.checkpoint, ranks=3 if at in (9, 4100) else 1)
            place = {0: "the mark", 40: "the padding of the header", 4100: "the content"}.get(at)
            if place:
                tell("damaged checkpoint", f"one byte flipped in {place}", said)

    def test_no_good_checkpoint_for_latest(self):
        flip_byte(self.folder / self.checkpoint, len(self.whole) // 2)
        self.refuse_restart("out: holds no usable checkpoint (checkpoint_NNNNNNNNN.h5):\n"
                            f"passed over {self.checkpoint}: damaged: its content does not match the hash in its header",
                            "latest", ranks=2)

    def test_no_checkpoint_for_latest(self):
        self.refuse_restart("none: holds no usable checkpoint (checkpoint_NNNNNNNNN.h5)", "latest", output="none")
        (self.folder / "empty").mkdir()
        self.refuse_restart("empty: holds no usable checkpoint (checkpoint_NNNNNNNNN.h5)", "latest", output="empty")

    def test_another_dimension(self):
        said = f"{self.checkpoint}: holds a 2-D run, the scene asks for 3-D"
        self.refuse_restart(said, self.checkpoint, scene="balls.toml", output="balls", ranks=2)
        tell("wrong checkpoint", "a checkpoint of a 2-D run for a 3-D scene", said)

    def test_other_physics(self):
        allowed = ("; allowed are differences in the title, time.end, time.max_steps, output, checkpoint, profile and morphology: "
                   "restart with the scene.toml beside it, or start a new run")
        written = f"{self.checkpoint} was written by a scene that differs in "
        tell("wrong checkpoint", "another impact velocity on restart", written + "loading.velocity" + allowed)
        self.refuse_restart(written + "loading.velocity" + allowed, "latest", "--set", "loading.velocity=1400", ranks=2)
        self.refuse_restart(written + "output.beat, time.cfl" + allowed, "latest", "--set", "time.cfl=0.3", "--set",
                            "output.beat=5e-9", "--set", "output.history=5e-9")
        self.refuse_restart(written + "material.0.conductivity" + allowed, "latest", "--set",
                            "material.0.conductivity=237")
        self.refuse_restart(written + "body, domain.size, loading.velocity, output.beat, sample.height, sample.keep_out, "
                            "sample.kind, sample.ligament, sample.porosity, sample.void_radius" + allowed, self.checkpoint,
                            scene="disc.toml", output="disc")

    def test_other_thresholds_in_the_same_folder(self):
        other = ("--set", "morphology.thresholds.pressure=[1e9, 6e9]")
        self.refuse_restart(f"{self.checkpoint} was written with other morphology fields, thresholds, domains, lattice or "
                            "pixel, which cannot go on in the same folder: keep them, or choose another folder with "
                            "--output", "latest", *other)
        self.run_scene("porous.toml", "elsewhere", "--restart", self.checkpoint, *other, "--set", "time.end=10e-9")

    def test_end_before_the_checkpoint(self):
        with h5py.File(self.folder / self.checkpoint) as file:
            time = file.attrs["time"]
        advice = "; nothing was changed. Raise it, or name an earlier checkpoint with --restart FILE"
        for restart in ("latest", self.checkpoint):
            self.refuse_restart(f"time.end: found 1e-09 s, allowed at least the time of {self.checkpoint}, {time:.9g} s{advice}",
                                restart, "--set", "time.end=1e-9", ranks=2)
            self.refuse_restart(f"time.max_steps: found 24, allowed 0 or at least the step of {self.checkpoint}, 25{advice}",
                                restart, "--set", "time.max_steps=24")
        self.refuse_restart(f"time.end: found 1e-09 s, allowed at least the time of {self.checkpoint}, {time:.9g} s{advice}",
                            self.checkpoint, "--set", "time.end=1e-9", output="elsewhere")

    def test_records_of_another_program(self):
        """Told before anything is cut, with the way to go on, which works."""
        advice = ("not those that this program writes for this scene; go on with the program that wrote it, or leave it as "
                  "it is and go on in another folder with --output DIR --restart CHECKPOINT")
        history = self.folder / "out/history.csv"
        whole = history.read_bytes()
        history.write_bytes(whole.replace(b",guards [-]", b"", 1))
        self.refuse_restart(f"out/history.csv:1: its columns are {advice}", "latest", ranks=2)
        self.run_scene("porous.toml", "beside", "--restart", self.checkpoint, "--set", "time.end=10e-9")
        history.write_bytes(whole)
        # Profiles of a grid of other rows stand for those of a program with other curves.
        self.write("low.toml", POROUS.replace("0.48e-3", "0.5e-3"))
        self.run_scene("low.toml", "low", "--set", "time.max_steps=2")
        profiles = (self.folder / "out/profiles.h5").read_bytes()
        shutil.copy(self.folder / "low/profiles.h5", self.folder / "out/profiles.h5")
        self.refuse_restart(f"out/profiles.h5: its heights or curves are {advice}", "latest", ranks=2)
        (self.folder / "out/profiles.h5").write_bytes(profiles)

    def test_existing_folder_of_another_run(self):
        self.write("other.toml", POROUS)
        self.run_scene("other.toml", "other", "--set", "time.max_steps=2")
        self.refuse_restart("output folder other: exists already; choose another with --output, overwrite it with "
                            "--force, or go on from a checkpoint in it with --restart latest", self.checkpoint,
                            output="other", ranks=2)
