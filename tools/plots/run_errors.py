"""errors: yaw, t_x and t_z beside the truth, the certainty, and the commands to the robot, over time."""

import style
from tables import Table

NEEDS = ("pose_errors.csv", "commands.csv")
QUANTITIES = (
    ("Yaw of the back in the camera", "yaw in degrees", "yaw_deg"),
    ("Sideways position", "$t_x$ in m", "x_m"),
    ("Distance", "$t_z$ in m", "z_m"),
)


def draw(folder):
    poses, commands = Table(folder / "pose_errors.csv"), Table(folder / "commands.csv")
    figure, panels = style.new_figure(10.2, rows=len(QUANTITIES) + 2, sharex=True)
    for axes, (title, label, column) in zip(panels, QUANTITIES):
        axes.plot(poses["t_s"], poses[f"true_{column}"], color=style.TRUTH, linewidth=3.6, label="true")
        axes.plot(poses["t_s"], poses[column], color=style.BLUE, linewidth=1.1, label="estimated")
        axes.set_ylabel(label)
        beside(axes, title)

    axes = panels[-2]
    style.add_reliable_line(axes)
    axes.plot(poses["t_s"], poses["certainty"], color=style.BLUE, linewidth=1.0, label="certainty")
    axes.set_ylabel("certainty")
    axes.set_ylim(bottom=0.0)
    beside(axes, "Certainty: inliers / template features")

    axes = panels[-1]
    axes.plot(commands["t_s"], commands["v_m_s"], color=style.BLUE, linewidth=1.3, label="speed in m/s")
    axes.plot(
        commands["t_s"],
        commands["yaw_rate_rad_s"],
        color=style.VERMILION,
        linewidth=1.3,
        label="yaw rate in rad/s, left positive",
    )
    axes.set_ylabel("m/s, rad/s")
    beside(axes, "Commands to the robot")
    axes.set_xlabel("time in s")
    axes.set_xlim(left=0.0)
    for axes in panels:
        axes.tick_params(labelbottom=True)
    figure.align_ylabels(panels)
    style.save(figure, folder / "errors")


def beside(axes, title):
    """Title at the left, legend at the right of the same row."""
    axes.set_title(title)
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncol=3, borderaxespad=0.1)
