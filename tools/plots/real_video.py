"""real_video: certainty over the frames of a real video, and where the back is in view."""

import style
from tables import Table

NEEDS = ("real_video.csv",)


def draw(folder):
    video = Table(folder / "real_video.csv")
    frames, in_view = video["frame"], video["in_view"] > 0
    figure, axes = style.new_figure(2.8)
    title = "A real back in a real video"
    if in_view.any():
        first, last = frames[in_view][[0, -1]]
        title += f": the whole back in view from frame {first:.0f} to {last:.0f}"
        axes.axvspan(
            first, last, color=style.AMBER, alpha=0.22, linewidth=0, label="the whole back is in view"
        )
    style.add_reliable_line(axes)
    axes.plot(frames, video["certainty"], color=style.BLUE, linewidth=1.2, label="certainty")
    axes.set(xlabel="frame", ylabel="certainty")
    axes.set_ylim(bottom=0.0)
    style.caption(axes, title)
    style.save(figure, folder / "real_video")
