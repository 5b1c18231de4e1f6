"""errors_over_conditions: for each condition yaw error, shares found and wrong, stated deviation."""

import numpy as np

import style
from tables import Table

NEEDS = ("errors_over_conditions.csv",)
LEAST_RATIO = 1e-3


def draw_yaw(axes, bins, seen):
    at = bins["middle"][seen]
    for column, label, colour in (
        ("yaw_p95_deg", "95 %", style.GREY),
        ("yaw_mean_abs_deg", "mean absolute", style.VERMILION),
        ("yaw_outward_mean_deg", "outwards", style.BLUE),
    ):
        axes.plot(at, bins[column][seen], "o-", color=colour, markersize=3.2, label=label)
    axes.set_ylabel("degrees")


def draw_shares(axes, bins, seen):
    at = bins["middle"]
    axes.plot(at, bins["found"] / bins["pictures"], "o-", color=style.GREEN, markersize=3.2, label="found")
    axes.plot(
        at[seen], bins["certainty"][seen], "o-", color=style.VERMILION, markersize=3.2, label="certainty"
    )
    axes.plot(
        at[seen],
        bins["wrong"][seen] / bins["found"][seen],
        "s--",
        color=style.INK,
        markersize=3.2,
        label="wrong of these",
    )
    axes.set(ylabel="share", ylim=(-0.04, 1.05))


def draw_consistency(axes, bins, seen):
    at = bins["middle"][seen]
    axes.axhline(1.0, color=style.GREY, linewidth=1.2, label="consistent")
    for column, label, colour in (
        ("yaw_nees", "yaw", style.BLUE),
        ("t_x_nees", "$t_x$", style.GREEN),
        ("t_z_nees", "$t_z$", style.VERMILION),
    ):
        axes.plot(
            at, np.maximum(bins[column][seen], LEAST_RATIO), "o-", color=colour, markersize=3.2, label=label
        )
    axes.set_yscale("log", base=10)
    low, high = axes.get_ylim()
    axes.set_ylim(min(low, 0.4), max(high, 2.5))
    axes.yaxis.set_major_locator(style.ticker.LogLocator(10, subs=(1.0, 2.0, 5.0)))
    axes.yaxis.set_major_formatter(style.ticker.FormatStrFormatter("%g"))
    axes.yaxis.set_minor_locator(style.ticker.NullLocator())
    axes.set_ylabel("mean of (error / $\\sigma$)²")


COLUMNS = (
    ("Yaw error", draw_yaw),
    ("Found, wrong, certainty", draw_shares),
    ("Stated $\\sigma$: 1 is consistent", draw_consistency),
)


class Bins:
    """The rows of one condition."""

    def __init__(self, table, rows):
        self.table, self.rows = table, rows

    def __getitem__(self, column):
        return self.table[column][self.rows]


def draw(folder):
    table = Table(folder / "errors_over_conditions.csv")
    names, units = np.array(table.text("condition")), np.array(table.text("unit"))
    rows = {name: np.flatnonzero(names == name) for name in dict.fromkeys(names)}
    # The shirt is no axis; it stands in the table.
    rows = {name: at for name, at in rows.items() if len(at) > 1 and name != "shirt"}
    if not rows:
        return
    figure, panels = style.new_figure(0.4 + 1.9 * len(rows), len(rows), len(COLUMNS), squeeze=False)
    figure.set_figwidth(9.8)
    for row, (name, at) in enumerate(rows.items()):
        bins = Bins(table, at)
        seen = bins["found"] > 0
        unit = units[at[0]]
        for axes, (title, draw_panel) in zip(panels[row], COLUMNS):
            draw_panel(axes, bins, seen)
            axes.set_xlim(*(bins["middle"][[0, -1]] + np.array((-0.03, 0.03)) * np.ptp(bins["middle"])))
            axes.set_xlabel(f"{name} in {unit}" if unit else name)
            if row == 0:
                style.caption(
                    axes, title, font_size=8, handlelength=1.2, columnspacing=0.9, handletextpad=0.5
                )
    style.save(figure, folder / "errors_over_conditions")
