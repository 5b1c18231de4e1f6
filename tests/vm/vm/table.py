"""The table device × fault × (time to rest, time to recover, lost data)."""

HEADINGS = ["device", "fault", "to rest, s", "to move again, s", "without a picture, s", "without the robot, s",
            "frames lost by the driver", "camera opened again", "bytes discarded"]


def _seconds(value):
    return "–" if value is None else f"{value:.1f}"


def markdown(rows):
    lines = ["| " + " | ".join(HEADINGS) + " |", "|" + "---|" * len(HEADINGS)]
    for row in rows:
        cells = [row["device"], row["fault"], "went on" if row["rest_s"] is None else _seconds(row["rest_s"]),
                 _seconds(row["recovery_s"]), _seconds(row["without_picture_s"]), _seconds(row["without_robot_s"]),
                 *(str(row[count]) for count in ("frames_dropped_by_driver", "camera_reopened", "bytes_discarded"))]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)
