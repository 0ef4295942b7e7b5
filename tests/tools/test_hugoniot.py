"""The Hugoniots of porous solids against a table, and the measuring of made-up profiles."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy

TOOLS = Path(__file__).resolve().parents[2] / "tools"
sys.path.insert(0, str(TOOLS))
from fake_output import CELL, WALL_STRESS, write_output, write_profiles  # noqa: E402
from plate_exact import Material  # noqa: E402
from poreshock_report import folder as reader  # noqa: E402
from poreshock_report import hugoniot, profiles  # noqa: E402

# Void fraction, Up m/s: Us m/s, P GPa, V / V0, T K; aluminium of the paper without strength.
SNOW_PLOW = {
    (.077, 500): "4026.8 5.0176 0.94890 428.6", (.077, 700): "4721.3 8.2361 0.92279 519.0",
    (.077, 900): "5261.2 11.8003 0.89809 628.2", (.077, 1100): "5718.9 15.6772 0.87503 758.5",
    (.077, 1300): "6128.2 19.8537 0.85359 912.7", (.077, 1500): "6507.1 24.3245 0.83368 1093.4",
    (.3, 500): "1625.5 1.5361 0.98915 446.7", (.3, 700): "2229.3 2.9493 0.97999 584.0",
    (.3, 900): "2799.0 4.7612 0.96923 763.3", (.3, 1100): "3336.3 6.9361 0.95756 983.0",
    (.3, 1300): "3844.4 9.4457 0.94549 1242.5", (.3, 1500): "4327.7 12.2689 0.93342 1541.3",
    (.46, 500): "1085.1 0.7910 0.99852 442.9", (.46, 700): "1516.7 1.5479 0.99715 580.0",
    (.46, 900): "1946.1 2.5536 0.99542 762.6", (.46, 1100): "2372.9 3.8056 0.99339 990.8",
    (.46, 1300): "2796.9 5.3012 0.99111 1264.3", (.46, 1500): "3218.0 7.0378 0.98866 1583.2",
    (.6, 1100): "1849.5 2.1972 1.01313 977.0",  # expanded beyond the solid
    # Half void: V = V0 at every velocity, so Us = 2 Up and P = 2 rho00 Up^2.
    (.5, 1100): "2200.0 3.2670 1.00000 987.5",
}


def text(shock):
    return (f"{shock.speed:.1f} {shock.pressure / 1e9:.4f} {2700.0 / shock.density:.5f} "
            f"{shock.temperature:.1f}")


class Hugoniots(unittest.TestCase):
    def test_snow_plow_to_every_digit(self):
        for (voids, velocity), row in SNOW_PLOW.items():
            self.assertEqual(text(hugoniot.snow_plow(Material(), voids, velocity)), row)

    def test_snow_plow_is_the_closed_form(self):
        m = Material()
        for voids, velocity in ((.077, 900.0), (.3, 1500.0), (.46, 700.0), (.6, 1100.0)):
            shock = hugoniot.snow_plow(m, voids, velocity)
            x, x00 = m.density / shock.density, 1.0 / (1.0 - voids)
            reference = hugoniot.reference(m, 1.0 / shock.density)[0]
            closed = reference * (2.0 * x - m.gamma * (1.0 - x)) / (2.0 * x - m.gamma * (x00 - x))
            self.assertAlmostEqual(closed / shock.pressure, 1.0, places=9)
            self.assertAlmostEqual(m.density * (1.0 - voids) * shock.speed * velocity / shock.pressure, 1.0, places=12)

    def test_without_voids_it_is_the_linear_law_of_the_solid(self):
        shock = hugoniot.snow_plow(Material(), 0.0, 1100.0)
        self.assertAlmostEqual(shock.speed, 5350.0 + 1.34 * 1100.0, places=8)
        self.assertAlmostEqual(shock.temperature, 540.567, places=3)

    def test_collapse_thresholds(self):
        found = [f"{hugoniot.crush_pressure(Material(), voids, 2) / 1e6:.1f}" for voids in (.077, .3, .46)]
        self.assertEqual(found, ["177.6", "83.4", "53.8"])
        # 3-D spheres: 2/3 Y ln(1 / void fraction).
        self.assertAlmostEqual(hugoniot.crush_pressure(Material(), .3, 3), 80e6 * numpy.log(1.0 / .3), places=4)

    def test_p_alpha_is_the_snow_plow_from_500_m_s_on(self):
        for voids, velocity in ((.077, 500.0), (.3, 500.0), (.3, 1100.0), (.46, 1500.0)):
            plow, alpha = (text(hugoniot.snow_plow(Material(), voids, velocity)),
                           text(hugoniot.p_alpha(Material(), voids, velocity)))
            self.assertEqual(plow, alpha)

    def test_residual_voids_of_weak_shocks(self):
        found = {voids: [hugoniot.p_alpha(Material(), voids, velocity).void_fraction
                         for velocity in (100.0, 200.0, 300.0)] for voids in (.077, .3, .46)}
        for voids, expected in {.077: (.0076, 0.0, 0.0), .3: (.173, .022, 3e-4), .46: (.333, .115, .015)}.items():
            numpy.testing.assert_allclose(found[voids], expected, atol=6e-4)

    def test_p_alpha_keeps_its_own_equation(self):
        m, voids, velocity = Material(), .46, 200.0
        shock = hugoniot.p_alpha(m, voids, velocity)
        alpha = hugoniot.distension(m, voids, 2, shock.pressure)
        solid = hugoniot.pressure_of(m, 1.0 / shock.density / alpha, 0.5 * velocity**2)
        self.assertAlmostEqual(solid / alpha / shock.pressure, 1.0, places=6)
        self.assertAlmostEqual(1.0 - 1.0 / alpha, shock.void_fraction, places=12)


class Measuring(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = Path(self.temporary.name) / "run"
        write_output(self.folder, "conserving")

    def table(self):
        shock = profiles.measure(self.folder)
        return profiles.table_rows(shock), shock.notes

    def test_known_front_and_state(self):
        rows, notes = self.table()
        measured = {row[0]: row[1] for row in rows}
        self.assertEqual(measured, {
            "Us [m/s]": "3300.0", "Up [m/s]": "1100.0", "P [GPa]": "6.9300",  # 0.99 of the stress of the solid
            "momentum flux [GPa]": "7.0290", "P at the wall [GPa]": f"{WALL_STRESS / 1e9:.4f}", "rho [kg/m3]": "2821.5", "T [K]": "980.0",
            "T + fluctuation / c_v [K]": "981.0"})  # 880 J/kg more at 880 J/(kg K)
        self.assertEqual([row[5] for row in rows][:3], ["3336.3", "1100.0", "6.9361"])
        self.assertEqual(rows[0][6], "-1.09 %")
        self.assertEqual([row[7] for row in rows], [row[5] for row in rows])
        self.assertTrue(notes[0].startswith("Void fraction 0.3000 of what the front crosses, impact at 1100 m/s"), notes[0])

    def test_window_and_entry(self):
        setting = profiles.setting_of(reader.read_scene(self.folder))
        data = profiles.read(self.folder)
        fit = profiles.fit_front(data, setting)
        # Twenty cells of 10 um count for more than two voids of 80 um.
        self.assertGreaterEqual(data.front[fit.used[0]], 20 * CELL)
        self.assertLess(data.front[fit.used[0] - 1], 20 * CELL)
        self.assertLess(fit.scatter, 1e-12)
        state = profiles.state_behind(data, setting, fit)
        self.assertAlmostEqual(state.low, 5 * CELL, places=12)
        self.assertAlmostEqual(state.distance, 160e-6, places=12)  # two void diameters
        numpy.testing.assert_allclose(state.spread, 0.0, atol=1e-3)

    def test_small_files_of_an_unfinished_run_give_the_same(self):
        whole = self.table()
        (self.folder / "profiles.h5").unlink()
        write_profiles(self.folder, numpy.linspace(0.0, 200e-9, 41), whole=False)
        self.assertEqual(self.table(), whole)
        (self.folder / "profile_000040.h5").write_bytes(b"\x89HDF")
        self.assertEqual(len(profiles.read(self.folder).time), 40)

    def test_what_is_missing_is_named(self):
        write_profiles(self.folder, [0.0, 100e-9, 200e-9])
        with self.assertRaisesRegex(reader.Missing, "200 um from the wall in 2 records"):
            profiles.measure(self.folder)
        (self.folder / "profiles.h5").unlink()
        with self.assertRaisesRegex(reader.Missing, "no profiles.h5"):
            profiles.measure(self.folder)
        (self.folder / "scene.toml").write_text('[boundary]\nlow = "free"\n')
        with self.assertRaisesRegex(reader.Missing, "describe the shock"):
            profiles.measure(self.folder)

    def test_void_fraction_is_that_of_what_the_front_crosses(self):
        setting = profiles.setting_of(reader.read_scene(self.folder))
        data = profiles.read(self.folder)
        fit = profiles.fit_front(data, setting)
        # Us is 3300 m/s: what meets the front at a time started that far above the wall.
        first, last = 3300.0 * data.time[fit.used[[0, -1]]]
        crossed = (data.height > first - CELL) & (data.height < last + CELL)
        with h5py.File(self.folder / "profiles.h5", "r+") as file:
            rows = file["row/solid_fraction"][0]
            file["row/solid_fraction"][0] = numpy.where(crossed, 0.9 * rows, 0.5 * rows)
        notes = profiles.measure(self.folder).notes
        self.assertTrue(notes[0].startswith("Void fraction 0.3700 of what the front crosses,"), notes[0])

    def test_strips_left_behind_do_not_slow_the_front(self):
        rows, _ = self.table()
        scene = self.folder / "scene.toml"
        text_before = scene.read_text()
        self.assertNotIn("[time]", text_before)
        scene.write_text(text_before + '[time]\nfollow = "front"\n')
        with h5py.File(self.folder / "profiles.h5", "r+") as file:
            # Strips of 40 and 30 um; the sample goes on above the window.
            left = numpy.select([numpy.arange(41) > 30, numpy.arange(41) > 20], [70e-6, 40e-6], 0.0)
            file["row/shift"][:] = left
            file["front/position"][:] -= left
            file["row/solid_fraction"][0] = 0.7
        measured, notes = self.table()
        self.assertEqual([row[0] for row in measured], [row[0] for row in rows])
        self.assertEqual(measured[0][1], rows[0][1])
        self.assertEqual([row[5] for row in measured], [row[5] for row in rows])
        self.assertIn("The domain follows the front", notes[-1])
        # Of a sample much higher than the window only what is in it is known.
        scene.write_text(scene.read_text().replace("height = 1.8e-3", "height = 18e-3"))
        self.assertEqual(profiles.setting_of(reader.read_scene(self.folder)).height, 18e-3)
        measured, notes = self.table()
        self.assertEqual([row[5] for row in measured], [row[5] for row in rows])
        self.assertIn("Void fraction 0.3000", notes[0])

    def test_command(self):
        def call(*names):
            return subprocess.run([TOOLS / "hugoniot.py", *names], capture_output=True, text=True, check=False)

        done = call(self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = done.stdout.splitlines()
        self.assertEqual(lines[0], f"**{self.folder}**")
        self.assertEqual(lines[2].count("|"), len(profiles.HEAD) + 1)
        self.assertTrue(lines[4].startswith("| Us [m/s] | 3300.0 | 0.0 | 6841.8 | -51.77 % | 3336.3 | -1.09 % |"))
        missing = call(self.folder / "nothing")
        self.assertEqual((missing.returncode, missing.stdout), (1, ""))
        self.assertIn("there is no scene.toml", missing.stderr)
        self.assertEqual(call().returncode, 2)


if __name__ == "__main__":
    unittest.main()
