"""path: both paths to scale, where they begin and end, and where the target was not found."""

import numpy as np

import style
from tables import Table, read_json

NEEDS = ("path.csv", "pose_errors.csv", "summary.json")
TIE_PERIOD_S = 4.0


def headline(metrics):
    return (
        f"{metrics['person_path_m']:.1f} m walked, {metrics['following_rms_m']:.2f} m RMS apart, "
        f"longest out of view {metrics['out_of_view_longest_s']:.2f} s"
    )


def add_paths(axes, path, scale=1.0):
    """Both paths, with a thin line every few seconds from the robot to the person of the same moment."""
    robot = path["robot_x_m"], path["robot_y_m"]
    person = path["person_x_m"], path["person_y_m"]
    times, walking = path["t_s"], path["walking"] > 0
    label = "at the same moment"
    t_tie_s = times[walking][0] if walking.any() else np.inf
    while t_tie_s <= times[-1]:
        i = np.searchsorted(times, t_tie_s)
        axes.plot(
            (robot[0][i], person[0][i]),
            (robot[1][i], person[1][i]),
            color="#B8B8B8",
            linewidth=0.9 * scale,
            label=label,
        )
        label = None
        t_tie_s += TIE_PERIOD_S
    axes.plot(*person, color=style.PERSON, linewidth=3.2 * scale, label="person")
    axes.plot(*robot, color=style.ROBOT, linewidth=1.7 * scale, label="robot")
    style.to_scale(axes)


def add_ends(axes, path):
    for name, place, marker, face in (("start", 0, "o", "white"), ("end", -1, "s", None)):
        for who, colour in (("person", style.PERSON), ("robot", style.ROBOT)):
            axes.plot(
                path[f"{who}_x_m"][place],
                path[f"{who}_y_m"][place],
                marker,
                color=colour,
                markerfacecolor=face or colour,
                markersize=7,
                markeredgewidth=1.8,
                zorder=4,
            )
        axes.plot(
            [], [], marker, color=style.INK, markerfacecolor=face or style.INK, markersize=6, label=name
        )


def add_losses(axes, poses):
    lost = (poses["found"] == 0) & (poses["walking"] > 0)
    if lost.any():
        axes.plot(
            poses["robot_x_m"][lost],
            poses["robot_y_m"][lost],
            "x",
            color=style.INK,
            markersize=5,
            label="target not found",
            zorder=5,
        )


def draw(folder):
    path, metrics = Table(folder / "path.csv"), read_json(folder / "summary.json")
    if len(path) == 0:
        return
    figure, axes = style.new_figure(5.4)
    add_paths(axes, path)
    add_losses(axes, Table(folder / "pose_errors.csv"))
    add_ends(axes, path)
    axes.set(xlabel="x in m", ylabel="y in m")
    style.caption(axes, f"Both paths: {headline(metrics)}")
    style.save(figure, folder / "path")
