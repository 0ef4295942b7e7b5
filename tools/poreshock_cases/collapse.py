"""What a run of input/porous_collapse.toml is judged by."""
import h5py
import numpy

from poreshock_cases.program import particles
from poreshock_report import folder

QUANTILES = (0.25, 0.5, 0.75)
THRESHOLDS = (503, 774, 1062)  # K, near the quantiles of the shocked mass at 1500 m/s
SHOCKED = 305.0  # K, colder material has seen no shock


def hot_quantiles(state):
    """Temperatures below which 25, 50 and 75 % of the shocked mass lie, K."""
    hot = state["temperature"] > SHOCKED
    order = numpy.argsort(state["temperature"][hot])
    share = numpy.cumsum(state["mass"][hot][order]) / state["mass"][hot].sum()
    return numpy.interp(QUANTILES, share, state["temperature"][hot][order])


def quantiles_of(run):
    """The same at the end of a run."""
    return hot_quantiles(particles(run.snapshots[-1]))


def curves(run):
    """Thresholds (K) and A, L, chi of the temperature at the end of a run."""
    with h5py.File(run.folder / "morphology.h5") as file:
        group = file["temperature"]
        return group["threshold"][...], {name: group[name][-1] for name in ("A", "L", "chi")}


def heats(run, mass):
    """Heat of each kind so far, J per kg of all material, and the numerical dissipation, percent of all heat."""
    history = run.history
    found = {name.replace("_", " "): float(history[name][-1]) / mass for name in folder.HEATS if numpy.any(history[name])}
    return found | {"numerical dissipation": 100.0 * float(folder.numerical_share(history)[-1])}


def figures(run, thresholds=THRESHOLDS):
    """Figures by name at the end of a run; A, L and chi at the thresholds, K."""
    state = particles(run.snapshots[-1])
    mass = state["mass"]
    grid, measured = curves(run)
    found = {"plastic work": float(numpy.average(state["plastic_work"], weights=mass))}
    found |= {f"T({100 * share:.0f} %)": float(value) for share, value in zip(QUANTILES, hot_quantiles(state))}
    for threshold in thresholds:
        found |= {f"{name}({threshold:.0f} K)": float(numpy.interp(threshold, grid, values))
                  for name, values in measured.items()}
    split = heats(run, mass.sum())
    split.pop("plastic work", None)  # the same as that of the particles
    return found | split | {"mass above 80 GPa": float(mass[state["pressure"] > 80e9].sum() / mass.sum())}
