"""The judging of cases: rows, verdicts, lines of the tests, and readers of what a run writes."""
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from poreshock_cases import accuracy, always, bits, catalogue, free, program, speed, table, void_reference  # noqa: E402


class Rows(unittest.TestCase):
    def test_bars(self):
        self.assertTrue(table.limit("a", "b", -0.9, 1.0).ok)
        self.assertFalse(table.limit("a", "b", -1.0, 1.0).ok)
        self.assertFalse(table.limit("a", "b", float("nan"), 1.0).ok)
        self.assertTrue(table.near("a", "b", 1.02, 1.0, 0.021).ok)
        self.assertFalse(table.near("a", "b", 0.97, 1.0, 0.021).ok)
        self.assertFalse(table.near("a", "b", float("nan"), 1.0, 0.1).ok)
        self.assertTrue(table.same("a", "b", ["1", "1"]).ok)
        self.assertFalse(table.same("a", "b", ["1", "2"]).ok)

    def test_known_misses_fail_only_when_they_no_longer_miss(self):
        rows = [table.Row("a", "met", "1", "2", True), table.Row("a", "missed", "3", "2", False),
                table.Row("a", "told", "3", "", None)]
        self.assertEqual(table.failures(rows, {}), ["a: missed: 3, wanted 2"])
        self.assertEqual(table.failures(rows, {("a", "missed"): "Why."}), [])
        self.assertEqual(table.failures(rows, {("a", "met"): "Why.", ("a", "missed"): "Why."}),
                         ["a: met is listed as a known miss but passes"])
        self.assertEqual(table.markdown(rows, {("a", "missed"): "Why."}),
                         "| case | figure | value | bar | pass |\n|---|---|---|---|---|\n| a | met | 1 | 2 | yes |\n"
                         "| a | missed | 3 | 2 | known miss |\n| a | told | 3 |  |  |\n\nKnown misses:\n\n"
                         "- a, missed. Why.\n")
        self.assertIn("| **no** |", table.markdown(rows, {}))

    def test_points_of_a_case_are_columns(self):
        rows = [table.Row("plate, paper, 300 / 500 m/s", "stress", "+0.10 / -0.40 %; missed at 500", "0.3 %", False),
                table.Row("plate, paper, 300 / 500 m/s", "drift", "1e-16 / 2e-16", "1e-10", True),
                table.Row("other", "met", "1", "2", True)]
        self.assertEqual(table.markdown(rows, {}),
                         "plate, paper, at m/s:\n\n| figure | 300 | 500 | bar | pass |\n|---|---|---|---|---|\n"
                         "| stress, % | +0.10 | -0.40 | 0.3 % | **no**; missed at 500 |\n"
                         "| drift | 1e-16 | 2e-16 | 1e-10 | yes |\n\n"
                         "| case | figure | value | bar | pass |\n|---|---|---|---|---|\n| other | met | 1 | 2 | yes |\n")

    def test_every_known_miss_belongs_to_a_case(self):
        self.assertEqual({case for case, _ in catalogue.KNOWN} - set(catalogue.CASES), set())

    def test_lines_of_the_tests(self):
        text = "3: VERIFY vortex 'L2 order' 2.03 '>= 1.8' pass\nVERIFY rod order 1.2 >=1.8 fail\n4: other VERIFY x\n"
        self.assertEqual(accuracy.parse_verify(text), [table.Row("vortex", "L2 order", "2.03", ">= 1.8", True),
                                                       table.Row("rod", "order", "1.2", ">=1.8", False)])
        with self.assertRaisesRegex(ValueError, "VERIFY rod order 1.2 fail"):
            accuracy.parse_verify("VERIFY rod order 1.2 fail\n")

    def test_bars_of_the_plates(self):
        figures = dict.fromkeys(accuracy.BARS, 0.0)
        warm = figures | {"temperature rise": -1.2}
        rows = {row.figure: row for row in accuracy.rows_of_plates("p", {500.0: warm, 700.0: warm, 3000.0: figures})}
        self.assertEqual([name for name, row in rows.items() if not row.ok], ["temperature rise"])
        self.assertEqual(rows["temperature rise"].value, "-1.20 / -1.20 / +0.00 %; missed at 700")
        self.assertEqual(rows["temperature rise"].bar, "1 %, below 700 m/s 1.5 %")
        rows = accuracy.rows_of_plates("p", {1100.0: figures | {"stress": 0.31}})
        self.assertEqual([(row.figure, row.bar) for row in rows if not row.ok], [("stress", "0.3 %")])


