"""Tables of runs: their expansion, what counts as done, and that nothing runs twice; with a made-up program."""
import csv
import sys
import tempfile
import textwrap
import unittest
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from fake_output import write_output  # noqa: E402
from poreshock_paper import sweep  # noqa: E402

TABLE = """
scene = "scene.toml"
output = "runs"
[set]
"output.snapshot" = 0
[vary]
"loading.velocity" = [900, 1100]
"sample.seed" = [1, 2]
[[option]]
name = "plain"
[[option]]
name = "two grids"
set = { "domain.cell" = 5e-6, "morphology.thresholds" = { from = 310, to = 400, step = 10 } }
"""


class Sweep(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = Path(self.temporary.name)
        (self.folder / "scene.toml").write_text("title = 'x'\n")
        self.write(TABLE)
        self.said = []

    def write(self, text):
        (self.folder / "table.toml").write_text(text)

    def table(self):
        return sweep.expand(self.folder / "table.toml")

    def program(self, ending="finished at step 9, time 1 ns, in x", code=0):
        """A program that notes its call and leaves an output folder. A wrapper starts it in place of MPI."""
        path = self.folder / "program"
        path.write_text(textwrap.dedent(f"""\
            #!/bin/sh
            echo "$@" >> {self.folder}/calls
            while [ $# -gt 0 ]; do [ "$1" = --output ] && out=$2; shift; done
            cp -r {self.folder}/output/. "$out"
            echo "{ending}"
            exit {code}
            """))
        path.chmod(0o755)
        write_output(self.folder / "output")
        return path

    def calls(self):
        path = self.folder / "calls"
        return path.read_text().splitlines() if path.exists() else []

    def run_all(self, cases, program):
        return sweep.run(self.folder / "runs", cases, 1, 2, program, self.said.append)

    def test_every_combination_once(self):
        table = self.table()
        self.assertEqual(len(table.cases), 8)
        self.assertEqual(table.folder, self.folder / "runs")
        self.assertEqual(table.cases[0].name, "velocity_900-seed_1-plain")
        self.assertEqual(table.cases[0].settings, ("output.snapshot=0", "loading.velocity=900", "sample.seed=1"))
        self.assertEqual(table.cases[-1].settings[-2:], ("domain.cell=5e-06", "morphology.thresholds={from=310,to=400,step=10}"))

    def test_output_lies_beside_the_file_by_default(self):
        self.write(TABLE.replace('output = "runs"\n', ""))
        self.assertEqual(self.table().folder, self.folder / "output/table")

    def test_long_titles_make_names_of_their_own(self):
        titles = ["all that was asked for in the third campaign " * 7 + end for end in ("a", "b")]
        self.write(f"scene = 'scene.toml'\noutput = 'runs'\n[vary]\ntitle = {titles!r}\n")
        cases = self.table().cases
        self.assertEqual([len(case.name) for case in cases], [120, 120])
        self.assertEqual(self.run_all(cases, self.program()), [])
        self.assertEqual(len({case.name for case in cases if sweep.is_done(self.folder / "runs", case)}), 2)

    def test_mistakes_are_named(self):
        for text, words in (("[vary]\n'a.b' = [1]", "no scene"), ("scene = 'no.toml'", "there is no file"),
                            ("scene = 'scene.toml'\nvarry = 1", "varry"),
                            ("scene = 'scene.toml'\n[vary]\n'a.b' = 3", "no list for a.b"),
                            ("scene = 'scene.toml'\n[[option]]\n[[option]]", "the same name: scene")):
            self.write(text)
            with self.assertRaisesRegex(ValueError, words):
                self.table()

    def test_what_is_done_is_not_repeated_until_it_changes(self):
        cases, program = self.table().cases[:3], self.program()
        self.assertEqual(self.run_all(cases, program), [])
        self.assertEqual(len(self.calls()), 3)
        self.assertIn("--force", self.calls()[0])
        self.assertEqual(self.run_all(cases, program), [])
        self.assertEqual(len(self.calls()), 3)
        self.assertEqual(self.said[-1], "3 runs, 3 done already")
        (self.folder / "scene.toml").write_text("title = 'y'\n")
        self.run_all(cases[:1], program)
        self.assertEqual(len(self.calls()), 4)

    def test_a_run_that_was_cut_off_goes_on(self):
        case = self.table().cases[0]
        program = self.program("stopped at step 5, time 1 ns, in x")
        self.assertEqual(self.run_all([case], program), [case.name])
        self.assertFalse(sweep.is_done(self.folder / "runs", case))
        (self.folder / "runs" / case.name / "checkpoint_000000005.h5").write_text("")
        self.assertEqual(self.run_all([case], self.program()), [])
        self.assertIn("--restart latest", self.calls()[-1])

    def test_a_failure_is_told_and_does_not_stop_the_others(self):
        cases = self.table().cases[:2]
        self.assertEqual(sorted(self.run_all(cases, self.program("state went bad", 3))), sorted(case.name for case in cases))
        self.assertTrue(any("exit code 3: state went bad" in text for text in self.said))

    def test_another_worker_has_it_in_hand(self):
        case = self.table().cases[0]
        (self.folder / "runs").mkdir()
        with sweep.held(self.folder / "runs", case) as first, sweep.held(self.folder / "runs", case) as second:
            self.assertTrue(first)
            self.assertFalse(second)
            self.run_all([case], self.program())
        self.assertEqual(self.calls(), [])

    def test_one_table_of_all(self):
        cases = self.table().cases
        self.run_all(cases[:2], self.program())
        self.assertEqual(sweep.collect(self.folder / "runs", cases, self.folder / "all.csv"), 2)
        with (self.folder / "all.csv").open() as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["run"] for row in rows], [case.name for case in cases[:2]])
        self.assertEqual([row["loading.velocity"] for row in rows], ["900", "900"])
        self.assertEqual(float(rows[0]["wall_seconds"]), 123.5)
        self.assertLess(float(rows[0]["energy drift [1]"]), 1e-9)
        self.assertGreater(float(rows[0]["end of loading [s]"]), 0.0)

    def test_end_of_loading_at_quantiles(self):
        """The areas stay as they are; the values tell the hottest record."""
        levels = numpy.array([[300.0, 310.0], [330.0, 350.0], [320.0, 365.0], [numpy.nan, numpy.nan]])
        areas = numpy.tile([0.75, 0.25], (4, 1))
        self.assertEqual(sweep.end_of_loading(numpy.arange(4.0), numpy.array([0.25, 0.75]), areas, levels), 2)


if __name__ == "__main__":
    unittest.main()
