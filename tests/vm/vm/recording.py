"""What heeld recorded of a stretch of time: how long it went without a picture, without the robot, and bytes lost."""
import csv
import io


def _rows(text, begin_s, end_s):
    """Rows of a recording's .csv with begin_s <= t_s <= end_s (seconds of the guest's CLOCK_MONOTONIC)."""
    return [row for row in csv.DictReader(io.StringIO(text)) if row["t_s"] and begin_s <= float(row["t_s"]) <= end_s]


def _longest_gap_s(times_s, begin_s, end_s):
    inside = sorted({t for t in times_s if begin_s <= t <= end_s})
    points = [begin_s, *inside, end_s]
    return max(later - earlier for earlier, later in zip(points, points[1:]))


def losses(ticks_csv, poses_csv, begin_s, end_s):
    ticks = _rows(ticks_csv, begin_s, end_s)
    pictures = [float(row["t_s"]) for row in _rows(poses_csv, begin_s, end_s)]
    packets = [float(row["odom_t_s"]) for row in ticks if row["odom_t_s"] != "nan"]

    def grown(column):
        return int(float(ticks[-1][column]) - float(ticks[0][column])) if ticks else 0

    return {
        "without_picture_s": round(_longest_gap_s(pictures, begin_s, end_s), 2),
        "without_robot_s": round(_longest_gap_s(packets, begin_s, end_s), 2),
        "bytes_discarded": grown("bytes_discarded"),
        "checksum_errors": grown("checksum_errors"),
        "reconnects": grown("reconnects"),
    }
