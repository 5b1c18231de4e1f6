"""Faults of the robot and its line: noise, silence, a reset, a session left open at another rate; and another adapter."""
from cases.appearing import VIVID
from vm.bench import SILENCE_REST_S
from vm.service import START_S

ADAPTERS = "/etc/heel/adapters"
QUIET_S = 8.0  # of the faults that last


def run(bench):
    service, machine = bench.service, bench.machine
    bench.guest.run(VIVID)
    service.configure(camera="v4l2:/dev/video0", robot="serial:/dev/heel-robot@38400")
    service.start()
    bench.wait("heeld waits for the robot", lambda: "the robot" in service.status_text(), START_S)

    plugged = []

    def plug(name, faults=(), **settings):
        while plugged:
            machine.unplug_ftdi(plugged.pop())
        robot = bench.new_robot(name, faults=faults, **settings)
        machine.plug_ftdi(name, robot.pty)
        plugged.append(name)
        return robot

    left_open(bench, plug)
    noise(bench, plug)
    off_and_on(bench, plug)
    other_adapter(bench, machine, plugged.pop())
    service.stop()
    bench.guest.run("modprobe -r vivid")


def left_open(bench, plug):
    robot = plug("left_open", faults=["left_open@0.2=300"], boot_baud=57600)
    bench.wait("a robot left open at 57600 baud, driving at 0.3 m/s when woken, is brought to heel",
               lambda: bench.service.state() == "active")
    bench.wait_until_following(robot)
    service_events = bench.service.events("baud", 0)
    bench.check(any("57600" in event or "38400" in event for event in service_events), f"its rate was found: {service_events[-1]}")


def noise(bench, plug):
    begin_s = 25.0
    robot = plug("noise", faults=[f"garble@{begin_s}+{QUIET_S}=0.01", f"drop@{begin_s}+{QUIET_S}=0.005"])
    bench.timed_fault("FTDI", "1 % of bytes garbled, 0.5 % lost, 8 s", robot, begin_s, QUIET_S)


def off_and_on(bench, plug):
    begin_s = 25.0
    robot = plug("reset", faults=[f"reset@{begin_s}"])
    bench.timed_fault("FTDI", "robot off and on", robot, begin_s, 0.0, rest_at_most_s=1.5)
    robot = plug("silence", faults=[f"silence@{begin_s}+{QUIET_S}"])
    bench.timed_fault("FTDI", "robot says nothing, 8 s", robot, begin_s, QUIET_S, rest_at_most_s=SILENCE_REST_S)


def other_adapter(bench, machine, plugged):
    """The robot's adapter is recognised by its serial number; another adapter of the same model is not used."""
    guest = bench.guest
    guest.run(f"mkdir -p {ADAPTERS} && touch {ADAPTERS}/HEEL0001 && udevadm trigger --subsystem-match=tty")
    machine.unplug_ftdi(plugged)
    stranger = bench.new_robot("stranger")
    machine.plug_ftdi("stranger", stranger.pty, serial="SOMEONE2")
    bench.wait("another adapter is plugged in", lambda: guest.status_of("test -c /dev/ttyUSB0")[0] == 0)
    guest.run("udevadm settle; sleep 5")
    bench.check(guest.status_of("test -e /dev/heel-robot")[0] != 0, "it does not get the robot's name")
    bench.check("client connected" not in stranger.log() or not stranger.is_open(), "and nobody opens what is behind it")
    robot = bench.new_robot("own")
    machine.plug_ftdi("own", robot.pty, serial="HEEL0001")
    bench.wait_until_following(robot)
    bench.check("ttyUSB1" in guest.run("readlink /dev/heel-robot"), "the robot's own adapter beside it is found")
    guest.run(f"rm -r {ADAPTERS}")
    bench.service.stop()
    for name in ("own", "stranger"):
        machine.unplug_ftdi(name)
