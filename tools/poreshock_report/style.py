"""Colours and lines of all pictures: told apart by colour-blind readers, and in print without colour."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend has to be chosen first)
import numpy  # noqa: E402
from matplotlib.colors import ListedColormap  # noqa: E402

# Okabe & Ito (2008) without yellow, which is too light for a line on white.
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#000000", "#56b4e9", "#e69f00", "#7f7f7f")
DASHES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (8, 2)), (0, (3, 1)), (0, (1, 1)))
# Lightness rises with temperature; the lightest sixteenth is left out, so that white stays for voids.
HEAT = ListedColormap(matplotlib.colormaps["inferno"](numpy.linspace(0.0, 15.0 / 16.0, 256)), "heat")

plt.rcParams.update({"font.size": 10, "axes.grid": True, "grid.color": "#d9d9d9", "grid.linewidth": 0.6,
                     "axes.axisbelow": True, "legend.frameon": False, "lines.linewidth": 1.6,
                     "axes.prop_cycle": plt.cycler(color=COLOURS) + plt.cycler(linestyle=DASHES)})


def ordered(count):
    """Line styles of `count` curves that have an order, such as rising times: dark to light, each with its dashes."""
    shades = matplotlib.colormaps["viridis"](numpy.linspace(0.0, 0.85, count))
    return [{"color": shade, "linestyle": DASHES[i % len(DASHES)]} for i, shade in enumerate(shades)]
