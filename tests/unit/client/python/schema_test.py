"""The package keeps up with the schema and with what C++ says."""

import re
import subprocess
import unittest
from enum import IntEnum
from typing import Any

import haptic
from haptic import version, v1
from haptic.calls import Calls
from haptic.errors import Error, error_of, error_of_exit_code
from support import HAPTICCTL, ROOT

PROTOCOL = (ROOT / "proto" / "protocol.h").read_text(encoding="utf-8")
EXIT_CODES = (ROOT / "client" / "cli" / "exit_code.h").read_text(encoding="utf-8")


def constant(name: str) -> str:
    match = re.search(rf"{name}.*? = (.*?);", PROTOCOL, re.DOTALL)
    assert match
    return match[1]


class Schema(unittest.TestCase):
    def test_the_version_is_that_of_the_programs(self) -> None:
        told = subprocess.run([HAPTICCTL, "--version"], check=True, capture_output=True, text=True).stdout
        self.assertEqual(told.split()[-1], haptic.__version__)

    def test_the_protocol_is_that_of_the_programs(self) -> None:
        self.assertEqual(int(constant("kProtocolMajor")), version.PROTOCOL_MAJOR)
        self.assertEqual(int(constant("kProtocolMinor")), version.PROTOCOL_MINOR)
        self.assertEqual(tuple(re.findall('"(.*?)"', constant("kFeatures"))), version.FEATURES)
        self.assertEqual(constant("kReplyLimit"), "std::size_t{64} * 1024 * 1024")
        self.assertEqual(version.REPLY_LIMIT, 64 * 1024 * 1024)

    def test_enumerations_have_what_the_schema_has(self) -> None:
        pairs: list[tuple[type[IntEnum], Any]] = [
            (haptic.Topic, v1.Topic),
            (haptic.Delivery, v1.Delivery),
            (haptic.Role, v1.Role),
            (haptic.State, v1.ConstraintState),
            (haptic.FaultKind, v1.FaultKind),
            (haptic.LimitKind, v1.LimitKind),
            (haptic.EventKind, v1.Event.Kind),
        ]
        prefixes: dict[type[IntEnum], str] = {haptic.FaultKind: "FAULT_", haptic.LimitKind: "LIMIT_"}
        for ours, theirs in pairs:
            names = {
                name.removeprefix(prefixes.get(ours, "")): number
                for name, number in theirs.items()
                if not name.endswith("_UNSPECIFIED")
            }
            self.assertEqual({one.name: one.value for one in ours}, names)

    def test_each_request_has_a_method(self) -> None:
        elsewhere = {
            "subscribe": haptic.Connection.subscribe,
            "unsubscribe": haptic.Subscription.close,
            "acquire_drive": haptic.DriveLease.__aenter__,
            "release_drive": haptic.DriveLease.__aexit__,
            "heartbeat": haptic.DriveLease._beat,
        }
        renamed = {
            "get_status": "status", "list_devices": "devices", "get_scene": "scene", "get_stats": "stats",
            "edit_scene": "edit", "get_state": "state", "list_faults": "faults",
        }
        descriptor = v1.Request.DESCRIPTOR
        for call in descriptor.oneofs_by_name["call"].fields:
            if call.name not in elsewhere:
                self.assertTrue(hasattr(Calls, renamed.get(call.name, call.name)), call.name)

    def test_each_edit_has_a_function(self) -> None:
        descriptor = v1.SceneEdit.DESCRIPTOR
        for edit in descriptor.oneofs_by_name["edit"].fields:
            self.assertTrue(callable(getattr(haptic.edits, edit.name)), edit.name)


class Errors(unittest.TestCase):
    def test_each_code_has_its_type(self) -> None:
        for name, code in v1.Error.Code.items():
            kind = type(error_of(v1.Error(code=code)))
            spelt = re.sub(r"(?<!^)([A-Z])", r"_\1", kind.__name__).upper()
            expected = {"UNSPECIFIED": "ERROR", "FAILED": "ERROR", "MISMATCH": "PROTOCOL_MISMATCH"}.get(name, name)
            self.assertEqual(spelt, expected)

    def test_exit_codes_are_those_of_hapticctl(self) -> None:
        codes = {name: int(code) for name, code in re.findall(r"k(\w+) = (\d+)", EXIT_CODES)}
        for kind in (haptic.NothingToDo, haptic.NotFound, haptic.Refused, haptic.Unreachable, haptic.ProtocolMismatch,
                     haptic.FaultLatched):
            self.assertEqual(kind.exit_code, codes[kind.__name__])
            self.assertIs(type(error_of_exit_code(kind.exit_code, "")), kind)
        self.assertEqual(haptic.Error.exit_code, codes["Failed"])
        self.assertIs(type(error_of_exit_code(codes["Failed"], "")), haptic.Error)
        self.assertIs(type(error_of_exit_code(codes["Usage"], "")), haptic.Invalid)

    def test_an_error_is_one_line_with_its_place(self) -> None:
        wire = v1.Error(code=v1.Error.INVALID, message="0 is out of range", field="object[0].shape.box.size.x",
                        file="a.scene.txtpb", line=7, column=3)
        self.assertEqual(str(error_of(wire)), "a.scene.txtpb:7:3: object[0].shape.box.size.x: 0 is out of range")
        self.assertEqual(str(Error("no")), "no")


if __name__ == "__main__":
    unittest.main()
