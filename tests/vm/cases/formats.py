"""heeld follows with every pixel format that heel reads; a control is set and read back; what the camera cannot do is refused with the reason."""
from cases.appearing import VIVID
from vm.service import START_S

UNCOMPRESSED = ["GREY", "NV12", "YUYV", "RGB3", "BGR3"]  # of vivid
JPEG_DEVICE = "/dev/video41"
FEED_JPEG = ("cjpeg -quality 90 -grayscale /etc/heel/picture.pgm >/tmp/picture.jpg && systemd-run -q --collect --unit=loopback-camera "
             f"/usr/local/lib/heel-vm/loopback_camera.py {JPEG_DEVICE} /tmp/picture.jpg 10")


def run(bench):
    guest = bench.guest
    guest.run(VIVID)
    for name in UNCOMPRESSED:
        follow(bench, "/dev/video0", f"{name} 320x180 at 10 Hz")
    set_and_read_back(bench)
    refused(bench, "camera.exposure_ms = 10: the device has no control of its exposure", more_camera="exposure_ms = 10\n")
    refused(bench, "requested 320x180 MJPG, the device gives 320x180 ", format="MJPG")
    guest.run("modprobe -r vivid && modprobe vivid n_devs=1 node_types=0x100 num_outputs=1 output_types=0")
    refused(bench, "does not capture video")
    guest.run("modprobe -r vivid")

    guest.run(f"modprobe v4l2loopback video_nr={JPEG_DEVICE[-2:]} exclusive_caps=0 && {FEED_JPEG}")
    follow(bench, JPEG_DEVICE, "MJPG 320x180 at 30 Hz (requested: 10 Hz)")  # the loopback's own rate: it takes no other
    guest.run("systemctl stop loopback-camera; modprobe -r v4l2loopback")


def configure(bench, device, **more):
    bench.service.configure(camera=f"v4l2:{device}", robot="serial:/dev/ttyS1@38400", **more)


def follow(bench, device, agreement):
    service, robot = bench.service, bench.robots["16550"]
    configure(bench, device, format=agreement.split()[0])
    begin_s = bench.in_guest("true")
    service.start()
    service.wait_until_ready()
    opened = service.events("camera opened", begin_s)
    bench.check(any(line.endswith(f", {agreement}") for line in opened), f"agreed on: {agreement}")
    bench.wait_until_following(robot)
    service.stop()


def set_and_read_back(bench):
    service = bench.service
    configure(bench, "/dev/video0", more_camera="gain = 60\n")
    begin_s = bench.in_guest("true")
    service.start()
    service.wait_until_ready()
    opened = service.events("camera opened", begin_s)
    bench.check(any("gain 60" in line for line in opened), f"a gain of 60 is set: {opened}")
    told = bench.guest.run("v4l2-ctl -d /dev/video0 -C gain,gain_automatic")
    bench.check("gain: 60" in told and "gain_automatic: 0" in told, "and the driver has it")
    service.stop()
    bench.guest.run("v4l2-ctl -d /dev/video0 -c gain_automatic=1")


def refused(bench, reason, **more):
    configure(bench, "/dev/video0", **more)
    begin_s = bench.in_guest("true")
    bench.service.start()
    bench.wait(f"refused: {reason.strip()}", lambda: reason in bench.service.journal_since(begin_s), START_S)
    bench.check(bench.service.state() != "active", "and the service is not ready")
    bench.service.stop()
    bench.guest.status_of("systemctl reset-failed heeld")
