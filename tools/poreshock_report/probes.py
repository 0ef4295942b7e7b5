"""Section of the traces of the probes of a run, beside the exact trace of a plate, and what follows from them."""
import csv
import re

import h5py
import numpy

import plate_exact
import plate_release

from . import folder as reader
from .markup import missing, picture, table
from .style import plt

FIGURES = (("arrival", "arrival [ns]", 1e9), ("jump_off", "jump-off [m/s]", 1.0), ("pull_back", "pull-back [m/s]", 1.0),
           ("pull_back_time", "at [ns]", 1e9), ("spall_strength", "spall strength [GPa]", 1e-9))


def present(folder):
    """Whether the run has probes."""
    return any(folder.glob("probe_*.csv"))


def read(path):
    """Columns of a trace by name."""
    with path.open(newline="", errors="replace") as file:
        rows = list(csv.reader(file))
    names = [re.sub(r" \[.*\]", "", entry) for entry in (rows or [[]])[0]]
    values = [[float(entry) for entry in row] for row in rows[1:] if len(row) == len(names)]
    if "time" not in names or not values:
        raise reader.Missing(f"{path.name} holds no rows")
    return dict(zip(names, numpy.array(values).T))


def traces(folder):
    """Traces by the names of the probes."""
    found = {path.stem.removeprefix("probe_"): read(path) for path in sorted(folder.glob("probe_*.csv"))}
    if not found:
        raise reader.Missing("there is no probe_*.csv")
    return found


def exact(scene):
    """Times (s) and velocities (m/s) of the free surface of a solid plate that hits a wall; None for others."""
    sample, loading, boundary = (scene.get(name, {}) for name in ("sample", "loading", "boundary"))
    materials, speed = scene.get("material", []), loading.get("velocity", 0.0)
    plate = (sample.get("kind") == "solid" and len(materials) == 1 and speed > 0.0 and not scene.get("body")
             and not scene.get("void") and boundary.get("low", {}).get("kind") == "wall"
             and not boundary["low"].get("velocity") and boundary.get("high", {}).get("kind") == "free")
    if not plate or materials[0].get("strength", "linear") != "linear":
        return None
    material = plate_exact.material_from_scene(materials[0])
    thermal = scene.get("thermal", "conserving")
    try:
        waves = plate_exact.solve(material, speed, thermal)
    except ValueError:
        return None
    start = loading.get("frame", [0.0])[-1] - speed
    height = sample["height"]
    steps = [(height / waves.final.front, speed + plate_release.release(material, waves.final, thermal).gain)]
    if waves.precursor:
        steps.insert(0, (height / waves.precursor.front, 2.0 * waves.precursor.velocity))
    times, velocities = [0.0], [start]
    for time, gain in steps:
        times += [time, time]
        velocities += [velocities[-1], start + gain]
    return numpy.array(times), numpy.array(velocities)


def figure(folder):
    """Velocity along the shock axis, pressure and temperature of all probes against time."""
    scene, found = reader.read_scene(folder), traces(folder)
    kinds = {probe["name"]: probe.get("kind") for probe in scene.get("probe", [])}
    along = "velocity_z" if any("velocity_z" in trace for trace in found.values()) else "velocity_y"
    panels = ((along, "velocity [m/s]", 1.0), ("pressure", "pressure [GPa]", 1e-9), ("temperature", "temperature [K]", 1.0))
    picture, axes = plt.subplots(3, 1, sharex=True, figsize=(7.5, 8.4), layout="constrained", height_ratios=(3, 2, 2))
    for axis, (name, label, unit) in zip(axes, panels):
        for probe, trace in found.items():
            axis.plot(1e9 * trace["time"], unit * trace[name], linewidth=1.1, label=probe)
        axis.set_ylabel(label)
    ideal = exact(scene) if "surface" in kinds.values() else None
    if ideal:
        end = max(trace["time"][-1] for trace in found.values())
        times, velocities = numpy.append(ideal[0], max(end, ideal[0][-1])), numpy.append(ideal[1], ideal[1][-1])
        axes[0].plot(1e9 * times, velocities, "k--", linewidth=0.9, label="exact, until waves come back")
    axes[0].legend(fontsize=9)
    axes[-1].set_xlabel("time [ns]")
    return picture


def figures_table(folder):
    """Head and rows of what follows from the traces; Missing without probes.h5."""
    path = folder / "probes.h5"
    if not path.exists():
        raise reader.Missing("there is no probes.h5 (it is written at the end of a run)")
    with h5py.File(path, "r") as file:
        rows = [(name, *(unit * float(group["figures"][key][0]) for key, _, unit in FIGURES))
                for name, group in file.items()]
    return ("probe", *(label for _, label, _ in FIGURES)), [
        tuple("-" if isinstance(entry, float) and numpy.isnan(entry) else entry for entry in row) for row in rows]


def sections(folder):
    """Sections of a run with probes; none for others."""
    if not present(folder):
        return []
    parts = [picture(folder, "probes", "Probes", "What the probes saw. A surface or an interface is the material that lay there "
                     "at the start, averaged over the spot.", lambda: figure(folder))]
    try:
        parts.append(table(*figures_table(folder)))
    except reader.Missing as reason:
        parts.append(missing("figures of the traces", reason))
    return [*parts, '<p class="note">Arrival is when 40 % of the jump-off are reached; spall strength is half of the pull-back '
                    "times density and bulk sound speed at rest.</p>"]
