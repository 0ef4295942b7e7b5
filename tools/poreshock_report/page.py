"""Puts the summary, the pictures and the final numbers of an output folder into one self-contained page."""
import html

import h5py

from . import (energy_figures, figures, frames, grain_figures, hugoniot_figures, markup, morphology_figures, probes,
               profile_figures, profiles, summary, volume_figures)
from . import folder as reader
from .markup import missing, picture, table

THERMAL = {
    "paper": "Thermal mode: paper. Temperature is T_H(V) + W_p/c_v, as in the paper's equations 4-7; "
             "viscous and filter heat are counted in the ledger but do not warm the material.",
    "conserving": "Thermal mode: conserving. Temperature follows from the full internal energy, "
                  "and every joule of the ledger is kept.",
}


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
        molten = reader.molten_share(folder)
        if molten is not None:
            rows.append(("molten share of the mass at the end [-]", molten))
        if "total" in columns:
            off = reader.drift(columns)
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
    """The state behind the shock beside the Hugoniots."""
    shock = profiles.measure(folder)
    return table(profiles.HEAD, profiles.table_rows(shock)) + "".join(
        f'<p class="note">{html.escape(note)}</p>' for note in shock.notes)


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


def temperature_sections(folder, drawn):
    """Sections with the temperature: some times side by side, and all with a slider; `drawn` gives the frames."""
    return [picture(folder, "temperature", "Figure 1: temperature", "Particles coloured by temperature; "
                    f"one scale for all, up to the {figures.HOTTEST:g} percentile. The shock travels upwards from the wall.",
                    lambda: figures.temperature(folder)),
            markup.section("Temperature, time by time", lambda: frames.section(drawn()))]


def volume_sections(folder, scene, heights):
    """Sections of a run in three dimensions; none for others."""
    if len(scene.get("domain", {}).get("size", ())) != 3:
        return []
    return [picture(folder, "slices", "Slices across the shock axis", "Temperature of the last snapshot at heights above the low "
                    "side; tools/report.py --heights chooses others.", lambda: volume_figures.slices(folder, heights)),
            picture(folder, "hot_surface", "Surface of the hot region", "Where the measured map of the temperature reaches a level, "
                    "lit from the upper left, inside the outline of the domain. Voids count as cold.",
                    lambda: volume_figures.hot_surface(folder))]


def morphology_sections(folder, start, follows):
    """Sections with what was measured of the hot regions; `follows` where the domain follows the front."""
    window = (" Only material in the window that follows the front counts; strips.h5 has the curves of each strip that it left "
              "behind, at the time when it was left." if follows else "")
    return [picture(folder, "morphology_time", "Figure 2: morphology against time", "Functionals of the region hotter than the "
                    "threshold, per material pixel, in 3-D per voxel. Where domains are counted, chi is the paper's: hot less cold domains; the "
                    "chi of the pixels counts every void as a hole in the hot region." + window,
                    lambda: morphology_figures.against_time(folder, start, follows)),
            picture(folder, "morphology_space", "Figure 3: the A-L-chi space", "The curves of Figure 2 without "
                    "the time; every record is a dot." + window, lambda: morphology_figures.space(folder, start, follows)),
            picture(folder, "hot_spots", "Hot spots", "Left: how many hot domains are at least as large. Right: size and peak of "
                    "each, at the record with the most of them." + window, lambda: morphology_figures.hot_spots(folder, start))]


def profile_sections(folder):
    """Sections with the profiles along the shock axis and the state behind the shock."""
    return [picture(folder, "profiles", "Profiles along the shock axis", "Averages over rows of cells: velocity, "
                    "temperature and fluctuation weighted with mass, stress with volume (compression positive). The "
                    "fluctuation is the kinetic energy of the deviation from the mean velocity of the row.",
                    lambda: profile_figures.profiles(folder)),
            picture(folder, "front", "Path of the front", "Where the row mean of the velocity, seen from the top, first "
                    "is half of the way to the wall's; below: distance from the straight line.",
                    lambda: profile_figures.front(folder)),
            markup.section("State behind the shock", lambda: hugoniot_table(folder)),
            picture(folder, "hugoniots", "Hugoniots", "The run beside the solid with strength, complete collapse without "
                    "strength (snow-plow) and P-alpha, whose voids collapse at the static crush pressure: that of hollow cylinders "
                    "in plane strain in 2-D, of hollow spheres in 3-D. Bars are standard errors of Us and the spread of Up and P.",
                    lambda: hugoniot_figures.hugoniots(folder))]


def write(folder, heights=()):
    """Writes report.html and pictures/ into `folder`, with slices at heights (m) of a run in 3-D; returns the path of the
    page."""
    notes = []
    try:
        scene = reader.read_scene(folder)
    except reader.Missing as reason:
        scene, notes = {}, [missing("scene", reason)]
    title = str(scene.get("title") or folder.name)
    thermal = str(scene.get("thermal", "unknown"))
    start = float((scene.get("material") or [{}])[0].get("T0", 300.0))
    try:
        shown = frames.draw_all(folder)
        drawn, movie = (lambda: shown), frames.movie(folder, shown)
    except reader.Missing:
        drawn, movie = (lambda: frames.draw_all(folder)), ""
    parts = [
        *notes,
        summary.head(folder, scene, start, movie),
        *temperature_sections(folder, drawn),
        *volume_sections(folder, scene, heights),
        *morphology_sections(folder, start, reader.follows_front(scene)),
        *profile_sections(folder),
        *probes.sections(folder),
        *grain_sections(folder),
        picture(folder, "energy", "Energy ledger", "Above: kinetic, internal and total energy. Middle: where the "
                "energy went. Below: how far the total is from its first value.",
                lambda: energy_figures.energy(folder)),
        f'<p class="note">{html.escape(THERMAL.get(thermal, f"Thermal mode: {thermal}."))}</p>',
        final_numbers(folder, title, thermal),
    ]
    path = folder / "report.html"
    path.write_text(markup.document(title, parts))
    return path
