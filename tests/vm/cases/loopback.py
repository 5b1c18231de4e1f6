"""A v4l2loopback device: the program that writes its frames ends while the robot moves, and is started again."""
from vm.bench import CAMERA_REST_S

DEVICE = "/dev/video40"
FEED = f"systemd-run -q --collect --unit=loopback-camera /usr/local/lib/heel-vm/loopback_camera.py {DEVICE} /etc/heel/picture.pgm 10"
END = "systemctl stop loopback-camera"


def run(bench):
    guest, service, robot = bench.guest, bench.service, bench.robots["16550"]
    guest.run("modprobe v4l2loopback video_nr=40 exclusive_caps=0")
    guest.run(FEED)
    service.configure(camera=f"v4l2:{DEVICE}", robot="serial:/dev/ttyS1@38400")
    service.start()
    service.wait_until_ready()
    bench.fault("v4l2loopback", "its feeder ends, is started again", robot, cause=END, cure=FEED, rest_within_s=CAMERA_REST_S)
    service.stop()
    guest.run(f"{END}; modprobe -r v4l2loopback")
