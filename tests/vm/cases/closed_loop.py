"""A closed loop through the kernel: heel-sim renders its robot's camera, v4l2loopback is the camera, a 16550 is the serial line."""
import csv
import io
import json
import math
import os
import subprocess

DEVICE = "/dev/video42"
SIZE = {"width_px": 320, "height_px": 240}
SCENARIO = os.path.join(os.path.dirname(__file__), "..", "vm", "slow_walk.toml")
TEACH_M = "1.5"
PATH_M = 4.98  # of the person, in 50 s; then they stand
WALK_S = 120.0
# The person walks slowly, because vision takes half a second or more in the emulator: frames count as fresh for 3 s.
FRESH_S = 3.0


def run(bench):
    guest, service, share = bench.guest, bench.service, bench.machine.share
    told = sim(bench, "--still", os.path.join(share, "view.pgm"), "--distance", TEACH_M, "--camera-info-out", os.path.join(share, "slow.yaml"))
    roi = told.split("roi=")[1].split()[0]
    guest.run("cp /mnt/share/slow.yaml /etc/heel/slow.yaml")
    guest.run(f"heel teach --image /mnt/share/view.pgm --roi {roi} --distance {TEACH_M} --camera-info /etc/heel/slow.yaml -o /etc/heel/slow.heel")

    robot = bench.new_robot("walker", world=["--scenario", SCENARIO, "--camera", f"file:{os.path.join(share, 'now.pgm')}"])
    bench.machine.plug_ftdi("walker", robot.pty)
    guest.run(f"modprobe v4l2loopback video_nr={DEVICE[-2:]} exclusive_caps=0")
    guest.run(f"systemd-run -q --collect --unit=loopback-camera /usr/local/lib/heel-vm/loopback_camera.py {DEVICE} /mnt/share/now.pgm 10")
    service.configure(camera=f"v4l2:{DEVICE}", robot="serial:/dev/heel-robot@38400", info="slow.yaml", shirt="slow.heel", octaves=2,
                      max_features=400, setpoint_t_z_m=0.3, bearing_max_rad=0.2, frame_timeout_s=FRESH_S, **SIZE)
    service.start()
    service.wait_until_ready()
    bench.wait_until_following(robot, speed_m_s=0.1)
    bench.wait("the person has walked", lambda: person_path_m(robot) > PATH_M - 0.05 and abs(robot.speed_m_s()) < 0.01, WALK_S, step_s=1.0)
    check(bench, robot)
    service.stop()
    bench.machine.unplug_ftdi("walker")
    guest.run("systemctl stop loopback-camera; modprobe -r v4l2loopback")


def sim(bench, *options):
    return subprocess.run([bench.robots["16550"].heel_sim, "--scenario", SCENARIO, *options], check=True, capture_output=True, text=True).stdout


def person_path_m(robot):
    places = [(float(row["person_x_m"]), float(row["person_y_m"])) for row in csv.DictReader(io.StringIO(robot.truth()))]
    return sum(math.dist(a, b) for a, b in zip(places[::50], places[50::50]))


def check(bench, robot):
    """Checks the run by the simulator's truth with `heel report`; the figures stay in the run's folder."""
    folder = os.path.join(bench.machine.folder, "closed_loop")
    os.makedirs(folder, exist_ok=True)
    bench.service.copy_recording(os.path.join(folder, "run.mcap"))
    with open(os.path.join(folder, "truth.csv"), "w") as file:
        file.write(robot.truth())
    heel = os.path.join(os.path.dirname(robot.heel_sim), "heel")
    # It also reports that no frame was seen during the walk, because the guest has another clock.
    report = subprocess.run([heel, "report", folder, "--json"], check=False, capture_output=True, text=True).stdout
    told = json.loads(report)
    driven_m, rms_m, least_m = told["robot_path_m"], told["following_rms_m"], told["separation_m"]["min"]
    bench.check(driven_m > 0.8 * PATH_M, f"the robot has followed for {driven_m:.2f} m")
    bench.check(rms_m < 0.15, f"{rms_m:.3f} m RMS beside the person's path")
    bench.check(least_m > 1.0, f"and never nearer than {least_m:.2f} m")
    bench.check(abs(robot.speed_m_s()) < 0.01, "and stands when they stand")
