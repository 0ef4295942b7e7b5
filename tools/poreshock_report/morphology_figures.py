"""Pictures of the morphology: functionals against time and against each other, and the hot spots."""
import numpy

from . import folder as reader
from .style import ordered, plt

RISES = (50.0, 100.0, 150.0, 200.0, 250.0)  # K above the initial temperature, as in the paper
# Where domains are counted, their chi stands for that of the pixels, which with black voids counts every void.
LABELS = {"A": "area $A$ [-]", "volume": "volume $V$ [-]", "L": "boundary length $L$ [-]", "S": "surface area $S$ [-]",
          "M": "integral of the\nmean curvature $M$ [-]", "chi": "Euler characteristic\n" + r"$\chi$ [-]",
          "chi_paper": "hot less cold domains\n" + r"$\chi$ [-]"}
IN_WINDOW = "in the window that follows the front"  # a picture that is shown alone says it too


def functionals(folder):
    """Times, thresholds and the functionals of a run by name, of two dimensions or of three, the Euler characteristic last."""
    for names in (("A", "L", "chi_paper"), ("volume", "S", "M", "chi_paper"), ("A", "L", "chi"), ("volume", "S", "M", "chi")):
        try:
            return reader.read_morphology(folder, names=names)
        except reader.Missing as reason:
            problem = reason
    raise problem


def nearest_rises(threshold, start):
    """(index, label) of the thresholds nearest to the rises of the paper above `start`."""
    indices = sorted({int(numpy.argmin(numpy.abs(threshold - start - rise))) for rise in RISES})
    return [(i, f"{threshold[i] - start:.4g} K") for i in indices]


def shown_thresholds(folder, threshold, start):
    """[(index, label)] of the thresholds to show, and what they are: rises above `start`, or some of the quantiles."""
    if reader.read_levels(folder) is None:
        return nearest_rises(threshold, start), f"threshold - {start:.4g} K"
    indices = sorted({int(i) for i in numpy.linspace(0, len(threshold) - 1, min(len(threshold), len(RISES))).round()})
    return [(i, f"{threshold[i]:.4g}") for i in indices], "share of colder material"


def against_time(folder, start, follows=False):
    """The functionals of the hot region against time (Figure 2 of the paper), three in 2-D and four in 3-D; of a run that follows
    the front they are those of its window."""
    time, threshold, arrays = functionals(folder)
    shown, title = shown_thresholds(folder, threshold, start)
    figure, axes = plt.subplots(len(arrays), 1, sharex=True, figsize=(7.0, 2.8 * len(arrays)), layout="constrained")
    for axis, (name, values) in zip(axes, arrays.items()):
        for (i, rise), line in zip(shown, ordered(len(shown))):
            axis.plot(1e9 * time, values[:, i], label=rise, **line)
        axis.set_ylabel(LABELS[name])
    axes[0].legend(title=title, ncols=3, loc="upper left")
    axes[0].set(ylim=(-0.02, 1.05), title=IN_WINDOW if follows else "")
    axes[-1].set_xlabel("time [ns]")
    return figure


def space(folder, start, follows=False):
    """The same curves in the space of area, boundary and Euler characteristic (Figure 3 of the paper)."""
    _, threshold, arrays = functionals(folder)
    names = [name for name in arrays if name != "M"]
    shown, title = shown_thresholds(folder, threshold, start)
    figure = plt.figure(figsize=(7.0, 5.6), layout="constrained")
    axis = figure.add_subplot(projection="3d")
    for (i, rise), line, marker in zip(shown, ordered(len(shown)), "osD^v"):
        axis.plot(*(arrays[name][:, i] for name in names), color=line["color"], linestyle="-", marker=marker, markersize=3.0,
                  linewidth=1.0, label=rise)
    axis.set_xlabel(f"${names[0][0].upper()}$", labelpad=8)
    axis.set_ylabel(f"${names[1]}$", labelpad=10)
    axis.set_zlabel(r"$\chi$", labelpad=14)
    axis.tick_params(axis="z", pad=6)
    axis.locator_params(nbins=5)
    axis.view_init(elev=22, azim=-58)
    axis.set_box_aspect(None, zoom=0.82)
    axis.set_title(IN_WINDOW if follows else "")
    axis.legend(title=title, loc="upper left")
    return figure


def unresolved(folder, start):
    """Names the thresholds, or is empty: those at which the two Euler characteristics differ by a quarter of chi or more on the average
    over the run: hot pixels that join over sides alone, or over corners too."""
    for other in ("chi4", "chi6"):
        try:
            _, threshold, arrays = reader.read_morphology(folder, names=("chi", other))
            break
        except reader.Missing as reason:
            problem = reason
    else:
        raise problem
    shares = reader.read_levels(folder) is not None
    found = []
    for i, label in shown_thresholds(folder, threshold, start)[0]:
        apart = numpy.abs(arrays[other][:, i] - arrays["chi"][:, i]).mean()
        if apart > 0.25 * numpy.abs(arrays["chi"][:, i]).mean():
            found.append(label)
    listed = ", ".join(found)
    return listed and (f"the quantiles {listed}" if shares else f"{listed} above the start")


def hot_spots(folder, start):
    """Number of hot spots above a size, and size against peak, by level."""
    level, size, peak, dimension, time = reader.read_hot_spots(folder)
    diameter = 2e6 * (numpy.sqrt(size / numpy.pi) if dimension == 2 else numpy.cbrt(0.75 * size / numpy.pi))
    levels = numpy.unique(level)
    figure, axes = plt.subplots(1, 2, figsize=(8.4, 3.9), layout="constrained")
    for value, line, marker in zip(levels, ordered(len(levels)), "o^sDv" * len(levels)):
        own = numpy.sort(diameter[level == value])[::-1]
        axes[0].loglog(own, numpy.arange(1, len(own) + 1), drawstyle="steps-post", label=f"{value - start:.4g} K", **line)
        axes[1].loglog(diameter[level == value], peak[level == value] - start, color=line["color"], marker=marker,
                       markersize=3, linestyle="none")
    same = "area" if dimension == 2 else "volume"
    axes[0].set(xlabel=rf"diameter of equal {same} [$\mu$m]", ylabel="hot spots at least as large",
                title=f"at {1e9 * time:.4g} ns")
    axes[1].set(xlabel=rf"diameter of equal {same} [$\mu$m]", ylabel=f"peak - {start:.4g} K [K]")
    axes[0].legend(title=f"threshold - {start:.4g} K", fontsize=9)
    return figure
