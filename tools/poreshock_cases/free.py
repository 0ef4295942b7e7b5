"""Hard cases without a plane shock: rest, free flight, rotation, needle, spray."""
import numpy

from poreshock_cases.program import particles
from poreshock_cases.table import check, limit, near, shown

BULK = 2700.0 * 5350.0**2  # Pa, of the aluminium of all scenes
SCHEMES = {  # name: settings
    "default": (),
    "cubic AFLIP": ("transfer.velocity=aflip",),
    "cubic PolyPIC": ("transfer.velocity=polypic",),
    "cubic APIC": ("transfer.velocity=apic",),
    "cubic FLIP": ("transfer.velocity=flip",),
    "quadratic AFLIP": ("transfer.shape=quadratic",),
    "quadratic APIC": ("transfer.shape=quadratic", "transfer.velocity=apic"),
    "lineage": ("transfer.preset=lineage",),
}


def speed(run):
    return numpy.linalg.norm(run.particles()["velocity"], axis=1)


def largest_stress(run):
    return float(numpy.max(abs(run.particles()["stress"])))


def rest(case, lab):
    """Block on the wall, 1e5 steps."""
    run = lab.run("rest", "hard/block.toml", "boundary.low=wall", "time.max_steps=100000",
                  "domain.size=[80e-6, 0.4e-3]", "body.0.low=[0, 0]", "body.0.high=[80e-6, 0.2e-3]")
    heat = float(numpy.max(abs(run.particles()["temperature"] - 300.0)))
    return [limit(case, "largest speed after 1e5 steps, m/s", float(numpy.max(speed(run))), 1e-12 * 5350.0),
            limit(case, "temperature drift, K", heat, 1e-9)]


def flight(case, lab):
    """Block that flies through the grid along both axes for 1e4 steps, in several schemes."""
    rows = []
    for name, settings in SCHEMES.items():
        run = lab.run(name.replace(" ", "_"), "hard/block.toml",
                      "loading.frame=[1100, -200]", *settings)
        history = run.history
        momentum = max(abs(history[f"momentum_{axis}"][-1] / history[f"momentum_{axis}"][0] - 1.0)
                       for axis in "xy")
        rows += [limit(case, f"{name}: largest stress / K0", largest_stress(run) / BULK, 1e-9),
                 limit(case, f"{name}: change of momentum", momentum, 1e-14)]
    return rows


def angular_momentum(state, centre, inertia):
    """Of a checkpoint's particles about `centre`; each affine field adds `inertia` (m^2) times its spin."""
    x, y = (state[f"position_{axis}"] - centre[axis] for axis in (0, 1))
    spin = state["affine_2"] - state["affine_1"] if "affine_2" in state else 0.0
    return float(numpy.sum(state["mass"] * (x * state["velocity_1"] - y * state["velocity_0"] + inertia * spin)))


def von_mises(state, inside=slice(None)):
    """Mass mean over the particles `inside`, Pa."""
    xx, yy, zz, xy = state["stress"][inside].T
    square = 0.5 * ((xx - yy)**2 + (yy - zz)**2 + (zz - xx)**2) + 3.0 * xy**2
    return float(numpy.average(numpy.sqrt(square), weights=state["mass"][inside]))


def centre_stress(state, centre, radius):
    """Mean in-plane stress of the particles within `radius` of the centre, Pa."""
    near_it = numpy.linalg.norm(state["position"] - centre, axis=1) < radius
    return float(numpy.mean(0.5 * (state["stress"][near_it, 0] + state["stress"][near_it, 1])))


def exact_centre_stress(run):
    """Spinning cylinder in plane strain, (3 - 2 nu)/(8 (1 - nu)) rho omega^2 R^2 (Timoshenko)."""
    material, body = run.scene["material"][0], run.scene["body"][0]
    shear = material["young"] / (2.0 * (1.0 + material["poisson"]))
    nu = (3.0 * BULK - 2.0 * shear) / (2.0 * (3.0 * BULK + shear))
    # The radius of the area that the particles have.
    area = run.particles(0)["mass"].sum() / material["density"]
    return (3.0 - 2.0 * nu) / (8.0 * (1.0 - nu)) * material["density"] * body["spin"]**2 * area / numpy.pi


def momentum_change(run):
    """Largest relative change of the angular momentum of an APIC run, over its checkpoints."""
    body, start = run.scene["body"][0], run.particles(0)
    inertia = run.scene["domain"]["cell"]**2 / 3.0
    state = {"mass": start["mass"], "affine_1": -body["spin"], "affine_2": body["spin"]}
    state |= {f"{name}_{axis}": start[name][:, axis] for name in ("position", "velocity") for axis in (0, 1)}
    before = angular_momentum(state, body["center"], inertia)
    return max(abs(angular_momentum(particles(path), body["center"], inertia) / before - 1.0)
               for path in run.folder.glob("checkpoint_*.h5"))


