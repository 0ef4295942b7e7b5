"""Whether the schemes still give the figures of a stored table of speed against error."""
import csv
from collections import defaultdict
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import numpy

from poreshock_cases import schemes

ROUNDING = 1e-5  # the table holds six digits
NEAR_ZERO = 1e-9  # round-off figures are not compared
VOID_FIGURES = ("plastic work", "mean T", "mass above 80 GPa")  # those that need no reference


def stored_figures(path):
    """Figures of a results.csv by (case, scheme, cell in um, particles per cell, figure)."""
    with open(path, newline="") as file:
        return {(row["case"], row["scheme"], round(1e6 * float(row["cell [m]"]), 3), int(row["particles per cell"]),
                 row["figure"]): float(row["value"]) for row in csv.DictReader(file) if row["figure"] and row["value"]}


def found_figures(lab, jobs):
    """The same of the plates and the voids with all but the finest cells, measured now."""
    rates = defaultdict(lambda: numpy.nan)  # the cost is not looked at
    thresholds = (0.0,) * len(schemes.QUANTILES)
    voids = [case for case in schemes.cases(schemes.VOID_CELLS) if case[1] > schemes.VOID_CELLS[-1]]
    with ThreadPoolExecutor(jobs) as pool:
        collapses = list(pool.map(partial(schemes.void_result, lab, rates, thresholds), voids))
    found = {}
    for case, results in (("plate", schemes.plates(lab, rates, jobs, False)), ("voids", collapses)):
        for result in results:
            for name, value in result.figures.items():
                if case == "plate" or name in VOID_FIGURES:
                    found[case, result.scheme.name, round(1e6 * result.cell, 3), result.per_cell, name] = value
    return found


def check(lab, jobs, path):
    """Compares, prints what differs and the largest difference; 1 where it is more than rounding."""
    stored, found = stored_figures(path), found_figures(lab, jobs)
    worst, same = 0.0, 0
    for key, value in sorted(found.items()):
        if key not in stored:
            print(f"{' '.join(map(str, key))}: {value:.6g}, not in {path}")
            worst = numpy.inf
            continue
        size = max(abs(value), abs(stored[key]))
        difference = abs(value - stored[key]) / size if size > NEAR_ZERO else 0.0
        worst, same = max(worst, difference), same + (difference <= ROUNDING)
        if difference > ROUNDING:
            print(f"{' '.join(map(str, key))}: {value:.6g}, {stored[key]:.6g} in {path}")
    print(f"{same} of {len(found)} figures as in {path}, largest relative difference {worst:.1e}")
    return 0 if worst <= ROUNDING else 1
