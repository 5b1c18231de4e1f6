"""tools/shirts-page: the table and the picture that it writes, and what it leaves as it is."""
import importlib.machinery
import importlib.util
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["HEEL_SOURCE_DIR"])
SCRIPT = SOURCE / "tools/shirts-page"
PAGE = "# Shirts\n\nabove\n\n<!-- shirts -->\nold\n<!-- end of shirts -->\n\nbelow\n"


def script():
    sys.dont_write_bytecode = True
    loader = importlib.machinery.SourceFileLoader("shirts_page", str(SCRIPT))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("shirts_page", loader))
    loader.exec_module(module)
    return module


def verdict(far_m=6.0, turn_rad=1.31, alike=0.02, features=200, reason=""):
    reach = None if reason else {"near_m": 0.8, "far_m": far_m, "turn_rad": turn_rad}
    return {"usable": not reason, "reason": reason, "features": features, "self_similarity": alike, "reach": reach}


class Rows(unittest.TestCase):
    def setUp(self):
        self.page = script()

    def test_a_row_is_that_of_the_worst_print(self):
        row = self.page.worst("bold", [verdict(), verdict(far_m=4.5, features=90), verdict(turn_rad=0.524, alike=0.3)])
        self.assertEqual((row["far_m"], row["turn_deg"], row["features"], row["alike"]), (4.5, 30, 90, 0.3))
        row = self.page.worst("dotted", [verdict(), verdict(reason="the pattern repeats: 93 %")])
        self.assertEqual(row["reason"], "the pattern repeats: 93 %")
        row = self.page.worst("plain", [verdict(reason="only 3 features", features=3), verdict(reason="only 1 feature", features=1)])
        self.assertEqual((row["reason"], row["features"]), ("only 1 feature", 1))
        row = self.page.worst("dotted", [verdict(), verdict(reason="the pattern repeats: 93 %")])
        self.assertIn("| – | – | refused: the pattern repeats |", self.page.table([row]))

    def test_easy_is_what_is_far_turned_and_unlike_itself(self):
        easy, middle, refused = self.page.GROUPS
        for group, one in (
            (easy, verdict(far_m=5.0, turn_rad=1.048, alike=0.1)),
            (middle, verdict(far_m=4.5)),
            (middle, verdict(turn_rad=0.8)),
            (middle, verdict(alike=0.11)),
            (refused, verdict(reason="only 3 features")),
        ):
            self.assertEqual(self.page.group(self.page.worst("bold", [one])), group, one)

    def test_the_best_comes_first(self):
        rows = [
            self.page.worst(design, [one])
            for design, one in (
                ("plain", verdict(reason="only 3 features")),
                ("photo", verdict(far_m=3.0)),
                ("jersey", verdict(alike=0.2)),
                ("text", verdict(turn_rad=1.048)),
                ("bold", verdict()),
            )
        ]
        self.assertEqual([row["design"] for row in self.page.ordered(rows)], ["bold", "text", "jersey", "photo", "plain"])


class Documents(unittest.TestCase):
    def test_the_page_has_a_row_for_each_design(self):
        text = (SOURCE / "docs/shirts.md").read_text(encoding="utf-8")
        module = script()
        rows = re.findall(r"^\| ([^|]+) \|", module.PART.search(text).group(0), re.MULTILINE)
        self.assertEqual(sorted(rows[1:]), sorted(module.DESIGNS.values()))
        self.assertLess((SOURCE / "docs/shirts.jpg").stat().st_size, 200_000)


class Run(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="heel-shirts-")
        self.addCleanup(folder.cleanup)
        self.page = pathlib.Path(folder.name) / "page.md"
        self.page.write_text(PAGE, encoding="utf-8")

    def run_script(self, *arguments):
        return subprocess.run([SCRIPT, "--page", self.page, *arguments], capture_output=True, text=True, check=False)

    def test_measures_good_and_bad_prints(self):
        done = self.run_script("--shirts", "dotted,bold")
        self.assertEqual(done.returncode, 0, done.stderr)
        text = self.page.read_text(encoding="utf-8")
        self.assertTrue(text.startswith("# Shirts\n\nabove\n\n<!-- shirts -->\n"))
        self.assertTrue(text.endswith("<!-- end of shirts -->\n\nbelow\n"))
        bold, dotted = text.splitlines()[8:10]
        self.assertRegex(bold, r"^\| many shapes.* \| 0.8 to [56] m \| (60|75)° \| easy to follow \|$")
        self.assertRegex(dotted, r"^\| dots .* \| – \| – \| refused: the pattern repeats \|$")
        self.assertEqual(self.page.with_suffix(".jpg").read_bytes()[:3], b"\xff\xd8\xff")

    def test_refuses_what_it_does_not_know(self):
        done = self.run_script("--shirts", "tartan")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--shirts tartan: no such design", done.stderr)
        self.page.write_text("# no part\n", encoding="utf-8")
        done = self.run_script("--shirts", "plain")
        self.assertEqual(done.returncode, 2)
        self.assertIn("no part between", done.stderr)
        self.assertEqual(self.page.read_text(encoding="utf-8"), "# no part\n")


if __name__ == "__main__":
    unittest.main()
