"""Reads profiles.h5 and measures the shock in it: its speed and the state behind it."""
from dataclasses import dataclass

import h5py
import numpy

import plate_exact

from . import folder as reader
from . import hugoniot

WALL = 5  # cells at the wall left out of the state
ENTRY = 20  # cells, and two void diameters: the front counts only when it is that far from the wall
DISTANCE = 10  # cells, and two void diameters: the state counts only that far behind the front
LEAST_ROWS = 10
LEAST_RECORDS = 5
POROUS = 1e-3  # void fraction from which on a sample counts as porous


@dataclass(frozen=True)
class Profiles:
    """Records of a run: n times, rows of the grid."""
    time: numpy.ndarray  # s, n
    height: numpy.ndarray  # m above the low side of the grid, rows
    front: numpy.ndarray  # m above the low side of the grid, n, NaN without a front
    width: numpy.ndarray  # m, n
    shift: numpy.ndarray  # m, n, of the low side in the laboratory
    row: dict  # name -> n x rows; `velocity` is the one along the shock axis


def read(folder):
    """All records of a folder, from profiles.h5 or from the small files of an unfinished run."""
    whole = folder / "profiles.h5"
    paths = ([whole] if whole.exists() else []) + sorted(folder.glob("profile_*.h5"))
    if not paths:
        raise reader.Missing("there is no profiles.h5 and no profile_*.h5 "
                             "(the scene needs [profile] every > 0)")
    found, rows = {}, None
    for path in paths:
        try:
            with h5py.File(path, "r") as file:
                data = {f"{group}/{name}": item[()] for group in ("row", "front")
                        for name, item in file[group].items()}
            rows = data["row/height"] if rows is None else rows
            if not numpy.array_equal(rows, data["row/height"]):
                raise ValueError("its rows are not those of the other records")
            for i, number in enumerate(data["row/record"]):
                found[int(number)] = {name: data[name][i] for name in data if name != "row/height"}
        except (OSError, KeyError, ValueError) as error:
            problem = reader.Missing(f"{path.name} cannot be read: {error}")
    if not found:
        raise problem
    records = [found[number] for number in sorted(found)]
    columns = {name: numpy.array([record[name] for record in records]) for name in records[0]}
    row = {name[4:]: values for name, values in columns.items()
           if name.startswith("row/") and values.ndim == 2}
    row["velocity"] = row.get("velocity_z", row["velocity_y"])
    return Profiles(columns["row/time"], rows, columns["front/position"], columns["front/width"],
                    columns.get("row/shift", numpy.zeros(len(records))), row)


@dataclass(frozen=True)
class Setting:
    """What a scene says about its shock, SI units."""
    material: plate_exact.Material
    dimension: int
    cell: float
    velocity: float  # of the low wall relative to the material ahead
    height: float
    void_diameter: float
    void_fraction: float  # the wanted one
    thermal: str
    wall: float  # velocity of the low side in the laboratory
    follows: bool  # the domain is a window that follows the front
    linear: bool  # the yield stress rises linearly, as in the exact solution


def setting_of(scene):
    """Setting of a resolved scene with a wall at the low side."""
    try:
        low = scene["boundary"]["low"]
        low = low if isinstance(low, dict) else {"kind": low}
        sample, size = scene["sample"], scene["domain"]["size"]
        names = [material["name"] for material in scene["material"]]
        if low["kind"] not in ("wall", "symmetry") or sample["kind"] == "none":
            raise reader.Missing("the shock is measured in a [sample] on a wall at the low side")
        chosen = scene["material"][names.index(sample.get("material", names[0]))]
        voids = sample["kind"] == "random_voids"
        return Setting(plate_exact.material_from_scene(chosen), len(size), scene["domain"]["cell"],
                       scene["loading"]["velocity"] + low.get("velocity", 0.0), sample.get("height", size[-1]),
                       2.0 * sample.get("void_radius", 0.0) if voids else 0.0,
                       sample.get("porosity", 0.0) if voids else 0.0, str(scene.get("thermal")),
                       low.get("velocity", 0.0), reader.follows_front(scene), chosen.get("strength", "linear") == "linear")
    except (KeyError, ValueError) as error:
        raise reader.Missing(f"scene.toml does not describe the shock: {error}") from None


@dataclass(frozen=True)
class FrontFit:
    """Straight line through the heights of the front: height = start + slope x time."""
    start: float  # m
    slope: float  # m/s relative to the wall
    error: float  # m/s, standard error of the slope
    scatter: float  # m, root mean square of what is left
    used: numpy.ndarray  # indices of the records


def front_path(profiles, setting):
    """Heights of the front above where the low side would be if it had left no strips behind, m."""
    if not setting.follows:
        return profiles.front
    return profiles.front + profiles.shift - profiles.shift[0] - setting.wall * (profiles.time - profiles.time[0])


