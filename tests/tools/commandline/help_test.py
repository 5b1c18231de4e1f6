"""Help, man pages and the page docs/command-line.md say the same of every command."""
import gzip
import os
import re
import subprocess
import tempfile
import unittest

from programs import BUILD, SOURCE, commands, help_of, run

PAGES = {"heel.1": ("heel", "--print-man"), "heel-sim.1": ("heel-sim", "--print-man"),
         "heeld.8": ("heeld", "--print-man"), "heel.toml.5": ("heeld", "--print-config-man")}


def statuses(help_text):
    """{0: "done", …} of the line in a help text."""
    line = re.search(r"^Exit status: (.*)\.$", help_text, re.M).group(1)
    return {int(number): meaning for number, meaning in re.findall(r"(\d+) ([^;]+)", line)}


class Help(unittest.TestCase):
    def test_every_command_has_examples_statuses_and_json(self):
        found = commands()
        self.assertGreaterEqual(len(found), 25)
        for path in found:
            with self.subTest(command=path):
                text = help_of("heel", *path)
                self.assertRegex(text, rf"\nExamples:\n  heel {' '.join(path)}\b")
                self.assertEqual(statuses(text)[0], "done")
                self.assertEqual(statuses(text)[2], "bad usage or input")
                if path != ["bench"]:
                    self.assertIn("--json", text)

    def test_every_program_has_examples_statuses_and_version(self):
        for program in ("heel", "heeld", "heel-sim"):
            text = help_of(program)
            self.assertRegex(text, rf"\nExamples:\n  {program} ")
            self.assertIn(0, statuses(text))
            self.assertRegex(run(program, "--version").stdout, rf"^{program} \d+\.\d+\.\d+\n$")

    def test_an_example_uses_options_that_exist(self):
        used, all_commands = 0, commands()
        for path in [[], *all_commands]:
            text = help_of("heel", *path)
            for line in re.findall(r"^  (heel .*)$", text.partition("\nExamples:\n")[2], re.M):
                command = line.split("|")[0].split()
                names = [word for word in command[1:] if re.fullmatch("[a-z]+", word)]
                of = names[:2] if names[:2] in all_commands else names[:1]
                known = help_of("heel", *of)
                for option in [word for word in command if word.startswith("-")]:
                    self.assertRegex(known, rf"(^|[ ,]){option}\b", line)
                    used += 1
        self.assertGreater(used, 40)

    def test_bad_usage_ends_with_the_documented_status(self):
        for program, status in (("heel", 2), ("heeld", 64), ("heel-sim", 2)):
            done = run(program, "--no-such-option")
            self.assertEqual(done.returncode, status)
            self.assertEqual(done.stdout, "")
            self.assertIn(status, statuses(help_of(program)))

    def test_the_document_has_every_status(self):
        page = (SOURCE / "docs/command-line.md").read_text(encoding="utf-8")
        for program in ("heel", "heeld", "heel-sim"):
            for number, meaning in statuses(help_of(program)).items():
                self.assertIn(f"| `{program}` | {number} | {meaning} |", page)


class ManPages(unittest.TestCase):
    def rendered(self, program, option):
        done = subprocess.run(["groff", "-k", "-man", "-ww", "-Tutf8", "-P-cbou", "-rLL=100n"],
                              input=run(program, option).stdout, capture_output=True, text=True, check=True)
        self.assertEqual(done.stderr, "", "groff warns")
        return done.stdout

    def test_pages_have_no_warnings_and_all_parts(self):
        for page, command in PAGES.items():
            text = self.rendered(*command)
            for part in ["NAME", "DESCRIPTION", "FILES", "SEE ALSO"]:
                self.assertRegex(text, rf"(?m)^{part}$", page)

    def test_statuses_are_those_of_the_help(self):
        for program in ("heel", "heeld", "heel-sim"):
            part = self.rendered(program, "--print-man").partition("\nEXIT STATUS\n")[2]
            part = re.sub(r"\s+", " ", re.split(r"\n[A-Z]", part)[0])
            for number, meaning in statuses(help_of(program)).items():
                self.assertIn(f" {number} {meaning} ", part + " ")

    def test_the_page_of_heel_has_every_command_and_option(self):
        text = self.rendered("heel", "--print-man")
        options = 0
        for path in commands():
            self.assertRegex(text, rf"(?m)^ +heel {' '.join(path)}$")
            for option in re.findall(r"^  (?:-\w,)?(--[a-z0-9-]+)", help_of("heel", *path), re.M):
                self.assertIn(option, text)
                options += 1
        self.assertGreater(options, 100)

    def test_the_page_of_the_configuration_has_every_key(self):
        text = self.rendered("heeld", "--print-config-man")
        keys = re.findall(r"^\| `(\w+\.\w+)`", run("heeld", "--print-config-manual").stdout, re.M)
        self.assertGreater(len(keys), 50)
        for key in keys:
            self.assertIn(key, text)

    def test_pages_and_completions_are_installed(self):
        with tempfile.TemporaryDirectory(prefix="heel-manuals-") as root:
            subprocess.run([os.environ["HEEL_CMAKE"], "--install", str(BUILD / "tools/manuals"), "--prefix", "/usr"],
                           env={**os.environ, "DESTDIR": root}, check=True, capture_output=True)
            for page, command in PAGES.items():
                path = f"{root}/usr/share/man/man{page[-1]}/{page}.gz"
                with gzip.open(path, "rt", encoding="utf-8") as file:
                    self.assertEqual(file.read(), run(*command).stdout)
            for program in ("heel", "heeld", "heel-sim"):
                self.assertTrue(os.path.exists(f"{root}/usr/share/bash-completion/completions/{program}"))
                self.assertTrue(os.path.exists(f"{root}/usr/share/zsh/site-functions/_{program}"))


if __name__ == "__main__":
    unittest.main()
