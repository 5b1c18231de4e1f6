"""overview: many runs at a glance, a band for each: its path, and camera pictures from its middle."""

import run_frames
import run_path
import style
from photographs import show
from style import plt
from tables import Table, read_json

NEEDS = ("overview.json",)
WIDTH_IN = 11.0
HEADING_IN, PICTURES_IN, CAPTION_IN, GAP_IN = 0.47, 1.5, 0.22, 0.12
PATH_IN = 2.5
PICTURES = 4


class Band:
    """A horizontal strip of the figure; places in inches from its upper left corner."""

    def __init__(self, figure, top_in):
        self.figure, self.top_in = figure, top_in
        self.figure_in = figure.get_figheight()

    def text(self, x_in, y_in, text, **options):
        self.figure.text(x_in / WIDTH_IN, 1.0 - (self.top_in + y_in) / self.figure_in, text, **options)

    def axes(self, x_in, y_in, width_in, height_in):
        bottom = 1.0 - (self.top_in + y_in + height_in) / self.figure_in
        return self.figure.add_axes(
            (x_in / WIDTH_IN, bottom, width_in / WIDTH_IN, height_in / self.figure_in)
        )


def add_path(band, folder):
    axes = band.axes(0.36, HEADING_IN, PATH_IN - 0.5, PICTURES_IN)
    path = Table(folder / "path.csv")
    run_path.add_paths(axes, path, scale=0.6)
    run_path.add_losses(axes, Table(folder / "pose_errors.csv"))
    axes.tick_params(labelsize=6.5, length=2, pad=1.5)
    axes.text(0.99, 0.03, "m", transform=axes.transAxes, ha="right", fontsize=7)


def add_pictures(band, folder):
    """From the middle of the run."""
    tiles = run_frames.tiles_of(folder)
    first = max(0, (len(tiles) - PICTURES) // 2)
    x_in = PATH_IN
    for picture, corners, caption, _ in tiles[first : first + PICTURES]:
        width_in = min(PICTURES_IN * picture.shape[1] / picture.shape[0], (WIDTH_IN - PATH_IN) / PICTURES)
        show(band.axes(x_in, HEADING_IN, width_in - 0.04, PICTURES_IN), picture, corners, line_width=1.3)
        band.text(x_in, HEADING_IN + PICTURES_IN + 0.14, caption, fontsize=7)
        x_in += width_in


def height_in_of(run):
    return HEADING_IN + (0.0 if "refused" in run else PICTURES_IN + CAPTION_IN + GAP_IN)


def draw(folder):
    runs = read_json(folder / "overview.json")
    if not runs:
        return
    heights = [height_in_of(run) for run in runs]
    figure = plt.figure(figsize=(WIDTH_IN, sum(heights)))
    for x_in, who, colour in ((10.0, "person", style.PERSON), (10.55, "robot", style.ROBOT)):
        Band(figure, 0.0).text(x_in, 0.2, who, color=colour, weight="bold", fontsize=8.5)
    for run, top_in in zip(runs, [sum(heights[:i]) for i in range(len(heights))]):
        band = Band(figure, top_in)
        band.text(0.08, 0.2, run["scenario"], weight="bold", fontsize=10.5)
        band.text(0.08, 0.37, run["shows"] + (" (refused)" if "refused" in run else ""), fontsize=8.5)
        if "refused" in run:
            continue
        run_folder = folder / run["scenario"]
        band.text(PATH_IN, 0.2, run_path.headline(read_json(run_folder / "summary.json")), fontsize=8.5)
        add_path(band, run_folder)
        if (run_folder / "frames.csv").exists():
            add_pictures(band, run_folder)
    style.save(figure, folder / "overview", kinds=("png",))