def fit_front(profiles, setting):
    """Fit of the front over all records in which it is far enough from the wall."""
    entry = max(ENTRY * setting.cell, 2.0 * setting.void_diameter)
    with numpy.errstate(invalid="ignore"):
        used = numpy.flatnonzero(profiles.front >= entry)
    if len(used) < LEAST_RECORDS:
        raise reader.Missing(f"the front is further than {1e6 * entry:.4g} um from the wall in {len(used)} records, "
                             f"and {LEAST_RECORDS} are needed: ask for more with [profile] every")
    time, front = profiles.time[used], front_path(profiles, setting)[used]
    slope, start = numpy.polyfit(time - time.mean(), front, 1)
    rest = front - start - slope * (time - time.mean())
    error = numpy.sqrt(numpy.sum(rest**2) / (len(used) - 2) / numpy.sum((time - time.mean())**2))
    return FrontFit(start - slope * time.mean(), slope, float(error), float(numpy.sqrt(numpy.mean(rest**2))), used)


@dataclass(frozen=True)
class State:
    """Averages behind the front; stress and density over solid and voids together."""
    records: int
    low: float  # m, where the windows begin
    distance: float  # m, where they end below the front
    names: tuple  # of mean and spread
    mean: numpy.ndarray
    spread: numpy.ndarray  # standard deviation between the records

    def __getitem__(self, name):
        return self.mean[self.names.index(name)]


NAMES = ("velocity", "stress", "momentum_flux", "density", "void_fraction", "temperature", "fluctuation")


def window_means(profiles, record, low, high):
    """Number of rows between two heights and their means, in the order of NAMES; None without enough rows."""
    inside = (profiles.height > low) & (profiles.height < high)
    row = {name: values[record][inside] for name, values in profiles.row.items()}
    if inside.sum() < LEAST_ROWS or not numpy.all(numpy.isfinite(row["density"])):
        return None
    solid, velocity = row["solid_fraction"], profiles.row["velocity"][record]
    flux = row.get("momentum_flux", numpy.full(len(solid), numpy.nan))  # older files have none
    mass = solid * row["density"]
    # The highest row with material is untouched as long as there is a front.
    ahead = velocity[numpy.isfinite(velocity)][-1]
    return inside.sum(), (numpy.average(row["velocity"], weights=mass) - ahead, numpy.mean(solid * row["stress"]),
                          numpy.mean(solid * flux), numpy.mean(mass), 1.0 - numpy.mean(solid),
                          numpy.average(row["temperature"], weights=mass),
                          numpy.average(row["fluctuation"], weights=mass))


def state_behind(profiles, setting, fit):
    """Mean state between wall and front over the records of the fit, each weighted with its rows."""
    low = WALL * setting.cell
    distance = max(DISTANCE * setting.cell, 2.0 * setting.void_diameter)
    windows = [window_means(profiles, record, low, profiles.front[record] - distance) for record in fit.used]
    windows = [window for window in windows if window]
    if not windows:
        raise reader.Missing(f"there are never {LEAST_ROWS} filled rows between the wall and the front: "
                             "let the run end later")
    weights, values = (numpy.array(column) for column in zip(*windows))
    mean = numpy.average(values, axis=0, weights=weights)
    spread = numpy.sqrt(numpy.average((values - mean)**2, axis=0, weights=weights))
    return State(len(windows), low, distance, NAMES, mean, spread)


