"""A run from start to end: what it writes, and that the number of ranks cannot be seen in it."""
import json
import math
import xml.etree.ElementTree as xml

import h5py
import numpy

from program import POROUS, ProgramTest, closing_lines, datasets, history, particles, same_bits

RANKS = (1, 2, 3)
SNAPSHOTS = ("snapshot_000000.h5", "snapshot_000004.h5", "snapshot_000008.h5")


class FinishedRun(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write("porous.toml", POROUS)
        cls.results = {n: cls.run_scene("porous.toml", f"on{n}", ranks=n) for n in RANKS}
        cls.steps = int(history(cls.folder / "on1/history.csv")["step"][-1])

    def test_folder_holds_what_the_scene_asks_for(self):
        newest = [25 * (self.steps // 25 - k) for k in (2, 1, 0)]
        expected = sorted(["scene.toml", "history.csv", "snapshots.xdmf", "maps.xdmf", "morphology.h5", "profiles.h5",
                           "timings.json",
                           *SNAPSHOTS, *(f"checkpoint_{step:09d}.h5" for step in newest)])
        for n in RANKS:
            self.assertEqual(sorted(p.name for p in (self.folder / f"on{n}").iterdir()), expected)

    def test_closing_lines_are_the_same_on_any_number_of_ranks(self):
        lines = closing_lines(self.results[1])
        self.assertEqual(lines[1:], ("finished", f"step {self.steps}, time 20 ns"))
        self.assertNotIn("checksum 0000000000000000", lines[0])
        for n in RANKS[1:]:
            self.assertEqual(closing_lines(self.results[n]), lines)

    def test_quiet_prints_the_closing_lines_only(self):
        for n in RANKS:
            text = self.results[n].output
            self.assertTrue(text.startswith("energy drift "), text)
            self.assertEqual(text.count("\n"), 2 + text.count("\nheat: ") + text.count("\nwarning: numerical dissipation "), text)

    def test_totals_are_constant(self):
        rows = history(self.folder / "on1/history.csv")
        numpy.testing.assert_array_equal(rows["time"], 2.5e-9 * numpy.arange(9))
        self.assertLess(numpy.ptp(rows["total"]), 1e-10 * rows["total"][0])
        self.assertEqual(set(rows["particles"]), {rows["particles"][0]})
        # Energy has changed hands, so that the constant total says something.
        self.assertGreater(rows["internal"][-1], 0.1 * rows["total"][0])
        self.assertGreater(rows["plastic_work"][-1], 0.0)

    def test_energies_of_the_snapshots_are_those_of_the_history(self):
        rows = history(self.folder / "on1/history.csv")
        for name in SNAPSHOTS:
            with h5py.File(self.folder / "on1" / name) as file:
                row = int(numpy.flatnonzero(rows["time"] == file.attrs["time"])[0])
                mass = file["particles/mass"][...]
                sums = [math.fsum(mass * file[f"particles/{kind}_energy"][...])
                        for kind in ("kinetic", "internal")]
            total = rows["kinetic"][row] + rows["internal"][row]
            self.assertLess(abs(sum(sums) - total), 1e-12 * total, name)
            self.assertLess(abs(sums[0] - rows["kinetic"][row]), 1e-12 * total, name)

    def test_profiles_are_the_averages_of_the_snapshots(self):
        profile = datasets(self.folder / "on1/profiles.h5")
        numpy.testing.assert_array_equal(profile["row/time"], [0.0, 10e-9, 20e-9])
        numpy.testing.assert_array_equal(profile["row/record"], [0, 4, 8])
        numpy.testing.assert_allclose(profile["row/height"], 1e-5 * (numpy.arange(48) + 0.5), rtol=1e-14)
        edge, spacing = 1e-5, 5e-6
        bottom = edge * numpy.arange(48)
        bottom[0] = -1.0  # what a particle has below the wall counts in the lowest row
        for index, name in enumerate(SNAPSHOTS):
            with h5py.File(self.folder / "on1" / name) as file:
                at = {field: item[...] for field, item in file["particles"].items()}
            volume, y = at["mass"] / at["density"], at["position"][:, 1]
            length = numpy.minimum(edge, volume / spacing)
            low = numpy.maximum(bottom[:, None], (y - 0.5 * length)[None])
            high = numpy.minimum(edge * numpy.arange(1, 49)[:, None], (y + 0.5 * length)[None])
            share = numpy.maximum(high - low, 0.0) / length
            with numpy.errstate(invalid="ignore"):
                expected = {"solid_fraction": share @ volume / (0.2e-3 * edge),
                            "density": share @ at["mass"] / (share @ volume),
                            "stress": share @ (-volume * at["stress"][:, 1]) / (share @ volume),
                            "temperature": share @ (at["mass"] * at["temperature"]) / (share @ at["mass"]),
                            "pressure": share @ (volume * at["pressure"]) / (share @ volume),
                            "velocity_y": share @ (at["mass"] * at["velocity"][:, 1]) / (share @ at["mass"])}
            for field, values in expected.items():
                if field != "solid_fraction":
                    values[expected["solid_fraction"] < 1e-4] = numpy.nan
                scale = numpy.nanmax(abs(values))
                numpy.testing.assert_allclose(profile[f"row/{field}"][index], values, rtol=0,
                                              atol=1e-12 * scale, err_msg=f"{field} of {name}")

    def test_snapshots_are_the_same_on_any_number_of_ranks(self):
        for name in SNAPSHOTS:
            one = particles(self.folder / "on1" / name)
            self.assertEqual(len(set(one["id"])), len(one["id"]))
            self.assertEqual(len(one), 14)
            for n in RANKS[1:]:
                other = particles(self.folder / f"on{n}" / name)
                self.assertEqual(list(one), list(other))
                for field, values in one.items():
                    self.assertTrue(same_bits(values, other[field]), f"{field} of {name} on {n} ranks")

    def test_history_and_morphology_are_the_same_on_any_number_of_ranks(self):
        for n in RANKS[1:]:
            self.assert_same_datasets("on1/morphology.h5", f"on{n}/morphology.h5")
            self.assert_same_datasets("on1/profiles.h5", f"on{n}/profiles.h5")
            self.assertEqual((self.folder / "on1/history.csv").read_bytes(),
                             (self.folder / f"on{n}/history.csv").read_bytes())

    def test_morphology_has_a_row_for_every_record(self):
        curves = datasets(self.folder / "on1/morphology.h5")
        numpy.testing.assert_array_equal(curves["temperature/time"], 5e-9 * numpy.arange(5))
        numpy.testing.assert_array_equal(curves["temperature/record"], 2 * numpy.arange(5))
        numpy.testing.assert_array_equal(curves["pressure/threshold"], [1e9, 5e9])
        self.assertEqual(curves["temperature/F"].shape, (5, 60))
        self.assertEqual(curves["temperature/F"].dtype, numpy.int64)
        # The sample is cold at the start, and a hotter region lies within a cooler one.
        self.assertEqual(curves["temperature/F"][0].sum(), 0)
        self.assertGreater(curves["temperature/F"][-1, 0], 20)
        self.assertTrue((numpy.diff(curves["temperature/F"], axis=1) <= 0).all())
        for field in ("temperature", "pressure"):
            parts = {name: curves[f"{field}/{name}"] for name in ("F", "E", "V", "chi")}
            pixels = curves[f"{field}/pixels"][:, None]
            numpy.testing.assert_array_equal((parts["V"] - parts["E"] + parts["F"]) / pixels, parts["chi"])

    def test_every_file_says_what_it_is(self):
        with h5py.File(self.folder / "on2/snapshot_000004.h5") as file:
            self.assertEqual(file.attrs["time"], 10e-9)
            for name in ("step", "version", "revision", "scene"):
                self.assertIn(name, file.attrs)
            self.assertEqual(file.attrs["scene"], (self.folder / "on2/scene.toml").read_text())
            units = {name: item.attrs["unit"] for name, item in file["particles"].items()}
        self.assertEqual({name: units[name] for name in ("mass", "stress", "temperature", "id")},
                         {"mass": "kg/m", "stress": "Pa", "temperature": "K", "id": "1"})

    def test_paraview_finds_every_dataset(self):
        root = xml.parse(self.folder / "on2/snapshots.xdmf").getroot()
        grids = root.findall("./Domain/Grid/Grid")
        self.assertEqual([float(grid.find("Time").get("Value")) for grid in grids], [0.0, 10e-9, 20e-9])
        for grid in grids:
            items = list(grid.iter("DataItem"))
            self.assertEqual(len(items), 15)
            for item in items:
                name, path = item.text.split(":")
                with h5py.File(self.folder / "on2" / name) as file:
                    self.assertEqual(" ".join(str(n) for n in file[path].shape), item.get("Dimensions"))

    def test_maps_are_those_that_were_measured(self):
        shots = [datasets(self.folder / f"on{n}/snapshot_000004.h5") for n in RANKS]
        for field in ("temperature", "pressure"):
            for other in shots[1:]:
                self.assertTrue(same_bits(shots[0][f"map/{field}"], other[f"map/{field}"]), field)
        record = list(datasets(self.folder / "on1/morphology.h5")["temperature/record"]).index(4)
        measured = datasets(self.folder / "on1/morphology.h5")
        hot = shots[0]["map/temperature"]
        for k, threshold in enumerate(measured["temperature/threshold"]):
            self.assertEqual(int((hot >= threshold).sum()), measured["temperature/F"][record, k])
        self.assertEqual(int(numpy.isfinite(hot).sum()), measured["temperature/pixels"][record])
        grid = xml.parse(self.folder / "on1/maps.xdmf").getroot().findall("./Domain/Grid/Grid")[1]
        self.assertEqual(grid.find("Topology").get("Dimensions"), f"2 {hot.shape[0] + 1} {hot.shape[1] + 1}")
        self.assertEqual([item.text for item in grid.find("Geometry")], ["-5e-06 0 0", "1e-05 1e-05 1e-05"])
        self.assertEqual([item.text for item in grid.findall("Attribute/DataItem")],
                         ["snapshot_000004.h5:/map/pressure", "snapshot_000004.h5:/map/temperature"])

    def test_timings_count_the_steps(self):
        for n in RANKS:
            timings = json.loads((self.folder / f"on{n}/timings.json").read_text())
            rows = history(self.folder / f"on{n}/history.csv")
            self.assertEqual((timings["ranks"], timings["steps"]), (n, self.steps))
            self.assertEqual(timings["particle_steps"], self.steps * int(rows["particles"][0]))
            calls = {phase["name"]: phase["calls"] for phase in timings["phases"]}
            self.assertEqual(calls["sort"], self.steps)
            self.assertGreaterEqual(calls["stress"], self.steps)  # chunks of rows
            self.assertEqual((calls["snapshot"], calls["history"], calls["morphology"]), (3, 9, 5))
            self.assertEqual(calls["profile"], 3)

    def test_resolved_scene_gives_the_same_run(self):
        result = self.run_scene("on1/scene.toml", "again")
        self.assertEqual(closing_lines(result), closing_lines(self.results[1]))
        self.assertEqual((self.folder / "again/scene.toml").read_text(),
                         (self.folder / "on1/scene.toml").read_text())


class ProgressRows(ProgramTest):
    def test_a_run_that_is_not_quiet_prints_its_phases(self):
        self.write("porous.toml", POROUS)
        result = self.succeed("run", "porous.toml", "--output", "loud", "--set", "time.max_steps=3", "--verbose")
        self.assertRegex(result.output, r"^    step   time ns     dt ns    kinetic   internal     drift")
        self.assertRegex(result.output, r"\nstress +\d+\.\d{3} +\d+\.\d{3} +\d+\.\d{3} +\d+\.\d%\n")
        self.assertRegex(result.output, r"\n3 steps in \S+ s on 1 ranks: \S+ million particle-steps")


class OtherScheme(ProgramTest):
    """FLIP with quadratic splines and the paper's thermodynamics, with a moving frame of reference."""

    def test_energies_and_bits(self):
        self.write("porous.toml", POROUS)
        changes = ["transfer.shape='quadratic'", "transfer.velocity='flip'",
                   "thermal='paper'", "time.end=5e-9", "loading.frame=[0.0, 300.0]"]
        arguments = [word for change in changes for word in ("--set", change)]
        lines = {closing_lines(self.run_scene("porous.toml", f"on{n}", *arguments, ranks=n)) for n in (1, 2)}
        self.assertEqual(len(lines), 1)
        rows = history(self.folder / "on2/history.csv")
        self.assertLess(numpy.ptp(rows["total"]), 1e-10 * rows["total"][0])
        last = particles(self.folder / "on2/snapshot_000002.h5")
        total = math.fsum(last["mass"] * last["kinetic_energy"]) + math.fsum(last["mass"] * last["internal_energy"])
        expected = rows["kinetic"][-1] + rows["internal"][-1]
        self.assertLess(abs(total - expected), 1e-12 * expected)
