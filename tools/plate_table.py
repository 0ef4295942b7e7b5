#!/usr/bin/python3
"""Compares plane impacts of a solid plate with the exact solution and prints a markdown table.

Runs SCENE once per impact velocity (--reuse compares runs that are already there) and averages the
last snapshot over the middle half of the shocked length, so neither wall heating nor the front counts.
"""
import argparse
import subprocess
import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy

import plate_exact

ROOT = Path(__file__).resolve().parent.parent
FLIGHT = 0.75  # of the time the fastest wave needs to the free surface
FIELDS = ("position", "mass", "density", "stress", "temperature", "internal_energy", "kinetic_energy")


@dataclass(frozen=True)
class Plateau:
    """What a snapshot says about the shocked material; compression is positive."""
    stress: float
    density: float
    temperature: float
    front: float


def row_means(particles, cell):
    """Centres of the rows of cells along the shock axis and the volume mean of the axial stress."""
    height = particles["position"][:, -1]
    row = numpy.floor(height / cell).astype(int)
    row -= row.min()
    volume = particles["mass"] / particles["density"]
    # Order of the stress columns: xx yy zz xy, and in 3-D xx yy zz xy yz zx.
    axial = -particles["stress"][:, particles["position"].shape[1] - 1]
    total = numpy.bincount(row, weights=volume)
    means = numpy.bincount(row, weights=volume * axial) / numpy.where(total > 0.0, total, numpy.nan)
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
    level = 0.5 * numpy.nanmedian(means[means > 0.5 * numpy.nanmax(means)])
    for _ in range(2):  # the front and its plateau fix each other
        front = crossing(centres, means, level)
        inside = (particles["position"][:, -1] > 0.25 * front) & (
            particles["position"][:, -1] < 0.75 * front)
        mass = particles["mass"][inside]
        volume = mass / particles["density"][inside]
        column = particles["position"].shape[1] - 1
        stress = -numpy.average(particles["stress"][inside, column], weights=volume)
        level = 0.5 * stress
    return Plateau(stress, mass.sum() / volume.sum(),
                   numpy.average(particles["temperature"][inside], weights=mass), front)


def energy(particles):
    """Kinetic and internal energy of all particles as a reader of a snapshot adds them up."""
    return float(numpy.sum(particles["mass"] * (
        particles["kinetic_energy"] + particles["internal_energy"])))


def read(path):
    """Time and the particle fields of a snapshot."""
    with h5py.File(path, "r") as file:
        return (float(numpy.ravel(file.attrs["time"])[0]),
                {name: file["particles"][name][()] for name in FIELDS})


def end_time(scene, plate):
    """Last beat of the output before the fastest wave has gone through most of the plate."""
    fastest = max(plate.final.front, plate.precursor.front if plate.precursor else 0.0)
    beat = scene.get("output", {}).get("beat", 5e-9)
    beats = int(FLIGHT * scene["sample"]["height"] / fastest / beat)
    return float(f"{beats * beat:.12g}")


def run(scene_path, folder, velocity, end, ranks, settings):
    """Runs poreshock; its log goes to <folder>.log."""
    command = [ROOT / "tools/mpirun", "-n", str(ranks), ROOT / "build/release/poreshock", "run",
               scene_path, "--output", folder, "--force"]
    for setting in [f"loading.velocity={velocity!r}", f"time.end={end!r}", *settings]:
        command += ["--set", setting]
    log = folder.with_name(folder.name + ".log")
    with log.open("w") as file:
        if subprocess.run(command, stdout=file, stderr=subprocess.STDOUT, check=False).returncode != 0:
            raise ValueError(f"the run at {velocity} m/s failed; see {log}")


def compare(folder, velocity, material):
    """Row of the table for the run in `folder`."""
    scene = tomllib.loads((folder / "scene.toml").read_text())
    snapshots = sorted(read(path)[0:1] + (path,) for path in folder.glob("snapshot_*.h5"))
    if len(snapshots) < 2:
        raise ValueError(f"{folder} holds {len(snapshots)} snapshots; the first and the last are needed")
    before, (time, after) = read(snapshots[0][1])[1], read(snapshots[-1][1])
    exact = plate_exact.solve(material, velocity)
    found = measure(after, scene["domain"]["cell"])
    final, rest = exact.final, material.T0
    front = (final.front - velocity) * time
    drift = energy(after) / energy(before) - 1.0

    def error(value, reference):
        return f"{100.0 * (value / reference - 1.0):+.2f} %"

    return (f"| {velocity:g} | {'two waves' if exact.precursor else 'one'} "
            f"| {found.stress / 1e9:.4f} | {final.stress / 1e9:.4f} | {error(found.stress, final.stress)} "
            f"| {found.density:.2f} | {final.density:.2f} | {error(found.density, final.density)} "
            f"| {found.temperature - rest:.1f} | {final.temperature - rest:.1f} "
            f"| {error(found.temperature - rest, final.temperature - rest)} "
            f"| {1e3 * found.front:.4f} | {1e3 * front:.4f} "
            f"| {(found.front - front) / scene['domain']['cell']:+.2f} | {drift:+.1e} |")


HEAD = ("| Up m/s | waves | sigma GPa | exact | error | rho kg/m3 | exact | error | T rise K | exact | error "
        "| front mm | exact | error in cells | energy drift |")


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--scene", type=Path, default=ROOT / "input/plate_impact.toml")
    parser.add_argument("--output", type=Path, default=ROOT / "output/plate_table",
                        help="folder that gets one folder per run")
    parser.add_argument("--velocities", type=float, nargs="+", metavar="UP", help="m/s",
                        default=[300.0, 500.0, 700.0, 900.0, 1100.0, 1300.0, 1500.0, 2000.0])
    parser.add_argument("--ranks", type=int, default=2)
    parser.add_argument("--set", dest="settings", action="append", default=[], metavar="KEY=VALUE",
                        help="passed to every run")
    parser.add_argument("--reuse", action="store_true", help="compare the runs that are already there")
    return parser.parse_args(arguments)


def main(arguments):
    options = parse(arguments)
    try:
        scene = tomllib.loads(options.scene.read_text())
        material = plate_exact.material_from_scene(scene["material"][0])
        options.output.mkdir(parents=True, exist_ok=True)
        rows = []
        for velocity in options.velocities:
            folder = options.output / f"{velocity:g}"
            if not (options.reuse and folder.exists()):
                end = end_time(scene, plate_exact.solve(material, velocity))
                run(options.scene, folder, velocity, end, options.ranks, options.settings)
            rows.append(compare(folder, velocity, material))
            print(f"{velocity:g} m/s done", file=sys.stderr)
        resolved = tomllib.loads((folder / "scene.toml").read_text())
    except (OSError, KeyError, ValueError) as problem:
        print(f"tools/plate_table.py: {problem}", file=sys.stderr)
        return 1
    print(f"Scene {options.scene.name}, thermal = \"{resolved['thermal']}\""
          + ("; the exact solution is that of \"conserving\"" if resolved["thermal"] == "paper" else "")
          + f". Cell {1e6 * resolved['domain']['cell']:g} um.\n\n{HEAD}\n" + "|---" * 15 + "|")
    print("\n".join(rows))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
