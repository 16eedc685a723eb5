"""The example scripts, run as their comments tell, against the daemon of the demonstration.

HAPTICD and HAPTICCTL name the programs.
"""

import csv
import os
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PATIENCE = 60.0  # s, for the daemon to answer


class ExampleScripts(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.socket = self.folder / "hapticd.sock"
        self.daemon = subprocess.Popen(
            [os.environ["HAPTICD"], "run", "--config", ROOT / "config/demo.txtpb", "--socket", self.socket],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(self.daemon.wait)
        self.addCleanup(self.daemon.terminate)
        deadline = time.monotonic() + PATIENCE
        while self.ctl("status").returncode != 0:
            self.assertLess(time.monotonic(), deadline, "the daemon does not answer")
            time.sleep(0.1)

    def ctl(self, *arguments):
        return subprocess.run([os.environ["HAPTICCTL"], "--socket", self.socket, *arguments], cwd=ROOT,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)

    def run_script(self, name, *arguments):
        done = self.ctl("run", f"config/scripts/{name}.script", *arguments)
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_a_shelf_is_built_in_a_scene_that_runs(self):
        self.run_script("shelf")

    def test_an_experiment_leaves_a_recording_and_its_tables(self):
        out = self.folder / "trial"
        self.run_script("experiment", "--define", f"out={out}", "--define", "viscosities=0.8")
        with open(f"{out}-0.8.csv", encoding="utf-8", newline="") as file:
            heights = [float(row["y"]) for row in csv.DictReader(file)]
        self.assertAlmostEqual(heights[0], 0.05, places=6)  # m; where the script has put it
        self.assertGreater(max(heights), 0.08)  # m; what the script has waited for
        self.assertTrue(Path(f"{out}-0.8.h5").exists())
        replayed = self.ctl("replay", f"{out}-0.8.mcap")
        self.assertEqual(replayed.returncode, 0, replayed.stdout)


if __name__ == "__main__":
    unittest.main()
