"""The .deb installs on a fresh machine: the service is disabled and stopped, account and device rules exist; a template is taught there."""
import os

PICTURE_SIZE = (320, 180)
CAMERA_INFO = """\
image_width: 320
image_height: 180
camera_name: test
camera_matrix: {rows: 3, cols: 3, data: [277.5, 0, 159.5, 0, 277.5, 89.5, 0, 0, 1]}
distortion_model: plumb_bob
distortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}
"""
# vivid writes its controls over its test picture: that text is the print of the shirt.
ROI = "60,10,200,160"


def run(bench):
    guest = bench.guest
    guest.run(f"dpkg -i {bench.package}", 120)
    bench.check(guest.status_of("systemctl is-enabled heeld")[1] == "disabled", "the service is disabled")
    bench.check(bench.service.state() == "inactive", "the service is stopped")
    groups = guest.run("id -nG heel").split()
    bench.check({"dialout", "video"} <= set(groups), "the account heel is in dialout and video")
    bench.check(guest.status_of("ls /etc/heel/heel.toml")[0] == 0, "/etc/heel/heel.toml is there")
    bench.check(guest.run("stat -c '%G %a' /etc/heel").strip() == "heel 2775", "heel save can write in /etc/heel")
    guest.run("systemd-analyze verify heeld.service", 60)
    bench.check(True, "systemd-analyze finds nothing wrong with the unit")

    guest.run("modprobe vivid n_devs=1 node_types=0x1 num_inputs=1 input_types=0")
    bench.wait("vivid's camera is there", lambda: guest.status_of("test -c /dev/video0")[0] == 0)
    bench.service.install("picture.pgm", grab(bench, "/dev/video0"))
    bench.service.install("camera.yaml", CAMERA_INFO.encode())
    verdict = guest.run(f"heel teach --image /etc/heel/picture.pgm --roi {ROI} --distance 2 --max 150 "
                        "--camera-info /etc/heel/camera.yaml -o /etc/heel/shirt.heel")
    bench.check("wrote" in verdict, "heel teach makes a template of the camera's picture")
    guest.run("modprobe -r vivid")


def grab(bench, device):
    """Returns a picture of the camera as a PGM."""
    width_px, height_px = PICTURE_SIZE
    bench.guest.run(f"v4l2-ctl -d {device} --set-fmt-video=width={width_px},height={height_px},pixelformat=GREY "
                    "--set-parm=10 --stream-mmap --stream-skip=3 --stream-count=1 --stream-to=/mnt/share/picture.grey")
    with open(os.path.join(bench.machine.share, "picture.grey"), "rb") as file:
        grey = file.read()
    bench.check(len(grey) == width_px * height_px, f"the camera gives a picture of {width_px}×{height_px}")
    return f"P5\n{width_px} {height_px}\n255\n".encode() + grey
