"""The report of runs in three dimensions: slices, and the surface of the hot region against a ball."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy

TOOLS = Path(__file__).resolve().parents[2] / "tools"
sys.path.insert(0, str(TOOLS))
from fake_output import HEIGHT, HOT, WIDTH, write_output  # noqa: E402
from poreshock_report import folder, raycast, volume_figures  # noqa: E402

SHAPE = (36, 30, 64)


def ball(centre, radius):
    """Radius less distance from the centre at the centres of voxels, so that 0 is the surface."""
    places = numpy.stack(numpy.meshgrid(*(numpy.arange(count) + 0.5 for count in SHAPE), indexing="ij"), axis=-1)
    return radius - numpy.linalg.norm(places - centre, axis=-1)


class Surface(unittest.TestCase):
    def test_a_ball_is_a_disc_where_it_should_be_lit_from_its_side(self):
        centre, radius = (16.0, 14.0, 40.0), 10.3
        shade, (left, right, low, high) = raycast.shaded_surface(ball(centre, radius), 0.0)
        pixel = (high - low) / shade.shape[0]
        self.assertAlmostEqual((right - left) / shade.shape[1] / pixel, 1.0, delta=0.01)
        seen = numpy.isfinite(shade)
        self.assertAlmostEqual(seen.sum() * pixel**2 / (numpy.pi * radius**2), 1.0, delta=0.02)
        rows, columns = numpy.nonzero(seen)
        middle = left + pixel * (columns.mean() + 0.5), low + pixel * (rows.mean() + 0.5)
        numpy.testing.assert_allclose(middle, raycast.project(centre, SHAPE), atol=0.1)
        # Lambert's law: brightest where the surface faces the light, darkest on the other side.
        row, column = numpy.unravel_index(numpy.nanargmax(shade), shade.shape)
        bright = left + pixel * (column + 0.5) - middle[0], low + pixel * (row + 0.5) - middle[1]
        numpy.testing.assert_allclose(bright, (radius * raycast.LIGHT @ raycast.RIGHT, radius * raycast.LIGHT @ raycast.UP), atol=0.7)
        self.assertAlmostEqual(numpy.nanmax(shade), 1.0, delta=0.01)
        self.assertAlmostEqual(numpy.nanmin(shade), 0.3, delta=0.01)

    def test_what_lies_in_front_hides_what_is_behind(self):
        near = numpy.array(SHAPE) / 2.0 - 9.0 * raycast.AHEAD
        far = numpy.array(SHAPE) / 2.0 + 6.0 * raycast.AHEAD
        both = raycast.shaded_surface(numpy.maximum(ball(near, 6.0), ball(far, 4.0)), 0.0)[0]
        alone = raycast.shaded_surface(ball(near, 6.0), 0.0)[0]
        numpy.testing.assert_array_equal(numpy.isfinite(both), numpy.isfinite(alone))
        numpy.testing.assert_allclose(both, alone, atol=0.02)

    def test_the_surface_is_closed_where_the_box_cuts_it(self):
        shade, (_, _, low, high) = raycast.shaded_surface(numpy.ones(SHAPE), 0.5)
        pixel = (high - low) / shade.shape[0]
        # The box from this side: three faces, each its area times how much it faces the eye.
        faces = numpy.prod(SHAPE) / numpy.array(SHAPE)
        self.assertAlmostEqual(numpy.isfinite(shade).sum() * pixel**2 / (faces @ numpy.abs(raycast.AHEAD)), 1.0, delta=0.05)

    def test_nothing_reaches_the_level(self):
        self.assertFalse(numpy.isfinite(raycast.shaded_surface(ball((9.0, 9.0, 9.0), 5.0), 6.0)[0]).any())

    def test_the_outline_has_the_edges_of_the_box(self):
        edges = raycast.outline(SHAPE)
        self.assertEqual(len(edges), 12)
        upright = [ends for ends in edges if abs(ends[0][0] - ends[0][1]) < 1e-9]
        self.assertEqual(len(upright), 4)
        for _, (low, high) in upright:
            self.assertAlmostEqual(abs(high - low), SHAPE[2] * numpy.cos(raycast.ELEVATION))


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name) / "run"
        write_output(cls.folder, dimension=3)

    def test_slices_at_chosen_heights(self):
        figure = volume_figures.slices(self.folder, [0.2e-3, 0.65e-3])
        titles = [axis.get_title() for axis in figure.axes[:2]]
        self.assertEqual(titles, ["0.2 mm high", "0.65 mm high"])
        image = numpy.ma.filled(figure.axes[0].images[0].get_array(), numpy.nan)
        self.assertEqual(image.shape, (8, round(WIDTH / 5e-6)))  # y, x on the spacing of the particles
        self.assertGreater(numpy.nanmin(image), HOT - 1.0)  # behind the front

    def test_heights_spread_over_what_is_hot(self):
        height = numpy.linspace(0.0, HEIGHT, 401)
        temperature = numpy.where(height < 0.8e-3, 900.0, 300.0)
        numpy.testing.assert_allclose(volume_figures.slice_heights(height, temperature, ()), [0.1e-3, 0.3e-3, 0.5e-3, 0.7e-3],
                                      rtol=0.01)
        self.assertEqual(volume_figures.slice_heights(height, temperature, (1e-3,)), [1e-3])

    def test_the_level_is_that_of_hot_spots_that_enough_has_reached(self):
        voxels = volume_figures.read_map(self.folder / "snapshot_000004.h5")[0]
        scene = self.folder / "scene.toml"
        text = scene.read_text()
        self.addCleanup(scene.write_text, text)
        self.assertAlmostEqual(volume_figures.level_of(self.folder, voxels), numpy.nanquantile(voxels, 0.9))
        scene.write_text(text + "[morphology]\nhot_spots = { temperature = [9000.0, 700.0, 500.0] }\n")
        self.assertEqual(volume_figures.level_of(self.folder, voxels), 500.0)
        scene.write_text(text + "[morphology]\nhot_spots = [9000.0]\n")
        self.assertAlmostEqual(volume_figures.level_of(self.folder, voxels), numpy.nanquantile(voxels, 0.9))

    def test_the_page_has_both_and_the_volumes_of_the_hot_spots(self):
        done = subprocess.run([TOOLS / "report.py", self.folder, "--heights", "0.2", "0.65"], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        text = (self.folder / "report.html").read_text()
        self.assertNotIn("Missing:", text)
        for title in ("Slices across the shock axis", "Surface of the hot region", "Hot spots"):
            self.assertIn(f"<h2>{title}</h2>", text)
        self.assertEqual(folder.read_hot_spots(self.folder)[3], 3)


if __name__ == "__main__":
    unittest.main()
