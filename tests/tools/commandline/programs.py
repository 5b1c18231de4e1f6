"""The built programs, and a terminal to run them in."""
import functools
import os
import pathlib
import pty
import re
import select
import signal
import subprocess
import time

SOURCE = pathlib.Path(os.environ["HEEL_SOURCE_DIR"])
BUILD = pathlib.Path(os.environ["HEEL_BUILD_DIR"])
BIN = BUILD / "bin"
PATIENCE_S = 120


def run(*command, **options):
    """The finished process; its output is text."""
    program, *arguments = map(str, command)
    return subprocess.run([str(BIN / program), *arguments], capture_output=True, text=True, timeout=900, check=False,
                          **options)


@functools.lru_cache(maxsize=None)
def help_of(program, *path):
    return run(program, *path, "--help").stdout


def commands():
    """The commands of heel: ["pose"], ["bench"], ["bench", "vision"], …"""
    found = []

    def below(path):
        text = help_of("heel", *path)
        for name in re.findall(r"^  ([a-z]+) ", text.partition("\nSubcommands:\n")[2].partition("\n\n")[0], re.M):
            found.append([*path, name])
            below(found[-1])

    below([])
    return found


class Terminal:
    """A program whose terminal this is, or its standard error alone."""

    def __init__(self, command, only_stderr=False, environment=None, folder=None):
        self.master, terminal = pty.openpty()
        if only_stderr:
            streams = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": terminal}
        else:
            streams = {"stdin": terminal, "stdout": terminal, "stderr": terminal}
        self.process = subprocess.Popen(command, start_new_session=True, cwd=folder, env=environment, **streams)
        os.close(terminal)
        self.shown = ""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        if self.process.stdout:
            self.process.stdout.close()
        os.close(self.master)

    def type(self, text):
        os.write(self.master, text.encode())

    def read(self):
        """True as long as there may be more."""
        if not select.select([self.master], [], [], 0.05)[0]:
            return self.process.poll() is None
        try:
            piece = os.read(self.master, 65536)
        except OSError:  # the program has ended
            return False
        self.shown += re.sub(r"\x1b(\[[0-9;?]*[A-Za-z]|[=>])", "", piece.decode(errors="replace"))
        return bool(piece)

    def shows(self, text):
        end = time.monotonic() + PATIENCE_S
        while text not in self.shown and time.monotonic() < end and self.read():
            pass
        return text in self.shown
