"""Morphology of a run: domains and hot spots while it goes, the same on any number of ranks."""
import unittest

import numpy

import program
from program import POROUS

LISTED = [600.0, 800.0]
DOMAINS = ("--set", "morphology.domains=true",
           "--set", "morphology.hot_spots={ temperature = [600, 800] }")


class Independence(program.ProgramTest):
    """What is asked of a map has no part in it."""

    # The scene's fields with thresholds near, at and far from what occurs.
    ASKED = {"near": ("[299, 300, 310, 500]", "[1e6, 5e9]"), "far": ("[299, 300, 1e9]", "[1e6]"),
             "at": ("{ from = 300, to = 900, step = 100 }", "[0, 1e6, 1e30]"),
             "more": ("{ from = 300, to = 1000, step = 100 }", "[-1e9, 1e6]")}

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write("porous.toml", POROUS)
        for name, (temperature, pressure) in cls.ASKED.items():
            cls.run_scene("porous.toml", name, "--set", "time.end=10e-9", "--set", "viscosity.limited=false", "--set",
                          f"morphology.thresholds={{ temperature = {temperature}, pressure = {pressure} }}",
                          "--set", "morphology.hot_spots={ pressure = [1e6, 5e9] }", "--set", "morphology.domains=true")
        cls.found = {name: program.datasets(cls.folder / name / "morphology.h5") for name in cls.ASKED}

    def test_same_map(self):
        last = [sorted((self.folder / name).glob("snapshot_*.h5"))[-1] for name in self.ASKED]
        for field in ("temperature", "pressure"):
            maps = [program.datasets(path)[f"map/{field}"] for path in last]
            for other in maps[1:]:
                self.assertTrue(program.same_bits(maps[0], other), field)
        self.assertGreater(numpy.nanmax(maps[0]), 10e9)

    def test_same_curves_where_asked_the_same(self):
        for field, level in (("temperature", 300.0), ("pressure", 1e6)):
            for name in ("F", "E", "V", "L", "chi", "chi_paper", "n_W"):
                columns = [data[f"{field}/{name}"][:, data[f"{field}/threshold"] == level] for data in self.found.values()]
                for other in columns[1:]:
                    numpy.testing.assert_array_equal(columns[0], other, err_msg=f"{field} {name}")
        # At rest all of it is at T0, which is 300 K.
        numpy.testing.assert_array_equal(self.found["at"]["temperature/A"][0, 0], 1.0)
        numpy.testing.assert_array_equal(self.found["far"]["temperature/A"][0], [1.0, 1.0, 0.0])

    def test_rounding_at_rest_is_no_cold(self):
        """What lies ahead of the shock is at 300 K but for less than a map resolves, 2^-31 of it."""
        image = program.datasets(self.folder / "at/snapshot_000004.h5")["map/temperature"]
        below = image[image < 300]
        self.assertGreater(len(below), 0)
        self.assertLess(300 - below.min(), 300 * 2.0**-31)
        self.assertEqual(self.found["at"]["temperature/A"][-1, 0], 1.0)
        self.run_scene("porous.toml", "sites", "--set", "time.end=10e-9", "--set", "viscosity.limited=false", "--set",
                       "morphology.lattice=lagrangian", "--set",
                       "morphology.thresholds={ temperature = [300], pressure = [1e9] }")
        self.assertEqual(program.datasets(self.folder / "sites/morphology.h5")["temperature/A"][-1, 0], 1.0)

    def test_same_hot_spots(self):
        spots = {name: data["pressure/domains/peak"] for name, data in self.found.items()}
        for other in spots.values():
            self.assertTrue(program.same_bits(spots["near"], other))
        self.assertGreater((self.found["far"]["pressure/domains/threshold"] == 5e9).sum(), 0)

    def test_a_snapshot_gives_the_same_whatever_is_asked(self):
        snapshot = "far/snapshot_000004.h5"
        self.succeed("analyze", snapshot, "--field", "pressure", "--thresholds", "1e6", "--output", "low")
        self.succeed("analyze", snapshot, "--field", "pressure", "--thresholds", "1e6,1e15", "--output", "high")
        low, high = (program.datasets(self.folder / name / "morphology.h5") for name in ("low", "high"))
        self.assertEqual(low["pressure/chi"][0, 0], high["pressure/chi"][0, 0])
        self.assertEqual(low["pressure/F"][0, 0], self.found["far"]["pressure/F"][-1, 0])

    def test_rest_in_single_precision(self):
        """T0 = 298.15 K is no number of 32 bits; the map of a body at rest still reaches it."""
        self.run_scene("porous.toml", "single", "--set", "time.end=5e-9", "--set", "output.precision=single",
                       "--set", "loading.velocity=0", "--set", "material.0.T0=298.15", "--set",
                       "morphology.thresholds={ temperature = [298.15], pressure = [1e9] }")
        self.succeed("analyze", "single/snapshot_000000.h5", "--thresholds", "298.15", "--output", "rest")
        rest = program.datasets(self.folder / "rest/morphology.h5")
        stored = program.particles(self.folder / "single/snapshot_000000.h5")["temperature"]
        self.assertEqual(set(stored), {numpy.float32(298.15)})
        self.assertEqual(rest["temperature/A"][0, 0], 1.0)
        self.assertEqual(program.datasets(self.folder / "single/morphology.h5")["temperature/A"][0, 0], 1.0)


