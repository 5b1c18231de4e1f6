"""Waiting that always ends."""
import time

LONGEST_S = 60.0


class Timeout(Exception):
    pass


def until(what, condition, timeout_s=LONGEST_S, step_s=0.05):
    """The first true value of condition(); Timeout names `what` otherwise."""
    give_up_s = time.monotonic() + timeout_s
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > give_up_s:
            raise Timeout(f"{what}: not within {timeout_s:g} s")
        time.sleep(step_s)
