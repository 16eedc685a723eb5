"""The examples do what they say, with a hapticd of their own."""

import asyncio
import csv
import sys
import unittest
from pathlib import Path

import numpy as np

from support import ROOT, DaemonTest

EXAMPLES = ROOT / "client" / "python" / "examples"


class ExampleTest(DaemonTest):
    async def example(self, name: str, *arguments: str | Path) -> str:
        """What it prints."""
        process = await asyncio.create_subprocess_exec(
            sys.executable, "-B", EXAMPLES / name, "--socket", self.socket, *arguments,
            stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE)
        output, errors = await process.communicate()
        self.assertEqual(process.returncode, 0, errors.decode())
        return output.decode()


class Examples(ExampleTest):
    async def test_a_recording_has_what_the_device_did(self) -> None:
        await self.pressed()
        await self.example("record.py", "--seconds", "0.2", self.folder / "take.npz")
        with np.load(self.folder / "take.npz") as take:
            frames = len(take["tick"])
            self.assertGreater(frames, 1)
            np.testing.assert_allclose(take["time"], (take["tick"] - take["tick"][0]) / 1000)
            self.assertLess(take["time"][-1], 0.2)
            np.testing.assert_array_equal(take["device_position"], frames * [[[0.001, 0.01, 0.002]]])
            np.testing.assert_allclose(take["hip_force"], frames * [[[0, 1, 0]]], atol=1e-3)
            self.assertEqual(take["object_orientation"].shape, (frames, 1, 4))
            self.assertEqual(take["gap"].shape[1], 2)

    async def test_the_force_is_shown_in_lines(self) -> None:
        await self.pressed()
        output = await self.example("plot_force.py", "--seconds", "0.2", "--full", "2")
        self.assertRegex(output, r"thumb +1\.000 N \|#{25} {25}\|")

    async def test_the_force_is_drawn_in_a_picture(self) -> None:
        await self.pressed()
        await self.example("plot_force.py", "--seconds", "0.2", "--picture", self.folder / "force.svg")
        self.assertIn("</svg>", (self.folder / "force.svg").read_text())

    async def test_a_daemon_that_is_not_there_is_told_by_the_exit_code(self) -> None:
        process = await asyncio.create_subprocess_exec(
            sys.executable, "-B", EXAMPLES / "record.py", "--socket", "/nowhere/hapticd.sock", "x.npz",
            stderr=asyncio.subprocess.PIPE)
        _, errors = await process.communicate()
        self.assertEqual(process.returncode, 5)
        self.assertIn(b"is hapticd running", errors)


class Experiment(ExampleTest):
    def start(self) -> None:
        text = (EXAMPLES / "friction.txtpb").read_text(encoding="utf-8")
        for name in ("stroke.csv", "../../../config/scenes/friction.scene.txtpb"):
            text = text.replace(f'"{name}"', f'"{(EXAMPLES / name).resolve()}"')
        (self.folder / "hapticd.txtpb").write_text(text + self.make_listen())
        super().start()

    async def test_what_a_finger_feels_is_the_friction_that_was_set(self) -> None:
        table = self.folder / "trials.csv"
        await self.example("friction_experiment.py", "--coefficients", "0.1,0.3", "--samples", "50", "--csv", table)
        with table.open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({row["friction"] for row in rows}, {"0.1", "0.3"})
        for row in rows:
            # the first tick of a slip still has the force that it was held with, a fifth more
            self.assertAlmostEqual(float(row["ratio_mean"]), float(row["friction"]), delta=0.02)


if __name__ == "__main__":
    unittest.main()
