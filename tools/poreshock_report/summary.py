"""What stands on top of the report: what was run, what came out, and what to beware of."""
import html

import numpy

from . import folder as reader
from . import markup, morphology_figures, profiles

SHOWN = ("Us [m/s]", "P [GPa]", "T [K]")  # rows of the Hugoniot table
HEAT = {"plastic work": ("plastic_work",), "artificial viscosity": ("viscous_heat",),
        "walls and friction": ("wall_heat", "friction_heat"), "velocity transfer (numerical)": ("filter_heat",),
        "steps and velocities changed between them (numerical)": ("step_heat",),
        "impulses of grains beside walls (numerical)": ("contact_heat",)}
MOST_NUMERICAL = 0.15  # share of all heat, as in the program's own warning
MOST_DRIFT = 1e-10
KINDS = {"random_voids": "a block with voids", "packed_grains": "packed grains", "voronoi_grains": "Voronoi grains",
         "image": "a sample from an image", "solid": "a solid block", "none": "bodies"}


def what(folder, scene):
    """Sentence that says what was run; empty where the scene does not."""
    try:
        return describe(folder, scene)
    except (KeyError, TypeError, ValueError):
        return ""


def describe(folder, scene):
    """Sentence that says what was run; KeyError where the scene lacks something."""
    domain, sample = scene.get("domain", {}), scene.get("sample", {})
    names = " and ".join(dict.fromkeys(str(material.get("name")) for material in scene.get("material", [])))
    if not domain or not names:
        return ""
    size = " x ".join(f"{1e3 * length:.4g}" for length in (*domain["size"][:-1], sample.get("height", domain["size"][-1])))
    kind = sample.get("kind", "none")
    text = f"{KINDS.get(kind, kind).capitalize()}, {size} mm, of {names}"
    if sample.get("porosity", 0.0) > 0.0 and kind not in ("solid", "none"):
        text += f", void fraction {sample['porosity']:.4g}"
    cell = f"cells of {1e6 * domain['cell']:.4g} um"
    if kind == "random_voids":
        cell += f" ({2.0 * sample['void_radius'] / domain['cell']:.3g} per void diameter)"
    text += f"; impact at {scene.get('loading', {}).get('velocity', 0.0):.5g} m/s; {cell}"
    transfer = scene.get("transfer", {})
    if transfer:
        text += f"; {str(transfer.get('velocity')).upper()} with {transfer.get('shape')} shape functions"
    try:
        columns, _ = reader.read_history(folder)
        text += (f"; {markup.number(columns['particles'][-1])} particles, {markup.number(columns['step'][-1])} steps, "
                 f"{1e9 * columns['time'][-1]:.5g} ns")
    except (reader.Missing, KeyError):
        pass
    return text + "."


def shock_rows(folder):
    """Head and rows of Us, P and T behind the shock, with the exact state of solid samples or the snow-plow of porous ones."""
    shock = profiles.measure(folder)
    porous = shock.voids > profiles.POROUS
    first = 5 if porous else 3
    name = "snow-plow" if porous else "exact" if shock.setting.linear else "solid"
    rows = {row[0]: (row[0], row[1], row[2], row[first], row[first + 1]) for row in profiles.table_rows(shock)}
    return ("", "run", "+-", name, "off by"), [rows[key] for key in SHOWN if key in rows]


def heat_shares(columns):
    """{label: share of all heat at the end} of those that are not zero, numerical ones last."""
    heat = sum(columns[name][-1] for name in reader.HEATS)
    if not heat > 0.0:
        raise reader.Missing("there is no heat yet")
    shares = {label: sum(columns[name][-1] for name in names) / heat for label, names in HEAT.items()}
    return {label: share for label, share in shares.items() if share != 0.0}


