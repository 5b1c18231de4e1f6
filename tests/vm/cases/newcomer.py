"""All steps of a new user: install, plug camera and robot in, calibrate, teach, check, start, watch, tune a gain, stop, remove."""
import os
import re

from cases.install import ROI
from cases.usb_camera import ATTACH, DETACH
from vm import chessboard

FOCAL_PX = 277.5


def run(bench):
    guest, service, machine = bench.guest, bench.service, bench.machine
    guest.run("dpkg -P heel", 60)
    guest.run(f"dpkg -i {bench.package}", 120)
    guest.run("cp /mnt/share/picture.pgm /etc/heel/")  # a photograph of the shirt

    robot = bench.new_robot("newcomer")
    machine.plug_ftdi("newcomer", robot.pty)
    guest.run("modprobe -a vhci_hcd uvcvideo")
    guest.run(ATTACH)
    bench.wait("camera and robot have their names", lambda: guest.status_of("test -c /dev/heel-camera -a -c /dev/heel-robot")[0] == 0)

    calibrate(bench)
    told = guest.run(f"heel teach --image /etc/heel/picture.pgm --roi {ROI} --distance 2 --max 150 "
                     "--camera-info /etc/heel/camera.yaml -o /etc/heel/shirt.heel")
    bench.check("wrote" in told, "the shirt is taught")
    told = guest.run("heel pose --template /etc/heel/shirt.heel --camera-info /etc/heel/camera.yaml /etc/heel/picture.pgm")
    bench.check("found in 1 of 1" in told, "and found in the picture")
    # Changes only what differs here from the package's configuration file.
    guest.run("sed -i -e 's/^width_px = .*/width_px = 320/' -e 's/^height_px = .*/height_px = 180/' -e 's/^rate_hz = 30.*/rate_hz = 10.0/' "
              "-e 's/^octaves = .*/octaves = 1/' -e 's/^start = .*/start = \"at_once\"/' -e 's/^max_features = .*/max_features = 150/' "
              "-e 's/^frame_timeout_s = .*/frame_timeout_s = 1.5/' -e 's/^target_timeout_s = .*/target_timeout_s = 1.5/' "
              "-e 's/^setpoint_t_z_m = .*/setpoint_t_z_m = -0.6/' /etc/heel/heel.toml")
    bench.check(": valid" in guest.run("heeld --config /etc/heel/heel.toml --check"), "heeld --check finds the configuration valid")

    guest.run("systemctl enable heeld && systemctl start --no-block heeld")
    service.wait_until_ready()
    bench.wait_until_following(robot)
    bench.check("following" in guest.run("systemctl status heeld"), "systemctl status says that it follows")
    guest.run("sed -i 's/^v_max_m_s = .*/v_max_m_s = 0.3/' /etc/heel/heel.toml && systemctl reload heeld")
    bench.wait("a limit tuned while driving is kept", lambda: abs(robot.speed_m_s() - 0.3) < 0.02)
    guest.run("systemctl disable --now heeld")
    bench.wait("stopped, the robot is at rest and closed", lambda: not robot.is_open() and abs(robot.speed_m_s()) < 0.001, 10)
    machine.unplug_ftdi("newcomer")
    guest.run(DETACH)


def calibrate(bench):
    folder = os.path.join(bench.machine.share, "board")
    os.makedirs(folder, exist_ok=True)
    for i, pose in enumerate(chessboard.poses()):
        with open(os.path.join(folder, f"{i}.pgm"), "wb") as file:
            file.write(chessboard.picture(320, 180, FOCAL_PX, pose))
    bench.guest.run(f"heel calibrate /mnt/share/board/*.pgm --board {chessboard.COLUMNS}x{chessboard.ROWS} "
                    f"--square {chessboard.SQUARE_M} -o /etc/heel/camera.yaml", 120)
    numbers = re.search(r"camera_matrix:.*?data: \[([^\]]*)\]", bench.guest.run("cat /etc/heel/camera.yaml"), re.S).group(1)
    focal_px = float(numbers.split(",")[0])
    bench.check(abs(focal_px / FOCAL_PX - 1.0) < 0.02, f"calibrated: focal length {focal_px:.1f} px (it is {FOCAL_PX})")
