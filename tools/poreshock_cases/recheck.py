"""Whether the schemes still give the figures of a stored table of speed against error."""
import csv
from collections import defaultdict
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import numpy

from poreshock_cases import collapse, schemes

ROUNDING = 1e-5  # the table holds six digits
NEAR_ZERO = 1e-9  # round-off figures are not compared


def compared(case, cell):
    """True for the runs that are measured again; cell in m."""
    return case == "plate" or cell > 1.01 * schemes.VOID_CELLS[-1]


def key_of(case, scheme, cell, per_cell, name):
    """What a figure is found by; cells in um, so that rounding does not count."""
    return case, scheme, round(1e6 * cell, 3), per_cell, name


def stored_figures(path):
    """The compared figures of a results.csv."""
    with open(path, newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["figure"] and row["value"]]
    return {key_of(row["case"], row["scheme"], float(row["cell [m]"]), int(row["particles per cell"]), row["figure"]):
            float(row["value"]) for row in rows if compared(row["case"], float(row["cell [m]"]))}


def found_figures(lab, jobs):
    """The same, measured now."""
    rates = defaultdict(lambda: numpy.nan)  # the cost is not looked at
    voids = [case for case in schemes.cases(schemes.VOID_CELLS) if case[1] > schemes.VOID_CELLS[-1]]
    with ThreadPoolExecutor(jobs) as pool:
        collapses = list(pool.map(partial(schemes.void_result, lab, rates, collapse.THRESHOLDS), voids))
    results = [("plate", result) for result in schemes.plates(lab, rates, jobs, False)]
    results += [("voids", result) for result in collapses]
    return {key_of(case, result.scheme.name, result.cell, result.per_cell, name): value for case, result in results
            for name, value in result.figures.items() if compared(case, result.cell)}


def check(lab, jobs, path):
    """Compares, prints what differs and the largest difference; 1 where it is more than rounding."""
    stored, found = stored_figures(path), found_figures(lab, jobs)
    worst, same = 0.0, 0
    for key in sorted(stored.keys() ^ found.keys()):
        print(f"{' '.join(map(str, key))}: {f'not in {path}' if key in found else 'not found, the run failed'}")
        worst = numpy.inf
    for key in sorted(stored.keys() & found.keys()):
        value = found[key]
        size = max(abs(value), abs(stored[key]))
        difference = abs(value - stored[key]) / size if size > NEAR_ZERO else 0.0
        worst, same = max(worst, difference), same + (difference <= ROUNDING)
        if difference > ROUNDING:
            print(f"{' '.join(map(str, key))}: {value:.6g}, {stored[key]:.6g} in {path}")
    print(f"{same} of {len(stored)} figures as in {path}, largest relative difference {worst:.1e}")
    return 0 if worst <= ROUNDING else 1
