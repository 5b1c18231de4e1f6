"""tools/random-worlds: the same seed draws the same world, the path stays free, and the table counts the runs."""
import importlib.machinery
import importlib.util
import os
import pathlib
import random
import subprocess
import sys
import unittest

SOURCE = pathlib.Path(os.environ["HEEL_SOURCE_DIR"])
HEEL = pathlib.Path(os.environ["HEEL_BUILD_DIR"]) / "bin/heel"
PROGRAM = SOURCE / "tools/random-worlds"


def load():
    sys.dont_write_bytecode = True
    sys.path.insert(0, str(PROGRAM.parent))
    loader = importlib.machinery.SourceFileLoader("random_worlds", str(PROGRAM))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("random_worlds", loader))
    loader.exec_module(module)
    return module


class RandomWorlds(unittest.TestCase):
    def test_a_seed_is_a_world(self):
        worlds = load()
        for kind in worlds.KINDS:
            self.assertEqual(worlds.world(kind, 3), worlds.world(kind, 3))
            self.assertNotEqual(worlds.world(kind, 3), worlds.world(kind, 4))

    def test_poles_leave_the_path_free(self):
        worlds = load()
        for seed in range(5):
            walk, things = worlds.clutter(random.Random(seed))
            poles = [dict(line.split(" = ") for line in pole.splitlines()[1:]) for pole in things.split("[[obstacle]]")[1:]]
            self.assertTrue(10 <= len(poles) <= 40)
            for pole in poles:
                gap = walk.distance(float(pole["x_m"]), float(pole["y_m"])) - float(pole["radius_m"])
                self.assertGreaterEqual(gap, worlds.FREE_M)

    def test_the_table_counts_the_runs(self):
        done = subprocess.run([str(PROGRAM), "corridor", "--laws", "view", "--runs", "2", "--heel", str(HEEL)],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("| corridor | `view` | 2 of 2 | 0 |", done.stdout)

    def test_an_unknown_kind_is_named(self):
        done = subprocess.run([str(PROGRAM), "castle"], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn("castle: no such kind (expected doorway", done.stderr)


if __name__ == "__main__":
    unittest.main()
