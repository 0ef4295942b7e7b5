"""A run that goes on from a checkpoint is, to the last bit, the run that was never interrupted."""
import shutil

import h5py

from program import DISC, POROUS, ProgramTest, closing_lines, flip_byte, history, particles, same_bits


class Restart(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write("porous.toml", POROUS)
        cls.whole = closing_lines(cls.run_scene("porous.toml", "whole", "--set", "checkpoint.every_steps=0"))
        # Stopped in the middle of a beat, a dozen steps after its last checkpoint.
        cls.run_scene("porous.toml", "stopped", "--set", "time.max_steps=62", ranks=3)

    def copy(self, name):
        shutil.copytree(self.folder / "stopped", self.folder / name)
        return name

    def assert_whole(self, name, result):
        """The folder and the closing lines are those of the uninterrupted run."""
        self.assertEqual(closing_lines(result), self.whole)
        self.assertEqual((self.folder / name / "history.csv").read_bytes(),
                         (self.folder / "whole/history.csv").read_bytes())
        self.assert_same_datasets(f"{name}/morphology.h5", "whole/morphology.h5")
        self.assert_same_datasets(f"{name}/profiles.h5", "whole/profiles.h5")
        names = sorted(path.name for path in (self.folder / name).glob("*[!0-9]_0*.h5")
                       if not path.name.startswith("checkpoint"))
        self.assertEqual(names, sorted(path.name for path in (self.folder / "whole").glob("snapshot_*.h5")))
        for snapshot in names:
            a, b = particles(self.folder / name / snapshot), particles(self.folder / "whole" / snapshot)
            self.assertEqual(list(a), list(b))
            for field, values in a.items():
                self.assertTrue(same_bits(values, b[field]), f"{field} of {snapshot}")

    def test_checkpoints_are_written_every_so_many_steps(self):
        names = sorted(path.name for path in (self.folder / "stopped").glob("checkpoint_*"))
        self.assertEqual(names, ["checkpoint_000000025.h5", "checkpoint_000000050.h5"])
        self.assertEqual(list((self.folder / "whole").glob("checkpoint_*")), [])

    def test_checkpoints_by_simulated_and_by_wall_time(self):
        never = ("--set", "checkpoint.every_steps=0", "--set", "checkpoint.keep=100")
        self.run_scene("porous.toml", "beats", "--set", "checkpoint.every_time=5e-9", *never, ranks=2)
        times = []
        for path in sorted((self.folder / "beats").glob("checkpoint_*")):
            with h5py.File(path) as file:
                times.append(round(file.attrs["time"] * 1e9, 6))
        self.assertEqual(times, [5.0, 10.0, 15.0, 20.0])
        result = self.run_scene("porous.toml", "often", "--set", "checkpoint.every_wall=1e-9", "--set", "time.max_steps=9",
                                "--set", "checkpoint.keep=4", *never[:2], ranks=2)
        self.assertIn("finished at step 9, ", result.output)
        self.assertEqual(sorted(path.name for path in (self.folder / "often").glob("checkpoint_*")),
                         [f"checkpoint_{step:09d}.h5" for step in (6, 7, 8, 9)])

    def test_written_on_three_ranks_and_continued_on_others(self):
        for ranks in (1, 2):
            name = self.copy(f"on{ranks}")
            result = self.run_scene("porous.toml", name, "--restart", "latest", ranks=ranks)
            self.assertTrue(result.output.startswith(f"restart from {name}/checkpoint_000000050.h5\n"), str(result))
            self.assert_whole(name, result)

    def test_energy_drift_counts_from_the_start_of_the_run(self):
        """That of the first row ever to the last, as the whole run has it."""
        total = history(self.folder / "whole/history.csv")["total"]
        self.write("drift.toml", POROUS.replace("every_steps = 25", "every_steps = 75"))
        self.run_scene("drift.toml", "late", "--set", "time.max_steps=76")
        for output in ("late", "late-elsewhere"):
            result = self.run_scene("porous.toml", output, "--restart", "late/checkpoint_000000075.h5", ranks=2)
            self.assertIn(f"energy drift {total[-1] / total[0] - 1.0:.1e}, ", result.output)
        with h5py.File(self.folder / "late/checkpoint_000000075.h5") as file:
            self.assertEqual(file.attrs["first_total"], total[0])

    def test_from_an_older_checkpoint_by_name(self):
        name = self.copy("older")
        result = self.run_scene("porous.toml", name, "--restart", f"{name}/checkpoint_000000025.h5", ranks=2)
        self.assert_whole(name, result)

    def test_damaged_newest_checkpoint_is_passed_over(self):
        name = self.copy("damaged")
        flip_byte(self.folder / name / "checkpoint_000000050.h5", 100000)
        result = self.run_scene("porous.toml", name, "--restart", "latest", ranks=2)
        self.assertTrue(result.output.startswith(
            f"passed over {name}/checkpoint_000000050.h5: damaged: its content does not match the hash in its "
            f"header\nrestart from {name}/checkpoint_000000025.h5\n"), str(result))
        self.assert_whole(name, result)

    def test_row_cut_off_by_a_killed_run_is_dropped(self):
        name = self.copy("killed")
        with open(self.folder / name / "history.csv", "a", encoding="ascii") as file:
            file.write("1.25e-08,7")
        (self.folder / name / "checkpoint_000000075.h5.part").write_bytes(b"unfinished")
        self.assert_whole(name, self.run_scene("porous.toml", name, "--restart", "latest"))
        self.assertEqual(list((self.folder / name).glob("*.part")), [])

    def test_into_another_folder(self):
        before = self.contents("stopped")
        result = self.run_scene("porous.toml", "elsewhere", "--restart", "stopped/checkpoint_000000050.h5")
        self.assertEqual(closing_lines(result), self.whole)
        self.assertEqual(self.contents("stopped"), before)
        rows = (self.folder / "whole/history.csv").read_text().splitlines()
        late = [row for row in rows[1:] if int(row.split(",")[1]) > 50]
        self.assertEqual((self.folder / "elsewhere/history.csv").read_text().splitlines(), [rows[0], *late])

    def test_a_finished_run_is_extended(self):
        self.write("short.toml", POROUS.replace("end = 20e-9", "end = 12.5e-9"))
        self.run_scene("short.toml", "extended", ranks=2)
        result = self.run_scene("porous.toml", "extended", "--restart", "latest")
        self.assert_whole("extended", result)


class LimitOfAnotherRank(ProgramTest):
    def test_checkpoint_keeps_the_step_limit_of_all_ranks(self):
        self.write("disc.toml", DISC)
        whole = closing_lines(self.run_scene("disc.toml", "whole"))
        self.assertEqual(whole, closing_lines(self.run_scene("disc.toml", "part", ranks=2)))
        steps = history(self.folder / "part/history.csv")["step"][-1]
        self.assertEqual(steps, 45)
        result = self.run_scene("disc.toml", "part", "--restart", "latest", ranks=3)
        self.assertTrue(result.output.startswith("restart from part/checkpoint_000000035.h5\n"), str(result))
        self.assertEqual(closing_lines(result), whole)
        self.assertEqual((self.folder / "part/history.csv").read_bytes(),
                         (self.folder / "whole/history.csv").read_bytes())
