"""The measured data beside the runs: reading of points, means around one Up, Boade's law."""
import math
import sys
import tempfile
import unittest
from pathlib import Path
from types import SimpleNamespace

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from plate_exact import Material  # noqa: E402
from poreshock_cases import measured, table  # noqa: E402

COPPER = Material(density=8930.0, yield_stress=0.0, hardening=0.0, c0=3940.0, gruneisen_slope=1.489, gamma=2.0, cv=383.0)


def text_file(folder, text):
    path = Path(folder) / "points.csv"
    path.write_text(text)
    return path


class Points(unittest.TestCase):
    def test_kilometres_become_metres(self):
        with tempfile.TemporaryDirectory() as folder:
            points = measured.read_points(text_file(folder, "# source\n# more\nup_km_s,us_km_s\n0.5,4.75\n2.25,7\n"))
        self.assertEqual(points.tolist(), [[500.0, 4750.0], [2250.0, 7000.0]])

    def test_problems_name_the_line(self):
        with tempfile.TemporaryDirectory() as folder:
            for text, problem in (("# source\n", "must be up_km_s,us_km_s"), ("us,up\n1,2\n", "must be up_km_s,us_km_s"),
                                  ("# source\nup_km_s,us_km_s\n1,2\n1,two\n", "points.csv:4: found \"1,two\""),
                                  ("up_km_s,us_km_s\n1,2,3\n", "points.csv:2: found \"1,2,3\"")):
                with self.assertRaisesRegex(ValueError, problem):
                    measured.read_points(text_file(folder, text))

    def test_the_files_of_the_tables(self):
        counts = {solid.file: len(measured.read_points(measured.DATA / solid.file)) for solid in measured.SOLIDS}
        self.assertEqual(counts, {"hugoniot_copper.csv": 371, "hugoniot_aluminium_6061.csv": 26})
        for solid in measured.SOLIDS:
            points = measured.read_points(measured.DATA / solid.file)
            for velocity in solid.velocities:
                self.assertGreaterEqual(measured.around(points, velocity, solid.half_width).count, 3)


class LocalMean(unittest.TestCase):
    def test_points_of_a_line_have_no_scatter_wherever_they_lie(self):
        points = numpy.array([(up, 3900.0 + 1.5 * up) for up in (100.0, 950.0, 960.0, 1100.0, 3000.0)])
        found = measured.around(points, 1000.0, 100.0)
        self.assertEqual(found.count, 3)
        self.assertAlmostEqual(found.mean, 5400.0)
        self.assertAlmostEqual(found.scatter, 0.0, places=9)

    def test_scatter_is_that_of_one_point(self):
        # Symmetric about the line, so that its slope is 1.5 exactly.
        points = numpy.array([(up, 3900.0 + 1.5 * up + off) for up in (0.0, 500.0, 1000.0) for off in (-20.0, 20.0)])
        found = measured.around(points, 500.0, 0.0)
        self.assertEqual(found.count, 2)
        self.assertAlmostEqual(found.mean, 4650.0)
        self.assertAlmostEqual(found.scatter, math.sqrt(800.0))
        self.assertAlmostEqual(found.error, 20.0)

    def test_fast_points_do_not_bend_the_slope(self):
        line = [(up, 3900.0 + 1.5 * up) for up in (0.0, 900.0, 3999.0)]
        found = measured.around(numpy.array([*line, (1100.0, 5550.0), (4001.0, 0.0)]), 1000.0, 100.0)
        self.assertAlmostEqual(found.mean, 5400.0)

    def test_one_point_is_no_mean(self):
        points = numpy.array([(0.0, 3900.0), (1000.0, 5400.0)])
        with self.assertRaisesRegex(ValueError, "1 measured points lie within 50 m/s of Up = 1000 m/s, 2 are needed"):
            measured.around(points, 1000.0, 50.0)


class PlateRows(unittest.TestCase):
    def rows(self, speeds):
        solid = measured.Solid("copper", "none.csv", 0.0, (500.0, 1000.0))
        points = numpy.array([(up, 3900.0 + 1.5 * up + off) for up in (500.0, 1000.0) for off in (-46.5, 46.5)])
        shocks = [SimpleNamespace(values=(speed,), setting=SimpleNamespace(material=COPPER)) for speed in speeds]
        return {row.case[:3] + row.figure: row for row in measured.plate_rows(solid, points, shocks)}

    def test_a_run_is_judged_by_the_scatter(self):
        found = self.rows((4650.0, 5400.0 + 65.0))
        self.assertEqual(found["plascatter of a point"].value, "1.41 / 1.22 %")
        self.assertEqual(found["plarun over measured"].value, "+0.00 / +1.20 %")
        self.assertTrue(found["plarun over measured"].ok)
        self.assertEqual(found["allrun over measured"].value, "+0.60 +- 0.60 %")
        found = self.rows((4650.0, 5400.0 + 67.0))
        self.assertFalse(found["plarun over measured"].ok)
        self.assertTrue(found["plarun over measured"].value.endswith("%; missed at 1000"))
        table.markdown([row for row in found.values()], {})

    def test_the_known_misses_are_figures_of_plates(self):
        self.assertLessEqual({case for case, _ in measured.KNOWN}, {measured.case_of(solid) for solid in measured.SOLIDS})


