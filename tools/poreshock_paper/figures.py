"""The figures of the paper and those past it, each a function from measured numbers to a matplotlib figure."""
import numpy

from poreshock_paper import measures
from poreshock_paper.plan import FIGURE_2, REFERENCE, START
from poreshock_report import figures as report
from poreshock_report import folder as reader

plt = report.plt
TEXT = {"A": "area $A$ [-]", "L": "boundary length $L$ [-]", "chi_paper": r"Euler characteristic $\chi$ [-]"}


def nearest_snapshot(folder, time):
    """(time, path) of the snapshot nearest to a time in seconds."""
    return min(reader.snapshot_times(folder), key=lambda entry: abs(entry[0] - time))


def figure_1(folder, times):
    return report.temperature_panels([nearest_snapshot(folder, 1e-9 * time) for time in times])


def figure_2(found):
    """A, L and chi of the reference against time."""
    figure, axes = plt.subplots(3, 1, sharex=True, figsize=(6.4, 7.6), layout="constrained")
    for axis, (name, label) in zip(axes, TEXT.items()):
        for rise in FIGURE_2:
            axis.plot(1e9 * found.time, found.at(name, rise), label=f"{rise} K")
        axis.axvline(1e9 * found.time[found.end], color="#999999", linewidth=0.8, linestyle="--")
        axis.set_ylabel(label)
    axes[0].legend(title=f"threshold - {START:.0f} K", ncols=2)
    axes[-1].set_xlabel("time [ns]; dashed: end of loading")
    return figure


def space(paths):
    """Paths in the space of A, L and chi by label, a dot every 50 ns."""
    figure = plt.figure(figsize=(6.0, 5.0), layout="constrained")
    axis = figure.add_subplot(projection="3d")
    for label, (found, rise, end) in paths.items():
        points = [found.at(name, rise)[:end + 1] for name in TEXT]
        line = axis.plot(*points, linewidth=1.2, label=label)[0]
        marked = numpy.isclose(numpy.round(found.time[:end + 1] / 50e-9), found.time[:end + 1] / 50e-9)
        axis.plot(*(values[marked] for values in points), ".", color=line.get_color(), markersize=4)
    axis.set_xlabel("$A$", labelpad=8)
    axis.set_ylabel("$L$", labelpad=10)
    axis.set_zlabel(r"$\chi$", labelpad=12)
    axis.tick_params(axis="z", pad=5)
    axis.locator_params(nbins=5)
    axis.view_init(elev=22, azim=-58)
    axis.set_box_aspect(None, zoom=0.84)
    axis.legend(loc="upper left", fontsize=9)
    return figure


def figure_4(matches, level, velocities):
    """d_p of every velocity against the rise of the threshold, one level of the reference."""
    figure, axis = plt.subplots(figsize=(6.4, 4.4), layout="constrained")
    for velocity in velocities:
        match = matches[velocity, level]
        line = axis.plot(match.rise, match.distance, label=f"{velocity} m/s")[0]
        axis.plot(match.best, match.best_distance, "o", markersize=4, color=line.get_color())
    used = max(match.best for (_, known), match in matches.items() if known == level)
    axis.set(xlim=(0.0, min(1.6 * used, match.rise[-1])), xlabel=f"threshold - {START:.0f} K [K]", ylabel="$d_p$ [-]")
    axis.set_ylim(bottom=0.0)
    axis.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=9)
    return figure


def figure_6(folders, wanted):
    """Material hotter (grey) and colder (black) than the threshold at one time, by label and threshold in K."""
    pieces = {label: (report.read_slice(nearest_snapshot(folder, wanted)[1]), threshold)
              for label, (folder, threshold) in folders.items()}
    extent = report.common_extent([piece for piece, _ in pieces.values()])
    wide, high, to_scale = report.panel_size(*(end[1] - end[0] for end in extent))
    figure, axes = plt.subplots(1, len(pieces), sharey=True, squeeze=False, layout="constrained",
                                figsize=((wide + 0.2) * len(pieces) + 1.0, high + 1.2))
    for axis, (label, (piece, threshold)) in zip(axes[0], pieces.items()):
        mean, spans = report.pixel_mean(*piece[:3], extent, piece[3])
        colour = numpy.where(numpy.isnan(mean), 1.0, numpy.where(mean >= threshold, 0.62, 0.0))
        axis.imshow(colour, origin="lower", extent=[1e3 * end for span in spans for end in span], cmap="gray", vmin=0.0,
                    vmax=1.0, interpolation="nearest", aspect="equal" if to_scale else "auto")
        axis.set_title(label, fontsize=8)
        axis.grid(False)
        axis.locator_params(axis="x", nbins=2)
    axes[0][0].set_ylabel("along the shock axis [mm]")
    return figure


