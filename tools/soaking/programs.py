"""heel-sim and heeld as tools/soak runs them: a person who walks in a circle and waits for the robot, and its operator."""
import errno
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BIN = pathlib.Path(os.environ.get("HEEL_BUILD_DIR", ROOT / "build/release")) / "bin"
TEACH_DISTANCE_M = "1.5"
RECORDINGS_MB = 600  # the file system of the recordings, where one can be mounted; an hour takes 150
START_TIMEOUT_S = 60.0
LAST_BYTES = 1 << 20

WORLD = """name = "circle"
duration_s = 86400.0
[person]
shirt = "bold"
walk_after_s = 4.0
waits_beyond_m = 2.6
[camera]
rate_hz = 15.0
width_px = 480
height_px = 360
focal_px = [415.0, 415.0]
centre_px = [239.5, 179.5]
[robot]
x_m = -1.8
[room]
objects = 12
"""
LAP = '[[person.path]]\nstep = "arc"\nradius_m = 5.0\nangle_deg = 350.0\nspeed_m_s = 0.35\n'
LAP_S = 85.0

CONFIG = """[camera]
source = "{camera}"
info = "camera.yaml"
mount_z_m = 1.1
[target]
shirt = "shirt.heel"
[control]
gain_distance_1_s = {gain}
[robot]
address = "pty:robot"
reconnect_s = 0.5
sync_retry_s = 0.5
[operator]
socket = "control.sock"
[view]
address = "127.0.0.1:0"
[telemetry]
directory = "recordings"
black_box = "black-box"
"""


class SoakError(Exception):
    """One line for the user."""


def run(*command):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SoakError(f"{command[0]}: ended with status {done.returncode}: {done.stderr.strip()}")
    return done.stdout


class Operator:
    """A connection to heeld's socket; a new one where it breaks."""

    def __init__(self, path):
        self.path, self.connection = path, None

    def close(self):
        if self.connection is not None:
            self.connection.close()
        self.connection = None

    def ask(self, what):
        """The answer, or {} where heeld gives none."""
        try:
            if self.connection is None:
                self.connection = socket.socket(socket.AF_UNIX)
                self.connection.settimeout(5.0)
                self.connection.connect(str(self.path))
            self.connection.sendall(json.dumps({"do": what}).encode() + b"\n")
            line = b""
            while not line.endswith(b"\n"):
                part = self.connection.recv(65536)
                if not part:
                    raise OSError("closed")
                line += part
            return json.loads(line)
        except (OSError, ValueError):
            self.close()
            return {}


class Rig:
    """Both programs, and what a fault may do to them."""

    def __init__(self, folder, seed, minutes):
        self.folder, self.seed = folder, seed
        self.laps = int(60.0 * minutes / LAP_S) + 5
        self.camera = f"sim:soak-{os.getpid()}"
        self.operator = Operator(folder / "control.sock")
        self.world = self.heeld = None
        self.mounted = False

    def file(self, name):
        return self.folder / name

    def prepare(self):
        """Scenario, template, configuration, and a file system for the recordings, where this may be mounted."""
        self.folder.mkdir(parents=True, exist_ok=True)
        self.file("circle.toml").write_text(WORLD + LAP * self.laps, encoding="utf-8")
        # The same seed makes the same print of the shirt.
        told = run(BIN / "heel-sim", "--scenario", self.file("circle.toml"), "--seed", self.seed, "--still",
                   self.file("shirt.png"), "--distance", TEACH_DISTANCE_M, "--camera-info-out", self.file("camera.yaml"))
        run(BIN / "heel", "teach", "--image", self.file("shirt.png"), "--roi", re.search(r"roi=([\d,]+)", told).group(1),
            "--distance", TEACH_DISTANCE_M, "--camera-info", self.file("camera.yaml"), "-o", self.file("shirt.heel"))
        self.write_config()
        recordings = self.file("recordings")
        recordings.mkdir(exist_ok=True)
        mount = ["mount", "-t", "tmpfs", "-o", f"size={RECORDINGS_MB}m", "heel-soak", str(recordings)]
        self.mounted = subprocess.run(mount, capture_output=True, check=False).returncode == 0

    def write_config(self, gain=1.0, damaged=False):
        text = CONFIG.format(camera=self.camera, gain=gain) + ("no_such_key = 1\n" if damaged else "")
        self.file("heel.toml").write_text(text, encoding="utf-8")

    def start_world(self):
        command = [BIN / "heel-sim", "--scenario", self.file("circle.toml"), "--robot", f"pty:{self.file('robot')}",
                   "--camera", self.camera, "--seed", str(self.seed), "--live-faults"]
        with open(self.file("heel-sim.log"), "a", encoding="utf-8") as log:
            self.world = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=log, stderr=log, text=True)

    def stop_world(self):
        self.world.terminate()
        self.world.wait()
        self.world.stdin.close()

    def start_heeld(self):
        with open(self.file("heeld.log"), "w", encoding="utf-8") as log:
            self.heeld = subprocess.Popen([BIN / "heeld", "--config", self.file("heel.toml")], stdout=log, stderr=log)

    def inject(self, fault):
        """A fault of heel-sim, which begins now."""
        self.world.stdin.write(fault + "\n")
        self.world.stdin.flush()

    def reload(self):
        self.heeld.send_signal(signal.SIGHUP)

    def log(self, begin=0):
        with open(self.file("heeld.log"), "rb") as log:
            log.seek(begin)
            return log.read().decode(errors="replace")

    def log_size(self):
        return self.file("heeld.log").stat().st_size

    def page_address(self):
        """Host and port, which heeld's log names."""
        end = time.monotonic() + START_TIMEOUT_S
        while time.monotonic() < end:
            found = re.search(r"the page is served at .*, port (\d+)", self.log())
            if found:
                return "127.0.0.1", int(found.group(1))
            time.sleep(0.1)
        raise SoakError("heeld: its log does not name the page's address")

    def fill_recordings(self):
        """All that is left of the file system that was mounted for them."""
        with open(self.file("recordings/filler"), "wb", buffering=0) as file:
            space = os.fstatvfs(file.fileno())
            # All but a little at once; heeld writes meanwhile, so the rest goes block by block.
            os.posix_fallocate(file.fileno(), 0, max(1, space.f_bavail * space.f_frsize - LAST_BYTES))
            file.seek(0, os.SEEK_END)
            try:
                while True:
                    file.write(bytes(space.f_frsize))
            except OSError as error:
                if error.errno != errno.ENOSPC:
                    raise

    def free_recordings(self):
        self.file("recordings/filler").unlink(missing_ok=True)

    def end(self):
        """The exit status of heeld; None: it was not started."""
        status = None
        self.operator.close()
        if self.heeld is not None:
            if self.heeld.poll() is None:
                self.heeld.send_signal(signal.SIGCONT)
                self.heeld.terminate()
            try:
                status = self.heeld.wait(timeout=30.0)
            except subprocess.TimeoutExpired:
                self.heeld.kill()
                status = self.heeld.wait()
        if self.world is not None:
            self.stop_world()
            self.world = None
        return status

    def unmount(self):
        """Keeps the recordings in the folder."""
        if not self.mounted:
            return
        recordings, kept = self.file("recordings"), self.file("kept")
        kept.mkdir(exist_ok=True)
        for recording in recordings.glob("*.mcap"):
            shutil.copy(recording, kept)
        subprocess.run(["umount", str(recordings)], check=False)
        self.mounted = False

