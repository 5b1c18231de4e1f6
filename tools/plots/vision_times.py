"""Bars of `heel bench vision --json`: search and tracking by stage, with OpenCV's features beneath."""

import os

import numpy as np

import style
from tables import BadInput

YARDSTICK = "orb_1000"
ROWS = (
    ("figures", "search", "searching everywhere"),
    ("figures", "tracking", "tracking"),
    ("figures", "features", "features alone, 1000"),
    ("yardsticks", YARDSTICK, "cv::ORB, 1000"),
    ("yardsticks", "akaze", "cv::AKAZE"),
    ("yardsticks", "sift", "cv::SIFT"),
)
# Features in blues, what is matched in oranges, geometry in greens.
STAGES = {
    "integral": ("integral image", "#08306B"),
    "hessian": ("fast-Hessian", "#2171B5"),
    "selection": ("selection", "#6BAED6"),
    "description": ("description", "#BDD7E7"),
    "matching": ("matching", "#D55E00"),
    "undistortion": ("undistortion", "#8C2D04"),
    "homography": ("homography", "#00441B"),
    "guided_matching": ("guided matching", "#FDBE85"),
    "motion": ("motion", "#66C2A4"),
}
AXIS_SPARE = 1.12  # beyond the longest bar that is to be seen whole
BAR = 0.6


def stage_of(key):
    return STAGES.get(key, (key.replace("_", " "), style.GREY))


def draw_bar(axes, y, times, axis_ms):
    """The stages' shares of the median; a bar longer than the axis is broken off."""
    whole_ms = times["median_ms"]
    stages = times.get("stages", {})
    if not stages:
        axes.barh(y, min(whole_ms, axis_ms), BAR, color="#A6A6A6")
    from_ms, sum_ms = 0.0, sum(stage["median_ms"] for stage in stages.values())
    for key, stage in stages.items():
        part_ms = whole_ms * stage["median_ms"] / sum_ms
        axes.barh(y, part_ms, BAR, left=from_ms, color=stage_of(key)[1])
        from_ms += part_ms
    if whole_ms > axis_ms:
        x = axis_ms * np.array((0.955, 0.967))
        axes.plot(x, (y + 0.62 * BAR, y - 0.62 * BAR), color="white", linewidth=5, solid_capstyle="butt")


def result_text(key, times, orb_ms):
    text = f"{times['median_ms']:.1f} ms"
    if key == YARDSTICK:
        return text
    text += f" = {times['median_ms'] / orb_ms:.3g} × ORB"
    return text + (f", goal {times['goal']:g}" if times.get("goal") is not None else "")


def draw_bars(axes, report):
    orb_ms = report["yardsticks"][YARDSTICK]["median_ms"]
    axis_ms = orb_ms
    for group, key, _ in ROWS[:3]:
        times = report[group][key]
        axis_ms = max(axis_ms, times["median_ms"] or 0.0, (times["goal"] or 0.0) * orb_ms)
    axis_ms *= AXIS_SPARE
    for y, (group, key, _) in enumerate(ROWS):
        times = report[group][key]
        if times["median_ms"] is None:
            axes.text(0.01 * axis_ms, y, "in no frame", va="center")
            continue
        draw_bar(axes, y, times, axis_ms)
        if times.get("goal") is not None:
            x = times["goal"] * orb_ms
            axes.plot((x, x), (y - 0.42, y + 0.42), color=style.INK, linewidth=2.2)
            axes.text(x + 0.008 * axis_ms, y, "goal", va="center", fontsize=8.5)
        axes.text(1.015 * axis_ms, y, result_text(key, times, orb_ms), va="center")
    axes.set(xlim=(0.0, axis_ms), ylim=(len(ROWS) - 0.5, -0.5))
    axes.set_yticks(range(len(ROWS)), [name for _, _, name in ROWS])
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="y", visible=False)
    axes.set_xlabel("thread CPU time in ms, median of the frames")


def draw_stage_table(axes, report):
    """What each stage takes, which is the bars' legend too."""
    axes.set_axis_off()
    shown = [report[group][key].get("stages", {}) for group, key, _ in ROWS[:2]]
    keys = list(dict.fromkeys(key for stages in shown for key in stages))
    axes.set(xlim=(0.0, 1.0), ylim=(len(keys) + 0.5, -0.5))
    left, right = 0.06, (0.68, 0.98)
    axes.text(left, 0.0, "stage", va="center", weight="bold")
    for x, (_, _, name) in zip(right, ROWS):
        axes.text(x, 0.0, name, ha="right", va="center", weight="bold")
    for y, key in enumerate(keys, start=1):
        label, colour = stage_of(key)
        axes.barh(y, 0.036, 0.66, color=colour)
        axes.text(left, y, label, va="center")
        for x, stages in zip(right, shown):
            times = stages.get(key)
            text = "–" if times is None or times["median_ms"] is None else f"{times['median_ms']:.3f} ms"
            axes.text(x, y, text, ha="right", va="center")


def subtitle_of(report):
    settings, machine = report["settings"], report["machine"]
    source = os.path.basename(settings["source"].rstrip("/"))
    return (
        f"{settings['frames']} frames of {settings['width_px']} × {settings['height_px']}, {source}; "
        f"one core, {machine['cpu']}; all in turns on every frame"
    )


def draw(report, picture):
    """`report` is the JSON object; `picture` names the picture to write, an SVG goes beside it."""
    name, kind = os.path.splitext(picture)
    kind = kind.lstrip(".").lower()
    if kind not in style.SAVE_OPTIONS:
        raise BadInput(f"{picture}: unknown kind of picture (expected a name ending in .png, .jpg or .svg)")
    figure = style.plt.figure(figsize=(8.8, 6.0))
    figure.text(0.5, 0.965, "From frame to pose, beside what OpenCV takes to find features", **style.TITLE)
    figure.text(0.5, 0.93, subtitle_of(report), ha="center", fontsize=9)
    draw_bars(figure.add_axes((0.18, 0.455, 0.56, 0.45)), report)
    draw_stage_table(figure.add_axes((0.21, 0.01, 0.53, 0.345)), report)
    style.save(figure, name, kinds=dict.fromkeys((kind, "svg")))
