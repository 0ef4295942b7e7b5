"""Hard cases with voids: very porous, thin ligament, void at the wall and at the free surface."""
import numpy

import plate_exact
from poreshock_cases.program import particles
from poreshock_cases.table import check, limit, near, shown
from poreshock_report.hugoniot import snow_plow


def wall_stress(run, first, last):
    """Mean stress on the wall between two times, from the momentum the material has lost, Pa."""
    time, momentum = run.history["time"], run.history["momentum_y"]
    a, b = (int(numpy.argmin(abs(time - instant))) for instant in (first, last))
    return (momentum[b] - momentum[a]) / (time[b] - time[a]) / run.scene["domain"]["size"][0]


def very_porous(case, lab):
    """Void fraction 0.6 at 3 km/s."""
    run = lab.run("very_porous", "hard/very_porous.toml")
    start, velocity = run.particles(0), run.scene["loading"]["velocity"]
    area = run.scene["domain"]["size"][0] * run.scene["sample"]["height"]
    density = start["mass"].sum() / area
    material = plate_exact.Material()
    plow = snow_plow(material, 1.0 - density / material.density, velocity)
    front, temperature = plow.speed, plow.temperature  # Us, the target at rest
    found = wall_stress(run, 40e-9, run.scene["time"]["end"])
    state = run.particles()
    top = (front - velocity) * state["time"]
    inside = (state["position"][:, 1] > 0.2 * top) & (state["position"][:, 1] < 0.8 * top)
    mean = float(numpy.average(state["temperature"][inside], weights=state["mass"][inside]))
    # Share of the compressed material's space that no particle takes.
    space = 0.6 * top * run.scene["domain"]["size"][0]
    unfilled = 1.0 - float(numpy.sum(state["mass"][inside] / state["density"][inside])) / space
    return [near(case, f"wall stress, void fraction {1.0 - density / 2700.0:.4f}", found, density * front * velocity,
                 0.05, unit=" GPa", scale=1e9),
            shown(case, "mean temperature behind the front", f"{mean:.0f} K (snow-plough {temperature:.0f} K)"),
            shown(case, "space behind the front that no particle fills", f"{100.0 * unfilled:.1f} %")]


def fastest(run):
    """Largest particle speed in any snapshot, m/s."""
    return max(float(numpy.max(numpy.linalg.norm(particles(path)["velocity"], axis=1))) for path in run.snapshots)


def lost(case, run):
    before, after = run.particles(0), run.particles()
    same = numpy.array_equal(before["id"], after["id"]) and numpy.array_equal(before["mass"], after["mass"])
    return check(case, f"{run.folder.name}: particles lost", len(before["id"]) - len(after["id"]),
                 "0, every mass the same", same and run.escaped == 0)


def ligament(case, lab):
    """Ligament of two or three particles."""
    run = lab.run("ligament", "hard/ligament.toml")
    return [limit(case, "fastest particle / impact speed", fastest(run) / 1100.0, 5.0, ".2f"), lost(case, run)]


def at_boundary(case, lab):
    """Void open to the wall, void open to the free surface."""
    rows = []
    for name, settings in (("wall", ()), ("surface", ("void.0.center=[0.2e-3, 0.5e-3]",))):
        run = lab.run(name, "hard/void_at_boundary.toml", *settings)
        momentum = run.history["momentum_y"]
        push = float(numpy.min(numpy.diff(momentum)) / abs(momentum[0]))
        rows += [check(case, f"{name}: least wall impulse per record / momentum", f"{push:.1e}", "> -1e-12",
                       push > -1e-12),
                 limit(case, f"{name}: fastest particle / impact speed", fastest(run) / 1100.0, 5.0, ".2f"),
                 lost(case, run)]
    return rows
