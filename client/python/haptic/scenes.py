"""Scenes: files, and what is where in the one that runs.

A scene file is the message v1.Scene in protobuf text format, or in JSON if its name ends in .json.
"""

from __future__ import annotations

import os
import re
from pathlib import Path

from google.protobuf import json_format, text_format

from haptic import v1
from haptic.errors import Error, Invalid, NotFound

_HEAD = "# proto-file: haptic/v1/scene.proto\n# proto-message: haptic.v1.Scene\n"


def read_scene(path: str | os.PathLike[str]) -> v1.Scene:
    """Raises NotFound if it cannot be read, Invalid with line and column if it is no scene."""
    file = Path(path)
    try:
        text = file.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise Invalid(_wrong(file, f"is not UTF-8 at byte {error.start}")) from error
    except OSError as error:
        raise NotFound(f"cannot read {file}: {error.strerror}") from error
    try:
        scene = v1.Scene()
        if file.suffix == ".json":
            json_format.Parse(text, scene)
        else:
            text_format.Parse(text, scene)
        return scene
    except text_format.ParseError as error:
        message = re.sub(r"^\d+:\d+ : ", "", str(error))
        raise Invalid(_wrong(file, message, error.GetLine() or 0, error.GetColumn() or 0)) from error
    except json_format.ParseError as error:
        raise Invalid(_wrong(file, str(error))) from error


def write_scene(scene: v1.Scene, path: str | os.PathLike[str]) -> None:
    """Replaces the file if there is one. Raises Error if it cannot be written."""
    file = Path(path)
    if file.suffix == ".json":
        text = json_format.MessageToJson(scene, preserving_proto_field_name=True) + "\n"
    else:
        text = _HEAD + text_format.MessageToString(scene)
    try:
        file.write_text(text, encoding="utf-8")
    except OSError as error:
        raise Error(f"cannot write {file}: {error.strerror}") from error


def hips_of(scene: v1.SceneDescription, finger: str) -> slice:
    """The rows of a finger in Hips, if the subscription does not select. Raises NotFound."""
    for one in scene.finger:
        if one.name == finger:
            return slice(one.first_hip, one.first_hip + one.hips)
    raise NotFound(f'there is no finger "{finger}" in the scene')


def object_index(scene: v1.SceneDescription, name: str) -> int:
    """The row of an object in Objects, if the subscription does not select. Raises NotFound."""
    for index, one in enumerate(scene.object):
        if one.name == name:
            return index
    raise NotFound(f'there is no object "{name}" in the scene')


def _wrong(file: Path, message: str, line: int = 0, column: int = 0) -> v1.Error:
    return v1.Error(code=v1.Error.INVALID, message=message, file=str(file), line=line, column=column)
