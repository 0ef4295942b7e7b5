"""Porous samples and beds of grains against what must hold on average: the in-situ Hugoniot, and the quality of a
collapse."""
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import numpy

from poreshock_cases.always import DRIFT
from poreshock_cases.program import particles
from poreshock_cases.table import check, limit, shown
from poreshock_report import folder, profiles
from poreshock_report.hugoniot import snow_plow

# Void fraction and end of the run, s: the front is then about 1.1 mm above the wall.
SAMPLES = ((0.077, 250e-9), (0.3, 500e-9), (0.46, 800e-9))
SEEDS = (1, 2, 3, 4)
FLUX = "momentum flux behind the front"
STATE = ("P behind the front", FLUX, "rise of mean T", "rise of mean T + fluctuation / c_v")
FIGURES = ("Us", "P at the wall", *STATE)
BARS = {"Us": 0.02, "P at the wall": 0.05, "P behind the front": 0.05, "rise of mean T": 0.08,
        "rise of mean T + fluctuation / c_v": 0.04}
BED_SEEDS = (1, 2, 3, 4, 5, 6)
BED_END = 280e-9  # s, the front is then in the upper third of the bed
BED_BARS = {"Us": 0.01, "P at the wall": 0.01, "P behind the front": 0.03, FLUX: 0.02}
COLLAPSE_CELLS = (10e-6, 5e-6, 2.5e-6)  # m
FINE_CELL = 2.5e-6  # m
JUDGED_CELL = 5e-6  # m, the others show the trend


def measured(run):
    """One sample: FIGURES over those of the snow-plow shock of what its front crosses; STATE over those at the measured
    Up; Up in m/s, the residual fluctuation in K, the space without particles in percent, and the drift."""
    scene = profiles.reader.read_scene(run.folder)
    setting, rows = profiles.setting_of(scene), profiles.read(run.folder)
    fit = profiles.fit_front(rows, setting)
    state = profiles.state_behind(rows, setting, fit)
    fraction = profiles.void_fraction(rows, setting, fit)
    start, moving = setting.material.T0, state["fluctuation"] / setting.material.cv

    def over(plow):
        rise = plow.temperature - start
        return [state["stress"] / plow.pressure, state["momentum_flux"] / plow.pressure,
                (state["temperature"] - start) / rise, (state["temperature"] + moving - start) / rise]

    plow = snow_plow(setting.material, fraction, setting.velocity)
    stress = profiles.wall_stress(run.folder, scene, rows, fit)
    return [(fit.slope + setting.velocity) / plow.speed, stress / plow.pressure, *over(plow),
            *over(snow_plow(setting.material, fraction, state["velocity"])),
            state["velocity"], moving, 100.0 * state["void_fraction"], run.drift]


def porous(lab, voids, end, seed, cell=5e-6):
    """What is measured of one porous sample."""
    return measured(lab.run(f"hugoniot_{voids:g}_{1e6 * cell:g}_{seed}", "porous_hugoniot.toml",
                            f"sample.porosity={voids:g}", f"sample.seed={seed}", f"domain.cell={cell!r}",
                            f"time.end={end!r}", "profile.every=5e-9"))


def bed(lab, seed):
    """What is measured of one bed of grains."""
    return measured(lab.run(f"bed_{seed}", "grain_bed.toml", f"sample.seed={seed}", f"time.end={BED_END!r}",
                            "profile.every=5e-9", "morphology.every=0.0", "output.snapshot=1.0"))


def hugoniot(name, found, bars):
    """Rows of the mean state behind the front over samples of one kind; five wall cells are left out."""
    many = f"{len(found)} samples" if len(found) > 1 else "one sample"
    case = f"{name}, {many}"
    values = numpy.array(found).T
    mean = values.mean(axis=1)
    error = values.std(axis=1, ddof=1) / len(found)**0.5 if len(found) > 1 else numpy.full(len(mean), numpy.nan)
    off = [f"{100.0 * (x - 1.0):+.1f} %" + (f" +- {100.0 * e:.1f} %" if e == e else "") for x, e in zip(mean, error)]
    rows = [check(case, figure, off[i], f"snow-plow +- {100.0 * bars[figure]:g} %", abs(mean[i] - 1.0) <= bars[figure])
            if figure in bars else shown(case, figure, off[i]) for i, figure in enumerate(FIGURES)]
    rows += [shown(case, f"{figure}, against the snow-plow of the measured Up", off[i])
             for i, figure in enumerate(STATE, len(FIGURES))]
    return rows + [shown(case, "Up behind the front", f"{mean[-4]:.0f} m/s"),
                   shown(case, "residual velocity fluctuation / c_v", f"{mean[-3]:.1f} K"),
                   shown(case, "space behind the front that no particle fills", f"{mean[-2]:.1f} %"),
                   limit(case, "energy drift", values[-1].max(), DRIFT)]