def figure_7(series):
    """Matching rise against V^2 by level: lists of (velocity, mean, deviation), and the line through them."""
    figure, axis = plt.subplots(figsize=(6.0, 4.6), layout="constrained")
    for level, points in series.items():
        velocity, mean, deviation = (numpy.array(column, dtype=float) for column in zip(*points))
        squared = velocity**2 / 1e4
        bars = axis.errorbar(squared, mean, yerr=numpy.nan_to_num(deviation), fmt="o", markersize=4, capsize=3,
                             label=f"{level} K at {REFERENCE} m/s")
        fit = measures.straight_line(squared, mean)
        if fit:
            ends = numpy.array([squared.min(), squared.max()])
            axis.plot(ends, fit.start + fit.slope * ends, linewidth=1.0, color=bars[0].get_color())
    axis.set(xlabel=r"$V^2/10^4$ [m$^2$/s$^2$]", ylabel=f"matching threshold - {START:.0f} K [K]")
    axis.legend(fontsize=9)
    return figure


def figure_8(series, fits):
    """ln DT against ln porosity by level of the reference, with the power law of the fitted range."""
    figure, axis = plt.subplots(figsize=(6.0, 4.6), layout="constrained")
    for level, points in series.items():
        points = [point for point in points if numpy.isfinite(point[1])]
        if not points:
            continue
        porosity, mean, deviation = (numpy.array(column, dtype=float) for column in zip(*points))
        bars = axis.errorbar(porosity, mean, yerr=numpy.nan_to_num(deviation), fmt="o-", markersize=4, capsize=3, linewidth=0.8,
                             label=f"{level} K")
        if fits.get(level):
            fit, last = fits[level]
            ends = numpy.array([porosity.min(), last])
            axis.plot(ends, numpy.exp(fit.start) * ends**fit.slope, linestyle="--", color=bars[0].get_color())
    axis.set(xscale="log", yscale="log", xlabel="void fraction [-]", ylabel=f"matching threshold - {START:.0f} K [K]")
    axis.legend(title="at 0.077", fontsize=9)
    axis.grid(True, which="both")
    return figure


def sensitivity(variants):
    """A at 200 K and chi at 150 K of the reference with one thing changed."""
    figure, axes = plt.subplots(2, 1, sharex=True, figsize=(7.2, 7.4), layout="constrained")
    styles = ["-"] * 8 + ["--"] * 8
    for (label, found), style in zip(variants.items(), styles):
        axes[0].plot(1e9 * found.time, found.at("A", 200), style, linewidth=1.1, label=label)
        axes[1].plot(1e9 * found.time, found.at("chi_paper", 150), style, linewidth=1.1)
    axes[0].set_ylabel("$A$ at 200 K [-]")
    axes[1].set(ylabel=r"$\chi$ at 150 K, per pixel of its own [-]", xlabel="time [ns]")
    axes[0].legend(fontsize=8, loc="upper left")
    return figure


def past_the_paper(found, pixel):
    """Growth of the hot area, direction of the pattern and its correlation length against time."""
    figure, axes = plt.subplots(3, 1, sharex=True, figsize=(6.4, 7.6), layout="constrained")
    for rise in FIGURE_2:
        area = found.at("A", rise)
        seen = (area > 0.01) & (area < 0.99)
        axes[0].plot(1e9 * found.time, 1e-6 * measures.growth(found, rise)[0], label=f"{rise} K")
        for axis, values, unit in ((axes[1], measures.anisotropy(found, rise), 1.0),
                                   (axes[2], measures.correlation_length(found, rise, pixel), 1e6)):
            axis.plot(1e9 * found.time, numpy.where(seen, unit * values, numpy.nan))
    axes[0].set_ylabel(r"$dA/dt$ [1/$\mu$s]")
    axes[1].set_ylabel("anisotropy of the boundary [-]")
    axes[2].set(ylabel=r"correlation length [$\mu$m]", xlabel="time [ns]", yscale="log")
    axes[0].legend(ncols=2, fontsize=9)
    return figure


def hot_spot_figure(spots):
    """Number of hot spots above a size, and size against peak, by level."""
    figure, axes = plt.subplots(1, 2, figsize=(8.4, 3.8), layout="constrained")
    for level, (area, peak) in spots.items():
        if len(area) == 0:
            continue
        size = numpy.sort(2e6 * numpy.sqrt(area / numpy.pi))[::-1]
        axes[0].loglog(size, numpy.arange(1, len(size) + 1), label=f"{level} K")
        axes[1].loglog(2e6 * numpy.sqrt(area / numpy.pi), peak - START, ".", markersize=3)
    axes[0].set(xlabel=r"diameter of equal area [$\mu$m]", ylabel="hot spots at least as large")
    axes[1].set(xlabel=r"diameter of equal area [$\mu$m]", ylabel=f"peak - {START:.0f} K [K]")
    axes[0].legend(fontsize=9)
    return figure
