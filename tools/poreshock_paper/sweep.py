"""Tables of runs: which there are, which are done, and running those that are not."""
import csv
import fcntl
import hashlib
import itertools
import json
import os
import re
import signal
import subprocess
import threading
import time
import tomllib
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy

from poreshock_cases.program import ROOT, CaseError
from poreshock_report import folder as reader

LONGEST_NAME = 120  # most file systems take 255 bytes, of which endings and temporary names need some


@dataclass(frozen=True)
class Case:
    """One run: its name, its scene and the KEY=VALUE settings that make it."""
    name: str
    scene: Path
    settings: tuple


@dataclass(frozen=True)
class Table:
    """Runs of one file: where they go and on how many ranks each."""
    folder: Path
    ranks: int
    cases: tuple


def toml_value(value):
    """A value of a TOML file as the program reads it in a setting."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return "[" + ",".join(toml_value(entry) for entry in value) + "]"
    if isinstance(value, dict):
        return "{" + ",".join(f"{key}={toml_value(entry)}" for key, entry in value.items()) + "}"
    return json.dumps(value) if isinstance(value, str) else repr(value)


def settings_of(values):
    return tuple(f"{key}={toml_value(value)}" for key, value in values.items())


def plain(text):
    """A text that can be part of a folder's name."""
    return re.sub(r"[^A-Za-z0-9.+-]+", "_", text).strip("_")


def run_name(parts):
    """The name of a run from its parts; a long one, which no file system takes, ends in a hash of all of it."""
    name = "-".join(parts)
    if len(name) <= LONGEST_NAME:
        return name
    return f"{name[:LONGEST_NAME - 11]}-{hashlib.sha256(name.encode()).hexdigest()[:10]}"


def expand(path):
    """The table of a file; ValueError says what is wrong with it."""
    content = tomllib.loads(path.read_text())
    unknown = set(content) - {"scene", "output", "ranks", "set", "vary", "option"}
    if unknown or "scene" not in content:
        raise ValueError(f"{path}: found {', '.join(sorted(unknown)) or 'no scene'}; allowed are scene (needed), output, "
                         "ranks, [set], [vary] and [[option]]")
    scene = path.parent / content["scene"]
    if not scene.exists():
        raise ValueError(f"{path}: scene: there is no file {scene}")
    vary = content.get("vary", {})
    wrong = [key for key, values in vary.items() if not isinstance(values, list) or not values]
    if wrong:
        raise ValueError(f"{path}: vary: found no list for {', '.join(wrong)}; allowed are lists of values")
    options = content.get("option", [{}])
    cases = []
    for option, values in itertools.product(options, itertools.product(*vary.values())):
        chosen = dict(zip(vary, values))
        parts = [f"{key.split('.')[-1]}_{plain(toml_value(value))}" for key, value in chosen.items()]
        parts += [plain(option["name"])] if "name" in option else []
        settings = content.get("set", {}) | chosen | option.get("set", {})
        cases.append(Case(run_name(parts or [scene.stem]), scene, settings_of(settings)))
    names = [case.name for case in cases]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise ValueError(f"{path}: these runs have the same name: {', '.join(twice)}; name the options apart")
    return Table(path.parent / content.get("output", Path("output") / path.stem), int(content.get("ranks", 1)), tuple(cases))


def marker(folder, case):
    return folder / f"{case.name}.json"


def fingerprint(case):
    return {"scene": case.scene.read_text(), "settings": list(case.settings)}


def is_done(folder, case):
    """Whether this very run has reached its end: same scene, same settings, output still there."""
    try:
        stored = json.loads(marker(folder, case).read_text())
    except (OSError, json.JSONDecodeError):
        return False
    same = all(stored.get(key) == value for key, value in fingerprint(case).items())
    return same and (folder / case.name / "timings.json").exists()


def tell_state(folder, cases, text):
    """Prints which cases are done, and text(case)."""
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # a reader that stops early, as head does, is no fault
    for case in cases:
        print("done   " if is_done(folder, case) else "missing", text(case))


@contextmanager
def held(folder, case):
    """True in its body where no other worker, here or on another machine, has this run in hand."""
    with (folder / f"{case.name}.lock").open("w") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            yield False
            return
        yield True


def started_alike(target, case):
    """Whether a folder holds a run of this scene and settings that was cut off with a checkpoint."""
    try:
        stored = json.loads((target / "sweep.json").read_text())
    except (OSError, json.JSONDecodeError):
        return False
    return stored == fingerprint(case) and any(target.glob("checkpoint_*.h5"))


