"""The camera's driver is unbound while the robot moves, and bound again; then the service is stopped."""
from cases.appearing import standing
from vm.bench import CAMERA_REST_S

DRIVER = "/sys/bus/platform/drivers/vivid"


def run(bench):
    standing(bench)
    robot = bench.robots["FTDI"]
    bench.fault("vivid", "unbound, bound", robot, cause=f"echo vivid.0 >{DRIVER}/unbind", cure=f"echo vivid.0 >{DRIVER}/bind",
                rest_within_s=CAMERA_REST_S)
    bench.wait_until_following(robot)
    bench.service.stop()
    bench.check(bench.service.state() == "inactive", "the service stops")
    bench.wait("the robot is at rest and closed", lambda: not robot.is_open() and abs(robot.speed_m_s()) < 0.001, 10)
    bench.machine.unplug_ftdi("ftdi")
    bench.guest.run("modprobe -r vivid")
