"""Schemes over cells and particles per cell: their errors and their cost."""
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial

import numpy

from poreshock_cases import collapse, plate
from poreshock_cases.program import CaseError, Run

UM = 1e-6


@dataclass(frozen=True)
class Scheme:
    """A scheme: its name and the settings that make it."""
    name: str
    settings: tuple


def scheme(name, *settings):
    return Scheme(name, settings)


DEFAULT = "default: cubic AFLIP"
MOMENTS = "cubic AFLIP, gradients by moments"
SCHEMES = (
    scheme(DEFAULT),
    scheme("cubic PolyFLIP", "transfer.velocity=polyflip"),
    scheme("cubic iAPIC", "transfer.velocity=iapic"),
    scheme("cubic PolyPIC", "transfer.velocity=polypic"),
    scheme("cubic iPolyPIC", "transfer.velocity=ipolypic"),
    scheme("cubic APIC", "transfer.velocity=apic"),
    scheme("cubic FLIP", "transfer.velocity=flip"),
    scheme("cubic PIC", "transfer.velocity=pic"),
    scheme(MOMENTS, "transfer.gradient=moments"),
    scheme("cubic AFLIP, unlimited viscosity", "viscosity.limited=false"),
    scheme("quadratic AFLIP", "transfer.shape=quadratic", "transfer.velocity=aflip"),
    scheme("quadratic APIC", "transfer.shape=quadratic", "transfer.velocity=apic"),
    scheme("lineage (GIMP, FLIP)", "transfer.preset=lineage"),
)
PLATE_CELLS = (40 * UM, 20 * UM, 10 * UM)
VOID_CELLS = (10 * UM, 5 * UM, 2.5 * UM)  # 8, 16 and 32 cells per void diameter
FINER_PARTICLES = (DEFAULT, "quadratic AFLIP")  # also with 3 x 3 particles per cell
# Run with the finest cells too.
FINEST = (DEFAULT, MOMENTS, "cubic PolyPIC", "cubic APIC", "cubic FLIP", "quadratic AFLIP", "lineage (GIMP, FLIP)")


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
            run = kept(lab, label("rate", one, 5 * UM, per_cell), "porous_collapse.toml", *one.settings,
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
        run, exact = plate.shock(lab, name, 1100.0, *one.settings, f"sample.particles_per_cell={per_cell}",
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


def void_run(lab, one, cell, per_cell, may_fail=False):
    """The run of the voids with a scheme."""
    return kept(lab, label("voids", one, cell, per_cell), "porous_collapse.toml", *one.settings,
                f"domain.cell={cell!r}", f"sample.particles_per_cell={per_cell}", may_fail=may_fail)


def void_result(lab, rates, thresholds, case):
    """The collapse with one scheme; A, L and chi at the thresholds, K."""
    one, cell, per_cell = case
    try:
        run = void_run(lab, *case, may_fail=True)
        if run.code != 0:
            raise CaseError(run.output)
    except CaseError as problem:
        return Result(one, cell, per_cell, numpy.nan, {}, str(problem).strip().splitlines()[-1])
    return Result(one, cell, per_cell, cost(run, rates, case), collapse.figures(run, thresholds) | {
        "drift": run.drift, "guards": sum(run.guards.values())})


def voids(lab, rates, jobs, quick):
    """Results of the collapse."""
    todo = sorted(cases(VOID_CELLS[:1] if quick else VOID_CELLS), key=lambda case: case[1] / case[2])
    with ThreadPoolExecutor(jobs) as pool:
        return list(pool.map(partial(void_result, lab, rates, collapse.THRESHOLDS), todo))
