"""Schemes over cells and particles per cell: their errors and their cost."""
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial

import h5py
import numpy

from poreshock_cases import plate
from poreshock_cases.program import CaseError, Run, particles

UM = 1e-6
WAVE_SPEED = 6436.8  # m/s, longitudinal, of the aluminium at rest


@dataclass(frozen=True)
class Scheme:
    """A scheme: its name and the settings that make it."""
    name: str
    settings: tuple
    damping: float = 0.0  # of the velocity noise, in longitudinal wave speeds per cell

    def at(self, cell):
        """Settings with cells of this size."""
        damping = (f"transfer.damping={self.damping * WAVE_SPEED / cell:.6g}",) if self.damping else ()
        return self.settings + damping


def scheme(name, shape, velocity, linear, averaging=0.0):
    """Settings of a scheme without damping; `linear` is the coefficient of the linear artificial viscosity."""
    return Scheme(name, (f"transfer.shape={shape}", f"transfer.velocity={velocity}", f"viscosity.linear={linear}",
                         "viscosity.quadratic=2.25", f"transfer.averaging={averaging}", "transfer.damping=0.0"))


DEFAULT = "default: cubic APIC, averaged, C_q 8"
SCHEMES = (
    Scheme(DEFAULT, ()),
    scheme("cubic APIC", "cubic", "apic", 0.6),
    scheme("cubic APIC, averaged 1/2", "cubic", "apic", 0.6, averaging=0.5),
    scheme("cubic APIC, averaged", "cubic", "apic", 0.8, averaging=1.0),
    scheme("cubic FLIP", "cubic", "flip", 0.6),
    scheme("cubic FLIP, averaged", "cubic", "flip", 0.8, averaging=1.0),
    Scheme("cubic FLIP, damped, averaged", ("transfer.velocity=flip", "viscosity.linear=0.73", "viscosity.quadratic=10"),
           damping=0.07),
    scheme("cubic PIC", "cubic", "pic", 0.6),
    scheme("quadratic APIC", "quadratic", "apic", 0.6),
    scheme("quadratic APIC, averaged", "quadratic", "apic", 0.8, averaging=1.0),
    scheme("lineage (GIMP, FLIP)", "gimp", "flip", 0.6),
)
PLATE_CELLS = (40 * UM, 20 * UM, 10 * UM)
VOID_CELLS = (10 * UM, 5 * UM, 2.5 * UM)  # 8, 16 and 32 cells per void diameter
FINER_PARTICLES = ("cubic APIC", "quadratic APIC")  # also with 3 x 3 particles per cell
# Run with the finest cells too.
FINEST = (DEFAULT, "cubic FLIP", "cubic FLIP, damped, averaged", "cubic APIC", "cubic APIC, averaged",
          "quadratic APIC", "quadratic APIC, averaged", "lineage (GIMP, FLIP)")
REFERENCES = ("cubic APIC", "cubic FLIP, damped, averaged")
REFERENCE_CELL = 1.25 * UM
QUANTILES = (0.25, 0.5, 0.75)


@dataclass(frozen=True)
class Result:
    """One run: figures by name; cost in core seconds; `failed` says why there are none."""
    scheme: Scheme
    cell: float
    per_cell: int
    cost: float
    figures: dict
    failed: str = ""


def seconds_of(run):
    """Seconds of the time loop without output."""
    skipped = ("morphology", "profile", "history", "snapshot", "checkpoint")
    return sum(phase["avg"] for phase in run.timings["phases"] if phase["name"] not in skipped)


def measure_rates(lab):
    """Seconds per particle-step of every scheme, measured one after the other on an idle machine."""
    rates = {}
    for one in SCHEMES:
        for per_cell in (2, 3):
            run = kept(lab, label("rate", one, 5 * UM, per_cell), "porous_collapse.toml", *one.at(5 * UM),
                       f"sample.particles_per_cell={per_cell}", "morphology.every=0.0", "time.max_steps=150")
            rates[one.name, per_cell] = seconds_of(run) / run.timings["particle_steps"]
    return rates


def kept(lab, name, scene, *settings, may_fail=False):
    """The run of that name, from disk when it is there and finished."""
    folder, closing = lab.folder / name, lab.folder / f"{name}.txt"
    if closing.exists() and (folder / "timings.json").exists():
        return Run(folder, 0, closing.read_text())
    run = lab.run(name, scene, *settings, may_fail=may_fail)
    if run.code == 0:
        closing.write_text(run.output)
    return run


def cases(cells):
    """All (scheme, cell, particles per cell and direction); the finest cells last."""
    return [(one, cell, per_cell) for one in SCHEMES for cell in cells for per_cell in (2, 3)
            if (per_cell == 2 or one.name in FINER_PARTICLES and cell > cells[-1])
            and (cell > cells[-1] or one.name in FINEST or len(cells) < 3)]


def label(kind, one, cell, per_cell):
    """Name of the folder of a run."""
    plain = "".join(c if c.isalnum() else "_" for c in one.name)
    return f"{kind}_{plain}_{cell / UM:g}um_{per_cell}"


