"""What is measured of the runs: curves, matches, fits, and what goes past the paper."""
import subprocess
from dataclasses import dataclass

import h5py
import numpy

from poreshock_cases.program import CaseError
from poreshock_paper.plan import HEIGHT, START
from poreshock_paper.sweep import end_of_loading
from poreshock_report import folder as reader

NAMES = ("A", "L", "L_crofton", "chi", "chi4", "chi_paper", "L_physical", "B_int", "B_axial")


@dataclass(frozen=True)
class Curves:
    """Morphology of one run: times (s), rises (K above the start), arrays times x rises by name."""
    time: numpy.ndarray
    rise: numpy.ndarray
    arrays: dict
    end: int  # record at the end of loading

    def at(self, name, rise):
        """One curve at the stored rise nearest to the wanted one."""
        return self.arrays[name][:, int(numpy.argmin(numpy.abs(self.rise - rise)))]


def curves(folder):
    time, threshold, arrays = reader.read_morphology(folder, names=NAMES)
    return Curves(time, threshold - START, arrays, end_of_loading(time, threshold, arrays["A"]))


@dataclass(frozen=True)
class Match:
    """One run against one level of the reference: d_p at every rise, the best rise, d_p there."""
    rise: numpy.ndarray
    distance: numpy.ndarray
    best: float
    best_distance: float
    at_end: bool  # at the end of what was measured, so maybe no minimum


def matches(program, reference, runs, levels, output, *options):
    """Matches of the runs (a dictionary of folders) by key and level, by `poreshock compare`; d_p is stored too."""
    keys = list(runs)
    command = [program, "compare", reference, *(runs[key] for key in keys), "--chi", "chi_paper", *options,
               "--threshold", ",".join(f"{START + level:g}" for level in levels), "--output", output]
    output.parent.mkdir(parents=True, exist_ok=True)
    done = subprocess.run([str(part) for part in command], text=True, capture_output=True, check=False)
    if done.returncode != 0:
        raise CaseError(f"compare with {reference}: {done.stdout}{done.stderr}")
    found = {}
    with h5py.File(output) as file:
        for number, key in enumerate(keys, 1):
            group = file[f"run_{number}"]
            rise = group["threshold"][...] - START
            for row, level in enumerate(levels):
                best = float(group["best_threshold"][row]) - START
                found[key, level] = Match(rise, group["d_p"][row], best, float(group["d_p_best"][row]),
                                          best in (rise[0], rise[-1]))
    return found


def over_seeds(found, key, level):
    """Best rises of all seeds at one key and level; those at the end of the thresholds are left out."""
    values = [match[key, level].best for match in found if (key, level) in match and not match[key, level].at_end]
    return numpy.array(values)


def mean_and_deviation(values):
    """Mean, and standard deviation over the seeds; NaN where there are not two."""
    if len(values) == 0:
        return numpy.nan, numpy.nan
    return float(numpy.mean(values)), float(numpy.std(values, ddof=1)) if len(values) > 1 else numpy.nan


@dataclass(frozen=True)
class Fit:
    """y = start + slope x by least squares, with the share of the variance that it explains and the slope's standard error."""
    slope: float
    start: float
    quality: float
    error: float


def straight_line(x, y):
    """Fit through the points that are finite; None with fewer than three."""
    known = numpy.isfinite(x) & numpy.isfinite(y)
    if known.sum() < 3:
        return None
    slope, start = numpy.polyfit(x[known], y[known], 1)
    rest = y[known] - start - slope * x[known]
    spread, reach = y[known] - y[known].mean(), x[known] - x[known].mean()
    error = numpy.sqrt((rest @ rest) / (known.sum() - 2) / (reach @ reach))
    return Fit(float(slope), float(start), float(1.0 - (rest @ rest) / (spread @ spread)), float(error))


def exceeded(found, share):
    """Rise (K) that this share of the material exceeds at the end of loading; infinite beyond what was measured."""
    if found.arrays["A"][found.end][-1] > share:
        return numpy.inf
    return float(numpy.interp(-share, -found.arrays["A"][found.end], found.rise))


def rank_correlation(values):
    """Spearman's rank correlation of a curve with time: 1 where it only rises, -1 where it only falls."""
    order = numpy.argsort(numpy.argsort(values))
    return float(numpy.corrcoef(order, numpy.arange(len(values)))[0, 1])


def growth(found, rise):
    """dA/dt at every record, 1/s, and the speed of the hot front in the material at rest, m/s, while loading.

    The front's speed is the slope of A x height over the middle half of the loading: hot material
    is counted where it was before the impact.
    """
    area = found.at("A", rise)
    rate = numpy.gradient(area, found.time)
    first, last = found.end // 4, 3 * found.end // 4
    slope = numpy.polyfit(found.time[first:last + 1], area[first:last + 1], 1)[0]
    return rate, float(slope) * HEIGHT


def anisotropy(found, rise):
    """(boundary crossed along the shock - across it) / both, by record; NaN without boundary: 0 isotropic."""
    both, axial = found.at("B_int", rise).astype(float), found.at("B_axial", rise)
    return numpy.where(both > 0, (2.0 * axial - both) / numpy.where(both > 0, both, 1.0), numpy.nan)


def correlation_length(found, rise, pixel):
    """pi A (1 - A) / L in metres, the decay length of the two-point function of a random two-colour medium whose
    function is exponential (Yeong and Torquato, Phys. Rev. E 57 (1998) 495); NaN without boundary."""
    area, length = found.at("A", rise), found.at("L_crofton", rise)
    return numpy.where(length > 0, numpy.pi * area * (1.0 - area) / numpy.where(length > 0, length, 1.0), numpy.nan) * pixel


def ambiguity(found, rise):
    """|chi4 - chi8| / |chi8| at the end of loading: how far chi depends on how pixels join."""
    eight, four = (float(found.at(name, rise)[found.end]) for name in ("chi", "chi4"))
    return abs(four - eight) / abs(eight) if eight else numpy.nan


def hot_spots(program, snapshot, levels, folder):
    """Areas (m^2) and peaks (K) of all hot spots of a snapshot by level (K above the start), by `poreshock analyze`."""
    text = ",".join(f"{START + level:g}" for level in levels)
    command = [program, "analyze", snapshot, "--thresholds", text, "--hot-spots", text, "--output", folder, "--force"]
    done = subprocess.run([str(part) for part in command], text=True, capture_output=True, check=False)
    if done.returncode != 0:
        raise CaseError(f"analyze {snapshot}: {done.stdout}{done.stderr}")
    with h5py.File(folder / "morphology.h5") as file:
        group = file["temperature/domains"]
        level = group["threshold"][...] - START
        area, peak = group["area"][...], group["peak"][...]
    return {wanted: (area[numpy.isclose(level, wanted)], peak[numpy.isclose(level, wanted)]) for wanted in levels}


def mean_rise(folder):
    """Times and mass-weighted mean temperature above the start from the snapshots of a run."""
    found = []
    for time, path in reader.snapshot_times(folder):
        particles = reader.read_particles(path, ("mass", "temperature"))
        found.append((time, numpy.average(particles["temperature"], weights=particles["mass"]) - START))
    return numpy.array(found).T
