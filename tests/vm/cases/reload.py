"""SIGHUP: systemd receives RELOADING with the time, and READY again; a bad file changes nothing."""
from cases.appearing import standing


def run(bench):
    standing(bench)
    guest, service = bench.guest, bench.service
    guest.run("systemd-analyze log-level debug")
    service.configure(camera="v4l2:/dev/video0", robot="serial:/dev/heel-robot@38400", more="[gate]\nv_max_m_s = 0.5\n")
    guest.run("systemctl reload heeld")
    bench.wait("it has reloaded", lambda: "reloaded /etc/heel/heel.toml" in service.journal())
    told = guest.run("journalctl _PID=1 -o cat --no-pager -n 400 | grep 'Got notification message' | tail -n 40", check=False)
    bench.check("RELOADING=1" in told and "MONOTONIC_USEC=" in told, "systemd was told RELOADING=1 with MONOTONIC_USEC")
    bench.wait("systemd was told READY=1 after it", lambda: service.state() == "active")
    bench.wait("the robot keeps the new limit", lambda: abs(bench.robots["FTDI"].speed_m_s() - 0.5) < 0.01)

    service.configure(camera="v4l2:/dev/video0", robot="serial:/dev/heel-robot@38400", more="[gate]\nv_maximum = 0.5\n")
    guest.run("systemctl reload heeld")
    bench.wait("a file with an unknown key is refused", lambda: "reload refused" in service.journal())
    bench.check("did you mean gate.v_max_m_s?" in service.journal(), "and the nearest key is named")
    guest.run("systemd-analyze log-level info")
    bench.check(service.state() == "active", "and it runs on")
    service.configure(camera="v4l2:/dev/video0", robot="serial:/dev/heel-robot@38400")
    guest.run("systemctl reload heeld")
