"""Pieces of HTML: tables, pictures, and what stands where something is missing."""
import base64
import html
import io
import re

import numpy

from . import folder as reader
from .style import plt

STYLE = """
:root { color-scheme: light; }
body { font: 16px/1.5 system-ui, sans-serif; color: #1c1c1c; background: #fff; margin: 0 auto;
       max-width: 62rem; padding: 1rem; }
h1 { font-size: 1.5rem; line-height: 1.25; margin: .2rem 0; }
h2 { font-size: 1.15rem; margin: 2rem 0 .4rem; border-bottom: 1px solid #ccc; }
h3 { font-size: 1rem; margin: 1rem 0 .2rem; }
figure { margin: 0; } img { display: block; max-width: 100%; height: auto; margin: 0 auto; }
figcaption, .note { color: #444; font-size: .92rem; }
.missing, .warning { background: #fff4e0; border-left: 4px solid #d08700; padding: .4rem .8rem; margin: .4rem 0; }
.fine { border-left: 4px solid #0072b2; background: #eef5fb; padding: .4rem .8rem; margin: .4rem 0; }
.scroll { overflow-x: auto; } table { border-collapse: collapse; font-size: .92rem; }
th, td { text-align: left; padding: .25rem .8rem .25rem 0; border-bottom: 1px solid #e2e2e2; }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.top { display: flex; flex-wrap: wrap; gap: 1rem 2rem; align-items: flex-start; }
.top > div { flex: 1 1 24rem; min-width: 0; } .top > figure { flex: 0 1 auto; max-width: 26rem; }
#movie { max-height: 36rem; width: auto; }
.bar { display: inline-block; height: .8rem; background: #0072b2; vertical-align: middle; }
.numerical .bar { background: repeating-linear-gradient(45deg, #d55e00 0 4px, #fff 4px 6px); }
.picture img { width: calc(var(--inches) * 96px); }
.hidden { display: none; } .slider { display: flex; gap: .8rem; align-items: center; margin: .4rem 0; }
.slider input { flex: 1; } .slider output { min-width: 5.5rem; font-variant-numeric: tabular-nums; }
#frames img { max-height: 85vh; width: auto; }
/* On a phone letters of a picture stay as large as 9 px; what is then wider than the screen is moved sideways. */
@media (max-width: 40rem) { .picture img { max-width: none; width: calc(var(--inches) * 64px); }
                            th, td { padding-right: .5rem; } table { font-size: .88rem; } }
@media print { .slider, #frames figure:not(:last-of-type) { display: none; } body { max-width: none; font-size: 11pt; padding: 0; }
               section { break-inside: avoid; } img { max-height: 22cm; } }
"""
NUMBER = re.compile(r"-|[-+]?\d[\d. ]*(e[-+]?\d+)?( %|\+- [\d.]+)?")


def number(value):
    """A number as text: whole numbers with spaces, others with five digits."""
    if isinstance(value, (int, numpy.integer)) or float(value).is_integer() and abs(value) < 1e15:
        return f"{int(value):,}".replace(",", " ")
    return f"{value:.5g}"


MISSING = '<p class="missing">'


def missing(what, reason):
    return f'{MISSING}Missing: {html.escape(what)}: {html.escape(str(reason))}.</p>'


def section(title, body):
    """A section whose body a function makes, or just the reason why it cannot."""
    try:
        return f"<section><h2>{html.escape(title)}</h2>{body()}</section>"
    except reader.Missing as reason:
        return missing(title, reason)


def inline(data, kind="png"):
    """Address that holds a picture itself."""
    return f"data:image/{kind};base64,{base64.b64encode(data).decode()}"


def picture(folder, name, title, caption, draw):
    """Section with one picture, which is also saved as pictures/<name>.png."""
    def body():
        figure = draw()
        data = io.BytesIO()
        figure.savefig(data, format="png", dpi=150, bbox_inches="tight", pad_inches=0.08)
        plt.close(figure)
        save(folder, f"{name}.png", data.getvalue())
        return (f'<figure><div class="scroll picture"><img style="--inches:{figure.get_figwidth():.3g}" '
                f'src="{inline(data.getvalue())}" alt="{html.escape(title)}"></div>'
                f"<figcaption>{html.escape(caption)}</figcaption></figure>")

    return section(title, body)


def save(folder, name, data):
    """Writes a file into pictures/ of a folder."""
    (folder / "pictures").mkdir(exist_ok=True)
    (folder / "pictures" / name).write_bytes(data)


def table(head, rows):
    """HTML table; entries that are numbers, or text of one, are aligned to the right."""
    def cell(tag, entry):
        text = entry if isinstance(entry, str) else number(entry)
        right = text is not entry or NUMBER.fullmatch(text)
        return f'<{tag}{" class=number" if right else ""}>{html.escape(text)}</{tag}>'

    body = ["<tr>" + "".join(cell("td", entry) for entry in row) + "</tr>" for row in rows]
    top = "<tr>" + "".join(f'<th{" class=number" if i else ""}>{html.escape(entry)}</th>'
                           for i, entry in enumerate(head)) + "</tr>" if head else ""
    return f'<div class="scroll"><table>{top}{"".join(body)}</table></div>'


def document(title, parts):
    """The whole page; what is missing stands together at its end."""
    absent = [part for part in parts if part.startswith(MISSING)]
    parts = [part for part in parts if not part.startswith(MISSING)]
    if absent:
        parts.append(f'<section><h2>Not in this report</h2>{"".join(absent)}</section>')
    return (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
            f'<meta name="viewport" content="width=device-width, initial-scale=1">'
            f"<title>{html.escape(title)}</title><style>{STYLE}</style></head><body>"
            f'<h1>{html.escape(title)}</h1>{"".join(parts)}</body></html>\n')
