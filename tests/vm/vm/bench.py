"""What a case uses: the machine, the robots, heeld's service; checks; measured faults."""
import time

from . import wait
from .service import FRAME_TIMEOUT_S, Service

SPEED_M_S = 0.6
DECELERATION_M_S2 = 1.5
# The emulator may add this to heeld's times: it shares both processors with the simulator and other programs.
EMULATOR_S = 1.5
STOPPING_S = SPEED_M_S / DECELERATION_M_S2
CAMERA_REST_S = FRAME_TIMEOUT_S + STOPPING_S + EMULATOR_S
SILENCE_REST_S = 0.5 + STOPPING_S + EMULATOR_S  # sip_timeout_s
WATCHDOG_REST_S = 2.0 + STOPPING_S + 0.3        # after the last byte that the robot received: no part of it is emulated
RECOVERY_S = 60.0
AFTERWARDS_S = 1.0  # recorded after the recovery


class CheckFailed(Exception):
    pass


class Bench:
    def __init__(self, machine, robots, new_robot, package, say):
        self.machine = machine
        self.guest = machine.agent
        self.service = Service(machine)
        self.robots = robots        # by the guest's device to which they are connected: "16550", "FTDI"
        self.new_robot = new_robot  # (name, faults) → another simulated robot
        self.package = package      # the .deb's path in the guest
        self.say = say
        self.rows = []              # of the table

    def reset(self):
        """After a failed case: nothing runs, nothing is plugged in."""
        self.guest.status_of("systemctl stop heeld usb-camera loopback-camera; systemctl reset-failed; rm -rf /etc/heel/adapters")
        self.machine.unplug_all()
        self.guest.status_of("modprobe -r vivid; modprobe -r v4l2loopback; modprobe -r vimc")

    def check(self, holds, what):
        if not holds:
            raise CheckFailed(what)
        self.say(f"    ok: {what}")

    def wait(self, what, condition, timeout_s=wait.LONGEST_S, step_s=0.2):
        """A check that waits until the condition holds."""
        begin_s = time.monotonic()
        wait.until(what, condition, timeout_s, step_s)
        self.say(f"    ok: {what} ({time.monotonic() - begin_s:.1f} s)")

    def wait_until_following(self, robot, speed_m_s=SPEED_M_S):
        begin_s = time.monotonic()
        self.wait(f"{robot.name} moves", lambda: robot.moved_since(begin_s), RECOVERY_S)
        self.wait(f"{robot.name} is at speed", lambda: robot.speed_m_s() > 0.5 * speed_m_s, RECOVERY_S)

    def in_guest(self, command):
        """Runs the command and returns the guest's CLOCK_MONOTONIC just before it, in seconds."""
        return float(self.guest.run(f"cut -d' ' -f1 /proc/uptime; {command}").split("\n")[0])

    def fault(self, device, name, robot, cause, cure, rest_within_s=None):
        """A fault that must bring the moving robot to rest; after its end the robot must move again. Returns the table's row.
        cause and cure are commands for the guest or functions. Times are taken before them and by the simulator's truth, so they are upper bounds.
        Without rest_within_s the robot's watchdog must stop it."""
        self.say(f"  {device}: {name}")
        self.wait_until_following(robot)
        caused_s, begin_s = time.monotonic(), self._do(cause)
        effective_s = time.monotonic()  # by now at the latest: a command takes the emulator up to two seconds
        rested_s = wait.until(f"{robot.name} at rest", lambda: robot.rested_since(caused_s), 30)
        if rest_within_s is None:
            alone_s = rested_s - robot.last_heard(rested_s)
            self.check(alone_s <= WATCHDOG_REST_S, f"at rest {alone_s:.2f} s after the last byte (at most {WATCHDOG_REST_S:.2f} s)")
        else:
            late_s = rested_s - effective_s
            self.check(late_s <= rest_within_s, f"at rest {late_s:.2f} s after it had happened (at most {rest_within_s:.2f} s)")
        time.sleep(1.0)
        self.check(abs(robot.speed_m_s()) < 0.01, "and stays at rest")
        cured_s = time.monotonic()
        self._do(cure)
        moved_s = wait.until(f"{robot.name} moves again", lambda: robot.moved_since(cured_s), RECOVERY_S)
        return self._record(device, name, begin_s, rested_s - caused_s, moved_s - cured_s)

    def blip(self, device, name, robot, cause, cure=None, rest_at_most_s=None, lasts_s=4.0):
        """A fault from which heeld recovers alone; the robot may stop or continue. Returns the table's row."""
        self.say(f"  {device}: {name}")
        self.wait_until_following(robot)
        caused_s, begin_s = time.monotonic(), self._do(cause)
        time.sleep(lasts_s)
        if cure is not None:
            self._do(cure)
        rested_s = robot.rested_since(caused_s)
        moved_s = None
        if rested_s is not None:
            moved_s = wait.until(f"{robot.name} moves again", lambda: robot.moved_since(rested_s), RECOVERY_S)
        self.check(rest_at_most_s is None or rested_s is None or rested_s - caused_s <= rest_at_most_s,
                   "continues" if rested_s is None else f"at rest after {rested_s - caused_s:.2f} s and moves again")
        return self._record(device, name, begin_s, rested_s and rested_s - caused_s, moved_s and moved_s - rested_s)

    def timed_fault(self, device, name, robot, begin_s, lasts_s, rest_at_most_s=None):
        """A fault given to the simulated robot at its start: it begins begin_s seconds later and lasts lasts_s. Returns the row."""
        self.say(f"  {device}: {name}")
        self.wait_until_following(robot)
        caused_s = robot.at(begin_s)
        self.check(time.monotonic() < caused_s, "it follows before the fault")
        cured_s = caused_s + lasts_s
        time.sleep(caused_s - time.monotonic())
        guest_s = self.in_guest("true")
        time.sleep(max(0.0, cured_s + 3.0 - time.monotonic()))
        rested_s = robot.rested_since(caused_s)
        moved_s = wait.until(f"{robot.name} moves again", lambda: robot.moved_since(max(cured_s, rested_s or 0.0)), RECOVERY_S)
        if rest_at_most_s is not None:
            self.check(rested_s is not None and rested_s - caused_s <= rest_at_most_s,
                       f"at rest after {(rested_s or moved_s) - caused_s:.2f} s (at most {rest_at_most_s:.2f} s)")
        return self._record(device, name, guest_s, rested_s and rested_s - caused_s, rested_s and moved_s - max(cured_s, rested_s))

    def _do(self, what):
        if isinstance(what, str):
            return self.in_guest(what)
        now_s = self.in_guest("true")
        what()
        return now_s

    def _record(self, device, name, begin_s, rest_s, recovery_s):
        end_s = self.in_guest("true") + AFTERWARDS_S
        wait.until("the recording contains the fault", lambda: self.service.recorded_until() > end_s, step_s=0.5)
        row = {"device": device, "fault": name, "rest_s": rest_s, "recovery_s": recovery_s,
               **self.service.losses(begin_s, end_s)}
        row["events"] = self.service.events("^(?!deadline)", begin_s)  # they say why
        self.rows.append(row)
        recovery = "continued" if recovery_s is None else f"moves again after {recovery_s:.2f} s"
        self.say(f"    ok: {recovery}; {row['without_picture_s']} s without a picture, {row['without_robot_s']} s without "
                 f"the robot; {row['frames_captured']} frames, {row['frames_dropped_by_driver']} more lost by the driver, camera "
                 f"opened again {row['camera_reopened']} times, {row['bytes_discarded']} bytes discarded")
        return row
