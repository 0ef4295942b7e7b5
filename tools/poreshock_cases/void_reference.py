"""The truth on collapsing voids: runs over cells, carried to finer cells by a narrower sample, and extrapolated."""
import csv
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy

from poreshock_cases import collapse
from poreshock_cases.schemes import UM, kept

SCHEMES = ("aflip", "polypic", "ipolypic")
WIDE, NARROW = 0.4e-3, 0.16e-3  # m, widths of the samples
HEIGHT = 0.72e-3  # m, of the domain
WIDE_CELLS = (5 * UM, 2.5 * UM, 1.25 * UM)
NARROW_CELLS = (2.5 * UM, 1.25 * UM, 0.625 * UM)
QUICK = 8.0  # times as large cells
ENDS = {1500.0: 100e-9, 700.0: 130e-9}  # m/s: s, so that the fronts are about as high
FIELDS = ("velocity [m/s]", "width [m]", "scheme", "cell [m]", "figure", "value", "error")
EXTRAPOLATED = "extrapolated"
SLOWEST = 0.5  # order below which an extrapolation is mostly noise: it adds 2.4 times the last difference


@dataclass(frozen=True)
class Case:
    """One run."""
    velocity: float
    width: float
    scheme: str
    cell: float

    @property
    def name(self):
        return f"reference_{self.velocity:g}_{self.width / UM:g}um_{self.scheme}_{self.cell / UM:g}um"


@dataclass(frozen=True)
class Limit:
    """What a sequence of halved cells tends to."""
    value: float  # the finest one where the differences do not shrink, or too slowly
    order: float  # NaN where they do not shrink
    last: float  # change of the last halving

    @property
    def doubt(self):
        """What the last halving still changed, or what the extrapolation adds if that is more."""
        if not self.order >= SLOWEST:
            return abs(self.last)
        return abs(self.last) * max(1.0, 1.0 / (2.0**self.order - 1.0))


def samples_of(quick=False, narrow=True):
    """Cells of the samples by their width, coarse first."""
    found = {WIDE: WIDE_CELLS} | ({NARROW: NARROW_CELLS} if narrow else {})
    return {width: tuple(round(cell * (QUICK if quick else 1.0), 10) for cell in cells) for width, cells in found.items()}


def cases(samples):
    """All runs, the quick ones first."""
    found = [Case(velocity, width, scheme, cell) for velocity in ENDS for width, cells in samples.items()
             for scheme in SCHEMES for cell in cells]
    return sorted(found, key=lambda case: case.width / case.cell**3)


def run_of(lab, case):
    """The run of a case, from disk when it is finished."""
    return kept(lab, case.name, "porous_collapse.toml", f"transfer.velocity={case.scheme}", f"domain.cell={case.cell!r}",
                f"domain.size=[{case.width!r}, {HEIGHT!r}]", f"loading.velocity={case.velocity!r}",
                f"time.end={ENDS[case.velocity]!r}")


def measure(lab, jobs, samples):
    """Runs all; {case: figures}."""
    todo = cases(samples)
    with ThreadPoolExecutor(jobs) as pool:
        runs = dict(zip(todo, pool.map(lambda case: run_of(lab, case), todo)))
    strong = max(ENDS)
    thresholds = {strong: collapse.THRESHOLDS}
    for velocity in ENDS.keys() - thresholds.keys():
        finest = Case(velocity, WIDE, SCHEMES[0], samples[WIDE][-1])
        thresholds[velocity] = tuple(round(float(level)) for level in collapse.quantiles_of(runs[finest]))
    return {case: collapse.figures(run, thresholds[case.velocity]) for case, run in runs.items()}


def values_of(found, velocity, scheme, name, samples):
    """Lists of the figure over the cells, a sample each."""
    return [[found[Case(velocity, width, scheme, cell)].get(name, 0.0) for cell in cells]
            for width, cells in samples.items()]


def sequence(found, velocity, scheme, name, samples):
    """The figure over halved cells: of the wide sample, then the last difference of the narrow one if there is one."""
    wide, *others = values_of(found, velocity, scheme, name, samples)
    # The finest cell of the wide sample is the next to last of the narrow one.
    return wide + [wide[-1] + narrow[-1] - narrow[-2] for narrow in others]


def limit(values):
    """Richardson's extrapolation by the observed order of the last two halvings."""
    before, last = numpy.diff(values)[-2:]
    if not 0.0 < abs(last) < abs(before):
        return Limit(values[-1], numpy.nan, last)
    ratio = last / before  # below zero where the values swing
    order = float(numpy.log2(1.0 / abs(ratio)))
    return Limit(values[-1] + (last * ratio / (1.0 - ratio) if order >= SLOWEST else 0.0), order, last)


