"""Speed of the whole step on the scenes of input/bench: rates, phases, memory and instructions."""
import csv
import os
import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

from poreshock_cases.program import ROOT, CaseError, Run

QUIET = ("output.snapshot=1.0", "morphology.every=0.0", "profile.every=0.0")
# The function of each phase whose instructions are counted with all that it calls.
PHASES = {"sort": "sort_particles", "particles to grid": "particles_to_grid", "average": "sum_pressure|sum_dilatation",
          "grid to particles": "grid_to_particles", "stress": "update_stress", "filter": "filter_velocity",
          "contact": "collide"}
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
    Scheme("cubic APIC", ("transfer.averaging=0.0", "viscosity.quadratic=2.25")),
    Scheme("cubic FLIP", ("transfer.velocity='flip'", "transfer.averaging=0.0", "viscosity.quadratic=2.25")),
    Scheme("cubic FLIP, averaged", ("transfer.velocity='flip'",)),
    Scheme("cubic FMPM(3)", ("transfer.velocity='fmpm'", "transfer.order=3", "transfer.averaging=0.0",
                             "viscosity.quadratic=2.25")),
    Scheme("quadratic APIC", ("transfer.shape='quadratic'", "transfer.averaging=0.0", "viscosity.quadratic=2.25")),
    Scheme("quadratic APIC, averaged", ("transfer.shape='quadratic'",)),
)


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
    instructions: float | None  # per particle-step, of the time loop on one rank
    phase_instructions: dict  # likewise, of the phases that were counted

    def row(self):
        return {"scene": self.scene, "scheme": self.scheme, "ranks": self.ranks, "particles": round(self.particles),
                "rate [1e6/s/core]": f"{self.rate:.2f}", "memory [bytes/particle]": round(self.memory),
                "instructions [1/particle-step]": "" if self.instructions is None else round(self.instructions),
                **{f"{name} [ns]": f"{value:.2f}" for name, value in self.phases.items()},
                **{f"{name} [instructions]": f"{value:.1f}" for name, value in self.phase_instructions.items()}}


def callgrind(lab, folder, bench, settings, checkpoint, end):
    """Instructions of the time loop from a checkpoint to `end`: of all, of each phase; and the particle-steps."""
    counts = folder / "callgrind.out"
    command = [ROOT / "tools/mpirun", "-n", 1, "valgrind", "--tool=callgrind", f"--callgrind-out-file={counts}",
               "--toggle-collect=void poreshock::advance<*", lab.program, "run", ROOT / "input" / bench.scene,
               "--output", folder / "counted", "--force", "--quiet", "--restart", checkpoint]
    for setting in (*settings, f"time.end={end!r}", "checkpoint.every_time=0.0"):
        command += ["--set", setting]
    done = subprocess.run([str(part) for part in command], text=True, capture_output=True, check=False,
                          env=os.environ | {"GLIBC_TUNABLES": PLAIN_CLEARING})
    found = re.search(r"Collected : (\d+)", done.stderr)
    if done.returncode != 0 or found is None:
        raise CaseError(f"{folder}: callgrind ended with {done.returncode}: {done.stderr.strip()}")
    lines = subprocess.run(["callgrind_annotate", "--inclusive=yes", "--threshold=100", counts], text=True,
                           capture_output=True, check=True).stdout.splitlines()
    phases = {}
    for name, functions in PHASES.items():
        own = re.compile(rf"^ *([\d,]+) .*:void poreshock::({functions})<[23]>\(")
        phases[name] = sum(int(m[1].replace(",", "")) for m in map(own.match, lines) if m)
    return int(found[1]), phases, Run(folder / "counted", 0, "").timings["particle_steps"]


def count_instructions(lab, folder, bench, settings, checkpoint):
    """Instructions per particle-step, of all and of each phase, from two lengths of a run."""
    ends = [bench.start + share * (bench.end - bench.start) for share in (0.01, 0.03)]
    (few, few_phases, few_steps), (many, many_phases, many_steps) = (
        callgrind(lab, folder, bench, settings, checkpoint, end) for end in ends)
    steps = many_steps - few_steps
    return (many - few) / steps, {name: (many_phases[name] - few_phases[name]) / steps for name in PHASES}


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
    count, phase_counts = None, {}
    if instructions:
        count, phase_counts = count_instructions(lab, first.folder.parent, bench, settings, checkpoints[-1])
    steps = best["particle_steps"] / best["ranks"]
    phases = {phase["name"]: 1e9 * phase["avg"] / steps for phase in best["phases"]
              if phase["avg"] > 0.01 * best["wall_seconds"]}
    return Timing(scene, scheme.name, best["ranks"], best["particle_steps"] / best["steps"],
                  1e-6 * best["rate_per_core"], best["bytes_per_particle_at_once"], phases, count, phase_counts)


def markdown(timings):
    """Table of rates, and of the phases above 1 %: ns per particle-step and core, and instructions where counted."""
    names = sorted({name for t in timings for name in t.phases},
                   key=lambda name: -max(t.phases.get(name, 0.0) for t in timings))
    lines = ["| scene | scheme | ranks | particles | million particle-steps/s/core | bytes per particle "
             "| instructions | " + " | ".join(names) + " |", "|---" * (7 + len(names)) + "|"]
    for t in timings:
        cells = []
        for name in names:
            cell = f"{t.phases[name]:.1f}" if name in t.phases else ""
            if cell and t.phase_instructions.get(name):
                cell += f" ({t.phase_instructions[name]:.0f})"
            cells.append(cell)
        count = "" if t.instructions is None else f"{t.instructions:.0f}"
        lines.append(f"| {t.scene} | {t.scheme} | {t.ranks} | {t.particles:.0f} | {t.rate:.2f} | {t.memory:.0f} "
                     f"| {count} | " + " | ".join(cells) + " |")
    return "\n".join([*lines, "", "Phases in ns per particle-step and core, in brackets instructions per particle-step.", ""])


def write_csv(timings, path):
    rows = [t.row() for t in timings]
    names = list(dict.fromkeys(name for row in rows for name in row))
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, names, restval="")
        writer.writeheader()
        writer.writerows(rows)
