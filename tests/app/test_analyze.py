"""Morphology of snapshots: as the run measured it, and in other ways."""
import unittest

import h5py
import numpy

import program
from program import POROUS


class Snapshots(program.ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write("porous.toml", POROUS)
        cls.run_scene("porous.toml", "run", "--set", "morphology.domains=true",
                      "--set", "morphology.hot_spots={temperature=[600,800]}")
        cls.snapshots = sorted(path.relative_to(cls.folder) for path in (cls.folder / "run").glob("snapshot_*.h5"))

    def test_as_the_run_measured_them(self):
        for ranks in (1, 3):
            self.succeed("analyze", *self.snapshots, "--thresholds", "310:900:10", "--hot-spots", "600,800",
                         "--output", f"after{ranks}", ranks=ranks)
            after = program.datasets(self.folder / f"after{ranks}/morphology.h5")
            during = program.datasets(self.folder / "run/morphology.h5")
            records = during["temperature/record"]
            stored = numpy.isin(records, after["temperature/record"])
            self.assertEqual(stored.sum(), 3)
            spots = numpy.isin(during["temperature/domains/record"], after["temperature/record"])
            self.assertGreater(spots.sum(), 0)
            compared = [name for name in during if name.startswith("temperature/")]
            self.assertEqual(compared, list(after))
            for name in compared:
                expected = during[name]
                if "domains" in name:
                    expected = expected[spots]
                elif not name.endswith("threshold"):
                    expected = expected[stored]
                self.assertTrue(program.same_bits(expected, after[name]), name)

    def test_every_field(self):
        for field, levels in (("pressure", "1e9,5e9"), ("density", "2800:3400:100"), ("speed", "100,1000"),
                              ("von_mises", "1e8,2e8"), ("plastic_strain", "0.1,0.5")):
            output = self.succeed("analyze", self.snapshots[-1], "--field", field, "--thresholds", levels).output
            self.assertIn(f": {field}, ", output)
        self.run_scene("porous.toml", "fields", "--set", "time.end=5e-9", "--set",
                       "morphology.fields=['von_mises','speed']", "--set",
                       "morphology.thresholds={von_mises=[1e8,1.2e8,1.5e8],speed=[100,700,1200]}")
        during = program.datasets(self.folder / "fields/morphology.h5")
        for field, levels in (("von_mises", "1e8,1.2e8,1.5e8"), ("speed", "100,700,1200")):
            self.succeed("analyze", "fields/snapshot_000002.h5", "--field", field, "--thresholds", levels,
                         "--output", f"after_{field}")
            after = program.datasets(self.folder / f"after_{field}/morphology.h5")
            self.assertTrue(0 < after[f"{field}/A"][0, 1] < 1)
            numpy.testing.assert_array_equal(after[f"{field}/F"][0], during[f"{field}/F"][-1])

    def test_quantiles_voids_and_isolines_of_a_snapshot(self):
        snapshot = self.snapshots[-1]
        self.succeed("analyze", snapshot, "--quantiles", "0.2,0.5,0.9", "--output", "shares", ranks=2)
        shares = program.datasets(self.folder / "shares/morphology.h5")
        numpy.testing.assert_array_equal(shares["temperature/threshold"], [0.2, 0.5, 0.9])
        with h5py.File(self.folder / "shares/morphology.h5") as file:
            self.assertEqual(file["temperature/threshold"].attrs["unit"], "1")
            self.assertEqual(file["temperature/level"].attrs["unit"], "K")
            self.assertEqual(file["temperature/L_physical"].attrs["unit"], "1/m")
            pixel = file.attrs["pixel"]
        # At least the share p of all pixels is no hotter than the level, and so at most 1 - p hotter.
        material = int(shares["temperature/pixels"][0])
        for p, level, white in zip((0.2, 0.5, 0.9), shares["temperature/level"][0], shares["temperature/F"][0]):
            self.assertGreaterEqual(white, material - numpy.ceil(p * material) + 1)
            above = float(level) * (1 + 1e-9)  # a threshold is reached from 2^-31 of it below
            self.succeed("analyze", snapshot, "--thresholds", repr(above), "--output", f"above{p}")
            hotter = program.datasets(self.folder / f"above{p}/morphology.h5")["temperature/F"][0, 0]
            self.assertLessEqual(hotter, material - numpy.ceil(p * material))
        numpy.testing.assert_allclose(shares["temperature/L_physical"], shares["temperature/L"] / pixel, rtol=1e-15)
        numpy.testing.assert_allclose(shares["temperature/chi_physical"], shares["temperature/chi"] / pixel**2, rtol=1e-15)
        found = {}
        for voids in ("black", "white", "fill", "exclude"):
            self.succeed("analyze", snapshot, "--thresholds", "310:600:10", "--voids", voids, "--isoline", "--output", voids,
                         ranks=3)
            found[voids] = program.datasets(self.folder / f"{voids}/morphology.h5")
            # Area, boundary and counts are of the material whatever a void is for chi.
            for name in ("A", "L", "L_crofton", "L_isoline", "F", "E", "V", "n_W"):
                numpy.testing.assert_array_equal(found[voids][f"temperature/{name}"], found["black"][f"temperature/{name}"])
        black, chi = found["black"], {voids: arrays["temperature/chi"][0] for voids, arrays in found.items()}
        # Voids inside hot material, from 320 K on: each is a hole when black, and none when white or filled.
        hottest = slice(1, 6)
        self.assertTrue((chi["white"] >= chi["black"]).all())
        self.assertTrue((chi["fill"][hottest] > chi["black"][hottest]).all())
        # Pixel sides are longer than the line they follow, by 4/pi for all directions alike.
        measured = black["temperature/L"][0] > 0.01
        ratio = black["temperature/L_isoline"][0][measured] / black["temperature/L"][0][measured]
        self.assertTrue(((0.3 < ratio) & (ratio < 1.05)).all(), ratio)

    def test_refusals(self):
        self.refuse("--thresholds: give FROM:TO:STEP or A,B,C in the unit of the field, or, and not both, --quantiles with "
                    "shares of the material", "analyze", self.snapshots[0])
        self.refuse("quantiles: found a share of 1.500000, allowed 0 ... 1", "analyze", self.snapshots[0], "--quantiles",
                    "0.5,1.5", ranks=2)
        self.refuse('--voids: found "grey", allowed "black", "white", "fill", "exclude"', "analyze", self.snapshots[0],
                    "--thresholds", "400", "--voids", "grey")
        self.refuse("run/history.csv: not an HDF5 file, or its beginning is damaged",
                    "analyze", "run/history.csv", "--thresholds", "1,2")
        self.refuse("run/morphology.h5: not a snapshot; for an array in an HDF5 file write "
                    "run/morphology.h5:/path/of/the/array", "analyze", "run/morphology.h5", "--thresholds", "1,2", ranks=2)
        self.refuse('--thresholds: found "3,2", allowed FROM:TO:STEP or A,B,C: 1 to 65534 numbers in ascending order, in '
                    "the unit of the field", "analyze", self.snapshots[0], "--thresholds", "3,2")
        self.refuse('unknown field "heat": allowed are temperature, pressure, density, speed, von_mises, plastic_strain, molten',
                    "analyze", self.snapshots[0], "--thresholds", "3", "--field", "heat")
        self.refuse(f"{self.snapshots[0]}: another of the files has the same record number, 0; analyse one run at a time",
                    "analyze", self.snapshots[0], self.snapshots[0], "--thresholds", "310")


if __name__ == "__main__":
    unittest.main()
