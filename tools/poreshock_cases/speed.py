"""Speed of the whole step: rates, phases and memory of schemes on one scene while the shock is on its way."""
import csv
from dataclasses import dataclass

from poreshock_cases.program import CaseError

START, END = 300e-9, 500e-9  # s, the part of the run that is timed
QUIET = ("output.snapshot=1.0", "morphology.every=0.0", "profile.every=0.0")


@dataclass(frozen=True)
class Scheme:
    """A name and the settings that make it."""
    name: str
    settings: tuple[str, ...]


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
    """What one scheme took between START and END."""
    scheme: str
    ranks: int
    particles: float
    rate: float  # million particle-steps per second and core
    phases: dict  # ns per particle-step and core

    def row(self):
        return {"scheme": self.scheme, "ranks": self.ranks, "particles": round(self.particles),
                "rate [1e6/s/core]": f"{self.rate:.2f}",
                **{f"{name} [ns]": f"{value:.2f}" for name, value in self.phases.items()}}


def timing(lab, scheme, scene, extra, sleep):
    """Runs to START, then times from its checkpoint to END; the best of three."""
    name = scheme.name.replace(" ", "_").replace(",", "").replace("(", "").replace(")", "")
    settings = (*scheme.settings, *extra, *QUIET, f"time.sleep={'true' if sleep else 'false'}")
    first = lab.run(f"{name}_start", scene, *settings, f"time.end={START!r}", f"checkpoint.every_time={START!r}")
    checkpoints = sorted(first.folder.glob("checkpoint_*.h5"))
    if not checkpoints:
        raise CaseError(f"{first.folder}: no checkpoint at {START} s")
    runs = [lab.run(f"{name}_{k}", scene, *settings, f"time.end={END!r}", "checkpoint.every_time=0.0",
                    restart=checkpoints[-1]) for k in range(3)]
    best = max((run.timings for run in runs), key=lambda t: t["rate_per_core"])
    steps = best["particle_steps"] / best["ranks"]
    phases = {phase["name"]: 1e9 * phase["avg"] / steps for phase in best["phases"]
              if phase["avg"] > 0.01 * best["wall_seconds"]}
    return Timing(scheme.name, best["ranks"], best["particle_steps"] / best["steps"],
                  1e-6 * best["rate_per_core"], phases)


def markdown(timings):
    """Table of rates, and of the phases above 1 % in ns per particle-step and core."""
    names = sorted({name for t in timings for name in t.phases},
                   key=lambda name: -max(t.phases.get(name, 0.0) for t in timings))
    lines = ["| scheme | ranks | particles | million particle-steps/s/core | " + " | ".join(names) + " |",
             "|---" * (4 + len(names)) + "|"]
    for t in timings:
        cells = [f"{t.phases[name]:.1f}" if name in t.phases else "" for name in names]
        lines.append(f"| {t.scheme} | {t.ranks} | {t.particles:.0f} | {t.rate:.2f} | " + " | ".join(cells) + " |")
    return "\n".join([*lines, "", "Phases in ns per particle-step and core.", ""])


def write_csv(timings, path):
    rows = [t.row() for t in timings]
    names = list(dict.fromkeys(name for row in rows for name in row))
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, names, restval="")
        writer.writeheader()
        writer.writerows(rows)
