"""The faults of tools/soak: how each is made and ended, and what heeld must say of it (docs/safety.md, docs/recording.md)."""
import re
import signal
import socket
import time
from dataclasses import dataclass
from typing import Callable, Optional

VIEWERS = 8
UPGRADE = ("GET {path} HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
           "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\nOrigin: http://127.0.0.1:{port}\r\n\r\n")
# What only says that the picture was late or the person out of sight; a busy machine draws too slowly.
OF_THE_PICTURE = "camera silent|target lost|certainty too low"


@dataclass
class Fault:
    """`says`: what heeld's log must have. `stops`: the robot must come to rest for it; otherwise it must drive on, except for
    the reasons `may_stop`."""
    name: str
    begin: Callable
    says: str
    stops: bool = True
    may_stop: str = OF_THE_PICTURE
    seconds: float = 0.0
    end: Optional[Callable] = None
    end_when_said: bool = False  # not before heeld has said it
    needs_mount: bool = False


class Viewers:
    """Clients of page and socket that ask for everything and read nothing."""

    def __init__(self):
        self.open = []

    def connect(self, family, address, first):
        client = socket.socket(family)
        client.settimeout(5.0)
        client.connect(address)
        client.sendall(first.encode())
        self.open.append(client)

    def on_socket(self, rig):
        for _ in range(VIEWERS):
            self.connect(socket.AF_UNIX, str(rig.file("control.sock")), '{"do":"watch","period_s":0.1}\n{"do":')

    def on_page(self, rig):
        host, port = rig.page_address()
        for path in ("/live", "/foxglove", "/operator"):
            self.connect(socket.AF_INET, (host, port), UPGRADE.format(path=path, port=port))
        self.connect(socket.AF_INET, (host, port), "GET /log HTTP/1.1\r\nHost: 127.0")

    def leave(self, _):
        for client in self.open:
            client.close()
        self.open = []

    def come_and_go(self, rig):
        for _ in range(VIEWERS):
            self.on_socket(rig)
            self.on_page(rig)
            time.sleep(0.1)
            self.leave(rig)


def restart_world(rig):
    rig.stop_world()
    time.sleep(1.0)
    rig.start_world()


def stop_for(seconds):
    def stop(rig):
        rig.heeld.send_signal(signal.SIGSTOP)
        time.sleep(seconds)
        rig.heeld.send_signal(signal.SIGCONT)
    return stop


def reload_good(rig):
    rig.reloads = getattr(rig, "reloads", 0) + 1
    rig.write_config(gain=(0.9, 1.0)[rig.reloads % 2])
    rig.reload()


def reload_bad(rig):
    rig.write_config(damaged=True)
    rig.reload()


def inject(fault):
    return lambda rig: rig.inject(fault)


def at_rest(*reasons):
    return "at rest: (" + "|".join(reasons) + ")"


def all_faults():
    viewers = Viewers()
    of_the_line = OF_THE_PICTURE + "|robot silent|no link to the robot|motors off|sonars silent"
    lost = ("robot silent", "no link to the robot", "motors off", "sonars silent")
    return [
        Fault("camera away for 2 s", inject("camera+2"), at_rest("camera silent"), seconds=2.0),
        Fault("robot silent for 2 s", inject("silence+2"), at_rest("robot silent"), seconds=2.0),
        Fault("line garbles 1 % of the bytes", inject("garble+3=0.01"), "", stops=False,
              may_stop=of_the_line, seconds=3.0),
        Fault("line loses 1 % of the bytes", inject("drop+3=0.01"), "", stops=False,
              may_stop=of_the_line, seconds=3.0),
        Fault("robot restarts", inject("reset"), at_rest(*lost)),
        Fault("robot and camera unplugged for 1 s", restart_world, at_rest(*lost)),
        Fault("emergency stop", lambda rig: rig.operator.ask("estop"), at_rest("emergency stop")),
        Fault("STOP button", inject("stop_button+1"), at_rest("stop button pressed"), seconds=1.0),
        Fault("bumper", inject("bumper+1=4"), at_rest("bumper pressed"), seconds=1.0),
        Fault("wheels blocked", inject("stall+1"), at_rest("wheels stalled"), seconds=1.0),
        Fault("heeld held for 0.5 s", stop_for(0.5), at_rest("control too late")),
        Fault("reload", reload_good, "reloaded", stops=False),
        Fault("reload of a bad file", reload_bad, "reload refused", stops=False, end=lambda rig: rig.write_config(),
              end_when_said=True),
        Fault("disk full for 3 s", lambda rig: rig.fill_recordings(),
              r"(?s)cannot write.*can be written again", stops=False, seconds=3.0,
              end=lambda rig: rig.free_recordings(), needs_mount=True),
        Fault("viewers hang on the socket", viewers.on_socket, "", stops=False, seconds=4.0, end=viewers.leave),
        Fault("viewers hang on the page", viewers.on_page, "", stops=False, seconds=4.0, end=viewers.leave),
        Fault("viewers come and go", viewers.come_and_go, "", stops=False),
    ]


def reasons_in(log):
    """Why the robot was at rest, in order, each once; `not started` is its operator's."""
    reasons = (reason.strip() for reason in re.findall(r"at rest: ([^;(\n]+)", log))
    return [reason for reason in dict.fromkeys(reasons) if reason != "not started"]


def said(says, log):
    return re.search(says, log) is not None


def as_stated(fault, log):
    """Whether heeld's log since the fault's beginning is what the manual says."""
    if not said(fault.says, log):
        return False
    if fault.stops:
        return True
    return all(re.search(fault.may_stop, reason) for reason in reasons_in(log))
