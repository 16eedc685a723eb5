"""Scripts of hapticctl, run beside the program: one verb a line, with wait, expect and loops (see hapticctl(1))."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Mapping

from haptic.address import Identity
from haptic.errors import Error, error_of_exit_code


async def run_script(
    script: str | os.PathLike[str] = "-",
    *,
    text: str = "",
    variables: Mapping[str, object] | None = None,
    address: str | os.PathLike[str] = "",
    identity: Identity | None = None,
    hapticctl: str | os.PathLike[str] = "hapticctl",
) -> str:
    """Runs a script file, or the lines of `text`, and returns what it printed.

    `variables` are those that the script's own `set` does not change. `address` and `identity` are as for connect(). If
    the task is cancelled, the script is ended. Raises the error that belongs to the line that failed, Invalid for a
    script that is wrong, and Error if there is no hapticctl.
    """
    arguments = [os.fspath(hapticctl), "run", os.fspath(script)]
    arguments += [f"--define={name}={value}" for name, value in (variables or {}).items()]
    if address:
        arguments += ["--socket", os.fspath(address)]
    if identity:
        arguments += ["--certificate", identity.certificate, "--key", identity.key, "--authority", identity.authority]
    pipe = asyncio.subprocess.PIPE
    try:
        process = await asyncio.create_subprocess_exec(*arguments, stdin=pipe, stdout=pipe, stderr=pipe)
    except OSError as error:
        raise Error(f"cannot run {os.fspath(hapticctl)}: {error.strerror}") from error
    try:
        output, complaint = await process.communicate(text.encode())
    except asyncio.CancelledError:
        process.terminate()
        await process.wait()
        raise
    if process.returncode:
        message = complaint.decode(errors="replace").strip() or f"hapticctl ended with {process.returncode}"
        raise error_of_exit_code(process.returncode, message.removeprefix("hapticctl: "))
    return output.decode(errors="replace")
