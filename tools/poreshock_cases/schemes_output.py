"""Tables and pictures of speed against error."""
import csv

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot  # noqa: E402
import numpy  # noqa: E402

from poreshock_cases.collapse import THRESHOLDS  # noqa: E402

UM = 1e-6
JUDGED = (*(f"A({threshold} K)" for threshold in THRESHOLDS), "plastic work", "T(50 %)")
SHOWN = (f"L({THRESHOLDS[1]} K)",)
CHI = f"chi({THRESHOLDS[1]} K)"  # near zero: shown as it is


def relative(result, reference, name):
    """Error of one figure of the collapse, percent; that of T is relative to its rise."""
    value, _ = reference[name]
    return 100.0 * (result.figures[name] - value) / abs(value - (300.0 if name.startswith("T") else 0.0))


def void_error(result, reference):
    """Root mean square of the judged errors, percent."""
    if result.failed:
        return numpy.nan
    return float(numpy.sqrt(numpy.mean([relative(result, reference, name)**2 for name in JUDGED])))


def plate_error(result):
    """Root mean square of the errors in stress, temperature and plastic strain and of the noise, percent."""
    if result.failed:
        return numpy.nan
    return float(numpy.sqrt(numpy.mean([result.figures[name]**2 for name in
                                        ("stress", "temperature", "plastic strain", "noise")])))


def pareto(points):
    """Indices of the (cost, error) points that no cheaper point beats, by cost."""
    best, front = numpy.inf, []
    for index in sorted(range(len(points)), key=lambda i: points[i]):
        cost, error = points[index]
        if numpy.isfinite(cost) and error < best:
            best = error
            front.append(index)
    return front


def ordered(results):
    """Results by scheme, cell and particles per cell, coarse cells first."""
    names = list(dict.fromkeys(result.scheme.name for result in sorted(
        results, key=lambda result: result.scheme.name)))
    return sorted(results, key=lambda r: (names.index(r.scheme.name), -r.cell, r.per_cell))


def finished(results):
    """Those that ran to the end."""
    return [result for result in results if not result.failed]


def plate_table(results):
    """Lines of the plate's table."""
    front = finished(results)
    front = {id(front[i]) for i in pareto([(r.cost, plate_error(r)) for r in front])}
    lines = ["| scheme | cell um | particles | core s | stress % | T % | plastic strain % | noise % | overshoot % "
             "| energy drift | rms % | front |", "|---" * 12 + "|"]
    for r in ordered(results):
        head = f"| {r.scheme.name} | {r.cell / UM:g} | {r.per_cell} x {r.per_cell} "
        if r.failed:
            lines.append(head + f"| - | failed: {r.failed[:90]} " + "| " * 8 + "|")
            continue
        f = r.figures
        lines.append(head + f"| {r.cost:.2g} | {f['stress']:+.2f} | {f['temperature']:+.2f} | "
                     f"{f['plastic strain']:+.1f} | {f['noise']:.2f} | {f['overshoot']:.1f} | {f['drift']:.0e} | "
                     f"{plate_error(r):.2f} | {'*' if id(r) in front else ''} |")
    return lines


def void_table(results, reference):
    """Lines of the collapse's table."""
    front = finished(results)
    front = {id(front[i]) for i in pareto([(r.cost, void_error(r, reference)) for r in front])}
    lines = ["| scheme | cell um | particles | core s | " + " | ".join(f"{name} %" for name in JUDGED + SHOWN)
             + f" | {CHI} | mass > 80 GPa % | numerical dissipation % | guards | energy drift | rms % | front |",
             "|---" * (11 + len(JUDGED + SHOWN)) + "|"]
    for r in ordered(results):
        head = f"| {r.scheme.name} | {r.cell / UM:g} | {r.per_cell} x {r.per_cell} "
        if r.failed:
            lines.append(head + f"| - | failed: {r.failed[:90]} " + "| " * (6 + len(JUDGED + SHOWN)) + "|")
            continue
        lines.append(head + f"| {r.cost:.2g} | "
                     + " | ".join(f"{relative(r, reference, name):+.1f}" for name in JUDGED + SHOWN)
                     + f" | {r.figures[CHI]:.4f} | {100.0 * r.figures['mass above 80 GPa']:.3f} | "
                     f"{r.figures['numerical dissipation']:.1f} | {r.figures['guards']} | "
                     f"{r.figures['drift']:.0e} | {void_error(r, reference):.1f} | {'*' if id(r) in front else ''} |")
    return lines


