#!/usr/bin/python3
"""Draws the report of an output folder, DIR/report.html and DIR/pictures/; of two folders one page that compares them,
SECOND/compared_with_FIRST.html.
"""
import argparse
import sys
from pathlib import Path

from poreshock_report import comparison, page


def options(arguments):
    parser = argparse.ArgumentParser(prog="tools/report.py", description=__doc__, allow_abbrev=False)
    parser.add_argument("folders", metavar="DIR", nargs="+", help="output folder of a run, or two of them")
    parser.add_argument("--heights", metavar="MM", nargs="+", type=float, default=[],
                        help="heights of the slices of a run in 3-D, by default four over what has been heated")
    choice = parser.parse_args(arguments)
    if len(choice.folders) > 2:
        parser.error(f"found {len(choice.folders)} folders; give one for its report, or two to compare them")
    for name in choice.folders:
        if not Path(name).is_dir():
            parser.error(f"there is no folder '{name}'")
    return choice


def main(arguments):
    choice = options(arguments)
    folders = [Path(name) for name in choice.folders]
    written = (page.write(folders[0], [1e-3 * height for height in choice.heights]) if len(folders) == 1
               else comparison.write(*folders))
    print(f"report: {written}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
