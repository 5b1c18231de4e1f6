"""Removing the package keeps the configuration, purging it leaves nothing."""


def run(bench):
    guest = bench.guest
    guest.run("dpkg -r heel", 60)
    bench.check(guest.status_of("test -e /etc/heel/heel.toml")[0] == 0, "a removal keeps the configuration")
    bench.check(guest.status_of("test -e /usr/bin/heeld")[0] != 0, "and takes the program")
    guest.run("dpkg -P heel", 60)
    left = guest.run("ls -d /etc/heel /var/lib/heel /lib/systemd/system/heeld.service /lib/udev/rules.d/60-heel.rules", check=False)
    bench.check(all("No such file" in line or "cannot access" in line for line in left.split("\n")), "a purge leaves nothing")
