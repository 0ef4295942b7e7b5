"""Speed of the whole step on the scenes of input/bench: rates, phases, memory, and what limits them."""
import csv
import json
import os
import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

from poreshock_cases.program import ROOT, CaseError, Run

QUIET = ("output.snapshot=1.0", "morphology.every=0.0", "profile.every=0.0")
# The function of each phase whose instructions are counted with all that it calls.
PHASES = {"sort": "sort_particles", "particles to grid": "particles_to_grid",
          "grid to particles": "grid_to_particles", "stress": "update_stress", "contact": "collide"}
# A core's share of the last cache, as valgrind wants it: bytes, ways, bytes of a line.
CACHE = "2097152,16,64"
# Above it glibc clears memory by one instruction per byte as valgrind counts them.
PLAIN_CLEARING = "glibc.cpu.x86_rep_stosb_threshold=1000000000"


@dataclass(frozen=True)
class Scheme:
    """A name and the settings that make it."""
    name: str
    settings: tuple[str, ...]


@dataclass(frozen=True)
class Bench:
    """A scene and the part of its run that is timed, s."""
    scene: str
    start: float
    end: float


POROUS = Bench("bench/porous.toml", 300e-9, 500e-9)
WIDE = Bench("paper/fig1_coarse.toml", 300e-9, 500e-9)
OTHERS = (Bench("bench/grains.toml", 50e-9, 80e-9), Bench("bench/porous_3d.toml", 60e-9, 80e-9))

SCHEMES = (
    Scheme("default", ()),
    Scheme("cubic AFLIP", ("transfer.velocity='aflip'",)),
    Scheme("cubic PolyPIC", ("transfer.velocity='polypic'",)),
    Scheme("cubic APIC", ("transfer.velocity='apic'",)),
    Scheme("cubic FLIP", ("transfer.velocity='flip'",)),
    Scheme("quadratic AFLIP", ("transfer.shape='quadratic'",)),
    Scheme("quadratic APIC", ("transfer.shape='quadratic'", "transfer.velocity='apic'")),
)


@dataclass(frozen=True)
class Machine:
    """What one core can do at most, and particle-steps per second of one square by the program and done plainly."""
    instructions: float  # per second
    bytes: float  # per second, from and to memory
    program_rate: float
    plain_rate: float


@dataclass(frozen=True)
class Count:
    """What valgrind counts, per particle-step."""
    instructions: float = 0.0
    bytes: float = 0.0  # that a cache of CACHE does not hold

    def least_time(self, machine):
        """Nanoseconds below which no program with these counts can come."""
        return 1e9 * max(self.instructions / machine.instructions, self.bytes / machine.bytes)

    def __sub__(self, other):
        return Count(self.instructions - other.instructions, self.bytes - other.bytes)

    def __truediv__(self, steps):
        return Count(self.instructions / steps, self.bytes / steps)


@dataclass(frozen=True)
class Timing:
    """What one scheme took on one scene."""
    scene: str
    scheme: str
    ranks: int
    particles: float
    rate: float  # million particle-steps per second and core
    memory: float  # bytes per particle, all in, at one time
    phases: dict  # ns per particle-step and core
    counts: dict  # of the time loop on one rank, "" whole and by phase; empty where nothing was counted

    def row(self):
        return {"scene": self.scene, "scheme": self.scheme, "ranks": self.ranks, "particles": round(self.particles),
                "rate [1e6/s/core]": f"{self.rate:.2f}", "memory [bytes/particle]": round(self.memory),
                **{f"{name} [ns]": f"{value:.2f}" for name, value in self.phases.items()},
                **{f"{name or 'all'} [instructions/particle-step]": f"{count.instructions:.1f}"
                   for name, count in self.counts.items()},
                **{f"{name or 'all'} [bytes/particle-step]": f"{count.bytes:.1f}"
                   for name, count in self.counts.items()}}


def measure_machine(program):
    """Runs the benchmarks of the core and of the plain step that stand beside the program."""
    folder = program.parent / "tests/benchmark"
    found = {}
    for name, pattern in (("benchmark_core", "."), ("benchmark_solver", "^(plain_step/aflip|program_step/scheme:0)$")):
        if not (folder / name).exists():
            raise CaseError(f"{folder / name} is missing: tools/build release -- slow_tests makes it")
        done = subprocess.run([folder / name, f"--benchmark_filter={pattern}", "--benchmark_format=json"], text=True,
                              capture_output=True, check=False)
        if done.returncode != 0:
            raise CaseError(f"{name} ended with {done.returncode}: {done.stderr.strip()}")
        found |= {result["name"]: result for result in json.loads(done.stdout)["benchmarks"]}
    return Machine(found["instructions"]["instructions/s"], found["triad"]["bytes/s"],
                   1e6 * found["program_step/scheme:0"]["Mparticle/s"], 1e6 * found["plain_step/aflip"]["Mparticle/s"])


def read_counts(lines):
    """Counts of the whole and of each phase from what callgrind_annotate prints of Ir, DLmr and DLmw."""
    number = r" *([\d,]+|\.) *(?:\([ \d.]+%\))?"
    line_bytes = 64
    counts = {}

    def count(match):
        instructions, reads, writes = (0 if text == "." else int(text.replace(",", "")) for text in match.groups()[:3])
        return Count(instructions, line_bytes * (reads + writes))

    for name, functions in (("", None), *PHASES.items()):
        tail = " +PROGRAM TOTALS" if functions is None else rf" .*:void poreshock::({functions})<[23]>\("
        found = [count(m) for m in map(re.compile(f"^{number * 3}{tail}").match, lines) if m]
        counts[name] = Count(sum(c.instructions for c in found), sum(c.bytes for c in found))
    return counts


