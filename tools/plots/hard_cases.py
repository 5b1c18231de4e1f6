"""fig1_hard: the recovered quadrilateral on the shirt in hard cases."""

import numpy as np

import style
from photographs import corners_px, read_picture, sheet
from tables import Table

NEEDS = ("hard.csv",)
COLUMNS = 4
SHEET_WIDTH_IN = 8.6
KEPT_PICTURE = 1  # of the two pictures of a case, the one whose file is kept


def draw(folder):
    table = Table(folder / "hard.csv")
    names, reasons = table.text("name"), table.text("reason")
    yaw_deg, true_yaw_deg = np.degrees(table["est_yaw_rad"]), np.degrees(table["true_yaw_rad"])
    tiles = []
    for row in np.flatnonzero(table["picture"] == KEPT_PICTURE):
        found = table["found"][row] != 0
        values = f"not found: {reasons[row]}"
        if found:
            values = (
                f"yaw {style.signed(yaw_deg[row])}° (true {style.signed(true_yaw_deg[row])}°), "
                f"certainty {table['certainty'][row]:.2f}"
            )
        picture = read_picture(folder / "hard" / f"{len(tiles):03d}.png", f"{table.path}:{row + 2}")
        tiles.append((picture, corners_px(table, row), f"{names[row]}\n{values}", found))
    if tiles:
        style.save(sheet(tiles, COLUMNS, SHEET_WIDTH_IN, font_size=7.6), folder / "fig1_hard", kinds=("jpg",))