def execute(folder, case, ranks, program):
    """Runs one case to its end, from its last checkpoint where there is one; CaseError when it fails."""
    target = folder / case.name
    command = [ROOT / "tools/mpirun", "-n", ranks, program, "run", case.scene, "--output", target, "--quiet"]
    command += ["--restart", "latest"] if started_alike(target, case) else ["--force"]
    for setting in case.settings:
        command += ["--set", setting]
    target.mkdir(parents=True, exist_ok=True)
    (target / "sweep.json").write_text(json.dumps(fingerprint(case)))
    start = time.monotonic()
    with (folder / f"{case.name}.log").open("w") as log:
        code = subprocess.run([str(part) for part in command], stdout=log, stderr=subprocess.STDOUT, check=False,
                              env=os.environ | {"OMPI_MCA_mpi_yield_when_idle": "1"}).returncode
    text = (folder / f"{case.name}.log").read_text()
    if code != 0 or not re.search(r"^finished at step", text, re.M):
        own = text.split("\n-----")[0]  # what mpirun adds says nothing more
        raise CaseError(f"{case.name}: exit code {code}: {' '.join(own.split())[-400:]}")
    marker(folder, case).write_text(json.dumps(fingerprint(case) | {"seconds": time.monotonic() - start}))


def run(folder, cases, ranks, jobs, program, say=print):
    """Runs what is not done, `jobs` at a time; returns the names of the runs that failed."""
    folder.mkdir(parents=True, exist_ok=True)
    failed, lock = [], threading.Lock()
    todo = [case for case in cases if not is_done(folder, case)]
    say(f"{len(cases)} runs, {len(cases) - len(todo)} done already")

    def one(case):
        with held(folder, case) as ours:
            # Another worker may have had it in hand, or have finished it meanwhile.
            if not ours or is_done(folder, case):
                return
            start = time.monotonic()
            try:
                execute(folder, case, ranks, program)
                say(f"{case.name}: done in {time.monotonic() - start:.0f} s")
            except CaseError as problem:
                with lock:
                    failed.append(case.name)
                say(f"failed: {problem}")

    with ThreadPoolExecutor(jobs) as pool:
        list(pool.map(one, todo))
    return failed


def end_of_loading(times, thresholds, area, levels=None):
    """Number of the record in which the mean of the field above the lowest threshold is largest. `levels` are the
    values at thresholds that are quantiles, of which the lowest moves too and is added where it is reached."""
    if levels is not None:
        steps = (0.5 * (area[:, 1:] + area[:, :-1]) * numpy.diff(levels)).sum(axis=1)
        return int(numpy.nanargmax(levels[:, 0] * area[:, 0] + steps))
    mean = 0.5 * (area[:, 1:] + area[:, :-1]) @ numpy.diff(thresholds) if len(thresholds) > 1 else area[:, 0]
    return int(numpy.argmax(mean))


def row_of(folder, case):
    """One row of the collected table."""
    target = folder / case.name
    row = {"run": case.name} | dict(setting.split("=", 1) for setting in case.settings)
    timings = reader.read_timings(target)
    wanted = ("wall_seconds", "ranks", "steps", "particle_steps", "rate_per_core")
    row |= {key: timings[key] for key in wanted if key in timings}
    columns, units = reader.read_history(target)
    total = columns["total"]
    row["energy drift [1]"] = float(numpy.max(numpy.abs(total - total[0])) / (abs(total[0]) or 1.0))
    row |= {f"{name} at the end [{units[name]}]": values[-1] for name, values in columns.items()}
    try:
        times, thresholds, arrays = reader.read_morphology(target, names=("A",))
        row["end of loading [s]"] = times[end_of_loading(times, thresholds, arrays["A"], reader.read_levels(target))]
    except reader.Missing:
        pass  # a run without morphology has none
    return row


def collect(folder, cases, path):
    """Writes one CSV row per run that is done; returns how many."""
    rows = [row_of(folder, case) for case in cases if is_done(folder, case)]
    names = list(dict.fromkeys(name for row in rows for name in row))
    temporary = path.with_suffix(".tmp")
    with temporary.open("w", newline="") as file:
        writer = csv.DictWriter(file, names, restval="")
        writer.writeheader()
        writer.writerows(rows)
    temporary.rename(path)
    return len(rows)
