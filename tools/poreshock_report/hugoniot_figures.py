"""Picture of the Hugoniots beside the state that a run has behind its shock."""
import numpy

import plate_exact

from . import hugoniot, profiles
from .style import COLOURS, plt

POINTS = 40  # of a curve
UNITS = (1.0, 1e-9)  # of Us and P in the picture, 1/(m/s) and 1/Pa
# P-alpha lies on the snow-plow where all voids collapse, so it goes over it as a thin line.
LINES = {"solid": {"color": COLOURS[2], "linestyle": "-.", "linewidth": 1.4},
         "snow-plow": {"color": COLOURS[5], "linestyle": "-", "linewidth": 3.5},
         "P-alpha": {"color": COLOURS[4], "linestyle": "--", "linewidth": 1.4}}


def curves(setting, voids):
    """{label: (Up, Us, P)} of solid with strength, snow-plow and P-alpha up to 1.4 times the impact, m/s and Pa; the
    velocities at which a curve does not exist are left out."""
    material = setting.material
    names = {"solid": lambda up: plate_exact.solve(material, up, setting.thermal).final}
    if voids > profiles.POROUS:
        names["snow-plow"] = lambda up: hugoniot.snow_plow(material, voids, up)
        names["P-alpha"] = lambda up: hugoniot.p_alpha(material, voids, up, setting.dimension)
    found = {}
    for label, state_at in names.items():
        rows = []
        for up in setting.velocity * numpy.geomspace(0.03, 1.4, POINTS):
            try:
                state = state_at(float(up))
            except ValueError:  # elastic, or beyond the equation of state
                continue
            rows.append((up, *((state.front, state.stress) if label == "solid" else (state.speed, state.pressure))))
        if rows:
            found[label] = numpy.array(rows).T
    return found


def hugoniots(folder):
    """Us and P against Up: the curves, and the run with its errors."""
    shock = profiles.measure(folder)
    names = [name for name, _, _ in profiles.QUANTITIES]
    (up, up_error), *measured = ((shock.values[i], shock.errors[i]) for i in map(names.index, ("Up [m/s]", "Us [m/s]", "P [GPa]")))
    figure, axes = plt.subplots(1, 2, figsize=(9.0, 4.4), layout="constrained")
    for label, (velocity, *rest) in curves(shock.setting, shock.voids).items():
        for axis, values, unit in zip(axes, rest, UNITS):
            axis.plot(velocity, unit * values, label=label, **LINES[label])
    for axis, (value, error), unit in zip(axes, measured, UNITS):
        axis.errorbar(up, unit * value, xerr=up_error, yerr=unit * error, color=COLOURS[1], marker="o", markersize=6, capsize=3,
                      linestyle="none", label="run", zorder=5)
        axis.set_xlabel("particle velocity Up [m/s]")
    axes[0].set(ylabel="shock speed Us [m/s]", ylim=(0.0, None), xlim=(0.0, None))
    axes[1].set(ylabel="longitudinal stress P [GPa]", xscale="log", yscale="log")
    for scale in (axes[1].xaxis, axes[1].yaxis):
        scale.set_major_formatter("{x:g}")
    axes[0].legend(loc="lower right")
    return figure