def reference_lines(reference):
    """Sentences about the reference of the collapse, {figure: (value, error)}."""
    lines = ["Reference: [extrapolated from finer cells](void_reference.md).", "", "| figure | reference | +- |", "|---|---|---|"]
    return lines + [f"| {name} | {reference[name][0]:.5g} | {reference[name][1]:.2g} |" for name in (*JUDGED, *SHOWN, CHI)]


def draw(panel, results, error, title):
    """Error against cost, one line per scheme over its cells, and the front of all."""
    panel.set_prop_cycle(color=pyplot.get_cmap("tab20").colors)
    for name in dict.fromkeys(result.scheme.name for result in ordered(results)):
        mine = [r for r in results if r.scheme.name == name and r.per_cell == 2 and not r.failed]
        mine.sort(key=lambda r: r.cost)
        if mine:
            panel.plot([r.cost for r in mine], [error(r) for r in mine], "o-", markersize=4, linewidth=1, label=name)
    usable = finished(results)
    front = pareto([(r.cost, error(r)) for r in usable])
    panel.plot([usable[i].cost for i in front], [error(usable[i]) for i in front], color="black", linewidth=3, alpha=0.3,
               label="front", zorder=0)
    panel.set(xscale="log", yscale="log", xlabel="cost [core s]", ylabel="error [%]", title=title)
    panel.grid(True, which="both", alpha=0.25)


def write_rows(path, plates, voids, reference):
    """All numbers as CSV."""
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["case", "scheme", "cell [m]", "particles per cell", "cost [core s]", "rms error [%]",
                         "figure", "value", "failed"])
        for case, results, error in (("plate", plates, plate_error), ("voids", voids, lambda r: void_error(r, reference))):
            for r in ordered(results):
                for name, value in r.figures.items() or (("", ""),):
                    writer.writerow([case, r.scheme.name, r.cell, r.per_cell, f"{r.cost:.4g}",
                                     f"{error(r):.4g}", name, f"{value:.6g}" if name else "", r.failed[:90]])


def write(folder, plates, voids, reference):
    """table.md, results.csv and speed_vs_error.png."""
    folder.mkdir(parents=True, exist_ok=True)
    text = ["# Speed against error", "", "Made by `tools/speed_vs_error`. Cost: core seconds of the time loop. A star "
            "marks the front.", "",
            "## Plate, 1100 m/s, against the exact solution", "",
            "rms: of the errors in stress, temperature rise and plastic strain and of the noise.", "",
            *plate_table(plates), "", "## Collapsing voids, void fraction 0.2, 1500 m/s", "", *reference_lines(reference),
            "", f"Errors relative to the reference; rms: of {', '.join(JUDGED)}.", "", *void_table(voids, reference), "",
            "![error against cost](speed_vs_error.png)", ""]
    (folder / "table.md").write_text("\n".join(text))
    write_rows(folder / "results.csv", plates, voids, reference)
    figure, panels = pyplot.subplots(1, 2, figsize=(13, 6.2), layout="constrained")
    draw(panels[0], plates, plate_error, "Plate, 1100 m/s")
    draw(panels[1], voids, lambda r: void_error(r, reference), "Collapsing voids, 1500 m/s")
    panels[1].legend(fontsize=7, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    figure.savefig(folder / "speed_vs_error.png", dpi=90)
    pyplot.close(figure)
