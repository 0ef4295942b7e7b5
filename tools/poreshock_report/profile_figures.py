"""Pictures of the profiles along the shock axis and of the front's path."""
import numpy

from . import folder as reader
from . import profiles as measuring
from .style import COLOURS, ordered, plt

PANELS = (("velocity", "velocity [m/s]", 1.0), ("stress", "longitudinal stress [GPa]", 1e-9),
          ("temperature", "temperature [K]", 1.0), ("density", "density of the solid [kg/m³]", 1.0),
          ("solid_fraction", "solid fraction [-]", 1.0), ("fluctuation", "velocity fluctuation [J/kg]", 1.0))


def filled(values, name):
    """The values of a row average, NaN above the free surface."""
    return numpy.where(values == 0.0, numpy.nan, values) if name == "solid_fraction" else values


def finish(axes):
    """Scales, labels and legend of the six panels."""
    axes[2, 1].set_yscale("symlog", linthresh=1.0)
    axes[2, 1].set_ylim(bottom=0.0)
    for axis in axes[-1]:
        axis.set_xlabel("height above the low side [mm]")
    axes[0, 1].legend(fontsize=9)


def profiles(folder, most=5):
    """Row averages at several times, one panel for each quantity."""
    data = measuring.read(folder)
    last = len(data.time) - 1
    chosen = sorted({int(round(i)) for i in numpy.linspace(0, last, most + 1)[1:]})
    figure, axes = plt.subplots(3, 2, sharex=True, figsize=(9.0, 8.6), layout="constrained")
    lines = ordered(len(chosen))
    for axis, (name, label, unit) in zip(axes.ravel(), PANELS):
        for record, line in zip(chosen, lines):
            axis.plot(1e3 * data.height, unit * filled(data.row[name][record], name), linewidth=1.1, **line,
                      label=f"{1e9 * data.time[record]:.4g} ns")
        axis.set_ylabel(label)
    finish(axes)
    return figure


def front(folder):
    """Height of the front against time, its width, the straight line through it and what is left."""
    setting = measuring.setting_of(reader.read_scene(folder))
    data = measuring.read(folder)
    fit = measuring.fit_front(data, setting)
    time, height = 1e9 * data.time, 1e3 * measuring.front_path(data, setting)
    line = 1e3 * (fit.start + fit.slope * data.time)
    figure, axes = plt.subplots(2, 1, sharex=True, figsize=(7.0, 6.2), layout="constrained", height_ratios=(3, 1))
    ends = fit.used[[0, -1]]
    axes[0].fill_between(time, height - 0.5e3 * data.width, height + 0.5e3 * data.width, alpha=0.25, linewidth=0,
                         label="width, 10-90 % of the velocity")
    axes[0].plot(time, height, linestyle="none", marker=".", markersize=4, label="front")
    axes[0].plot(time[ends], line[ends], linestyle="-", color=COLOURS[1],
                 label=f"fit: {fit.slope:.1f} ± {fit.error:.1f} m/s, Us = {fit.slope + setting.velocity:.1f} m/s")
    axes[0].set_ylabel("height of the front [mm]")
    axes[0].legend(loc="upper left")
    axes[1].plot(time[fit.used], (height - line)[fit.used] * 1e-3 / setting.cell, linestyle="none", marker=".", markersize=4)
    axes[1].set(xlabel="time [ns]", ylabel="front - fit [cells]")
    return figure
