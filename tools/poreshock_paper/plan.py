"""The runs that the figures of the paper need."""
import math
from dataclasses import dataclass, field
from pathlib import Path

import plate_exact
from poreshock_cases.program import ROOT
from poreshock_paper.sweep import Case, settings_of
from poreshock_report.hugoniot import snow_plow

NS = 1e-9
START = 300.0  # K
HEIGHT = 5e-3  # m
REFERENCE = 1100  # m/s
LOW, HIGH = 0.077, 0.46  # void fractions of the paper
FIGURE_4A = (700, 900, 1000, 1100, 1200, 1300, 1400, 1500)  # m/s
FIGURE_4B = (900, 1000, 1100, 1200, 1300, 1400, 1500)
LEVEL_4A, LEVELS_7A = 120, (120, 150, 180, 200)  # K above the start, of the reference
LEVEL_4B, LEVELS_7B = 300, (280, 300, 320, 350, 380)
FIGURE_8 = (0.077, 0.12, 0.2, 0.3, 0.4, 0.46, 0.55)
LEVELS_8 = (120, 200, 250, 300)
FIGURE_2 = (50, 100, 150, 200, 250)
FIGURE_1 = (500, 750, 850, 1100)  # ns
FIGURE_6 = 500  # ns


@dataclass(frozen=True)
class Study:
    """What is run: width and cell in metres, seeds of the samples, thermal models of figures 4 to 8."""
    width: float
    cell: float
    seeds: tuple
    thermals: tuple
    finer: bool  # the reference on half the cell too
    radius: float = 40e-6
    scene: Path = field(default=ROOT / "input/paper/fig1.toml")


FULL = Study(width=1e-3, cell=10e-6, seeds=(1, 2, 3), thermals=("paper", "conserving"), finer=True)
QUICK = Study(width=0.5e-3, cell=12.5e-6, seeds=(1,), thermals=("paper",), finer=False)


def loading_time(porosity, velocity):
    """Seconds that the shock needs through the sample, by complete collapse without strength."""
    return HEIGHT / snow_plow(plate_exact.Material(), porosity, velocity).speed


def ends(porosity, velocity):
    """End of a run: no earlier than its loading, with a margin, and that of all of its porosity it is compared with."""
    slowest = {LOW: min(FIGURE_4A), HIGH: min(FIGURE_4B)}
    last = loading_time(porosity, velocity)
    if porosity in slowest:
        last = max(last, loading_time(porosity, slowest[porosity] if velocity == REFERENCE else REFERENCE))
    end = 1.08 * last + 20 * NS
    if (porosity, velocity) == (LOW, REFERENCE):
        end = max(end, max(FIGURE_1) * NS)
    return float(f"{10 * round(end / (10 * NS))}e-9")


def settings(study, porosity, velocity, seed, thermal, **more):
    """Settings of a run; `more` are keys of the scene with __ for the point."""
    row = 2.0 * study.cell  # the largest cell and pixel of the variants
    high = row * math.ceil(round(1.1 * HEIGHT / row, 6))  # there is room to fly up
    snapshot = 0.0
    if (porosity, thermal, seed) == (LOW, "paper", study.seeds[0]):
        snapshot = 50 * NS if velocity == REFERENCE else FIGURE_6 * NS
    values = {"domain.size": [study.width, float(f"{high:.9g}")], "domain.cell": study.cell, "thermal": thermal,
              "sample.porosity": porosity, "sample.seed": seed, "sample.void_radius": study.radius,
              "loading.velocity": float(velocity), "time.end": ends(porosity, velocity), "profile.every": 0.0,
              "output.snapshot": snapshot, "output.history": 10 * NS, "morphology.every": 10 * NS,
              "morphology.thresholds": {"from": 302, "to": 1200 if porosity > LOW else 900, "step": 1},
              "checkpoint.every_wall": 600.0, "checkpoint.keep": 1}
    return settings_of(values | {key.replace("__", "."): value for key, value in more.items()})


def case(study, porosity, velocity, seed, thermal="paper"):
    return Case(f"{thermal}-p{porosity:g}-v{velocity}-s{seed}", study.scene,
                settings(study, porosity, velocity, seed, thermal))


def reference(study, porosity=LOW, seed=None, thermal="paper"):
    return case(study, porosity, REFERENCE, study.seeds[0] if seed is None else seed, thermal)


def figure_4(study, porosity, seed, thermal):
    """Runs of Figure 4 and 7 of one sample, by velocity."""
    velocities = FIGURE_4A if porosity == LOW else FIGURE_4B
    return {velocity: case(study, porosity, velocity, seed, thermal) for velocity in velocities}


def figure_8(study, seed, thermal):
    """Runs of Figure 8 of one sample, by void fraction."""
    return {porosity: case(study, porosity, REFERENCE, seed, thermal) for porosity in FIGURE_8}


def solid(study):
    """A plate without voids: the temperature of uniform material."""
    return Case("paper-solid-v1100", study.scene, settings(
        study, LOW, REFERENCE, 1, "paper", sample__kind="solid", domain__size=[float(f"{4 * study.cell:.9g}"), 1.12 * HEIGHT], output__snapshot=50 * NS,
        time__end=1100 * NS))


def variants(study):
    """The reference with one thing changed, by what is changed."""
    cell, seed = study.cell, study.seeds[0]
    changes = {"conserving": {"thermal": "conserving"},
               "conserving, conduction": {"thermal": "conserving", "conduction__on": True},
               "conduction": {"conduction__on": True},
               "pixel of half a cell": {"morphology__pixel": 0.5 * cell},
               "pixel of two cells": {"morphology__pixel": 2.0 * cell},
               "cells twice as large": {"domain__cell": 2.0 * cell, "morphology__pixel": 2.0 * cell},
               "voids of 30 um": {"sample__void_radius": 30e-6},
               "voids of 60 um": {"sample__void_radius": 60e-6},
               "APIC": {"transfer__velocity": "apic"},
               "unlimited viscosity": {"viscosity__limited": False},
               "lineage": {"transfer__preset": "lineage"}}
    if study.finer:
        changes["cells half as large"] = {"domain__cell": 0.5 * cell, "morphology__pixel": 0.5 * cell}
    found = {}
    for name, change in changes.items():
        label = "variant-" + name.replace(", ", "-").replace(" ", "_")
        found[name] = Case(label, study.scene, settings(study, LOW, REFERENCE, seed, **{"thermal": "paper", "output__snapshot": 0.0, "time__end": 1100 * NS} | change))
    return found


def all_cases(study):
    """Every run once, the reference first."""
    cases = [reference(study), solid(study)]
    for thermal in study.thermals:
        for seed in study.seeds:
            cases += [*figure_4(study, LOW, seed, thermal).values(), *figure_4(study, HIGH, seed, thermal).values(),
                      *figure_8(study, seed, thermal).values()]
    cases += variants(study).values()
    return tuple(dict.fromkeys(cases))
