#!/usr/bin/python3
"""Draws the report of an output folder: DIR/report.html and DIR/pictures/.

Usage: tools/report.py DIR [DIR...]
"""
import sys
from pathlib import Path

from poreshock_report import page


def main(names):
    if not names or names[0].startswith("-"):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    for name in names:
        if not Path(name).is_dir():
            print(f"tools/report.py: there is no folder '{name}'", file=sys.stderr)
            return 1
        print(f"report: {page.write(Path(name))}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
