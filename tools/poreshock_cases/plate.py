"""Measures the plane shock in a plate, and runs the plate.

The plateau is averaged over the middle half of the shocked length, so neither wall heating nor the
front counts. Compression is positive.
"""
from dataclasses import dataclass

import numpy

import plate_exact
import plate_release

FLIGHT = 0.75  # of the time the fastest wave needs to the free surface


@dataclass(frozen=True)
class Plateau:
    """What a snapshot says about the shocked material."""
    stress: float
    density: float
    temperature: float
    plastic_strain: float
    front: float
    noise: float  # standard deviation over mean of the particles' axial stress
    overshoot: float  # largest row mean of the axial stress behind the front over the plateau, minus 1


def axial_stress(particles):
    """Compressive stress along the shock axis of each particle, Pa."""
    # Order of the stress columns: xx yy zz xy, and in 3-D xx yy zz xy yz zx.
    return -particles["stress"][:, particles["position"].shape[1] - 1]


def row_means(particles, cell):
    """Centres of the rows of cells along the shock axis and the volume mean of the axial stress."""
    height = particles["position"][:, -1]
    row = numpy.floor(height / cell).astype(int)
    row -= row.min()
    volume = particles["mass"] / particles["density"]
    total = numpy.bincount(row, weights=volume)
    means = numpy.bincount(row, weights=volume * axial_stress(particles)) / numpy.where(
        total > 0.0, total, numpy.nan)
    return (numpy.floor(height.min() / cell) + 0.5 + numpy.arange(len(total))) * cell, means


def crossing(centres, means, level):
    """Height at which the row means, seen from the free surface, first rise above `level`."""
    above = numpy.flatnonzero(means > level)
    if len(above) == 0 or above[-1] == len(means) - 1:
        raise ValueError("no shock front was found between the wall and the free surface")
    i = above[-1]
    share = (means[i] - level) / (means[i] - means[i + 1])
    return centres[i] + share * (centres[i + 1] - centres[i])


def measure(particles, cell):
    """Plateau of the shocked material above a wall at coordinate 0."""
    centres, means = row_means(particles, cell)
    axial, height = axial_stress(particles), particles["position"][:, -1]
    level = 0.5 * numpy.nanmedian(means[means > 0.5 * numpy.nanmax(means)])
    for _ in range(2):  # the front and its plateau fix each other
        front = crossing(centres, means, level)
        inside = (height > 0.25 * front) & (height < 0.75 * front)
        mass = particles["mass"][inside]
        volume = mass / particles["density"][inside]
        stress = numpy.average(axial[inside], weights=volume)
        level = 0.5 * stress
    deviation = numpy.sqrt(numpy.average((axial[inside] - stress)**2, weights=volume))
    behind = centres > 0.25 * front
    return Plateau(stress, mass.sum() / volume.sum(),
                   numpy.average(particles["temperature"][inside], weights=mass),
                   numpy.average(particles["plastic_strain"][inside], weights=mass), front,
                   deviation / stress, numpy.nanmax(means[behind]) / stress - 1.0)


@dataclass(frozen=True)
class TwoWaves:
    """Heights of both fronts and the mean axial stress between them."""
    precursor: float
    front: float
    limit: float


def two_waves(particles, cell, plate):
    """Precursor and plastic front; the levels looked for come from the exact `plate`."""
    centres, means = row_means(particles, cell)
    limit, final = plate.precursor.stress, plate.final.stress
    precursor, front = (crossing(centres, means, level) for level in (0.5 * limit, 0.5 * (limit + final)))
    gap = precursor - front
    between = (centres > front + 0.4 * gap) & (centres < precursor - 0.3 * gap)
    return TwoWaves(precursor, front, float(numpy.mean(means[between])) if between.any() else numpy.nan)


def front_height(state, velocity, time):
    """Height of an exact front above the wall that the plate hit at `velocity`."""
    return (state.front - velocity) * time


def end_time(height, plate, beat=5e-9, flight=FLIGHT):
    """Last beat of the output before the fastest wave has gone through `flight` of the plate."""
    fastest = max(plate.final.front, plate.precursor.front if plate.precursor else 0.0)
    return float(f"{int(flight * height / fastest / beat) * beat:.12g}")


def shock(lab, name, velocity, *settings, cell=20e-6, height=5e-3, scene="plate_impact.toml",
          material=plate_exact.Material(), thermal="conserving", may_fail=False, start=None):
    """Runs a plate of four cells width, by `start` or lab.run, and returns the run and its exact solution."""
    plate = plate_exact.solve(material, velocity, thermal)
    lateral = [4 * cell] * (2 if "3d" in scene else 1)
    # Room above for rounding: a whole number of cells.
    size = [*lateral, (round(height / cell) + 4) * cell]
    run = (start or lab.run)(name, scene, f"thermal={thermal}", f"domain.cell={cell!r}",
                  "domain.size=[" + ", ".join(f"{length:.12g}" for length in size) + "]",
                  f"sample.height={height!r}", f"loading.velocity={velocity!r}", "output.snapshot=0.0",
                  f"time.end={end_time(height, plate)!r}", *settings, may_fail=may_fail)
    return run, plate


@dataclass(frozen=True)
class ReleasedPlate:
    """What a snapshot says about the material below a free surface; the target was at rest."""
    velocity: float
    temperature: float
    paper_excess: float  # largest of T - T_H(V) - W_p/c_v over the particles, K


def released(lab, name, velocity, kinematic_share=0.0, thermal="conserving", cell=20e-6, height=2e-3):
    """Runs a plate until its upper quarter is released; what was found there, and the exact end."""
    material = plate_exact.Material(kinematic_share=kinematic_share)
    shocked = plate_exact.solve(material, velocity, thermal).final
    # The slowest part of the rarefaction needs this long for the released quarter.
    end = round((height / shocked.front + 0.5 * height / material.c0) / 5e-9) * 5e-9
    run = shock(lab, name, velocity, f"material.0.kinematic_share={kinematic_share:g}", f"time.end={end:.12g}",
                cell=cell, height=height, thermal=thermal)[0]
    state, start = run.particles(), run.particles(0)["position"][:, -1]
    inside = (start > 0.72 * height) & (start < 0.95 * height)
    mean = {field: state[field][inside] for field in ("temperature", "density", "plastic_work")}
    reversible = numpy.array([plate_exact.reference_temperature(material, 1.0 / rho) for rho in mean["density"]])
    excess = numpy.max(abs(mean["temperature"] - reversible - mean["plastic_work"] / material.cv))
    # The snapshot's velocities are those over a wall at rest.
    return (ReleasedPlate(velocity + float(numpy.mean(state["velocity"][inside, -1])),
                          float(numpy.mean(mean["temperature"])), float(excess)),
            plate_release.release(material, shocked, thermal))
