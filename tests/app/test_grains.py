"""A bed of grains from check to its last history row, on one rank and on two."""
import h5py
import numpy

from program import POROUS, ProgramTest, closing_lines, history

BED = (POROUS.replace('kind = "random_voids"', 'kind = "packed_grains"').replace("porosity = 0.15", "porosity = 0.3")
       .replace("void_radius = 25e-6", "grain_radius = 25e-6\ngrain_spread = 0.2")
       .replace("ligament = 10e-6\nkeep_out = 10e-6\n", "").replace("[checkpoint]", "[contact]\nfriction = 0.3\n[checkpoint]"))

# Balls of three cells across, of two materials in a box.
BALLS_BED = """
[domain]
size = [0.1e-3, 0.1e-3, 0.2e-3]
cell = 12.5e-6
periodic = [true, false]
[boundary]
low = "wall"
lateral = "symmetry"
[[material]]
name = "copper"
[sample]
kind = "packed_grains"
height = 0.15e-3
grain_radius = 20e-6
porosity = 0.5
[loading]
velocity = 800
[time]
end = 20e-9
"""


class CrowdedGrains(ProgramTest):
    def test_small_balls_are_a_fault_of_the_scene(self):
        """More neighbours than velocity fields: said before anything runs, with the cell that helps."""
        self.write("balls.toml", BALLS_BED)
        for command in (["check", "balls.toml"], ["run", "balls.toml", "--output", "out"], ["sample", "balls.toml"]):
            message = self.message(2, *command, ranks=2)
            self.assertRegex(message, r"^at the start grain \d+ is near \d+ others, grain \d+ among them, and all 12 velocity fields "
                             r"are taken there; grains are near each other where less than 4 cells lie between their "
                             r"particles, and these are 2\.\d+ cells across\. Set domain\.cell to 4\.\d+e-06 m or less, raise "
                             r"sample\.porosity or sample\.grain_gap, make the grains larger, or take a transfer\.shape of a "
                             r"narrower stencil\.$")
        self.assertFalse((self.folder / "out").exists())
        self.assertIn("3 cells lie between", self.message(2, "check", "balls.toml", "--set", "transfer.shape=quadratic",
                                                             "--set", "domain.cell=20e-6"))
        self.succeed("check", "balls.toml", "--set", "domain.cell=4e-6")


class Grains(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write("bed.toml", BED)
        cls.results = {n: cls.run_scene("bed.toml", f"on{n}", "--set", "time.end=10e-9", ranks=n) for n in (1, 2)}

    def test_check_says_what_the_bed_is(self):
        text = self.succeed("check", "bed.toml").output
        self.assertRegex(text, r"grains +\d+, void fraction 0\.3\d* \(asked 0\.300000\), least gap .* m")
        self.assertRegex(text, r"void fraction of the particles +0\.\d+")

    def test_ranks_cannot_be_seen(self):
        self.assertEqual(closing_lines(self.results[1]), closing_lines(self.results[2]))
        with h5py.File(self.folder / "on1/snapshot_000004.h5") as one, h5py.File(self.folder / "on2/snapshot_000004.h5") as two:
            orders = [numpy.argsort(file["particles/id"][...]) for file in (one, two)]
            for name in ("colour", "grain", "temperature", "position"):
                values = [file[f"particles/{name}"][...][order] for file, order in zip((one, two), orders)]
                numpy.testing.assert_array_equal(*values, err_msg=name)
            # Grains that can share a node have colours of their own: more than one, few of them.
            colours = {(int(g), int(c)) for g, c in zip(one["particles/grain"][...], one["particles/colour"][...])}
        self.assertEqual(len(colours), len({grain for grain, _ in colours}))
        self.assertIn(len({colour for _, colour in colours}), range(2, 9))

    def test_history_follows_the_contact(self):
        rows = {n: history(self.folder / f"on{n}/history.csv") for n in (1, 2)}
        for name in ("contact_nodes", "crowded_nodes", "least_gap", "penetration", "momentum_residual", "contact_heat",
                     "friction_heat"):
            numpy.testing.assert_array_equal(rows[1][name], rows[2][name], err_msg=name)
        self.assertGreater(rows[1]["contact_nodes"][-1], 0)
        self.assertGreater(rows[1]["contact_heat"][-1], 0.0)
        self.assertGreater(rows[1]["friction_heat"][-1], 0.0)
        self.assertLess(rows[1]["momentum_residual"].max(), 1e-12)
        self.assertLess(numpy.ptp(rows[1]["total"]), 1e-10 * rows[1]["total"][0])

