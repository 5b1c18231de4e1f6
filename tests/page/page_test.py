"""The page of heeld: the types of its modules, and Playwright's tests in Chromium (tests/page)."""

import os
import shutil
import subprocess
import unittest
from pathlib import Path

FOLDER = Path(os.environ["HEEL_SOURCE_DIR"]) / "tests/page"
TOOLS = FOLDER / "node_modules/.bin"
CHROMIUM = os.environ.get("HEEL_CHROMIUM", "chromium")


@unittest.skipUnless(shutil.which("node"), "node is not installed (tools/setup installs it)")
@unittest.skipUnless(TOOLS.is_dir(), "the npm packages are missing (tools/setup)")
class Page(unittest.TestCase):
    def run_tool(self, *command):
        result = subprocess.run(command, cwd=FOLDER, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        print(result.stdout)
        self.assertEqual(result.returncode, 0, result.stdout[-4000:])

    def test_types_of_the_modules(self):
        self.run_tool(TOOLS / "tsc", "--project", "tsconfig.json")

    @unittest.skipUnless(shutil.which(CHROMIUM), "chromium is not installed (tools/setup installs it)")
    def test_in_the_browser(self):
        self.run_tool(TOOLS / "playwright", "test")


if __name__ == "__main__":
    unittest.main()
