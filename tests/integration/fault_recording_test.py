"""What is left after a fault: the recording of what came before, the list of faults, the log and the numbers, all of a
real daemon whose devices fail on purpose.

HAPTICD and HAPTICCTL name the programs.
"""

import json
import os
import resource
import socket
import subprocess
import tempfile
import time
import unittest
import urllib.error
import urllib.request
from pathlib import Path

from prometheus_client.parser import text_string_to_metric_families

ROOT = Path(__file__).resolve().parents[2]
PATIENCE = 60.0  # s, for what takes a moment on a machine that has nothing else to do
TICK_RATE = 1000  # Hz

# Two hands hold a box from the beginning; then the left one's position is no number.
CONFIG = """
device {{
  name: "left" simulated {{
    mass: 0.1 damping: 1.0 hand {{ stiffness: 300 damping: 3 path: "{root}/config/paths/demo_left.csv" repeat: true }}
    {faults}
  }}
}}
device {{
  name: "right" simulated {{
    mass: 0.1 damping: 1.0 hand {{ stiffness: 300 damping: 3 path: "{root}/config/paths/demo_right.csv" repeat: true }}
  }}
}}
scene: "{root}/config/scenes/demo.scene.txtpb"
safety {{ max_missed_ticks: 1000000 }}
{more}
"""


