"""The hook of tools/install-hooks refuses commits by the staged files; tested in a new repository."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["HEEL_SOURCE_DIR"])
FORMATTED = "#include \"control/gate.h\"\n\nint planted() {\n  return 1;\n}\n"


class PreCommitHook(unittest.TestCase):
    def setUp(self):
        if shutil.which("clang-format-14") is None:
            self.skipTest("clang-format-14 is not installed (tools/setup --lint)")
        folder = tempfile.TemporaryDirectory(prefix="heel-hook-")
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        for part in ("src", "include", "firmware-protocol", "tools/hooks"):
            shutil.copytree(SOURCE / part, self.root / part)
        for file in (".clang-format", "tools/check-includes"):
            shutil.copy(SOURCE / file, self.root / file)
        self.git("init", "--quiet")
        self.git("config", "core.hooksPath", "tools/hooks")
        self.git("add", "--all")
        self.git("commit", "--quiet", "--no-verify", "--message", "The tree")

    def git(self, *words, check=True):
        environment = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
        identity = ["-c", "user.name=Somebody", "-c", "user.email=somebody@example.org"]
        return subprocess.run(["git", *identity, *words], cwd=self.root, env=environment, check=check,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def commit(self, text):
        """Stages `text` as a new file of src/control and tries to commit it."""
        (self.root / "src/control/planted.cpp").write_text(text, encoding="utf-8")
        self.git("add", "src/control/planted.cpp")
        return self.git("commit", "--message", "Plant a file", check=False)

    def test_takes_what_is_in_order(self):
        done = self.commit(FORMATTED)
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_refuses_another_format(self):
        done = self.commit(FORMATTED.replace("{\n  return", "{return"))
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("src/control/planted.cpp:3:", done.stdout)
        self.assertIn("pre-commit: the format differs from .clang-format", done.stdout)

    def test_refuses_a_forbidden_include(self):
        done = self.commit(FORMATTED.replace("control/gate.h", "sim/robot/p3at.h"))
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("src/control/planted.cpp:1: room 'control' may not include room 'sim/robot'", done.stdout)

    def test_looks_at_what_is_staged_not_at_the_working_tree(self):
        (self.root / "src/control/planted.cpp").write_text(FORMATTED.replace("{\n  return", "{return"), encoding="utf-8")
        self.git("add", "src/control/planted.cpp")
        (self.root / "src/control/planted.cpp").write_text(FORMATTED, encoding="utf-8")
        self.assertNotEqual(self.git("commit", "--message", "Plant a file", check=False).returncode, 0)


if __name__ == "__main__":
    unittest.main()
