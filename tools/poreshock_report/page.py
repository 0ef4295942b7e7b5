"""Puts the pictures and the final numbers of an output folder into one self-contained page."""
import base64
import html
import io

import h5py
import matplotlib.pyplot as plt
import numpy

from . import figures
from . import folder as reader
from . import frames, grain_figures, profile_figures, profiles

STYLE = """
:root { color-scheme: light; }
body { font: 16px/1.5 system-ui, sans-serif; color: #1c1c1c; background: #fff; margin: 0 auto;
       max-width: 62rem; padding: 1rem; }
h1 { font-size: 1.5rem; line-height: 1.25; margin: .2rem 0; }
h2 { font-size: 1.15rem; margin: 2rem 0 .4rem; border-bottom: 1px solid #ccc; }
figure { margin: 0; } img { display: block; max-width: 100%; height: auto; margin: 0 auto; }
figcaption, .note { color: #444; font-size: .92rem; }
.missing { background: #fff4e0; border-left: 4px solid #d08700; padding: .4rem .8rem; }
.scroll { overflow-x: auto; } table { border-collapse: collapse; font-size: .92rem; }
th, td { text-align: left; padding: .25rem .8rem .25rem 0; border-bottom: 1px solid #e2e2e2; }
.hidden { display: none; } .slider { display: flex; gap: .8rem; align-items: center; margin: .4rem 0; }
.slider input { flex: 1; } .slider output { min-width: 5.5rem; font-variant-numeric: tabular-nums; }
#frames img { max-height: 85vh; width: auto; }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; }
@media print { .slider, #frames figure:not(:last-of-type) { display: none; } body { max-width: none; font-size: 11pt; padding: 0; }
               section { break-inside: avoid; } img { max-height: 22cm; } }
"""

THERMAL = {
    "paper": "Thermal mode: paper. Temperature is T_H(V) + W_p/c_v, as in the paper's equations 4-7; "
             "viscous and filter heat are counted in the ledger but do not warm the material.",
    "conserving": "Thermal mode: conserving. Temperature follows from the full internal energy, "
                  "and every joule of the ledger is kept.",
}


def number(value):
    """A number as text: whole numbers with spaces, others with five digits."""
    if isinstance(value, (int, numpy.integer)) or float(value).is_integer() and abs(value) < 1e15:
        return f"{int(value):,}".replace(",", " ")
    return f"{value:.5g}"


def missing(what, reason):
    return f'<p class="missing">Missing: {html.escape(what)}: {html.escape(str(reason))}.</p>'


def picture(folder, name, title, caption, draw):
    """Section with one picture, which is also saved as pictures/<name>.png."""
    head = f"<section><h2>{html.escape(title)}</h2>"
    try:
        figure = draw()
    except reader.Missing as reason:
        return head + missing(title, reason) + "</section>"
    data = io.BytesIO()
    figure.savefig(data, format="png", dpi=150, bbox_inches="tight", pad_inches=0.08)
    plt.close(figure)
    (folder / "pictures").mkdir(exist_ok=True)
    (folder / "pictures" / f"{name}.png").write_bytes(data.getvalue())
    code = base64.b64encode(data.getvalue()).decode()
    return (f'{head}<figure><img src="data:image/png;base64,{code}" alt="{html.escape(title)}">'
            f"<figcaption>{html.escape(caption)}</figcaption></figure></section>")


def frames_section(folder):
    """Section with the snapshots and their slider."""
    title = "Temperature, time by time"
    try:
        return f"<section><h2>{title}</h2>{frames.section(folder)}</section>"
    except reader.Missing as reason:
        return f"<section><h2>{title}</h2>{missing(title, reason)}</section>"


def resolution_note(folder, start):
    """A warning where chi depends on how pixels join, that is where the pattern is not resolved."""
    try:
        poor = figures.unresolved(folder, start)
    except reader.Missing:
        return ""
    if not poor:
        return ""
    return (f'<p class="note">Resolution warning: at {html.escape(", ".join(poor))}, chi4 (hot pixels join over '
            "sides) and chi (over corners too) differ by a quarter of chi or more while the run lasts: their pattern is "
            "not resolved by the pixels.</p>")


def table(head, rows):
    """HTML table; entries that are numbers are aligned to the right."""
    def cell(tag, entry):
        if isinstance(entry, str):
            return f"<{tag}>{html.escape(entry)}</{tag}>"
        return f'<{tag} class="number">{number(entry)}</{tag}>'

    body = ["<tr>" + "".join(cell("td", entry) for entry in row) + "</tr>" for row in rows]
    top = "<tr>" + "".join(f'<th{" class=number" if i else ""}>{html.escape(entry)}</th>'
                           for i, entry in enumerate(head)) + "</tr>" if head else ""
    return f'<div class="scroll"><table>{top}{"".join(body)}</table></div>'


def provenance(folder):
    """Version and revision that wrote the newest snapshot, or nothing."""
    try:
        with h5py.File(reader.snapshot_times(folder)[-1][1], "r") as file:
            texts = [file.attrs[name] for name in ("version", "revision") if name in file.attrs]
    except (reader.Missing, OSError):
        return []
    texts = [text.decode() if isinstance(text, bytes) else str(text) for text in texts]
    return [("program", "poreshock " + ", revision ".join(texts))] if texts else []


