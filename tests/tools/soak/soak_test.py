"""tools/soak: its verdicts on made-up samples and logs, and a short run of heeld against heel-sim in real time."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["HEEL_SOURCE_DIR"])
HEEL_SIM = pathlib.Path(os.environ["HEEL_BUILD_DIR"]) / "bin/heel-sim"
sys.path.insert(0, str(SOURCE / "tools"))

from soaking import faults, report, samples  # noqa: E402 (the folder is named first)

MINUTES = 40 / 60
THREE = ["camera away for 2 s", "emergency stop", "bumper"]


def rows(key, values, quiet=True):
    return [{"t_s": 3.0 * i, "quiet": quiet, key: value} for i, value in enumerate(values)]


class Growth(unittest.TestCase):
    def judge(self, key, values, t_settled_s=0.0, **options):
        return samples.growth(rows(key, values, **options), t_settled_s)[key]

    def test_a_descriptor_more_is_growth(self):
        self.assertTrue(self.judge("descriptors", [20] * 12 + [21] * 12)["grown"])
        self.assertFalse(self.judge("descriptors", [20] * 24)["grown"])

    def test_memory_that_creeps_is_growth_and_one_peak_is_none(self):
        self.assertTrue(self.judge("resident_mb", [40 + 0.1 * i for i in range(24)])["grown"])
        self.assertFalse(self.judge("resident_mb", [40] * 20 + [90] + [40] * 3)["grown"])

    def test_latency_may_differ_a_little(self):
        self.assertFalse(self.judge("pose_to_tick_ms", [20.0] * 8 + [24.0] * 8)["grown"])
        self.assertTrue(self.judge("pose_to_tick_ms", [20.0] * 8 + [40.0] * 8)["grown"])

    def test_what_comes_before_the_first_round_has_ended_and_during_faults_does_not_count(self):
        self.assertFalse(self.judge("threads", [5] * 8 + [9] * 16, t_settled_s=24.0)["grown"])
        self.assertFalse(self.judge("threads", [5, 9] * 20, quiet=False)["judged"])
        self.assertFalse(self.judge("threads", [5] * 15)["judged"], "too few to judge")


class Faults(unittest.TestCase):
    def fault(self, name):
        return next(fault for fault in faults.all_faults() if fault.name == name)

    def test_a_stop_must_be_in_the_log_with_its_reason(self):
        bumper = self.fault("bumper")
        self.assertTrue(faults.as_stated(bumper, "1 info at rest: bumper pressed; when it is over, `heel start`\n"))
        self.assertFalse(faults.as_stated(bumper, "1 info at rest: wheels stalled; when it is over, `heel start`\n"))
        self.assertFalse(faults.as_stated(bumper, ""))

    def test_where_it_must_drive_on_a_stop_is_not_as_stated(self):
        reload = self.fault("reload")
        self.assertTrue(faults.as_stated(reload, "1 info reloaded heel.toml\n1 info at rest: camera silent (waiting)\n"))
        self.assertFalse(faults.as_stated(reload, "1 info reloaded heel.toml\n1 info at rest: control too late; when\n"))

    def test_a_run_passes_only_with_every_fault_as_stated_and_followed_again(self):
        good = {"fault": "bumper", "reasons": [], "as_stated": True, "follows_again_s": 1.0}
        soak = {"heeld_status": 0, "problem": None, "moved_at_rest": 0, "outcomes": [good],
                "growth": {"threads": {"grown": False}}}
        self.assertTrue(report.passed(soak))
        for change in ({"heeld_status": 1}, {"problem": "no"}, {"moved_at_rest": 1}, {"outcomes": []},
                       {"growth": {"threads": {"grown": True}}},
                       {"outcomes": [good, {**good, "as_stated": False}]}, {"outcomes": [{**good, "follows_again_s": None}]}):
            self.assertFalse(report.passed({**soak, **change}), change)


class LiveFaults(unittest.TestCase):
    def test_heel_sim_names_a_line_that_is_no_fault_and_goes_on(self):
        command = [HEEL_SIM, "--robot", "tcp:0", "--live-faults", "--duration", "1"]
        done = subprocess.run(command, input="dorp+1\ncamera+1\ncamera+x\nbumper+0.1=4\n", capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("fault 'dorp+1': 'dorp' is not a fault (expected one of drop", done.stderr)
        self.assertIn("fault 'camera+1': there is no camera", done.stderr)
        self.assertIn("fault bumper", done.stdout)


class ShortSoak(unittest.TestCase):
    def test_three_faults_end_as_stated(self):
        with tempfile.TemporaryDirectory(prefix="heel-soak-") as folder:
            out = pathlib.Path(folder) / "soak"
            command = [SOURCE / "tools/soak", "--minutes", f"{MINUTES:.3f}", "--faults", ",".join(THREE), "-o", out]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            soak = json.loads((out / "soak.json").read_text(encoding="utf-8"))
            self.assertTrue((out / "soak.png").exists())
        self.assertEqual({outcome["fault"] for outcome in soak["outcomes"]}, set(THREE))
        self.assertIn("left: bumper: bumper pressed; follows after", done.stdout)
        self.assertGreater(len(soak["samples"]), 5)
        self.assertIn("pose_to_tick_ms", soak["samples"][-2])
        self.assertGreater(soak["latency"]["count"], 50)


if __name__ == "__main__":
    unittest.main()
