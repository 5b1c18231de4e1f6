#!/usr/bin/python3
"""The guest's side of the tests: a shell for the host over a virtio-serial port.

One JSON object a line each way: {"id", "command", "timeout_s"} in, {"id", "status", "output"} out; status is the shell's,
or null when the command was still running after timeout_s and was ended.
"""
import json
import os
import signal
import subprocess
import threading
import time

PORT = "/dev/virtio-ports/heel-vm"
SHARE = "/mnt/share"


def run(command, timeout_s):
    process = subprocess.Popen(["/bin/bash", "-c", command], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, start_new_session=True)
    try:
        output, _ = process.communicate(timeout=timeout_s)
        return process.returncode, output
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        output, _ = process.communicate()
        return None, output


def answer(port, lock, request):
    status, output = run(request["command"], request["timeout_s"])
    line = json.dumps({"id": request["id"], "status": status, "output": output.decode(errors="replace")}) + "\n"
    with lock:
        port.write(line.encode())


def main():
    subprocess.run(["mountpoint", "-q", SHARE]).returncode and subprocess.run(
        ["mount", "-t", "9p", "-o", "trans=virtio,version=9p2000.L,msize=262144,cache=none", "share", SHARE], check=True)
    while not os.path.exists(PORT):
        time.sleep(0.1)
    lock = threading.Lock()
    with open(PORT, "r+b", buffering=0) as port:
        port.write(b'{"id": 0, "status": 0, "output": "up"}\n')
        waiting = b""
        while True:
            data = port.read(65536)
            if not data:  # nobody at the other end
                time.sleep(0.05)
                continue
            *lines, waiting = (waiting + data).split(b"\n")
            for line in lines:
                # Each in its own thread, so that a short command need not wait for a long one.
                threading.Thread(target=answer, args=(port, lock, json.loads(line)), daemon=True).start()


main()
