"""tools/check-includes accepts the tree, and names file, line and rule of each forbidden include planted in a copy of it."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["HEEL_SOURCE_DIR"])


class CheckIncludes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="heel-includes-")
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        for part in ("src", "include", "firmware-protocol"):
            shutil.copytree(SOURCE / part, self.root / part)

    def plant(self, path, text):
        (self.root / path).parent.mkdir(parents=True, exist_ok=True)
        (self.root / path).write_text(text, encoding="utf-8")

    def edit_table(self, old, new):
        table = self.root / "src" / "rooms.txt"
        text = table.read_text(encoding="utf-8")
        self.assertIn(old, text)
        table.write_text(text.replace(old, new), encoding="utf-8")

    def check(self):
        return subprocess.run([SOURCE / "tools" / "check-includes", self.root], capture_output=True, text=True, check=False)

    def expect_found(self, *lines):
        """The output has exactly these lines; each is compared as far as it is given."""
        done = self.check()
        self.assertEqual(done.returncode, 1, done.stderr)
        found = done.stdout.splitlines()
        self.assertEqual([line[:len(expected)] for line, expected in zip(found, lines)], list(lines), done.stdout)
        self.assertEqual(len(found), len(lines), done.stdout)

    def test_tree_as_it_is(self):
        done = self.check()
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertEqual(done.stdout, "")

    def test_control_includes_sim(self):
        self.plant("src/control/planted.cpp", "// A comment.\n#include \"sim/robot/p3at.h\"\n")
        self.expect_found("src/control/planted.cpp:2: room 'control' may not include room 'sim/robot' (it may: core")

    def test_daemon_includes_evaluation(self):
        self.plant("src/daemon/planted.h", "#pragma once\n\n  #  include \"evaluation/metrics/metrics.h\"\n")
        self.expect_found("src/daemon/planted.h:3: room 'daemon' may not include room 'evaluation/metrics' (it may: ")

    def test_vision_includes_spdlog(self):
        self.plant("src/vision/pose/planted.cpp", "#include <spdlog/spdlog.h>\n")
        self.expect_found("src/vision/pose/planted.cpp:1: room 'vision/pose' may not include library 'spdlog' (it may: eigen)")

    def test_public_header_includes_internal_one(self):
        self.plant("include/heel/time.h", "#include <cstdint>\n#include \"core/angles.h\"\n")
        self.expect_found("include/heel/time.h:2: a public header may not include 'core/angles.h'")

    def test_public_header_includes_library_of_its_room(self):
        self.plant("include/heel/matching.h", "#include <hwy/highway.h>\n")
        self.expect_found("include/heel/matching.h:1: a public header may not include library 'highway' (it may: eigen)")

    def test_public_header_without_room(self):
        self.plant("include/heel/planted.h", "")
        self.expect_found("include/heel/planted.h: no row 'public' of src/rooms.txt names it")

    def test_protocol_includes_the_tree(self):
        self.plant("firmware-protocol/src/planted.cpp", "#include \"field_order.h\"\n#include \"heel/time.h\"\n")
        self.expect_found("firmware-protocol/src/planted.cpp:2: room 'arcos' may not include room 'core' (it may: none)")

    def test_unknown_room(self):
        self.plant("src/planted/planted.h", "#pragma once\n")
        self.expect_found("src/planted/planted.h: folder 'planted' has no row in src/rooms.txt")

    def test_include_of_unknown_room(self):
        self.plant("src/control/planted.cpp", "#include \"elsewhere/planted.h\"\n")
        self.expect_found("src/control/planted.cpp:1: 'elsewhere/planted.h' is in no room of the table")

    def test_unknown_library(self):
        self.plant("src/control/planted.cpp", "#include <elsewhere/planted.h>\n")
        self.expect_found("src/control/planted.cpp:1: 'elsewhere/planted.h' belongs to no library of the table")

    def test_row_that_names_a_later_room(self):
        self.edit_table("room core : - :", "room core : control :")
        done = self.check()
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("room 'control' stands in no row above (expected the order of data flow)", done.stderr)

    def test_row_with_unknown_library(self):
        self.edit_table("room core : - : eigen", "room core : - : eigne")
        done = self.check()
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("library 'eigne' is not known (expected one of: eigen", done.stderr)


if __name__ == "__main__":
    unittest.main()
