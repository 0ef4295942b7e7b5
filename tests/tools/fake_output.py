"""Makes an output folder with the names and units of a run, from formulas instead of a run."""
import json

import h5py
import numpy

WIDTH, HEIGHT, CELL = 0.4e-3, 2.0e-3, 10e-6
SPEED, FRONT, HOT = 1100.0, 5700.0, 480.0  # m/s, m/s relative to the wall, K
WALL_STRESS = 6.9e9  # Pa
# Behind the made-up front: rows of the profiles, in SI units.
BEHIND = {"solid_fraction": 0.99, "density": 2850.0, "pressure": 6.8e9, "stress": 7.0e9, "momentum_flux": 7.1e9,
          "temperature": 980.0,
          "plastic_strain": 0.6, "velocity_x": 0.0, "velocity_y": 0.0, "fluctuation": 880.0}
AHEAD = {"solid_fraction": 0.7, "density": 2700.0, "pressure": 0.0, "stress": 0.0, "momentum_flux": 0.0,
         "temperature": 300.0,
         "plastic_strain": 0.0, "velocity_x": 0.0, "velocity_y": -SPEED, "fluctuation": 0.0}
THRESHOLDS = numpy.arange(310.0, 700.0, 10.0)

SCENE = """title = "Porous aluminium, made up"
thermal = "{thermal}"
[domain]
size = {size}
cell = 10e-6
[boundary]
low = {{ kind = "wall", velocity = 0.0 }}
high = {{ kind = "free", velocity = 0.0 }}
[loading]
velocity = {velocity}
[sample]
kind = "random_voids"
material = "aluminium"
height = 1.8e-3
porosity = 0.3
void_radius = 40e-6
[[material]]
name = "aluminium"
density = 2700.0
young = 69e9
poisson = 0.33
yield = 120e6
hardening = 384e6
c0 = 5350.0
lambda = 1.34
gamma = 2.0
cv = 880.0
T0 = 300.0
"""

HISTORY = ("time [s],step [-],dt [s],particles [-],kinetic [J/m],internal [J/m],escaped [J/m],"
           "wall_work [J/m],body_work [J/m],total [J/m],elastic [J/m],compression_work [J/m],plastic_work [J/m],"
           "viscous_heat [J/m],filter_heat [J/m],step_heat [J/m],wall_heat [J/m],contact_heat [J/m],"
           "friction_heat [J/m],conduction [J/m],momentum_x [kg/s],momentum_y [kg/s],wall_impulse_y [kg/s],"
           "guards [-]")


def sizes(dimension):
    """Edges of the domain, m."""
    return [WIDTH, HEIGHT] if dimension == 2 else [WIDTH, 4 * CELL, HEIGHT]


def _lattice(dimension):
    axes = [numpy.arange(CELL / 4, end, CELL / 2) for end in sizes(dimension)]
    points = numpy.stack([axis.ravel() for axis in numpy.meshgrid(*axes, indexing="ij")], axis=1)
    centers = numpy.random.default_rng(1).uniform((0, 0), (WIDTH, HEIGHT), (40, 2))
    flat = points[:, [0, -1]]
    near = numpy.min(numpy.linalg.norm(flat[:, None] - centers[None], axis=2), axis=1)
    return points[near > 25e-6], near[near > 25e-6]


def write_snapshots(folder, times, dimension):
    rest, near = _lattice(dimension)
    for number, time in enumerate(times):
        position = rest.copy()
        front = (FRONT - SPEED) * time
        position[:, -1] = rest[:, -1] - SPEED * time
        squeezed = rest[:, -1] * (1.0 - SPEED / FRONT)
        behind = squeezed < front
        position[:, -1] = numpy.where(behind, squeezed, position[:, -1])
        temperature = numpy.where(behind, HOT + 900.0 * numpy.exp(-((near - 25e-6) / 15e-6)), 300.0)
        with h5py.File(folder / f"snapshot_{number:06d}.h5", "w") as file:
            file.attrs.update(time=time, step=number * 100, version="0.1.0", revision="abc")
            data = {"position": position, "temperature": temperature,
                    "mass": numpy.full(len(rest), 2700.0 * (CELL / 2)**dimension),
                    "density": numpy.full(len(rest), 2700.0)}
            for name, values in data.items():
                file[f"particles/{name}"] = values
            write_map(file, position, temperature, dimension)


def write_map(file, position, temperature, dimension):
    """Mean temperature of the particles in each cell, NaN without any, the shock axis first."""
    edges = [numpy.arange(round(end / CELL) + 1) * CELL for end in sizes(dimension)]
    count, total = (numpy.histogramdd(position, edges, weights=weights)[0].T for weights in (None, temperature))
    file["map/temperature"] = numpy.where(count > 0, total / numpy.maximum(count, 1), numpy.nan)
    file["map/temperature"].attrs.update({f"low_{axis}": 0.0 for axis in "xyz"[:dimension]} | {"pixel": CELL, "unit": "K"})


