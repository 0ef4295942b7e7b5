#!/usr/bin/python3
"""Exact plane shock of an elastic-plastic Mie-Grueneisen solid that hits a rigid wall.

Two jumps: rest -> yield at ln(V0/V) = Y/2G, then yield -> final; or one jump where the plastic front
would overtake the elastic one. Each keeps momentum, mass and energy; P(V, E) is linear in E; the
elastic energy of the deviator is kept out of the equation of state. Stresses are positive in
compression here. With thermal = "paper" pressure and temperature follow eqs 4-7 of the paper, from
volume and plastic work alone. Run by itself it prints the table for aluminium.
"""
import math
import signal
from dataclasses import dataclass

import numpy

NODES, WEIGHTS = numpy.polynomial.legendre.leggauss(40)


@dataclass(frozen=True)
class Material:
    """Names and SI units of [[material]] in a scene; the defaults are the aluminium of the paper."""
    density: float = 2700.0
    young: float = 69e9
    poisson: float = 0.33
    yield_stress: float = 120e6  # `yield` in a scene
    hardening: float = 384e6
    c0: float = 5350.0
    kinematic_share: float = 0.0
    gruneisen_slope: float = 1.34  # `lambda` in a scene
    gamma: float = 2.0
    cv: float = 880.0
    T0: float = 300.0

    @property
    def shear(self):
        return self.young / (2.0 * (1.0 + self.poisson))


def material_from_scene(table):
    """Material of a [[material]] table of a scene."""
    renamed = {"yield": "yield_stress", "lambda": "gruneisen_slope"}
    known = {renamed.get(key, key): value for key, value in table.items()}
    return Material(**{key: known[key] for key in Material.__dataclass_fields__ if key in known})


@dataclass(frozen=True)
class State:
    """State behind a jump; `front` is the speed of the jump in the frame where the solid was at rest."""
    front: float
    velocity: float
    volume: float
    pressure: float
    deviator: float
    energy: float  # all internal energy per mass, J/kg
    temperature: float
    plastic_strain: float
    plastic_work: float  # J/kg

    @property
    def stress(self):
        return self.pressure + self.deviator

    @property
    def density(self):
        return 1.0 / self.volume


@dataclass(frozen=True)
class Plate:
    """Plane impact: the final state, and the elastic precursor or None where it is overdriven."""
    final: State
    precursor: State | None


def reference_temperature(material, volume):
    """Temperature of the strengthless solid on its Hugoniot, in tension on its isentrope, K."""
    compression = 1.0 - volume * material.density
    s = 0.5 * max(compression, 0.0) * (NODES + 1.0)
    slope = material.gruneisen_slope
    integral = 0.5 * max(compression, 0.0) * numpy.sum(
        WEIGHTS * s**2 * (1.0 - s)**material.gamma / (1.0 - slope * s)**3)
    heat = slope * material.c0**2 / material.cv * integral
    return (material.T0 + heat) / (1.0 - compression)**material.gamma


def reference(material, volume):
    """Pressure and energy of the reference curve: the Hugoniot, in tension linear in the volume."""
    rest = 1.0 / material.density
    compression = 1.0 - volume / rest
    slope = material.gruneisen_slope if compression > 0.0 else 0.0
    pressure = material.density * material.c0**2 * compression / (1.0 - slope * compression)**2
    return pressure, 0.5 * pressure * (rest - volume)


def elastic_energy(material, volume, deviator):
    """Energy per mass of the deviator in uniaxial strain, s:s V/(4 G), J/kg."""
    return 0.375 * volume * deviator**2 / material.shear if material.shear > 0.0 else 0.0


def plastic_work(material, strain):
    """Plastic work per mass of a monotonic uniaxial compression to a plastic strain, J/kg."""
    s = 0.5 * strain * (NODES + 1.0)
    flow = material.yield_stress + material.hardening * s
    # ln(V0/V) = (Y + (3 G + H) e)/(2 G) while it flows.
    closing = (flow + 3.0 * material.shear * s) / (2.0 * material.shear)
    return 0.5 * strain * float(numpy.sum(WEIGHTS * flow * numpy.exp(-closing))) / material.density


