"""frames: camera pictures spread over a run, with the recovered quadrilateral."""

import style
from photographs import corners_px, read_picture, sheet
from tables import Table

NEEDS = ("frames.csv",)
COLUMNS = 4
SHEET_WIDTH_IN = 10.8


def tiles_of(folder):
    """(picture, corners, caption, found) of every row of frames.csv."""
    frames = Table(folder / "frames.csv")
    tiles = []
    for row, name in enumerate(frames.text("file")):
        found = frames["found"][row] != 0
        caption = f"{frames['t_s'][row]:.1f} s:  "
        if found:
            caption += (
                f"yaw {style.signed(frames['yaw_deg'][row], 1)}°,  certainty {frames['certainty'][row]:.2f}"
            )
        else:
            caption += "not found"
        picture = read_picture(folder / name, f"row {row + 1} of {frames.path}")
        tiles.append((picture, corners_px(frames, row), caption, found))
    return tiles


def draw(folder):
    tiles = tiles_of(folder)
    if tiles:
        style.save(sheet(tiles, COLUMNS, SHEET_WIDTH_IN), folder / "frames", kinds=("png",))
