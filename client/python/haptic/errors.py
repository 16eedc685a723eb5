"""What can go wrong for a client: one type for each thing that a program may want to do about it.

Each has the exit code with which hapticctl tells the same, so that a script can end with it:

    except haptic.Error as error:
        sys.exit(error.exit_code)
"""

from __future__ import annotations

from typing import ClassVar

from haptic import v1


class Error(Exception):
    """Base of all errors of this package; as itself, a request that failed.

    str() is one line for a person: the place in a file if there is one, the field, the message. `wire` is what the
    daemon said, or what it would have said: code, message, field, file, line, column.
    """

    code: ClassVar[v1.Error.Code] = v1.Error.FAILED
    exit_code: ClassVar[int] = 1

    def __init__(self, wire: v1.Error | str) -> None:
        self.wire = v1.Error(code=self.code, message=wire) if isinstance(wire, str) else wire
        super().__init__(_in_one_line(self.wire))


class Unreachable(Error):
    """No daemon is there, or it went away, or it does not answer, or what answers is none."""

    exit_code = 5


class NothingToDo(Error):
    """It is as was asked for already: armed, paused, ..."""

    code = v1.Error.NOTHING_TO_DO
    exit_code = 2


class NotFound(Error):
    """A name that is not in the scene, or a lease that is not held."""

    code = v1.Error.NOT_FOUND
    exit_code = 3


class Refused(Error):
    """The client's role does not allow it, or another client holds the drive lease."""

    code = v1.Error.REFUSED
    exit_code = 4


class ProtocolMismatch(Error):
    """The daemon speaks another major version of the protocol."""

    code = v1.Error.MISMATCH
    exit_code = 6


class FaultLatched(Error):
    """No force until a person has cleared the fault."""

    code = v1.Error.FAULT_LATCHED
    exit_code = 7


class Invalid(Error):
    """The request, a file, or what they carry is wrong."""

    code = v1.Error.INVALID


class Unsupported(Error):
    """A call that this daemon does not know."""

    code = v1.Error.UNSUPPORTED


class Busy(Error):
    """Too many requests; try again."""

    code = v1.Error.BUSY


_USAGE = 64  # the exit code of hapticctl for a command line, or a script, that is wrong

_TYPES = (NothingToDo, NotFound, Refused, ProtocolMismatch, FaultLatched, Invalid, Unsupported, Busy)
_TYPE_OF_CODE: dict[int, type[Error]] = {kind.code: kind for kind in _TYPES}


def error_of(wire: v1.Error) -> Error:
    """The error of the type that belongs to the code; for a code that is not known, Error itself."""
    return _TYPE_OF_CODE.get(wire.code, Error)(wire)


def error_of_exit_code(exit_code: int, message: str) -> Error:
    """The error that hapticctl tells by this exit code."""
    for kind in (Unreachable, *_TYPES):
        if kind.exit_code == exit_code != Error.exit_code:
            return kind(message)
    return Invalid(message) if exit_code == _USAGE else Error(message)


def _in_one_line(error: v1.Error) -> str:
    line = ""
    if error.file:
        line = error.file + ":"
        if error.line:
            line += f"{error.line}:"
            if error.column:
                line += f"{error.column}:"
        line += " "
    if error.field and error.field not in error.message:
        line += error.field + ": "
    return line + error.message
