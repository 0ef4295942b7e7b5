"""The recipes of src/README.md are true: one of each is added to a copy of the sources, which is built and run.

NAME.diff adds one; all together they make the program that the tests run. It stays in the build folder, so that a
second call compiles only what has changed.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
import unittest
from pathlib import Path

import h5py
import numpy

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "app"))
from program import ALUMINIUM, ROOT  # noqa: E402

EXTENDED = Path(os.environ.get("PORESHOCK_EXTENDED", ROOT / "build/extended"))
SOURCES = ("CMakeLists.txt", "include", "src", "tests", "tools")
RECIPES = {"shape_function": "A shape function", "transfer": "A transfer", "boundary": "A boundary",
           "state_variable": "A state variable", "strength_law": "A strength law"}

# A block of 10 x 20 cells that hits the low side and slides along it.
SCENE = """
[domain]
size = [0.1e-3, 0.3e-3]
cell = 10e-6
periodic = true
[boundary]
low = "symmetry"
[[body]]
shape = "box"
low = [0, 0]
high = [0.1e-3, 0.2e-3]
velocity = [200, -500]
[time]
end = 1e-6
max_steps = 60
""" + ALUMINIUM
FLIP = ("transfer.velocity=flip", "viscosity.limited=false")


def run(*command, **how):
    done = subprocess.run([str(part) for part in command], text=True, capture_output=True, check=False, **how)
    if done.returncode != 0:
        raise AssertionError(f"{command}: exit {done.returncode}\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}")
    return done.stdout


def touched(name):
    """Paths of the files that a diff changes or adds."""
    return re.findall(r"^\+\+\+ (\S+)$", (HERE / f"{name}.diff").read_text(), re.M)


def copy_with_all(target):
    """The sources with every diff in `target`; files that stay as they are keep their time."""
    with tempfile.TemporaryDirectory() as name:
        fresh = Path(name)
        for entry in SOURCES:
            copy = shutil.copytree if (ROOT / entry).is_dir() else shutil.copy
            copy(ROOT / entry, fresh / entry)
        for recipe in RECIPES:
            run("git", "apply", "-p0", "-C1", HERE / f"{recipe}.diff", cwd=fresh)
        kept = {path.relative_to(fresh) for path in fresh.rglob("*") if path.is_file()}
        for path in kept:
            old, new = target / path, (fresh / path).read_bytes()
            if not old.is_file() or old.read_bytes() != new:
                old.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(fresh / path, old)
        for path in [path for path in target.rglob("*") if path.is_file()]:
            if path.relative_to(target) not in kept:
                path.unlink()


class Recipes(unittest.TestCase):
    def test_the_page_names_the_files_and_their_number(self):
        page = (ROOT / "src/README.md").read_text()
        for name, title in RECIPES.items():
            recipe, = re.findall(rf"^- \*{title}\*(.*?)(?=^- |^\S|\Z)", page, re.M | re.S)
            number, = re.findall(r"\((\d) files", recipe)
            files = touched(name)
            self.assertEqual(len(files), int(number), name)
            named = re.findall(r"`([\w/.]+)`", recipe)
            for file in files:
                self.assertTrue(any(file == place or Path(file).parent.as_posix() == place for place in named),
                                f"{title} touches {file}, which the page does not name")


class Extended(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        sources, build = EXTENDED / "sources", EXTENDED / "build"
        copy_with_all(sources)
        options = ["-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_CXX_FLAGS_DEBUG=-O0"]
        if shutil.which("ccache"):
            options += ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache", "-DCMAKE_CXX_FLAGS=-fpch-preprocess"]
        if shutil.which("ninja"):
            options += ["-G", "Ninja"]
        run("cmake", "-S", sources, "-B", build, *options)
        run("cmake", "--build", build, "-j2", "--target", "poreshock", "test_shape")
        cls.build = build

    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="poreshock_extend_")
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        (self.folder / "scene.toml").write_text(SCENE)

    def simulate(self, output, *overrides, restart=()):
        """Runs the scene; returns the columns of the last snapshot. No energy is lost."""
        overrides = [word for one in overrides for word in ("--set", one)]
        run(self.build / "poreshock", "run", "scene.toml", "--output", output, "--quiet", *overrides, *restart,
            cwd=self.folder)
        rows = [line for line in (self.folder / output / "history.csv").read_text().splitlines() if not line.startswith("#")]
        total = [column.split(" ")[0].strip('"') for column in rows[0].split(",")].index("total")
        first, last = float(rows[1].split(",")[total]), float(rows[-1].split(",")[total])
        self.assertLess(abs(last / first - 1.0), 1e-12)
        with h5py.File(sorted((self.folder / output).glob("snapshot_*.h5"))[-1]) as file:
            order = numpy.argsort(file["particles/id"][:])
            return {name: column[:][order] for name, column in file["particles"].items()}

    def test_shape_function(self):
        run(self.build / "tests/transfer/test_shape")
        found, same = (self.simulate(shape, f"transfer.shape={shape}", *FLIP) for shape in ("smooth_hat", "gimp"))
        # Two particles per cell and direction reach as far as the smooth hat averages.
        for name in same:
            numpy.testing.assert_array_equal(found[name], same[name], name)

    def test_transfer(self):
        found = self.simulate("blend", "transfer.velocity=blend", "viscosity.limited=false")
        damping = tomllib.loads((self.folder / "blend/scene.toml").read_text())["transfer"]["damping"]
        self.assertEqual(damping, 0.3)
        # What it is for the particles: FLIP with this damping and its step.
        same = self.simulate("flip", *FLIP, f"transfer.damping={damping}", "time.cfl=0.5")
        for name in same:
            numpy.testing.assert_array_equal(found[name], same[name], name)

    def test_boundary(self):
        slides, sticks = self.simulate("symmetry"), self.simulate("glued", "boundary.low=glued")
        for found, low, high in ((slides, 199.0, 201.0), (sticks, -100.0, 100.0)):
            lowest = found["position"][:, 1] < 20e-6
            self.assertGreater(found["velocity"][lowest, 0].mean(), low)
            self.assertLess(found["velocity"][lowest, 0].mean(), high)

    def test_state_variable(self):
        found = self.simulate("whole", "checkpoint.every_steps=30")
        self.assertTrue((found["peak_pressure"] >= found["pressure"]).all())
        self.assertTrue((found["peak_pressure"] > found["pressure"]).any())
        first = sorted((self.folder / "whole").glob("checkpoint_*.h5"))[0]
        again = self.simulate("again", restart=("--restart", first))
        numpy.testing.assert_array_equal(found["peak_pressure"], again["peak_pressure"])

    def test_strength_law(self):
        voce = {"yield": 120e6, "hardening": 2e9, "saturation": 100e6}
        keys = ", ".join(f"{key}={value:g}" for key, value in voce.items())
        (self.folder / "scene.toml").write_text(
            SCENE.replace("yield = 120e6\nhardening = 384e6\n", f'strength = "voce"\nvoce = {{ {keys} }}\n'))
        found = self.simulate("voce")
        rise = voce["saturation"] * -numpy.expm1(-voce["hardening"] / voce["saturation"] * found["plastic_strain"])
        self.assertGreater(rise.max(), 10e6)
        numpy.testing.assert_allclose(found["hardened"], rise, rtol=1e-9, atol=1.0)


if __name__ == "__main__":
    sys.exit(unittest.main())
