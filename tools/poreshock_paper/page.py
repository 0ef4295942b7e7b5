"""Measures the runs of a study and writes the results page with its figures and tables."""
import csv
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

import numpy

from poreshock_paper import claims, figures, measures, plan

MOST_BYTES = 300_000  # of one picture


@dataclass
class Page:
    """The page being written: its folder and the markdown so far."""
    folder: Path
    parts: list = field(default_factory=list)

    def text(self, *paragraphs):
        self.parts += [paragraph + "\n" for paragraph in paragraphs]

    def picture(self, name, title, figure):
        """Saves a figure, with fewer dots where the file would be too large, and puts it on the page."""
        path = self.folder / f"{name}.png"
        for dots in (130, 100, 80, 60):
            figure.savefig(path, dpi=dots, pil_kwargs={"optimize": True})
            if path.stat().st_size <= MOST_BYTES:
                break
        figures.plt.close(figure)
        self.text(f"![{title}]({path.name})")

    def table(self, name, head, rows):
        """Writes a CSV table and returns it as markdown lines."""
        with (self.folder / f"{name}.csv").open("w", newline="") as file:
            csv.writer(file).writerows([head, *rows])

    def markdown(self, head, rows):
        lines = ["| " + " | ".join(entry.replace("|", "\\|") for entry in head) + " |", "|" + "---|" * len(head)]
        lines += ["| " + " | ".join(str(entry).replace("|", "\\|") for entry in row) + " |" for row in rows]
        self.text("\n".join(lines))


@dataclass
class Results:
    """Where the runs are, and what the figures share."""
    study: plan.Study
    runs: Path
    program: Path

    def folder(self, case):
        return self.runs / case.name

    def curves(self, case):
        return measures.curves(self.folder(case))

    def matched(self, name, reference, cases, levels, *options):
        """Matches of one sample."""
        return measures.matches(self.program, self.folder(reference), {key: self.folder(case) for key, case in cases.items()},
                                levels, self.runs / "compare" / f"{name}.h5", *options)

    def figure_4(self, porosity, levels, thermal):
        """Matches of all seeds at one void fraction, each seed against the reference of its own sample."""
        return [self.matched(f"{thermal}-p{porosity:g}-s{seed}", plan.reference(self.study, porosity, seed, thermal),
                             plan.figure_4(self.study, porosity, seed, thermal), levels) for seed in self.study.seeds]

    def figure_8(self, thermal, *options):
        return [self.matched(f"{thermal}-porosity-s{seed}", plan.reference(self.study, plan.LOW, seed, thermal),
                             plan.figure_8(self.study, seed, thermal), plan.LEVELS_8, *options) for seed in self.study.seeds]


def series_of(found, keys, levels):
    """Lists of (key, mean, deviation) by level."""
    return {level: [(key, *measures.mean_and_deviation(measures.over_seeds(found, key, level))) for key in keys]
            for level in levels}


def opening(page, results):
    study, parts = results.study, [f"{1e3 * results.study.width:g} mm wide", f"{1e6 * results.study.cell:g} um cells",
                                   f"voids of {1e6 * results.study.radius:g} um radius"]
    revision = subprocess.run([str(results.program), "--version"], text=True, capture_output=True, check=False).stdout.strip()
    page.text("# The paper's figures", f"\"Temperature pattern dynamics in shocked porous materials\", reproduced by "
              f"`tools/reproduce_paper`: {', '.join(parts)}, {len(study.seeds)} sample{'s' if len(study.seeds) > 1 else ''} of "
              f"each kind, thermal models {', '.join(study.thermals)}. {revision or ''}",
              "The paper does not state cell, void size, shape functions, artificial viscosity, lambda, gamma, pixels or "
              "neighbourhoods. Ours are in `input/paper/fig1.toml`; nothing is tuned to its figures. chi is the paper's "
              "(hot - cold domains)/N, L counts pixel sides, N counts material pixels. d_p is taken at common times, by default "
              "to the end of loading of the slower of two runs. Loading ends where the mean "
              "temperature is largest. Error bars are standard deviations over the samples; with one sample there are none.")


