"""The page of heeld: the types of its modules, and Playwright's tests in Chromium (tests/page)."""

import os
import re
import shutil
import subprocess
import unittest
from pathlib import Path

SOURCE = Path(os.environ["HEEL_SOURCE_DIR"])
FOLDER = SOURCE / "tests/page"
TOOLS = FOLDER / "node_modules/.bin"
CHROMIUM = os.environ.get("HEEL_CHROMIUM", "chromium")


def documents_pictures():
    return {file.name for file in (SOURCE / "docs").glob("page-*.jpg")}


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
        kept = documents_pictures()
        before = {name: (SOURCE / "docs" / name).read_bytes() for name in kept}
        written = Path(os.environ["HEEL_BUILD_DIR"]) / "page/screenshots"
        shutil.rmtree(written, ignore_errors=True)
        self.run_tool(TOOLS / "playwright", "test")
        # tools/page-pictures writes the documents' pictures: the same ones, and only it does.
        self.assertEqual(kept, {file.name for file in written.iterdir()})
        self.assertEqual(before, {name: (SOURCE / "docs" / name).read_bytes() for name in kept})

    def test_the_documents_show_each_picture(self):
        text = "".join(file.read_text(encoding="utf-8") for file in [SOURCE / "README.md", *(SOURCE / "docs").glob("*.md")])
        self.assertEqual(documents_pictures(), set(re.findall(r"page-[a-z-]+\.jpg", text)))
        for name in documents_pictures():
            self.assertLess((SOURCE / "docs" / name).stat().st_size, 200_000, name)


if __name__ == "__main__":
    unittest.main()