def fault_at(seconds, duration=0.005):
    return f"fault {{ kind: NOT_A_NUMBER at: {seconds} duration: {duration} }}"


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class AfterAFault(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.socket = self.folder / "s"

    def start(self, faults="", more='flight_recorder { directory: "faults" }', environment=None, prepare=None):
        (self.folder / "hapticd.txtpb").write_text(CONFIG.format(root=ROOT, faults=faults, more=more))
        with (self.folder / "stderr").open("wb") as log:
            self.daemon = subprocess.Popen(
                [os.environ["HAPTICD"], "run", "--config", self.folder / "hapticd.txtpb", "--socket", self.socket],
                stdin=subprocess.DEVNULL, stdout=log, stderr=log, env={**os.environ, **(environment or {})},
                preexec_fn=prepare)
        self.addCleanup(self.daemon.wait)
        self.addCleanup(self.daemon.terminate)
        self.wait_for(lambda: self.ctl("status").returncode == 0)

    def log(self):
        return (self.folder / "stderr").read_text(encoding="utf-8")

    def wait_for(self, is_so):
        deadline = time.monotonic() + PATIENCE
        while not (result := is_so()):
            self.assertIsNone(self.daemon.poll(), self.log())
            self.assertLess(time.monotonic(), deadline, self.log())
            time.sleep(0.05)
        return result

    def ctl(self, *arguments):
        return subprocess.run([os.environ["HAPTICCTL"], "--socket", self.socket, *arguments],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)

    def faults(self):
        listed = self.ctl("faults", "--json")
        self.assertEqual(listed.returncode, 0, listed.stdout)
        return [json.loads(line) for line in listed.stdout.splitlines()]

    def recordings(self):
        return sorted(path.name for path in (self.folder / "faults").glob("*"))

    def test_what_came_before_is_recorded_and_is_replayed_to_the_bit(self):
        self.start(fault_at(3.5))
        (fault,) = self.wait_for(lambda: [one for one in self.faults() if one["recording"]])
        self.assertEqual(fault["fault"]["kind"], "FAULT_NOT_FINITE")
        self.assertEqual(fault["fault"]["device"], "left")
        self.assertTrue(fault["latched"])
        self.assertAlmostEqual(int(fault["realtime_ns"]) * 1e-9, time.time(), delta=PATIENCE)
        path, tick = fault["recording"], int(fault["fault"]["tick"])
        self.assertRegex(Path(path).name, r"^fault-\d{8}T\d{6}\.\d{3}Z-not_finite\.mcap$")

        replayed = self.ctl("replay", "--json", path)
        self.assertEqual(replayed.returncode, 0, replayed.stdout)
        replay = json.loads(replayed.stdout)
        self.assertIsNone(replay["difference"])
        self.assertEqual(replay["damage"], "")
        self.assertLessEqual(replay["first_tick"], tick - 2 * TICK_RATE)
        self.assertGreaterEqual(replay["last_tick"], tick + TICK_RATE // 10)
        if not replay["gaps"]:  # a busy machine may lose ticks on their way
            self.assertGreaterEqual(replay["compared"], 2 * TICK_RATE + 1)

        info = json.loads(self.ctl("info", "--json", path).stdout)
        self.assertTrue(info["whole"])
        topics = {channel["topic"] for channel in info["channels"]}
        for topic in ("objects", "hips", "devices", "inputs", "events", "state", "scene", "device_list"):
            self.assertIn(f"/haptic/{topic}", topics)
        table = self.folder / "hips.csv"
        exported = self.ctl("export", path, "--topic", "hips", "-o", str(table))
        self.assertEqual(exported.returncode, 0, exported.stdout)
        self.assertGreater(len(table.read_text().splitlines()), 2 * TICK_RATE)

    def test_each_fault_has_a_file_and_the_newest_stay(self):
        # again and again, since one that comes before the last one was cleared is none
        self.start(" ".join(fault_at(at) for at in range(1, 60)), 'flight_recorder { directory: "faults" keep: 2 }')
        for count in (1, 2):
            self.wait_for(lambda: len([one for one in self.faults() if one["recording"]]) == count)
            self.assertEqual(self.ctl("clear").returncode, 0)
        self.wait_for(lambda: len([one for one in self.faults() if one["recording"]]) == 3)
        faults = self.faults()
        self.assertEqual([one["latched"] for one in faults], [False, False, True])
        self.assertEqual(self.recordings(), [Path(one["recording"]).name for one in faults[1:]])

    def test_faults_are_told_in_words(self):
        self.start(fault_at(0.5))
        self.wait_for(lambda: [one for one in self.faults() if one["recording"]])
        told = self.ctl("faults").stdout
        self.assertIn("left: not finite (tick ", told)
        self.assertIn("LATCHED", told)
        self.assertIn("was no number", told)
        self.assertIn(str(self.folder / "faults" / "fault-"), told)
        self.assertIn("hapticctl clear", told)

    def serves_without_a_recording(self):
        (fault,) = self.wait_for(self.faults)
        time.sleep(1.0)
        self.assertEqual(fault["recording"], "")
        self.assertEqual(self.ctl("clear").returncode, 0)
        self.assertEqual(self.ctl("status").returncode, 0)

    def test_the_daemon_serves_where_the_folder_cannot_be_made(self):
        self.start(fault_at(1.0), 'flight_recorder { directory: "hapticd.txtpb/faults" }')
        self.serves_without_a_recording()
        self.assertIn("cannot be made: Not a directory", self.log())

    def test_the_daemon_serves_where_the_disk_is_full(self):
        # a limit of the size of files is to the daemon what a full disk is
        self.start(fault_at(1.0), prepare=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000)))
        self.serves_without_a_recording()
        self.assertIn("the fault is not recorded: ", self.log())
        self.assertEqual(self.recordings(), [])

    def test_without_a_folder_nothing_is_written(self):
        self.start(fault_at(0.5), more="", environment={"LOGS_DIRECTORY": ""})
        self.serves_without_a_recording()

    def test_recordings_go_where_the_service_manager_says(self):
        logs = self.folder / "logs"
        logs.mkdir()
        self.start(fault_at(0.5), more="", environment={"LOGS_DIRECTORY": str(logs)})
        (fault,) = self.wait_for(lambda: [one for one in self.faults() if one["recording"]])
        self.assertEqual(Path(fault["recording"]).parent, logs / "faults")

    def test_the_log_file_tells_of_the_fault(self):
        self.start(fault_at(0.5), 'log { file: "hapticd.log" level: WARNING }')
        self.wait_for(self.faults)
        text = self.wait_for(lambda: (self.folder / "hapticd.log").read_text(encoding="utf-8"))
        self.assertRegex(text, r"\d{4}-\d\d-\d\dT.* warning tick \d+: fault latched: left: ")

    def test_the_numbers_are_read_by_prometheus(self):
        port = free_port()
        self.start(fault_at(0.5), f"metrics {{ port: {port} }}")
        self.wait_for(self.faults)
        url = f"http://127.0.0.1:{port}/metrics"
        with urllib.request.urlopen(url, timeout=PATIENCE) as answer:
            self.assertTrue(answer.headers["Content-Type"].startswith("text/plain; version=0.0.4"))
            scraped = answer.read().decode()
        printed = self.ctl("stats", "--prometheus")
        self.assertEqual(printed.returncode, 0, printed.stdout)
        for text in (scraped, printed.stdout):
            families = {one.name: one for one in text_string_to_metric_families(text)}
            for family in families.values():
                self.assertTrue(family.name.startswith("hapticd_"), family.name)
                self.assertTrue(family.documentation, family.name)
                self.assertIn(family.type, ("gauge", "counter", "histogram"), family.name)
            faults = {one.labels["kind"]: one.value for one in families["hapticd_faults"].samples}
            self.assertEqual(faults["not_finite"], 1.0)
            self.assertEqual(faults["over_speed"], 0.0)
            self.assertEqual(families["hapticd_faults_latched"].samples[0].value, 1.0)
            self.assertEqual({one.labels["device"] for one in families["hapticd_device_sample_age_seconds"].samples},
                             {"left", "right"})
            self.check_histogram([one for one in families["hapticd_stage_seconds"].samples
                                  if one.labels["stage"] == "tick"])
            self.check_histogram(families["hapticd_wakeup_lateness_seconds"].samples)
        self.assertEqual([one.name for one in text_string_to_metric_families(scraped)],
                         [one.name for one in text_string_to_metric_families(printed.stdout)])

    def check_histogram(self, samples):
        buckets = [(float(one.labels["le"]), one.value) for one in samples if one.name.endswith("_bucket")]
        self.assertEqual(buckets, sorted(buckets), "bounds and counts ascend")
        self.assertEqual(buckets[-1][0], float("inf"))
        (count,) = [one.value for one in samples if one.name.endswith("_count")]
        (total,) = [one.value for one in samples if one.name.endswith("_sum")]
        self.assertGreater(count, 0)
        self.assertEqual(buckets[-1][1], count)
        self.assertGreater(total, 0.0)

    def test_there_is_no_other_page(self):
        port = free_port()
        self.start(more=f"metrics {{ port: {port} }}")
        with self.assertRaises(urllib.error.HTTPError) as refused:
            urllib.request.urlopen(f"http://127.0.0.1:{port}/", timeout=PATIENCE)
        self.assertEqual(refused.exception.code, 404)
        refused.exception.close()


if __name__ == "__main__":
    unittest.main()
