"""The kernel's uvcvideo driver and a 16550: the robot follows; the USB camera stalls, is unplugged and plugged in again."""
from vm.bench import CAMERA_REST_S

ATTACH = "systemd-run -q --collect --unit=usb-camera /usr/local/lib/heel-vm/usb_camera.py /etc/heel/picture.pgm 10"
DETACH = "systemctl stop usb-camera"
SIGNAL = "systemctl kill --signal={} usb-camera"


def run(bench):
    guest, service, robot = bench.guest, bench.service, bench.robots["16550"]
    guest.run("modprobe -a vhci_hcd uvcvideo")
    guest.run(ATTACH)
    bench.wait("the camera is /dev/heel-camera", lambda: guest.status_of("test -c /dev/heel-camera")[0] == 0)
    service.configure(camera="v4l2:/dev/heel-camera", robot="serial:/dev/ttyS1@38400")
    service.start()
    service.wait_until_ready()
    bench.fault("uvcvideo", "stalled, goes on", robot, cause=SIGNAL.format("STOP"), cure=SIGNAL.format("CONT"),
                rest_within_s=CAMERA_REST_S)
    bench.fault("uvcvideo", "unplugged, plugged in", robot, cause=DETACH, cure=ATTACH, rest_within_s=CAMERA_REST_S)
    bench.check(guest.run("readlink /dev/heel-camera").startswith("video"), "/dev/heel-camera names the camera again")
    service.stop()
    bench.wait("the robot is at rest and closed", lambda: not robot.is_open() and abs(robot.speed_m_s()) < 0.001, 10)
    guest.run(DETACH)
