#!/usr/bin/python3
"""Prints the state behind the shock of runs as markdown tables, beside the Hugoniots of solid and porous material.

Usage: tools/hugoniot.py FOLDER [FOLDER...]
Reads scene.toml, profiles.h5 and history.csv of each output folder; the wall is at the low side.
"""
import signal
import sys
from pathlib import Path

from poreshock_report import folder as reader
from poreshock_report import profiles


def markdown(rows):
    """Lines of a markdown table."""
    lines = ["| " + " | ".join(row) + " |" for row in (profiles.HEAD, *rows)]
    return [lines[0], "|---" * len(profiles.HEAD) + "|", *lines[1:]]


def main(names):
    if not names or names[0].startswith("-"):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    for name in names:
        try:
            shock = profiles.measure(Path(name))
        except reader.Missing as reason:
            print(f"tools/hugoniot.py: {name}: {reason}", file=sys.stderr)
            return 1
        print("\n".join([f"**{name}**", "", *markdown(profiles.table_rows(shock)), "", *shock.notes, ""]))
    return 0


if __name__ == "__main__":
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # a reader that stops early, as head does, is no fault
    sys.exit(main(sys.argv[1:]))
