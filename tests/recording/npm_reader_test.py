"""Recordings of heel, read and checked by the npm reader of the MCAP project (tests/recording/node)."""

import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ["HEEL_SOURCE_DIR"])
HEEL = Path(os.environ["HEEL_BUILD_DIR"]) / "bin" / "heel"
READER = SOURCE / "tests/recording/node"
SCENARIO = """name = "walk"
duration_s = 6.0
[person]
walk_after_s = 0.0
[[person.path]]
step = "straight"
length_m = 5
[robot]
x_m = -1.8
"""


@unittest.skipUnless(shutil.which("node"), "node is not installed (tools/setup installs it)")
@unittest.skipUnless((READER / "node_modules").is_dir(), "the npm packages are missing (tools/setup)")
class NpmReader(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        folder = Path(cls.folder.name)
        (folder / "walk.toml").write_text(SCENARIO, encoding="utf-8")
        model = SOURCE / "tools/heel-sim/pose_noise/pictured.toml"
        command = [HEEL, "simulate", folder / "walk.toml", "--error-model", model, "--out", folder / "run"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        cls.recording = folder / "run/run.mcap"

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def read(self, content, *options):
        path = Path(self.folder.name) / "part.mcap"
        path.write_bytes(content)
        command = ["node", READER / "read_recording.mjs", path, *options]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    def test_reads_every_message_by_index_and_from_the_beginning(self):
        read = self.read(self.recording.read_bytes())
        self.assertEqual(read.returncode, 0, read.stderr)
        counts = json.loads(read.stdout)
        self.assertEqual(counts["/heel/tick"], 301)
        self.assertEqual(counts["/heel/configuration"], 1)
        self.assertGreater(counts["/heel/pose"], 100)
        self.assertGreater(counts["/heel/wire"], 300)
        self.assertGreater(counts["/tf"], 50)
        self.assertGreater(counts["/person"], 40)

    def test_reads_pictures(self):
        folder = Path(self.folder.name)
        config = folder / "heel.toml"
        config.write_text('[telemetry]\npictures = "jpeg"\n', encoding="utf-8")
        scenario = folder / "short.toml"
        scenario.write_text(SCENARIO.replace("6.0", "0.5"), encoding="utf-8")
        command = [HEEL, "simulate", scenario, "--config", config, "--out", folder / "pictured"]
        subprocess.run(command, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        read = self.read((folder / "pictured/run.mcap").read_bytes())
        self.assertEqual(read.returncode, 0, read.stderr)
        counts = json.loads(read.stdout)
        self.assertGreater(counts["/camera"], 10)
        self.assertEqual(counts["/camera"], counts["/heel/pose"])

    def test_reads_a_recording_without_its_end(self):
        content = self.recording.read_bytes()
        read = self.read(content[: len(content) // 2], "--cut")
        self.assertEqual(read.returncode, 0, read.stderr)
        self.assertGreater(json.loads(read.stdout)["/heel/tick"], 50)

    def test_notices_damage(self):
        content = bytearray(self.recording.read_bytes())
        content[content.index(b"zstd") + 500] ^= 1
        self.assertNotEqual(self.read(bytes(content)).returncode, 0)


if __name__ == "__main__":
    unittest.main()