def spinning(case, lab):
    """Elastic disc, ten turns with APIC, two with the default and with FLIP."""
    # Limited viscosity lets the disc breathe, and instants are compared.
    run = lab.run("apic", "hard/spinning_disc.toml", *SCHEMES["cubic APIC"], "viscosity.limited=false")
    body, cell = run.scene["body"][0], run.scene["domain"]["cell"]
    turns = [particles(path) for path in run.snapshots]
    centre = numpy.mean([centre_stress(turn, body["center"], 1.5 * cell) for turn in turns[5:]])

    def drift(radius):
        inside = numpy.linalg.norm(turns[0]["position"] - body["center"], axis=1) < radius
        return (von_mises(turns[10], inside) / von_mises(turns[5], inside) - 1.0) / 5.0

    rows = [limit(case, "APIC: change of angular momentum in ten turns", momentum_change(run), 1e-10),
            limit(case, "APIC: drift per turn of the mean von Mises stress, turns 5 to 10", drift(1.0), 1e-3),
            limit(case, "APIC: the same inside 0.7 of the radius", drift(0.7 * body["radius"]), 1e-3),
            near(case, "APIC: stress at the centre, turns 5 to 10", centre, exact_centre_stress(run), 0.05,
                 unit=" MPa", scale=1e6)]
    for name in ("default", "cubic FLIP"):
        two = lab.run(name.replace(" ", "_"), "hard/spinning_disc.toml", *SCHEMES[name], "time.end=10.053e-6")
        strain = float(numpy.max(two.particles()["plastic_strain"]))
        lost = 1.0 - two.history["kinetic"][-1] / two.history["kinetic"][0]
        rows.append(shown(case, f"{name}, two turns: kinetic energy lost, largest plastic strain",
                          f"{100.0 * lost:.1f} %, {strain:.3f}"))
    return rows


def spray(case, lab):
    """Single particles over a hundred cells."""
    rows = []
    for name in ("default", "cubic APIC", "cubic FLIP", "quadratic AFLIP", "quadratic APIC"):
        run = lab.run(name.replace(" ", "_"), "hard/spray.toml", *SCHEMES[name])
        first, last = run.particles(0), run.particles()
        change = numpy.linalg.norm(last["velocity"] - first["velocity"], axis=1)
        path = numpy.max(abs(last["position"] - first["position"])) / run.scene["domain"]["cell"]
        heat = float(numpy.max(abs(last["temperature"] - first["temperature"])))
        rows += [limit(case, f"{name}: change of velocity over {path:.0f} cells",
                       float(numpy.max(change / numpy.linalg.norm(first["velocity"], axis=1))), 1e-10),
                 limit(case, f"{name}: change of temperature, K", heat, 1e-9),
                 check(case, f"{name}: particles", len(last["id"]), "4", len(last["id"]) == 4)]
    return rows


def pieces(position, reach):
    """Number of pieces when particles closer than `reach` hang together."""
    left, count = set(range(len(position))), 0
    while left:
        count += 1
        front = [left.pop()]
        while front:
            others = numpy.fromiter(left, int, len(left))
            if len(others) == 0:
                break
            close = others[numpy.linalg.norm(position[others] - position[front.pop()], axis=1) < reach]
            left.difference_update(close.tolist())
            front += close.tolist()
    return count


def needle(case, lab):
    """Needle that strikes the wall with its tip."""
    run = lab.run("needle", "hard/needle.toml")
    first, last = run.particles(0), run.particles()
    cell = run.scene["domain"]["cell"]
    fastest = max(float(numpy.max(numpy.linalg.norm(particles(path)["velocity"], axis=1))) for path in run.snapshots)
    push = float(numpy.min(numpy.diff(run.history["momentum_y"])) / abs(run.history["momentum_y"][0]))
    return [check(case, "particles lost", len(first["id"]) - len(last["id"]), "0",
                  len(first["id"]) == len(last["id"]) and run.escaped == 0),
            limit(case, "fastest particle, m/s", fastest, 5.0 * 300.0, ".0f"),
            check(case, "least wall impulse per record / momentum", f"{push:.1e}", "> -1e-12", push > -1e-12),
            shown(case, "pieces farther apart than 1.5 cells at the end", pieces(last["position"], 1.5 * cell))]
