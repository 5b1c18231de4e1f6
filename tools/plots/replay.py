"""replay: the recorded commands to the robot and those of a replay, over time."""

import numpy as np
import style
from tables import Table

NEEDS = ("replay.csv",)
QUANTITIES = (
    ("Speed", "m/s", "v_m_s"),
    ("Yaw rate, left positive", "rad/s", "yaw_rate_rad_s"),
)


def draw(folder):
    replay = Table(folder / "replay.csv")
    figure, panels = style.new_figure(6.2, rows=len(QUANTITIES), sharex=True)
    for axes, (title, label, column) in zip(panels, QUANTITIES):
        recorded, replayed = replay[f"recorded_{column}"], replay[f"replayed_{column}"]
        axes.plot(replay["t_s"], recorded, color=style.TRUTH, linewidth=3.6, label="recorded")
        axes.plot(replay["t_s"], replayed, color=style.BLUE, linewidth=1.1, label="replayed")
        different = np.flatnonzero(recorded != replayed)
        if len(different) > 0:
            t_s = replay["t_s"][different[0]]
            axes.axvline(t_s, color=style.VERMILION, linewidth=1.0, label="first difference")
        axes.set_ylabel(label)
        axes.set_title(title)
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncol=3, borderaxespad=0.1)
        axes.tick_params(labelbottom=True)
    panels[-1].set_xlabel("time in s")
    figure.align_ylabels(panels)
    style.save(figure, folder / "replay")
