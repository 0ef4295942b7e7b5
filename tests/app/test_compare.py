"""Similarity of runs: the command against eqs 16 to 18 worked out from the stored curves."""
import csv
import shutil
import unittest

import h5py
import numpy

import program
from program import POROUS

NAMES = ("A", "L", "chi")


def curves(path, names=NAMES):
    """Times, thresholds, and functionals as times x thresholds x names."""
    data = program.datasets(path)
    values = numpy.stack([data[f"temperature/{name}"] for name in names], axis=-1)
    return data["temperature/time"], data["temperature/threshold"], values


def trapezoids(values, time):
    """Integral over time along the last axis."""
    return 0.5 * (values[..., 1:] + values[..., :-1]) @ numpy.diff(time)


def process_distance(time, a, b, begin, end):
    """Trapezoidal rule for records at the same times."""
    inside = (time >= begin - 1e-15) & (time <= end + 1e-15)
    distance = numpy.sqrt(((a - b)[inside] ** 2).sum(axis=-1))
    return trapezoids(distance, time[inside]) / (end - begin)


class Compare(program.ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write("porous.toml", POROUS)
        for speed in (1300, 1500):
            cls.run_scene("porous.toml", f"v{speed}", "--set", f"loading.velocity={speed}",
                          "--set", "morphology.domains=true")
        cls.write("coarse.toml", POROUS)
        cls.run_scene("coarse.toml", "coarse", "--set", "morphology.pixel=20e-6", "--set", "time.end=10e-9")

    def test_every_threshold_as_the_equations_say(self):
        self.succeed("compare", "v1500", "v1300", "--output", "all.h5")
        time, threshold, slow = curves(self.folder / "v1300/morphology.h5")
        _, _, fast = curves(self.folder / "v1500/morphology.h5")
        found = program.datasets(self.folder / "all.h5")
        numpy.testing.assert_array_equal(found["reference_threshold"], threshold)
        numpy.testing.assert_array_equal(found["run_1/threshold"], threshold)
        # The run is still being loaded when it ends.
        expected = [[process_distance(time, fast[:, r], slow[:, k], time[0], time[-1])
                     for k in range(len(threshold))] for r in range(len(threshold))]
        numpy.testing.assert_allclose(found["run_1/d_p"], expected, rtol=1e-12, atol=1e-15)
        numpy.testing.assert_allclose(found["run_1/d_p_same"], numpy.diag(expected), rtol=1e-12, atol=1e-15)
        self.assertTrue((found["run_1/d_p_best"] <= numpy.min(expected, axis=1) * (1 + 1e-12)).all())
        nearest = threshold[numpy.argmin(expected, axis=1)]
        self.assertTrue((abs(found["run_1/best_threshold"] - nearest) <= 10.0).all())
        # A slower impact heats less: its matching threshold lies lower.
        middle = slice(5, 40)
        self.assertTrue((found["run_1/best_threshold"][middle] < threshold[middle]).all())
        with h5py.File(self.folder / "all.h5") as file:
            self.assertEqual(file.attrs["reference"], "v1500")
            self.assertEqual(file.attrs["run_1"], "v1300")
            self.assertEqual(file["run_1/time"].attrs["unit"], "s")
            integral = trapezoids(file["run_1/d"][...], file["run_1/time"][...])
        numpy.testing.assert_allclose(integral / (time[-1] - time[0]), found["run_1/d_p_best"], rtol=1e-10, atol=1e-15)

    def test_window_threshold_and_chi_of_the_paper(self):
        output = self.succeed("compare", "v1500", "v1300", "v1500", "--threshold", "500", "--window", "5e-9:15e-9", "--chi",
                              "chi_paper", "--output", "one.csv").output
        names = ("A", "L", "chi_paper")
        time, threshold, slow = curves(self.folder / "v1300/morphology.h5", names)
        _, _, fast = curves(self.folder / "v1500/morphology.h5", names)
        at = list(threshold).index(500.0)
        lines = (self.folder / "one.csv").read_text().splitlines()
        self.assertEqual(lines[0], "run,reference_threshold [K],begin [s],end [s],d_p_same [1],best_threshold [K],"
                                   "d_p_best [1],d_p_same_interpolation [1],d_p_best_interpolation [1]")
        name, *numbers = lines[1].split(",")
        self.assertEqual(name, '"v1300"')
        reference, begin, end, same, _, best, *interpolation = map(float, numbers)
        self.assertEqual(interpolation, [0.0, 0.0])
        self.assertNotIn("interpolated", output)
        self.assertEqual((reference, begin, end), (500.0, 5e-9, 15e-9))
        expected = process_distance(time, fast[:, at], slow[:, at], 5e-9, 15e-9)
        self.assertAlmostEqual(same, expected, delta=1e-9 * expected)
        self.assertLess(best, same)
        # The reference against itself: no distance at all, and the table says so.
        self.assertEqual(lines[2].split(",")[4:], ["0", "500", "0", "0", "0"])
        self.assertEqual(output.count("identical"), 2)

    def test_names_with_quotes_and_commas(self):
        names = ('a "quoted" name', "one, two", '"', 'both: "a", b')
        for name in names:
            shutil.copytree(self.folder / "v1300", self.folder / name)
        self.succeed("compare", "v1500", *names, "v1300", "--threshold", "500", "--output", "names.csv")
        with open(self.folder / "names.csv", newline="") as file:
            rows = list(csv.reader(file))
        self.assertEqual([row[0] for row in rows[1:]], [*names, "v1300"])
        self.assertEqual({len(row) for row in rows}, {9})
        self.assertEqual(len({tuple(row[1:]) for row in rows[1:]}), 1)

    def test_seeds_give_an_uncertainty(self):
        for seed in (2, 3):
            self.run_scene("porous.toml", f"seed{seed}", "--set", "loading.velocity=1300", "--set", f"sample.seed={seed}",
                           "--set", "morphology.domains=true")
        output = self.succeed("compare", "v1500", "v1300", "v1500", "seed2", "seed3", "--threshold", "450,500", "--output",
                              "seeds.h5", ranks=2).output
        self.assertIn("3 runs that differ in the seed only, mean +- standard deviation: v1300 seed2 seed3", output)
        found = program.datasets(self.folder / "seeds.h5")
        best = numpy.stack([found[f"run_{k}/best_threshold"] for k in (1, 3, 4)])
        self.assertEqual(best.shape, (3, 2))
        numpy.testing.assert_allclose(found["seeds_1/best_threshold"], best.mean(axis=0), rtol=1e-12)
        numpy.testing.assert_allclose(found["seeds_1/best_threshold_deviation"], best.std(axis=0, ddof=1), rtol=1e-9)
        self.assertGreater(best.std(axis=0, ddof=1).max(), 0.0)
        with h5py.File(self.folder / "seeds.h5") as file:
            self.assertEqual(file.attrs["seeds_1"], "run_1, run_3, run_4")
            self.assertNotIn("seeds_2", file)

    def test_times_of_their_own_loading(self):
        # A slow run of a third of the time is loaded all along, as the fast one is: at equal shares of the loading.
        self.run_scene("porous.toml", "short", "--set", "time.end=15e-9", "--set", "morphology.domains=true")
        self.succeed("compare", "v1500", "short", "--threshold", "500", "--time", "loading", "--output", "own.h5")
        self.succeed("compare", "v1500", "short", "--threshold", "500", "--window", "faster", "--output", "common.h5")
        own, common = (program.datasets(self.folder / name) for name in ("own.h5", "common.h5"))
        self.assertEqual((own["run_1/time"][0], own["run_1/time"][-1]), (0.0, 1.0))
        self.assertEqual(common["run_1/time"][-1], 15e-9)
        # The same run: no distance at common times, and some where one is stretched.
        self.assertLess(common["run_1/d_p_same"][0], 1e-15)
        self.assertGreater(own["run_1/d_p_same"][0], 0.0)
        with h5py.File(self.folder / "own.h5") as file:
            self.assertEqual(file["run_1/time"].attrs["unit"], "1")

    def test_other_pixels_need_a_length(self):
        self.assertIn("other pixels than v1500, 2e-05 m against 1e-05 m", self.message(2, "compare", "v1500", "coarse"))
        self.succeed("compare", "v1500", "coarse", "--length", "10e-6", "--threshold", "500", "--output", "length.h5")
        ours, theirs = program.datasets(self.folder / "length.h5"), program.datasets(self.folder / "coarse/morphology.h5")
        time, threshold, fine = curves(self.folder / "v1500/morphology.h5")
        at = list(threshold).index(500.0)
        coarse = numpy.stack([theirs[f"temperature/{name}"] / 2.0 ** k for k, name in enumerate(NAMES)], axis=-1)
        both = numpy.isin(time, theirs["temperature/time"])
        expected = process_distance(time[both], fine[both][:, at], coarse[:, at], time[0], time[both][-1])
        self.assertAlmostEqual(ours["run_1/d_p_same"][0], expected, delta=1e-12)

    def test_other_record_times(self):
        """One run, recorded more and less often, differs from itself by what interpolation adds, and that is said."""
        for name, every in (("often", "2.5e-9"), ("seldom", "10e-9")):
            self.run_scene("porous.toml", name, "--set", f"morphology.every={every}", "--set", "loading.velocity=1500")
        for first, second in (("often", "v1500"), ("v1500", "often"), ("seldom", "v1500"), ("often", "seldom")):
            for window in ((), ("--window", "2e-9:17e-9")):
                output = self.succeed("compare", first, second, *window, "--output", "times.h5").output
                found = program.datasets(self.folder / "times.h5")
                most = found["run_1/d_p_same_interpolation"].max()
                self.assertGreater(most, 0.0)
                self.assertIn(f"recorded at other times than {first}: each was interpolated at the times of the other, "
                              "which alone moves d_p by up to ", output)
                self.assertTrue((found["run_1/d_p_same"] <= found["run_1/d_p_same_interpolation"] * (1 + 1e-9)).all())
                self.assertTrue((found["run_1/d_p_best"] <= found["run_1/d_p_same_interpolation"] * (1 + 1e-9)).all())
                self.assertGreater(output.count("alike"), 50)
        # Another run is still told from it.
        output = self.succeed("compare", "often", "v1300", "--threshold", "500", "--output", "times.h5").output
        found = program.datasets(self.folder / "times.h5")
        self.assertGreater(found["run_1/d_p_same"][0], 2 * found["run_1/d_p_same_interpolation"][0])
        self.assertNotIn("alike\n", output)

    def test_refusals(self):
        self.refuse("compare: found 1 run, allowed two or more; the first is the reference", "compare", "v1500")
        self.refuse('--window: found "5", allowed BEGIN:END, two numbers in seconds, the second larger, or slower or faster, the run whose end of '
                    "loading ends the window",
                    "compare", "v1500", "v1300", "--window", "5")
        self.refuse('--threshold: found "50", allowed a number from 310 to 900 K, what v1500 measured',
                    "compare", "v1500", "v1300", "--threshold", "50")
        self.refuse('v1500/morphology.h5: holds no morphology of "speed", allowed pressure, temperature',
                    "compare", "v1500", "v1300", "--field", "speed", ranks=2)
        self.refuse("elsewhere: not found", "compare", "v1500", "elsewhere", ranks=2)
        self.refuse("table.txt: a comparison goes to a file whose name ends in .h5 or .csv", "compare", "v1500", "v1300",
                    "--threshold", "500", "--output", "table.txt")


if __name__ == "__main__":
    unittest.main()