class Boade(unittest.TestCase):
    def test_the_jumps_keep_mass_momentum_and_energy(self):
        first, speed = measured.BOADE_PRECURSOR
        ahead = first / (6400.0 * speed)
        before = (1.0 - ahead / speed) / 6400.0
        state = measured.boade(COPPER, 2e9)
        flux = (state.speed - ahead) / before
        self.assertAlmostEqual(flux * (state.velocity - ahead) / (2e9 - first), 1.0, places=12)
        self.assertAlmostEqual(state.density * (state.speed - state.velocity) / flux, 1.0, places=12)
        energy = 0.5 * ahead**2 + 0.5 * (2e9 + first) * (before - 1.0 / state.density)
        alpha = 1.0 / state.density / measured.solid_volume(COPPER, 2e9, energy)
        start = before / measured.solid_volume(COPPER, first, 0.5 * ahead**2)
        self.assertAlmostEqual((alpha - 1.0) / (start - 1.0), math.exp(-0.254 * 18.6), places=12)

    def test_nothing_collapses_behind_the_precursor_alone(self):
        first, speed = measured.BOADE_PRECURSOR
        state = measured.boade(COPPER, first + 1.0)
        self.assertAlmostEqual(state.velocity, first / (6400.0 * speed), places=3)
        self.assertAlmostEqual(state.density, 6400.0 / (1.0 - state.velocity / speed), places=3)

    def test_strong_waves_collapse_completely(self):
        state = measured.boade_at(COPPER, 380.0)
        plow = measured.snow_plow(COPPER, 1.0 - 6400.0 / 8930.0, 380.0)
        self.assertAlmostEqual(state.density / plow.density, 1.0, places=3)
        self.assertLess(state.speed, plow.speed)

    def test_ends_where_the_measurements_end(self):
        self.assertAlmostEqual(measured.boade_at(COPPER, measured.boade(COPPER, 3.5e9).velocity).pressure, 3.5e9, delta=1.0)
        with self.assertRaisesRegex(ValueError, "Up = 500 m/s is beyond 3.5 GPa"):
            measured.boade_at(COPPER, 500.0)

    def test_a_denser_powder_is_faster(self):
        # Complete collapse: Us = Up / (1 - rho00 / rho), so 1 % of density are 2.5 % of speed.
        faster = measured.boade_at(COPPER, 350.0, 6464.0).speed / measured.boade_at(COPPER, 350.0).speed
        self.assertAlmostEqual(faster, 1.025, delta=0.002)

    def test_samples_are_averaged(self):
        law = measured.boade_at(COPPER, 300.0, 6400.0)
        beds = [measured.Bed(SimpleNamespace(values=[law.speed * f, 300.0, 0.0, 0.5 * law.pressure, law.pressure, law.density],
                                             setting=SimpleNamespace(material=COPPER)), 6400.0, 1e-7, 1e-5)
                for f in (1.01, 1.03)]
        found = {row.figure: row.value for row in measured.powder_rows((300.0, 300.0), [beds, beds])}
        self.assertEqual(found["Us, run over Boade"], "+2.0 / +2.0 %")
        self.assertEqual(found["Us, standard error of that"], "1.0 / 1.0 %")
        self.assertEqual(found["momentum flux behind the front, run over Boade"], "-50.0 / -50.0 %")
        self.assertEqual(found["P at the wall, run over Boade"], "+0.0 / +0.0 %")
        self.assertEqual(found["density before the shock"], "6400 / 6400 kg/m3")

    def test_lead_is_counted_from_the_front(self):
        records = SimpleNamespace(height=numpy.array([1.0, 2.0, 3.0, 4.0]), front=numpy.array([0.0, 1.5]), row={
            "velocity": numpy.array([[0.0] * 4, [0.0, -290.0, -294.0, numpy.nan]])})
        self.assertEqual(measured.lead(records, 300.0, 5.75), 1.5)
        self.assertEqual(measured.lead(records, 300.0, 7.0), 0.5)


if __name__ == "__main__":
    unittest.main()
