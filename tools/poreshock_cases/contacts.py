"""Hard cases of grains in contact: waves through a contact, small and slender grains, crowded nodes."""
import math

import numpy

from poreshock_cases.program import particles
from poreshock_cases.table import check, limit, near

LAYERS = {"soft to stiff": (), "stiff to soft": (
    "body.0.material=stiff", "body.1.material=soft", "body.0.high=[40e-6, 4e-3]", "body.1.low=[0, 4e-3]",
    "body.1.high=[40e-6, 4.7e-3]", "time.end=1.35e-6")}
RESIDUAL = 1e-13  # of the impulses of a node


def impedance(material):
    """Density times longitudinal wave speed of an elastic material, kg/(m^2 s)."""
    nu = material["poisson"]
    modulus = material["young"] * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))
    return math.sqrt(material["density"] * modulus)


def layers(case, lab):
    """Wave from one grain into another of far other impedance."""
    rows = []
    for name, settings in LAYERS.items():
        run = lab.run(name.replace(" ", "_"), "hard/layers.toml", *settings)
        materials = {material["name"]: material for material in run.scene["material"]}
        first, second = (impedance(materials[body["material"]]) for body in run.scene["body"])
        state, face = run.particles(), run.scene["body"][1]["low"][1]
        # The numerical front is wide: only the cells next to the contact have seen all of it.
        cell = run.scene["domain"]["cell"]
        height = state["position"][:, 1]
        behind = (height > face + 3.0 * cell) & (height < face + 10.0 * cell)
        stress = -float(numpy.average(state["stress"][behind, 1], weights=state["mass"][behind]))
        incoming = first * run.scene["loading"]["velocity"]
        rows.append(near(case, f"{name}: transmitted over incoming stress", stress / incoming,
                         2.0 * second / (first + second), 0.03))
    return rows


def momentum_rows(case, run):
    """Momentum over all grains and at every node."""
    history = run.history
    start = max(abs(history[f"momentum_{axis}"][0]) for axis in "xy")
    change = max(float(numpy.max(abs(history[f"total_momentum_{axis}"] - history[f"total_momentum_{axis}"][0])))
                 for axis in "xy")
    return [limit(case, "change of momentum", change / start, RESIDUAL),
            limit(case, "largest momentum residual of a node", float(history["momentum_residual"].max()), RESIDUAL)]


def small(case, lab):
    """Grains of one to four particles on a block."""
    run = lab.run("small_grains", "hard/small_grains.toml")
    first, last = run.particles(0), run.particles()
    block = last["grain"] == first["grain"][numpy.argmax(numpy.bincount(first["grain"])[first["grain"]])]
    middle = float(numpy.mean(last["position"][block, 1]))
    lowest = float(numpy.min(last["position"][~block, 1]))
    speeds = [float(numpy.max(numpy.linalg.norm(particles(path)["velocity"], axis=1))) for path in run.snapshots]
    return [check(case, "particles lost", len(first["id"]) - len(last["id"]), "0", len(first["id"]) == len(last["id"])),
            check(case, "lowest small grain above the middle of the block, um", f"{1e6 * (lowest - middle):.1f}", "> 0",
                  lowest > middle),
            limit(case, "fastest particle, m/s", max(speeds), 1.01 * speeds[0], ".0f"), *momentum_rows(case, run)]


def slender(case, lab):
    """Needle that strikes another grain with its tip."""
    run = lab.run("needle_on_grain", "hard/needle_on_grain.toml")
    first, last = run.particles(0), run.particles()
    fastest = max(float(numpy.max(numpy.linalg.norm(particles(path)["velocity"], axis=1))) for path in run.snapshots)
    return [check(case, "particles lost", len(first["id"]) - len(last["id"]), "0",
                  len(first["id"]) == len(last["id"]) and run.escaped == 0),
            limit(case, "fastest particle, m/s", fastest, 5.0 * 300.0, ".0f"),
            limit(case, "largest momentum residual of a node", float(run.history["momentum_residual"].max()), RESIDUAL)]


def crowd(case, lab):
    """Crushed grains, three and four at a node."""
    run = lab.run("crowd", "hard/crowd.toml")
    history = run.history
    crowded = int(history["crowded_nodes"].max())
    # Heat of normal impulses may fall back when sides change the velocities once more, friction's may not.
    rubbed = float(numpy.min(numpy.diff(history["friction_heat"])) / history["friction_heat"][-1])
    return [check(case, "most nodes of three grains and more", crowded, "> 100", crowded > 100),
            *momentum_rows(case, run),
            check(case, "least step of the friction heat / its end", f"{rubbed:.1e}", ">= -1e-6", rubbed >= -1e-6)]