def reference(limits):
    """(value, error) of one figure: the mean of the schemes; their spread, and the largest doubt of one."""
    values = [one.value for one in limits]
    return float(numpy.mean(values)), max(values) - min(values) + max(one.doubt for one in limits)


def names_of(found, velocity):
    """Figures of a velocity, in their order."""
    return list(dict.fromkeys(name for case, figures in found.items() if case.velocity == velocity for name in figures))


def limits_of(found, velocity, name, samples):
    """Limit of each scheme."""
    return {scheme: limit(sequence(found, velocity, scheme, name, samples)) for scheme in SCHEMES}


def write_rows(path, found, samples):
    """All values and the references as CSV."""
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(FIELDS)
        for case, figures in found.items():
            for name, value in figures.items():
                writer.writerow([f"{case.velocity:g}", f"{case.width:g}", case.scheme, f"{case.cell:g}", name,
                                 f"{value:.9g}", ""])
        for velocity in ENDS:
            for name in names_of(found, velocity):
                value, error = reference(limits_of(found, velocity, name, samples).values())
                writer.writerow([f"{velocity:g}", f"{WIDE:g}", EXTRAPOLATED, 0, name, f"{value:.9g}", f"{error:.3g}"])


def read(path, velocity=max(ENDS)):
    """{figure: (value, error)} of a velocity; ValueError where there is no such file."""
    if not path.exists():
        raise ValueError(f"{path} is missing: tools/speed_vs_error --reference makes it")
    with path.open(newline="") as file:
        return {row["figure"]: (float(row["value"]), float(row["error"])) for row in csv.DictReader(file)
                if row["scheme"] == EXTRAPOLATED and float(row["velocity [m/s]"]) == velocity}


def tendency(one):
    """Order and limit of one scheme as text."""
    if numpy.isnan(one.order):
        return f"does not converge, {one.last:+.3g} per halving | {one.value:.5g}"
    if one.order < SLOWEST:
        return f"{one.order:.2f}, too low to extrapolate, {one.last:+.3g} per halving | {one.value:.5g}"
    return f"{one.order:.2f} | {one.value:.5g}"


def scheme_rows(found, velocity, name, samples):
    """Lines of one figure, a scheme each."""
    lines = []
    for scheme in SCHEMES:
        cells = []
        for values in values_of(found, velocity, scheme, name, samples):
            cells += [" / ".join(f"{value:.5g}" for value in values),
                      " / ".join(f"{step:+.3g}" for step in numpy.diff(values))]
        lines.append(f"| {name} | {scheme} | " + " | ".join(cells)
                     + f" | {tendency(limit(sequence(found, velocity, scheme, name, samples)))} |")
    return lines


def markdown(found, samples):
    """Tables of the references, of the values and of their differences."""
    columns = [f"{width / UM:g} um wide, cells of {' / '.join(f'{cell / UM:g}' for cell in cells)} um | per halving"
               for width, cells in samples.items()]
    carried = (f"The sample of {NARROW / UM:g} um carries that of {WIDE / UM:g} um to the next finer cell: its last difference is "
               "added. " if NARROW in samples else "")
    lines = ["# Collapsing voids on ever finer cells", "",
             f"Made by `tools/speed_vs_error --reference{'' if NARROW in samples else ' --no-narrow'}` from `input/porous_collapse.toml`. Heat is in J per kg of all "
             "material, T of the shocked mass in K, numerical dissipation in percent of all heat. A, L and chi are per "
             "pixel of 10 um.", "",
             carried + "Values are extrapolated with the order of the last two differences. Where these do not shrink, or "
             f"by an order below {SLOWEST:g}, the value is that of the finest cell. The reference is the mean of the "
             "schemes. Its error is their spread plus the last difference of a scheme, or what the extrapolation adds if "
             "that is more.", ""]
    for velocity in ENDS:
        names = names_of(found, velocity)
        lines += [f"## {velocity:g} m/s, {1e9 * ENDS[velocity]:g} ns", "", "| figure | reference | +- |", "|---|---|---|"]
        for name in names:
            value, error = reference(limits_of(found, velocity, name, samples).values())
            lines.append(f"| {name} | {value:.5g} | {error:.2g} |")
        lines += ["", f"| figure | scheme | {' | '.join(columns)} | order | extrapolated |",
                  "|---" * (4 + 2 * len(columns)) + "|"]
        lines += [line for name in names for line in scheme_rows(found, velocity, name, samples)] + [""]
    return "\n".join(lines)


def write(lab, jobs, results, samples):
    """Runs what is not yet there and writes void_reference.csv and void_reference.md."""
    found = measure(lab, jobs, samples)
    results.mkdir(parents=True, exist_ok=True)
    write_rows(results / "void_reference.csv", found, samples)
    (results / "void_reference.md").write_text(markdown(found, samples))
