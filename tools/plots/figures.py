"""Which figures there are, and which of them a folder has the numbers of."""

from functools import partial

import conditions
import error_map
import hard_cases
import laws
import overview
import real_video
import reliability
import replay
import response
import run_errors
import run_frames
import run_path
import soak
import steps
import sweep
import walk
from tables import read_json

MODULES = (
    run_path,
    run_errors,
    run_frames,
    overview,
    hard_cases,
    laws,
    replay,
    response,
    walk,
    conditions,
    error_map,
    real_video,
    reliability,
    soak,
    sweep,
)


def all_figures():
    """(the files a figure needs, the function that draws it into their folder)."""
    for module in MODULES:
        yield module.NEEDS, module.draw
    for name in steps.FIGURES:
        yield (f"{name}.csv",), partial(steps.draw, name=name)


def draw_folder(folder):
    """Every figure whose files are in the folder, and those of the runs in it; returns how many."""
    drawn = 0
    for needs, draw in all_figures():
        if all((folder / name).exists() for name in needs):
            draw(folder)
            drawn += 1
    if (folder / "overview.json").exists():
        for run in read_json(folder / "overview.json"):
            if "refused" not in run:
                drawn += draw_folder(folder / run["scenario"])
    return drawn