def cost(run, rates, case):
    """Core seconds: particle-steps times the measured seconds of one."""
    return run.timings["particle_steps"] * rates[case[0].name, case[2]]


def plate_result(lab, rates, case):
    """The plate at 1100 m/s: errors against the exact state, in percent."""
    one, cell, per_cell = case
    name = label("plate", *case)
    try:
        run, exact = plate.shock(lab, name, 1100.0, *one.at(cell), f"sample.particles_per_cell={per_cell}",
                                 cell=cell, start=partial(kept, lab))
        found, final = plate.measure(run.particles(), cell), exact.final
    except (CaseError, ValueError) as problem:
        return Result(one, cell, per_cell, numpy.nan, {}, str(problem).splitlines()[-1])
    return Result(one, cell, per_cell, cost(run, rates, case), {
        "stress": 100.0 * (found.stress / final.stress - 1.0),
        "temperature": 100.0 * ((found.temperature - 300.0) / (final.temperature - 300.0) - 1.0),
        "plastic strain": 100.0 * (found.plastic_strain / final.plastic_strain - 1.0),
        "noise": 100.0 * found.noise, "overshoot": 100.0 * found.overshoot, "drift": run.drift})


def plates(lab, rates, jobs, quick):
    """Results of the plate; cells of different size last longest first."""
    chosen = sorted(cases(PLATE_CELLS[:2] if quick else PLATE_CELLS), key=lambda case: case[1] / case[2])
    with ThreadPoolExecutor(jobs) as pool:
        return list(pool.map(partial(plate_result, lab, rates), chosen))


def curves(run):
    """Thresholds (K) and A, L, chi of the temperature at the end of a run."""
    with h5py.File(run.folder / "morphology.h5") as file:
        group = file["temperature"]
        return group["threshold"][...], {name: group[name][-1] for name in ("A", "L", "chi")}


def void_figures(run, thresholds):
    """What the comparison of a collapse looks at; A, L and chi at three temperatures."""
    state = particles(run.snapshots[-1])
    mass = state["mass"]
    grid, measured = curves(run)
    figures = {"plastic work": float(numpy.average(state["plastic_work"], weights=mass)),
               "mean T": float(numpy.average(state["temperature"], weights=mass)),
               "mass above 80 GPa": float(mass[state["pressure"] > 80e9].sum() / mass.sum())}
    for share, threshold in zip(QUANTILES, thresholds):
        figures |= {f"{name}({100 * share:.0f} %)": float(numpy.interp(threshold, grid, values))
                    for name, values in measured.items()}
    return figures


def hot_quantiles(run):
    """Temperatures below which 25, 50 and 75 % of the shocked mass lie."""
    state = particles(run.snapshots[-1])
    hot = state["temperature"] > 305.0
    order = numpy.argsort(state["temperature"][hot])
    share = numpy.cumsum(state["mass"][hot][order]) / state["mass"][hot].sum()
    return numpy.interp(QUANTILES, share, state["temperature"][hot][order])


def void_run(lab, one, cell, per_cell, may_fail=False):
    """The run of the voids with a scheme."""
    return kept(lab, label("voids", one, cell, per_cell), "porous_collapse.toml", *one.at(cell),
                f"domain.cell={cell!r}", f"sample.particles_per_cell={per_cell}", may_fail=may_fail)


def void_result(lab, rates, thresholds, case):
    """The collapse with one scheme."""
    one, cell, per_cell = case
    try:
        run = void_run(lab, *case, may_fail=True)
        if run.code != 0:
            raise CaseError(run.output)
    except CaseError as problem:
        return Result(one, cell, per_cell, numpy.nan, {}, str(problem).strip().splitlines()[-1])
    return Result(one, cell, per_cell, cost(run, rates, case), void_figures(run, thresholds) | {
        "drift": run.drift, "guards": sum(run.guards.values())})


@dataclass(frozen=True)
class Reference:
    """The common reference: mean of two schemes at the finest cells and half their difference."""
    cell: float
    thresholds: tuple
    results: tuple

    def value(self, name):
        return 0.5 * sum(result.figures[name] for result in self.results)

    def uncertainty(self, name):
        return 0.5 * abs(self.results[0].figures[name] - self.results[1].figures[name])


def voids(lab, rates, jobs, quick):
    """Results of the collapse and their reference."""
    cell = VOID_CELLS[1] if quick else REFERENCE_CELL
    chosen = [one for one in SCHEMES if one.name in REFERENCES]
    with ThreadPoolExecutor(jobs) as pool:
        runs = list(pool.map(lambda one: void_run(lab, one, cell, 2), chosen))
        thresholds = tuple(numpy.mean([hot_quantiles(run) for run in runs], axis=0))
        reference = Reference(cell, thresholds, tuple(
            pool.map(partial(void_result, lab, rates, thresholds), [(one, cell, 2) for one in chosen])))
        todo = sorted(cases(VOID_CELLS[:1] if quick else VOID_CELLS), key=lambda case: case[1] / case[2])
        return list(pool.map(partial(void_result, lab, rates, thresholds), todo)), reference
