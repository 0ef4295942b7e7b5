"""Picture of the energy ledger."""
import numpy

from . import folder as reader
from .style import COLOURS, plt

LEDGER = ("total", "kinetic", "internal", "escaped", "handed_over", "taken_in", "wall_work", "body_work")
SPLITS = ("elastic", "compression_work", *reader.HEATS, "conduction")


def energy(folder):
    """The energy ledger: sums, splits and the drift of the total."""
    columns, units = reader.read_history(folder)
    missing = [name for name in ("time", "total", "kinetic", "internal") if name not in columns]
    if missing:
        raise reader.Missing(f"history.csv has no column {', '.join(missing)}")
    time, unit = 1e9 * columns["time"], units["total"]
    figure, axes = plt.subplots(3, 1, sharex=True, figsize=(7.0, 9.2), layout="constrained")
    for axis, names in zip(axes, (LEDGER, SPLITS)):
        # A column of zeros (no contact, nothing escaped) only crowds the legend.
        for name in names:
            if name in columns and (numpy.any(columns[name]) or name in LEDGER[:3]):
                axis.plot(time, columns[name], label=name.replace("_", " "))
        axis.set_ylabel(f"energy [{unit}]")
        if axis.lines:
            axis.legend(ncols=2, fontsize=9)
    off = reader.drift(columns)
    axes[2].semilogy(time, numpy.where(off > 0.0, off, numpy.nan), color=COLOURS[0])
    axes[2].set(xlabel="time [ns]", ylabel="|total / first total - 1|")
    if not numpy.any(off > 0.0):
        axes[2].set(yscale="linear", ylim=(0.0, 1.0))
        axes[2].text(0.5, 0.5, "no drift: every total has the bits of the first",
                     ha="center", transform=axes[2].transAxes)
    return figure
