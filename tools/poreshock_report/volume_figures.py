"""Pictures of three-dimensional runs: slices across the shock axis and the surface of the hot region."""
import h5py
import numpy

from . import figures, raycast
from . import folder as reader
from .style import HEAT, plt

HEIGHTS = 4  # slices, unless heights are chosen
LEAST_HOT = 0.005  # share of the material that must be above a level for its surface to be drawn
SURFACE = numpy.array((0.90, 0.45, 0.05))


def read_map(path, field="temperature"):
    """Voxels of a field (z, y, x), NaN without material, their low corner (x, y, z) and their edge, m."""
    try:
        with h5py.File(path, "r") as file:
            data = file[f"map/{field}"]
            return data[()], numpy.array([data.attrs[f"low_{axis}"] for axis in "xyz"]), float(data.attrs["pixel"])
    except KeyError:
        raise reader.Missing(f"{path.name} holds no map of {field} (the scene needs [morphology])") from None
    except OSError as error:
        raise reader.Missing(f"{path.name} cannot be read: {error}") from None


def slice_heights(height, temperature, wanted):
    """Heights of the slices: those that are wanted, m, or evenly spread over the material that is warmer than at first."""
    if wanted:
        return list(wanted)
    start = temperature.min()
    warm = height[temperature > start + 0.02 * (temperature.max() - start)]
    low, high = (warm.min(), warm.max()) if len(warm) else (height.min(), height.max())
    return [low + (high - low) * (i + 0.5) / HEIGHTS for i in range(HEIGHTS)]


def slices(folder, wanted=()):
    """Temperature of the last snapshot on planes across the shock axis, one and a quarter spacings to each side."""
    time, path = reader.snapshot_times(folder)[-1]
    particles = reader.read_particles(path, ("position", "temperature", "mass", "density"))
    position, temperature = particles["position"], particles["temperature"]
    if position.shape[1] != 3 or len(position) == 0:
        raise reader.Missing(f"{path.name} holds no particles in three dimensions")
    spacing = float(numpy.cbrt(numpy.median(particles["mass"] / particles["density"])))
    heights = slice_heights(position[:, 2], temperature, wanted)
    extent = [figures.within(position[:, axis], 0.5 * spacing, size) for axis, size in enumerate(figures.sizes_of(folder)[:2])]
    low, high = figures.common_scale([(None, None, temperature)])
    figure, axes = plt.subplots(1, len(heights), squeeze=False, sharey=True, layout="compressed",
                                figsize=(2.6 * len(heights) + 1.2, 3.4))
    for axis, height in zip(axes[0], heights):
        near = numpy.abs(position[:, 2] - height) < 1.25 * spacing
        mean, spans = figures.pixel_mean(position[near, 0], position[near, 1], temperature[near], extent, spacing)
        image = axis.imshow(mean, origin="lower", extent=[1e3 * end for span in spans for end in span], cmap=HEAT, vmin=low,
                            vmax=high, interpolation="nearest")
        axis.set(title=f"{1e3 * height:.3g} mm high", xlabel="x [mm]")
        axis.grid(False)
        axis.locator_params(nbins=3)
    axes[0, 0].set_ylabel(f"y [mm], at {1e9 * time:.4g} ns")
    figure.colorbar(image, ax=axes, label="temperature [K]", extend="max", shrink=0.8, pad=0.01)
    return figure


def level_of(folder, voxels):
    """Temperature whose surface is drawn: the lowest level of the hot spots that enough material has reached, or else the
    one that a tenth of the material has reached."""
    filled = voxels[numpy.isfinite(voxels)]
    try:
        listed = reader.read_scene(folder)["morphology"]["hot_spots"]
        listed = listed.get("temperature", []) if isinstance(listed, dict) else listed
    except (reader.Missing, KeyError):
        listed = []
    reached = [level for level in sorted(listed) if (filled >= level).mean() >= LEAST_HOT]
    return float(reached[0] if reached else numpy.quantile(filled, 0.9))


def hot_surface(folder):
    """The isosurface of the temperature at up to three times, seen from the side, inside the outline of the map."""
    times = reader.snapshot_times(folder)
    chosen = [times[i] for i in figures.choose_snapshots(times, most=3)]
    level = level_of(folder, read_map(chosen[-1][1])[0])
    figure, axes = plt.subplots(1, len(chosen), squeeze=False, layout="constrained", figsize=(3.2 * len(chosen), 6.0))
    for axis, (time, path) in zip(axes[0], chosen):
        voxels, low, edge = read_map(path)
        values = numpy.where(numpy.isfinite(voxels), voxels, voxels[numpy.isfinite(voxels)].min()).transpose(2, 1, 0)
        shade, window = raycast.shaded_surface(values, level)
        seen = numpy.isfinite(shade)[..., None]
        image = numpy.concatenate([numpy.nan_to_num(shade)[..., None] * SURFACE, seen], axis=2)  # clear where there is none
        axis.imshow(image, origin="lower", extent=window, zorder=2)
        for ends in raycast.outline(values.shape):
            axis.plot(*ends, color="#666666", linestyle="-", linewidth=0.7, zorder=1)
        for fraction in (0.0, 0.5, 1.0):
            across, up = raycast.project((values.shape[0], 0.0, fraction * values.shape[2]), values.shape)
            axis.text(across, up, f" {1e3 * (low[2] + fraction * values.shape[2] * edge):.3g} mm", fontsize=8, va="center")
        axis.set(title=f"{1e9 * time:.4g} ns", aspect="equal")
        axis.axis("off")
    figure.suptitle(f"hotter than {level:.5g} K", fontsize=11)
    return figure
