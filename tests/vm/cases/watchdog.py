"""systemd's watchdog is fed only while the control loop runs: its thread alone is held, and the service is killed and restarted."""
from cases.appearing import VIVID

RESTARTS = "systemctl show --value -p NRestarts heeld"
HOLD = "/usr/local/lib/heel-vm/hold_thread.py $(systemctl show --value -p MainPID heeld) heel-control 20"


def run(bench):
    service, robot = bench.service, bench.robots["16550"]
    bench.guest.run(VIVID)
    service.configure(camera="v4l2:/dev/video0", robot="serial:/dev/ttyS1@38400")
    service.start()
    service.wait_until_ready()
    before = int(bench.guest.run(RESTARTS))
    bench.fault("heeld", "control thread held, killed, restarted", robot,
                cause=f"systemd-run -q --collect --unit=hold-thread /bin/sh -c '{HOLD}'",
                cure=lambda: bench.wait("systemd has restarted it", lambda: int(bench.guest.run(RESTARTS)) == before + 1))
    told = bench.guest.status_of("journalctl -u heeld -o cat --no-pager | grep 'Watchdog timeout'")[1]
    bench.check(told.startswith("heeld.service: Watchdog timeout"), f"systemd says: {told}")
    bench.guest.run("systemctl kill --signal=KILL heeld")
    bench.wait("killed outright, it is restarted too", lambda: int(bench.guest.run(RESTARTS)) == before + 2)
    service.wait_until_ready()
    bench.wait_until_following(robot)
    service.stop()
    bench.check(service.state() == "inactive", "and it stops when asked")
    bench.guest.run("modprobe -r vivid")
