"""tools/plots: what is computed for the picture of the three laws, and that the picture is drawn."""
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

PLOTS = pathlib.Path(os.environ["HEEL_SOURCE_DIR"]) / "tools/plots"
sys.dont_write_bytecode = True
sys.path.insert(0, str(PLOTS))
import laws  # noqa: E402 (its folder comes first)


def walk():
    """Straight on for 4 m, then a quarter circle to the left with a radius of 2 m."""
    straight = [(0.01 * i, 0.0) for i in range(400)]
    turn = [(4.0 + 2.0 * math.sin(a), 2.0 - 2.0 * math.cos(a)) for a in np.linspace(0.0, math.pi / 2.0, 315)]
    return np.array(straight + turn)


def moved_to_the_left(path, by_m):
    along = np.gradient(path, axis=0)
    along /= np.linalg.norm(along, axis=1)[:, None]
    return path + by_m * np.column_stack((-along[:, 1], along[:, 0]))


class Laws(unittest.TestCase):
    def test_beside_is_positive_to_the_left(self):
        path, walked_m = laws.evenly(walk())
        self.assertAlmostEqual(walked_m[-1], 4.0 + math.pi, delta=0.06)
        for by_m in (0.1, -0.05, 0.0):
            apart_m = laws.beside(moved_to_the_left(walk(), by_m), path)
            # Near the end the nearest place of the robot may lie behind the path's last point.
            self.assertLess(np.abs(apart_m - by_m)[:-3].max(), 0.003)

    def test_the_picture_is_drawn(self):
        with tempfile.TemporaryDirectory() as folder:
            for law, by_m in (("position", 0.2), ("view", -0.05), ("trail", 0.0)):
                truth = pathlib.Path(folder) / law / "truth.csv"
                truth.parent.mkdir()
                columns = np.column_stack((walk(), moved_to_the_left(walk(), by_m)))
                np.savetxt(truth, columns, delimiter=",", comments="",
                           header="person_x_m,person_y_m,robot_x_m,robot_y_m")
            subprocess.run([PLOTS / "plots", folder], check=True)
            for kind in ("png", "svg"):
                self.assertGreater((pathlib.Path(folder) / f"laws.{kind}").stat().st_size, 10000)


if __name__ == "__main__":
    unittest.main()
