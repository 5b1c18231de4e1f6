"""foreign_reliability: whether certainty and stated sigma can be relied on, on pictures of others."""

import numpy as np

import style
from matplotlib import ticker
from tables import Table

NEEDS = ("foreign_certainty.csv", "foreign_sigma.csv")
SETS = (
    ("stills", "stills by others", style.BLUE, "o"),
    ("walk", "a walk by others", style.VERMILION, "s"),
    ("own world", "our simulated world", style.GREY, "^"),
)


def rows_of(table, name):
    return np.array([cell == name for cell in table.text("set")], dtype=bool)


def draw_certainty(axes, table):
    for name, label, color, marker in SETS:
        rows = rows_of(table, name)
        if not rows.any():
            continue
        share = 100.0 * table["right"][rows] / table["found"][rows]
        axes.plot(table["mean"][rows], share, color=color, marker=marker, label=label)
        for x, y, count in zip(table["mean"][rows], share, table["found"][rows]):
            if name != "own world":  # its counts are in the thousands, and not the point
                axes.annotate(
                    f"{count:.0f}",
                    (x, y),
                    textcoords="offset points",
                    xytext=(0, -14 if name == "stills" else 8),
                    ha="center",
                    color=color,
                    fontsize=8,
                )
    axes.axvline(style.RELIABLE, color=style.INK, linewidth=1.0, linestyle="--")
    lowest = 100.0 * (table["right"] / table["found"]).min() if len(table) else 100.0
    axes.set(xlabel="certainty", ylabel="right poses, %", ylim=(min(75.0, lowest - 10.0), 104.0))
    axes.margins(x=0.06)


def draw_sigma(axes, table):
    for name, label, color, marker in SETS:
        rows = rows_of(table, name)
        if rows.any():
            axes.plot(
                table["sigma_deg"][rows], table["error_deg"][rows], color=color, marker=marker, label=label
            )
    limits = np.array([0.5, 40.0])
    if len(table):
        both = np.concatenate([table["sigma_deg"], table["error_deg"]])
        limits = np.array([0.8 * both.min(), 1.25 * both.max()])
    axes.plot(limits, limits, color=style.INK, linewidth=1.0, linestyle="--", label="as stated")
    axes.set(xscale="log", yscale="log", xlim=limits, ylim=limits)
    axes.set(xlabel="stated sigma of yaw, degrees", ylabel="RMS error of yaw, degrees")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(ticker.LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(ticker.FormatStrFormatter("%g"))
        axis.set_minor_formatter(ticker.NullFormatter())


def draw(folder):
    figure, (left, right) = style.new_figure(3.8, columns=2)
    draw_certainty(left, Table(folder / "foreign_certainty.csv"))
    draw_sigma(right, Table(folder / "foreign_sigma.csv"))
    style.caption(left, "Right poses over the certainty", font_size=7.5)
    style.caption(right, "Errors over the stated sigma", font_size=7.5)
    style.save(figure, folder / "foreign_reliability")
