"""What `heel tune` has found: the cost of each step, and every figure before and after, in units of its aim."""

import os

import numpy as np

import style
from tables import BadInput

BAR = 0.36
UNDER_TEXT = {"facecolor": "white", "edgecolor": "none", "pad": 0.3}
NAMES = {
    "path_p95_m": "beside the path",
    "along_p95_m": "along the path",
    "jerk_p99_m_s3": "jerk",
    "straight_yaw_rate_rms_rad_s": "yaw rate, straight",
    "yaw_beyond_share": "yaw beyond 45°",
    "out_of_sight_share": "out of sight",
}


def draw_steps(axes, steps):
    costs = [step["cost"] for step in steps]
    least = [step["least_cost"] for step in steps]
    number = range(1, len(steps) + 1)
    axes.plot(number, costs, ".", color=style.GREY, label="a step")
    axes.step(number, least, where="post", color=style.BLUE, label="least so far")
    axes.set(xlabel="step", ylabel="cost, seeds of the search")
    spread = max(costs[0] - least[-1], 0.05 * least[-1])
    axes.set_ylim(max(0.0, least[-1] - 0.2 * spread), costs[0] + 0.8 * spread)
    style.caption(axes, "The search")


def draw_figures(axes, report):
    aims = report["aims"]
    places = np.arange(len(aims))
    for offset, when, colour in ((-0.5, "before", style.GREY), (0.5, "after", style.BLUE)):
        runs = [scenario[when] for scenario in report["scenarios"]]
        shares = [np.mean([run[aim["name"]] for run in runs]) / aim["aim"] for aim in aims]
        axes.barh(places + offset * BAR, shares, BAR, color=colour, label=when)
        for place, aim, share in zip(places, aims, shares):
            text = f" {share * aim['aim']:.3g} {aim['unit']}".rstrip()
            axes.text(share, place + offset * BAR, text, va="center", fontsize=8, bbox=UNDER_TEXT)
    axes.axvline(1.0, color=style.INK, linewidth=1.0, linestyle="--", label="aim")
    axes.set_yticks(places, [NAMES.get(aim["name"], aim["name"]) for aim in aims])
    axes.margins(x=0.2)
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    cost, failed = (
        "{:.3g} \N{RIGHTWARDS ARROW} {:.3g}".format(*pair)
        for pair in (
            (report["cost_before"], report["cost_after"]),
            [sum(run[when]["failed_runs"] for run in report["scenarios"]) for when in ("before", "after")],
        )
    )
    axes.set_xlabel(f"in units of the aim\ncost {cost}, failed runs {failed}")
    style.caption(axes, "Seeds that were not searched")


def draw(report, picture):
    """`report` is the JSON object; `picture` names the picture to write, an SVG goes beside it."""
    name, kind = os.path.splitext(picture)
    kind = kind.lstrip(".").lower()
    if kind not in style.SAVE_OPTIONS:
        raise BadInput(f"{picture}: unknown kind of picture (expected a name ending in .png, .jpg or .svg)")
    figure, (left, right) = style.new_figure(3.9, 1, 2, width_ratios=(1.0, 1.25))
    draw_steps(left, report["steps"])
    draw_figures(right, report)
    style.save(figure, name, kinds=dict.fromkeys((kind, "svg")))
