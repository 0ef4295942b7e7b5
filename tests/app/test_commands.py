"""The commands that run nothing: check, sample, info, and the options that print and end."""
import json
import math
import re
import shutil
import subprocess

import numpy

from program import ALUMINIUM, BALLS, POROUS, PROGRAM, ROOT, ProgramTest, datasets, flip_byte, particles


class Commands(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write("porous.toml", POROUS)
        cls.write("balls.toml", BALLS)
        cls.run_scene("porous.toml", "run", "--set", "time.max_steps=25", ranks=2)

    def test_version(self):
        self.assertRegex(self.succeed("--version").output,
                         r"^poreshock \d+\.\d+\.\d+ \(\S+\)\ncompiler   \S+ \d\S+, \w+\nflags      -\S.* -ffp-contract=off .*\n"
                         r"libraries  .*MPI.*, PETSc \d\S+ with \d\d-bit indices, HDF5 \d\S+, METIS \d\S+, Eigen \d\S+, "
                         r"toml\+\+ \d\S+, CLI11 \d\S+, libpng \d\S+, libtiff \d\S+\n$")

    def test_a_full_disk_at_standard_output_is_a_failure(self):
        """Of every command, without mpirun, which takes all that is printed."""
        self.write("a.npy", "")
        numpy.save(self.folder / "a.npy", numpy.arange(12.0).reshape(3, 4))
        shutil.copytree(self.folder / "run", self.folder / "twin")
        for command in (["--version"], ["--help"], ["run", "--help"], ["materials"], ["materials", "copper"], ["keys"],
                        ["check", "porous.toml"], ["sample", "porous.toml", "--output", "full-sample"],
                        ["info", "run/history.csv"], ["analyze", "a.npy", "--thresholds", "5"], ["compare", "run", "twin"],
                        ["run", "porous.toml", "--output", "full", "--set", "time.max_steps=2"]):
            with open("/dev/full", "w", encoding="ascii") as full:
                done = subprocess.run([PROGRAM, *command], cwd=self.folder, text=True, stdout=full, stderr=subprocess.PIPE,
                                      check=False)
            self.assertEqual(done.returncode, 4, f"{command}: {done.stderr}")
            self.assertIn("poreshock: cannot write all of the result to standard output: make room", done.stderr)
        self.assertTrue((self.folder / "full/timings.json").exists())

    def test_materials(self):
        names = self.succeed("materials").output.split("\n")
        self.assertEqual([name for name in names if name and name[0] != " "][:8],
                         ["paper_aluminium", "aluminium_6061_t6", "copper", "tungsten", "magnesium_az31b", "steel_304",
                          "pmma", "hmx"])
        text = self.succeed("materials", "copper").output
        scene = POROUS.replace(ALUMINIUM, "\n" + text.split("\n\n# with strength")[0])
        self.write("copper.toml", scene + "\n")
        self.write("by_name.toml", POROUS.replace(ALUMINIUM, '\n[[material]]\nname = "copper"\n'))
        self.assertEqual(self.succeed("check", "copper.toml").output, self.succeed("check", "by_name.toml").output)
        self.refuse('found the material "coper", allowed paper_aluminium, aluminium_6061_t6, copper, tungsten, magnesium_az31b, '
                    'steel_304, pmma, hmx',
                    "materials", "coper")

    def test_progress_rows_go_to_a_terminal_or_are_asked_for(self):
        head = r"step +time ns +dt ns +kinetic +internal +drift"
        short = ("run", "porous.toml", "--set", "time.end=7.5e-9", "--force", "--output", "rows")
        self.assertNotRegex(self.succeed(*short).output, head)
        text = self.succeed(*short, "--verbose").output
        self.assertRegex(text, head)
        rows = re.findall(r"^ +\d+ +\d+\.\d{3} .*$", text, re.M)
        self.assertGreaterEqual(len(rows), 2)
        self.assertLessEqual(max(len(row) for row in rows), 100)
        self.assertEqual(self.call(*short, "--verbose", "--quiet").code, 2)

    def test_help_names_every_command(self):
        text = self.succeed("--help", ranks=2).output
        for word in ("run", "check", "sample", "info", "materials", "keys"):
            self.assertRegex(text, rf"\n  {word} +\S")
        for option in ("--output", "--restart", "--wall-time", "--force", "--quiet", "--verbose", "--set"):
            self.assertIn(option, self.succeed("run", "--help").output)

    def test_check_prints_the_scene_and_what_follows_and_writes_nothing(self):
        before = self.contents(".")
        text = self.succeed("check", "porous.toml", ranks=2).output
        self.assertEqual(self.contents("."), before)
        resolved = (self.folder / "run/scene.toml").read_text()
        self.assertTrue(text.startswith(resolved.replace("max_steps = 25 ", "max_steps = 0  ")), text)
        count = len(particles(self.folder / "run/snapshot_000000.h5")["id"])
        self.assertIn(f"\nparticles               {count}\n", text)
        self.assertRegex(text, r"\nvoids                   6, void fraction 0\.150000 \(asked 0\.15\d*\), "
                               r"least gap \S+ m\n")
        self.assertIn("\ncells per void diameter 5.0\n", text)
        self.assertRegex(text, r"\nwarning: A void is only 5\S* cells across; below 16 its collapse is not resolved\.")
        # Sound is 1.2 times as fast as at rest, the viscosity acts, and voids make 1.6 times as many steps.
        shear = 69e9 / (2.0 * 1.33)
        sound = 1.2 * math.sqrt(5350.0**2 + 4.0 / 3.0 * shear / 2700.0)
        wave = 1500.0 + 1.0 * sound + math.hypot(1.0 * sound, sound)
        step = 0.35 * 10e-6 / (1.6 * wave)
        self.assertIn(f"\ntypical time step       {step:.3g} s, about {8 * math.ceil(2.5e-9 / step)} steps\n", text)
        self.assertRegex(text, r"\nmemory                  \d+ MB for particles \(\d+ bytes each\), \d+ MB for nodes\n")
        self.assertRegex(text, r"\ndisk                    \d+ MB for 3 snapshots, \d+ MB a checkpoint\n")
        self.assertRegex(text, r"\ntime to go              about \d+ s on 2 ranks at 8\.0 million particle-steps")

    def test_the_first_scene_warns_of_nothing(self):
        text = self.succeed("check", ROOT / "input/porous_aluminium.toml").output
        self.assertIn("\ncells per void diameter 20.0\n", text)
        self.assertNotIn("warning", text)

    def warning(self, *changes):
        """The warnings of check but the two that this small scene always has."""
        options = [word for change in changes for word in ("--set", change)]
        text = self.succeed("check", "porous.toml", *options).output
        # The long runs of these tests are not meant as such.
        found = re.findall(r"^warning: ((?!Sound crosses).*)$", text, re.M)
        self.assertRegex(found[0], r"^A void is only 5\S* cells across; .* Set domain\.cell to 3\.125e-06 m or less\.$")
        self.assertRegex(found[1], r"^The thinnest solid between two voids .* Set sample\.ligament to 3\.5e-05 m or more, "
                                   r"or domain\.cell to \S+ m or less\.$")
        return found[2:]

    def test_check_warns_of_what_costs_too_much_and_names_the_keys(self):
        self.assertEqual(self.warning(), [])
        self.assertRegex(*self.warning("time.end=0.1", "output.snapshot=0"), r"^The run takes about 3\.\d+ days on 1 ranks\. Start it on more, end "
                         r"it earlier with time\.end, or set domain\.cell to 1\.5\d+e-05 m for one day\.$")
        # A thousand million snapshots of half a megabyte.
        self.assertRegex(self.warning("time.end=1e-3", "output.beat=1e-12", "output.snapshot=1e-12")[1],
                         r"^The files of the run need about \S+ GB, 1e\+09 snapshots of \S+ GB among them; this disk has \S+ GB "
                         r"left\. Raise output\.snapshot, name fewer output\.fields, set output\.precision = \"single\", or "
                         r"lower checkpoint\.keep\.$")
        self.assertRegex(self.message(2, "check", "porous.toml", "--set", "domain.cell=2e-8", "--set",
                                      "sample.particles_per_cell=8"),
                         r"The run needs about \S+ GB of memory, here are \S+ GB\. Set domain\.cell to \S+ m or more, lower "
                         r"sample\.particles_per_cell, or start on more machines\.")

    def test_check_counts_the_steps_that_the_beat_asks_for(self):
        def told(*changes):
            options = [word for change in changes for word in ("--set", change)]
            text = self.succeed("check", "porous.toml", "--set", "output.snapshot=0", "--set", "morphology.every=0", *options).output
            steps = int(re.search(r"\ntypical time step       \S+ s, about (\d+) steps\n", text)[1])
            return steps, re.findall(r"^warning: (output\.beat .*)$", text, re.M)

        self.assertEqual(told("output.beat=1e-12")[0], 20000)
        self.assertEqual(told("output.beat=1e-15")[0], 20000000)
        self.assertEqual(told("output.beat=1e-12", "time.max_steps=7")[0], 7)
        self.assertRegex(*told("output.beat=5e-11")[1],
                         r"^output\.beat = 5e-11 s sets the time step, which else were about (1\.\d+e-10) s: steps land on its "
                         r"multiples, and 400 of them reach time\.end instead of \d+\. Set output\.beat to 1\.\d+e-09 s or more; ")
        self.assertEqual(told("output.beat=20e-9")[1], [])

    def test_check_warns_of_hats(self):
        text = ("\nwarning: With transfer.shape = \"linear\" runs stop where voids collapse: hats let forces jump where particles "
                "cross cells. Set transfer.shape to \"gimp\" or \"cubic\".\n")
        for shape in ("linear", "gimp", "quadratic", "cubic"):
            output = self.succeed("check", "porous.toml", "--set", f"transfer.shape='{shape}'").output
            self.assertEqual(output.count(text), int(shape == "linear"), output)

    def test_check_warns_of_conduction(self):
        conductivity = "material.0.conductivity=237"
        # 2.8 um until 20 ns, in voids of 50 um.
        self.assertEqual(self.warning(conductivity), [])
        self.assertRegex(*self.warning(conductivity, "conduction.on=true"),
                         r"^Heat gets 2\.82e-06 m far in aluminium until the end, 0\.282 cells; below 2 its conduction is not "
                         r"resolved\. Set domain\.cell to 1\.41e-06 m or less, or conduction\.on = false\.$")
        self.assertRegex(*self.warning(conductivity, "time.end=400e-9"),
                         r"^Heat gets 1\.26e-05 m far in aluminium until the end, 0\.253 void diameters, and does not flow: .* Set conduction\.on = "
                         r"true, or material\.conductivity = 0 where it shall not\.$")
        self.assertRegex(*self.warning("material.0.conductivity=1e6", "conduction.on=true"),
                         r"^Heat conduction makes the time step \S+ times smaller than the motion does\. Set domain\.cell to "
                         r"\S+ m, where the two are equal, or conduction\.on = false\.$")

    def test_what_can_hardly_be_meant_is_told_by_check_and_by_run(self):
        """Once, by check with its numbers, by a run before it starts, not again when it goes on; it hinders neither."""
        body = '[[body]]\nshape = "box"\nlow = [0, {}]\nhigh = [0.1e-3, {}]\n'
        self.write("odd.toml", POROUS.replace('low = "wall"', 'low = "free"').replace("every_steps = 25", "every_steps = 2")
                   .replace("from = 310", "from = 300") + body.format("0.41e-3", "0.45e-3") + "velocity = [0, 1.5]\n" +
                   body.format("2e-3", "3e-3"))
        told = [r"body\.0\.velocity = 1\.5 m/s is only \S+ of the sound speed and \S+ cells until time\.end; all numbers are SI\. If it "
                r"is in km/s, write 1500 \(m/s\)\.",
                r"1 of 61 morphology\.thresholds of temperature is not above T0 = 300 K of aluminium: all of it counts as hot there "
                r"from the start\. Begin above it\.",
                r"body\.1 lies outside of the domain \(0 to 0\.0002 m along x, 0 to 0\.00048 m along y\) and counts for nothing\. .*",
                r"the sample and body\.0 have different velocities, but are one grain, number 0: .*",
                r"\d+ particles \(\S+ %\) leave the domain within the first 20 steps, through the open side boundary\.low\. .*",
                r"Nothing is hit until time\.end = 2e-08 s: no wall, symmetry plane or body lies in the way of what moves\. .*"]
        found = re.findall(r"^warning: (.*)$", self.succeed("check", "odd.toml", ranks=2).output, re.M)
        ran = self.succeed("run", "odd.toml", "--quiet", "--output", "odd", "--set", "time.max_steps=4", ranks=2)
        for warnings in (found, re.findall(r"^warning: (.*)$", ran.errors, re.M)):
            for pattern in told:
                self.assertEqual(sum(re.fullmatch(pattern, text) is not None for text in warnings), 1, f"{pattern} in {warnings}")
        self.assertEqual(len(re.findall("^warning: ", ran.errors, re.M)), len(told))
        again = self.succeed("run", "odd.toml", "--quiet", "--output", "odd", "--restart", "latest", "--set", "time.max_steps=6")
        self.assertNotIn("warning: ", again.errors)
        sample = self.succeed("sample", "odd.toml", "--output", "odd-sample").output
        self.assertEqual(len(re.findall(r"^warning: body\.1 lies outside", sample, re.M)), 1)

    def test_check_takes_overrides(self):
        text = self.succeed("check", "balls.toml", "--set", "time.end=4e-9", "--set", "title='three balls'").output
        self.assertIn('title = "three balls"', text)
        self.assertRegex(text, r"\nend = 4e-0?9 ")

    def test_sample_is_the_first_snapshot_of_a_run(self):
        result = self.succeed("sample", "porous.toml", "--output", "sample", ranks=3)
        self.assertTrue(result.output.endswith("sample in               sample/snapshot_000000.h5\n"), str(result))
        self.assertEqual(sorted(self.contents("sample")), ["sample/snapshot_000000.h5", "sample/snapshots.xdmf"])
        sample = particles(self.folder / "sample/snapshot_000000.h5")
        first = particles(self.folder / "run/snapshot_000000.h5")
        self.assertIn(f"\nparticles               {len(sample['id'])}\n", result.output)
        for name, values in first.items():
            numpy.testing.assert_array_equal(sample[name], values, err_msg=name)

    def test_sample_does_not_replace_a_folder(self):
        before = self.contents("run")
        self.assertIn("output folder run: exists already;", self.message(2, "sample", "porous.toml", "--output", "run"))
        self.assertEqual(self.contents("run"), before)

    def info(self, name):
        return self.succeed("info", name).output

    def test_info_on_a_snapshot(self):
        text = self.info("run/snapshot_000000.h5")
        count = len(particles(self.folder / "run/snapshot_000000.h5")["id"])
        self.assertTrue(text.startswith("run/snapshot_000000.h5: snapshot of poreshock\ncontent   intact\n"
                                        "time      0 s\nstep      0\nrecord    0\n"), text)
        self.assertRegex(text, rf"\n  /particles/stress +float64  {count} x 4  Pa\n")

    def test_info_on_a_checkpoint(self):
        text = self.info("run/checkpoint_000000025.h5")
        self.assertTrue(text.startswith("run/checkpoint_000000025.h5: checkpoint of poreshock\n"
                                        "content   intact\n"), text)
        self.assertIn("\nstep      25\n", text)
        self.assertIn("\ndimension 2\n", text)

    def test_info_on_morphology(self):
        text = self.info("run/morphology.h5")
        rows = len(datasets(self.folder / "run/morphology.h5")["temperature/time"])
        self.assertTrue(text.startswith("run/morphology.h5: morphology of poreshock\ncontent   intact\n"), text)
        self.assertRegex(text, rf"\n  /temperature/F +int64  {rows} x 60\n")
        self.assertRegex(text, r"\n  /pressure/threshold +float64  2  Pa\n")

    def test_timings_hold_the_warnings_of_check(self):
        warnings = re.findall(r"^warning: (.*)$", self.succeed("check", "porous.toml").output, re.M)
        self.assertGreater(len(warnings), 1)
        self.assertEqual(json.loads((self.folder / "run/timings.json").read_text())["warnings"], warnings)

    def test_info_on_text_files(self):
        text = self.info("run/history.csv")
        rows = (self.folder / "run/history.csv").read_text().count("\n") - 1
        self.assertTrue(text.startswith("run/history.csv: history of a 2-D run of poreshock\n"
                                        f"rows      {rows}\n"), text)
        self.assertIn("\nstep      25 (last row)\n", text)
        self.assertEqual(self.info("run/snapshots.xdmf"),
                         "run/snapshots.xdmf: time series of 2 snapshots, for ParaView\n")
        self.assertTrue(self.info("run/timings.json").startswith("run/timings.json: timings of a run of poreshock\n{"))

    def test_info_says_what_is_damaged(self):
        (self.folder / "copy.h5").write_bytes((self.folder / "run/snapshot_000000.h5").read_bytes())
        flip_byte(self.folder / "copy.h5", 60000)
        self.assertIn("\ncontent   copy.h5: damaged: its content does not match the hash in its header\n",
                      self.info("copy.h5"))

    def test_info_refuses_what_is_not_ours(self):
        self.write("notes.txt", "nothing of poreshock\n")
        self.refuse("notes.txt: not a file of poreshock; known are *.h5, history.csv, probe_*.csv, timings.json, "
                    "snapshots.xdmf, maps.xdmf and *.toml", "info", "notes.txt", ranks=2)
        self.refuse("none.h5: not found", "info", "none.h5")
        self.write("fake.h5", "nothing of HDF5\n")
        self.refuse("fake.h5: not an HDF5 file, or its beginning is damaged", "info", "fake.h5")
