#!/usr/bin/python3
"""Exact release of a plane shock: the state that a rarefaction leaves in an elastic-plastic solid.

The path is an elastic unloading and then reverse plastic flow, integrated in small steps of ln V with
dE = -(P + s) dV and du = sqrt(-d(P + s) dV). All plastic work becomes heat. Stresses are positive in
compression. Run by itself it prints the free-surface table for aluminium.
"""
import math
from dataclasses import dataclass

import plate_exact

STEP = 1e-5  # of ln V


@dataclass(frozen=True)
class Released:
    """A state on the path; `gain` is the particle velocity that the rarefaction has added, m/s."""
    volume: float
    pressure: float
    deviator: float
    back_stress: float
    energy: float  # J/kg
    plastic_strain: float
    plastic_work: float  # J/kg
    gain: float

    @property
    def stress(self):
        return self.pressure + self.deviator


def flow(material, before, opening):
    """Deviator, back stress, plastic strain and plastic work (J/m^3) after ln V grew by `opening`."""
    isotropic = (1.0 - material.kinematic_share) * material.hardening
    kinematic = material.kinematic_share * material.hardening
    trial = before.deviator - 4.0 / 3.0 * material.shear * opening
    excess = 1.5 * abs(trial - before.back_stress) - (
        material.yield_stress + isotropic * before.plastic_strain)
    if excess <= 0.0 or material.shear == 0.0:
        return trial, before.back_stress, before.plastic_strain, 0.0
    step = excess / (3.0 * material.shear + isotropic + kinematic)
    sign = math.copysign(1.0, trial - before.back_stress)
    after = trial - 2.0 * material.shear * step * sign
    return (after, before.back_stress + 2.0 / 3.0 * kinematic * step * sign,
            before.plastic_strain + step, 1.5 * sign * 0.5 * (before.deviator + after) * step)


def expand(material, before, thermal, opening):
    """State after ln V grew by `opening`."""
    volume = before.volume * math.exp(opening)
    deviator, back_stress, strain, heat = flow(material, before, opening)
    work = before.plastic_work + 0.5 * (before.volume + volume) * heat
    reference, reference_energy = plate_exact.reference(material, volume)
    g, opened = material.gamma / volume, volume - before.volume
    if thermal == "paper":
        pressure = reference + g * work
    else:
        # E = E_before - (stress_before + P + s) dV/2 and P = reference + g (E - e_d - E_r): linear in P.
        known = (before.energy - 0.5 * opened * (before.stress + deviator)
                 - plate_exact.elastic_energy(material, volume, deviator) - reference_energy)
        pressure = (reference + g * known) / (1.0 + 0.5 * g * opened)
    fall = before.stress - pressure - deviator
    return Released(volume, pressure, deviator, back_stress,
                    before.energy - 0.5 * opened * (before.stress + pressure + deviator), strain, work,
                    before.gain + math.sqrt(max(fall, 0.0) * opened))


def release(material, shocked, thermal="conserving", gain=None):
    """Path end from the state behind a shock: at zero stress, or where the gain is `gain`, m/s."""
    back = 2.0 / 3.0 * material.kinematic_share * material.hardening * shocked.plastic_strain
    state = Released(shocked.volume, shocked.pressure, shocked.deviator, back, shocked.energy,
                     shocked.plastic_strain, shocked.plastic_work, 0.0)
    while True:
        after = expand(material, state, thermal, STEP)
        if gain is None:
            share = state.stress / (state.stress - after.stress)
        else:
            share = (gain - state.gain) / (after.gain - state.gain)
        if share <= 1.0:
            return expand(material, state, thermal, share * STEP)
        state = after


def temperature(material, state, thermal="conserving"):
    """Temperature of a state on the path, K."""
    heat = state.plastic_work if thermal == "paper" else (
        state.energy - plate_exact.elastic_energy(material, state.volume, state.deviator)
        - plate_exact.reference(material, state.volume)[1])
    return plate_exact.reference_temperature(material, state.volume) + heat / material.cv


def main():
    laws = [plate_exact.Material(kinematic_share=share) for share in (0.0, 1.0)]
    print("| Up | u_fs iso (kin) | T_res iso (kin) |\n" + "|---" * 3 + "|")
    for velocity in (300, 500, 700, 900, 1000, 1100, 1300, 1500, 2000):
        ends = [release(law, plate_exact.solve(law, velocity).final) for law in laws]
        speed = [f"{velocity + end.gain:.2f}" for end in ends]
        heat = [f"{temperature(law, end):.2f}" for law, end in zip(laws, ends)]
        print(f"| {velocity} | {speed[0]} ({speed[1]}) | {heat[0]} ({heat[1]}) |")


if __name__ == "__main__":
    main()
