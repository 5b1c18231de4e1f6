"""The simulated P3-AT on the host: heel-sim at a pty, and the truth that it writes."""
import os
import subprocess
import time

from . import wait

MOVING_M_S = 0.05
RESTING_M_S = 0.002
RESTING_RAD_S = 0.002


class Robot:
    """heel-sim in real time. All times are seconds of the host's CLOCK_MONOTONIC."""

    def __init__(self, heel_sim, folder, name, faults=(), boot_baud=9600, world=()):
        """`world`: options for a world with a person and a camera."""
        self.name = name
        self.pty = os.path.join(folder, f"{name}.pty")
        self._truth = os.path.join(folder, f"{name}.csv")
        self.heel_sim = heel_sim
        self._log_path = os.path.join(folder, f"{name}.log")
        self._wire = os.path.join(folder, f"{name}.wire")
        command = [heel_sim, "--robot", f"pty:{self.pty}", "--truth", self._truth, "--truth-rate", "100", "--wire", self._wire,
                   "--boot-baud", str(boot_baud), *world]
        for fault in faults:
            command += ["--fault", fault]
        with open(self._log_path, "wb") as log:
            self._process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT)
        self._rows = []
        self._read_to = 0
        self._columns = None
        self._zero_s = float("inf")  # the simulator's time 0, from the least delay a row was seen with
        wait.until(f"{self.pty}: the simulated robot", self._up, 20)

    def _up(self):
        if self._process.poll() is not None:
            raise RuntimeError(f"heel-sim ended with status {self._process.returncode}; see {self._log_path}")
        return os.path.exists(self.pty) and len(self.rows()) > 100

    def rows(self):
        """(time, speed m/s, yaw rate rad/s, session open, motors on), 100 a second, up to about half a second ago."""
        try:
            with open(self._truth, "rb") as file:
                file.seek(self._read_to)
                data = file.read()
        except FileNotFoundError:
            return []
        complete = data[:data.rfind(b"\n") + 1]
        self._read_to += len(complete)
        for line in complete.decode().split("\n")[:-1]:
            if self._columns is None:
                names = line.split(",")
                wanted = ("t_s", "robot_v_m_s", "robot_yaw_rate_rad_s", "session_open", "motors_enabled")
                self._columns = [names.index(name) for name in wanted]
            else:
                fields = line.split(",")
                self._rows.append(tuple(float(fields[i]) for i in self._columns))
        if complete and self._rows:
            self._zero_s = min(self._zero_s, time.monotonic() - self._rows[-1][0])
        return self._rows

    def _since(self, t_s, holds):
        """When `holds` was first true of a row at or after t_s; None: not yet."""
        for row in rows_from(self.rows(), t_s - self._zero_s):
            if holds(row):
                return row[0] + self._zero_s
        return None

    def rested_since(self, t_s):
        return self._since(t_s, lambda row: abs(row[1]) < RESTING_M_S and abs(row[2]) < RESTING_RAD_S)

    def moved_since(self, t_s):
        return self._since(t_s, lambda row: abs(row[1]) > MOVING_M_S)

    def last_heard(self, before_s):
        """When the last bytes before that time arrived."""
        with open(self._wire) as file:
            times_s = [float(line.split(" ", 1)[0]) for line in file if line.endswith("\n")]
        return max(t_s for t_s in times_s if t_s <= before_s)

    def at(self, t_s):
        """Converts a time since the simulator's start, as for faults, to the host's clock."""
        return self._zero_s + t_s

    def speed_m_s(self):
        return self.rows()[-1][1]

    def is_open(self):
        return self.rows()[-1][3] > 0.5

    def motors_are_on(self):
        return self.rows()[-1][4] > 0.5

    def truth(self):
        """The text of the truth file so far."""
        with open(self._truth) as file:
            text = file.read()
        return text[:text.rfind("\n") + 1]

    def log(self):
        with open(self._log_path, errors="replace") as file:
            return file.read()

    def stop(self):
        self._process.kill()
        self._process.wait()


def rows_from(rows, t_s):
    """The rows from t_s on, in order of time, without a search through the earlier rows."""
    first = len(rows)
    while first > 0 and rows[first - 1][0] >= t_s:
        first -= 1
    return rows[first:]
