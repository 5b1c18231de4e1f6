"""sweep: path, distance and calm of the control laws while one thing at a time is changed (tools/sweep-laws)."""

import numpy as np

import style
from tables import Table

NEEDS = ("sweep.csv",)

AXES = {
    "gain_distance_1_s": "gain of distance, 1/s",
    "bearing_gain_1_s": "gain of the picture's limit, 1/s",
    "trail_reach_m": "reach of the trail, m",
    "trail_delay_s": "delay allowed for, s",
    "gain_lateral_rad_s_m": "gain of t_x, rad/s/m",
    "gain_yaw_1_s": "gain of yaw, 1/s",
    "setpoint_t_z_m": "set distance, m more",
    "speed": "person's speed, m/s",
    "latency": "latency of vision, ms",
    "track": "true track, m (0.588 assumed)",
}
ROWS = (
    ("path_p95_m", "beside the path, 95 %, m", 0.5),
    ("along_p95_m", "along it, 95 %, m", 1.5),
    ("straight_yaw_rate_rms_rad_s", "yaw rate on straights, rad/s", 0.3),
)
COLOURS = {"trail": style.BLUE, "view": style.VERMILION, "position": style.GREEN}


def draw(folder):
    table = Table(folder / "sweep.csv")
    laws, changed = np.array(table.text("law")), np.array(table.text("what"))
    names = [what for what in AXES if what in changed]
    figure, grid = style.new_figure(6.8, rows=len(ROWS), columns=len(names), sharex="col", sharey="row")
    figure.set_size_inches(2.0 * len(names), 6.8)
    for column, what in enumerate(names):
        for row, (figure_name, label, most) in enumerate(ROWS):
            axes = grid[row][column]
            for law in dict.fromkeys(laws):
                chosen = (laws == law) & (changed == what)
                values, followed = table["value"][chosen], table["followed_to_end"][chosen]
                axes.plot(values, np.minimum(table[figure_name][chosen], most), color=COLOURS[law], label=law)
                lost = followed < 1.0
                axes.plot(values[lost], np.full(lost.sum(), most), "x", color=COLOURS[law])
            axes.set_ylim(0.0, 1.05 * most)
            if column == 0:
                axes.set_ylabel(label)
        grid[-1][column].set_xlabel(AXES[what])
    grid[0][0].legend(loc="upper left")
    figure.suptitle("What the control laws bear: x marks runs in which the person was lost", **style.TITLE)
    style.save(figure, folder / "sweep")
