"""Agreement with scikit-image on maps of real snapshots: domains, Euler characteristics, Crofton length."""
import sys
import unittest
from pathlib import Path

import h5py
import numpy

import program
from program import POROUS

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from poreshock_report import figures  # noqa: E402

try:
    from skimage import measure
except ImportError:
    measure = None

LEVELS = numpy.arange(320.0, 900.0, 20.0)


def pixel_map(path, pixel):
    """Means of the temperature on pixels, voids cold, with a cold margin so that nothing hot lies on the frame."""
    with h5py.File(path) as file:
        position, temperature = (file[f"particles/{name}"][...] for name in ("position", "temperature"))
    extent = [(position[:, axis].min(), position[:, axis].max()) for axis in (0, 1)]
    mean, _ = figures.pixel_mean(*position.T, temperature, extent, pixel)
    return numpy.ascontiguousarray(numpy.pad(numpy.nan_to_num(mean, nan=0.0), 2, constant_values=0.0))


@unittest.skipIf(measure is None, "scikit-image (python3-skimage) cannot be imported")
class ScikitImage(program.ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write("porous.toml", POROUS)
        cls.run_scene("porous.toml", "run", "--set", "time.end=120e-9", "--set", "output.snapshot=40e-9",
                      "--set", "sample.porosity=0.25")
        cls.maps = [pixel_map(path, 5e-6) for path in sorted((cls.folder / "run").glob("snapshot_*.h5"))[1:]]

    def test_domains_euler_characteristics_and_crofton_length(self):
        checked = 0
        for number, image in enumerate(self.maps):
            numpy.save(self.folder / f"map{number}.npy", image)
            for ranks in (1, 3, 6):
                self.succeed("analyze", f"map{number}.npy", "--thresholds", "320:880:20", "--output", f"of{number}_{ranks}",
                             ranks=ranks)
                found = program.datasets(self.folder / f"of{number}_{ranks}/morphology.h5")
                ours = {name.split("/")[-1]: values[0] for name, values in found.items() if name.startswith("array/")}
                for k, level in enumerate(LEVELS):
                    white = image >= level
                    self.assertEqual(ours["F"][k], white.sum())
                    self.assertEqual(ours["n_W"][k], measure.label(white, connectivity=2).max())
                    self.assertEqual(ours["n_B"][k], measure.label(~white, connectivity=1).max())
                    self.assertEqual(ours["V"][k] - ours["E"][k] + ours["F"][k], measure.euler_number(white, connectivity=2))
                    self.assertEqual(ours["E"][k] - 3 * ours["F"][k] + ours["V4"][k], measure.euler_number(white, connectivity=1))
                    crofton = measure.perimeter_crofton(white, directions=4)
                    self.assertAlmostEqual(ours["L_crofton"][k] * image.size, crofton, delta=1e-9 * crofton + 1e-9)
                    checked += white.any() and not white.all()
        self.assertGreater(checked, 100)


if __name__ == "__main__":
    unittest.main()
