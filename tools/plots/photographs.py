"""Camera pictures as a sheet of equal tiles, each with the recovered quadrilateral and a caption beneath."""

import numpy as np

from style import DPI, INK, VERMILION, plt
from tables import BadInput

FOUND = "#2BE34A"  # stands out from any grey
GAP_IN, CAPTION_LINE_IN = 0.045, 0.165


def read_picture(path, place):
    """Grey or colour, 0 ... 1; `place` is what names the picture."""
    try:
        picture = plt.imread(path)
    except (OSError, SyntaxError, ValueError) as error:
        raise BadInput(f"{path}: cannot read (expected the picture of {place})") from error
    return picture / 255.0 if picture.dtype == np.uint8 else picture


def corners_px(table, row):
    """The quadrilateral of a row, four corners of x and y; None where nothing was found."""
    if table["found"][row] == 0:
        return None
    return np.array([[table[f"corner_{i}_{axis}_px"][row] for axis in "xy"] for i in range(4)])


def show(axes, picture, corners, line_width=1.8):
    """A picture that fills its axes, and the quadrilateral in it."""
    axes.set_axis_off()
    axes.imshow(picture, cmap="gray", vmin=0.0, vmax=1.0, aspect="auto")
    if corners is not None:
        for colour, width in (("black", line_width + 1.0), (FOUND, line_width)):
            axes.fill(*corners.T, fill=False, edgecolor=colour, linewidth=width, joinstyle="round")
    height, width = picture.shape[:2]
    axes.set(xlim=(-0.5, width - 0.5), ylim=(height - 0.5, -0.5))


def sheet(tiles, columns, width_in, font_size=9):
    """A figure of tiles (picture, corners, caption, found)."""
    columns = min(columns, len(tiles))
    rows = -(-len(tiles) // columns)
    caption_in = 0.07 + CAPTION_LINE_IN * font_size / 9 * max(tile[2].count("\n") + 1 for tile in tiles)
    tile_in = (width_in - GAP_IN * (columns + 1)) / columns
    picture_in = tile_in * tiles[0][0].shape[0] / tiles[0][0].shape[1]
    row_in = picture_in + caption_in + GAP_IN
    height_in = rows * row_in + GAP_IN
    figure = plt.figure(figsize=(width_in, height_in), dpi=DPI)
    for index, (picture, corners, caption, found) in enumerate(tiles):
        left = GAP_IN + index % columns * (tile_in + GAP_IN)
        bottom = height_in - GAP_IN - index // columns * row_in - picture_in
        axes = figure.add_axes(
            (left / width_in, bottom / height_in, tile_in / width_in, picture_in / height_in)
        )
        show(axes, picture, corners)
        figure.text(
            (left + 0.03) / width_in,
            (bottom - 0.05) / height_in,
            caption,
            fontsize=font_size,
            verticalalignment="top",
            linespacing=1.25,
            color=INK if found else VERMILION,
        )
    return figure
