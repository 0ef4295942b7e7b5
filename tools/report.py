#!/usr/bin/python3
"""Draws the report of an output folder, DIR/report.html and DIR/pictures/; of two folders one page that compares them,
SECOND/compared_with_FIRST.html.

Usage: tools/report.py DIR | FIRST SECOND
"""
import sys
from pathlib import Path

from poreshock_report import comparison, page


def main(names):
    if len(names) not in (1, 2) or any(name.startswith("-") for name in names):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    for name in names:
        if not Path(name).is_dir():
            print(f"tools/report.py: there is no folder '{name}'", file=sys.stderr)
            return 1
    folders = [Path(name) for name in names]
    written = page.write(*folders) if len(folders) == 1 else comparison.write(*folders)
    print(f"report: {written}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
