"""The figures of the paper: which runs they need, and that measures and verdicts know right from wrong."""
import sys
import unittest
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from poreshock_paper import claims, figures, measures, plan  # noqa: E402


def made_up(areas, chi=None, length=None):
    """Curves at rises 50 ... 250 K from functions of the share of the loading time, which ends at 750 ns."""
    time = numpy.arange(0.0, 1101e-9, 10e-9)
    rise = numpy.array(plan.FIGURE_2, dtype=float)
    loaded = numpy.clip(time / 750e-9, 0.0, 1.0)
    after = numpy.clip((time - 750e-9) / 350e-9, 0.0, 1.0)
    area = numpy.stack([top * loaded - drop * after for top, drop in areas], axis=1)
    flat = numpy.zeros_like(area)
    names = dict.fromkeys(measures.NAMES, flat) | {"A": area}
    names["chi_paper"] = flat if chi is None else numpy.outer(loaded, chi)
    if length is not None:
        names["L"] = numpy.stack([on * loaded + off * after for on, off in length], axis=1)
    end = int(numpy.argmax(0.5 * (area[:, 1:] + area[:, :-1]) @ numpy.diff(rise)))
    return measures.Curves(time, rise, names, end)


PAPER = ((1.0, 0.05), (1.0, 0.2), (0.82, 0.5), (0.31, 0.2), (0.07, 0.05))


class Plan(unittest.TestCase):
    def test_every_run_once_and_long_enough(self):
        cases = plan.all_cases(plan.QUICK)
        names = [case.name for case in cases]
        self.assertEqual(len(names), len(set(names)))
        # 8 + 7 velocities, 5 more void fractions, the solid, 11 variants.
        self.assertEqual(len(names), 32)
        for case in cases:
            values = dict(setting.split("=", 1) for setting in case.settings)
            end, porosity, velocity = (float(values[key]) for key in ("time.end", "sample.porosity", "loading.velocity"))
            least = plan.loading_time(porosity, velocity)
            self.assertGreater(end, least, case.name)
        self.assertEqual(len(plan.all_cases(plan.FULL)), 2 + 2 * 3 * 20 - 1 + 12)

    def test_loading_time_of_the_snow_plow(self):
        self.assertAlmostEqual(plan.loading_time(0.077, 1100), 874e-9, delta=1e-9)


class Measures(unittest.TestCase):
    def test_speed_of_the_hot_front(self):
        found = made_up(PAPER)
        self.assertAlmostEqual(measures.growth(found, 50)[1], 5e-3 / 750e-9, delta=1e-6 * 5e-3 / 750e-9)
        self.assertAlmostEqual(measures.growth(found, 200)[0][30], 0.31 / 750e-9, delta=1.0)

    def test_anisotropy_and_correlation_length(self):
        found = made_up(PAPER)
        found.arrays["B_int"] = numpy.full_like(found.arrays["A"], 8.0)
        found.arrays["B_axial"] = numpy.full_like(found.arrays["A"], 6.0)
        self.assertEqual(measures.anisotropy(found, 100)[5], 0.5)
        found.arrays["L_crofton"] = numpy.full_like(found.arrays["A"], 0.1)
        area = found.at("A", 100)[40]
        self.assertAlmostEqual(measures.correlation_length(found, 100, 2e-6)[40], numpy.pi * area * (1 - area) / 0.1 * 2e-6)
        found.arrays["L_crofton"][:] = 0.0
        self.assertTrue(numpy.isnan(measures.correlation_length(found, 100, 2e-6)).all())

    def test_straight_line_and_spread(self):
        x = numpy.arange(6.0)
        fit = measures.straight_line(x, 3.0 - 2.0 * x)
        self.assertAlmostEqual(fit.slope, -2.0)
        self.assertAlmostEqual(fit.quality, 1.0)
        self.assertAlmostEqual(fit.error, 0.0)
        # Residuals 0.5, -1, 0.5: sum of squares 1.5 on one degree of freedom, over sum (x - mean)^2 = 2.
        self.assertAlmostEqual(measures.straight_line(x[:3], numpy.array([0.0, 0.0, 3.0])).error, numpy.sqrt(0.75))
        self.assertIsNone(measures.straight_line(x, numpy.where(x < 2, x, numpy.nan)))
        self.assertEqual(measures.mean_and_deviation([1.0, 3.0]), (2.0, numpy.sqrt(2.0)))

    def test_matches_at_the_end_of_the_thresholds_are_no_minima(self):
        inner = measures.Match(numpy.arange(3.0), numpy.arange(3.0), 1.0, 0.0, False)
        outer = measures.Match(numpy.arange(3.0), numpy.arange(3.0), 2.0, 0.0, True)
        self.assertEqual(list(measures.over_seeds([{(1, 2): inner}, {(1, 2): outer}], 1, 2)), [1.0])


