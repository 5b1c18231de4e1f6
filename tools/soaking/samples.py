"""What tools/soak measures of heeld every few seconds, and whether it grows."""
import csv
import os
import pathlib
import re
import statistics

PAGE_KB = os.sysconf("SC_PAGE_SIZE") // 1024
ENDS = 8  # samples at each end that are compared
# key: unit, what may be added between the ends, what may be multiplied
LIMITS = {
    "resident_mb": ("MB", 1.0, 1.0),
    "descriptors": ("", 0, 1.0),
    "threads": ("", 0, 1.0),
    "switches_1_s": ("1/s", 20.0, 1.2),
    "core_share": ("", 0.02, 1.2),
    "lateness_ms": ("ms", 0.5, 1.5),
    "pose_to_tick_ms": ("ms", 3.0, 1.25),
}


def read(pid):
    """Counts since the start and current values, of /proc."""
    folder = pathlib.Path(f"/proc/{pid}")
    switches = 0
    for task in (folder / "task").iterdir():
        try:
            switches += sum(map(int, re.findall(r"ctxt_switches:\s*(\d+)", (task / "status").read_text(encoding="utf-8"))))
        except OSError:
            pass  # this thread has ended
    fields = (folder / "stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    return {
        "resident_mb": int((folder / "statm").read_text(encoding="utf-8").split()[1]) * PAGE_KB / 1024,
        "descriptors": len(os.listdir(folder / "fd")),
        "threads": int(fields[17]),
        "switches": switches,
        "cpu_s": (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK"),
    }


class Samples:
    """One row for each reading; `quiet`: heeld follows, and no fault was on since the reading before."""

    def __init__(self, pid):
        self.pid, self.rows, self.before = pid, [], None

    def take(self, t_s, quiet):
        now = read(self.pid)
        if self.before is not None:
            t_before_s, before = self.before
            dt_s = t_s - t_before_s
            self.rows.append({
                "t_s": round(t_s, 2), "quiet": quiet,
                "resident_mb": round(now["resident_mb"], 3),
                "descriptors": now["descriptors"],
                "threads": now["threads"],
                "switches_1_s": round((now["switches"] - before["switches"]) / dt_s, 1),
                "core_share": round((now["cpu_s"] - before["cpu_s"]) / dt_s, 4),
            })
        self.before = (t_s, now)

    def add_latency(self, csv_folder, t_begin_s):
        """From the recording, medians: how late control ticks begin; from vision's end to the tick that uses the pose; and from
        the exposure to that tick, which has the time that heel-sim takes to draw in it."""
        with open(csv_folder / "poses.csv", encoding="utf-8") as file:
            done_s = {pose["t_s"]: float(pose["done_s"]) for pose in csv.DictReader(file)}
        for row, values in zip(self.rows, self.latencies(csv_folder / "ticks.csv", done_s, t_begin_s)):
            row.update({key: round(statistics.median(of_key), 4) for key, of_key in values.items() if of_key})

    def latencies(self, ticks_csv, done_s, t_begin_s):
        """Of the ticks between each sample and the one before."""
        ends = [row["t_s"] for row in self.rows]
        found = [{"lateness_ms": [], "pose_to_tick_ms": [], "frame_to_tick_ms": []} for _ in ends]
        place, frame = 0, None
        with open(ticks_csv, encoding="utf-8") as file:
            for tick in csv.DictReader(file):
                t_s = float(tick["t_s"])
                while place < len(ends) and t_s - t_begin_s > ends[place]:
                    place += 1
                if place == len(ends):
                    break
                found[place]["lateness_ms"].append(1e-3 * float(tick["lateness_us"]))
                if tick["pose_t_capture_s"] != frame and tick["pose_t_capture_s"] in done_s:
                    frame = tick["pose_t_capture_s"]
                    found[place]["pose_to_tick_ms"].append(1e3 * (t_s - done_s[frame]))
                    found[place]["frame_to_tick_ms"].append(1e3 * (t_s - float(frame)))
        return found


def growth(rows, t_settled_s):
    """By quantity: the median of the first and of the last quiet samples, after `t_settled_s`, and whether it has grown."""
    verdict = {}
    for key, (unit, add, times) in LIMITS.items():
        values = [row[key] for row in rows if row["quiet"] and row["t_s"] >= t_settled_s and key in row]
        if len(values) < 2 * ENDS:
            verdict[key] = {"judged": False, "samples": len(values), "needed": 2 * ENDS}
            continue
        first, last = statistics.median(values[:ENDS]), statistics.median(values[-ENDS:])
        limit = first * times + add
        verdict[key] = {"judged": True, "unit": unit, "first": first, "last": last, "limit": limit, "grown": last > limit}
    return verdict