class Speed(unittest.TestCase):
    LISTING = """Events shown:     Ir DLmr DLmw
--------------------------------------------------------------------------------
Ir                   DLmr        DLmw
138,625,503 (100.0%) 14 (100.0%) 1,213 (100.0%)  PROGRAM TOTALS

138,625,503 (100.0%) 14 (100.0%) 1,213 (100.0%)  ???:void poreshock::advance<2>(poreshock::Simulation<2>&, double)
 37,058,430 (26.73%)  1 ( 7.14%)   449 (37.02%)  ???:void poreshock::grid_to_particles<2>(poreshock::SlabGrid const&)
 23,225,437 (16.75%)  0             16 ( 1.32%)  ???:void poreshock::particles_to_grid<2>(poreshock::Particles<2> const&)
 11,807,914 ( 8.52%)  7 (50.00%)    32 ( 2.64%)  ???:void poreshock::particles_to_grid<3>(poreshock::Particles<3> const&)
  1,000,000 ( 0.72%)  .              .           ???:void poreshock::update_stress<2>(poreshock::Material const&)
"""

    def test_counts_of_the_phases(self):
        counts = speed.read_counts(self.LISTING.splitlines())
        self.assertEqual(counts[""], speed.Count(138625503, 64 * 1227))
        self.assertEqual(counts["grid to particles"], speed.Count(37058430, 64 * 450))
        self.assertEqual(counts["particles to grid"], speed.Count(23225437 + 11807914, 64 * 55))
        self.assertEqual(counts["stress"], speed.Count(1000000, 0))
        self.assertEqual(counts["contact"], speed.Count(0, 0))

    def test_the_slower_of_instructions_and_bytes_is_the_bound(self):
        machine = speed.Machine(instructions=4e9, bytes=10e9, program_rate=3e6, plain_rate=1e6)
        self.assertEqual(speed.Count(400.0, 100.0).least_time(machine), 100.0)
        self.assertEqual(speed.Count(4.0, 100.0).least_time(machine), 10.0)
        timing = speed.Timing("s", "default", 1, 10.0, 2.0, 300.0, {"stress": 200.0, "sort": 5.0},
                              {"": speed.Count(700.0, 300.0), "stress": speed.Count(400.0, 100.0)})
        self.assertIn("| 300 | 700 | 200.0 (400; 50 %) | 5.0 |", speed.markdown([timing], machine))
        self.assertIn("| 200.0 | 5.0 |", speed.markdown([timing]))
        self.assertEqual(timing.row()["stress [bytes/particle-step]"], "100.0")


class Extrapolation(unittest.TestCase):
    def test_limit_of_halved_cells(self):
        # 10 - 8 / 2^n, of first order, and a sequence that swings.
        first = void_reference.limit([2.0, 6.0, 8.0, 9.0])
        self.assertAlmostEqual(first.value, 10.0)
        self.assertAlmostEqual(first.order, 1.0)
        self.assertAlmostEqual(first.doubt, 1.0)
        swings = void_reference.limit([0.0, 8.0, 4.0, 6.0])
        self.assertAlmostEqual(swings.value, 6.0 - 2.0 / 3.0)
        self.assertAlmostEqual(swings.order, 1.0)
        # Where a halving gains little, what the extrapolation adds is the doubt.
        slow = void_reference.limit([0.0, 0.0, 5.0, 8.0])
        self.assertAlmostEqual(slow.value, 8.0 + 4.5)
        self.assertAlmostEqual(slow.doubt, 4.5)
        slower = void_reference.limit([0.0, 0.0, 10.0, 19.0])
        self.assertEqual((slower.value, slower.doubt), (19.0, 9.0))
        self.assertIn("too low to extrapolate, +9 per halving", void_reference.tendency(slower))

    def test_differences_that_do_not_shrink(self):
        for values in ([0.0, 1.0, 2.0, 3.5], [0.0, 0.0, 0.0, 0.0], [0.0, 1.0, 2.0, 1.0]):
            found = void_reference.limit(values)
            self.assertTrue(numpy.isnan(found.order))
            self.assertEqual((found.value, found.doubt), (values[-1], abs(values[-1] - values[-2])))
        self.assertIn("does not converge, +1.5 per halving",
                      void_reference.tendency(void_reference.limit([0.0, 1.0, 2.0, 3.5])))

    def test_written_and_read_again(self):
        # All schemes tend to 10 on the wide sample, one of them to 11; the narrow one has twice the value.
        def value(case):
            top = 11.0 if case.scheme == "polypic" else 10.0
            return (top - case.cell / 5e-6) * (2.0 if case.width == void_reference.NARROW else 1.0)

        found = {case: {"A": value(case)} for case in void_reference.cases(void_reference.samples_of())}
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "void_reference.csv"
            with self.assertRaisesRegex(ValueError, "void_reference.csv is missing"):
                void_reference.read(path)
            void_reference.write_rows(path, found, void_reference.samples_of())
            middle, error = void_reference.read(path)["A"]
        # Of the wide sample 9.75; the narrow one adds 0.25, as much as the halving before: nothing shrinks.
        self.assertAlmostEqual(middle, 10.0 + 1.0 / 3.0)
        self.assertAlmostEqual(error, 1.0 + 0.25)

    def test_without_the_narrow_sample(self):
        samples = void_reference.samples_of(narrow=False)
        found = {case: {"A": 10.0 - case.cell / 5e-6} for case in void_reference.cases(samples)}
        self.assertEqual(void_reference.sequence(found, 1500.0, "aflip", "A", samples), [9.0, 9.5, 9.75])
        text = void_reference.markdown(found, samples)
        self.assertIn("| A | aflip | 9 / 9.5 / 9.75 | +0.5 / +0.25 | 1.00 | 10 |", text)
        self.assertNotIn("160 um", text)


