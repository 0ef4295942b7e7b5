"""Pictures of runs with several grains: the grains beside their temperature, and contact against time."""
import numpy

from . import figures
from . import folder as reader
from .style import HEAT, plt

CONTACT = ("contact_nodes", "crowded_nodes", "least_gap", "penetration", "momentum_residual")
SHADES = 12  # grains of neighbouring numbers get different ones


def present(folder):
    """True when the run has grains that can touch: its history then has columns of contact."""
    try:
        return CONTACT[0] in reader.read_history(folder)[0]
    except reader.Missing:
        return False


def outlined(values, grain):
    """The values without the pixels at which a grain ends, so that grains of like colour stay apart."""
    edge = numpy.zeros(values.shape, bool)
    edge[:, 1:] |= (grain[:, 1:] != grain[:, :-1]) & numpy.isfinite(grain[:, 1:] + grain[:, :-1])
    edge[1:] |= (grain[1:] != grain[:-1]) & numpy.isfinite(grain[1:] + grain[:-1])
    return numpy.where(edge, numpy.nan, values)


def maps(state, piece, extent, pixel, scale):
    """[(pixels, colours, range)] of one snapshot by grain, by velocity field where it has them, and by temperature; and
    the spans of the pixels."""
    across, along, temperature, _ = piece
    grain = last_on_pixels(across, along, state["grain"].astype(float), extent, pixel)
    # Seven steps in a circle of twelve keep grains of neighbouring numbers apart.
    found = [(outlined(grain * 7 % SHADES, grain), "Paired", (-0.5, SHADES - 0.5))]
    if "colour" in state:
        fields = last_on_pixels(across, along, state["colour"].astype(float), extent, pixel)
        found.append((outlined(fields, grain), "tab20", (-0.5, 19.5)))
    mean, spans = figures.pixel_mean(across, along, temperature, extent, pixel)
    return [*found, (mean, HEAT, scale)], spans


def read_states(snapshots):
    """Particles of snapshots, with their velocity fields where all of them have these."""
    names = ("position", "temperature", "mass", "density", "grain")
    coloured = all(reader.has_dataset(path, "colour") for _, path in snapshots)
    return [reader.read_particles(path, names + (("colour",) if coloured else ())) for _, path in snapshots]


def grains(folder):
    """First, middle and last snapshot: by grain, by velocity field where the snapshots have it, by temperature."""
    times = reader.snapshot_times(folder)
    chosen = [times[i] for i in sorted({0, len(times) // 2, len(times) - 1})]
    states = read_states(chosen)
    if states[0]["position"].shape[1] != 2:
        raise reader.Missing("grains are drawn in 2-D only")
    pieces = [figures.slice_of(state) for state in states]
    if not all(len(piece[0]) for piece in pieces):
        raise reader.Missing("a snapshot holds no particles")
    extent, scale = figures.common_extent(pieces, figures.sizes_of(folder)[0]), figures.common_scale(pieces)
    width, height = (high - low for low, high in extent)
    panel, tall, to_scale = figures.panel_size(width, height)
    count = 3 if "colour" in states[0] else 2
    figure, axes = plt.subplots(count, len(chosen), sharex=True, sharey=True, squeeze=False, layout="compressed",
                                figsize=((panel + 0.15) * len(chosen) + 2.0, count * tall + 1.5))
    for column, ((time, _), state, piece) in enumerate(zip(chosen, states, pieces)):
        found, spans = maps(state, piece, extent, max(piece[3], max(width, height) / 1500.0), scale)
        for axis, (cells, colours, (low, high)) in zip(axes[:, column], found):
            image = axis.imshow(cells, origin="lower", extent=[1e3 * end for pair in spans for end in pair], cmap=colours,
                                vmin=low, vmax=high, interpolation="nearest", aspect="equal" if to_scale else "auto")
            axis.grid(False)
        axes[0][column].set_title(f"{1e9 * time:.4g} ns")
        axes[-1][column].set_xlabel("across [mm]")
    for row in axes:
        row[0].set_ylabel("along the shock axis [mm]")
    figure.colorbar(image, ax=axes[-1], label="temperature [K]")
    return figure


def last_on_pixels(across, along, values, extent, pixel):
    """On each square pixel the value of one of its particles, NaN without any: a mean of grain numbers is no grain."""
    shape = [max(1, int(numpy.ceil((high - low) / pixel - 1e-6))) for low, high in extent]
    cells = numpy.full(shape, numpy.nan)
    index = [numpy.clip(((place - low) / pixel).astype(int), 0, count - 1)
             for place, (low, _), count in zip((across, along), extent, shape)]
    cells[index[0], index[1]] = values
    # The same pixels are bridged as in the map of temperatures, from the side that has a particle.
    filled = numpy.isfinite(figures.pixel_mean(across, along, values, extent, pixel)[0].T)
    for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
        cells = numpy.where(filled & numpy.isnan(cells), numpy.roll(cells, step, axis), cells)
    return cells.T


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