def write_morphology(folder, times, dimension):
    """One small file per record, as a run that has not ended leaves them."""
    names = {"A": "A", "L": "L", "chi4": "chi4"} if dimension == 2 else {"A": "volume", "L": "S", "chi4": "chi6"}
    for number, time in enumerate(times):
        done = time / times[-1]
        hot = 1.0 / (1.0 + numpy.exp((THRESHOLDS - HOT) / 40.0))
        with h5py.File(folder / f"morphology_{number:06d}.h5", "w") as file:
            group = file.create_group("temperature")
            group["time"], group["threshold"], group["record"] = [time], THRESHOLDS, [number]
            group[names["A"]] = [done * hot]
            group[names["L"]] = [0.8 * done * hot * (1.0 - hot)]
            group["chi_paper"] = [-0.01 * done * (THRESHOLDS - HOT) / 100.0 * hot * (1.0 - hot)]
            # Every void counts as a hole of the pixels.
            group["chi"] = group["chi_paper"][()] - 0.05
            # At 550 K and above half of chi is a matter of how pixels join.
            group[names["chi4"]] = group["chi"][()] * numpy.where(THRESHOLDS < 550.0, 1.0, 1.5)
            if dimension == 3:
                group["M"] = [0.1 * done * hot * (1.0 - hot)]
            # One hot spot more each record.
            group["domains/record"] = numpy.full(number, number)
            group["domains/threshold"] = numpy.full(number, 600.0)
            group["domains/area" if dimension == 2 else "domains/volume"] = 10.0**(-5 * dimension) * numpy.arange(1.0, number + 1.0)
            group["domains/peak"] = 650.0 + 10.0 * numpy.arange(number)


def write_profiles(folder, times, speed=3300.0, whole=True):
    """A sharp front of shock speed `speed` in profiles.h5, or in one small file per record."""
    height = CELL * (numpy.arange(round(HEIGHT / CELL)) + 0.5)
    front = (speed - SPEED) * numpy.asarray(times)
    top = 1.8e-3 - SPEED * numpy.asarray(times)
    behind, solid = height < front[:, None], height < top[:, None]
    row = {name: numpy.where(solid, numpy.where(behind, BEHIND[name], AHEAD[name]), numpy.nan) for name in BEHIND}
    row["solid_fraction"] = numpy.where(solid, row["solid_fraction"], 0.0)
    common = {"time": numpy.asarray(times), "step": numpy.arange(len(times)), "record": numpy.arange(len(times))}
    row |= common | {"shift": numpy.zeros(len(times))}
    fronts = common | {"position": numpy.where(front > 0.0, front, numpy.nan), "width": numpy.full(len(times), CELL)}
    pieces = [slice(None)] if whole else [slice(i, i + 1) for i in range(len(times))]
    for i, piece in enumerate(pieces):
        with h5py.File(folder / ("profiles.h5" if whole else f"profile_{i:06d}.h5"), "w") as file:
            file["row/height"] = height
            for group, columns in (("row", row), ("front", fronts)):
                for name, values in columns.items():
                    file[f"{group}/{name}"] = values[piece]


def write_history(folder, times):
    rows = [HISTORY]
    for number, time in enumerate(times):
        kinetic, done = 1000.0 * (1.0 - 0.8 * time / times[-1]), 800.0 * time / times[-1]
        total = 1000.0 * (1.0 + 1e-13 * number)
        rows.append(",".join(f"{entry:.17g}" for entry in (
            time, number * 10, 1e-10, 48000, kinetic, total - kinetic, 0, 0, 0, total, 0.05 * done, 0,
            0.4 * done, 0.5 * done, 0.03 * done, 0.01 * done, 0.01 * done, 0, 0, 0, 0, -1.0 + time,
            WALL_STRESS * WIDTH * time, 3)))
    (folder / "history.csv").write_text("\n".join(rows) + "\n1.0,2")  # the last row is cut


def write_timings(folder):
    phases = {name: {"min": seconds, "avg": 1.1 * seconds, "max": 1.2 * seconds, "calls": 1000}
              for name, seconds in (("particles_to_grid", 41.0), ("stress", 62.0), ("exchange", 3.0))}
    (folder / "timings.json").write_text(json.dumps({
        "ranks": 2, "wall_seconds": 123.5, "steps": 1000, "particle_steps": 48000000,
        "rate_per_core": 194331.0, "phases": phases,
        "warnings": ["A void is only \"8\" cells across."]}))


def write_output(folder, thermal="paper", dimension=2):
    """Fills `folder` with everything the report reads."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scene.toml").write_text(SCENE.format(thermal=thermal, velocity=SPEED, size=sizes(dimension)))
    write_snapshots(folder, [0.0, 50e-9, 100e-9, 150e-9, 200e-9], dimension)
    write_morphology(folder, numpy.linspace(0.0, 200e-9, 21), dimension)
    write_profiles(folder, numpy.linspace(0.0, 200e-9, 41))
    write_history(folder, numpy.linspace(0.0, 200e-9, 101))
    write_timings(folder)
