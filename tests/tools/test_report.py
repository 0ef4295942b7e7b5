"""The report of a made-up output folder: complete, self-contained, and honest about what is missing."""
import re
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from fake_output import THRESHOLDS, write_output  # noqa: E402
from poreshock_report import figures, folder, morphology_figures, page  # noqa: E402

FIGURES = ("Figure 1: temperature", "Figure 2: morphology against time", "Figure 3: the A-L-chi space",
           "Temperature, time by time", "Hot spots", "Profiles along the shock axis", "Path of the front", "Hugoniots",
           "Energy ledger")
PICTURES = {"hot_spots.png", "temperature.png", "morphology_time.png", "morphology_space.png", "energy.png",
            "profiles.png", "front.png", "hugoniots.png", "temperature.webp"}


class Report(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = Path(self.temporary.name) / "run"

    def test_complete_folder_gives_every_figure_in_one_file(self):
        write_output(self.folder)
        text = page.write(self.folder).read_text()
        for title in FIGURES:
            self.assertIn(f"<h2>{title}</h2>", text)
        self.assertEqual(text.count('src="data:image/png;base64,'), 8)
        self.assertEqual(text.count('src="data:image/webp;base64,'), 5 + 1)  # the frames and the movie
        self.assertEqual(re.findall('data-time="(.*?)"', text), ["0 ns", "50 ns", "100 ns", "150 ns", "200 ns"])
        self.assertEqual(re.findall(r'(?:src|srcset|href)="(?!data:)', text), [])
        self.assertNotIn("http", re.sub(r'base64,[^"]*', "", text))
        self.assertNotIn("Missing:", text)
        self.assertIn("Thermal mode: paper.", text)
        self.assertEqual({path.name for path in (self.folder / "pictures").iterdir()}, PICTURES)

    def test_final_numbers(self):
        write_output(self.folder)
        text = page.final_numbers(self.folder, "A title", "conserving")
        for label, value in (("thermal mode", "conserving"), ("steps", "1 000"), ("particles", "48 000"),
                             ("wall time [s]", "123.5"), ("guards (clamps and floors hit)", "3"),
                             ("energy drift at the end [-]", "1e-11")):
            cell = re.search(f"<td>{re.escape(label)}</td><td[^>]*>(.*?)</td>", text)
            self.assertEqual(cell and cell[1], value, label)
        # The phase that took longest comes first.
        self.assertLess(text.index("<td>stress</td>"), text.index("<td>particles_to_grid</td>"))

    def test_timings_with_phases_as_a_list_or_by_name(self):
        self.folder.mkdir()
        for phases in ('[{"name": "sort", "min": 1, "avg": 2.5, "max": null, "calls": 7}]',
                       '{"sort": {"min": 1, "avg": 2.5, "calls": 7}}'):
            (self.folder / "timings.json").write_text(f'{{"ranks": 2, "phases": {phases}}}')
            found = folder.read_timings(self.folder)
            self.assertEqual(str(found["phases"]), "[('sort', 1, 2.5, nan, 7)]")
            self.assertIn("<td>sort</td>", page.final_numbers(self.folder, "A title", "paper"))

    def test_three_dimensional_snapshots(self):
        write_output(self.folder, dimension=3)
        particles = folder.read_particles(self.folder / "snapshot_000004.h5",
                                          ("position", "temperature", "mass", "density"))
        across, along, temperature, spacing = figures.slice_of(particles)
        self.assertAlmostEqual(spacing, 5e-6, places=12)
        # Two of the eight layers across y lie near the middle.
        self.assertEqual(len(across) / len(particles["mass"]), 2 / 8)
        self.assertEqual(along.max(), particles["position"][:, 2].max())
        self.assertNotIn("Missing:", page.write(self.folder).read_text())
        figure = morphology_figures.against_time(self.folder, 300.0)
        self.assertEqual([axis.get_ylabel().split("$")[1] for axis in figure.axes], ["V", "S", "M", r"\chi"])

    def test_every_missing_part_is_named(self):
        self.folder.mkdir()
        text = page.write(self.folder).read_text()
        for words in ("there is no morphology.h5", "there is no timings.json", "there is no history.csv",
                      "there is no snapshot_*.h5", "there is no scene.toml", "there is no profiles.h5"):
            self.assertIn(words, text)
        for title in (*FIGURES, "State behind the shock"):
            self.assertGreater(text.find(f"Missing: {title}"), text.index("Not in this report"))
            self.assertNotIn(f"<h2>{title}</h2>", text)
        self.assertNotIn("<img", text)

    def test_damaged_files_are_no_reason_to_fail(self):
        write_output(self.folder)
        for name in ("snapshot_000003.h5", "morphology_000004.h5", "timings.json", "history.csv"):
            (self.folder / name).write_bytes(b"\x89HDF,,\n")
        text = page.write(self.folder).read_text()
        self.assertIn("timings.json cannot be read", text)
        self.assertEqual(len(folder.snapshot_times(self.folder)), 4)
        self.assertEqual(len(folder.read_morphology(self.folder)[0]), 20)

    def test_hot_spots_of_the_fullest_record(self):
        write_output(self.folder)
        level, area, peak, dimension, time = folder.read_hot_spots(self.folder)
        self.assertEqual((len(level), dimension), (20, 2))
        self.assertAlmostEqual(time, 200e-9)
        self.assertEqual((area[0], peak[-1]), (1e-10, 840.0))
        (self.folder / "morphology_000020.h5").unlink()
        self.assertEqual(len(folder.read_hot_spots(self.folder)[0]), 19)

    def test_quantiles_are_named_as_such(self):
        write_output(self.folder)
        self.assertIsNone(folder.read_levels(self.folder))
        for path in self.folder.glob("morphology_*.h5"):
            with h5py.File(path, "r+") as file:
                group = file["temperature"]
                group["level"] = [THRESHOLDS]
                group["threshold"][...] = numpy.linspace(0.0, 1.0, len(THRESHOLDS))
        self.assertEqual(folder.read_levels(self.folder).shape, (21, len(THRESHOLDS)))
        _, threshold, _ = folder.read_morphology(self.folder)
        shown, title = morphology_figures.shown_thresholds(self.folder, threshold, 300.0)
        self.assertEqual((shown[0], shown[-1], title), ((0, "0"), (len(THRESHOLDS) - 1, "1"), "share of colder material"))
        self.assertIn("the quantiles ", morphology_figures.unresolved(self.folder, 300.0))
        self.assertEqual(morphology_figures.against_time(self.folder, 300.0).axes[0].get_legend().get_title().get_text(), title)

    def test_a_run_that_follows_the_front_says_that_its_morphology_is_that_of_the_window(self):
        write_output(self.folder)
        sections = page.morphology_sections(self.folder, 300.0, False)
        self.assertNotIn("window", re.sub(r'base64,[^"]*', "", "".join(sections)))
        with (self.folder / "scene.toml").open("a") as file:
            file.write('[time]\nfollow = "front"\n')
        text = re.sub(r'base64,[^"]*', "", page.write(self.folder).read_text())
        for title in ("Figure 2: morphology against time", "Figure 3: the A-L-chi space", "Hot spots"):
            section = text[text.index(f"<h2>{title}</h2>"):].partition("</section>")[0]
            self.assertIn("Only material in the window that follows the front counts", section)
        for draw in (morphology_figures.against_time, morphology_figures.space):
            self.assertEqual([draw(self.folder, 300.0, follows).axes[0].get_title() for follows in (True, False)],
                             [morphology_figures.IN_WINDOW, ""])

    def test_narrow_samples_are_stretched_and_wide_ones_are_not(self):
        for width, height in ((1e-3, 5e-3), (0.5e-3, 2.5e-3), (1e-3, 1e-3), (5e-3, 1e-3)):
            wide, high, to_scale = figures.panel_size(width, height)
            self.assertTrue(to_scale)
            self.assertAlmostEqual(wide / high, width / height)
            self.assertLessEqual(high, 7.0)
        wide, high, to_scale = figures.panel_size(40e-6, 5e-3)
        self.assertFalse(to_scale)
        self.assertLessEqual(high, 7.0)

    def test_history_is_read_by_name_without_its_cut_row(self):
        write_output(self.folder)
        columns, units = folder.read_history(self.folder)
        self.assertEqual(len(columns["time"]), 101)
        self.assertEqual((units["kinetic"], units["momentum_y"], units["step"]), ("J/m", "kg/s", "-"))
        numpy.testing.assert_allclose(columns["kinetic"] + columns["internal"], columns["total"], rtol=1e-15)


class Heat(unittest.TestCase):
    def test_numerical_share_counts_transfers_steps_and_contacts_but_no_friction(self):
        columns = {name: numpy.array([0.0, value]) for name, value in
                   zip(("plastic_work", "viscous_heat", "filter_heat", "step_heat", "wall_heat", "contact_heat", "friction_heat"),
                       (40.0, 30.0, 6.0, -1.0, 4.0, 3.0, 18.0))}
        numpy.testing.assert_array_equal(folder.numerical_share(columns), [numpy.nan, 0.08])


class Figures(unittest.TestCase):
    def test_nearest_thresholds(self):
        rises = morphology_figures.nearest_rises(THRESHOLDS, 300.0)
        self.assertEqual([label for _, label in rises], ["50 K", "100 K", "150 K", "200 K", "250 K"])
        # With few thresholds each is shown once.
        self.assertEqual([i for i, _ in morphology_figures.nearest_rises(numpy.array([350.0, 500.0]), 300.0)], [0, 1])

    def test_snapshots_are_chosen_evenly_without_the_start(self):
        times = [(float(i), None) for i in range(23)]
        self.assertEqual(figures.choose_snapshots(times), [1, 5, 9, 14, 18, 22])
        self.assertEqual(figures.choose_snapshots(times[:5]), [1, 2, 3, 4])
        self.assertEqual(figures.choose_snapshots(times[:1]), [0])

    def test_pixel_means_bridge_gaps_and_keep_voids(self):
        x, y = (axis.ravel() for axis in numpy.meshgrid(numpy.arange(9) + 0.5, numpy.arange(9) + 0.5))
        gap = (x == 2.5) & (y == 2.5)
        void = (numpy.abs(x - 5.5) < 2) & (numpy.abs(y - 5.5) < 2)
        keep = ~(gap | void)
        mean, _ = figures.pixel_mean(x[keep], y[keep], 300.0 + x[keep], ((0, 9), (0, 9)), 1.0)
        self.assertEqual(mean.shape, (9, 9))
        self.assertEqual(mean[2, 2], 302.5)  # the mean of its eight neighbours
        self.assertTrue(numpy.isnan(mean[5, 5]))
        self.assertEqual(mean[0, 3], 303.5)


if __name__ == "__main__":
    unittest.main()
