"""The FTDI adapter is unplugged while the robot moves: the robot's watchdog stops it; plugged in again, the adapter is found by its name."""
from cases.appearing import standing


def run(bench):
    standing(bench)
    robot, machine = bench.robots["FTDI"], bench.machine
    bench.fault("FTDI", "unplugged, plugged in", robot, cause=lambda: machine.unplug_ftdi("ftdi"),
                cure=lambda: machine.plug_ftdi("ftdi", robot.pty))
    bench.check("ttyUSB" in bench.guest.run("readlink /dev/heel-robot"), "/dev/heel-robot names the adapter again")
