"""Hugoniots of porous solids: states behind one steady shock that compacts the material.

All use the complete equation of state of the program: P = P_r(V) + gamma / V (E - E_r(V)) and
T = T_r(V) + (E - E_r(V)) / c_v, with the Hugoniot of the solid as reference below V0 and the isentrope
with P linear in V above. Behind a shock from rest E = Up^2 / 2, P (V00 - V) = Up^2 and
Us = Up V00 / (V00 - V), with V00 = V0 / (1 - void fraction). Pressures are positive in compression.
"""
import math
from dataclasses import dataclass

from plate_exact import reference, reference_temperature


@dataclass(frozen=True)
class Shock:
    """State behind a shock of a porous solid; `speed` is relative to the material ahead, m/s."""
    speed: float
    pressure: float  # Pa, over solid and voids together
    density: float  # kg/m^3, over solid and voids together
    temperature: float  # K
    void_fraction: float


def pressure_of(material, volume, energy):
    """Pressure of the solid at a volume (m^3/kg) and an energy (J/kg), Pa."""
    pressure, cold = reference(material, volume)
    return pressure + material.gamma / volume * (energy - cold)


def least_volume(material):
    """Volume that no shock reaches, m^3/kg: pole of the reference curve, or its Grueneisen limit."""
    rest = 1.0 / material.density
    return rest * max(1.0 - 1.0 / material.gruneisen_slope, material.gamma / (2.0 + material.gamma))


def bisect(function, low, high):
    """Root of a function that is positive at `low` and falls below zero at `high`."""
    for _ in range(200):
        middle = 0.5 * (low + high)
        if function(middle) > 0.0:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


def shock(material, void_fraction, velocity, volume, alpha):
    """The state at a volume of solid and voids together, from momentum, mass and energy."""
    start = 1.0 / (material.density * (1.0 - void_fraction))
    energy = 0.5 * velocity**2
    cold = reference(material, volume / alpha)[1]
    temperature = float(reference_temperature(material, volume / alpha))
    return Shock(speed=velocity * start / (start - volume), pressure=velocity**2 / (start - volume),
                 density=1.0 / volume, temperature=temperature + (energy - cold) / material.cv,
                 void_fraction=1.0 - 1.0 / alpha)


def snow_plow(material, void_fraction, velocity):
    """Complete collapse without strength (Zel'dovich & Raizer ch. XI; McQueen et al. 1970).

    Without voids this is the Hugoniot of the solid without strength. The usual closed form
    P = P_H [2 V - gamma (V0 - V)] / [2 V - gamma (V00 - V)] is 0 / 0 where V = V0 at every velocity.
    """
    start = 1.0 / (material.density * (1.0 - void_fraction))
    energy = 0.5 * velocity**2
    volume = bisect(lambda v: pressure_of(material, v, energy) * (start - v) - velocity**2,
                    least_volume(material) * (1.0 + 1e-9), start)
    return shock(material, void_fraction, velocity, volume, 1.0)


def crush_strength(material, dimension):
    """k of P = k ln(alpha / (alpha - 1)): cylinders in plane strain, spheres in 3-D (Carroll & Holt 1972)."""
    return material.yield_stress * (1.0 / math.sqrt(3.0) if dimension == 2 else 2.0 / 3.0)


def crush_pressure(material, void_fraction, dimension):
    """Pressure at which the voids begin to collapse, Pa."""
    return -crush_strength(material, dimension) * math.log(void_fraction)


def distension(material, void_fraction, dimension, pressure):
    """alpha = total over solid volume on the static crush curve of a perfectly plastic matrix."""
    strength = crush_strength(material, dimension)
    if strength == 0.0:
        return 1.0
    crushed = -1.0 / math.expm1(-pressure / strength) if pressure > 0.0 else math.inf
    return min(1.0 / (1.0 - void_fraction), crushed)


def p_alpha(material, void_fraction, velocity, dimension=2):
    """P-alpha (Herrmann 1969): P = P_solid(V / alpha, E) / alpha on the static crush curve."""
    start = 1.0 / (material.density * (1.0 - void_fraction))
    energy = 0.5 * velocity**2

    def excess(pressure):
        alpha = distension(material, void_fraction, dimension, pressure)
        solid = max((start - velocity**2 / pressure) / alpha, least_volume(material) * (1.0 + 1e-9))
        return pressure_of(material, solid, energy) - alpha * pressure

    highest = 2.0 * snow_plow(material, void_fraction, velocity).pressure + material.density * material.c0**2
    pressure = bisect(excess, velocity**2 / start, highest)
    return shock(material, void_fraction, velocity, start - velocity**2 / pressure,
                 distension(material, void_fraction, dimension, pressure))
