"""What ParaView sees of a run: times, particles, grains, owners of the slabs, and the view of the paper."""
import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

import h5py
import matplotlib.image
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "app"))
from program import ALUMINIUM, ROOT, ProgramTest  # noqa: E402

GRAINS = """
[domain]
size = [0.3e-3, 0.6e-3]
cell = 10e-6
periodic = true
[boundary]
low = "wall"
[sample]
kind = "voronoi_grains"
height = 0.5e-3
porosity = 0.1
grain_radius = 60e-6
[loading]
velocity = 1100
[time]
end = 60e-9
[output]
snapshot = 20e-9
[morphology]
every = 20e-9
fields = ["temperature"]
thresholds = [400.0]
""" + ALUMINIUM

# Solid aluminium: heated to 543 K up to the front, 0.11 mm above the wall at the end.
PLATE = """
[domain]
size = [80e-6, 80e-6, 240e-6]
cell = 10e-6
periodic = true
[boundary]
low = "wall"
[sample]
kind = "solid"
height = 220e-6
[loading]
velocity = 1100
[time]
end = 20e-9
[morphology]
every = 20e-9
fields = ["temperature"]
thresholds = [400.0]
""" + ALUMINIUM

READ = """
import sys
import numpy
from paraview import simple
from paraview.servermanager import Fetch
from vtkmodules.numpy_interface import dataset_adapter
reader = simple.XDMFReader(FileNames=[sys.argv[1]])
reader.UpdatePipelineInformation()
print("times", *(round(t * 1e9, 6) for t in reader.TimestepValues))
reader.UpdatePipeline(reader.TimestepValues[-1])
data = dataset_adapter.WrapDataObject(Fetch(reader))
print("points", data.GetNumberOfPoints())
for name in sorted(data.PointData.keys()):
    values = data.PointData[name]
    print("field", name, values.shape[1] if len(values.shape) > 1 else 1, float(values.sum()))
print("bounds", *(round(x * 1e6, 3) for x in Fetch(reader).GetBounds()))
for name in sorted(data.CellData.keys()):
    values = numpy.asarray(data.CellData[name])
    print("cells", name, len(values), float(numpy.nansum(values)), float(numpy.nanmean(values[:30])))
"""


