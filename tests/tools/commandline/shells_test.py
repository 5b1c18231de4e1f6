"""Completion in real shells, and progress on a real terminal."""
import json
import os
import pathlib
import shutil
import tempfile
import unittest

from programs import BIN, SOURCE, Terminal, run

PROMPT = "ready>"
# What is typed before the tabulator, and what it becomes.
COMPLETIONS = [
    ("heel cal", "heel calibrate"),
    ("heel bench vis", "heel bench vision"),
    ("heel pose --pict", "heel pose --picture-dir"),
    ("heel bench daemon --pictures lossl", "heel bench daemon --pictures lossless"),
    ("heel set gate.v_m", "heel set gate.v_max_m_s="),
    ("heel pose --template sh", "heel pose --template shirt.heel"),
    ("heel simulate sc", "heel simulate scenarios"),
    ("heeld --che", "heeld --check"),
    ("heel-sim --model p3dx-", "heel-sim --model p3dx-sh"),
]


class Shells(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix="heel-shells-")
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)
        for name in ("shirt.heel", "shot.txt"):
            (self.path / name).touch()
        (self.path / "scenarios").mkdir()
        self.environment = {"PATH": f"{BIN}:{os.environ['PATH']}", "TERM": "xterm", "HOME": self.folder.name,
                            "LC_ALL": "C.UTF-8", "COLUMNS": "200"}

    def write_scripts(self, shell, name):
        for program in ("heel", "heeld", "heel-sim"):
            script = run(program, "--print-completion", shell).stdout
            (self.path / name.format(program)).write_text(script, encoding="utf-8")

    def complete_in(self, shell, start):
        with Terminal(shell, environment=self.environment, folder=self.folder.name) as terminal:
            terminal.type(start)
            self.assertTrue(terminal.shows(PROMPT), terminal.shown)  # in the echo of what was typed it has quotes
            for typed, expected in COMPLETIONS:
                terminal.shown = ""
                terminal.type(typed + "\t")
                self.assertTrue(terminal.shows(expected), f"{typed!r}: {terminal.shown!r}")
                terminal.type("\x15")  # empties the line

    def test_bash(self):
        self.write_scripts("bash", "{}.bash")
        sources = "; ".join(f". ./{program}.bash" for program in ("heel", "heeld", "heel-sim"))
        self.complete_in(["bash", "--norc", "-i"], f"bind 'set bell-style none'; {sources}; PS1='ready''>'\r")

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not installed")
    def test_zsh(self):
        self.write_scripts("zsh", "_{}")
        self.complete_in(["zsh", "-f", "-i"],
                         f"fpath=({self.path} $fpath); autoload -Uz compinit; compinit -u -D; unsetopt beep; "
                         "PROMPT='ready''>'\r")


class Progress(unittest.TestCase):
    COMMAND = [str(BIN / "heel"), "simulate", str(SOURCE / "tools/heel-sim/scenarios/demo.toml"), "--error-model",
               str(SOURCE / "tools/heel-sim/pose_noise/pictured.toml"), "--duration", "60", "--json", "--runs"]

    def test_a_terminal_shows_time_left_and_json_stays_alone(self):
        with Terminal([*self.COMMAND, "12"], only_stderr=True) as terminal:
            self.assertTrue(terminal.shows(" left"), terminal.shown)
            self.assertRegex(terminal.shown, r"\rruns: \d+ of 12, about \d+ (s|min) left")
            while terminal.read():
                pass
            self.assertEqual(json.loads(terminal.process.stdout.read())["runs"], 12)
            self.assertTrue(terminal.shown.endswith("\r"), "the line is freed at the end")

    def test_elsewhere_nothing_is_shown(self):
        done = run("heel", *self.COMMAND[1:], "2")
        self.assertEqual(done.returncode, 0)
        self.assertEqual(done.stderr, "")


if __name__ == "__main__":
    unittest.main()
