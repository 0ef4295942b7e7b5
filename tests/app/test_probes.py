"""Traces of probes: the same on any number of ranks and over a restart, and read back from probes.h5."""
import unittest

import numpy

import program
from program import POROUS

PROBES = """
[[probe]]
name = "top"
at = [0.1e-3]
width = 60e-6
[[probe]]
name = "gauge"
kind = "particle"
at = [0.1e-3, 0.1e-3]
width = 30e-6
every = "beat"
"""
# A flyer hits a plate that lies on a window.
WINDOW = """
[domain]
size = [40e-6, 2.2e-3]
cell = 10e-6
periodic = true
[boundary]
low = { kind = "free", behind = "pmma" }
high = "free"
[[material]]
name = "paper_aluminium"
[[material]]
name = "pmma"
[sample]
kind = "solid"
height = 1.2e-3
[[body]]
shape = "box"
low = [0, 1.2e-3]
high = [40e-6, 1.8e-3]
velocity = [0, -1100]
[time]
end = 260e-9
[[probe]]
name = "window"
at = [20e-6]
width = 40e-6
faces = "down"
"""


class Traces(program.ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write("porous.toml", POROUS + PROBES)
        cls.run_scene("porous.toml", "whole", "--set", "checkpoint.every_steps=0")
        cls.run_scene("porous.toml", "stopped", "--set", "time.max_steps=62", ranks=3)
        cls.run_scene("porous.toml", "stopped", "--restart", "latest", ranks=2)

    def trace(self, folder, name):
        return (self.folder / folder / f"probe_{name}.csv").read_bytes()

    def test_a_restart_on_other_ranks_goes_on_with_the_same_bytes(self):
        for name in ("top", "gauge"):
            self.assertEqual(self.trace("stopped", name), self.trace("whole", name))
        self.assert_same_datasets("stopped/probes.h5", "whole/probes.h5")

    def test_one_row_per_step_or_per_beat(self):
        history = program.history(self.folder / "whole/history.csv")
        steps = int(history["step"][-1])
        self.assertEqual(self.trace("whole", "top").count(b"\n"), steps + 2)
        self.assertEqual(self.trace("whole", "gauge").count(b"\n"), 9 + 1)  # 20 ns in beats of 2.5 ns

    def test_info_on_a_trace(self):
        text = self.succeed("info", "whole/probe_gauge.csv").output
        self.assertTrue(text.startswith("whole/probe_gauge.csv: trace of a probe of a 2-D run of poreshock\nrows      9\n"), text)

    def test_probes_h5_holds_the_traces_and_their_figures(self):
        found = program.datasets(self.folder / "whole/probes.h5")
        lines = self.trace("whole", "gauge").decode().splitlines()
        names = [entry.split(" [")[0] for entry in lines[0].split(",")]
        for k, name in enumerate(names):
            numbers = numpy.array([float(line.split(",")[k]) for line in lines[1:]])
            self.assertTrue(program.same_bits(found[f"gauge/{name}"], numbers), name)
        self.assertAlmostEqual(found["gauge/velocity_y"][0], -1500.0, places=6)
        self.assertGreater(found["gauge/figures/jump_off"][0], 1000.0)
        self.assertTrue(0.0 < found["gauge/figures/arrival"][0] < 20e-9)

    def test_only_a_free_surface_tells_a_spall_strength(self):
        self.run_scene(program.ROOT / "input/plate_spall.toml", "spall", "--set", "time.end=450e-9", ranks=2)
        found = program.datasets(self.folder / "spall/probes.h5")
        self.assertAlmostEqual(found["free_surface/figures/spall_strength"][0], 2e9, delta=0.03 * 2e9)
        for name in ("gauge", "impact_face"):
            self.assertGreater(found[f"{name}/figures/jump_off"][0], 500.0)
            self.assertTrue(numpy.isnan(found[f"{name}/figures/spall_strength"][0]))
        self.write("window.toml", WINDOW)
        self.run_scene("window.toml", "window")
        found = program.datasets(self.folder / "window/probes.h5")
        self.assertGreater(found["window/figures/pull_back"][0], 20.0)
        self.assertTrue(numpy.isnan(found["window/figures/spall_strength"][0]))

    def test_force_removes_old_traces(self):
        self.write("plain.toml", POROUS)
        self.run_scene("porous.toml", "forced", "--set", "time.max_steps=2")
        self.run_scene("plain.toml", "forced", "--force", "--set", "time.max_steps=2")
        self.assertEqual([path.name for path in (self.folder / "forced").glob("probe*")], [])


if __name__ == "__main__":
    unittest.main()
