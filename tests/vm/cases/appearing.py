"""heeld starts without camera and robot, and is ready only when both are connected."""
from vm.service import START_S

VIVID = "modprobe vivid n_devs=1 node_types=0x1 num_inputs=1 input_types=0"


def run(bench):
    service, robot = bench.service, bench.robots["FTDI"]
    service.configure(camera="v4l2:/dev/video0", robot="serial:/dev/heel-robot@38400")
    service.start()
    bench.wait("heeld waits for robot and camera",
               lambda: "the robot" in service.status_text() and "camera" in service.status_text(), START_S)
    bench.check(service.state() == "activating", "and is not ready")

    bench.guest.run(VIVID)
    bench.wait("with the camera there it waits for the robot only",
               lambda: "the robot" in service.status_text() and "camera" not in service.status_text())
    bench.check(service.state() == "activating", "and is still not ready")

    bench.machine.plug_ftdi("ftdi", robot.pty)
    bench.wait("with the robot plugged in it is ready", lambda: service.state() == "active")
    bench.check(robot.is_open(), "the robot has been opened by then")
    bench.check(bench.guest.run("readlink /dev/heel-robot").startswith("ttyUSB"), "the adapter is /dev/heel-robot")
    latency = bench.guest.run("cat /sys/bus/usb-serial/devices/ttyUSB*/latency_timer")
    bench.check(latency == "1", "its latency timer is 1 ms")
    bench.wait_until_following(robot)
    check_priorities(bench)


def standing(bench):
    """The state after this case, set up where needed: heeld follows vivid's picture, the robot is behind the adapter."""
    if bench.service.state() == "active":
        return
    bench.guest.run(VIVID)
    bench.machine.plug_ftdi("ftdi", bench.robots["FTDI"].pty)
    bench.service.configure(camera="v4l2:/dev/video0", robot="serial:/dev/heel-robot@38400")
    bench.service.start()
    bench.service.wait_until_ready()


def check_priorities(bench):
    threads = bench.guest.run("for task in /proc/$(systemctl show --value -p MainPID heeld)/task/*; do "
                              "echo $(cat $task/comm) $(chrt -p ${task##*/} | cut -d: -f2); done").split("\n")
    for name, priority in (("heel-control", 60), ("heel-capture", 50), ("heel-vision", 40)):
        bench.check(any(line.startswith(f"{name} SCHED_FIFO") and line.endswith(f" {priority}") for line in threads),
                    f"{name} runs under SCHED_FIFO {priority}")
