"""The summary on top of the report says what the tools and the files say, its movie moves, and two runs fit on one page."""
import csv
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy
from PIL import Image

TOOLS = Path(__file__).resolve().parents[2] / "tools"
sys.path.insert(0, str(TOOLS))
from fake_output import THRESHOLDS, write_output  # noqa: E402
from poreshock_report import comparison, folder, frames, morphology_figures, style, summary  # noqa: E402


def text_of(page_text):
    """The page without tags and pictures, one space between words."""
    return re.sub(r"\s+", " ", re.sub(r"<[^>]*>", " ", page_text))


class Folders(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = Path(self.temporary.name) / "run"
        write_output(self.folder, "conserving")


class Summary(Folders):
    def head(self):
        return text_of(summary.head(self.folder, folder.read_scene(self.folder), 300.0, ""))

    def test_figures_of_the_shock_are_those_of_the_tool(self):
        printed = subprocess.run([TOOLS / "hugoniot.py", self.folder], capture_output=True, text=True, check=True).stdout
        rows = [[entry.strip() for entry in line.strip("|").split("|")] for line in printed.splitlines() if line.startswith("|")]
        table = {row[0]: dict(zip(("measured", "+-", "solid", "off", "snow-plow", "error"), row[1:])) for row in rows[2:]}
        found, shown = self.head(), 0
        for name in ("Us [m/s]", "P [GPa]", "T [K]"):
            row = table[name]
            self.assertIn(f"{name} {row['measured']} {row['+-']} {row['snow-plow']} {row['error']}", found)
            shown += 1
        self.assertEqual(shown, 3)
        self.assertIn("Us [m/s] 3300.0 0.0 3336.3 -1.09 %", found)

    def test_a_plate_is_compared_with_its_exact_state(self):
        with h5py.File(self.folder / "profiles.h5", "r+") as file:
            file["row/solid_fraction"][...] = numpy.where(file["row/solid_fraction"][()] > 0.0, 1.0, 0.0)
        head, rows = summary.shock_rows(self.folder)
        self.assertEqual((head[3], rows[0][3]), ("exact", "6841.8"))

    def test_heat_is_that_of_the_last_row_of_the_history(self):
        with (self.folder / "history.csv").open(newline="") as file:
            rows = list(csv.reader(file))
        last = {title.split(" ")[0]: float(entry) for title, entry in zip(rows[0], rows[-2])}  # the last one is cut
        heat = sum(last[name] for name in ("plastic_work", "viscous_heat", "filter_heat", "step_heat", "wall_heat", "contact_heat",
                                           "friction_heat"))
        found = self.head()
        for label, value in (("plastic work", last["plastic_work"]), ("artificial viscosity", last["viscous_heat"]),
                             ("walls and friction", last["wall_heat"]), ("velocity transfer (numerical)", last["filter_heat"])):
            self.assertIn(f"{label} {100.0 * value / heat:.1f} %", found)
        self.assertIn(f"Numerical dissipation: {100.0 * (last['filter_heat'] + last['step_heat'] + last['contact_heat']) / heat:.1f} % of all heat", found)
        self.assertIn("Numerical dissipation: 4.2 %", found)
        self.assertIn("48 000 particles, 1 000 steps, 200 ns", found)

    def test_what_was_run_and_how_fast(self):
        found = self.head()
        self.assertIn("A block with voids, 0.4 x 1.8 mm, of aluminium, void fraction 0.3; impact at 1100 m/s; cells of 10 um (8 per "
                      "void diameter)", found)
        self.assertIn("0.19 million particle steps per second and core, 2 ranks, 123.5 s.", found)

    def test_a_scene_that_lacks_something_is_no_reason_to_fail(self):
        for lacking in ("cell = 10e-6", "size = ", "void_radius = ", "kind = \"random_voids\""):
            lines = (self.folder / "scene.toml").read_text().splitlines()
            kept = "\n".join(line for line in lines if not line.startswith(lacking))
            self.assertLess(len(kept.splitlines()), len(lines))
            other = self.folder.parent / "lacking"
            other.mkdir(exist_ok=True)
            (other / "scene.toml").write_text(kept)
            self.assertIn("there is no history.csv", text_of(summary.head(other, folder.read_scene(other), 300.0, "")))

    def test_warnings(self):
        scene = folder.read_scene(self.folder)
        self.assertIn("Warning: A void is only &quot;8&quot; cells across.", self.head())
        (self.folder / "timings.json").unlink()
        for path in self.folder.glob("morphology_*.h5"):
            with h5py.File(path, "r+") as file:
                file["temperature/chi4"][...] = file["temperature/chi"][()]
        self.assertEqual(summary.warnings(self.folder, scene, 300.0), [])
        self.assertIn("No warnings.", summary.warning_list(self.folder, scene, 300.0))
        scene["time"] = {"end": 300e-9}
        (self.folder / "failed.h5").touch()
        rows = (self.folder / "history.csv").read_text().splitlines()
        last = rows[-2].split(",")
        last[9], last[14] = "1001", "400"  # total and filter heat, J/m
        (self.folder / "history.csv").write_text("\n".join((*rows[:-2], ",".join(last))))
        found = " ".join(summary.warnings(self.folder, scene, 300.0))
        for words in ("The run stands at 200 ns; time.end is 300 ns.", "Numerical dissipation is 36 % of all heat",
                      "Set domain.cell to 5e-06 m or less.", "drifts by 1.0e-03 of itself", "The state of the run went bad"):
            self.assertIn(words, found)

    def test_unresolved_thresholds_are_named(self):
        self.assertIn("at 250 K above the start, the Euler characteristics", self.head())

    def test_without_files_it_says_what_is_not_there(self):
        for path in self.folder.iterdir():
            path.unlink()
        found = text_of(summary.head(self.folder, {}, 300.0, ""))
        for words in ("there is no history.csv", "there is no timings.json", "there is no scene.toml"):
            self.assertIn(words, found)

    def test_the_chi_of_domains_is_shown_where_they_are_counted(self):
        arrays = morphology_figures.functionals(self.folder)[2]
        self.assertEqual(list(arrays), ["A", "L", "chi_paper"])
        for path in self.folder.glob("morphology_*.h5"):
            with h5py.File(path, "r+") as file:
                del file["temperature/chi_paper"]
        arrays = morphology_figures.functionals(self.folder)[2]
        self.assertEqual(list(arrays), ["A", "L", "chi"])
        self.assertEqual(arrays["chi"].shape, (21, len(THRESHOLDS)))


class Movie(Folders):
    def test_one_frame_for_each_snapshot_in_a_small_file(self):
        text = frames.movie(self.folder, frames.draw_all(self.folder))
        path = self.folder / "pictures/temperature.webp"
        with Image.open(path) as movie:
            self.assertEqual((movie.format, movie.n_frames), ("WEBP", 5))
            shown = []
            for i in range(movie.n_frames):
                movie.seek(i)
                shown.append(numpy.asarray(movie.convert("RGB"), float))
        for before, after in zip(shown, shown[1:]):
            self.assertGreater(numpy.abs(after - before).mean(), 0.5)
        self.assertLess(path.stat().st_size, 300_000)
        self.assertIn('media="(prefers-reduced-motion: reduce)" srcset="data:image/webp', text)
        self.assertIn('alt="temperature from 0 ns to 200 ns"', text)


class Comparison(Folders):
    def setUp(self):
        super().setUp()
        self.other = self.folder.parent / "other"
        write_output(self.other, "paper")
        scene = (self.other / "scene.toml").read_text().replace("porosity = 0.3", "porosity = 0.3\nseed = 2")
        (self.other / "scene.toml").write_text(scene)

    def test_one_page_by_the_command(self):
        done = subprocess.run([TOOLS / "report.py", self.folder, self.other], capture_output=True, text=True, check=False)
        path = self.other / "compared_with_run.html"
        self.assertEqual((done.returncode, done.stdout), (0, f"report: {path}\n"), done.stderr)
        text = path.read_text()
        self.assertNotIn("Missing:", text)
        self.assertEqual(text.count('src="data:image/png'), 4)
        found = text_of(re.sub(r"base64,[^\"]*", "", text))
        self.assertIn("Us [m/s] 3300.0 +- 0.0 3300.0 +- 0.0 +0.00 %", found)
        self.assertIn("key run other sample.seed not there 2 thermal conserving paper", found)
        self.assertFalse((self.folder / "report.html").exists())

    def test_differences_are_of_the_second_to_the_first(self):
        text = (self.other / "timings.json").read_text().replace("123.5", "247")
        (self.other / "timings.json").write_text(text)
        rows = {row[0]: row[1:] for row in comparison.number_rows((self.folder, self.other))}
        self.assertEqual(rows["wall time [s]"], ("123.5", "247", "+100.00 %"))
        self.assertEqual(rows["numerical dissipation"], ("4.2 %", "4.2 %", "+0.00 %"))

    def test_runs_without_common_times_say_so(self):
        for number in range(1, 5):
            with h5py.File(self.other / f"snapshot_{number:06d}.h5", "r+") as file:
                file.attrs["time"] = number * 31e-9
        (self.other / "snapshot_000000.h5").unlink()
        self.assertIn("the runs have no snapshots of the same time", comparison.write(self.folder, self.other).read_text())

    def test_usage(self):
        for names, words in (((), "DIR"), ((self.folder, self.other, self.other), "found 3 folders; give one for its report, or two"),
                             (("nowhere",), "there is no folder 'nowhere'")):
            done = subprocess.run([TOOLS / "report.py", *names], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 2)
            self.assertIn(words, done.stderr)


# Simulation of colour vision without red and without green cones, of linear RGB (Machado, Oliveira & Fernandes 2009).
BLIND = {"protanope": ((0.152286, 1.052583, -0.204868), (0.114503, 0.786281, 0.099216), (-0.003882, -0.048116, 1.051998)),
         "deuteranope": ((0.367322, 0.860646, -0.227968), (0.280085, 0.672501, 0.047413), (-0.011820, 0.042940, 0.968881))}


def lab(colours, matrix):
    """CIELAB of sRGB colours as one sees them through a matrix of linear RGB."""
    rgb = numpy.asarray(colours)
    linear = numpy.where(rgb > 0.04045, ((rgb + 0.055) / 1.055)**2.4, rgb / 12.92)
    linear = numpy.clip(linear @ numpy.transpose(matrix), 0.0, 1.0)
    to_xyz = numpy.array(((0.4124, 0.3576, 0.1805), (0.2126, 0.7152, 0.0722), (0.0193, 0.1192, 0.9505)))
    ratio = linear @ to_xyz.T / to_xyz.sum(axis=1)
    f = numpy.where(ratio > 0.008856, numpy.cbrt(ratio), 7.787 * ratio + 16.0 / 116.0)
    return numpy.stack([116.0 * f[:, 1] - 16.0, 500.0 * (f[:, 0] - f[:, 1]), 200.0 * (f[:, 1] - f[:, 2])], axis=1)


class Colours(unittest.TestCase):
    def test_hotter_is_lighter_for_all_eyes(self):
        for matrix in (numpy.eye(3), *BLIND.values()):
            seen = lab(style.HEAT(numpy.linspace(0.0, 1.0, 64))[:, :3], matrix)
            self.assertGreater(numpy.diff(seen[:, 0]).min(), 0.0)
            self.assertGreater(numpy.linalg.norm(seen[-1] - lab(numpy.ones((1, 3)), matrix)[0]), 20.0)  # white is void

    def test_lines_differ_by_colour_for_all_eyes_and_by_dashes(self):
        colours = [[int(code[i:i + 2], 16) / 255.0 for i in (1, 3, 5)] for code in style.COLOURS]
        for matrix in (numpy.eye(3), *BLIND.values()):
            seen = lab(colours[:6], matrix)
            apart = numpy.linalg.norm(seen[:, None] - seen[None], axis=2)[numpy.triu_indices(6, 1)]
            self.assertGreater(apart.min(), 10.0)
        self.assertEqual(len(set(style.DASHES)), len(style.COLOURS))
        lines = style.ordered(6)
        self.assertEqual(len({str(line["linestyle"]) for line in lines}), 6)


if __name__ == "__main__":
    unittest.main()
