"""laws: the paths on which three control laws follow the same person, and how far each is beside the person's path."""

import numpy as np

import style
from tables import Table

LAWS = (("position", style.AMBER), ("view", style.BLUE), ("trail", style.GREEN))
NEEDS = tuple(f"{name}/truth.csv" for name, _ in LAWS)
SPACING_M = 0.05  # of the points of the person's path


def places(truth, who):
    return np.column_stack((truth[f"{who}_x_m"], truth[f"{who}_y_m"]))


def evenly(path):
    """Points of the path SPACING_M apart, and the length walked up to each."""
    walked = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))))
    at = np.arange(0.0, walked[-1], SPACING_M)
    return np.column_stack([np.interp(at, walked, path[:, axis]) for axis in (0, 1)]), at


def beside(robot, path):
    """For each point of the path the robot's distance to its left, where the robot passes it."""
    along = np.gradient(path, axis=0)
    along /= np.linalg.norm(along, axis=1)[:, None]
    nearest = np.argmin(np.linalg.norm(path[:, None] - robot[None], axis=2), axis=1)
    apart = robot[nearest] - path
    return along[:, 0] * apart[:, 1] - along[:, 1] * apart[:, 0]


def draw(folder):
    truths = {name: Table(folder / name / "truth.csv") for name, _ in LAWS}
    path, walked_m = evenly(places(truths["view"], "person"))
    figure, (map_axes, axes) = style.new_figure(6.6, rows=2, height_ratios=(3, 2))
    map_axes.plot(*path.T, color=style.PERSON, linewidth=3.4, label="person")
    for name, colour in LAWS:
        robot = places(truths[name], "robot")
        map_axes.plot(*robot.T, color=colour, linewidth=1.6, label=name)
        # Where the person stops, the robot stays behind by the set distance.
        last_m = walked_m[np.argmin(np.linalg.norm(path - robot[-1], axis=1))]
        passed = walked_m <= last_m
        apart_cm = 100.0 * beside(robot, path)[passed]
        rms_cm = np.sqrt(np.mean(apart_cm**2))
        axes.plot(walked_m[passed], apart_cm, color=colour, linewidth=1.4, label=f"{name}: {rms_cm:.1f} cm RMS")
    axes.axhline(0.0, color=style.PERSON, linewidth=1.2)
    style.to_scale(map_axes)
    map_axes.set(xlabel="x in m", ylabel="y in m")
    axes.set(xlabel="along the person's path in m", ylabel="robot to its left in cm")
    style.caption(map_axes, "The same walk, followed by each of the three laws")
    style.caption(axes, "Beside the person's path")
    style.save(figure, folder / "laws")
