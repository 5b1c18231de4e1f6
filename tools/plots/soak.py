"""heeld over the time of `tools/soak`: memory, descriptors, threads, context switches, latency, and the faults."""

import style
from tables import read_json

NEEDS = ("soak.json",)
QUANTITIES = (
    ("resident_mb", "memory, MB"),
    ("descriptors", "descriptors"),
    ("threads", "threads"),
    ("switches_1_s", "context switches, 1/s"),
    ("pose_to_tick_ms", "pose to tick, ms"),
    ("frame_to_tick_ms", "exposure to tick, ms"),
)


def draw_quantity(axes, rows, key, label):
    for quiet, colour, name in ((True, style.BLUE, "follows"), (False, style.GREY, "fault, or at rest")):
        points = [(row["t_s"] / 60.0, row[key]) for row in rows if row["quiet"] == quiet and key in row]
        if points:
            axes.plot(*zip(*points), ".", color=colour, markersize=3.5, label=name)
    axes.set_ylabel(label)
    axes.margins(y=0.15)


def draw(folder):
    soak = read_json(folder / "soak.json")
    figure, all_axes = style.new_figure(9.5, len(QUANTITIES), sharex=True)
    for axes, (key, label) in zip(all_axes, QUANTITIES):
        draw_quantity(axes, soak["samples"], key, label)
        for outcome in soak["outcomes"]:
            axes.axvline(outcome["t_s"] / 60.0, color=style.PALE, linewidth=1.0, zorder=0)
        axes.axvline(soak["t_settled_s"] / 60.0, color=style.INK, linewidth=1.0, linestyle="--")
    style.caption(all_axes[0], f"heeld for {soak['minutes']:g} minutes with {len(soak['outcomes'])} faults")
    all_axes[-1].set_xlabel("minutes; lines: faults; dashed: each kind has come once")
    style.save(figure, folder / "soak")