def void_fraction(profiles, setting, fit):
    """Void fraction of what the front crosses, as it was made; the wanted one without a first record."""
    if profiles.time[0] > 0.0:
        return setting.void_fraction
    solid = profiles.row["solid_fraction"][0]
    if setting.follows:  # more of the sample lies above the window
        made = solid[profiles.height < setting.height]
        return max(0.0, 1.0 - float(made[len(made) // 4:].mean()))
    # The material ahead falls: what meets the front at a height started higher.
    low, high = fit.start + (fit.slope + setting.velocity) * profiles.time[fit.used[[0, -1]]]
    crossed = abs(profiles.height - 0.5 * (low + high)) < 0.5 * (high - low + setting.cell)
    return max(0.0, 1.0 - float(solid[crossed].mean()))


def wall_stress(folder, scene, profiles, fit):
    """Mean stress that the wall bears over the records of the fit, Pa; NaN where it cannot be told."""
    try:
        columns, _ = reader.read_history(folder)
        impulse = columns[f"wall_impulse_{'xyz'[len(scene['domain']['size']) - 1]}"]
    except (reader.Missing, KeyError):
        return numpy.nan
    ends = profiles.time[fit.used[[0, -1]]]
    high = scene["boundary"]["high"]
    high = high["kind"] if isinstance(high, dict) else high
    if high != "free" or ends[1] > columns["time"][-1]:
        return numpy.nan
    area = float(numpy.prod(scene["domain"]["size"][:-1]))
    return float(numpy.diff(numpy.interp(ends, columns["time"], impulse))[0] / (ends[1] - ends[0]) / area)


def references(setting, voids):
    """Rows (Us, Up, P, P, P, rho, T, T) of solid with strength, snow-plow and P-alpha; None where undefined."""
    def row(state, speed, stress):
        return (speed, setting.velocity, stress, stress, stress, state.density, state.temperature, state.temperature)

    try:
        solid = plate_exact.solve(setting.material, setting.velocity, setting.thermal).final
        first = row(solid, solid.front, solid.stress)
        plow = hugoniot.snow_plow(setting.material, voids, setting.velocity)
    except ValueError:
        raise reader.Missing("the impact is elastic, or beyond the equation of state") from None
    alpha = None
    if voids > POROUS:
        state = hugoniot.p_alpha(setting.material, voids, setting.velocity, setting.dimension)
        alpha = row(state, state.speed, state.pressure)
    return first, row(plow, plow.speed, plow.pressure), alpha


HEAD = ("quantity", "measured", "+-", "solid", "error", "snow-plow", "error", "P-alpha", "error")
QUANTITIES = (("Us [m/s]", 1.0, ".1f"), ("Up [m/s]", 1.0, ".1f"), ("P [GPa]", 1e9, ".4f"),
              ("momentum flux [GPa]", 1e9, ".4f"), ("P at the wall [GPa]", 1e9, ".4f"),
              ("rho [kg/m3]", 1.0, ".1f"), ("T [K]", 1.0, ".1f"), ("T + fluctuation / c_v [K]", 1.0, ".1f"))


@dataclass(frozen=True)
class Shock:
    """What was measured of the shock of a run, in the order of QUANTITIES, SI units, NaN where it is not known."""
    setting: Setting
    voids: float  # void fraction of what the front crossed, as it was made
    values: tuple
    errors: tuple
    curves: tuple  # of `references`
    notes: list  # sentences that say how it was measured


def method(setting, profiles, fit, state, voids):
    """Sentences that say how the numbers of a table were measured."""
    used = front_path(profiles, setting)[fit.used]
    notes = [
        f"Void fraction {voids:.4f} of what the front crosses, impact at {setting.velocity:g} m/s, "
        f"cell {1e6 * setting.cell:.4g} um.",
        f"Us: straight line through {len(used)} heights of the front from {1e3 * used[0]:.3f} to "
        f"{1e3 * used[-1]:.3f} mm above the wall ({1e9 * profiles.time[fit.used[0]]:.4g} to "
        f"{1e9 * profiles.time[fit.used[-1]]:.4g} ns), plus the velocity of the wall relative to the material "
        f"ahead; its +- is the standard error of the slope for independent heights, which scatter by "
        f"{1e6 * fit.scatter:.2g} um.",
        f"State: means over {state.records} of these records and the rows from {1e3 * state.low:.3f} mm "
        f"above the wall to {1e3 * state.distance:.3f} mm below the front; +- is the standard deviation between "
        f"records. {100.0 * max(state['void_fraction'], 0.0):.2f} % of these rows is void. P is the longitudinal "
        "stress and rho the density, of solid and voids together; the momentum flux has artificial viscosity and the "
        "residual motion beside the stress; P at the wall is the wall impulse over area and time.",
        "Curves: the solid with strength, complete collapse without strength (snow-plow), and P-alpha with the "
        f"static crush curve of {'cylinders' if setting.dimension == 2 else 'spheres'}."]
    if setting.follows:
        notes.append("The domain follows the front: heights of the front count from the wall as it would be without "
                     "strips, rows of the state from the wall that took the place of the last strip. The void fraction "
                     "is that of the first window without its lowest quarter.")
    if setting.thermal == "paper" and voids > POROUS:
        notes.append("The curves of porous material hold for thermal = \"conserving\"; in paper mode T leaves out heat "
                     "that they have.")
    return notes


def measure(folder):
    """The shock of a run."""
    scene = reader.read_scene(folder)
    setting, profiles = setting_of(scene), read(folder)
    fit = fit_front(profiles, setting)
    state = state_behind(profiles, setting, fit)
    voids = void_fraction(profiles, setting, fit)
    spread = dict(zip(state.names, state.spread))
    measured = (fit.slope + setting.velocity, state["velocity"], state["stress"], state["momentum_flux"],
                wall_stress(folder, scene, profiles, fit), state["density"], state["temperature"],
                state["temperature"] + state["fluctuation"] / setting.material.cv)
    errors = (fit.error, spread["velocity"], spread["stress"], spread["momentum_flux"], numpy.nan, spread["density"],
              spread["temperature"], numpy.nan)
    return Shock(setting, voids, measured, errors, references(setting, voids), method(setting, profiles, fit, state, voids))


def table_rows(shock):
    """Rows of the Hugoniot table (HEAD)."""
    rows = []
    for i, (name, unit, digits) in enumerate(QUANTITIES):
        if not numpy.isfinite(shock.values[i]):
            continue
        row = [name, format(shock.values[i] / unit, digits),
               format(shock.errors[i] / unit, digits) if numpy.isfinite(shock.errors[i]) else "-"]
        for curve in shock.curves:
            row += ["-", "-"] if curve is None else [
                format(curve[i] / unit, digits), f"{100.0 * (shock.values[i] / curve[i] - 1.0):+.2f} %"]
        rows.append(row)
    return rows
