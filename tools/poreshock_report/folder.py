"""Reads what a run left in its output folder. Every reader raises Missing with the reason."""
import csv
import json
import re
import tomllib

import h5py
import numpy


class Missing(Exception):
    """Something the report would show is not there; the text says what and why."""


def read_scene(folder):
    """The resolved scene as nested tables."""
    path = folder / "scene.toml"
    if not path.exists():
        raise Missing("there is no scene.toml")
    try:
        return tomllib.loads(path.read_text(errors="replace"))
    except tomllib.TOMLDecodeError as error:
        raise Missing(f"scene.toml cannot be read: {error}") from None


def follows_front(scene):
    """Whether the domain of a run is a window that follows the front."""
    return scene.get("time", {}).get("follow") == "front"


def read_timings(folder):
    """timings.json; `phases` becomes a list of (name, min, avg, max, calls), numbers that are null NaN."""
    path = folder / "timings.json"
    if not path.exists():
        raise Missing("there is no timings.json (it is written at the end of a run)")
    try:
        timings = json.loads(path.read_text(errors="replace"))
        phases = timings.get("phases", [])
        if isinstance(phases, dict):
            phases = [{"name": name, **phase} for name, phase in phases.items()]
        keys = ("min", "avg", "max", "calls")
        known = {key: numpy.nan if value is None else value for key, value in timings.items()}
        return known | {"phases": [
            (phase["name"], *(numpy.nan if phase.get(key) is None else phase[key] for key in keys))
            for phase in phases]}
    except (json.JSONDecodeError, AttributeError, KeyError, TypeError) as error:
        raise Missing(f"timings.json cannot be read: {error}") from None


def molten_share(folder):
    """Share of the mass that is molten in the newest snapshot; None where nothing can melt."""
    try:
        newest = snapshot_times(folder)[-1][1]
    except Missing:
        return None
    with h5py.File(newest, "r") as file:
        particles = file.get("particles", {})
        if "molten" not in particles or "mass" not in particles:
            return None
        return float(numpy.average(particles["molten"][...], weights=particles["mass"][...]))


def read_history(folder):
    """Columns of history.csv by name, and their units by name."""
    path = folder / "history.csv"
    if not path.exists():
        raise Missing("there is no history.csv")
    with path.open(newline="", errors="replace") as file:
        rows = list(csv.reader(file))
    titles = [re.fullmatch(r"\s*(\w+)\s*(?:\[(.*)\])?\s*", title) for title in (rows or [[]])[0]]
    if not titles or None in titles:
        raise Missing("the first line of history.csv does not name the columns as 'name [unit]'")
    values = []
    for row in rows[1:]:
        try:
            numbers = [float(entry) for entry in row]
        except ValueError:
            continue  # the last row of a killed run may be cut
        if len(numbers) == len(titles):
            values.append(numbers)
    if not values:
        raise Missing("history.csv holds no rows")
    columns = {title[1]: column for title, column in zip(titles, numpy.array(values).T)}
    return columns, {title[1]: title[2] or "-" for title in titles}


NUMERICAL = ("filter_heat", "step_heat", "contact_heat")
HEATS = ("plastic_work", "viscous_heat", "wall_heat", "friction_heat", *NUMERICAL)


def numerical_share(columns):
    """Heat of the transfers, of steps and of impulses of grains beside walls as a share of all heat, row by row
    of a history; NaN where there is no heat yet."""
    heat = sum(columns[name] for name in HEATS)
    numerical = sum(columns[name] for name in NUMERICAL)
    return numpy.where(heat > 0.0, numerical / numpy.where(heat > 0.0, heat, 1.0), numpy.nan)


def drift(columns):
    """|total - first total| / |first total| of each row of the history."""
    total = columns["total"]
    if total[0] == 0.0:
        raise Missing("the total energy starts at zero, so its drift has no scale")
    return numpy.abs(total - total[0]) / abs(total[0])


