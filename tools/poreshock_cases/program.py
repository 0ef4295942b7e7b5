"""Runs of the program and readers of what they write."""
import json
import os
import re
import subprocess
import tomllib
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import h5py
import numpy

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ.get("PORESHOCK", ROOT / "build/release/poreshock"))
CLOSING = re.compile(r"^energy drift \S+, guards: (.*); escaped particles (\d+) .*; checksum ([0-9a-f]{16})$", re.M)


class CaseError(Exception):
    """A run that did not end as the case needs it."""


@dataclass(frozen=True)
class Run:
    """One finished run."""
    folder: Path
    code: int
    output: str

    @cached_property
    def closing(self):
        found = CLOSING.search(self.output)
        if found is None:
            raise CaseError(f"{self.folder}: the run ended with exit code {self.code}: {self.output.strip()}")
        return found.groups()

    @property
    def guards(self):
        """Counters by name, particle-steps."""
        return {name: int(count) for name, count in
                (part.rsplit(" ", 1) for part in self.closing[0].split(", "))}

    @property
    def escaped(self):
        return int(self.closing[1])

    @property
    def checksum(self):
        return self.closing[2]

    @cached_property
    def scene(self):
        return tomllib.loads((self.folder / "scene.toml").read_text())

    @cached_property
    def timings(self):
        return json.loads((self.folder / "timings.json").read_text())

    @cached_property
    def history(self):
        """Columns of history.csv by name without unit."""
        lines = (self.folder / "history.csv").read_text().splitlines()
        rows = numpy.array([[float(cell) for cell in line.split(",")] for line in lines[1:]])
        return {name.split(" ")[0]: rows[:, i] for i, name in enumerate(lines[0].split(","))}

    @property
    def snapshots(self):
        return sorted(self.folder.glob("snapshot_*.h5"))

    def particles(self, which=-1):
        """Fields of a snapshot, by default the last, in the order of the ids; `time` is its time."""
        return particles(self.snapshots[which])

    @property
    def drift(self):
        """Largest change of the total energy over its start, or over the largest kinetic and
        internal energy where the start has none; J/m or J where there is none at all."""
        total = self.history["total"]
        scale = abs(total[0]) or numpy.max(self.history["kinetic"] + self.history["internal"])
        return float(numpy.max(abs(total - total[0]))) / (scale or 1.0)


def particles(path):
    """Fields of one snapshot or checkpoint in the order of the ids; `time` is its time."""
    with h5py.File(path) as file:
        order = numpy.argsort(file["particles/id"][...])
        found = {name: item[...][order] for name, item in file["particles"].items()}
        found["time"] = float(numpy.ravel(file.attrs["time"])[0])
    return found


@dataclass
class Lab:
    """Where the runs of one case go and how they are started."""
    folder: Path
    ranks: int = 1
    program: Path = PROGRAM
    runs: list = field(default_factory=list)

    def run(self, name, scene, *settings, ranks=None, restart=None, may_fail=False):
        """Runs `scene` of input/ with KEY=VALUE settings; exit code 3 is an answer with may_fail."""
        folder = self.folder / name
        folder.parent.mkdir(parents=True, exist_ok=True)
        command = [ROOT / "tools/mpirun", "-n", ranks or self.ranks, self.program, "run",
                   ROOT / "input" / scene, "--output", folder, "--force", "--quiet"]
        if restart:
            command += ["--restart", restart]
        for setting in settings:
            command += ["--set", setting]
        # Ranks that share a core wait for each other politely.
        done = subprocess.run([str(part) for part in command], text=True, capture_output=True, check=False,
                              env=os.environ | {"OMPI_MCA_mpi_yield_when_idle": "1"})
        run = Run(folder, done.returncode, done.stdout + done.stderr)
        if done.returncode != 0 and not (may_fail and done.returncode == 3):
            raise CaseError(f"{folder}: exit code {run.code}: {run.output.strip()}")
        if done.returncode == 0:
            self.runs.append(run)
        return run
