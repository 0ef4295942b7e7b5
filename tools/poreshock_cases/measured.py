"""Experiments beside the program: shock speeds of solids as measured, and Boade's law of pressed copper powder.

A point of an experiment is a pair (Up, Us) in m/s, both relative to the material ahead of the shock. Compression is
positive.
"""
import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy

from poreshock_cases.program import ROOT
from poreshock_cases.table import check, shown
from poreshock_report import profiles
from poreshock_report.hugoniot import bisect, least_volume, pressure_of, snow_plow

DATA = ROOT / "tests/verification"
HEAD = "up_km_s,us_km_s"
OFF = "run over measured"
STRAIGHT = 4000.0  # m/s, Up up to which a straight line tells the slope


@dataclass(frozen=True)
class Solid:
    """A material of the library, the file of its points, how far around Up they count, and the plates that are run."""
    material: str
    file: str
    half_width: float  # m/s
    velocities: tuple  # m/s


SOLIDS = (Solid("copper", "hugoniot_copper.csv", 100.0, (300.0, 500.0, 1000.0, 1500.0, 2000.0, 3000.0)),
          Solid("aluminium_6061_t6", "hugoniot_aluminium_6061.csv", 500.0, (500.0, 1000.0, 2000.0, 3000.0)),
          Solid("paper_aluminium", "hugoniot_aluminium_6061.csv", 500.0, (500.0, 1000.0, 2000.0, 3000.0)))
PLATE_CELL, PLATE_HEIGHT = 10e-6, 2e-3  # m
CROSSED = 0.8  # of the sample, by the shock
POWDER_VELOCITIES = (200.0, 300.0, 380.0)  # m/s
POWDER_SEEDS = (1, 2)
POWDER_HEIGHT = 0.8e-3  # m, of the scene


def read_points(path):
    """Points (Up, Us) of a file, m/s, shape n x 2; comments begin with #, then comes HEAD, then km/s; else ValueError."""
    lines = [(number, line) for number, line in enumerate(Path(path).read_text().splitlines(), 1)
             if not line.startswith("#")]
    if not lines or lines[0][1] != HEAD:
        raise ValueError(f"{path}: the first line without # must be {HEAD}")
    points = []
    for number, line in lines[1:]:
        try:
            up, us = (float(word) for word in line.split(","))
        except ValueError:
            raise ValueError(f"{path}:{number}: found \"{line}\", wanted two numbers in km/s") from None
        points.append((1000.0 * up, 1000.0 * us))
    return numpy.array(points)


@dataclass(frozen=True)
class Around:
    """What the points around one Up say of Us there, m/s."""
    mean: float
    scatter: float  # standard deviation of a point
    count: int

    @property
    def error(self):
        """Standard error of the mean."""
        return self.scatter / math.sqrt(self.count)


def around(points, up, half_width):
    """Mean and scatter of Us at `up` from the points within half_width of it; ValueError with less than two.

    Each point is moved to `up` with the slope of the straight line through all points below STRAIGHT, for points that
    lie to one side would else shift the mean.
    """
    straight = points[points[:, 0] < STRAIGHT]
    slope = numpy.polyfit(straight[:, 0], straight[:, 1], 1)[0]
    near = points[abs(points[:, 0] - up) <= half_width]
    if len(near) < 2:
        raise ValueError(f"{len(near)} measured points lie within {half_width:g} m/s of Up = {up:g} m/s, 2 are needed")
    moved = near[:, 1] + slope * (up - near[:, 0])
    return Around(float(moved.mean()), float(moved.std(ddof=1)), len(near))


def end_time(height, speed):
    """Time at which a shock of speed Us has crossed CROSSED of the sample, in whole 5 ns."""
    return round(CROSSED * height / speed / 5e-9) * 5e-9


def plate(lab, solid, velocity):
    """The shock of a plate of the library that hits a wall, as `profiles.measure` has it."""
    us = around(read_points(DATA / solid.file), velocity, solid.half_width).mean
    run = lab.run(f"{solid.material}_{velocity:g}", "plate_impact.toml", f"material=[{{name=\"{solid.material}\"}}]",
                  f"sample.material={solid.material}", f"loading.velocity={velocity!r}",
                  f"sample.height={PLATE_HEIGHT!r}", f"domain.cell={PLATE_CELL!r}",
                  f"domain.size=[{4 * PLATE_CELL:.12g}, {PLATE_HEIGHT + 4 * PLATE_CELL:.12g}]",
                  f"time.end={end_time(PLATE_HEIGHT, us):.12g}", "profile.every=5e-9",
                  "output.snapshot=0.0")
    return profiles.measure(run.folder)


def listed(values, form, unit=""):
    """Values of all points of a case, as the tables split them."""
    return f"{' / '.join(format(value, form) for value in values)} {unit}".strip()


def percent(value, reference):
    return 100.0 * (value / reference - 1.0)


def case_of(solid):
    return (f"plates of {solid.material} beside {solid.file}, "
            f"{' / '.join(f'{velocity:g}' for velocity in solid.velocities)} m/s")


