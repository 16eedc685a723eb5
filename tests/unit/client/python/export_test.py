"""What hapticctl exports of a recording is what was recorded, to the bit."""

import csv
import subprocess
import tempfile
import unittest
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from support import HAPTICCTL, HAPTICD, ROOT

CONFIG = ROOT / "config" / "grasp.txtpb"
SHARED = ("hips", "objects", "devices")
DURATION = 1.1  # s; the fingertips hold the box from 0.4 s on, and lift it from 1 s on


def read_csv(file: Path) -> list[dict[str, str]]:
    with file.open(newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def hapticctl(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([HAPTICCTL, *map(str, arguments)], capture_output=True, text=True)


class Export(unittest.TestCase):
    folder: Path
    recording: Path

    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.recording = cls.folder / "demo.mcap"
        tables = [f"--{topic}-csv={cls.folder / topic}.simulated.csv" for topic in SHARED]
        subprocess.run(
            [HAPTICD, "simulate", "--config", str(CONFIG), "--duration", str(DURATION), "--record", str(cls.recording),
             *tables], check=True, capture_output=True)

    def export(self, name: str, *arguments: str | Path) -> Path:
        file = self.folder / name
        done = hapticctl("export", self.recording, "-o", file, "--force", *arguments)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return file

    def test_csv_is_what_simulate_writes_itself(self) -> None:
        for topic in SHARED:
            with self.subTest(topic):
                simulated = read_csv(self.folder / f"{topic}.simulated.csv")
                exported = read_csv(self.export(f"{topic}.csv", "--topic", topic))
                self.assertGreater(len(simulated), 1000)
                self.assertEqual(list(exported[0])[: len(simulated[0])], list(simulated[0]))
                shared = [{name: row[name] for name in simulated[0]} for row in exported]
                self.assertTrue(shared == simulated)

    def test_contacts_are_the_rows_of_hips_that_are_held(self) -> None:
        contacts = read_csv(self.export("contacts.csv", "--topic", "contacts"))
        hips = [row for row in read_csv(self.export("hips.csv", "--topic", "hips")) if row["object"]]
        self.assertIn("Sur", {row["state"] for row in contacts})
        self.assertTrue([{name: row[name] for name in contacts[0]} for row in hips] == contacts)

    def test_hdf5_has_the_same_numbers_and_names_as_csv(self) -> None:
        with h5py.File(self.export("all.h5")) as file:
            self.assertEqual(file.attrs["rate_hz"], 1000.0)
            for topic in (*SHARED, "contacts"):
                rows = read_csv(self.export(f"{topic}.csv", "--topic", topic))
                group = file[topic]
                self.assertEqual(group.attrs["rows"], len(rows))
                columns = 0
                for name, dataset in group.items():
                    if name.endswith("_names"):
                        continue
                    headers = dataset.attrs["columns"].split(",")
                    columns += len(headers)
                    texts = [[row[header] for header in headers] for row in rows]
                    self.compare(group, dataset, texts)
                self.assertEqual(columns, len(rows[0]))

    def compare(self, group: Any, dataset: Any, texts: list[list[str]]) -> None:
        values = dataset[()].reshape(len(texts), -1)
        if "names" in dataset.attrs:
            names = group[dataset.attrs["names"]].asstr()[()]
            self.assertEqual([names[code] for code in values[:, 0]], [row[0] for row in texts])
        else:
            kind = np.float64 if values.dtype == np.float64 else np.uint64
            np.testing.assert_array_equal(values, np.array(texts).astype(kind))
        self.assertIsNotNone(dataset.chunks)
        self.assertEqual(dataset.compression, "gzip")

    def test_hdf5_tells_units_and_frames(self) -> None:
        with h5py.File(self.export("objects.h5", "--topic", "objects")) as file:
            self.assertEqual(list(file), ["objects"])
            position, time = file["objects/position"], file["objects/time"]
            self.assertEqual(position.shape[1], 3)
            self.assertEqual((position.attrs["unit"], position.attrs["frame"], position.attrs["columns"]),
                             ("m", "world", "x,y,z"))
            self.assertEqual(time.attrs["unit"], "s")
            self.assertEqual(file["objects/torque"].attrs["unit"], "N m")

    def test_a_part_is_from_the_first_tick_up_to_before_the_last(self) -> None:
        for limits in (("0.5s", "1s"), ("500ms", "1000ms"), ("0.5", "1")):
            rows = read_csv(self.export("part.csv", "--topic", "devices", "--from", limits[0], "--to", limits[1]))
            self.assertEqual((rows[0]["tick"], rows[-1]["tick"]), ("500", "999"))

    def test_what_cannot_be_exported_is_told_and_leaves_nothing(self) -> None:
        there = self.folder / "there.csv"
        there.write_text("mine")
        cases: list[tuple[int, str, list[str | Path]]] = [
            (3, "there is no", [self.folder / "missing.mcap", "-o", self.folder / "x.h5"]),
            (3, "has no gaps", [self.recording, "--topic", "gaps", "-o", self.folder / "x.csv"]),
            (1, "is there already", [self.recording, "--topic", "hips", "-o", there]),
            (64, "a CSV file holds one topic", [self.recording, "-o", self.folder / "x.csv"]),
            (64, "is not after", [self.recording, "--from", "2", "--to", "1", "-o", self.folder / "x.h5"]),
            (64, "is no time", [self.recording, "--from", "soon", "-o", self.folder / "x.h5"]),
            (64, "ends in neither", [self.recording, "-o", self.folder / "x.txt"]),
            (1, "cannot be written", [self.recording, "-o", "/nowhere/x.h5"]),
            (1, "cannot be written", [self.recording, "--topic", "hips", "-o", "/nowhere/x.csv"]),
            (1, "", [CONFIG, "-o", self.folder / "x.h5"]),
        ]
        for code, message, arguments in cases:
            with self.subTest(message):
                done = hapticctl("export", *arguments)
                self.assertEqual(done.returncode, code, done.stderr)
                self.assertIn(message, done.stderr)
        self.assertEqual(there.read_text(), "mine")
        self.assertEqual(sorted(self.folder.glob("x.*")), [])


if __name__ == "__main__":
    unittest.main()