def first_figures(page, results):
    """Figures 1 to 3; returns the curves of the reference."""
    case = plan.reference(results.study)
    found = results.curves(case)
    page.text("## Figure 1: temperature at 500, 750, 850 and 1100 ns")
    page.picture("figure_1", "Figure 1", figures.figure_1(results.folder(case), plan.FIGURE_1))
    page.text("## Figure 2: morphology of the process in Figure 1")
    page.picture("figure_2", "Figure 2", figures.figure_2(found))
    page.table("figure_2", ["time [s]", *(f"{name}({rise} K)" for name in figures.TEXT for rise in plan.FIGURE_2)],
               numpy.column_stack([found.time, *(found.at(name, rise) for name in figures.TEXT for rise in plan.FIGURE_2)]))
    page.text("## Figure 3: the same in the space of A, L and chi")
    page.picture("figure_3", "Figure 3", figures.space(
        {f"{rise} K": (found, rise, len(found.time) - 1) for rise in plan.FIGURE_2}))
    return found


def write_distances(page, name, matches, levels, keys):
    """CSV of d_p against the rise, a column per key and level."""
    rise = max((match.rise for match in matches.values()), key=len)
    columns = [numpy.interp(rise, matches[key, level].rise, matches[key, level].distance) for level in levels for key in keys]
    page.table(name, ["rise [K]", *(f"{key} against {level} K" for level in levels for key in keys)],
               numpy.column_stack([rise, *columns]))


def write_series(page, name, unit, series):
    page.table(name, ["reference [K]", unit, "best rise [K]", "standard deviation [K]"],
               [(level, *point) for level, points in series.items() for point in points])


def velocities_of(thermal):
    return ((plan.LOW, plan.FIGURE_4A, plan.LEVEL_4A, plan.LEVELS_7A, "a"), (plan.HIGH, plan.FIGURE_4B, plan.LEVEL_4B, plan.LEVELS_7B, "b"))


def figures_4_and_7(page, results, thermal):
    """Figures 4 and 7 of one thermal model; returns the series of Figure 7 and the matches of the first sample by letter."""
    series, first = {}, {}
    ending = "" if thermal == "paper" else f"_{thermal}"
    for porosity, velocities, level, levels, letter in velocities_of(thermal):
        found = results.figure_4(porosity, levels, thermal)
        series[letter], first[letter] = series_of(found, velocities, levels), found[0]
        page.text(f"## Figure 4({letter}): d_p against the threshold, void fraction {porosity:g}, reference {level} K at "
                  f"1100 m/s, thermal model {thermal}")
        page.picture(f"figure_4{letter}{ending}", f"Figure 4({letter})", figures.figure_4(found[0], level, velocities))
        write_distances(page, f"figure_4{letter}{ending}", found[0], (level,), velocities)
        page.text(f"## Figure 7({letter}): matching threshold against V^2, thermal model {thermal}")
        page.picture(f"figure_7{letter}{ending}", f"Figure 7({letter})", figures.figure_7(series[letter]))
        write_series(page, f"figure_7{letter}{ending}", "velocity [m/s]", series[letter])
    return series, first


def figures_5_and_6(page, results, matches):
    """The three similar processes of the first sample: 120 K at 1100 m/s and its best matches."""
    runs = plan.figure_4(results.study, plan.LOW, results.study.seeds[0], "paper")
    paths, folders = {}, {}
    for velocity in (1000, 1100, 1200):
        best = matches[velocity, plan.LEVEL_4A].best
        found = results.curves(runs[velocity])
        label = f"{velocity} m/s, {best:.0f} K"
        paths[label] = (found, best, found.end)
        folders[label] = (results.folder(runs[velocity]), plan.START + best)
    page.text("## Figure 5: three similar processes while loading", "Our best matches, not the paper's numbers.")
    page.picture("figure_5", "Figure 5", figures.space(paths))
    page.text(f"## Figure 6: their patterns at {plan.FIGURE_6} ns", "Grey: hotter than the threshold. Black: colder.")
    page.picture("figure_6", "Figure 6", figures.figure_6(folders, 1e-9 * plan.FIGURE_6))


