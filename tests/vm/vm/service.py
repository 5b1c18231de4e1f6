"""heeld in the guest: its configuration, its systemd unit, its recording."""
import os
import re
import shutil

from . import recording, wait

START_S = 150.0  # the emulator needs 10 s and more to link the daemon's libraries, twice: --check runs first
FRAME_TIMEOUT_S = 1.5

# The emulated processor needs up to half a second for a small picture, so pictures count as fresh for longer than on a robot.
CONFIGURATION = """\
[camera]
source = "{camera}"
info = "{info}"
format = "{format}"
rate_hz = 10
width_px = {width_px}
height_px = {height_px}
{more_camera}[target]
shirt = "{shirt}"
[vision]
octaves = {octaves}
max_features = {max_features}
[control]
setpoint_t_z_m = {setpoint_t_z_m}
bearing_max_rad = {bearing_max_rad}
[supervisor]
start = "at_once"
frame_timeout_s = {frame_timeout_s}
target_timeout_s = {frame_timeout_s}
[robot]
address = "{robot}"
[telemetry]
directory = "/var/lib/heel"
{more}"""
DEFAULTS = {
    "width_px": 320, "height_px": 180, "format": "auto", "more_camera": "", "octaves": 1, "max_features": 150,
    "setpoint_t_z_m": -0.6,  # the picture does not move, at the template's distance: the robot always wants to drive nearer
    "bearing_max_rad": 0.35, "info": "camera.yaml", "shirt": "shirt.heel", "frame_timeout_s": FRAME_TIMEOUT_S, "more": "",
}


class Service:
    def __init__(self, machine):
        self._machine = machine
        self._guest = machine.agent

    def configure(self, camera, robot, **others):
        text = CONFIGURATION.format(camera=camera, robot=robot, **{**DEFAULTS, **others})
        self.install("heel.toml", text.encode())

    def install(self, name, content):
        """A file in /etc/heel."""
        with open(os.path.join(self._machine.share, name), "wb") as file:
            file.write(content)
        self._guest.run(f"cp /mnt/share/{name} /etc/heel/{name}")

    def start(self):
        """Does not wait for READY."""
        self._guest.run("systemctl start --no-block heeld")

    def wait_until_ready(self):
        wait.until("heeld is ready", lambda: self.state() == "active", START_S, step_s=0.5)

    def stop(self):
        self._guest.run("systemctl stop heeld")

    def state(self):
        return self._show("ActiveState")

    def status_text(self):
        return self._show("StatusText")

    def _show(self, name):
        return self._guest.run(f"systemctl show --value -p {name} heeld")

    def journal(self, lines=40):
        return self._guest.status_of(f"journalctl -u heeld -o cat -n {lines} --no-pager")[1]

    def journal_since(self, begin_s):
        """The journal from begin_s (guest's CLOCK_MONOTONIC) on; it may start up to a second earlier."""
        now_s = float(self._guest.run("cut -d' ' -f1 /proc/uptime"))
        return self._guest.status_of(f"journalctl -u heeld -o cat --no-pager --since=-{int(now_s - begin_s) + 1}s")[1]

    def events(self, pattern, begin_s):
        """Lines of the recording's events from begin_s (guest's CLOCK_MONOTONIC) on that match."""
        text = self.recorded("events.log")
        lines = (line.split(" ", 1) for line in text.splitlines() if re.match(r"\d+\.\d+ ", line))
        return [what for t_s, what in lines if float(t_s) >= begin_s and re.search(pattern, what)]

    def losses(self, begin_s, end_s):
        return recording.losses(*(self.recorded(f"{name}.csv") for name in ("ticks", "poses", "capture")), begin_s, end_s)

    def recorded_until(self):
        """CLOCK_MONOTONIC of the guest's newest recorded tick, seconds."""
        ticks = self.recorded("ticks.csv").splitlines()[1:]
        return float(ticks[-1].split(",", 1)[0]) if ticks else 0.0

    def copy_recording(self, path):
        """The newest recording as it is now, into a file here."""
        self._guest.run('cp "$(ls -t /var/lib/heel/*.mcap | head -n 1)" /mnt/share/run.mcap')
        shutil.copyfile(os.path.join(self._machine.share, "run.mcap"), path)

    def recorded(self, name):
        """The complete lines of a file that `heel export` makes of the newest recording."""
        self._guest.run(f"heel export /var/lib/heel --csv -o /run/exported && cp /run/exported/{name} /mnt/share/{name}")
        with open(os.path.join(self._machine.share, name)) as file:
            text = file.read()
        return text[:text.rfind("\n") + 1]
