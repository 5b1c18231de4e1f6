"""Waterfall of `heel latency --json`: each hop from a frame's exposure to its command, and the slowest frame."""

import os

import style
from tables import BadInput

BAR = 0.55


def draw_waterfall(axes, report):
    hops = report["hops"]
    begin = 0.0
    for y, hop in enumerate(hops):
        axes.barh(y, hop["p50_ms"], BAR, left=begin, color="#2171B5")
        axes.plot((begin, begin + hop["p99_ms"]), (y, y), color=style.INK, linewidth=1.2)
        axes.plot((begin + hop["p99_ms"],) * 2, (y - 0.15, y + 0.15), color=style.INK, linewidth=1.2)
        text = f"{hop['p50_ms']:.2f} ms, p99 {hop['p99_ms']:.2f}, max {hop['max_ms']:.2f}"
        axes.text(1.02, y, text, transform=axes.get_yaxis_transform(), va="center", fontsize=8.5)
        begin += hop["p50_ms"]
    total = report.get("to_wheels", report["total"])
    axes.barh(len(hops), total["p50_ms"], BAR, color="#A6A6A6")
    text = f"{total['p50_ms']:.1f} ms, p99 {total['p99_ms']:.1f}, max {total['max_ms']:.1f}"
    axes.text(1.02, len(hops), text, transform=axes.get_yaxis_transform(), va="center", fontsize=8.5)
    axes.plot(report["slowest_ms"][1:], range(len(hops)), "o", color="#D55E00", label="the slowest frame")
    axes.set(xlim=(0.0, 1.05 * max(report["slowest_ms"][-1], total["p99_ms"])), ylim=(len(hops) + 0.5, -0.5))
    axes.set_yticks(range(len(hops) + 1), [hop["name"] for hop in hops] + [total["name"]])
    axes.grid(axis="y", visible=False)
    axes.set_xlabel("ms after the exposure; bar: median, line: to the 99th percentile of the hop")
    axes.legend(loc="upper right")


def draw(report, picture):
    """`report` is the JSON object; `picture` names the picture to write, an SVG goes beside it."""
    name, kind = os.path.splitext(picture)
    kind = kind.lstrip(".").lower()
    if kind not in style.SAVE_OPTIONS:
        raise BadInput(f"{picture}: unknown kind of picture (expected a name ending in .png, .jpg or .svg)")
    figure = style.plt.figure(figsize=(8.8, 4.2))
    figure.text(0.5, 0.94, "From the exposure of a frame to its command", **style.TITLE)
    source = os.path.basename(report["recording"])
    figure.text(0.5, 0.885, f"{report['commands']} commands of {source}", ha="center", fontsize=9)
    draw_waterfall(figure.add_axes((0.19, 0.14, 0.53, 0.7)), report)
    style.save(figure, name, kinds=dict.fromkeys((kind, "svg")))