TIMES = {"own": ("each run's time in units of its own loading time", ("--time", "loading")),
         "common": ("at common times while both are loaded, as eq. 18 reads", ("--window", "faster"))}


SHARES = (0.9, 0.75, 0.5, 0.25, 0.1)


def heat_by_porosity(page, results, thermal):
    """Table of what is exceeded at the end of loading; returns rows of (void fraction, end of loading, rises by share)."""
    rows, most = [], {}
    for porosity in plan.FIGURE_8:
        samples = [results.curves(plan.case(results.study, porosity, plan.REFERENCE, seed, thermal)) for seed in results.study.seeds]
        most[porosity] = samples[0].rise[-1]
        rows.append((porosity, numpy.mean([one.time[one.end] for one in samples]),
                     {share: numpy.mean([measures.exceeded(one, share) for one in samples]) for share in SHARES}))
    page.text("What a share of the sample exceeds at the end of loading, in K above the start, mean of the samples:")
    page.markdown(("void fraction", "end of loading, ns", *(f"{100 * share:g} %" for share in SHARES)),
                  [(f"{porosity:g}", f"{1e9 * end:.0f}", *(f"{rise:.0f}" if numpy.isfinite(rise) else f"> {most[porosity]:.0f}" for rise in rises.values()))
                   for porosity, end, rises in rows])
    return rows


def figure_8(page, results, thermal):
    """Figure 8 of one thermal model, with both readings of the time; returns its claims."""
    found = []
    page.text(f"## Figure 8: matching threshold against void fraction at 1100 m/s, thermal model {thermal}",
              "The shock is up to three times slower in more porous material, so at common times much less of it is hot, whatever "
              "the threshold. The paper does not say how it compares such runs; both readings are shown. Dashed: power law through "
              "as many points from the left as it describes within 10 %. Points at the end of the measured thresholds are left "
              "out: they are no minima.")
    rows = heat_by_porosity(page, results, thermal)
    whys = {"own": claims.heat_by_porosity(rows), "common": claims.loaded_by_porosity(rows)}
    for reading, (words, options) in TIMES.items():
        name = f"figure_8_{reading}" + ("" if thermal == "paper" else f"_{thermal}")
        series = series_of(results.figure_8(thermal, *options), plan.FIGURE_8, plan.LEVELS_8)
        fits = {level: claims.fit_range(points) for level, points in series.items()}
        page.text(f"Compared with {words}:")
        page.picture(name, f"Figure 8, {words}", figures.figure_8(series, fits))
        write_series(page, name, "void fraction [1]", series)
        found += claims.power_law(series, fits, f"{reading} times", whys[reading])
    return found


def checklist(page, title, found):
    page.text(f"## {title}")
    page.markdown(("the paper says", "found here", "verdict", "why"),
                  [(entry.claim, entry.found, f"**{entry.verdict}**", entry.why) for entry in found])


def sensitivity(page, variants):
    """What changing one thing of the reference does to Figure 2; curves by what is changed."""
    page.text("## How much Figure 2 depends on what the paper does not state")
    page.picture("sensitivity", "Sensitivity", figures.sensitivity(variants))
    rows = []
    for name, found in variants.items():
        end = found.end
        rows.append((name, f"{1e9 * found.time[end]:.0f}", *(f"{found.at('A', rise)[end]:.3f}" for rise in plan.FIGURE_2),
                     f"{1e-3 * found.at('L_physical', 200)[end]:.2f}", f"{found.at('chi_paper', 150)[end]:+.1e}",
                     f"{found.at('chi_paper', 250)[end]:+.1e}"))
    head = ("changed", "end of loading, ns", *(f"A({rise} K)" for rise in plan.FIGURE_2), "L(200 K), 1/mm", "chi(150 K)", "chi(250 K)")
    page.markdown(head, rows)
    page.table("sensitivity", head, rows)
    page.text("All at the end of loading. L per millimetre compares pixels of different size; chi is per pixel of its own. "
              "Self-contact of void walls (contact.self) is off in all.")


