"""Snapshots one at a time, with a slider for the time. Without a script all are on the page one below the other."""
import base64
import html
import io

import numpy

from . import figures
from . import folder as reader

MOST = 14  # frames, each some ten kilobytes

SCRIPT = """
<script>
(function () {
  var box = document.getElementById("frames"), all = box.querySelectorAll("figure");
  var slider = document.createElement("input"), label = document.createElement("output");
  slider.type = "range"; slider.min = 0; slider.max = all.length - 1; slider.value = all.length - 1;
  slider.setAttribute("aria-label", "time");
  function show() {
    all.forEach(function (frame, i) { frame.classList.toggle("hidden", i != slider.value); });
    label.textContent = all[slider.value].dataset.time;
  }
  slider.addEventListener("input", show);
  var row = document.createElement("div"); row.className = "slider";
  row.append(slider, label); box.prepend(row); show();
})();
</script>
"""


def choose(times):
    """Indices of the snapshots that become frames, evenly spread, the first and the last among them."""
    return sorted({int(round(i)) for i in numpy.linspace(0, len(times) - 1, min(MOST, len(times)))})


def draw(piece, extent, pixel, scale):
    """One frame as the bytes of a PNG."""
    wide, high, to_scale = figures.panel_size(*(end[1] - end[0] for end in extent))
    figure, axis = figures.plt.subplots(figsize=(wide + 1.9, high + 0.7), layout="constrained")
    mean, spans = figures.pixel_mean(*piece[:3], extent, pixel)
    image = axis.imshow(mean, origin="lower", extent=[1e3 * end for span in spans for end in span], cmap="turbo",
                        vmin=scale[0], vmax=scale[1], interpolation="nearest", aspect="equal" if to_scale else "auto")
    axis.set(xlim=[1e3 * end for end in extent[0]], ylim=[1e3 * end for end in extent[1]],
             ylabel="along the shock axis [mm]", xlabel="across [mm]" + ("" if to_scale else ", stretched"))
    axis.locator_params(axis="x", nbins=3 if wide > 0.8 else 1)
    axis.grid(False)
    figure.colorbar(image, ax=axis, label="temperature [K]", extend="max")
    data = io.BytesIO()
    figure.savefig(data, format="png", dpi=90)
    figures.plt.close(figure)
    return data.getvalue()


def section(folder):
    """The frames of a run as a section of the page; Missing without snapshots."""
    times = reader.snapshot_times(folder)
    chosen = [(times[i][0], figures.read_slice(times[i][1])) for i in choose(times)]
    pieces = [piece for _, piece in chosen]
    extent = figures.common_extent(pieces)
    pixel = max(max(piece[3] for piece in pieces), max(high - low for low, high in extent) / 700.0)
    everything = numpy.concatenate([piece[2] for piece in pieces])
    low = float(everything.min())
    scale = low, max(float(numpy.percentile(everything, 99.5)), low + 1.0)
    parts = []
    for time, piece in chosen:
        text = f"{1e9 * time:.4g} ns"
        code = base64.b64encode(draw(piece, extent, pixel, scale)).decode()
        parts.append(f'<figure data-time="{text}"><img src="data:image/png;base64,{code}" alt="temperature at {text}">'
                     f"<figcaption>{html.escape(text)}</figcaption></figure>")
    return f'<div id="frames">{"".join(parts)}</div>{SCRIPT}'
