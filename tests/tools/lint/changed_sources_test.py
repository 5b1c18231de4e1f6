"""tools/tidy and tools/compile-alone find what is planted in a small tree, and check again only what has changed."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["HEEL_SOURCE_DIR"])
CMAKE_LISTS = """cmake_minimum_required(VERSION 3.25)
project(small LANGUAGES CXX)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
add_subdirectory(src)
"""
LIBRARY = """add_library(small one.cpp two.cpp)
target_include_directories(small PRIVATE .)
"""
PRESETS = """{"version": 6, "configurePresets": [
  {"name": "debug", "generator": "Ninja", "binaryDir": "${sourceDir}/build/debug"},
  {"name": "tidy", "inherits": "debug", "binaryDir": "${sourceDir}/build/tidy",
   "cacheVariables": {"CMAKE_UNITY_BUILD": "ON"}}]}
"""


class ChangedSources(unittest.TestCase):
    def setUp(self):
        if shutil.which("clang-tidy-14") is None:
            self.skipTest("clang-tidy-14 is not installed (tools/setup --lint)")
        folder = tempfile.TemporaryDirectory(prefix="heel-changed-")
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name) / "tree"
        self.environment = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
        self.environment["XDG_CACHE_HOME"] = str(pathlib.Path(folder.name) / "cache")
        shutil.copytree(SOURCE / "tools/checking", self.root / "tools/checking")
        for file in (".clang-tidy", "tools/tidy", "tools/compile-alone"):
            shutil.copy(SOURCE / file, self.root / file)
        self.t_written_s = 0
        self.write(".gitignore", "build/\n__pycache__/\n")
        self.write("CMakeLists.txt", CMAKE_LISTS)
        self.write("CMakePresets.json", PRESETS)
        self.write("src/CMakeLists.txt", LIBRARY)
        self.write("src/number.h", "#pragma once\ninline int number() { return 1; }\n")
        self.write("src/one.cpp", "int one() { return 1; }\n")
        self.write("src/two.cpp", "#include \"number.h\"\nint two() { return number() + 1; }\n")
        self.run_in_tree("git", "init", "--quiet")
        self.commit("2026-01-01T12:00:00")

    def write(self, path, text):
        (self.root / path).parent.mkdir(parents=True, exist_ok=True)
        (self.root / path).write_text(text, encoding="utf-8")
        self.t_written_s += 1  # long before the check, and never the same
        os.utime(self.root / path, (self.t_written_s, self.t_written_s))

    def run_in_tree(self, *command):
        return subprocess.run(command, cwd=self.root, env=self.environment, check=False, capture_output=True, text=True)

    def commit(self, date):
        self.environment.update(GIT_AUTHOR_DATE=date, GIT_COMMITTER_DATE=date)
        self.run_in_tree("git", "add", "--all")
        done = self.run_in_tree("git", "-c", "user.name=Somebody", "-c", "user.email=somebody@example.org", "commit", "--quiet",
                                "--message", "Change the tree")
        self.assertEqual(done.returncode, 0, done.stderr)

    def check(self, program, *options):
        return self.run_in_tree(f"tools/{program}", *options)

    def expect(self, program, units, before, now, *options):
        """No findings, and as many units as stated: all, passed before, checked now."""
        done = self.check(program, *options)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn(f": {units} units, {before} have passed before, {now} checked now: 0 findings", done.stderr)
        return done

    def expect_found(self, program, text):
        for _ in range(2):  # the second time, too: what has findings is not remembered
            done = self.check(program)
            self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
            self.assertIn(text, done.stdout)

    def test_forgotten_include(self):
        self.expect("compile-alone", 2, 0, 2)
        self.write("src/two.cpp", "int two() { return number() + 1; }\n")
        self.expect_found("compile-alone", "src/two.cpp:1:20: error: 'number' was not declared in this scope")

    def test_fault_for_clang_tidy(self):
        self.expect("tidy", 1, 0, 1)
        self.write("src/two.cpp", "#include \"number.h\"\nint two(int* p) { if (p != 0) { return number(); } return *p; }\n")
        self.expect_found("tidy", "src/two.cpp:2:28: error: use nullptr [modernize-use-nullptr")

    def test_named_headers_and_sources(self):
        self.write("src/number.h", "#pragma once\ninline int number(int* p = 0) { return p != 0 ? *p : 1; }\n")
        done = self.check("tidy", "src/number.h", "src/two.cpp")
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertIn("number.h:2:28: error: use nullptr [modernize-use-nullptr", done.stdout)
        self.assertIn(": 1 units, ", done.stderr)
        done = self.check("tidy", "src/one.cpp")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        done = self.check("tidy", "src/missing.h")
        self.assertEqual(done.returncode, 2)
        self.assertIn("src/missing.h: the preset debug does not compile it", done.stderr)

    def test_only_what_changed_is_checked_again(self):
        self.expect("compile-alone", 2, 0, 2)
        self.expect("compile-alone", 2, 2, 0)
        self.expect("tidy", 1, 0, 1)
        self.write("src/number.h", "#pragma once\ninline int number() { return 2; }\n")
        self.expect("compile-alone", 2, 1, 1)
        self.expect("tidy", 1, 0, 1)
        self.expect("compile-alone", 2, 2, 0)

    def test_other_flags_and_settings_check_all_again(self):
        self.expect("compile-alone", 2, 0, 2)
        self.expect("tidy", 1, 0, 1)
        self.expect("tidy", 1, 1, 0)
        self.write(".clang-tidy", "Checks: '-*,modernize-use-nullptr'\n")
        self.expect("tidy", 1, 0, 1)
        self.write("src/CMakeLists.txt", LIBRARY + "target_compile_options(small PRIVATE -Wshadow)\n")
        self.expect("compile-alone", 2, 0, 2)

    def test_the_newest_change_comes_first(self):
        self.write("src/number.h", "#pragma once\ninline int number() { return 2; }\n")
        self.commit("2026-01-02T12:00:00")
        done = self.expect("compile-alone", 2, 0, 1, "--at-most", "1")
        self.assertIn("; 1 left, changed longer ago", done.stderr)
        self.write("src/two.cpp", "#include \"number.h\"\nint two() { return number() + 2; }\n")  # two.cpp was checked
        self.expect("compile-alone", 2, 0, 2)

    def test_a_change_that_is_not_committed_is_the_newest(self):
        self.write("src/two.cpp", "#include \"number.h\"\nint two() { return number() + 2; }\n")
        self.commit("2026-01-02T12:00:00")
        self.write("src/one.cpp", "int one() { return none; }\n")
        done = self.check("compile-alone", "--at-most", "1")
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertIn("src/one.cpp:1:20: error: ", done.stdout)


if __name__ == "__main__":
    unittest.main()
