"""Runs one check over many units, as many at a time as there are processors, and prints each finding once."""
import concurrent.futures
import os
import re
import subprocess
import sys
import time

from checking.units import ROOT, newest_first

UNIT_TIMEOUT_S = 600
FINDING = re.compile(r"^(\S+:\d+:\d+: )(fatal )?(error|warning): ")


def add_option(parser):
    parser.add_argument("--at-most", type=int, metavar="N",
                        help="of those that have not passed as they are, only the N that changed last")


def findings_of(command, folder):
    """(findings as blocks of text, what went wrong or None)"""
    english = {**os.environ, "LC_ALL": "C"}
    try:
        done = subprocess.run(command, cwd=folder, env=english, capture_output=True, text=True, timeout=UNIT_TIMEOUT_S, check=False)
    except subprocess.TimeoutExpired:
        return [], f"not done after {UNIT_TIMEOUT_S} s"
    findings = []
    for line in (done.stdout or done.stderr).splitlines():  # clang-tidy's findings, or the compiler's
        if FINDING.match(line):
            findings.append(line)
        elif findings:
            findings[-1] += "\n" + line
    return findings, None if done.returncode == 0 or findings else done.stdout + done.stderr


def check_units(name, units, check, passed=None, at_most=None):
    """`check`: unit → findings_of(…). Without `passed`, every unit is checked, and none remembered. The exit status."""
    waiting = [unit for unit in units if passed is None or not passed.has(unit)]
    chosen = waiting if at_most is None else newest_first(waiting)[:at_most]
    # The largest first: no processor is left waiting for one that was begun last.
    chosen.sort(key=lambda unit: -unit.source.stat().st_size)

    def check_one(unit):
        t_begin_s = time.time()
        findings, failure = check(unit)
        if passed is not None and not findings and not failure:
            passed.keep(unit, t_begin_s)
        return unit, findings, failure

    seen, failures = set(), 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for unit, findings, failure in pool.map(check_one, chosen):
            for finding in findings:
                if finding not in seen:
                    seen.add(finding)
                    print(finding.replace(f"{ROOT}/", ""), flush=True)
            if failure:
                failures += 1
                print(f"{unit.source}: {name} failed: {failure}", flush=True)
    left = len(waiting) - len(chosen)
    print(f"{name}: {len(units)} units, {len(units) - len(waiting)} have passed before, {len(chosen)} checked now: "
          f"{len(seen)} findings" + (f"; {left} left, changed longer ago" if left else ""), file=sys.stderr)
    return 1 if seen or failures else 0
