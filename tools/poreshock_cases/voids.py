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


def slot_histories(run):
    """Mean stress across the two layers of particles beside the slot's middle, tension positive, Pa, and the opening
    of the slot, m, by snapshot."""
    scene, start = run.scene, run.particles(0)
    low, high = scene["void"][0]["low"], scene["void"][0]["high"]
    cell, middle = scene["domain"]["cell"], 0.5 * (low[1] + high[1])
    length = high[0] - low[0]
    x, y = start["position"].T
    inside = (x > low[0] + length / 4.0) & (x < high[0] - length / 4.0)
    walls = inside & (abs(y - middle) < 0.5 * (high[1] - low[1]) + cell)
    upper = walls & (y > middle)
    stress, opening = [], []
    for path in run.snapshots:
        state = particles(path)
        # Some may have left the domain.
        beside = numpy.isin(state["id"], start["id"][walls])
        above = numpy.isin(state["id"], start["id"][upper])
        stress.append(float(numpy.average(state["stress"][beside, 1], weights=state["mass"][beside])))
        heights = state["position"][:, 1]
        opening.append(float(numpy.mean(heights[above]) - numpy.mean(heights[beside & ~above])) - cell)
    return numpy.array(stress), numpy.array(opening)


def closing(case, lab):
    """A slot that closes and is pulled open, and a gap that closes under shear."""
    slot = {name: slot_histories(lab.run(f"slot_{name}", "hard/closing_slot.toml", f"contact.self={name}"))
            for name in ("true", "false")}
    stress, opening = slot["true"]
    cell = 6.25e-6
    rows = [check(case, "slot, when closed: mean stress, GPa", f"{1e-9 * stress.min():.2f}", "< -0.5",
                  stress.min() < -0.5e9),
            limit(case, "slot: largest mean tension / largest compression", stress.max() / -stress.min(), 0.05),
            shown(case, "the same with contact.self = false",
                  f"{slot['false'][0].max() / -slot['false'][0].min():.2f}"),
            check(case, "slot: least and last opening, cells", f"{opening.min() / cell:.2f}, {opening[-1] / cell:.2f}",
                  "< 0.2, > 0.5", opening.min() < 0.2 * cell and opening[-1] > 0.5 * cell),
            shown(case, "the same with contact.self = false",
                  f"{slot['false'][1].min() / cell:.2f}, {slot['false'][1][-1] / cell:.2f}")]
    run = lab.run("plates", "hard/closing_plates.toml")
    first, last = run.particles(0), run.particles()
    upper = first["position"][:, 1] > 0.403e-3

    def relative(state, axis):
        velocity, mass = state["velocity"][:, axis], state["mass"]
        return numpy.average(velocity[upper], weights=mass[upper]) - numpy.average(velocity[~upper], weights=mass[~upper])

    pushed = int(numpy.max(run.history["contact_nodes"]))
    gap = float(numpy.min(last["position"][upper, 1]) - numpy.max(last["position"][~upper, 1])) - 0.5 * cell
    return rows + [
        near(case, "plates: sideways velocity left, m/s", float(relative(last, 0)), float(relative(first, 0)), 0.01),
        check(case, "plates: velocity apart, m/s; gap at the end, cells",
              f"{relative(last, 1):.0f}; {gap / cell:.1f}", "> 0; > 1", relative(last, 1) > 0.0 and gap > cell),
        check(case, "plates: most nodes that push", pushed, "> 0", pushed > 0)]