def final_numbers(folder, title, thermal):
    """The table of final numbers and the table of the phases."""
    rows = [("title", title), ("thermal mode", thermal), *provenance(folder)]
    notes = []
    try:
        columns, units = reader.read_history(folder)
        wanted = {"time": "simulated time", "step": "steps", "particles": "particles",
                  "total": "total energy", "guards": "guards (clamps and floors hit)"}
        for name, label in wanted.items():
            if name in columns:
                unit = "" if units[name] == "-" else f" [{units[name]}]"
                rows.append((label + unit, columns[name][-1]))
        if "total" in columns:
            off = figures.drift(columns)
            rows += [("energy drift at the end [-]", off[-1]), ("largest energy drift [-]", off.max())]
    except reader.Missing as reason:
        notes.append(missing("numbers of the history", reason))
    phases = ""
    try:
        timings = reader.read_timings(folder)
        wanted = {"ranks": "ranks", "wall_seconds": "wall time [s]",
                  "particle_steps": "particle steps",
                  "rate_per_core": "particle steps per second and core"}
        rows += [(label, timings[name]) for name, label in wanted.items() if name in timings]
        parts = sorted(timings["phases"], key=lambda part: -part[2])
        phases = "<h2>Time per phase</h2>" + table(
            ("phase", "least rank [s]", "mean [s]", "most [s]", "calls"), parts)
    except reader.Missing as reason:
        notes.append(missing("timings", reason))
    return ("<section><h2>Final numbers</h2>" + table((), rows) + "".join(notes) +
            f"</section><section>{phases}</section>")


def hugoniot_table(folder):
    """Section with the state behind the shock beside the Hugoniots."""
    title = "State behind the shock"
    try:
        rows, notes = profiles.compare(folder)
    except reader.Missing as reason:
        return f"<section><h2>{title}</h2>{missing(title, reason)}</section>"
    text = "".join(f'<p class="note">{html.escape(note)}</p>' for note in notes)
    return f"<section><h2>{title}</h2>{table(profiles.HEAD, rows)}{text}</section>"


def grain_sections(folder):
    """Sections of a run with several grains; none for others."""
    if not grain_figures.present(folder):
        return []
    return [picture(folder, "grains", "Grains", "Above: one shade for each grain, as many as there are in the palette. Then the "
                    "velocity field each particle is in, where the snapshots hold it: grains that meet never share one; "
                    "with contact.self the four fields face down, up, left and right. Below: temperature on one scale.",
                    lambda: grain_figures.grains(folder)),
            picture(folder, "contact", "Contact", "Nodes at which grains push each other, those at which more than two meet, "
                    "the least gap and the largest penetration of the step, and the heat so far.",
                    lambda: grain_figures.contact(folder))]


def numerical_note(folder):
    """Sentence on the numerical dissipation, empty where the history does not say."""
    try:
        share = reader.numerical_share(reader.read_history(folder)[0])[-1]
    except (reader.Missing, KeyError):
        return ""
    if not share == share:
        return ""
    return (f" Numerical dissipation, that is the heat of the velocity transfers and of the impulses between grains "
            f"without friction, is {100.0 * share:.3g} % of all heat at the end.")


def write(folder):
    """Writes report.html and pictures/ into `folder`; returns the path of the page."""
    notes = ""
    try:
        scene = reader.read_scene(folder)
    except reader.Missing as reason:
        scene, notes = {}, missing("scene", reason)
    title = str(scene.get("title") or folder.name)
    thermal = str(scene.get("thermal", "unknown"))
    materials = scene.get("material") or [{}]
    start = float(materials[0].get("T0", 300.0))
    parts = [
        picture(folder, "temperature", "Figure 1: temperature", "Particles coloured by temperature; "
                "one scale for all, up to the 99.5 percentile. The shock travels upwards from the wall.",
                lambda: figures.temperature(folder)),
        frames_section(folder),
        picture(folder, "morphology_time", "Figure 2: morphology against time", "Area A, boundary length L and "
                "Euler characteristic of the region hotter than the threshold, per material pixel.",
                lambda: figures.morphology_time(folder, start)),
        picture(folder, "morphology_space", "Figure 3: the A-L-chi space", "The curves of Figure 2 without "
                "the time; every record is a dot.", lambda: figures.morphology_space(folder, start)),
        resolution_note(folder, start),
        picture(folder, "hot_spots", "Hot spots", "Left: how many hot domains are at least as large. Right: size and peak of "
                "each, at the record with the most of them.", lambda: figures.hot_spots(folder, start)),
        picture(folder, "profiles", "Profiles along the shock axis", "Averages over rows of cells: velocity, "
                "temperature and fluctuation weighted with mass, stress with volume (compression positive). The "
                "fluctuation is the kinetic energy of the deviation from the mean velocity of the row.",
                lambda: profile_figures.profiles(folder)),
        picture(folder, "front", "Path of the front", "Where the row mean of the velocity, seen from the top, first "
                "is half of the way to the wall's; below: distance from the straight line.",
                lambda: profile_figures.front(folder)),
        *grain_sections(folder),
        hugoniot_table(folder),
        picture(folder, "energy", "Energy ledger", "Above: kinetic, internal and total energy. Middle: where the "
                "energy went. Below: how far the total is from its first value." + numerical_note(folder),
                lambda: figures.energy(folder)),
        final_numbers(folder, title, thermal),
    ]
    mode = THERMAL.get(thermal, f"Thermal mode: {thermal}.")
    page = (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
            f'<meta name="viewport" content="width=device-width, initial-scale=1">'
            f"<title>{html.escape(title)}</title><style>{STYLE}</style></head><body>"
            f'<h1>{html.escape(title)}</h1><p class="note">{html.escape(mode)}</p>{notes}'
            f'{"".join(parts)}</body></html>\n')
    path = folder / "report.html"
    path.write_text(page)
    return path
