"""Waiting with a time-out."""
import time

LONGEST_S = 60.0


class Timeout(Exception):
    pass


def until(what, condition, timeout_s=LONGEST_S, step_s=0.05):
    """Returns the first true value of condition(); otherwise raises Timeout, which names `what`."""
    give_up_s = time.monotonic() + timeout_s
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > give_up_s:
            raise Timeout(f"{what}: not within {timeout_s:g} s")
        time.sleep(step_s)
