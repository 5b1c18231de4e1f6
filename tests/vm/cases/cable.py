"""The FTDI adapter falls out while the robot moves: its watchdog stops it; plugged in again, it is found by its name."""
from vm.bench import WATCHDOG_REST_S


def run(bench):
    robot, machine = bench.robots["FTDI"], bench.machine
    bench.fault("FTDI", "unplugged, plugged in", robot, cause=lambda: machine.unplug_ftdi("ftdi"),
                cure=lambda: machine.plug_ftdi("ftdi", robot.pty), rest_within_s=WATCHDOG_REST_S)
    bench.check("ttyUSB" in bench.guest.run("readlink /dev/heel-robot"), "/dev/heel-robot names the adapter again")
