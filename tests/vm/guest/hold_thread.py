#!/usr/bin/python3
"""Holds one thread of a process, and only that one, as if the control loop hung.

  hold_thread.py PID THREAD-NAME SECONDS
"""
import ctypes
import os
import sys
import time

PTRACE_SEIZE, PTRACE_INTERRUPT = 0x4206, 0x4207


def thread_id(pid, name):
    for task in os.listdir(f"/proc/{pid}/task"):
        with open(f"/proc/{pid}/task/{task}/comm") as comm:
            if comm.read().strip() == name:
                return int(task)
    sys.exit(f"process {pid} has no thread {name}")


def main():
    libc = ctypes.CDLL(None, use_errno=True)
    libc.ptrace.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p]
    task = thread_id(sys.argv[1], sys.argv[2])
    for request in (PTRACE_SEIZE, PTRACE_INTERRUPT):
        if libc.ptrace(request, task, None, None) != 0:
            sys.exit(f"thread {task}: {os.strerror(ctypes.get_errno())}")
    time.sleep(float(sys.argv[3]))


main()
