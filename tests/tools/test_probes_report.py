"""Traces in the report: the exact trace of a plate, the figures, and other runs left as they are."""
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from poreshock_report import probes  # noqa: E402

SCENE = {
    "thermal": "conserving", "sample": {"kind": "solid", "height": 1e-3}, "loading": {"velocity": 1100.0},
    "boundary": {"low": {"kind": "wall"}, "high": {"kind": "free"}},
    "material": [{"density": 2700.0, "young": 69e9, "poisson": 0.33, "yield": 120e6, "hardening": 384e6, "c0": 5350.0,
                  "lambda": 1.34, "gamma": 2.0, "cv": 880.0, "T0": 300.0, "strength": "linear"}]}


class Traces(unittest.TestCase):
    def test_exact_trace_of_a_plate(self):
        times, velocities = probes.exact(SCENE)
        # One front of 6842 m/s; momentum and energy behind it, and the release, are those of plate_release.py.
        self.assertAlmostEqual(times[1] * 6841.84, 1e-3, delta=1e-8)
        self.assertEqual(velocities[0], -1100.0)
        self.assertTrue(1100.0 < velocities[-1] < 1.01 * 1100.0)

    def test_a_precursor_arrives_first(self):
        times, velocities = probes.exact(SCENE | {"loading": {"velocity": 300.0}})
        self.assertEqual(len(times), 5)
        self.assertTrue(0.0 < times[1] < times[3])
        self.assertTrue(-300.0 < velocities[2] < velocities[4])

    def test_no_exact_trace_where_there_is_none(self):
        for other in ({"sample": {"kind": "random_voids", "height": 1e-3}}, {"body": [{}]}, {"boundary": {}},
                      {"loading": {"velocity": 1.0}}):
            self.assertIsNone(probes.exact(SCENE | other))

    def test_sections(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            self.assertEqual(probes.sections(folder), [])
            (folder / "scene.toml").write_text('[[probe]]\nname = "a"\nkind = "surface"\n')
            (folder / "probe_a.csv").write_text(
                "time [s],step [-],velocity_y [m/s],pressure [Pa],temperature [K]\n0,0,0,0,300\n1e-9,1,5,1e9,nan\n")
            text = "".join(probes.sections(folder))
            self.assertIn("there is no probes.h5", text)
            with h5py.File(folder / "probes.h5", "w") as file:
                for key, value in (("arrival", 1e-9), ("jump_off", 5.0), ("pull_back", numpy.nan),
                                   ("pull_back_time", numpy.nan), ("spall_strength", numpy.nan)):
                    file[f"a/figures/{key}"] = [value]
            text = "".join(probes.sections(folder))
            self.assertNotIn("Missing", text)
            self.assertIn("<td>a</td>", text)
            self.assertIn("<h2>Probes</h2>", text)
            self.assertEqual(text.count(">-</td>"), 3)


if __name__ == "__main__":
    unittest.main()
