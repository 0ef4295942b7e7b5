"""One page with two runs side by side."""
import html

import numpy

from . import comparison_figures, markup, summary
from . import folder as reader

LAST = {"particles": "particles", "step": "steps", "time": "time [s]"}  # columns of the history
SPEED = {"ranks": "ranks", "wall_seconds": "wall time [s]", "rate_per_core": "particle steps per second and core"}


def flat(table, path=""):
    """{dotted key: value} of nested tables and lists of tables."""
    found = {}
    for key, value in table.items():
        if isinstance(value, dict):
            found |= flat(value, f"{path}{key}.")
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            for i, entry in enumerate(value):
                found |= flat(entry, f"{path}{key}.{i}.")
        else:
            found[path + key] = value
    return found


def short(value):
    """Text of a value of a scene; long lists are cut."""
    text = "not there" if value is None else str(value)
    return text if len(text) < 60 else text[:56] + " ..."


def scene_differences(scenes):
    """Rows (key, first, second) of the keys that differ."""
    first, second = (flat(scene) for scene in scenes)
    return [(key, short(first.get(key)), short(second.get(key))) for key in sorted(first | second)
            if first.get(key) != second.get(key)]


def numbers(folder):
    """{name: (value, text)} of what came out of a run, in the order in which it is shown; what is missing is left out."""
    found = {}
    try:
        for name, measured, error, *_ in summary.shock_rows(folder)[1]:
            found[name] = float(measured), measured if error == "-" else f"{measured} +- {error}"
    except reader.Missing:
        pass
    try:
        columns, _ = reader.read_history(folder)
        found |= {f"heat: {label}": (share, f"{100.0 * share:.1f} %") for label, share in summary.heat_shares(columns).items()}
        share = reader.numerical_share(columns)[-1]
        found["numerical dissipation"] = share, f"{100.0 * share:.1f} %"
        found |= {label: (columns[name][-1], markup.number(columns[name][-1])) for name, label in LAST.items()}
        found["largest energy drift"] = numpy.nan, f"{reader.drift(columns).max():.1e}"
    except (reader.Missing, KeyError):
        pass
    try:
        timings = reader.read_timings(folder)
        found |= {label: (timings[name], markup.number(timings[name])) for name, label in SPEED.items() if name in timings}
    except reader.Missing:
        pass
    return found


def number_rows(folders):
    """Rows (name, first, second, difference in percent of the first)."""
    first, second = (numbers(folder) for folder in folders)
    rows = []
    for name in first | second:
        values = [run.get(name, (numpy.nan, "-")) for run in (first, second)]
        known = all(numpy.isfinite(value) for value, _ in values) and values[0][0] != 0.0
        rows.append((name, values[0][1], values[1][1],
                     f"{100.0 * (values[1][0] / values[0][0] - 1.0):+.2f} %" if known else "-"))
    if not rows:
        raise reader.Missing("neither run has a history, profiles or timings")
    return rows


def read_scenes(folders):
    """The scenes of both runs, empty where they cannot be read."""
    scenes = []
    for folder in folders:
        try:
            scenes.append(reader.read_scene(folder))
        except reader.Missing:
            scenes.append({})
    return scenes


def write(first, second):
    """Writes SECOND/compared_with_FIRST.html and its pictures; returns the path of the page."""
    folders = first, second
    names = [folder.resolve().name for folder in folders]
    if names[0] == names[1]:
        names = [str(folder) for folder in folders]
    scenes = read_scenes(folders)
    start = float((scenes[0].get("material") or [{}])[0].get("T0", 300.0))
    prefix = f"compared_with_{first.resolve().name}"

    def drawn(name, title, caption, draw):
        return markup.picture(second, f"{prefix}_{name}", title, caption, draw)

    parts = [f"<p>{html.escape(name)}: {html.escape(summary.what(folder, scene))}</p>{summary.warning_list(folder, scene, start)}"
             for name, folder, scene in zip(names, folders, scenes)]
    parts += [
        markup.section("What came out", lambda: markup.table(("", *names, "difference"), number_rows(folders))),
        markup.section("What differs in the scenes", lambda: markup.table(("key", *names), scene_differences(scenes))
                       if scene_differences(scenes) else "<p>Nothing: the scenes are the same.</p>"),
        drawn("temperature", "Temperature", "The last time that both runs have a snapshot of, on one scale.",
              lambda: comparison_figures.temperature(folders, names)),
        drawn("morphology", "Morphology against time", "Functionals of the region hotter than the threshold, per material pixel.",
              lambda: comparison_figures.morphology(folders, names, start)),
        drawn("profiles", "Profiles along the shock axis", "Averages over rows of cells at the last time that both runs have.",
              lambda: comparison_figures.profiles(folders, names)),
        drawn("front", "Path of the front", "Where the row mean of the velocity first is half of the way to the wall's.",
              lambda: comparison_figures.front(folders, names)),
    ]
    path = second / f"{prefix}.html"
    path.write_text(markup.document(f"{names[1]} compared with {names[0]}", parts))
    return path
