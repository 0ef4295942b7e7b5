"""Pictures of the profiles along the shock axis and of the front's path."""
import numpy

from . import figures
from . import folder as reader
from . import profiles as measuring

plt = figures.plt
PANELS = (("velocity", "velocity [m/s]", 1.0), ("stress", "longitudinal stress [GPa]", 1e-9),
          ("temperature", "temperature [K]", 1.0), ("density", "density of the solid [kg/m³]", 1.0),
          ("solid_fraction", "solid fraction [-]", 1.0), ("fluctuation", "velocity fluctuation [J/kg]", 1.0))


def profiles(folder, most=5):
    """Row averages at several times, one panel for each quantity."""
    data = measuring.read(folder)
    last = len(data.time) - 1
    chosen = sorted({int(round(i)) for i in numpy.linspace(0, last, most + 1)[1:]})
    figure, axes = plt.subplots(3, 2, sharex=True, figsize=(9.0, 8.6), layout="constrained")
    shades = plt.get_cmap("viridis")(numpy.linspace(0.85, 0.0, len(chosen)))
    for axis, (name, label, unit) in zip(axes.ravel(), PANELS):
        for record, shade in zip(chosen, shades):
            values = data.row[name][record].copy()
            if name == "solid_fraction":
                values[values == 0.0] = numpy.nan  # above the free surface
            axis.plot(1e3 * data.height, unit * values, color=shade, linewidth=1.1,
                      label=f"{1e9 * data.time[record]:.4g} ns")
        axis.set_ylabel(label)
    axes[2, 1].set_yscale("symlog", linthresh=1.0)
    axes[2, 1].set_ylim(bottom=0.0)
    for axis in axes[-1]:
        axis.set_xlabel("height above the low side [mm]")
    axes[0, 1].legend(fontsize=9)
    return figure


def front(folder):
    """Height of the front against time, its width, the straight line through it and what is left."""
    setting = measuring.setting_of(reader.read_scene(folder))
    data = measuring.read(folder)
    fit = measuring.fit_front(data, setting)
    time, height = 1e9 * data.time, 1e3 * data.front
    line = 1e3 * (fit.start + fit.slope * data.time)
    figure, axes = plt.subplots(2, 1, sharex=True, figsize=(7.0, 6.2), layout="constrained", height_ratios=(3, 1))
    ends = fit.used[[0, -1]]
    axes[0].fill_between(time, height - 0.5e3 * data.width, height + 0.5e3 * data.width, alpha=0.25, linewidth=0,
                         label="width, 10-90 % of the velocity")
    axes[0].plot(time, height, ".", markersize=4, label="front")
    axes[0].plot(time[ends], line[ends], color=figures.COLOURS[3],
                 label=f"fit: {fit.slope:.1f} ± {fit.error:.1f} m/s, Us = {fit.slope + setting.velocity:.1f} m/s")
    axes[0].set_ylabel("height of the front [mm]")
    axes[0].legend(loc="upper left")
    axes[1].plot(time[fit.used], (height - line)[fit.used] * 1e-3 / setting.cell, ".", markersize=4)
    axes[1].set(xlabel="time [ns]", ylabel="front - fit [cells]")
    return figure
