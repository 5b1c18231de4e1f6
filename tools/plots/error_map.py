"""errors_map: yaw error over distance and angle to the line of sight, undisturbed; colour and numbers."""

import numpy as np

import style
from tables import Table

NEEDS = ("errors_map.csv",)
MOST_DEG = 15.0


def draw(folder):
    cells = Table(folder / "errors_map.csv")
    distances = np.unique(np.append(cells["distance_from_m"], cells["distance_to_m"]))
    angles = np.unique(np.append(cells["angle_from_deg"], cells["angle_to_deg"]))
    figure, axes = style.new_figure(5.0)
    figure.set_figwidth(9.6)
    axes.grid(False)
    row = np.searchsorted(distances, cells["distance_from_m"])
    column = np.searchsorted(angles, cells["angle_from_deg"])
    mean_abs = np.full((len(distances) - 1, len(angles) - 1), np.nan)
    found = cells["found"] > 0
    mean_abs[row[found], column[found]] = cells["yaw_mean_abs_deg"][found]
    image = axes.pcolormesh(
        mean_abs, cmap="YlOrBr", vmin=0.0, vmax=MOST_DEG, edgecolors="white", linewidth=1.5
    )
    for i in range(len(cells)):
        at = column[i] + 0.5, row[i] + 0.5
        dark = found[i] and cells["yaw_mean_abs_deg"][i] > 0.7 * MOST_DEG
        share = f"{100 * cells['found'][i] / cells['pictures'][i]:.0f} %" if cells["pictures"][i] > 0 else ""
        text = share
        if found[i]:
            mean, deviation = cells["yaw_mean_deg"][i], cells["yaw_deviation_deg"][i]
            places = 0 if max(abs(mean), deviation) >= 9.95 else 1
            text = f"{style.signed(mean, places)} ± {deviation:.{places}f}\n{share}"
        axes.text(*at, text, ha="center", va="center", fontsize=8, color="white" if dark else style.INK)
    axes.set_xticks(range(len(angles)), [f"{angle:g}".replace("-", "\N{MINUS SIGN}") for angle in angles])
    axes.set_yticks(
        np.arange(len(distances) - 1) + 0.5,
        [f"{a:.1f} … {b:.1f} m" for a, b in zip(distances, distances[1:])],
    )
    axes.tick_params(length=0)
    axes.invert_yaxis()
    for spine in axes.spines.values():
        spine.set_visible(False)
    axes.set_xlabel("angle of the back to the line of sight in degrees")
    axes.set_title("Yaw error in degrees (mean ± deviation) and share found, undisturbed")
    bar = figure.colorbar(image, ax=axes, pad=0.01, aspect=32, extend="max")
    bar.set_label("mean absolute yaw error in degrees")
    bar.outline.set_visible(False)
    style.save(figure, folder / "errors_map")
