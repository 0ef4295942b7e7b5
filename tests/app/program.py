"""The built program, small scenes for it, and readers of what it writes."""
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy

ROOT = Path(__file__).resolve().parents[2]
MPIRUN = ROOT / "tools/mpirun"
PROGRAM = Path(os.environ.get("PORESHOCK", ROOT / "build/release/poreshock"))
# When a rank has failed, mpirun waits a second or two before it ends the others; here all have printed.
# Factor on time limits, for builds that are slow.
PATIENCE = float(os.environ.get("PORESHOCK_PATIENCE", "1"))
ENVIRONMENT = os.environ | {"OMPI_MCA_odls_base_sigkill_timeout": "0"}

ALUMINIUM = """
[[material]]
name = "aluminium"
density = 2700
young = 69e9
poisson = 0.33
yield = 120e6
hardening = 384e6
c0 = 5350
lambda = 1.34
gamma = 2.0
cv = 880
"""

# A block of 20 x 40 cells with voids of 5 cells hits a wall; a hundred steps, four checkpoints.
POROUS = """
title = "porous block"
[domain]
size = [0.2e-3, 0.48e-3]
cell = 10e-6
periodic = true
[boundary]
low = "wall"
high = "free"
[sample]
kind = "random_voids"
height = 0.4e-3
porosity = 0.15
void_radius = 25e-6
ligament = 10e-6
keep_out = 10e-6
[loading]
velocity = 1500
[time]
cfl = 0.35
end = 20e-9
[output]
beat = 2.5e-9
snapshot = 10e-9
[morphology]
every = 5e-9
fields = ["temperature", "pressure"]
thresholds = { temperature = { from = 310, to = 900, step = 10 }, pressure = [1e9, 5e9] }
[checkpoint]
every_steps = 25
keep = 3
""" + ALUMINIUM

# A disc flies at a block at rest: the step is limited by the disc, which is on the highest rank.
DISC = """
[domain]
size = [0.1e-3, 0.5e-3]
cell = 10e-6
periodic = true
[boundary]
low = "wall"
high = "free"
[[body]]
shape = "box"
low = [0, 0]
high = [0.1e-3, 0.25e-3]
[[body]]
shape = "disc"
center = [0.05e-3, 0.32e-3]
radius = 0.045e-3
velocity = [0, -1500]
[time]
cfl = 0.35
end = 100e-9
max_steps = 45
[checkpoint]
every_steps = 35
""" + ALUMINIUM

# A block of 10 x 10 x 20 cells with three balls cut out.
BALLS = """
[domain]
size = [0.1e-3, 0.1e-3, 0.24e-3]
cell = 10e-6
periodic = true
[boundary]
low = "wall"
high = "free"
[sample]
kind = "solid"
height = 0.2e-3
[[void]]
shape = "ball"
center = [30e-6, 40e-6, 40e-6]
radius = 22e-6
[[void]]
shape = "ball"
center = [70e-6, 60e-6, 90e-6]
radius = 25e-6
[[void]]
shape = "ball"
center = [75e-6, 25e-6, 150e-6]
radius = 20e-6
[loading]
velocity = 1500
[transfer]
shape = "cubic"
[time]
cfl = 0.35
end = 10e-9
[output]
beat = 2.5e-9
[morphology]
every = 5e-9
length = "isoline"
fields = ["temperature"]
thresholds = { from = 305, to = 605, step = 50 }
[checkpoint]
every_steps = 20
""" + ALUMINIUM


class Result:
    """How one call of the program ended."""

    def __init__(self, code, output, errors):
        self.code, self.output, self.errors = code, output, errors

    def __str__(self):
        return f"exit code {self.code}\n{self.output}\n{self.errors}"


