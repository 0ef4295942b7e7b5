"""A porous 3-D run: the number of ranks and a restart cannot be seen in it."""
import math

import h5py
import numpy

from program import BALLS, ProgramTest, closing_lines, datasets, history, particles, same_bits


class ThreeDimensions(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write("balls.toml", BALLS)
        cls.results = {n: cls.run_scene("balls.toml", f"on{n}", ranks=n) for n in (1, 2, 3)}

    def test_same_bits_on_any_number_of_ranks(self):
        first = particles(self.folder / "on1/snapshot_000004.h5")
        self.assertEqual(first["stress"].shape, (len(first["id"]), 6))
        for n in (2, 3):
            self.assertEqual(closing_lines(self.results[n]), closing_lines(self.results[1]))
            self.assert_same_datasets(f"on{n}/morphology.h5", "on1/morphology.h5")
            self.assertEqual((self.folder / f"on{n}/history.csv").read_bytes(),
                             (self.folder / "on1/history.csv").read_bytes())
            for field, values in particles(self.folder / f"on{n}/snapshot_000004.h5").items():
                self.assertTrue(same_bits(values, first[field]), f"{field} on {n} ranks")

    def test_energies(self):
        rows = history(self.folder / "on1/history.csv")
        self.assertIn("momentum_z", rows)
        self.assertLess(numpy.ptp(rows["total"]), 1e-10 * rows["total"][0])
        last = particles(self.folder / "on1/snapshot_000004.h5")
        total = math.fsum(last["mass"] * (last["kinetic_energy"] + last["internal_energy"]))
        expected = rows["kinetic"][-1] + rows["internal"][-1]
        self.assertLess(abs(total - expected), 1e-12 * expected)
        self.assertGreater(rows["plastic_work"][-1], 0.0)

    def test_voids_are_balls(self):
        volume = 4 / 3 * math.pi * (22**3 + 25**3 + 20**3) * 1e-18
        with h5py.File(self.folder / "on1/snapshot_000000.h5") as file:
            mass = math.fsum(file["particles/mass"][...])
        solid = 0.1e-3 * 0.1e-3 * 0.2e-3
        self.assertLess(abs(mass / 2700 - (solid - volume)), 0.05 * volume)

    def test_morphology_counts_voxels(self):
        curves = datasets(self.folder / "on1/morphology.h5")
        self.assertEqual(curves["temperature/C"].shape, (3, 7))
        self.assertGreater(curves["temperature/C"][-1, 0], 50)
        self.assertTrue((numpy.diff(curves["temperature/C"], axis=1) <= 0).all())
        # Voxel faces are longer than the surface they follow, by 3/2 for all directions alike; a surface ends where its
        # cube has a void corner.
        faces, surface = curves["temperature/S"], curves["temperature/S_isosurface"]
        measured = faces > 0.01
        self.assertTrue(measured.any())
        self.assertTrue(((0.2 < surface[measured] / faces[measured]) & (surface[measured] / faces[measured] < 1.05)).all())

    def test_restart_on_another_number_of_ranks(self):
        checkpoints = sorted((self.folder / "on3").glob("checkpoint_*.h5"))
        self.assertGreater(len(checkpoints), 0)
        self.assertLess(int(checkpoints[0].stem[-9:]), history(self.folder / "on3/history.csv")["step"][-1] - 5)
        result = self.run_scene("balls.toml", "continued", "--restart", f"on3/{checkpoints[0].name}", ranks=2)
        self.assertEqual(closing_lines(result), closing_lines(self.results[1]))
        first = particles(self.folder / "on1/snapshot_000004.h5")
        for field, values in particles(self.folder / "continued/snapshot_000004.h5").items():
            self.assertTrue(same_bits(values, first[field]), field)
        curves, late = (datasets(self.folder / name / "morphology.h5") for name in ("on1", "continued"))
        for name, values in late.items():
            rows = values if name.endswith("threshold") else curves[name][-len(values):]
            self.assertTrue(same_bits(values, numpy.ascontiguousarray(rows)), name)
