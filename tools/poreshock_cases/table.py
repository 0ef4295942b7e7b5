"""Rows of figures with the bar each has to meet, and their markdown tables."""
import re
from dataclasses import dataclass
from itertools import groupby

# A case with several points: "plate, paper, 300 / 500 m/s", whose value lists one number for each: "+0.1 / -0.2 %".
POINTS = re.compile(r"(.*), (\S+(?: / \S+)+) (\S+)")
VALUES = re.compile(r"(\S+(?: / \S+)+)(?: ([^;]+))?(?:; (.*))?")


@dataclass(frozen=True)
class Row:
    """One figure of a case; `ok` is None where it is shown only."""
    case: str
    figure: str
    value: str
    bar: str
    ok: bool | None


def limit(case, figure, value, bar, form=".2g"):
    """A figure whose size must stay below `bar`."""
    return Row(case, figure, f"{value:{form}}", f"< {bar:g}", bool(abs(value) < bar))


def near(case, figure, value, exact, share, form=".5g", unit="", scale=1.0):
    """A figure that may differ from the exact one by `share` of it."""
    error = value / exact - 1.0
    return Row(case, figure, f"{value / scale:{form}}{unit} ({100.0 * error:+.2f} %)",
               f"{exact / scale:{form}}{unit} +- {100.0 * share:g} %", bool(abs(error) <= share))


def same(case, figure, values):
    """A figure that must be the same, to the bit, in all runs."""
    different = len(set(values))
    return Row(case, figure, "identical" if different == 1 else f"{different} different", "identical",
               different == 1)


def check(case, figure, value, bar, ok):
    """A figure judged by the caller."""
    return Row(case, figure, str(value), bar, bool(ok))


def shown(case, figure, value):
    """A figure without a bar."""
    return Row(case, figure, str(value), "", None)


def verdict(row, known):
    """Text of the last column."""
    if row.ok is None:
        return ""
    return "yes" if row.ok else "known miss" if (row.case, row.figure) in known else "**no**"


def line(words):
    return f"| {' | '.join(words)} |"


def points_table(case, rows, known):
    """The table of a case with several points: a row per figure, a column per point."""
    name, points, unit = POINTS.fullmatch(case).groups()
    points = points.split(" / ")
    lines = [f"{name}, at {unit}:", "", line(["figure", *points, "bar", "pass"]), "|---" * (len(points) + 3) + "|"]
    for row in rows:
        values, of, missed = VALUES.fullmatch(row.value).groups()
        lines.append(line([row.figure + (f", {of}" if of else ""), *values.split(" / "), row.bar,
                           verdict(row, known) + (f"; {missed}" if missed else "")]))
    return lines


def markdown(rows, known):
    """The tables, and under them the known misses in them, grouped by their reason."""
    lines = []
    for several, part in groupby(rows, lambda row: POINTS.fullmatch(row.case) is not None):
        for case, figures in groupby(part, lambda row: row.case if several else ""):
            lines += [""] if lines else []
            if several:
                lines += points_table(case, figures, known)
            else:
                lines += [line(["case", "figure", "value", "bar", "pass"]), "|---|---|---|---|---|"]
                lines += [line([row.case, row.figure, row.value, row.bar, verdict(row, known)]) for row in figures]
    missed = {}
    for row in rows:
        if row.ok is False and (row.case, row.figure) in known:
            missed.setdefault(known[row.case, row.figure], []).append(f"{row.case}, {row.figure}")
    if missed:
        lines += ["", "Known misses:", ""]
        lines += [f"- {'; '.join(figures)}. {reason}" for reason, figures in missed.items()]
    return "\n".join(lines) + "\n"


def failures(rows, known):
    """What makes a table fail: a bar missed without a known reason, or a reason that no longer holds."""
    wrong = []
    for row in rows:
        listed = (row.case, row.figure) in known
        if row.ok is False and not listed:
            wrong.append(f"{row.case}: {row.figure}: {row.value}, wanted {row.bar}")
        if row.ok and listed:
            wrong.append(f"{row.case}: {row.figure} is listed as a known miss but passes")
    return wrong
