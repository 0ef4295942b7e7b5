"""Exit 2: what is wrong with a scene or a command line, said completely and before anything is made."""
from program import BALLS, POROUS, ProgramTest


class RefusedScenes(ProgramTest):
    def refuse_text(self, message, text, *arguments, ranks=1):
        """The scene is refused with this message, and no output folder is made."""
        self.write("scene.toml", text)
        self.refuse(message, "run", "scene.toml", "--output", "out", *arguments, ranks=ranks)
        self.assertFalse((self.folder / "out").exists())

    def place(self, text, part):
        """line:column of the start of `part`."""
        before = text[:text.index(part)]
        return f"scene.toml:{before.count(chr(10)) + 1}:{len(before) - before.rfind(chr(10))}"

    def test_unknown_key(self):
        text = POROUS.replace("porosity =", "porosty =")
        message = self.message_of(text)
        self.assertIn(f"{self.place(text, 'porosty')}: sample.porosty: unknown key, allowed kind, material, ", message)
        self.assertIn('did you mean "porosity"?', message)

    def message_of(self, text, *arguments):
        self.write("scene.toml", text)
        message = self.message(2, "run", "scene.toml", "--output", "out", *arguments)
        self.assertFalse((self.folder / "out").exists())
        return message

    def test_wrong_type(self):
        text = POROUS.replace("velocity = 1500", 'velocity = "fast"')
        self.refuse_text(f"{self.place(text, chr(34) + 'fast')}: loading.velocity: found \"fast\", "
                         "allowed a number >= 0 (m/s)", text, ranks=2)

    def test_out_of_range(self):
        text = POROUS.replace("poisson = 0.33", "poisson = 0.5")
        self.refuse_text(f"{self.place(text, '0.5' + chr(10))}: material.0.poisson: found 0.5, "
                         "allowed a number >= 0 and < 0.5", text)

    def test_override_out_of_range(self):
        self.refuse_text("--set time.cfl=1.6: time.cfl: found 1.6, allowed a number > 0 and <= 1.5", POROUS,
                         "--set", "time.cfl=1.6")

    def test_several_problems_make_one_report_in_the_order_of_the_file(self):
        text = (POROUS.replace("cell = 10e-6", "cell = -1").replace("low = \"wall\"", "low = \"wal\"")
                .replace("seed", "sed").replace("end = 20e-9", "end = true").replace("c0 = 5350\n", ""))
        message = self.message_of(text).split("\n")
        self.assertEqual([line.split(" ")[1] for line in message],
                         ["domain.cell:", "boundary.low.kind:", "time.end:", "material.0.c0:"])
        self.assertTrue(message[0].startswith(self.place(text, "-1\n")), message[0])
        self.assertTrue(message[1].endswith('did you mean "wall"?'), message[1])
        self.assertEqual(message[2], f"{self.place(text, 'true' + chr(10) + '[output]')}: time.end: found true, "
                                     "allowed a number > 0 (s)")
        self.assertTrue(message[3].endswith("missing, give a number > 0 (m/s)"), message[3])

    def test_broken_toml(self):
        message = self.message_of(POROUS.replace("cell = 10e-6", "cell = "))
        self.assertRegex(message, r"^scene\.toml:5:\d+: ")

    def test_scene_that_cannot_be_read(self):
        advice = "give the path of a scene file such as input/porous_aluminium.toml"
        self.refuse(f"none.toml: cannot be read (No such file or directory), {advice}", "run", "none.toml", ranks=3)
        (self.folder / "folder.toml").mkdir()
        self.refuse(f"folder.toml: cannot be read (it is a folder), {advice}", "check", "folder.toml")

    def test_porosity_that_cannot_be_packed(self):
        text = POROUS.replace("porosity = 0.15", "porosity = 0.6")
        for command in ("run", "check", "sample"):
            self.write("scene.toml", text)
            output = [] if command == "check" else ["--output", "out"]
            message = self.message(2, command, "scene.toml", *output, ranks=2)
            self.assertTrue(message.startswith("sample.porosity = 0.6 cannot be packed: 24 voids of radius "), message)
            self.assertIn("Lower sample.porosity, sample.ligament or sample.keep_out,", message)
            self.assertFalse((self.folder / "out").exists())

    def test_scene_without_particles(self):
        text = POROUS + '[[void]]\nshape = "box"\nlow = [0, 0]\nhigh = [1, 1]\n'
        self.assertTrue(self.message_of(text).startswith("The scene makes no particle at all:"))

    def test_grid_that_petsc_cannot_count(self):
        """A rank counts its nodes in 32 bits; said before the sample is made."""
        self.refuse_text("the grid has 9600020400009 nodes, allowed are 2147483647, which a rank can count in 32 bits: use "
                         "larger cells", POROUS, "--set",
                         "domain.size=[20, 48]", "--set", "sample.height=48", ranks=2)

    def test_too_many_ranks(self):
        low = POROUS.replace("0.48e-3", "0.09e-3").replace("0.4e-3", "0.09e-3").replace("0.15", "0.1")
        self.refuse_text("the domain has 12 rows of nodes along the shock axis, 4 ranks need at least 15: use fewer "
                         "ranks or smaller cells", low, ranks=4)
        self.write("balls.toml", BALLS.replace("0.24e-3", "0.1e-3").replace("0.2e-3", "0.1e-3"))
        message = self.message(2, "check", "balls.toml", ranks=4)
        self.assertRegex(message, r"^the domain has \d+ rows of nodes along the shock axis, 4 ranks need at least \d+: ")


class RefusedCommandLines(ProgramTest):
    def refuse_line(self, message, *arguments, ranks=2):
        result = self.call(*arguments, ranks=ranks)
        self.assertEqual(result.code, 2, str(result))
        self.assertEqual((result.output + result.errors).count(message), 1, str(result))
        self.assertEqual(self.contents("."), {})

    def test_no_command(self):
        self.refuse_line("A subcommand is required\nRun with --help for more information.")

    def test_unknown_command(self):
        self.refuse_line('poreshock: unknown command "walk", allowed run, check, sample, analyze, compare, info, '
                         'materials, keys; see --help\n', "walk",
                         "scene.toml")

    def test_missing_scene(self):
        self.refuse_line("scene is required\nRun with --help for more information.", "run")

    def test_unknown_option(self):
        self.refuse_line("--fast", "run", "scene.toml", "--fast")

    def test_option_without_value(self):
        self.refuse_line("--output: 1 required", "run", "scene.toml", "--output")

    def test_empty_value(self):
        """As from a variable of a script that is not set."""
        told = "found an empty text; give a value, or leave the option out"
        for option in ("--restart", "--output", "--wall-time", "--set"):
            self.refuse_line(f"{option}: {told}", "run", "scene.toml", option, "")
        self.refuse_line(f"--output: {told}", "sample", "scene.toml", "--output", "")
        self.refuse_line(f"--hot-spots: {told}", "analyze", "a.npy", "--hot-spots", "")
        self.refuse_line(f"--output: {told}", "compare", "a", "b", "--output", "")
        self.refuse_line(f"scene: {told}", "check", "")

    def test_negative_wall_time(self):
        self.refuse_line("poreshock: --wall-time: found -5.000000, allowed a number >= 0 (s), 0 = no limit\n", "run",
                         "scene.toml", "--wall-time", "-5")