def plate_rows(solid, points, shocks):
    """Rows of one material: Us of its plates beside the measured points, and the mean over all plates."""
    case = case_of(solid)
    found = [around(points, velocity, solid.half_width) for velocity in solid.velocities]
    scatter = [100.0 * there.scatter / there.mean for there in found]
    off = [percent(shock.values[0], there.mean) for shock, there in zip(shocks, found)]
    line = [percent(shock.setting.material.c0 + shock.setting.material.gruneisen_slope * velocity, there.mean)
            for shock, there, velocity in zip(shocks, found, solid.velocities)]
    missed = [f"{velocity:g}" for velocity, o, s in zip(solid.velocities, off, scatter) if not abs(o) <= s]
    text = listed(off, "+.2f", "%") + (f"; missed at {', '.join(missed)}" if missed else "")
    return [shown(case, "Us of the run", listed((shock.values[0] for shock in shocks), ".0f", "m/s")),
            shown(case, "measured Us", listed((there.mean for there in found), ".0f", "m/s")),
            shown(case, f"measured points within {solid.half_width:g} m/s", listed((t.count for t in found), "d")),
            shown(case, "scatter of a point", listed(scatter, ".2f", "%")),
            shown(case, "standard error of the mean",
                  listed((100.0 * there.error / there.mean for there in found), ".2f", "%")),
            check(case, OFF, text, "the scatter of a point", not missed),
            shown(case, "c0 + lambda Up of the library over measured", listed(line, "+.2f", "%")),
            shown(f"all plates of {solid.material}", OFF,
                  f"{numpy.mean(off):+.2f} +- {numpy.std(off, ddof=1) / len(off)**0.5:.2f} %")]


# Boade's law (J. Appl. Phys., "Principal Hugoniot, second-shock Hugoniot, and release behavior of pressed copper
# powder"), from its abstract: 6.4 g/cm3, one precursor of about 1.4 kbar at about 1.9 km/s, and up to about 35 kbar
# alpha_2 = 1 + (alpha_1 - 1) exp[-0.254 / kbar (P_2 - P_1)].
BOADE_DENSITY = 6400.0  # kg/m^3
BOADE_PRECURSOR = (0.14e9, 1900.0)  # Pa, m/s
BOADE_SLOPE = 2.54e-9  # 1/Pa
BOADE_LIMIT = 3.5e9  # Pa


@dataclass(frozen=True)
class Powder:
    """State behind the main wave of Boade's powder, in the frame of the powder at rest."""
    speed: float  # m/s, of the main wave
    velocity: float  # m/s, of the material behind it
    pressure: float  # Pa
    density: float  # kg/m^3, over solid and voids together


def solid_volume(material, pressure, energy):
    """Volume of the solid at a pressure and an energy, m^3/kg."""
    return bisect(lambda volume: pressure_of(material, volume, energy) - pressure,
                  least_volume(material) * (1.0 + 1e-9), 1.1 / material.density)


def boade(material, pressure, density=BOADE_DENSITY):
    """The main wave at a pressure, from Boade's law and the jump conditions behind his precursor.

    alpha is the volume of the powder over that of the solid at the same pressure and energy (Herrmann 1969).
    """
    first, speed = BOADE_PRECURSOR
    ahead = first / (density * speed)
    before = (1.0 - ahead / speed) / density
    alpha = before / solid_volume(material, first, 0.5 * ahead**2)
    alpha = 1.0 + (alpha - 1.0) * math.exp(-BOADE_SLOPE * (pressure - first))

    def missing(solid):
        energy = 0.5 * ahead**2 + 0.5 * (pressure + first) * (before - alpha * solid)
        return pressure_of(material, solid, energy) - pressure

    volume = alpha * bisect(missing, least_volume(material) * (1.0 + 1e-9), 1.1 / material.density)
    step = math.sqrt((pressure - first) * (before - volume))
    # The wave's speed relative to what the precursor has set in motion is V1 sqrt(dP / (V1 - V2)).
    return Powder(ahead + before * math.sqrt((pressure - first) / (before - volume)), ahead + step, pressure,
                  1.0 / volume)


def boade_at(material, velocity, density=BOADE_DENSITY):
    """Boade's main wave with a velocity behind it, m/s; ValueError beyond the pressures that he measured."""
    pressure = bisect(lambda p: velocity - boade(material, p, density).velocity, BOADE_PRECURSOR[0] * (1.0 + 1e-6),
                      1.02 * BOADE_LIMIT)
    found = boade(material, pressure, density)
    if abs(found.velocity - velocity) > 1e-3:
        raise ValueError(f"Up = {velocity:g} m/s is beyond {BOADE_LIMIT / 1e9:g} GPa, where Boade's law ends")
    return found


@dataclass(frozen=True)
class Bed:
    """What a run of packed grains says, its shock as `profiles.measure` has it."""
    shock: profiles.Shock
    density: float  # kg/m^3 before the shock, of what the front crossed
    time: float  # s, of the last record
    lead: float  # m by which motion of half the precursor's velocity was ahead of the front then


