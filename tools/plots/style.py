"""What all figures share: colours, sizes, and how a figure is saved."""

import os

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot as plt, ticker  # noqa: E402 (the backend is chosen first)

# Okabe and Ito's colours, which people with any kind of colour blindness can tell apart.
BLUE, GREEN, VERMILION, AMBER = "#0072B2", "#009E73", "#D55E00", "#E69F00"
INK, GREY, PALE = "#262626", "#8C8C8C", "#E4E4E4"

PERSON, ROBOT, TRUTH = VERMILION, BLUE, "#B0B0B0"
RELIABLE = 0.1  # certainty, by the paper

WIDTH_IN = 8.0  # 1200 pixels
DPI = 150

# Dates and versions stay out, so that only other numbers make another file.
SAVE_OPTIONS = {
    "png": {"metadata": {"Software": None}},
    "svg": {"metadata": {"Date": None}},
    "jpeg": {"pil_kwargs": {"quality": 80}},
    "jpg": {"pil_kwargs": {"quality": 80}},
}

plt.rcdefaults()  # whatever the user has set
plt.rcParams.update(
    {
        "figure.dpi": DPI,
        "font.size": 9.5,
        "text.color": INK,
        "axes.edgecolor": INK,
        "axes.labelcolor": INK,
        "axes.linewidth": 0.8,
        "axes.titlesize": 10.5,
        "axes.titleweight": "bold",
        "axes.titlelocation": "left",
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.grid": True,
        "axes.axisbelow": True,
        "axes.xmargin": 0.0,
        "axes.formatter.useoffset": False,
        "grid.color": PALE,
        "grid.linewidth": 0.7,
        "xtick.color": INK,
        "ytick.color": INK,
        "legend.frameon": False,
        "legend.fontsize": 9,
        "lines.solid_capstyle": "round",
        "svg.hashsalt": "heel",  # the same numbers make the same file
    }
)

TITLE = {"ha": "center", "fontsize": 11.5, "weight": "bold"}  # of a whole figure


def new_figure(height_in, rows=1, columns=1, **options):
    """A figure of the usual width, and its axes."""
    return plt.subplots(rows, columns, figsize=(WIDTH_IN, height_in), layout="constrained", **options)


def signed(value, places=0):
    """With + or a true minus sign; zero without a sign."""
    text = f"{round(value, places) + 0.0:+.{places}f}".replace("-", "\N{MINUS SIGN}")
    return text if text.strip("+0.") else text[1:]


def caption(axes, title, font_size=9, **options):
    """The title above the axes at the left, and the legend in the row beneath it: it covers no curve."""
    handles, labels = axes.get_legend_handles_labels()
    axes.set_title(title, pad=24 if handles else 8)
    if handles:
        axes.legend(
            handles,
            labels,
            loc="lower left",
            bbox_to_anchor=(-0.01, 1.0),
            ncol=len(handles),
            borderaxespad=0.2,
            fontsize=font_size,
            **{"handlelength": 1.7, "columnspacing": 1.6, **options},
        )


def add_reliable_line(axes):
    axes.axhline(RELIABLE, color=INK, linewidth=1.0, linestyle="--", label=f"reliable above {RELIABLE}")


class SameStep(ticker.MaxNLocator):
    """The ticks of the other axis's distance, for axes to scale."""

    def __init__(self, axes):
        super().__init__(nbins=10, steps=(1, 2, 5, 10))
        self.axes_to_scale = axes

    def tick_values(self, low, high):
        x_ticks = super().tick_values(*self.axes_to_scale.get_xlim())
        step = x_ticks[1] - x_ticks[0]
        return step * np.arange(np.floor(low / step), np.ceil(high / step) + 1)


def to_scale(axes):
    """One metre is as long in both directions."""
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.06)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(SameStep(axes))


def save(figure, path, kinds=("png", "svg")):
    """Writes path.png and path.svg; a reader never sees half a picture."""
    for kind in kinds:
        unfinished = f"{path}.part"
        figure.savefig(unfinished, format=kind, dpi=DPI, **SAVE_OPTIONS.get(kind, {}))
        os.replace(unfinished, f"{path}.{kind}")
    plt.close(figure)