class Readers(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.run_of_it = program.Run(
            self.folder, 0, "energy drift 1.0e-14, guards: compression 7, sound speed 0, wall 2; escaped particles 3 "
            "(0.5 kg/m); checksum 0123456789abcdef\nfinished at step 5, time 1 ns, in x\n")

    def snapshot(self, number, **fields):
        with h5py.File(self.folder / f"snapshot_{number:06d}.h5", "w") as file:
            file.attrs["time"] = 1e-9 * number
            for name, values in fields.items():
                file[f"particles/{name}"] = values

    def test_closing_lines(self):
        run = self.run_of_it
        self.assertEqual((run.guards, run.escaped, run.checksum),
                         ({"compression": 7, "sound speed": 0, "wall": 2}, 3, "0123456789abcdef"))
        with self.assertRaisesRegex(program.CaseError, "exit code 3: bad state"):
            _ = program.Run(self.folder, 3, "bad state\n").guards

    def test_drift(self):
        for totals, drift in (("4,5,3.5", 0.25), ("0,0.5,-1", 0.5)):
            rows = "".join(f"\n{total},1,1" for total in totals.split(","))
            (self.folder / "history.csv").write_text("total [J/m],kinetic [J/m],internal [J/m]" + rows + "\n")
            self.assertEqual(program.Run(self.folder, 0, "").drift, drift)

    def test_bad_particles_are_counted(self):
        (self.folder / "scene.toml").write_text("[[material]]\nkinematic_share = 0.0\n")
        good = {"plastic_strain": [0.0, 0.0, 0.1], "temperature": [300.0, 290.0, 400.0]}
        self.snapshot(0, id=[0, 1, 2], plastic_work=[0.0, 0.0, 5.0], **good)
        self.snapshot(1, id=[2, 0, 1], plastic_work=[4.0, 0.0, 1.0], **good)  # the work of id 2 fell
        self.assertEqual(always.bad_particles(self.run_of_it), 1)
        self.snapshot(2, id=[0, 1, 2], plastic_work=[9.0, 9.0, 9.0], plastic_strain=[-1e-9, 0.0, numpy.nan],
                      temperature=[300.0, 1.0, 300.0])
        self.assertEqual(always.bad_particles(self.run_of_it), 4)


class Measures(unittest.TestCase):
    def test_pieces(self):
        self.assertEqual(free.pieces(numpy.array([[0.0, 0.0], [1.0, 0.0], [5.0, 0.0], [5.0, 1.0], [9.0, 9.0]]), 1.5), 3)

    def test_angular_momentum_counts_the_affine_part(self):
        # Two particles on a rigid spin of 3 rad/s: m r^2 w each, and m (2 w) D each.
        state = {"mass": numpy.array([2.0, 2.0]), "position_0": numpy.array([2.0, 0.0]),
                 "position_1": numpy.array([1.0, 1.0]), "velocity_0": numpy.zeros(2),
                 "velocity_1": numpy.array([3.0, -3.0]), "affine_1": numpy.full(2, -3.0),
                 "affine_2": numpy.full(2, 3.0)}
        self.assertAlmostEqual(free.angular_momentum(state, (1.0, 1.0), 0.25), 2 * 2.0 * 3.0 + 2 * 2.0 * 6.0 * 0.25)

    def test_scaled_scene(self):
        scene = {"domain": {"size": [1.0, 2.0], "cell": 0.5}, "sample": {"height": 2.0}, "time": {"end": 8.0},
                 "output": {"beat": 4.0}, "void": [{"center": [0.5, 0.25], "radius": 0.125}]}
        self.assertEqual(bits.scale_settings(scene, 2.0),
                         ["domain.size=[2.0, 4.0]", "domain.cell=1.0", "sample.height=4.0", "time.end=16.0",
                          "output.beat=8.0", "void.0.center=[1.0, 0.5]", "void.0.radius=0.25"])


if __name__ == "__main__":
    unittest.main()
