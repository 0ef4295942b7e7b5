"""The pictures of the report, each a function from what was read to a matplotlib figure."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend has to be chosen first)
import numpy  # noqa: E402

from . import folder as reader  # noqa: E402

RISES = (50.0, 100.0, 150.0, 200.0, 250.0)  # K above the initial temperature, as in the paper
COLOURS = ("#1b6ca8", "#2a9d4e", "#b8860b", "#d1495b", "#6a3d9a", "#444444", "#e07b39", "#00868b")
plt.rcParams.update({"font.size": 10, "axes.grid": True, "grid.color": "#d9d9d9",
                     "grid.linewidth": 0.6, "axes.axisbelow": True, "legend.frameon": False,
                     "axes.prop_cycle": plt.cycler(color=COLOURS), "lines.linewidth": 1.6})


def choose_snapshots(times, most=6):
    """Indices of at most `most` snapshots, evenly spread; the untouched start only if alone."""
    first = 1 if len(times) > 1 and times[0][0] == 0.0 else 0
    count = min(most, len(times) - first)
    return sorted({int(round(i)) for i in numpy.linspace(first, len(times) - 1, count)})


def slice_of(particles):
    """Lateral and axial positions, temperatures and spacing of a plane piece of the particles.

    In 3-D that is the middle slice across y, one and a quarter spacings to each side.
    """
    position, temperature = particles["position"], particles["temperature"]
    dimension = position.shape[1]
    spacing = float(numpy.median(particles["mass"] / particles["density"])) ** (1.0 / dimension)
    if dimension == 3:
        middle = 0.5 * (position[:, 1].min() + position[:, 1].max())
        near = numpy.abs(position[:, 1] - middle) < 1.25 * spacing
        position, temperature = position[near], temperature[near]
    return position[:, 0], position[:, -1], temperature, spacing


def pixel_mean(x, y, values, extent, pixel):
    """Mean of the values on square pixels; NaN without particles. Single gaps are bridged."""
    shape = [max(1, int(numpy.ceil((high - low) / pixel - 1e-6))) for low, high in extent]
    spans = [(low, low + n * pixel) for (low, _), n in zip(extent, shape)]
    count = numpy.histogram2d(x, y, bins=shape, range=spans)[0]
    total = numpy.histogram2d(x, y, bins=shape, range=spans, weights=values)[0]
    mean = numpy.where(count > 0, total / numpy.maximum(count, 1), numpy.nan)
    # Particles are not on the pixels: an empty pixel with material on most sides, or on two that face each other, is
    # no void, nor is what is then left where an empty row crosses an empty column.
    for crossing in (False, True):
        padded = numpy.pad(mean, 1, constant_values=numpy.nan)
        around = numpy.stack([padded[1 + i:padded.shape[0] - 1 + i, 1 + j:padded.shape[1] - 1 + j]
                              for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)])
        known = numpy.isfinite(around)
        between = known.sum(axis=0) >= 5
        between |= (known[1] & known[6]) | (known[3] & known[4])
        bridge = numpy.isnan(mean) & (known.all(axis=0) if crossing else between)
        mean[bridge] = numpy.where(known, around, 0.0).sum(axis=0)[bridge] / known.sum(axis=0)[bridge]
    return mean.T, spans


def read_slice(path):
    """The plane piece of a snapshot that is drawn."""
    piece = slice_of(reader.read_particles(path, ("position", "temperature", "mass", "density")))
    if len(piece[0]) == 0:
        raise reader.Missing(f"{path.name} holds no particles")
    return piece


def common_extent(pieces):
    """Lateral and axial range of all pieces, half a particle beyond the outermost ones, so that these do
    not lie on the edges of pixels."""
    half = 0.5 * max(piece[3] for piece in pieces)
    return [(min(piece[axis].min() for piece in pieces) - half, max(piece[axis].max() for piece in pieces) + half)
            for axis in (0, 1)]


def panel_size(width, height):
    """Width and height in inches of one panel of a sample of this shape, and whether it is to scale."""
    high = numpy.clip(4.5 * height / width, 1.5, 7.0)
    if high * width / height >= 0.5:
        return high * width / height, high, True
    return 0.9, high, False  # so narrow that it is stretched


def temperature(folder):
    """Snapshots side by side, coloured by temperature (Figure 1 of the paper)."""
    times = reader.snapshot_times(folder)
    return temperature_panels([times[i] for i in choose_snapshots(times)])


def temperature_panels(snapshots):
    """The snapshots, a list of (time, path), side by side on one scale of temperature."""
    chosen = [(time, read_slice(path)) for time, path in snapshots]
    extent = common_extent([piece for _, piece in chosen])
    width, height = (high - low for low, high in extent)
    pixel = max(max(piece[3] for _, piece in chosen), max(width, height) / 1500.0)
    everything = numpy.concatenate([piece[2] for _, piece in chosen])
    low, high = everything.min(), numpy.percentile(everything, 99.5)
    low = min(low, high - 1.0)

    panel, tall, to_scale = panel_size(width, height)
    figure, axes = plt.subplots(1, len(chosen), sharey=True, squeeze=False,
                                layout="compressed" if to_scale else "constrained",
                                figsize=((panel + 0.15) * len(chosen) + 2.0, tall + 1.0))
    for axis, (time, piece) in zip(axes[0], chosen):
        mean, spans = pixel_mean(piece[0], piece[1], piece[2], extent, pixel)
        image = axis.imshow(mean, origin="lower", extent=[1e3 * end for span in spans for end in span],
                            cmap="turbo", vmin=low, vmax=high, interpolation="nearest",
                            aspect="equal" if to_scale else "auto")
        axis.set(title=f"{1e9 * time:.4g} ns",
                 xlim=[1e3 * end for end in extent[0]], ylim=[1e3 * end for end in extent[1]])
        axis.grid(False)
        axis.locator_params(axis="x", nbins=3 if panel > 0.8 else 1)
    axes[0][0].set_ylabel("along the shock axis [mm]")
    axes[0][len(chosen) // 2].set_xlabel("across [mm]" + ("" if to_scale else ", stretched"))
    figure.colorbar(image, ax=axes, label="temperature [K]", extend="max", shrink=0.8, pad=0.01)
    return figure


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


def morphology_time(folder, start):
    """A, L and chi of the hot area against time (Figure 2 of the paper)."""
    time, threshold, arrays = reader.read_morphology(folder)
    shown, title = shown_thresholds(folder, threshold, start)
    figure, axes = plt.subplots(3, 1, sharex=True, figsize=(7.0, 8.4), layout="constrained")
    labels = {"A": "area $A$ [-]", "L": "boundary length $L$ [-]",
              "chi": r"Euler characteristic $\chi$ [-]"}
    for axis, (name, label) in zip(axes, labels.items()):
        for i, rise in shown:
            axis.plot(1e9 * time, arrays[name][:, i], label=rise)
        axis.set_ylabel(label)
    axes[0].legend(title=title, ncols=3, loc="upper left")
    axes[0].set_ylim(-0.02, 1.05)
    axes[-1].set_xlabel("time [ns]")
    return figure


def morphology_space(folder, start):
    """The same curves in the space of A, L and chi (Figure 3 of the paper)."""
    time, threshold, arrays = reader.read_morphology(folder)
    shown, title = shown_thresholds(folder, threshold, start)
    figure = plt.figure(figsize=(7.0, 5.6), layout="constrained")
    axis = figure.add_subplot(projection="3d")
    for i, rise in shown:
        axis.plot(arrays["A"][:, i], arrays["L"][:, i], arrays["chi"][:, i], marker="o",
                  markersize=2.5, linewidth=1.2, label=rise)
    axis.set_xlabel("$A$", labelpad=8)
    axis.set_ylabel("$L$", labelpad=10)
    axis.set_zlabel(r"$\chi$", labelpad=14)
    axis.tick_params(axis="z", pad=6)
    axis.locator_params(nbins=5)
    axis.view_init(elev=22, azim=-58)
    axis.set_box_aspect(None, zoom=0.82)
    axis.legend(title=title, loc="upper left")
    return figure


def unresolved(folder, start):
    """Labels of the thresholds at which chi4 and chi differ by a quarter of chi or more on the average over the run."""
    _, threshold, arrays = reader.read_morphology(folder, names=("chi", "chi4"))
    shares = reader.read_levels(folder) is not None
    found = []
    for i, label in shown_thresholds(folder, threshold, start)[0]:
        apart = numpy.abs(arrays["chi4"][:, i] - arrays["chi"][:, i]).mean()
        if apart > 0.25 * numpy.abs(arrays["chi"][:, i]).mean():
            found.append(f"the quantile {label}" if shares else f"{label} above the start")
    return found


def hot_spots(folder, start):
    """Number of hot spots above a size, and size against peak, by level."""
    level, size, peak, dimension, time = reader.read_hot_spots(folder)
    diameter = 2e6 * (numpy.sqrt(size / numpy.pi) if dimension == 2 else numpy.cbrt(0.75 * size / numpy.pi))
    figure, axes = plt.subplots(1, 2, figsize=(8.4, 3.9), layout="constrained")
    for value in numpy.unique(level):
        own = numpy.sort(diameter[level == value])[::-1]
        axes[0].loglog(own, numpy.arange(1, len(own) + 1), drawstyle="steps-post", label=f"{value - start:.4g} K")
        axes[1].loglog(diameter[level == value], peak[level == value] - start, ".", markersize=3)
    same = "area" if dimension == 2 else "volume"
    axes[0].set(xlabel=rf"diameter of equal {same} [$\mu$m]", ylabel="hot spots at least as large",
                title=f"at {1e9 * time:.4g} ns")
    axes[1].set(xlabel=rf"diameter of equal {same} [$\mu$m]", ylabel=f"peak - {start:.4g} K [K]")
    axes[0].legend(title=f"threshold - {start:.4g} K", fontsize=9)
    return figure


def drift(columns):
    """|total - first total| / |first total| of each row of the history."""
    total = columns["total"]
    if total[0] == 0.0:
        raise reader.Missing("the total energy starts at zero, so its drift has no scale")
    return numpy.abs(total - total[0]) / abs(total[0])


LEDGER = ("total", "kinetic", "internal", "escaped", "wall_work", "body_work")
SPLITS = ("elastic", *reader.HEATS, "conduction")


def energy(folder):
    """The energy ledger: sums, splits and the drift of the total."""
    columns, units = reader.read_history(folder)
    missing = [name for name in ("time", "total", "kinetic", "internal") if name not in columns]
    if missing:
        raise reader.Missing(f"history.csv has no column {', '.join(missing)}")
    time, unit = 1e9 * columns["time"], units["total"]
    figure, axes = plt.subplots(3, 1, sharex=True, figsize=(7.0, 9.2), layout="constrained")
    for axis, names in zip(axes, (LEDGER, SPLITS)):
        # A column of zeros (no contact, nothing escaped) only crowds the legend.
        for name in names:
            if name in columns and (numpy.any(columns[name]) or name in LEDGER[:3]):
                axis.plot(time, columns[name], label=name.replace("_", " "))
        axis.set_ylabel(f"energy [{unit}]")
        if axis.lines:
            axis.legend(ncols=2, fontsize=9)
    off = drift(columns)
    axes[2].semilogy(time, numpy.where(off > 0.0, off, numpy.nan), color=COLOURS[0])
    axes[2].set(xlabel="time [ns]", ylabel="|total / first total - 1|")
    if not numpy.any(off > 0.0):
        axes[2].set(yscale="linear", ylim=(0.0, 1.0))
        axes[2].text(0.5, 0.5, "no drift: every total has the bits of the first",
                     ha="center", transform=axes[2].transAxes)
    return figure
