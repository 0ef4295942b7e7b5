"""A domain that follows the front: strips keep what was left behind, and restarts and ranks keep the bytes."""
import unittest

import numpy

import program

SCENE = """
[domain]
size = [60e-6, 1.28e-3]
cell = 10e-6
periodic = true
[boundary]
low = "wall"
[[material]]
name = "paper_aluminium"
[sample]
kind = "random_voids"
height = 2.4e-3
porosity = 0.05
void_radius = 15e-6
[loading]
velocity = 1500
[time]
end = 260e-9
follow = "front"
[output]
snapshot = 50e-9
[morphology]
every = 20e-9
fields = ["temperature"]
thresholds = { from = 350, to = 1500, step = 50 }
hot_spots = [900]
[checkpoint]
every_steps = 150
"""


class Window(program.ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write("long.toml", SCENE)
        cls.run_scene("long.toml", "whole")
        cls.run_scene("long.toml", "parts", "--set", "time.max_steps=700", ranks=2)
        cls.run_scene("long.toml", "parts", "--restart", "latest")

    def strips(self, folder):
        return sorted((self.folder / folder).glob("handed_over_*.h5"))

    def test_ranks_and_a_restart_change_nothing(self):
        self.assertEqual(len(self.strips("parts")), len(self.strips("whole")))
        for name in ("morphology.h5", "strips.h5", "profiles.h5"):
            self.assert_same_datasets(f"parts/{name}", f"whole/{name}")
        one, other = (program.history(self.folder / folder / "history.csv") for folder in ("parts", "whole"))
        for name, column in one.items():
            self.assertEqual(column.tolist(), other[name].tolist(), name)

    def test_every_particle_is_in_one_strip_or_in_the_window(self):
        self.assertGreater(len(self.strips("whole")), 3)
        last = sorted((self.folder / "whole").glob("snapshot_*.h5"))[-1]
        ids = numpy.concatenate([program.particles(path)["id"] for path in [*self.strips("whole"), last]])
        self.assertEqual(len(numpy.unique(ids)), len(ids))
        # From the wall on nothing is missing up to the top of the window: 12 sites a layer, few of them void.
        self.assertGreater(len(ids), 0.9 * ids.max())
        history = program.history(self.folder / "whole/history.csv")
        self.assertAlmostEqual(history["total"][-1] / history["total"][0], 1.0, places=12)
        self.assertGreater(history["handed_over"][-1], 0.0)

    def test_strips_say_where_they_lie_and_what_was_hot(self):
        strips = program.datasets(self.folder / "whole/strips.h5")
        low = strips["temperature/low"]
        self.assertEqual(len(low), len(self.strips("whole")))
        self.assertEqual(low[0], 0.0)
        rows = numpy.diff(low) / 10e-6
        self.assertTrue(numpy.all((rows > 7.5) & (rows < 16.5)), rows)
        for k, path in enumerate(self.strips("whole")):
            particles = program.particles(path)
            height = particles["position"][:, 1]
            self.assertGreaterEqual(height.min(), low[k])
            if k + 1 < len(low):
                self.assertLess(height.max(), low[k + 1])
            # The coldest threshold has been passed everywhere, and pixels are cells.
            hot = strips["temperature/A"][k][0]
            self.assertGreater(hot, 0.95)
            area = 1e-10 * strips["temperature/pixels"][k]
            self.assertAlmostEqual(area, (particles["mass"] / particles["density"]).sum(), delta=0.12 * area)

    def test_waves_that_run_ahead_of_the_front_end_the_run(self):
        message = self.message(3, "run", "long.toml", "--output", "weak", "--set", "loading.velocity=200",
                               "--set", "sample.kind=solid", "--set", "sample.height=20e-3", "--set", "time.end=3e-6")
        self.assertIn("the domain is too low to hold both", message)


if __name__ == "__main__":
    unittest.main()
