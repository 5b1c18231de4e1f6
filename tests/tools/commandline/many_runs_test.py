"""Many runs as many processes: heel merge gives what heel simulate --runs gives, also with GNU parallel."""
import json
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from programs import BIN, SOURCE, run

SCENARIO = SOURCE / "tools/heel-sim/scenarios/demo.toml"
ARGUMENTS = ["simulate", str(SCENARIO), "--error-model", str(SOURCE / "tools/heel-sim/pose_noise/pictured.toml"), "--duration",
             "15", "--json"]
# The names in a run's result, and over runs by --runs.
SAME = {"lateral_m.rms": "path_rms_m", "following.path_p95_m": "path_p95_m", "separation_m.mean": "separation_mean_m",
        "robot_path_m": "robot_path_m", "out_of_view_longest_s": "out_of_view_longest_s"}


class ManyRuns(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="heel-runs-")
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)

    def simulate(self, seed, *more):
        file = self.path / f"run-{seed}.json"
        done = run("heel", *ARGUMENTS, "--seed", str(seed), *more)
        file.write_text(done.stdout, encoding="utf-8")
        return str(file)

    def merged(self, *files, status=0):
        done = run("heel", "merge", *files, "--json")
        self.assertEqual(done.returncode, status, done.stderr)
        (scenario,) = json.loads(done.stdout)["scenarios"]
        return scenario

    def test_two_seeds_give_what_runs_2_gives(self):
        files = [self.simulate(7), self.simulate(8)]
        merged = self.merged(*files)
        self.assertEqual(merged, self.merged(*reversed(files)), "the order of the files does not matter")
        self.assertEqual((merged["scenario"], merged["runs"], merged["seeds"], merged["failed"]), ("demo", 2, [7, 8], []))
        together = json.loads(run("heel", *ARGUMENTS, "--seed", "7", "--runs", "2").stdout)
        for name, other in SAME.items():
            for part in ("mean", "deviation", "min", "p50", "max"):
                self.assertAlmostEqual(merged["figures"][name][part], together[other][part], places=9, msg=f"{name} {part}")
        self.assertNotEqual(merged["figures"]["lateral_m.rms"]["min"], merged["figures"]["lateral_m.rms"]["max"])

    def test_a_table_names_the_runs_that_failed(self):
        files = [self.simulate(7), self.simulate(8, "--min-path-m", "1000")]
        self.assertEqual(self.merged(*files, status=1)["failed"], [8])
        done = run("heel", "merge", *files)
        self.assertEqual(done.returncode, 1)
        self.assertIn("demo: 2 runs, 1 of them did not meet a limit\n", done.stdout)

    def test_what_is_no_result_is_named(self):
        good = self.simulate(7)
        (self.path / "empty.json").touch()
        (self.path / "cut.json").write_text(pathlib.Path(good).read_text(encoding="utf-8")[:-20], encoding="utf-8")
        (self.path / "other.json").write_text('{"a": 1}', encoding="utf-8")
        for files, complaint in (([good, good], "seed 7 of demo a second time"), (["empty.json"], "has the run ended?"),
                                 (["cut.json"], "was a run interrupted?"), (["other.json"], "no result of a run"),
                                 (["none.json"], "cannot be read")):
            done = run("heel", "merge", *files, cwd=self.path)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn(complaint, done.stderr)
            self.assertEqual(done.stderr.count("\n"), 1)

    @unittest.skipUnless(shutil.which("parallel"), "GNU parallel is not installed")
    def test_gnu_parallel(self):
        every = subprocess.run(["parallel", "--will-cite", "--jobs", "2", str(BIN / "heel"), *ARGUMENTS, "--seed", "{}", ":::",
                                "1", "2", "3"], capture_output=True, text=True, check=True)
        file = self.path / "all.json"
        file.write_text(every.stdout, encoding="utf-8")
        self.assertEqual(self.merged(str(file))["seeds"], [1, 2, 3])


if __name__ == "__main__":
    unittest.main()
