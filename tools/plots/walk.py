"""fig8_walk: both paths of a long walk, and that of a robot which follows the position only."""

import numpy as np

import style
from tables import Table, read_json

NEEDS = ("fig8_walk.csv", "fig8_walk.json")


def draw(folder):
    table, numbers = Table(folder / "fig8_walk.csv"), read_json(folder / "fig8_walk.json")
    runs = np.array(table.text("run"))
    walk, position_only = runs == "walk", runs == "walk-position-only"
    figure, axes = style.new_figure(5.6)
    axes.plot(
        table["person_x_m"][walk],
        table["person_y_m"][walk],
        color=style.PERSON,
        linewidth=3.4,
        label="person",
    )
    axes.plot(
        table["robot_x_m"][walk], table["robot_y_m"][walk], color=style.ROBOT, linewidth=1.6, label="robot"
    )
    title = (
        f"Figure 8: {numbers['person_path_m']:.0f} m walked, "
        f"the robot's path {numbers['following_rms_m']:.2f} m RMS from the person's"
    )
    if position_only.any():
        axes.plot(
            table["robot_x_m"][position_only],
            table["robot_y_m"][position_only],
            color=style.GREEN,
            linewidth=1.6,
            linestyle=(0, (5, 1.6)),
            label=f"robot that follows the position only: {numbers['position_only_rms_m']:.2f} m RMS",
        )
    style.to_scale(axes)
    axes.set(xlabel="x in m", ylabel="y in m")
    style.caption(axes, title)
    style.save(figure, folder / "fig8_walk")