def callgrind(lab, folder, bench, settings, checkpoint, end):
    """Counts of the time loop from a checkpoint to `end`, and its particle-steps."""
    file = folder / "callgrind.out"
    command = [ROOT / "tools/mpirun", "-n", 1, "valgrind", "--tool=callgrind", "--cache-sim=yes", f"--LL={CACHE}",
               f"--callgrind-out-file={file}", "--toggle-collect=void poreshock::advance<*", lab.program, "run",
               ROOT / "input" / bench.scene, "--output", folder / "counted", "--force", "--quiet",
               "--restart", checkpoint]
    for setting in (*settings, f"time.end={end!r}", "checkpoint.every_time=0.0"):
        command += ["--set", setting]
    file.unlink(missing_ok=True)
    done = subprocess.run([str(part) for part in command], text=True, capture_output=True, check=False,
                          env=os.environ | {"GLIBC_TUNABLES": PLAIN_CLEARING})
    if done.returncode != 0 or not file.exists():
        raise CaseError(f"{folder}: callgrind ended with {done.returncode}: {done.stderr.strip()}")
    lines = subprocess.run(["callgrind_annotate", "--inclusive=yes", "--threshold=100", "--show=Ir,DLmr,DLmw", file],
                           text=True, capture_output=True, check=True).stdout.splitlines()
    counts = read_counts(lines)
    if not counts[""].instructions:
        raise CaseError(f"{file}: nothing of the time loop was counted")
    return counts, Run(folder / "counted", 0, "").timings["particle_steps"]


def count_work(lab, folder, bench, settings, checkpoint):
    """Counts per particle-step, of all and of each phase, from two lengths of a run."""
    ends = [bench.start + share * (bench.end - bench.start) for share in (0.01, 0.03)]
    (few, few_steps), (many, many_steps) = (callgrind(lab, folder, bench, settings, checkpoint, end) for end in ends)
    return {name: (many[name] - few[name]) / (many_steps - few_steps) for name in many}


def timing(lab, scheme, bench, sleep=False, instructions=False):
    """Runs to the start, then times from its checkpoint to the end; the best of three."""
    scene = Path(bench.scene).stem
    name = f"{scene}_{scheme.name}".replace(" ", "_").replace(",", "").replace("(", "").replace(")", "")
    settings = (*scheme.settings, *QUIET, f"time.sleep={'true' if sleep else 'false'}")
    first = lab.run(f"{name}_start", bench.scene, *settings, f"time.end={bench.start!r}",
                    f"checkpoint.every_time={bench.start!r}")
    checkpoints = sorted(first.folder.glob("checkpoint_*.h5"))
    if not checkpoints:
        raise CaseError(f"{first.folder}: no checkpoint at {bench.start} s")
    runs = [lab.run(f"{name}_{k}", bench.scene, *settings, f"time.end={bench.end!r}", "checkpoint.every_time=0.0",
                    restart=checkpoints[-1]) for k in range(3)]
    best = max((run.timings for run in runs), key=lambda t: t["rate_per_core"])
    counts = count_work(lab, first.folder.parent, bench, settings, checkpoints[-1]) if instructions else {}
    steps = best["particle_steps"] / best["ranks"]
    phases = {phase["name"]: 1e9 * phase["avg"] / steps for phase in best["phases"]
              if phase["avg"] > 0.01 * best["wall_seconds"]}
    return Timing(scene, scheme.name, best["ranks"], best["particle_steps"] / best["steps"],
                  1e-6 * best["rate_per_core"], best["bytes_per_particle_at_once"], phases, counts)


def markdown(timings, machine=None):
    """Table of rates, and of the phases above 1 %: ns per particle-step and core; where the machine was measured and
    the phase counted, also instructions, and the share of its least time."""
    names = sorted({name for t in timings for name in t.phases},
                   key=lambda name: -max(t.phases.get(name, 0.0) for t in timings))
    lines = ["| scene | scheme | ranks | particles | million particle-steps/s/core | bytes per particle | "
             "instructions | " + " | ".join(names) + " |", "|---" * (7 + len(names)) + "|"]
    for t in timings:
        cells = []
        for name in names:
            cell = f"{t.phases[name]:.1f}" if name in t.phases else ""
            count = t.counts.get(name, Count())
            if cell and machine and count.instructions:
                cell += f" ({count.instructions:.0f}; {100.0 * count.least_time(machine) / t.phases[name]:.0f} %)"
            cells.append(cell)
        whole = f"{t.counts[''].instructions:.0f}" if t.counts else ""
        lines.append(f"| {t.scene} | {t.scheme} | {t.ranks} | {t.particles:.0f} | {t.rate:.2f} | {t.memory:.0f} "
                     f"| {whole} | " + " | ".join(cells) + " |")
    lines += ["", "Phases in ns per particle-step and core."]
    if machine:
        ratio = machine.program_rate / machine.plain_rate
        lines += ["In brackets instructions per particle-step, and the share of the phase's time that they, or the",
                  "bytes that a cache of 2 MB does not hold, would take at the most this core can do:",
                  f"{1e-9 * machine.instructions:.1f} simple instructions, {1e-9 * machine.bytes:.1f} bytes per ns.",
                  "",
                  f"A square of 48 400 particles: {1e-6 * machine.program_rate:.2f} million particle-steps/s, the same",
                  f"step done plainly {1e-6 * machine.plain_rate:.2f}: {ratio:.1f} times."]
    return "\n".join([*lines, ""])


def write_csv(timings, path):
    rows = [t.row() for t in timings]
    names = list(dict.fromkeys(name for row in rows for name in row))
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, names, restval="")
        writer.writeheader()
        writer.writerows(rows)
