"""Snapshots one at a time: a small movie, and a slider for the time. Without a script all are one below the other."""
import html
import io

import numpy
from PIL import Image

from . import figures, markup
from . import folder as reader
from .style import HEAT, plt

MOST = 24  # frames, each some tens of kilobytes
MILLISECONDS = 250  # of a frame of the movie; the last one stays eight times as long

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


def draw(time, piece, extent, pixel, scale):
    """One frame as the bytes of a WebP, a tenth of a PNG."""
    wide, high, to_scale = figures.panel_size(*(end[1] - end[0] for end in extent))
    figure, axis = plt.subplots(figsize=(wide + 1.9, high + 0.9), layout="constrained")
    mean, spans = figures.pixel_mean(*piece[:3], extent, pixel)
    image = axis.imshow(mean, origin="lower", extent=[1e3 * end for span in spans for end in span], cmap=HEAT,
                        vmin=scale[0], vmax=scale[1], interpolation="nearest", aspect="equal" if to_scale else "auto")
    axis.set(xlim=[1e3 * end for end in extent[0]], ylim=[1e3 * end for end in extent[1]], title=time,
             ylabel="along the shock axis [mm]", xlabel="across [mm]" + ("" if to_scale else ", stretched"))
    axis.locator_params(axis="x", nbins=3 if wide > 0.8 else 1)
    axis.grid(False)
    figure.colorbar(image, ax=axis, label="temperature [K]", extend="max")
    data = io.BytesIO()
    figure.savefig(data, format="webp", dpi=90, pil_kwargs={"quality": 85})
    plt.close(figure)
    return data.getvalue()


def draw_all(folder):
    """[(time as text, picture)] of the snapshots on one scale of temperature; Missing without snapshots."""
    times = reader.snapshot_times(folder)
    chosen = [(f"{1e9 * times[i][0]:.4g} ns", figures.read_slice(times[i][1])) for i in choose(times)]
    pieces = [piece for _, piece in chosen]
    extent = figures.common_extent(pieces, figures.sizes_of(folder)[0])
    pixel = max(max(piece[3] for piece in pieces), max(high - low for low, high in extent) / 700.0)
    scale = figures.common_scale(pieces)
    return [(time, draw(time, piece, extent, pixel, scale)) for time, piece in chosen]


def movie(folder, drawn):
    """The frames as an animated WebP, saved as pictures/temperature.webp; readers who want no motion see the last frame."""
    images = [Image.open(io.BytesIO(data)).convert("RGB") for _, data in drawn]
    data = io.BytesIO()
    images[0].save(data, format="WEBP", save_all=True, append_images=images[1:], quality=60, method=4, loop=0,
                   duration=[MILLISECONDS] * (len(images) - 1) + [8 * MILLISECONDS])
    markup.save(folder, "temperature.webp", data.getvalue())
    return (f'<figure><picture><source media="(prefers-reduced-motion: reduce)" srcset="{markup.inline(drawn[-1][1], "webp")}">'
            f'<img id="movie" src="{markup.inline(data.getvalue(), "webp")}" alt="temperature from {drawn[0][0]} to '
            f'{drawn[-1][0]}"></picture></figure>')


def section(drawn):
    """HTML of the frames with their slider."""
    parts = [f'<figure data-time="{time}"><img src="{markup.inline(data, "webp")}" alt="temperature at {time}">'
             f"<figcaption>{html.escape(time)}</figcaption></figure>" for time, data in drawn]
    return f'<div id="frames">{"".join(parts)}</div>{SCRIPT}'
