"""Maps of the temperature, each a function from what was read to a matplotlib figure."""
import numpy

from . import folder as reader
from .style import HEAT, plt

WIDEST = 12.0  # inches, of panels side by side
HOTTEST = 98.0  # percentile of the temperature at which its scale ends: jets are far hotter than all the rest


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


def within(positions, half, size=None):
    """Range of positions with `half` a particle beyond the outermost ones, so that these do not lie on the edges of pixels;
    0 to `size` where all are inside of it."""
    low, high = positions.min() - half, positions.max() + half
    return (0.0, size) if size and low >= -half and high <= size + half else (low, high)


def common_extent(pieces, width=None):
    """Lateral and axial range of all pieces, in a domain of this width (m) or of one that is not known."""
    half = 0.5 * max(piece[3] for piece in pieces)
    along = numpy.concatenate([piece[1] for piece in pieces])
    return [within(numpy.concatenate([piece[0] for piece in pieces]), half, width), within(along, half)]


def sizes_of(folder):
    """Edges of the domain of a run, m; None for each where its scene does not say."""
    try:
        return [float(size) for size in reader.read_scene(folder)["domain"]["size"]]
    except (reader.Missing, KeyError, TypeError, ValueError):
        return [None, None, None]


def common_scale(pieces):
    """Lowest temperature of all pieces, and the one at which the colours end."""
    everything = numpy.concatenate([piece[2] for piece in pieces])
    low = float(everything.min())
    return low, max(float(numpy.percentile(everything, HOTTEST)), low + 1.0)


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


def temperature_panels(snapshots, titles=None):
    """The snapshots, a list of (time, path), side by side on one scale of temperature; the titles say the time by default."""
    titles = titles or [f"{1e9 * time:.4g} ns" for time, _ in snapshots]
    chosen = [(time, read_slice(path)) for time, path in snapshots]
    extent = common_extent([piece for _, piece in chosen], sizes_of(snapshots[0][1].parent)[0])
    width, height = (high - low for low, high in extent)
    pixel = max(max(piece[3] for _, piece in chosen), max(width, height) / 1500.0)
    low, high = common_scale([piece for _, piece in chosen])

    panel, tall, to_scale = panel_size(width, height)
    shrink = min(1.0, WIDEST / (panel * len(chosen)))
    panel, tall = shrink * panel, (shrink if to_scale else 1.0) * tall
    figure, axes = plt.subplots(1, len(chosen), sharey=True, squeeze=False,
                                layout="compressed" if to_scale else "constrained",
                                figsize=((panel + 0.15) * len(chosen) + 2.0, tall + 1.0))
    for axis, title, (_, piece) in zip(axes[0], titles, chosen):
        mean, spans = pixel_mean(piece[0], piece[1], piece[2], extent, pixel)
        image = axis.imshow(mean, origin="lower", extent=[1e3 * end for span in spans for end in span],
                            cmap=HEAT, vmin=low, vmax=high, interpolation="nearest",
                            aspect="equal" if to_scale else "auto")
        axis.set(title=title,
                 xlim=[1e3 * end for end in extent[0]], ylim=[1e3 * end for end in extent[1]])
        axis.grid(False)
        axis.locator_params(axis="x", nbins=3 if panel > 0.8 else 1)
    axes[0][0].set_ylabel("along the shock axis [mm]")
    axes[0][len(chosen) // 2].set_xlabel("across [mm]" + ("" if to_scale else ", stretched"))
    figure.colorbar(image, ax=axes, label="temperature [K]", extend="max", shrink=0.8, pad=0.01)
    return figure
