"""The package can be installed from the tree, with nothing from the network."""

import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from support import ROOT


class Install(unittest.TestCase):
    def test_pip_installs_it_with_the_schema(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            # a copy, because a build leaves its traces in the tree that it builds
            folder = Path(name)
            for part in ("client/python", "proto"):
                shutil.copytree(ROOT / part, folder / "tree" / part)
            pip = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check", "--no-cache-dir", "install",
                   "--no-build-isolation", "--no-index", "--no-deps", "--target", str(folder / "installed"),
                   str(folder / "tree" / "client" / "python")]
            done = subprocess.run(pip, capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            script = "import haptic; print(haptic.__file__, haptic.v1.Scene(name='installed').name, haptic.__version__)"
            told = subprocess.run(
                [sys.executable, "-c", script], check=True, capture_output=True, text=True,
                env={"PYTHONPATH": str(folder / "installed")}).stdout
            self.assertEqual(
                told.split()[:2], [str(folder / "installed" / "haptic" / "__init__.py"), "installed"])
            metadata = next((folder / "installed").glob("haptic-*.dist-info")) / "METADATA"
            self.assertIn(f"Version: {told.split()[2]}\n", metadata.read_text(encoding="utf-8"))
            self.assertTrue((folder / "installed" / "haptic" / "py.typed").exists())


if __name__ == "__main__":
    unittest.main()
