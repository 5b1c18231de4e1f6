"""What heeld recorded in an interval: the longest time without a picture and without the robot; frames and bytes lost."""
import csv
import io


def _rows(text, begin_s, end_s):
    """Rows of a recording's .csv with begin_s <= t_s <= end_s (seconds of the guest's CLOCK_MONOTONIC)."""
    return [row for row in csv.DictReader(io.StringIO(text)) if row["t_s"] and begin_s <= float(row["t_s"]) <= end_s]


def _longest_gap_s(times_s, begin_s, end_s):
    inside = sorted({t for t in times_s if begin_s <= t <= end_s})
    points = [begin_s, *inside, end_s]
    return max(later - earlier for earlier, later in zip(points, points[1:]))


def _grown(rows, column):
    return int(float(rows[-1][column]) - float(rows[0][column])) if rows else 0


def _since(text, begin_s, end_s):
    """As _rows, for a file with a line for each change: with the newest line before begin_s, or zeros."""
    rows = list(csv.DictReader(io.StringIO(text)))
    before = [row for row in rows if float(row["t_s"]) < begin_s][-1:]
    return (before or [dict.fromkeys(rows[0], 0)] if rows else []) + _rows(text, begin_s, end_s)


def losses(ticks_csv, poses_csv, capture_csv, begin_s, end_s):
    ticks = _rows(ticks_csv, begin_s, end_s)
    captures = _since(capture_csv, begin_s, end_s)
    pictures = [float(row["t_s"]) for row in _rows(poses_csv, begin_s, end_s)]
    packets = [float(row["odom_t_s"]) for row in ticks if row["odom_t_s"] != "nan"]

    return {
        "without_picture_s": round(_longest_gap_s(pictures, begin_s, end_s), 2),
        "without_robot_s": round(_longest_gap_s(packets, begin_s, end_s), 2),
        "frames_captured": _grown(captures, "captured"),
        "frames_dropped_by_driver": _grown(captures, "dropped_by_driver"),
        "camera_reopened": _grown(captures, "reopened"),
        "bytes_discarded": _grown(ticks, "bytes_discarded"),
        "checksum_errors": _grown(ticks, "checksum_errors"),
        "reconnects": _grown(ticks, "reconnects"),
    }