def past_the_paper(page, results, found):
    """Numbers that the paper does not give, for the reference."""
    case, cell = plan.reference(results.study), results.study.cell
    snapshot = figures.nearest_snapshot(results.folder(case), found.time[found.end])[1]
    spots = measures.hot_spots(results.program, snapshot, (200, 300, 500), results.runs / "hot_spots")
    page.text("## Past the paper", "Speed of the hot front: rise of A times the height of the sample, in the material at rest. "
              "Anisotropy: (boundary crossed along the shock axis - across it) / both, 0 without direction. Correlation length: "
              "pi A (1 - A)/L with the Crofton length.")
    page.picture("past", "Growth, anisotropy, correlation length", figures.past_the_paper(found, cell))
    rows = [(f"{rise} K", f"{measures.growth(found, rise)[1]:.0f}", f"{measures.anisotropy(found, rise)[found.end]:+.3f}",
             f"{1e6 * measures.correlation_length(found, rise, cell)[found.end]:.1f}", f"{100 * measures.ambiguity(found, rise):.0f} %")
            for rise in plan.FIGURE_2]
    head = ("threshold", "speed of the hot front, m/s", "anisotropy", "correlation length, um", "|chi4 - chi8| / |chi8|")
    page.markdown(head, rows)
    page.table("past", head, rows)
    poor = [row[0] for rise, row in zip(plan.FIGURE_2, rows) if not measures.ambiguity(found, rise) < 0.25]
    if poor:
        page.text(f"**Resolution warning**: at {', '.join(poor)} chi changes by a quarter or more with the way pixels join; the "
                  "pattern is not resolved there.")
    page.text("Hot spots at the snapshot nearest to the end of loading, their sizes and peaks, which ignition models ask for:")
    page.picture("hot_spots", "Hot spots", figures.hot_spot_figure(spots))
    page.table("hot_spots", ("level [K]", "area [m^2]", "peak [K]"),
               [(level, *spot) for level, columns in spots.items() for spot in zip(*columns)])


def paper_claims(results, found, series, of_8, variants):
    """The checklist of the paper's own thermal model."""
    case, solid = plan.reference(results.study), plan.solid(results.study)
    rises = [measures.mean_rise(results.folder(one)) for one in (case, solid)]
    at_120 = {velocity: (mean, deviation) for velocity, mean, deviation in series["a"][plan.LEVEL_4A]}
    return [*claims.loading(found, results.curves(solid), variants), *claims.areas(found), *claims.lengths(found), *claims.connectivity(found),
            *claims.release(*rises, found), *claims.best_matches(at_120), *claims.growth(series["a"], series["b"]), *of_8]


def write(study, runs, program, folder):
    """Writes results.md with its pictures and tables into `folder`; returns its path."""
    folder.mkdir(parents=True, exist_ok=True)
    page, results = Page(folder), Results(study, runs, program)
    opening(page, results)
    slot = len(page.parts)
    found = first_figures(page, results)
    variants = {"reference": found} | {name: results.curves(case) for name, case in plan.variants(study).items()}
    for thermal in study.thermals:
        series, first = figures_4_and_7(page, results, thermal)
        of_8 = figure_8(page, results, thermal)
        if thermal == "paper":
            figures_5_and_6(page, results, first["a"])
            checked = paper_claims(results, found, series, of_8, variants)
        else:
            checklist(page, f"The claims of Figures 7 and 8 with thermal model {thermal}", [*claims.growth(series["a"], series["b"]), *of_8])
    sensitivity(page, variants)
    past_the_paper(page, results, found)
    # The checklist comes first on the page.
    head = Page(folder)
    checklist(head, "The paper's claims", checked)
    page.parts[slot:slot] = head.parts
    path = folder / "results.md"
    path.write_text("\n".join(page.parts))
    return path
