"""tools/experiments-page replaces the marked parts and the pictures of a page, and keeps what was not measured."""
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["HEEL_SOURCE_DIR"])
PAGE = """# Page

Text above.

<!-- goals -->

| old |

<!-- end of goals -->

<!-- real -->

| kept |

<!-- end of real -->

![drawn](experiments/a.png)
![not drawn](experiments/b.png)
"""


class ExperimentsPage(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="heel-page-")
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        for name in ("tools", "docs/experiments", "out"):
            (self.root / name).mkdir(parents=True)
        shutil.copy(SOURCE / "tools" / "experiments-page", self.root / "tools")
        self.page = self.root / "docs" / "experiments.md"
        self.page.write_text(PAGE, encoding="utf-8")
        for name in ("a.png", "b.png"):
            (self.root / "docs" / "experiments" / name).write_text("old", encoding="utf-8")

    def update(self):
        command = [self.root / "tools" / "experiments-page", self.root / "out"]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    def test_replaces_what_was_measured_and_names_what_was_not(self):
        summary = "# S\n\n## Goals\n\n<!-- goals -->\n\n| new |\n\n<!-- end of goals -->\n"
        (self.root / "out" / "summary.md").write_text(summary, encoding="utf-8")
        (self.root / "out" / "a.png").write_text("new", encoding="utf-8")
        done = self.update()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("not measured, kept: real, b.png", done.stdout)
        self.assertEqual(self.page.read_text(encoding="utf-8"), PAGE.replace("| old |", "| new |"))
        self.assertEqual((self.root / "docs/experiments/a.png").read_text(encoding="utf-8"), "new")
        self.assertEqual((self.root / "docs/experiments/b.png").read_text(encoding="utf-8"), "old")
        self.assertEqual(self.update().returncode, 0)
        self.assertEqual(self.page.read_text(encoding="utf-8"), PAGE.replace("| old |", "| new |"), "twice is as once")

    def test_refuses_a_folder_without_a_summary(self):
        done = self.update()
        self.assertEqual(done.returncode, 2)
        self.assertIn("summary.md", done.stderr)
        self.assertEqual(self.page.read_text(encoding="utf-8"), PAGE)

    def test_every_mark_of_the_page_has_its_end(self):
        page = (SOURCE / "docs" / "experiments.md").read_text(encoding="utf-8")
        begun = re.findall(r"<!-- (?!end of )([a-z-]+) -->", page)
        self.assertEqual(begun, re.findall(r"<!-- end of ([a-z-]+) -->", page))
        self.assertEqual(len(begun), len(set(begun)))
        self.assertGreaterEqual(len(begun), 9)


if __name__ == "__main__":
    unittest.main()