@unittest.skipUnless(shutil.which("pvpython") and shutil.which("xvfb-run"), "there is no pvpython or no xvfb-run")
class ParaView(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write("grains.toml", GRAINS)
        cls.run_scene("grains.toml", "run", ranks=3)
        cls.write("read.py", READ)
        cls.write("plate.toml", PLATE)
        cls.run_scene("plate.toml", "plate")

    def pvpython(self, *arguments):
        # A server that starts anew when its last client leaves refuses the next one for a moment.
        command = ["xvfb-run", "-a", "-s", "-noreset -screen 0 1600x1600x24", "pvpython", *map(str, arguments)]
        done = subprocess.run(command, cwd=self.folder, text=True, capture_output=True, check=False, timeout=240)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def test_times_particles_grains_and_owners(self):
        text = self.pvpython("read.py", "run/snapshots.xdmf")
        self.assertIn("times 0.0 20.0 40.0 60.0\n", text)
        fields = {name: (int(width), float(total))
                  for name, width, total in re.findall(r"^field (\S+) (\d) (\S+)$", text, re.M)}
        with h5py.File(self.folder / "run/snapshot_000012.h5") as file:
            particles = file["particles"]
            self.assertIn(f"points {len(particles['id'])}\n", text)
            self.assertEqual(set(fields), set(particles) - {"position"} | {"owner"})
            self.assertGreater(len(numpy.unique(particles["grain"])), 5)
            self.assertEqual(set(numpy.unique(file["slabs/owner"])), {0, 1, 2})
            for name, (width, total) in fields.items():
                data = file["slabs/owner"] if name == "owner" else particles[name]
                self.assertEqual(width, data.shape[1] if data.ndim > 1 else 1, name)
                numpy.testing.assert_allclose(total, data[...].astype(float).sum(), rtol=1e-9, atol=1e-6, err_msg=name)

    def test_maps_lie_where_the_particles_are(self):
        text = self.pvpython("read.py", "run/maps.xdmf")
        self.assertIn("times 0.0 20.0 40.0 60.0\n", text)
        # 30 x 60 cells of 10 um.
        self.assertIn("bounds 0.0 300.0 0.0 600.0 -5.0 5.0\n", text)
        name, count, total, lowest = re.search(r"^cells (\S+) (\d+) (\S+) (\S+)$", text, re.M).groups()
        self.assertEqual((name, int(count)), ("temperature", 1800))
        with h5py.File(self.folder / "run/snapshot_000012.h5") as file:
            temperature = file["map/temperature"][...]
        self.assertEqual(temperature.shape, (60, 30))
        self.assertAlmostEqual(float(total) / numpy.nansum(temperature), 1.0, places=12)
        self.assertAlmostEqual(float(lowest) / numpy.nanmean(temperature[0]), 1.0, places=12)

    def picture(self, *options, run="run"):
        text = self.pvpython(ROOT / "tools/paraview_view.py", run, "--output", "view.png", *options)
        shot = matplotlib.image.imread(self.folder / "view.png")[:, :, :3]
        self.assertEqual(shot.shape[0], 1200)
        return text, shot

    @staticmethod
    def row_of(where):
        """Mean row of the pixels, counted from above."""
        return (where * numpy.arange(1200)[:, None]).sum() / where.sum()

    def test_the_view_of_the_paper(self):
        text, shot = self.picture("--time", "40")
        self.assertIn("particles at 40 ns, temperature ", text)
        cold = shot.max(axis=2) < 0.1
        hot = (shot[:, :, 0] > 0.5) & (shot[:, :, 2] < 0.7)
        # Not yet reached above, heated below; the wall lies low in the picture.
        self.assertGreater(cold.mean(), 0.05)
        self.assertGreater(hot.mean(), 0.005)
        self.assertGreater(self.row_of(hot), self.row_of(cold) + 100)

    def test_the_hot_surface_in_three_dimensions(self):
        _, shot = self.picture("--surface", "450", run="plate")
        orange = (shot[:, :, 0] > 1.6 * shot[:, :, 1]) & (shot[:, :, 2] < 0.1) & (shot[:, :, 0] > 0.2)
        self.assertGreater(orange.mean(), 0.01)
        # Nothing but the front is at 450 K: a plane a little below the middle, seen from above.
        rows = numpy.flatnonzero(orange.any(axis=1))
        self.assertLess(rows.max() - rows.min(), 500)
        self.assertGreater(self.row_of(orange), 600)

    def test_slices_in_three_dimensions(self):
        _, shot = self.picture("--slices", "0.05", "0.16", run="plate")
        heated = (shot[:, :, 0] > 0.3) & (shot[:, :, 1] < 0.5 * shot[:, :, 0]) & (shot[:, :, 2] > 0.2)
        cold = shot.max(axis=2) < 0.1
        self.assertGreater(heated.mean(), 0.01)
        self.assertGreater(cold.mean(), 0.01)
        self.assertGreater(self.row_of(heated), self.row_of(cold) + 200)

    def test_surfaces_are_for_three_dimensions(self):
        with self.assertRaisesRegex(AssertionError, "--surface and --slices are for runs in three dimensions"):
            self.picture("--surface", "450")

    def test_the_owners_of_the_slabs(self):
        _, shot = self.picture("--slabs")
        for colour in ((0.27, 0.00, 0.33), (0.13, 0.57, 0.55), (0.99, 0.91, 0.14)):
            close = (numpy.abs(shot - numpy.array(colour)).max(axis=2) < 0.05).mean()
            self.assertGreater(close, 0.02, colour)

    def test_what_is_missing_is_named(self):
        with self.assertRaisesRegex(AssertionError, "no field heat; the snapshot holds colour, density, "):
            self.picture("--field", "heat")


if __name__ == "__main__":
    unittest.main()