def jump(material, before, volume, thermal="conserving"):
    """State behind a jump from `before` to `volume` by momentum, mass and energy."""
    strain = math.log(1.0 / (material.density * volume))
    excess = 2.0 * material.shear * strain - material.yield_stress
    flows = excess > 0.0 and material.shear > 0.0
    plastic = excess / (3.0 * material.shear + material.hardening) if flows else 0.0
    work = plastic_work(material, plastic) if flows else 0.0
    deviator = 2.0 * material.shear * (2.0 / 3.0 * strain - plastic)
    pressure, reference_energy = reference(material, volume)
    g = material.gamma / volume
    half = 0.5 * (before.volume - volume)
    if thermal == "paper":
        thermal_energy = work
        pressure += g * work
    else:
        # energy = before.energy + half (before.stress + P + deviator) and
        # P = reference + g (energy - elastic_energy - reference_energy): linear in P.
        known = (before.energy + half * (before.stress + deviator)
                 - elastic_energy(material, volume, deviator) - reference_energy)
        pressure = (pressure + g * known) / (1.0 - g * half)
        thermal_energy = known + half * pressure
    rise = pressure + deviator - before.stress
    return State(
        front=before.velocity + before.volume * math.sqrt(rise / (before.volume - volume)),
        velocity=before.velocity + math.sqrt(rise * (before.volume - volume)),
        volume=volume, pressure=pressure, deviator=deviator,
        energy=before.energy + half * (before.stress + pressure + deviator),
        temperature=reference_temperature(material, volume) + thermal_energy / material.cv,
        plastic_strain=plastic, plastic_work=work)


def jump_to_velocity(material, before, velocity, thermal="conserving"):
    """State behind the jump from `before` that moves the solid at `velocity`."""
    # A complete compression is limited both by the reference curve and by the energy it takes.
    rest = 1.0 / material.density
    least = 1.0 - 1.0 / material.gruneisen_slope
    if thermal == "conserving":
        least = max(least, material.gamma / (2.0 + material.gamma))
    high = before.volume * (1.0 - 1e-12)
    # The velocity rises with the compression, but close to the limit a second jump has a root that is none.
    volumes = numpy.linspace(high, least * rest * (1.0 + 1e-9), 200)[1:]
    low = next((volume for volume in volumes if jump(material, before, volume, thermal).velocity >= velocity), None)
    if low is None:
        raise ValueError(f"an impact at {velocity} m/s is beyond the equation of state")
    for _ in range(200):
        middle = 0.5 * (low + high)
        if jump(material, before, middle, thermal).velocity > velocity:
            low = middle
        else:
            high = middle
    return jump(material, before, 0.5 * (low + high), thermal)


def at_rest(material):
    """State of the undisturbed solid."""
    return State(0.0, 0.0, 1.0 / material.density, 0.0, 0.0, 0.0, material.T0, 0.0, 0.0)


def solve(material, velocity, thermal="conserving"):
    """Plate of `material` that hits a rigid wall at `velocity`, m/s, above its elastic limit.

    A fluid, with no shear modulus or no yield stress, has one wave.
    """
    rest = at_rest(material)
    if material.yield_stress == 0.0 or material.shear == 0.0:
        return Plate(jump_to_velocity(material, rest, velocity, thermal), None)
    limit = jump(material, rest,
                 rest.volume * math.exp(-material.yield_stress / (2.0 * material.shear)), thermal)
    if velocity <= limit.velocity:
        raise ValueError(f"an impact at {velocity} m/s is elastic; the yield starts at "
                         f"{limit.velocity:.4g} m/s")
    final = jump_to_velocity(material, limit, velocity, thermal)
    if final.front <= limit.front:
        return Plate(final, limit)
    return Plate(jump_to_velocity(material, rest, velocity, thermal), None)


def main():
    print("| Up | D_pl | rho | P GPa | sigma GPa | s MPa | eps_p | T K |\n" + "|---" * 8 + "|")
    for velocity in (100, 300, 500, 700, 900, 1000, 1100, 1300, 1500, 2000):
        state = solve(Material(), velocity).final
        print(f"| {velocity} | {state.front:.1f} | {state.density:.3f} | {state.pressure / 1e9:.5f} "
              f"| {state.stress / 1e9:.5f} | {state.deviator / 1e6:.2f} | {state.plastic_strain:.5f} "
              f"| {state.temperature:.2f} |")


if __name__ == "__main__":
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # a reader that stops early, as head does, is no fault
    main()
