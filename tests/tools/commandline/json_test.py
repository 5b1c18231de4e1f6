"""With --json standard output holds one JSON document and nothing else."""
import json
import pathlib
import tempfile
import unittest

from programs import SOURCE, commands, run

SCENARIO = SOURCE / "tools/heel-sim/scenarios/demo.toml"
MODEL = SOURCE / "tools/heel-sim/pose_noise/pictured.toml"


class Json(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="heel-json-")
        cls.path = pathlib.Path(cls.folder.name)
        done = run("heel-sim", "--scenario", SCENARIO, "--still", cls.file("view.png"), "--camera-info-out",
                   cls.file("camera.yaml"), "--distance", "1.5")
        cls.region = done.stdout
        assert done.returncode == 0, done.stderr
        done = run("heel", "simulate", SCENARIO, "--error-model", MODEL, "--duration", "12", "-o", cls.file("run"))
        assert done.returncode == 0, done.stderr

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def file(cls, name):
        return str(cls.path / name)

    def json_of(self, *arguments, status=0):
        done = run("heel", *arguments, "--json")
        self.assertEqual(done.returncode, status, done.stderr)
        return json.loads(done.stdout)

    def teach(self, roi, output, status=0):
        return self.json_of("teach", "--image", self.file("view.png"), "--roi", roi, "--distance", "1.5",
                            "--camera-info", self.file("camera.yaml"), "-o", self.file(output), "--reach-time", "1",
                            status=status)

    def test_teach_and_pose(self):
        roi = self.region.split("roi=")[1].split()[0]
        taught = self.teach(roi, "shirt.heel")
        self.assertTrue(taught["usable"])
        self.assertEqual(taught["output"], self.file("shirt.heel"))
        self.assertGreater(taught["reach"]["cells"][0]["pictures"], 0)
        refused = self.teach("0,0,40,40", "none.heel", status=1)
        self.assertFalse(refused["usable"])
        self.assertNotEqual(refused["reason"], "")
        self.assertIsNone(refused["reach"])
        pose = self.json_of("pose", "--template", self.file("shirt.heel"), "--camera-info", self.file("camera.yaml"),
                            self.file("view.png"))
        self.assertTrue(pose["found"])

    def test_card(self):
        card = self.json_of("card", "-o", self.file("card.pdf"))
        self.assertEqual((card["columns"], card["rows"], card["square_m"]), (5, 7, 0.034))

    def test_features(self):
        found = self.json_of("features", self.file("view.png"), "-o", self.file("view.kpd"), "--max", "50")
        self.assertEqual(found["features"], 50)

    def test_simulate(self):
        run_s = ("simulate", SCENARIO, "--error-model", MODEL, "--duration", "5")
        self.assertEqual(self.json_of(*run_s, "--seed", "7")["seed"], 7)
        self.assertEqual(self.json_of(*run_s, "--runs", "2")["runs"], 2)

    def test_recordings(self):
        recording = self.file("run/run.mcap")
        replayed = self.json_of("replay", recording)
        self.assertEqual(replayed["same"], replayed["ticks"])
        self.assertGreater(replayed["ticks"], 500)
        self.assertIsNone(replayed["first"])
        self.assertEqual(replayed["vision"]["frames"], 0)
        other = self.json_of("replay", recording, "--set", "control.gain_yaw_1_s=0.1", status=1)
        self.assertTrue(other["first_command"]["fields"])
        self.assertIsNone(other["vision"])
        exported = self.json_of("export", recording, "--csv", "-o", self.file("csv"))
        for name in exported["files"]:
            self.assertTrue(pathlib.Path(name).exists())
        bundle = self.json_of("bundle", recording, "-o", self.file("bundle.mcap"))
        self.assertEqual(bundle["bytes"], pathlib.Path(self.file("bundle.mcap")).stat().st_size)
        self.assertIn("along_p95_m", json.dumps(self.json_of("report", self.file("run"))))

    def test_experiment(self):
        family = self.json_of("experiment", "family", "-o", self.file("family"))["experiments"]
        self.assertEqual([one["name"] for one in family], ["family"])
        self.assertGreater(family[0]["robots"], 5)

    def test_every_command_that_is_not_tested_here_is_tested_elsewhere(self):
        here = {"teach", "card", "pose", "features", "simulate", "replay", "export", "bundle", "report", "experiment"}
        # many_runs_test, calibrate_test, experiment_test, bench_vision_test, measured_heeld_test, operator_test,
        # preflight_test, setup_test, tune_test
        elsewhere = {"merge", "calibrate", "fit", "latency", "bench", "status", "start", "stop", "estop", "reset", "set", "save",
                     "watch", "mark", "preflight", "setup", "tune"}
        self.assertEqual({path[0] for path in commands()}, here | elsewhere)


if __name__ == "__main__":
    unittest.main()