def snapshot_times(folder):
    """Sorted list of (time, path) of the snapshots that can be read."""
    found = []
    for path in sorted(folder.glob("snapshot_*.h5")):
        try:
            with h5py.File(path, "r") as file:
                found.append((float(numpy.ravel(file.attrs["time"])[0]), path))
        except (OSError, KeyError):
            continue  # not one of ours, or cut short
    if not found:
        raise Missing("there is no snapshot_*.h5 that can be read")
    return sorted(found)


def has_dataset(path, name):
    """Whether a snapshot that can be read holds /particles/NAME."""
    try:
        with h5py.File(path, "r") as file:
            return name in file["particles"]
    except (OSError, KeyError):
        return False


def read_particles(path, names):
    """Datasets of /particles of a snapshot by name."""
    try:
        with h5py.File(path, "r") as file:
            return {name: file["particles"][name][()] for name in names}
    except (OSError, KeyError) as error:
        raise Missing(f"{path.name} cannot be read: {error}") from None


def _spots_of(path, field):
    """Hot spots of the record of a file that has the most of them: (number, columns, time), or None without any."""
    with h5py.File(path, "r") as file:
        group = file[field]["domains"]
        record = group["record"][()]
        if len(record) == 0:
            return None
        most = numpy.bincount(record).argmax()
        size = "area" if "area" in group else "volume"
        columns = [group[name][()][record == most] for name in ("threshold", size, "peak")]
        times, records = (numpy.ravel(file[field][name][()]) for name in ("time", "record"))
        return len(columns[0]), columns + [2 if size == "area" else 3], float(times[records == most][0])


def read_hot_spots(folder, field="temperature"):
    """Level (in the unit of the field), area (m^2) or volume (m^3) and peak of all hot spots of the record with the
    most of them, the number of dimensions, and the time of the record (s)."""
    whole = folder / "morphology.h5"
    paths = [whole] if whole.exists() else sorted(folder.glob("morphology_*.h5"))
    best = None
    for path in paths:
        try:
            found = _spots_of(path, field)
        except (OSError, KeyError, IndexError, ValueError):
            continue  # not one of ours, cut short, or without a list
        if found and (best is None or found[0] > best[0]):
            best = found
    if best is None:
        raise Missing("no record lists hot spots (the scene needs [morphology] hot_spots)")
    return *best[1], best[2]


def _read_records(path, field, names):
    with h5py.File(path, "r") as file:
        group = file[field]
        time = numpy.ravel(group["time"][()])
        threshold = numpy.ravel(group["threshold"][()])
        shape = (len(time), len(threshold))
        return time, threshold, {name: group[name][()].reshape(shape) for name in names}


def read_morphology(folder, field="temperature", names=("A", "L", "chi")):
    """Times (n), thresholds (K, in the unit of the field, or quantiles) and the named arrays (n x K) of a field."""
    whole = folder / "morphology.h5"
    paths = [whole] if whole.exists() else sorted(folder.glob("morphology_*.h5"))
    if not paths:
        raise Missing("there is no morphology.h5 and no morphology_*.h5 "
                      "(the scene needs [morphology] every > 0)")
    records, problem = [], ""
    for path in paths:
        try:
            records.append(_read_records(path, field, names))
        except (OSError, KeyError, ValueError) as error:
            problem = f"{path.name} holds no '{field}' with {', '.join(names)}: {error}"
    if not records:
        raise Missing(problem)
    threshold = records[0][1]
    records = [record for record in records if numpy.array_equal(record[1], threshold)]
    time = numpy.concatenate([record[0] for record in records])
    order = numpy.argsort(time, kind="stable")
    arrays = {name: numpy.concatenate([record[2][name] for record in records])[order]
              for name in names}
    return time[order], threshold, arrays


def read_levels(folder, field="temperature"):
    """The values of a field (n x K) at thresholds that are quantiles; None where they are values themselves."""
    try:
        return read_morphology(folder, field, names=("level",))[2]["level"]
    except Missing:
        return None