def lead(records, velocity, least):
    """How far above the front of the last record material still moves at `least` m/s, seen from material at rest ahead
    of a wall that comes at `velocity`, m; the lowest row counts where none does."""
    moving = numpy.flatnonzero(numpy.nan_to_num(records.row["velocity"][-1] + velocity) >= least)
    return float(records.height[moving[-1] if len(moving) else 0] - records.front[-1])


def powder(lab, velocity, seed):
    """A bed of packed copper grains that hits a wall."""
    # Boade's Us is 754 to 1290 m/s at 200 to 380 m/s.
    run = lab.run(f"powder_{velocity:g}_{seed}", "copper_powder.toml", f"loading.velocity={velocity!r}",
                  f"sample.seed={seed}", f"time.end={end_time(POWDER_HEIGHT, 150.0 + 3.0 * velocity):.12g}",
                  "output.snapshot=0.0")
    return read_bed(run.folder, velocity)


def read_bed(folder, velocity):
    """What the files of a bed say."""
    records, shock = profiles.read(folder), profiles.measure(folder)
    ahead = BOADE_PRECURSOR[0] / (BOADE_DENSITY * BOADE_PRECURSOR[1])
    return Bed(shock, (1.0 - shock.voids) * shock.setting.material.density, float(records.time[-1]),
               lead(records, velocity, 0.5 * ahead))


def powder_rows(velocities, beds):
    """Rows of the beds beside Boade's law and complete collapse at the same Up and density; `beds` has a list of
    samples for each velocity."""
    case = (f"copper powder beside Boade's law, {len(beds[0])} samples, "
            f"{' / '.join(f'{velocity:g}' for velocity in velocities)} m/s")
    law = [[boade_at(bed.shock.setting.material, velocity, bed.density) for bed in samples]
           for velocity, samples in zip(velocities, beds)]
    plow = [[snow_plow(bed.shock.setting.material, 1.0 - bed.density / bed.shock.setting.material.density, velocity)
             for bed in samples] for velocity, samples in zip(velocities, beds)]

    def means(values, form, unit):
        return listed((numpy.mean([*samples]) for samples in values), form, unit)

    def figure(name, i, field, scale, form, unit):
        run = [[bed.shock.values[i] for bed in samples] for samples in beds]
        curves = [[[getattr(x, field) for x in samples] for samples in curve] for curve in (law, plow)]
        off = [[[*map(percent, *pair)] for pair in zip(run, curve)] for curve in curves]
        error = ([numpy.std(samples, ddof=1) / len(samples)**0.5 for samples in off[0]])
        return [shown(case, f"{name} of the run", means(numpy.divide(run, scale), form, unit)),
                shown(case, f"{name} by Boade's law", means(numpy.divide(curves[0], scale), form, unit)),
                shown(case, f"{name}, run over Boade", means(off[0], "+.1f", "%")),
                shown(case, f"{name}, standard error of that", listed(error, ".1f", "%")),
                shown(case, f"{name}, run over complete collapse", means(off[1], "+.1f", "%"))]

    return [shown(case, "density before the shock", means([[bed.density for bed in b] for b in beds], ".0f", "kg/m3")),
            *figure("Us", 0, "speed", 1.0, ".0f", "m/s"),
            *figure("momentum flux behind the front", 3, "pressure", 1e9, ".2f", "GPa"),
            *figure("P at the wall", 4, "pressure", 1e9, ".2f", "GPa"),
            *figure("density behind the front", 5, "density", 1.0, ".0f", "kg/m3"),
            shown(case, "half the precursor's velocity ahead of the front, run",
                  means([[1e6 * bed.lead for bed in samples] for samples in beds], ".0f", "um")),
            shown(case, "precursor ahead of the front by Boade",
                  means([[1e6 * bed.time * (BOADE_PRECURSOR[1] - state.speed) for bed, state in zip(*pair)]
                         for pair in zip(beds, law)], ".0f", "um"))]


def rows(lab, jobs):
    """All rows of the table of measured data, four minutes of one core."""
    with ThreadPoolExecutor(jobs) as pool:
        plates = [pool.map(partial(plate, lab, solid), solid.velocities) for solid in SOLIDS]
        powders = [pool.map(partial(powder, lab, velocity), POWDER_SEEDS) for velocity in POWDER_VELOCITIES]
        found = [row for solid, shocks in zip(SOLIDS, plates)
                 for row in plate_rows(solid, read_points(DATA / solid.file), [*shocks])]
        found += powder_rows(POWDER_VELOCITIES, [[*samples] for samples in powders])
    # The means of all plates share one table at the end.
    return sorted(found, key=lambda row: row.case.startswith("all "))


KNOWN = {(case_of(SOLIDS[2]), OFF): "Three to five points are near, and scatter by 0.4 %. The library's line, Meyers' of "
         "6061, lies 0.8 and 0.5 % above them, and strength adds 0.3 %."}
