"""Beside what pyproject.toml says: the modules of the schema are made by protoc when the package is built."""

import subprocess
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

SCHEMA = Path(__file__).resolve().parents[2] / "proto"


class BuildWithSchema(build_py):
    """Puts haptic/v1/*_pb2.py, with type hints beside them, into the package that is built."""

    def run(self):
        super().run()
        protos = sorted((SCHEMA / "haptic" / "v1").glob("*.proto"))
        if not protos:
            raise SystemExit(f"there is no schema in {SCHEMA}: build the package within the tree of hapticd")
        target = self.build_lib
        subprocess.run(
            ["protoc", f"-I{SCHEMA}", f"--python_out={target}", f"--pyi_out={target}", *map(str, protos)], check=True)


setup(cmdclass={"build_py": BuildWithSchema})
