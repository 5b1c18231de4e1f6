"""systemd-analyze security gives the service at most 2.0."""


def run(bench):
    verdict = bench.guest.run("systemd-analyze security --no-pager heeld | tail -n 1")
    score = float(verdict.split(":")[1].split()[0])
    bench.check(score <= 2.0, f"exposure {score} (at most 2.0)")
