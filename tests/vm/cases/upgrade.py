"""A newer package is installed while the robot moves: the robot stops, and the user's changes of the configuration are kept although its default changed."""
import os
import subprocess

from cases.appearing import standing

CHANGED = "# a line written by the user"
NEW_DEFAULT = "# a line of the newer package"


def run(bench):
    standing(bench)
    guest, robot = bench.guest, bench.robots["FTDI"]
    guest.run(f"echo '{CHANGED}' >>/etc/heel/heel.toml")
    before = guest.run("cat /etc/heel/heel.toml")
    bench.wait_until_following(robot)
    guest.run(f"dpkg --force-confold -i /mnt/share/{newer_package(bench)}", 120)
    bench.wait("the robot is at rest and closed", lambda: not robot.is_open() and abs(robot.speed_m_s()) < 0.001, 10)
    bench.check(guest.run("dpkg-query -W -f '${Version}' heel").endswith("+newer"), "the newer package is installed")
    bench.check(bench.service.state() == "inactive", "the service waits for a person to start it")
    bench.check(guest.run("cat /etc/heel/heel.toml") == before, "the configuration is as it was")
    bench.check(NEW_DEFAULT in guest.run("cat /etc/heel/heel.toml.dpkg-dist"), "the newer default is beside it")
    bench.service.start()
    bench.service.wait_until_ready()
    bench.wait_until_following(robot)
    bench.service.stop()
    bench.machine.unplug_ftdi("ftdi")
    guest.run("modprobe -r vivid")


def newer_package(bench):
    """Makes the package with a higher version and another default configuration; returns its name in the shared folder."""
    folder, name = os.path.join(bench.machine.folder, "newer"), "newer.deb"

    def edit(path, text):
        with open(os.path.join(folder, path)) as file:
            before = file.read()
        with open(os.path.join(folder, path), "w") as file:
            file.write(text(before))

    old = os.path.join(bench.machine.share, os.path.basename(bench.package))
    subprocess.run(["dpkg-deb", "-R", old, folder], check=True)
    version = subprocess.run(["dpkg-deb", "-f", old, "Version"], check=True, capture_output=True, text=True).stdout.strip()
    edit("DEBIAN/control", lambda text: text.replace(f"Version: {version}", f"Version: {version}+newer"))
    edit("etc/heel/heel.toml", lambda text: f"{NEW_DEFAULT}\n{text}")
    subprocess.run(["dpkg-deb", "--root-owner-group", "-b", folder, os.path.join(bench.machine.share, name)], check=True,
                   capture_output=True)
    return name