class Claims(unittest.TestCase):
    def verdicts(self, entries):
        return [entry.verdict for entry in entries]

    def test_the_papers_own_curves_agree(self):
        chi = (0.0, 0.0, -4e-3, 3e-3, 1e-3)
        length = ((0.01, 0.1), (0.05, 0.1), (0.3, -0.1), (0.4, -0.2), (0.2, -0.1))
        found = made_up(PAPER, chi, length)
        self.assertEqual(set(self.verdicts(claims.loading(found, found, {"reference": found}))), {claims.AGREES})
        for part in (claims.areas, claims.lengths, claims.connectivity):
            self.assertEqual(set(self.verdicts(part(found))), {claims.AGREES}, part.__name__)

    def test_other_curves_differ_and_say_why(self):
        found = made_up(((0.7, 0.3), (0.5, 0.1), (0.2, 0.1), (0.9, 0.1), (0.6, 0.1)), (4e-3, 4e-3, 4e-3, -3e-3, -1e-3),
                        ((0.4, -0.1), (0.4, -0.1), (0.3, 0.1), (0.4, 0.2), (0.2, 0.1)))
        for part in (claims.areas, claims.lengths, claims.connectivity):
            self.assertEqual(set(self.verdicts(part(found))), {claims.DIFFERS}, part.__name__)
        self.assertTrue(all(entry.why for entry in claims.connectivity(found)))

    def test_areas_that_differ_show_what_they_hang_on(self):
        found = made_up(((1.0, 0.05), (1.0, 0.2), (0.82, 0.5), (0.7, 0.2), (0.07, 0.05)))
        entries = claims.loading(found, found, {"reference": found, "APIC": made_up(PAPER)})
        self.assertEqual(self.verdicts(entries), [claims.AGREES] * 3 + [claims.DIFFERS, claims.AGREES])
        self.assertIn("0.310 (APIC) to 0.700 (reference)", entries[3].why)

    def test_what_a_share_of_the_sample_exceeds(self):
        self.assertEqual(measures.exceeded(made_up(PAPER), 0.31), 200.0)
        self.assertAlmostEqual(measures.exceeded(made_up(PAPER), 0.19), 225.0)
        self.assertEqual(measures.exceeded(made_up(PAPER), 0.05), numpy.inf)

    def test_best_matches_within_their_uncertainty(self):
        nan = numpy.nan
        self.assertEqual(self.verdicts(claims.best_matches({1000: (95.0, nan), 1200: (148.0, 4.0)})), [claims.AGREES] * 2)
        self.assertEqual(self.verdicts(claims.best_matches({1000: (80.0, nan), 1200: (162.0, 1.0)})), [claims.DIFFERS, claims.PARTLY])

    def test_parabola_and_faster_growth(self):
        def series(power, scale):
            return {120: [(v, scale * (v / 1100) ** power, numpy.nan) for v in (700, 900, 1100, 1300, 1500)]}

        self.assertEqual(self.verdicts(claims.growth(series(2.6, 120), series(2.0, 300))), [claims.AGREES] * 2)
        self.assertEqual(self.verdicts(claims.growth(series(1.5, 120), series(6.0, 300)))[1], claims.DIFFERS)

    def test_power_law_and_where_it_ends(self):
        porosities = numpy.array(plan.FIGURE_8)
        mean = 300.0 * (porosities / 0.077) ** 0.7
        mean[-2:] *= (0.8, 0.6)
        points = list(zip(porosities, mean, numpy.full(7, numpy.nan)))
        fit, last = claims.fit_range(points)
        self.assertAlmostEqual(fit.slope, 0.7, delta=0.05)
        self.assertIn(last, (0.4, 0.46))
        self.assertEqual(self.verdicts(claims.power_law({300: points}, {300: (fit, last)}, "x", "why")), [claims.AGREES] * 3)
        self.assertIsNone(claims.fit_range(points[:2]))
        self.assertEqual(self.verdicts(claims.power_law({300: points}, {300: None}, "x", "why"))[1], claims.DIFFERS)


class Figures(unittest.TestCase):
    def test_every_figure_of_numbers_can_be_drawn(self):
        found = made_up(PAPER, (0.0, 0.0, -4e-3, 3e-3, 1e-3), ((0.1, 0.1),) * 5)
        match = measures.Match(numpy.arange(1.0, 400.0), numpy.abs(numpy.arange(1.0, 400.0) - 120.0), 120.0, 0.0, False)
        series = {120: [(700, 50.0, 2.0), (1100, 120.0, numpy.nan), (1500, numpy.nan, numpy.nan)]}
        drawn = [figures.figure_2(found), figures.space({"a": (found, 100, 60)}),
                 figures.figure_4({(v, 120): match for v in (700, 1100)}, 120, (700, 1100)), figures.figure_7(series),
                 figures.figure_8({120: [(0.1, 120.0, 1.0), (0.2, 200.0, 1.0), (0.4, 330.0, 1.0)]},
                                  {120: (measures.straight_line(numpy.log([0.1, 0.2, 0.4]), numpy.log([120, 200, 330])), 0.4)}),
                 figures.sensitivity({"a": found, "b": found}), figures.past_the_paper(found, 1e-5),
                 figures.hot_spot_figure({200: (numpy.array([1e-10, 4e-10]), numpy.array([600.0, 700.0])), 300: (numpy.array([]),) * 2})]
        for figure in drawn:
            self.assertGreater(len(figure.axes), 0)
            figure.canvas.draw()
            figures.plt.close(figure)


if __name__ == "__main__":
    unittest.main()