class Domains(program.ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write("porous.toml", POROUS)
        for ranks in (1, 2, 4):
            cls.run_scene("porous.toml", f"run{ranks}", *DOMAINS, ranks=ranks)
        cls.all = program.datasets(cls.folder / "run1/morphology.h5")

    def test_same_on_any_number_of_ranks(self):
        for ranks in (2, 4):
            self.assert_same_datasets("run1/morphology.h5", f"run{ranks}/morphology.h5")

    def test_counts_fit_each_other(self):
        for field in ("temperature", "pressure"):
            data = {name.split("/")[1]: values for name, values in self.all.items()
                    if name.startswith(field + "/") and "domains" not in name}
            pixels = data["pixels"][:, None]
            numpy.testing.assert_array_equal(data["chi_paper"], (data["n_W"] - data["n_B"]) / pixels)
            # A domain has a pixel; all pixels have one of two colours.
            self.assertTrue((data["n_W"] <= data["F"]).all() and (data["n_B"] <= pixels - data["F"]).all())
            numpy.testing.assert_array_equal(data["n_W"] > 0, data["F"] > 0)
            numpy.testing.assert_array_equal(data["n_B"] > 0, data["F"] < pixels)
            self.assertTrue((data["n_B_frame"] <= data["n_B"]).all())

    def test_hot_spots_add_up(self):
        spots = {name.split("/")[2]: values for name, values in self.all.items() if "temperature/domains/" in name}
        records = self.all["temperature/record"]
        thresholds = self.all["temperature/threshold"]
        # The band behind the wall winds, spots ahead of it do not: the run has both.
        self.assertEqual(set(spots["winds"].ravel()), {0, 1})
        for record in records:
            for level in LISTED:
                mine = (spots["record"] == record) & (spots["threshold"] == level)
                row, column = numpy.searchsorted(records, record), numpy.searchsorted(thresholds, level)
                self.assertEqual(thresholds[column], level)
                self.assertEqual(mine.sum(), self.all["temperature/n_W"][row, column])
                self.assertEqual(spots["pixels"][mine].sum(), self.all["temperature/F"][row, column])
                self.assertEqual(spots["winds"][mine].sum(), self.all["temperature/white_winding"][row, column])
                self.assertTrue((numpy.diff(spots["pixels"][mine]) <= 0).all())
        self.assertTrue((spots["peak"] >= spots["mean"] * (1 - 1e-9)).all())
        self.assertTrue((spots["mean"] >= spots["threshold"] * (1 - 1e-9)).all())
        # Inside the block of 0.2 x 0.48 mm, in metres.
        still = spots["winds"][:] == 0
        self.assertTrue(((spots["centroid"][still] > 0) & (spots["centroid"][still] < [0.2e-3, 0.48e-3])).all())
        numpy.testing.assert_allclose(spots["area"], spots["pixels"] * 10e-6 ** 2, rtol=1e-12)

    def test_sites_of_the_particles(self):
        """On the initial lattice every particle is a pixel from first to last: voids never close."""
        sites = ("--set", "morphology.lattice=lagrangian", *DOMAINS)
        for ranks in (1, 3):
            self.run_scene("porous.toml", f"sites{ranks}", *sites, ranks=ranks)
        self.assert_same_datasets("sites1/morphology.h5", "sites3/morphology.h5")
        found = program.datasets(self.folder / "sites1/morphology.h5")
        particles = [program.particles(path) for path in sorted((self.folder / "sites1").glob("snapshot_*.h5"))]
        self.assertEqual(set(found["temperature/pixels"]), {len(particles[0]["id"])})
        hot = particles[-1]["temperature"][:, None] >= found["temperature/threshold"]
        numpy.testing.assert_array_equal(found["temperature/F"][-1], hot.sum(axis=0))
        # Two neighbouring sites along x, one above and one below the threshold, are an edge inside.
        image = numpy.full((96, 40), numpy.nan)
        image.flat[particles[-1]["id"]] = particles[-1]["temperature"]
        for level, length in zip(found["temperature/threshold"], found["temperature/B_int"][-1]):
            edges = 0
            for other in (numpy.roll(image, -1, axis=1), numpy.vstack((image[1:], numpy.full((1, 40), numpy.nan)))):
                both = ~numpy.isnan(image) & ~numpy.isnan(other)
                edges += (both & ((image >= level) != (other >= level))).sum()
            self.assertEqual(length, edges)
        # What the run measured is what a snapshot of it gives.
        self.succeed("analyze", "sites1/snapshot_000008.h5", "--thresholds", "310:900:10", "--output", "after")
        after = program.datasets(self.folder / "after/morphology.h5")
        numpy.testing.assert_array_equal(after["temperature/chi_paper"][0], found["temperature/chi_paper"][-1])

    def test_quantiles(self):
        """Thresholds by shares of the material, which differ from record to record."""
        shares = [0.1, 0.5, 0.5625, 0.9, 1.0]
        scene = ("--set", f"morphology.thresholds={{ temperature = {{ quantiles = {shares} }}, pressure = [1e9, 5e9] }}",
                 "--set", "morphology.domains=true")
        for ranks in (1, 3):
            self.run_scene("porous.toml", f"shares{ranks}", *scene, ranks=ranks)
        self.assert_same_datasets("shares1/morphology.h5", "shares3/morphology.h5")
        found = program.datasets(self.folder / "shares1/morphology.h5")
        numpy.testing.assert_array_equal(found["temperature/threshold"], shares)
        self.assertNotIn("pressure/level", found)
        level, white, pixels = (found[f"temperature/{name}"] for name in ("level", "F", "pixels"))
        self.assertEqual(level.shape, (len(pixels), len(shares)))
        self.assertTrue((numpy.diff(level, axis=1) >= 0).all() and (level[-1, 3] > level[0, 3] + 50))
        # The level is the pixel ceil(p N) of the sorted ones: it and those after it are at least as hot.
        number = numpy.maximum(numpy.ceil(numpy.array(shares) * pixels[:, None]), 1)
        self.assertTrue((white >= pixels[:, None] - number + 1).all())
        # Exactly so many where no two pixels are equally hot, as in the compressed half.
        numpy.testing.assert_array_equal(white[-1, 3:], (pixels[:, None] - number + 1)[-1, 3:])
        # A snapshot gives what the run measured, to the bit.
        self.succeed("analyze", "shares1/snapshot_000008.h5", "--quantiles", ",".join(map(str, shares)), "--output",
                     "shares_after", ranks=2)
        after = program.datasets(self.folder / "shares_after/morphology.h5")
        for name in ("level", "F", "E", "V", "L", "chi", "chi_paper"):
            numpy.testing.assert_array_equal(after[f"temperature/{name}"][0], found[f"temperature/{name}"][-1])
        # Runs are compared share by share, and not with runs at thresholds in kelvin.
        self.run_scene("porous.toml", "slow", *scene, "--set", "loading.velocity=1300")
        self.assertIn("temperature against shares1", self.succeed("compare", "shares1", "slow").output)
        self.refuse("shares1 was measured at quantiles, run1 at values in K: allowed are two runs of one kind; measure the "
                    "snapshots of one again with poreshock analyze --quantiles or --thresholds", "compare", "run1", "shares1")

    def test_no_domains_unless_asked_for(self):
        self.run_scene("porous.toml", "plain", "--set", "time.end=5e-9")
        names = list(program.datasets(self.folder / "plain/morphology.h5"))
        self.assertFalse([name for name in names if "domains" in name or "n_W" in name or "chi_paper" in name])


if __name__ == "__main__":
    unittest.main()