def beds(lab, jobs):
    """Rows of beds of grains with friction 0.5."""
    with ThreadPoolExecutor(jobs) as pool:
        found = [*pool.map(partial(bed, lab), BED_SEEDS)]
    return hugoniot("beds of grains, void fraction 0.3, 1100 m/s, 6.25 um", found, BED_BARS)


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


def above_isentrope(state):
    """Least T of a particle above the isentrope through rho_0 and T_0 of the aluminium, K: no entropy is lost.

    With rho Gamma constant it is T_0 exp(Gamma_0 (1 - rho_0/rho)); material in tension is colder than T_0."""
    return float((state["temperature"] - 300.0 * numpy.exp(2.0 * (1.0 - 2700.0 / state["density"]))).min())


def collapse(lab, cell):
    """Outliers, entropy, guards and steps of voids that collapse at 1500 m/s; one cell size."""
    case = f"collapsing voids, 1500 m/s, {1e6 * cell:g} um"
    run = lab.run(f"collapse_{1e6 * cell:g}", "porous_collapse.toml", f"domain.cell={cell!r}",
                  "output.snapshot=10e-9")
    states = [particles(path) for path in run.snapshots]
    mass = states[0]["mass"].sum()
    hard = max(state["mass"][state["pressure"] > 80e9].sum() for state in states) / mass
    coldest = min(above_isentrope(state) for state in states)
    last = states[-1]
    inside = shocked(last, run.scene["loading"]["velocity"], cell)
    hottest = quantile(last["temperature"][inside], last["mass"][inside], 0.99)
    steps = run.history["dt"][5:].min()
    guarded = sum(run.guards.values()) / (len(last["mass"]) * run.history["step"][-1])
    planar = plane_step(lab, cell)
    rows = [limit(case, "mass above 80 GPa, %", 100.0 * hard, 0.2, ".3f"),
            shown(case, "99th percentile of T behind the front", f"{hottest:.0f} K"),
            check(case, "coldest particle, against the isentrope of the start", f"{coldest:+.2f} K", ">= -1 K",
                  coldest >= -1.0),
            limit(case, "guards, share of the particle-steps", guarded, 1e-4, ".1e"),
            check(case, "least step over that of the plane shock", f"{steps / planar:.2f}", ">= 0.25",
                  steps >= 0.25 * planar),
            shown(case, "numerical dissipation", f"{100.0 * folder.numerical_share(run.history)[-1]:.1f} % of all heat"),
            limit(case, "energy drift", run.drift, DRIFT)]
    return rows if cell == JUDGED_CELL else [shown(row.case, row.figure, row.value) for row in rows]


def plane_step(lab, cell):
    """Least step of the same impact of the solid, once the shock stands."""
    run = lab.run(f"planar_{1e6 * cell:g}", "porous_collapse.toml", f"domain.cell={cell!r}", "sample.kind=solid",
                  f"domain.size=[{4 * cell:.12g}, 0.72e-3]", "morphology.every=0.0", "time.end=60e-9")
    return run.history["dt"][5:].min()


def rows(lab, jobs, fine):
    """All rows of porous samples; with `fine` also the one whose gaps need cells half as large."""
    runs = [(*sample, seed) for sample in SAMPLES for seed in SEEDS]
    with ThreadPoolExecutor(jobs) as pool:
        shocks = [*pool.map(lambda run: porous(lab, *run), runs)]
        collapses = [*pool.map(partial(collapse, lab), COLLAPSE_CELLS)]

    def name(sample, cell=5e-6):
        return f"porous Hugoniot, void fraction {sample[0]:g}, 1100 m/s, {1e6 * cell:g} um"

    found = [hugoniot(name(sample), shocks[i * len(SEEDS):(i + 1) * len(SEEDS)], BARS)
             for i, sample in enumerate(SAMPLES)]
    if fine:
        sample = SAMPLES[-1]
        found.append(hugoniot(name(sample, FINE_CELL), [porous(lab, *sample, SEEDS[0], FINE_CELL)], BARS))
    return [row for part in found + collapses for row in part]