class ProgramTest(unittest.TestCase):
    """Tests with a folder of their own; relative paths are paths in it."""

    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory(prefix="poreshock_test_")
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)

    @classmethod
    def write(cls, name, text):
        (cls.folder / name).write_text(text)
        return name

    @classmethod
    def command(cls, *arguments, ranks=1):
        return [str(part) for part in (MPIRUN, "-n", ranks, PROGRAM, *arguments)]

    @classmethod
    def call(cls, *arguments, ranks=1):
        done = subprocess.run(cls.command(*arguments, ranks=ranks), cwd=cls.folder, text=True,
                              env=ENVIRONMENT, capture_output=True, check=False, timeout=300 * PATIENCE)
        return Result(done.returncode, done.stdout, done.stderr)

    @classmethod
    def succeed(cls, *arguments, ranks=1):
        result = cls.call(*arguments, ranks=ranks)
        if result.code != 0:
            raise AssertionError(str(result))
        return result

    @classmethod
    def run_scene(cls, scene, output, *arguments, ranks=1):
        return cls.succeed("run", scene, "--quiet", "--output", output, *arguments, ranks=ranks)

    def message(self, code, *arguments, ranks=1):
        """What the program says when it refuses: once, whatever the number of ranks."""
        result = self.call(*arguments, ranks=ranks)
        self.assertEqual(result.code, code, str(result))
        self.assertEqual(len(re.findall("^poreshock: ", result.errors, re.M)), 1, str(result))
        text = re.split("^poreshock: ", result.errors, flags=re.M)[1].split("\n-----", maxsplit=1)[0]
        message, page = re.fullmatch(r"(.*)\nexplained in (\S+\.md)[^\n]*", text.strip(), re.S).groups()
        self.assertTrue((ROOT / page).is_file(), page)
        return message

    def refuse(self, message, *arguments, ranks=1):
        self.assertEqual(self.message(2, *arguments, ranks=ranks), message)

    def contents(self, name):
        """Every file below a folder with its bytes."""
        return {str(path.relative_to(self.folder)): path.read_bytes()
                for path in sorted((self.folder / name).rglob("*")) if path.is_file()}

    def assert_same_datasets(self, one, other):
        """Two HDF5 files hold the same datasets, bit for bit."""
        a, b = datasets(self.folder / one), datasets(self.folder / other)
        self.assertEqual(list(a), list(b))
        self.assertGreater(len(a), 0)
        for path, values in a.items():
            self.assertTrue(same_bits(values, b[path]), f"{path} of {one} and {other}")


def closing_lines(result):
    """Counters and checksum, and how far the run went: what must not depend on ranks or restarts."""
    match = re.search(r"^energy drift \S+, (guards: .*, negative heat 0; escaped particles \d+ \([^)]*\); "
                      r"checksum [0-9a-f]{16}\n(?:heat: .*\n(?:warning: numerical dissipation .*\n)?)?)"
                      r"(finished|stopped) at (step \d+, time \S+ ns), in \S+\n\Z", result.output, re.M)
    if match is None:
        raise AssertionError(str(result))
    return match.groups()


def datasets(path):
    """All datasets of a file by path."""
    found = {}
    with h5py.File(path) as file:
        file.visititems(lambda name, item: found.update({name: item[...]})
                        if isinstance(item, h5py.Dataset) else None)
    return found


def particles(path):
    """Particle datasets of a snapshot in the order of their ids."""
    with h5py.File(path) as file:
        order = numpy.argsort(file["particles/id"][...])
        return {name: item[...][order] for name, item in file["particles"].items()}


def same_bits(a, b):
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()


def history(path):
    """Columns of a history.csv by name without unit."""
    lines = path.read_text().splitlines()
    rows = numpy.array([[float(cell) for cell in line.split(",")] for line in lines[1:]])
    return {name.split(" ")[0]: rows[:, i] for i, name in enumerate(lines[0].split(","))}


def flip_byte(path, offset):
    with open(path, "r+b") as file:
        file.seek(offset)
        byte = file.read(1)[0]
        file.seek(offset)
        file.write(bytes([byte ^ 0x10]))