def heat(folder):
    """HTML of the split of heat and the numerical dissipation."""
    try:
        columns, _ = reader.read_history(folder)
        shares = heat_shares(columns)
    except KeyError as name:
        raise reader.Missing(f"history.csv has no column {name}") from None
    rows = "".join(f'<tr{" class=numerical" if "numerical" in label else ""}><td>{label}</td><td class="number">{100.0 * share:.1f} %'
                   f'</td><td><span class="bar" style="width:{max(0.0, 6.0 * share):.2f}rem"></span></td></tr>'
                   for label, share in shares.items())
    return (f'<h3>Heat until the end</h3><div class="scroll"><table>{rows}</table></div><p>Numerical dissipation: '
            f"<b>{100.0 * reader.numerical_share(columns)[-1]:.1f} %</b> of all heat.</p>")


def speed(folder):
    """Sentence on how fast the run was."""
    timings = reader.read_timings(folder)
    known = {key: timings.get(key, numpy.nan) for key in ("rate_per_core", "ranks", "wall_seconds")}
    return (f"{1e-6 * known['rate_per_core']:.2f} million particle steps per second and core, {known['ranks']} "
            f"rank{'' if known['ranks'] == 1 else 's'}, {known['wall_seconds']:.4g} s.")


def warnings_of_history(folder, scene):
    """What the history warns of."""
    columns, _ = reader.read_history(folder)
    found, cell = [], scene.get("domain", {}).get("cell", numpy.nan)
    if columns["time"][-1] < (1.0 - 1e-9) * scene.get("time", {}).get("end", 0.0):
        found.append(f"The run stands at {1e9 * columns['time'][-1]:.5g} ns; time.end is {1e9 * scene['time']['end']:.5g} ns.")
    if all(name in columns for name in reader.HEATS) and reader.numerical_share(columns)[-1] > MOST_NUMERICAL:
        found.append(f"Numerical dissipation is {100.0 * reader.numerical_share(columns)[-1]:.0f} % of all heat; above 15 % the "
                     f"cells are too coarse for the heat of this sample. Set domain.cell to {0.5 * cell:.3g} m or less.")
    if "total" in columns and reader.drift(columns).max() > MOST_DRIFT:
        found.append(f"The total energy drifts by {reader.drift(columns).max():.1e} of itself.")
    return found


def warnings(folder, scene, start):
    """Sentences: everything that the files of a run warn of."""
    found = []
    try:
        found += warnings_of_history(folder, scene)
    except (reader.Missing, KeyError):
        pass  # the energy section says so
    try:
        found += [str(text) for text in reader.read_timings(folder).get("warnings", [])]
    except (reader.Missing, TypeError):
        pass
    if (folder / "failed.h5").exists():
        found.append("The state of the run went bad; failed.h5 holds it.")
    try:
        poor = morphology_figures.unresolved(folder, start)
    except reader.Missing:
        poor = ""
    if poor:
        found.append(f"Resolution of the morphology: at {poor}, the Euler characteristics of hot pixels that join over "
                     "sides alone and over corners too differ by a quarter or more while the run lasts.")
    return found


def warning_list(folder, scene, start):
    """HTML of the warnings."""
    found = warnings(folder, scene, start)
    if not found:
        return '<p class="fine">No warnings.</p>'
    return "".join(f'<p class="warning">Warning: {html.escape(text)}</p>' for text in found)


def head(folder, scene, start, movie):
    """HTML of the summary; `movie` is that of the moving picture."""
    parts = [f"<p>{html.escape(what(folder, scene))}</p>"]
    for make in (lambda: "<h3>Behind the shock</h3>" + markup.table(*shock_rows(folder)), lambda: heat(folder),
                 lambda: f"<p>Speed: {html.escape(speed(folder))}</p>"):
        try:
            parts.append(make())
        except reader.Missing as reason:
            parts.append(f'<p class="note">Not here: {html.escape(str(reason))}.</p>')
    parts.append(warning_list(folder, scene, start))
    return f'<section class="top" id="summary"><div>{"".join(parts)}</div>{movie}</section>'
