"""The host's side of the guest's shell (guest/agent.py)."""
import json
import socket
import threading

from . import wait


class CommandFailed(Exception):
    pass


class Agent:
    def __init__(self, path):
        self._socket = socket.socket(socket.AF_UNIX)
        wait.until(f"{path}: QEMU's socket", self._connected(path), 10)
        self._answers = {}
        self._news = threading.Condition()
        self._next_id = 1
        threading.Thread(target=self._listen, daemon=True).start()

    def _connected(self, path):
        return lambda: self._socket.connect_ex(path) == 0

    def _listen(self):
        for line in self._socket.makefile("rb"):
            answer = json.loads(line)
            with self._news:
                self._answers[answer["id"]] = answer
                self._news.notify_all()

    def wait_until_up(self, timeout_s):
        self._take(0, "the guest's agent", timeout_s)

    def run(self, command, timeout_s=wait.LONGEST_S, check=True):
        """Returns the command's output (both streams). With check, raises CommandFailed when the command fails."""
        status, output = self.status_of(command, timeout_s)
        if check and status != 0:
            how = "does not end" if status is None else f"ends with status {status}"
            raise CommandFailed(f"in the guest, '{command}' {how}:\n{output}")
        return output

    def status_of(self, command, timeout_s=wait.LONGEST_S):
        with self._news:
            number, self._next_id = self._next_id, self._next_id + 1
        request = {"id": number, "command": command, "timeout_s": timeout_s}
        self._socket.sendall((json.dumps(request) + "\n").encode())
        answer = self._take(number, f"in the guest, '{command}'", timeout_s + 20)
        return answer["status"], answer["output"].rstrip("\n")

    def _take(self, number, what, timeout_s):
        with self._news:
            if not self._news.wait_for(lambda: number in self._answers, timeout_s):
                raise wait.Timeout(f"{what}: no answer within {timeout_s:g} s")
            return self._answers.pop(number)
