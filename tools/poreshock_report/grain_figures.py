"""Pictures of runs with several grains: the grains beside their temperature, and contact against time."""
import matplotlib.pyplot as plt
import numpy

from . import figures
from . import folder as reader

CONTACT = ("contact_nodes", "crowded_nodes", "least_gap", "penetration", "momentum_residual")
SHADES = 12  # grains of neighbouring numbers get different ones
FIELDS = 8   # most velocity fields of a run


def present(folder):
    """True when the run has grains that can touch: its history then has columns of contact."""
    try:
        return CONTACT[0] in reader.read_history(folder)[0]
    except reader.Missing:
        return False


def grains(folder):
    """First, middle and last snapshot: by grain, by velocity field where the snapshots have it, by temperature."""
    times = reader.snapshot_times(folder)
    chosen = [times[i] for i in sorted({0, len(times) // 2, len(times) - 1})]
    names = ("position", "temperature", "mass", "density", "grain")
    coloured = all(reader.has_dataset(path, "colour") for _, path in chosen)
    states = [reader.read_particles(path, names + (("colour",) if coloured else ())) for _, path in chosen]
    if states[0]["position"].shape[1] != 2:
        raise reader.Missing("grains are drawn in 2-D only")
    pieces = [figures.slice_of(state) for state in states]
    if not all(len(piece[0]) for piece in pieces):
        raise reader.Missing("a snapshot holds no particles")
    extent = figures.common_extent(pieces)
    width, height = (high - low for low, high in extent)
    panel, tall, to_scale = figures.panel_size(width, height)
    hottest = max(numpy.percentile(piece[2], 99.5) for piece in pieces)
    coldest = min(min(piece[2].min() for piece in pieces), hottest - 1.0)
    count = 3 if coloured else 2
    figure, axes = plt.subplots(count, len(chosen), sharex=True, sharey=True, squeeze=False, layout="compressed",
                                figsize=((panel + 0.15) * len(chosen) + 2.0, count * tall + 1.5))
    for column, ((time, _), state, piece) in enumerate(zip(chosen, states, pieces)):
        pixel = max(piece[3], max(width, height) / 1500.0)
        # Seven steps in a circle of twelve keep grains of neighbouring numbers apart.
        shade = (state["grain"] * 7) % SHADES
        across, along = piece[0], piece[1]
        rows = [(shade, "Paired", (-0.5, SHADES - 0.5)), (piece[2], "turbo", (coldest, hottest))]
        if coloured:
            rows.insert(1, (state["colour"], "Set1", (-0.5, FIELDS + 0.5)))
        for axis, (values, colours, span) in zip(axes[:, column], rows):
            if colours != "turbo":
                cells, spans = last_on_pixels(across, along, values.astype(float), extent, pixel)
            else:
                cells, spans = figures.pixel_mean(across, along, values, extent, pixel)
            image = axis.imshow(cells, origin="lower", extent=[1e3 * end for pair in spans for end in pair], cmap=colours,
                                vmin=span[0], vmax=span[1], interpolation="nearest",
                                aspect="equal" if to_scale else "auto")
            axis.grid(False)
        axes[0][column].set_title(f"{1e9 * time:.4g} ns")
        axes[-1][column].set_xlabel("across [mm]")
    for row in axes:
        row[0].set_ylabel("along the shock axis [mm]")
    figure.colorbar(image, ax=axes[-1], label="temperature [K]")
    return figure


def last_on_pixels(across, along, values, extent, pixel):
    """On each square pixel the value of one of its particles, NaN without any: a mean of grain numbers is no grain."""
    shape = [max(1, int(numpy.ceil((high - low) / pixel))) for low, high in extent]
    cells = numpy.full(shape, numpy.nan)
    index = [numpy.clip(((place - low) / pixel).astype(int), 0, count - 1)
             for place, (low, _), count in zip((across, along), extent, shape)]
    cells[index[0], index[1]] = values
    # The same pixels are bridged as in the map of temperatures, from the side that has a particle.
    filled = numpy.isfinite(figures.pixel_mean(across, along, values, extent, pixel)[0].T)
    for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
        cells = numpy.where(filled & numpy.isnan(cells), numpy.roll(cells, step, axis), cells)
    return cells.T, [(low, low + count * pixel) for (low, _), count in zip(extent, shape)]


def contact(folder):
    """Contact nodes, gap and penetration, and the heat of contact and friction against time."""
    columns, units = reader.read_history(folder)
    missing = [name for name in CONTACT if name not in columns]
    if missing:
        raise reader.Missing(f"history.csv has no column {', '.join(missing)}")
    time, cell = 1e9 * columns["time"], reader.read_scene(folder)["domain"]["cell"]
    figure, axes = plt.subplots(3, 1, sharex=True, figsize=(7.0, 8.4), layout="constrained")
    for name in CONTACT[:2]:
        axes[0].plot(time, columns[name], label=name.replace("_", " "))
    axes[0].set_ylabel("nodes")
    for name in CONTACT[2:4]:
        length = numpy.where(numpy.isfinite(columns[name]), columns[name] / cell, numpy.nan)
        axes[1].plot(time, length, label=name.replace("_", " "))
    axes[1].set_ylabel("length [cells]")
    for name in ("contact_heat", "friction_heat"):
        axes[2].plot(time, columns[name], label=name.replace("_", " "))
    axes[2].set(ylabel=f"energy [{units['contact_heat']}]", xlabel="time [ns]")
    for axis in axes:
        axis.legend(fontsize=9)
    axes[0].set_title(f"largest momentum residual of a node: {columns['momentum_residual'].max():.1e}", fontsize=10)
    return figure
