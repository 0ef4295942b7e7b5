#!/usr/bin/python3
"""Prints the paper's numbers for its first case beside those of a run of input/paper/fig1*.toml.

usage: tools/paper_numbers.py FOLDER [FOLDER...]

Area fractions come from morphology.h5 at the thresholds 350 ... 550 K; extremes of the particles from
the snapshots. Loading ends when the area above 350 K is largest.
"""
import pathlib
import signal
import sys

import h5py
import numpy as np

from poreshock_report import folder as reader

# Figure 2 and its text: rise above 300 K, area fraction at the end of loading.
PAPER_AREA = {50: 1.0, 100: 1.0, 150: 0.82, 200: 0.31, 250: 0.07}


def areas(folder):
    """Times (s) and area fraction per temperature rise (K)."""
    with h5py.File(folder / "morphology.h5") as file:
        group = file["temperature"]
        thresholds = group["threshold"][:].reshape(-1)[: group["A"].shape[1]]
        columns = {rise: int(np.argmin(abs(thresholds - 300.0 - rise))) for rise in PAPER_AREA}
        return group["time"][:], {rise: group["A"][:, k] for rise, k in columns.items()}


def extremes(folder, end_of_loading):
    """Largest mass fractions above 80 GPa and 5000 K, and the coldest particle before and after."""
    result = {"80 GPa": 0.0, "5000 K": 0.0, "cold": 0.0, "coldest before": np.inf, "coldest": np.inf}
    for path in sorted(folder.glob("snapshot_*.h5")):
        with h5py.File(path) as file:
            time = file.attrs["time"]
            particles = file["particles"]
            mass, T = particles["mass"][:], particles["temperature"][:]
            pressure = particles["pressure"][:]
        result["80 GPa"] = max(result["80 GPa"], mass[pressure > 80e9].sum() / mass.sum())
        result["5000 K"] = max(result["5000 K"], mass[T > 5000.0].sum() / mass.sum())
        result["coldest"] = min(result["coldest"], T.min())
        if time <= end_of_loading:
            result["coldest before"] = min(result["coldest before"], T.min())
            result["cold"] = max(result["cold"], mass[T < 299.0].sum() / mass.sum())
    return result


def column(folder):
    """The figures of one run, in the order of the rows."""
    time, area = areas(folder)
    end = int(np.argmax(area[50]))
    rows = [f"{time[end] * 1e9:.0f} ns"]
    at_750 = int(np.argmin(abs(time - 750e-9)))
    rows.append(" / ".join(f"{area[rise][at_750]:.3f}" for rise in (50, 100)))
    rows.append(" / ".join(f"{area[rise][end]:.3f}" for rise in (50, 100)))
    rows += [f"{area[rise][end]:.3f}" for rise in (150, 200, 250)]
    found = extremes(folder, time[end])
    rows += [f"{found['80 GPa']:.2e}", f"{found['5000 K']:.2e}",
             f"{found['coldest before']:.1f} K ({found['cold']:.1e} of the mass)",
             f"{found['coldest']:.1f} K"]
    history, _ = reader.read_history(folder)
    return rows + [f"{100.0 * reader.numerical_share(history)[-1]:.1f} %", f"{reader.drift(history).max():.1e}",
                   f"{history['guards'][-1]:.0f}"]


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        print(__doc__)
        return 2
    folders = [pathlib.Path(name) for name in sys.argv[1:]]
    labels = ["end of loading", "A(50 K) / A(100 K) at 750 ns",
              "A(50 K) / A(100 K) at the end of loading", "A(150 K) at the end of loading",
              "A(200 K)", "A(250 K)", "largest mass fraction above 80 GPa",
              "largest mass fraction above 5000 K", "coldest particle while loading (mass below 299 K)",
              "coldest particle ever", "numerical dissipation, share of all heat", "largest energy drift", "guards"]
    paper = ["about 750 ns", "1.0 / 1.0", "1.0 / 1.0", "0.82", "0.31", "0.07"] + [""] * 7
    columns = [column(folder) for folder in folders]
    print("| | paper | " + " | ".join(folder.name for folder in folders) + " |")
    print("|---|---|" + "---|" * len(folders))
    for k, label in enumerate(labels):
        print(f"| {label} | {paper[k]} | " + " | ".join(c[k] for c in columns) + " |")
    return 0


if __name__ == "__main__":
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # a reader that stops early, as head does, is no fault
    sys.exit(main())
