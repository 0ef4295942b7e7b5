"""Porous samples against what must hold on average: the in-situ Hugoniot, and the quality of a collapse."""
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import numpy

from poreshock_cases.always import DRIFT
from poreshock_cases.program import particles
from poreshock_cases.table import check, limit, near, shown
from poreshock_report import profiles

# Void fraction and end of the run, s: the front is then about 1.1 mm above the wall.
SAMPLES = ((0.077, 250e-9), (0.3, 500e-9), (0.46, 800e-9))
COLLAPSE_CELLS = (10e-6, 5e-6, 2.5e-6)  # m
JUDGED_CELL = 5e-6  # m, the others show the trend


def hugoniot(lab, sample):
    """Rows of the state behind the front of one porosity at 1100 m/s; five wall cells are left out."""
    voids, end = sample
    case = f"porous Hugoniot, void fraction {voids:g}, 1100 m/s, 5 um"
    run = lab.run(f"hugoniot_{voids:g}", "porous_hugoniot.toml", f"sample.porosity={voids:g}", f"time.end={end!r}",
                  "profile.every=5e-9")
    scene = profiles.reader.read_scene(run.folder)
    setting, rows = profiles.setting_of(scene), profiles.read(run.folder)
    fit = profiles.fit_front(rows, setting)
    state = profiles.state_behind(rows, setting, fit)
    plow = profiles.references(setting, profiles.void_fraction(rows, setting))[1]
    speed, _, pressure, _, _, temperature, _ = plow
    rise = temperature - setting.material.T0
    hot = state["temperature"] + state["fluctuation"] / setting.material.cv
    stress = profiles.wall_stress(run.folder, scene, rows, fit)
    return [near(case, "Us", fit.slope + setting.velocity, speed, 0.02, unit=" m/s"),
            near(case, "P at the wall", stress, pressure, 0.05, unit=" GPa", scale=1e9),
            near(case, "P behind the front", state["stress"], pressure, 0.05, unit=" GPa", scale=1e9),
            near(case, "rise of mean T", state["temperature"] - setting.material.T0, rise, 0.08, unit=" K"),
            near(case, "rise of mean T + fluctuation / c_v", hot - setting.material.T0, rise, 0.04, unit=" K"),
            shown(case, "residual velocity fluctuation",
                  f"{state['fluctuation']:.3g} J/kg = {state['fluctuation'] / setting.material.cv:.1f} K"),
            shown(case, "space behind the front that no particle fills", f"{100.0 * state['void_fraction']:.1f} %"),
            limit(case, "energy drift", run.drift, DRIFT)]


def quantile(values, weights, share):
    """Value below which a share of the weight lies."""
    order = numpy.argsort(values)
    return float(numpy.interp(share, numpy.cumsum(weights[order]) / weights.sum(), values[order]))


def shocked(state, velocity, cell):
    """Particles between five wall cells and two void diameters below the front of a 40 um void sample."""
    height, mass = state["position"][:, 1], state["mass"]
    row = numpy.floor(height / 10e-6).astype(int)
    mean = numpy.bincount(row, weights=mass * state["velocity"][:, 1]) / numpy.maximum(
        numpy.bincount(row, weights=mass), 1e-300)
    front = 10e-6 * float(numpy.argmax(mean < -0.5 * velocity))
    return (height > 5.0 * cell) & (height < front - 160e-6)


def collapse(lab, cell):
    """Outliers, cold particles, guards and steps of voids that collapse at 1500 m/s; one cell size."""
    case = f"collapsing voids, 1500 m/s, {1e6 * cell:g} um"
    run = lab.run(f"collapse_{1e6 * cell:g}", "porous_collapse.toml", f"domain.cell={cell!r}",
                  "output.snapshot=10e-9")
    states = [particles(path) for path in run.snapshots]
    mass = states[0]["mass"].sum()
    hard = max(state["mass"][state["pressure"] > 80e9].sum() for state in states) / mass
    coldest = min(float(state["temperature"].min()) for state in states)
    cold = max(state["mass"][state["temperature"] < 299.0].sum() for state in states) / mass
    last = states[-1]
    inside = shocked(last, run.scene["loading"]["velocity"], cell)
    hottest = quantile(last["temperature"][inside], last["mass"][inside], 0.99)
    steps = run.history["dt"][5:].min()
    planar = plane_step(lab, cell)
    rows = [limit(case, "mass above 80 GPa, %", 100.0 * hard, 0.2, ".3f"),
            shown(case, "99th percentile of T behind the front", f"{hottest:.0f} K"),
            check(case, "coldest particle in first compression",
                  f"{coldest:.1f} K (mass below 299 K: {100.0 * cold:.3f} %)", ">= 299 K", coldest >= 299.0),
            check(case, "guards, particle-steps", sum(run.guards.values()), "0", not any(run.guards.values())),
            check(case, "least step over that of the plane shock", f"{steps / planar:.2f}", ">= 0.25",
                  steps >= 0.25 * planar),
            limit(case, "energy drift", run.drift, DRIFT)]
    return rows if cell == JUDGED_CELL else [shown(row.case, row.figure, row.value) for row in rows]


def plane_step(lab, cell):
    """Least step of the same impact of the solid, once the shock stands."""
    run = lab.run(f"planar_{1e6 * cell:g}", "porous_collapse.toml", f"domain.cell={cell!r}", "sample.kind=solid",
                  f"domain.size=[{4 * cell:.12g}, 0.72e-3]", "morphology.every=0.0", "time.end=60e-9")
    return run.history["dt"][5:].min()


def rows(lab, jobs):
    """All rows of porous samples."""
    with ThreadPoolExecutor(jobs) as pool:
        found = [*pool.map(partial(hugoniot, lab), SAMPLES), *pool.map(partial(collapse, lab), COLLAPSE_CELLS)]
    return [row for part in found for row in part]
