"""Pictures of two runs over each other: the first with full lines, the second with dashes."""
import numpy

from . import figures, morphology_figures, profile_figures
from . import folder as reader
from . import profiles as measuring
from .style import COLOURS, plt

DASHES = ("-", (0, (4, 1.5)))


def common_snapshots(folders):
    """The last snapshots of two runs at nearly the same time: [(time, path), (time, path)]."""
    first, second = (reader.snapshot_times(folder) for folder in folders)
    step = min(times[-1][0] / max(1, len(times) - 1) for times in (first, second))
    for time, path in reversed(first):
        other = min(second, key=lambda entry: abs(entry[0] - time))
        if abs(other[0] - time) <= 0.01 * step:
            return [(time, path), other]
    raise reader.Missing("the runs have no snapshots of the same time")


def temperature(folders, names):
    """The last common snapshots side by side on one scale."""
    snapshots = common_snapshots(folders)
    return figures.temperature_panels(snapshots, [f"{name}\n{1e9 * time:.4g} ns" for name, (time, _) in zip(names, snapshots)])


def morphology(folders, names, start):
    """Functionals of the hot regions against time at three thresholds that both runs have."""
    found = [morphology_figures.functionals(folder) for folder in folders]
    common = numpy.intersect1d(found[0][1], found[1][1])
    if len(common) == 0 or any((reader.read_levels(folder) is None) != (reader.read_levels(folders[0]) is None) for folder in folders):
        raise reader.Missing("the runs have no threshold in common")
    shown = [common[i] for i, _ in morphology_figures.nearest_rises(common, start)][::2]
    curves = [name for name in found[0][2] if name in found[1][2]]
    figure, axes = plt.subplots(len(curves), 1, sharex=True, squeeze=False, figsize=(7.0, 2.8 * len(curves)), layout="constrained")
    for axis, name in zip(axes[:, 0], curves):
        for (time, threshold, arrays), dash, run in zip(found, DASHES, names):
            for value, colour in zip(shown, COLOURS):
                axis.plot(1e9 * time, arrays[name][:, int(numpy.flatnonzero(threshold == value)[0])], color=colour, linestyle=dash,
                          label=f"{run}, {value - start:.4g}")
        axis.set_ylabel(morphology_figures.LABELS[name])
    axes[0, 0].legend(fontsize=8, ncols=2, title=f"threshold - {start:.4g}")
    axes[-1, 0].set_xlabel("time [ns]")
    return figure


def profiles(folders, names):
    """Row averages at the last time that both runs have."""
    data = [measuring.read(folder) for folder in folders]
    last = min(run.time[-1] for run in data)
    figure, axes = plt.subplots(3, 2, sharex=True, figsize=(9.0, 8.6), layout="constrained")
    for axis, (name, label, unit) in zip(axes.ravel(), profile_figures.PANELS):
        for run, dash, colour, text in zip(data, DASHES, COLOURS, names):
            record = int(numpy.argmin(numpy.abs(run.time - last)))
            axis.plot(1e3 * run.height, unit * profile_figures.filled(run.row[name][record], name), color=colour, linestyle=dash,
                      linewidth=1.2, label=f"{text}, {1e9 * run.time[record]:.4g} ns")
        axis.set_ylabel(label)
    profile_figures.finish(axes)
    return figure


def path_of(folder, data):
    """Heights of the front, m; without a wall those above the low side of the domain."""
    try:
        return measuring.front_path(data, measuring.setting_of(measuring.reader.read_scene(folder)))
    except measuring.reader.Missing:
        return data.front


def front(folders, names):
    """Height of the front against time."""
    figure, axis = plt.subplots(figsize=(7.0, 4.2), layout="constrained")
    for folder, dash, colour, text in zip(folders, DASHES, COLOURS, names):
        data = measuring.read(folder)
        axis.plot(1e9 * data.time, 1e3 * path_of(folder, data), color=colour, linestyle=dash, label=text)
    axis.set(xlabel="time [ns]", ylabel="height of the front [mm]")
    axis.legend()
    return figure
