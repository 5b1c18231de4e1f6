"""QEMU's machine protocol: plugs and unplugs devices of the running machine."""
import json
import socket

from .wait import LONGEST_S


class Qmp:
    def __init__(self, path):
        self._socket = socket.socket(socket.AF_UNIX)
        self._socket.settimeout(LONGEST_S)
        self._socket.connect(path)
        self._lines = self._socket.makefile("rw")
        self._lines.readline()  # the greeting
        self.execute("qmp_capabilities")

    def execute(self, command, **arguments):
        self._lines.write(json.dumps({"execute": command, "arguments": arguments}) + "\n")
        self._lines.flush()
        while True:
            answer = json.loads(self._lines.readline())
            if "return" in answer:
                return answer["return"]
            if "error" in answer:
                raise RuntimeError(f"QEMU refuses {command} {arguments}: {answer['error']['desc']}")
