"""The verification table: the plane shock over all velocities in both thermal modes, and what the
tests of the label `verification` print."""
import re
import shlex
import subprocess
from concurrent.futures import ThreadPoolExecutor
from functools import partial

from poreshock_cases import impact, plate
from poreshock_cases.always import DRIFT
from poreshock_cases.catalogue import LIMITERS
from poreshock_cases.program import Lab
from poreshock_cases.table import Row, check

CELL = 10e-6  # m
VELOCITIES = (300.0, 500.0, 700.0, 900.0, 1100.0, 1500.0, 2000.0, 3000.0)
ALL = " / ".join(f"{velocity:g}" for velocity in VELOCITIES)
# Figure: unit, bar from 700 m/s on, bar below.
BARS = {
    "stress": ("%", 0.3, 0.3),
    "density": ("%", 0.1, 0.1),
    "temperature rise": ("%", 1.0, 1.5),
    "plastic strain": ("%", 1.0, 1.0),
    "particle noise of the stress": ("%", 1.0, 1.0),
    "overshoot behind the front": ("%", 3.0, 3.0),
    "front position": ("cells", 1.0, 1.0),
    "energy drift": ("", DRIFT, DRIFT),
}
FAST = 700.0  # m/s
VERIFY = re.compile(r"^(?:\d+: )?(VERIFY .*)$", re.M)


def errors(lab, thermal, velocity, cell=CELL, height=5e-3, scene="plate_impact.toml"):
    """Figures of one plate against the exact solution of its thermal mode, in the units of BARS."""
    run, exact = plate.shock(lab, f"{thermal}_{velocity:g}", velocity, thermal=thermal, cell=cell, height=height,
                             scene=scene)
    state, final = run.particles(), exact.final
    found = plate.measure(state, cell)

    def percent(value, reference):
        return 100.0 * (value / reference - 1.0)

    return {"stress": percent(found.stress, final.stress), "density": percent(found.density, final.density),
            "temperature rise": percent(found.temperature - 300.0, final.temperature - 300.0),
            "plastic strain": percent(found.plastic_strain, final.plastic_strain),
            "particle noise of the stress": 100.0 * found.noise,
            "overshoot behind the front": 100.0 * found.overshoot,
            "front position": (found.front - plate.front_height(final, velocity, state["time"])) / cell,
            "energy drift": run.drift}


def bar(name, velocity):
    """Largest size a figure may have."""
    _, fast, slow = BARS[name]
    return fast if velocity >= FAST else slow


def number(name, value):
    if name == "energy drift":
        return f"{value:.0e}"
    return f"{value:.2f}" if name.startswith(("particle", "overshoot")) else f"{value:+.2f}"


def rows_of_plates(case, found):
    """A row per figure with the values of all velocities; `found` is {velocity: figures}."""
    rows = []
    for name, (unit, fast, slow) in BARS.items():
        values = {velocity: figures[name] for velocity, figures in found.items()}
        bars = f"{fast:g} {unit}".strip()
        if slow != fast and min(values) < FAST:
            bars += f", below {FAST:g} m/s {slow:g} {unit}"
        missed = [f"{velocity:g}" for velocity, value in values.items() if not abs(value) < bar(name, velocity)]
        text = f"{' / '.join(number(name, value) for value in values.values())} {unit}".strip()
        rows.append(check(case, name, text + (f"; missed at {', '.join(missed)}" if missed else ""), bars,
                          not missed))
    return rows


def plates(lab, jobs):
    """Rows of all velocities in both thermal modes, and of the plate in three dimensions."""
    rows = []
    with ThreadPoolExecutor(jobs) as pool:
        for thermal in ("conserving", "paper"):
            found = pool.map(partial(errors, lab, thermal), VELOCITIES)
            rows += rows_of_plates(f"plate, {thermal}, {ALL} m/s", dict(zip(VELOCITIES, found)))
    solid = Lab(lab.folder / "3d", lab.ranks, lab.program)
    figures = errors(solid, "conserving", 1100.0, 20e-6, 2.5e-3, "plate_impact_3d.toml")
    return rows + rows_of_plates("plate in 3-D, 1100 m/s, 20 um cells", {1100.0: figures})


