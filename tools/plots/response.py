"""fig7_response: the robot set down beside a person's straight line at another heading."""

import style
from tables import Table

NEEDS = ("fig7_response.csv",)


def draw(folder):
    run = Table(folder / "fig7_response.csv")
    figure, (paths, offset, heading) = style.new_figure(
        6.8, rows=3, gridspec_kw={"height_ratios": (1.35, 1.0, 1.0)}
    )
    paths.plot(run["person_x_m"], run["person_y_m"], color=style.PERSON, linewidth=3.2, label="person")
    paths.plot(run["robot_x_m"], run["robot_y_m"], color=style.ROBOT, linewidth=1.7, label="robot")
    style.to_scale(paths)
    paths.set(xlabel="x in m", ylabel="y in m")
    begin = run["offset_m"][0], run["heading_deg"][0]
    style.caption(
        paths,
        f"Figure 7: set down {abs(begin[0]):.2f} m beside the line, turned by {style.signed(begin[1])}°",
    )
    for axes, column, label, title in (
        (offset, "offset_m", "offset in m", "Robot's distance from the person's line"),
        (heading, "heading_deg", "angle in degrees", "Robot's heading against the person's"),
    ):
        axes.axhline(0.0, color=style.GREY, linewidth=1.0)
        axes.plot(run["driven_m"], run[column], color=style.ROBOT, linewidth=1.6)
        axes.set_ylabel(label)
        axes.set_title(title)
    heading.set_xlabel("distance driven in m")
    heading.sharex(offset)
    figure.align_ylabels()
    style.save(figure, folder / "fig7_response")
