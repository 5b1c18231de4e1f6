"""fig2 ... fig6: mean ± deviation over the commanded value beside the truth; beneath, certainty."""

import numpy as np

import style
from tables import Table

# name: title, x label, y label, unit of the columns
FIGURES = {
    "fig2_t_x": ("Figure 2: $t_x$ at sideways offsets, 2 m away", "sideways offset in m", "$t_x$ in m", "m"),
    "fig3_t_z": ("Figure 3: $t_z$ over the distance", "distance in m", "$t_z$ in m", "m"),
    "fig4_yaw": (
        "Figure 4: yaw of the back, 2 m away",
        "true yaw in degrees",
        "estimated yaw in degrees",
        "deg",
    ),
    "fig5_yaw_over_x": (
        "Figure 5: yaw of a person who only moves sideways",
        "sideways offset in m",
        "estimated yaw in degrees",
        "deg",
    ),
    "fig6_yaw_over_z": (
        "Figure 6: yaw of a person who only moves away",
        "distance in m",
        "estimated yaw in degrees",
        "deg",
    ),
}


def draw_values(axes, steps, unit):
    at, seen = steps["commanded"], steps["found"] > 0
    hidden = np.where(seen, 0.0, np.nan)  # nothing was found there: the line breaks
    axes.plot(at, steps[f"true_{unit}"], color=style.TRUTH, linewidth=3.0, label="true")
    axes.errorbar(
        at,
        steps[f"mean_{unit}"] + hidden,
        yerr=steps[f"deviation_{unit}"],
        color=style.BLUE,
        marker="o",
        markersize=4.5,
        linewidth=1.4,
        elinewidth=1.1,
        capsize=3,
        label="mean ± one deviation",
        clip_on=False,
    )


def draw_certainty(axes, steps):
    at, mean = steps["commanded"], steps["certainty_mean"]
    below, above = mean - steps["certainty_p05"], steps["certainty_p95"] - mean
    style.add_reliable_line(axes)
    axes.plot(
        at,
        steps["found"] / steps["pictures"],
        "s-",
        color=style.GREEN,
        markersize=4,
        label="share found",
        clip_on=False,
    )
    axes.errorbar(
        at,
        mean,
        # The mean of a skewed few may lie outside the middle 90 %.
        yerr=np.maximum((below, above), 0.0),
        color=style.VERMILION,
        marker="o",
        markersize=4,
        linewidth=1.4,
        elinewidth=1.1,
        capsize=3,
        label="mean certainty, and 90 % of the pictures",
        clip_on=False,
    )
    axes.set(ylim=(0.0, 1.05), ylabel="0 … 1")


def draw(folder, name):
    title, x_label, y_label, unit = FIGURES[name]
    steps = Table(folder / f"{name}.csv")
    figure, (values, certainty) = style.new_figure(
        5.8, rows=2, sharex=True, gridspec_kw={"height_ratios": (1.75, 1.0)}
    )
    draw_values(values, steps, unit)
    values.set_ylabel(y_label)
    style.caption(values, title)
    draw_certainty(certainty, steps)
    style.caption(certainty, "Certainty: inliers / template features")
    certainty.set_xlabel(x_label)
    values.tick_params(labelbottom=True)
    values.margins(x=0.02)
    figure.align_ylabels()
    style.save(figure, folder / name)