def other_waves(lab, jobs):
    """Rows of the two-wave structure, the release and the moving frames."""
    cases = {"two waves, 5 mm": impact.two_waves, "release, 1100 m/s": partial(impact.release, cell=CELL),
             "moving plate, 1100 m/s": partial(impact.moving_plates, cell=CELL)}

    def judge(case):
        return cases[case](case, Lab(lab.folder / case.split(",")[0].replace(" ", "_"), lab.ranks, lab.program))

    with ThreadPoolExecutor(jobs) as pool:
        return [row for found in pool.map(judge, cases) for row in found]


def parse_verify(text):
    """Rows of the lines VERIFY <case> <figure> <value> <bar> <pass|fail>; words with blanks are quoted."""
    rows = []
    for line in VERIFY.findall(text):
        words = shlex.split(line)
        if len(words) != 6 or words[5] not in ("pass", "fail"):
            raise ValueError(f"found the line \"{line}\", wanted VERIFY <case> <figure> <value> <bar> <pass|fail>")
        rows.append(Row(*words[1:5], words[5] == "pass"))
    return rows


def tests(build):
    """Rows that the tests of the label `verification` print, and one for a test that fails."""
    subprocess.run(["cmake", "--build", build, "--target", "slow_tests"], capture_output=True, check=True)
    done = subprocess.run(["ctest", "--test-dir", build, "-L", "verification", "-V"], text=True, capture_output=True,
                          check=False)
    # The same test on several numbers of ranks prints the same lines.
    rows = list(dict.fromkeys(parse_verify(done.stdout)))
    # A miss that a test knows does not fail it, so a failure is something else: a limit of time, an error.
    if done.returncode != 0:
        failed = re.findall(r"^\s*\d+ - (\S+) \(", done.stdout, re.M)
        rows.append(check("tests", "label verification", ", ".join(failed) or f"ctest ended with {done.returncode}",
                          "all pass", False))
    return rows


GAPS = ("Collapsed voids leave gaps on 5 um cells, 1.8 % of the space at void fraction 0.3 and 4.9 % at 0.46, which make the "
        "front too fast: 1 % of density is 2.5 % of Us. With 2.5 um they are 1.7 % at 0.46.")
SOUND = ("The energy behind the front is right, but sound still swings there: the pressure by 5.4 GPa (standard "
         "deviation) at void fraction 0.077 and 4.4 GPa at 0.3, whose elastic energy would be 39 and 50 K.")
RIM = ("What the crossing of cells takes from the stress at the rim of a turning disc is lost for good, less so the finer "
       "the cells.")
KNOWN = {
    ("rotation_cubic_apic", "von_mises_drift_per_turn"): RIM,
    ("rotation_aflip", "von_mises_drift_per_turn"): RIM,
    ("rotation_residual_stress", "von_mises_drift_per_turn"): RIM,
    ("rotation_residual_stress", "von_mises_drift_per_turn_inner_half"): RIM,
    ("rotation_residual_stress", "drift_ratio_20_10_inner_half"): RIM,
    ("vibration_polyflip", "loss_ratio_64_32"):
        "PolyFLIP loses 7e-5 in ten periods at 32 cells, a hundredth and less of what the others lose, and no longer of "
        "their order.",
    ("vortex_aflip_0.2", "return_displacement_error_160"):
        "Transfers that keep the velocity of a particle are further off than those that keep nothing; the error falls with "
        "the second order.",
    ("porous Hugoniot, void fraction 0.3, 1100 m/s, 5 um, 4 samples", "Us"): GAPS,
    ("porous Hugoniot, void fraction 0.46, 1100 m/s, 2.5 um, one sample", "Us"): GAPS,
    ("porous Hugoniot, void fraction 0.46, 1100 m/s, 2.5 um, one sample", "rise of mean T + fluctuation / c_v"): SOUND,
} | {
    ("porous Hugoniot, void fraction 0.46, 1100 m/s, 5 um, 4 samples", figure): GAPS
    for figure in ("Us", "P at the wall", "P behind the front")
} | {(case, figure): LIMITERS for case, figures in {
    "invariance_aflip": ("mirror_100", "shift_100")}.items() for figure in figures} | {
        (f"porous Hugoniot, void fraction {voids:g}, 1100 m/s, 5 um, 4 samples", figure): SOUND
        for voids in (0.077, 0.3) for figure in ("rise of mean T", "rise of mean T + fluctuation / c_v")}
