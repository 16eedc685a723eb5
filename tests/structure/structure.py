#!/usr/bin/env python3
"""Checks what the compiler does not: that the rooms of the tree stay apart.

usage: structure.py ROOT    prints each violation as "path:line: what is wrong"; exit code 1 if there is any

Which room may include which is the table ROOMS: the include graph of the project, with no arrow back. The
quiet rooms, those that a servo tick runs through, also have words and headers that they may not use.
"""

import re
import sys
from dataclasses import dataclass
from pathlib import Path

TOP_FOLDERS = ("daemon", "drivers", "client", "proto", "tests")
MAX_LINES = 600


@dataclass(frozen=True)
class Room:
    """What the files of one folder may include, apart from each other and the standard library."""

    ours: tuple = ()  # folders with all below them, or single headers
    libraries: tuple = ()  # prefixes of <...> includes; "posix" stands for the system's C headers


# The most exact path wins: drivers/device.h is a room of its own within drivers.
ROOMS = {
    "daemon/engine": Room(libraries=("glm/",)),
    "daemon/rt": Room(libraries=("posix",)),
    "daemon/safety": Room(libraries=("glm/",)),
    "daemon/servo": Room(
        ours=("daemon/engine", "daemon/rt", "daemon/safety", "drivers/device.h"),
        libraries=("glm/", "boost/lockfree/"),
    ),
    "daemon/load": Room(
        ours=("daemon/engine", "drivers/path.h", "schema"),
        libraries=("glm/", "google/protobuf/", "fmt/", "posix"),
    ),
    "daemon/ipc": Room(
        ours=(
            "daemon/servo/mailbox.h",
            "daemon/servo/prepare_scene.h",
            "daemon/engine",
            "daemon/safety",
            "daemon/load/embedded_mesh.h",
            "daemon/load/error.h",
            "daemon/load/state_message.h",
            "daemon/flight",
            "daemon/log/fields.h",
            "proto",
            "schema",
        ),
        libraries=("glm/", "google/protobuf/", "boost/", "spdlog/", "fmt/", "posix"),
    ),
    # recordings of faults; knows neither sockets nor the servo thread
    "daemon/flight": Room(
        ours=("daemon/engine", "daemon/load/embedded_mesh.h", "proto/recording", "schema"),
        libraries=("fmt/", "posix"),
    ),
    "daemon/log": Room(ours=("schema",), libraries=("spdlog/", "posix")),
    "daemon/service": Room(libraries=("spdlog/", "posix")),
    "daemon/setup": Room(ours=("daemon/servo", "daemon/rt", "daemon/load", "drivers", "schema")),
    "daemon/replay": Room(
        ours=("daemon/servo", "daemon/load", "daemon/engine", "daemon/safety", "drivers/device.h", "schema"),
        libraries=("glm/", "google/protobuf/"),
    ),
    "daemon/simulate": Room(
        ours=(
            "daemon/setup",
            "daemon/replay",
            "daemon/servo",
            "daemon/rt",
            "daemon/load",
            "daemon/engine",
            "daemon/safety",
            "daemon/ipc/convert",
            "daemon/ipc/encode",
            "proto/csv",
            "proto/recording",
            "schema",
        ),
        libraries=("glm/", "fmt/"),
    ),
    "daemon": Room(
        ours=("daemon", "drivers", "proto", "schema"),
        libraries=("glm/", "google/protobuf/", "boost/", "spdlog/", "fmt/", "CLI/", "posix"),
    ),
    "drivers/device.h": Room(libraries=("glm/",)),
    "drivers": Room(
        ours=("drivers/device.h", "drivers/io", "daemon/rt", "proto/device"),
        libraries=("glm/", "fmt/", "posix"),
    ),
    # the ways to devices, which know no device
    "drivers/io": Room(ours=("drivers/device_error.h",)),
    "drivers/io/hid": Room(
        ours=("drivers/device.h", "drivers/device_error.h", "drivers/io/same_kind.h", "daemon/rt"),
        libraries=("hidapi/", "posix"),
    ),
    "drivers/io/phantom": Room(ours=("drivers/device_error.h",), libraries=("posix",)),
    "drivers/io/serial": Room(
        ours=("drivers/device_error.h",),
        libraries=("boost/asio", "boost/system/", "posix"),
    ),
    "drivers/io/udev": Room(
        ours=("drivers/device_error.h", "drivers/plug_monitor.h"),
        libraries=("libudev.h",),
    ),
    "drivers/io/udp": Room(
        ours=("drivers/device_error.h",),
        libraries=("boost/asio", "boost/system/"),
    ),
    "drivers/io/usb": Room(
        ours=(
            "drivers/device.h",
            "drivers/device_error.h",
            "drivers/io/same_kind.h",
            "drivers/plug_monitor.h",
            "daemon/rt",
        ),
        libraries=("libusb-1.0/", "posix"),
    ),
    "drivers/registry": Room(ours=("drivers", "schema"), libraries=("glm/", "fmt/")),
    "proto": Room(ours=("schema",), libraries=("google/protobuf/", "posix")),
    "proto/csv": Room(),
    "proto/device": Room(libraries=("posix",)),  # copied into programs that have nothing else of ours
    "proto/foxglove": Room(ours=("schema",)),
    "proto/metrics": Room(ours=("schema",)),
    "proto/recording": Room(ours=("proto/foxglove", "schema"), libraries=("google/protobuf/", "posix")),
    "client/lib": Room(ours=("proto", "schema"), libraries=("google/protobuf/", "boost/", "fmt/", "posix")),
    "client/plot": Room(
        ours=("client/lib", "client/export", "proto/recording", "schema"),
        libraries=("google/protobuf/", "fmt/", "posix"),
    ),
    "client/export": Room(
        ours=("proto/csv", "proto/recording", "schema"),
        libraries=("google/protobuf/", "fmt/", "hdf5.h", "posix"),
    ),
    # the daemon's own thread and clock: what is measured is what it would meet
    "client/latency": Room(ours=("daemon/rt",), libraries=("fmt/",)),
    "client/doctor": Room(ours=("schema",), libraries=("google/protobuf/", "fmt/", "posix")),
    "client/cli": Room(
        ours=("client/lib", "client/plot", "client/export", "client/doctor", "client/latency", "proto", "schema"),
        libraries=("google/protobuf/", "boost/", "fmt/", "CLI/", "posix"),
    ),
    "client/bridge": Room(
        ours=("client/lib", "proto", "schema"),
        libraries=("google/protobuf/", "CLI/", "nats/", "posix"),
    ),
    "client/view": Room(
        ours=("client/lib", "proto", "schema"),
        libraries=("google/protobuf/", "boost/", "CLI/", "nlohmann/", "posix"),
    ),
    "tests": Room(ours=("daemon", "drivers", "proto", "schema", "client"), libraries=("",)),
}

# Rooms that a tick runs through. Their files may neither print, wait, ask a clock nor depend on chance.
QUIET_ROOMS = ("daemon/engine", "daemon/safety", "daemon/servo", "drivers/device.h")
QUIET_FORBIDDEN_HEADERS = frozenset(
    "chrono condition_variable cstdio ctime filesystem fstream future iostream locale mutex ostream random regex "
    "semaphore shared_mutex sstream stop_token thread unordered_map unordered_set".split()
)
QUIET_FORBIDDEN_WORDS = re.compile(
    r"\b(std::(?:cout|cerr|clog|mutex|jthread|thread|rand|getenv|system|async)\b|thread_local\b)|"
    r"(?<![\w.>:])((?:printf|fprintf|malloc|calloc|free|rand|usleep|nanosleep|sleep|clock_gettime|getenv)\s*\()"
)

# Files of the engine that only run before a scene is handed to the servo thread: they may throw, and compose words.
BUILD_TIME = frozenset(
    "body box_tree cell_builder cell_complex cell_topology delaunay extrusion finger icosphere mesh_check polygon "
    "scene shapes".split()
)
BUILD_TIME_HEADERS = frozenset("sstream unordered_map".split())

UNFINISHED = re.compile(r"\b(TODO|FIXME|XXX|HACK)\b")
COMMENT_OR_STRING = re.compile(
    r"""R"(?P<delimiter>[^(\s"\\]{0,16})\(.*?\)(?P=delimiter)"|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])+'|//[^\n]*|/\*.*?\*/""",
    re.DOTALL,
)
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.MULTILINE)


def blank(text, keep_strings):
    """Replaces comments, and strings if not kept, by spaces; lines keep their numbers."""

    def replace(match):
        token = match.group(0)
        if keep_strings and not token.startswith(("//", "/*")):
            return token
        return re.sub(r"[^\n]", " ", token)

    return COMMENT_OR_STRING.sub(replace, text)


def line_of(text, offset):
    return text.count("\n", 0, offset) + 1


def room_of(path):
    """The name in ROOMS of the file at `path`, relative to the root; None if there is none."""
    stem = path.rsplit(".", 1)[0]
    candidates = [room for room in ROOMS if path == room or stem == room or path.startswith(room + "/")]
    best = max(candidates, key=len, default=None)
    # a folder without a row is not covered by the row of the folder above
    if best == "daemon" and path.count("/") > 1:
        return None
    return best


def find(root, including, name):
    """The file that #include "name" means, relative to the root; "schema" for generated ones; None if there is none."""
    if name.startswith(("haptic/v1/", "foxglove/")) and name.endswith(".pb.h"):
        return "schema" if (root / "proto" / (name[: -len(".pb.h")] + ".proto")).is_file() else None
    beside = str(Path(including).parent / name)
    for candidate in (beside, name, "daemon/" + name):
        if (root / candidate).is_file():
            return candidate
    return None


def may_include(room, target):
    """Whether files of `room` may include the file `target`."""
    if target == "schema" or room_of(target) != room:
        return any(target == allowed or target.startswith((allowed + "/", allowed + ".")) for allowed in ROOMS[room].ours)
    return True


def is_build_time(path):
    return room_of(path) == "daemon/engine" and Path(path).stem in BUILD_TIME


def library_problem(path, room, header):
    if "/" in header or header.endswith((".h", ".hpp")):
        is_posix = header.endswith(".h") and not header.startswith(
            ("boost/", "google/", "spdlog/", "fmt/", "glm/", "libusb-1.0/", "hidapi/")
        )
        for allowed in ROOMS[room].libraries:
            if header.startswith(allowed) or (allowed == "posix" and is_posix):
                return None
        return f"{room} does not use <{header}>"
    if is_build_time(path) and header in BUILD_TIME_HEADERS:
        return None
    if room in QUIET_ROOMS and header in QUIET_FORBIDDEN_HEADERS:
        return f"{room} is part of a tick and does not use <{header}>"
    return None


def check_includes(root, path, code, problems, graph):
    room = room_of(path)
    if room is None:
        problems.append((path, 1, "is in a folder that the table of rooms in tests/structure does not know"))
        return
    for match in INCLUDE.finditer(code):
        line = line_of(code, match.start(1))
        kind, name = match.groups()
        if kind == "<":
            problem = library_problem(path, room, name)
            if problem:
                problems.append((path, line, problem))
            continue
        target = find(root, path, name)
        if target is None:
            problems.append((path, line, f'"{name}" is no file of ours'))
        elif target != "schema" and "/" not in name:
            problems.append((path, line, f'"{name}" is not named from the top of the tree or of daemon'))
        elif not may_include(room, target):
            problems.append((path, line, f"{room} may not include {target}"))
        if target is not None:
            graph.setdefault(path, []).append(target)


def check_own_header_first(root, path, code, problems):
    """A source that includes its header first proves that the header compiles alone."""
    header = path[: -len(".cpp")] + ".h"
    if not path.endswith(".cpp") or not (root / header).is_file():
        return
    first = INCLUDE.search(code)
    if first is None or find(root, path, first.group(2)) != header:
        problems.append((path, 1, f"does not include {header} before anything else"))


USING = re.compile(r"^[ \t]*using[ \t]+[\w:]+::(\w+);", re.MULTILINE)


def check_together(path, code, problems):
    """What clang-tidy does not see in sources that are checked together: includes of sources, and unused usings."""
    for match in INCLUDE.finditer(code):
        if match.group(2).endswith((".cpp", ".cc", ".c")):
            problems.append((path, line_of(code, match.start(1)), f"includes the source {match.group(2)}"))
    if path.endswith(".cpp"):
        words = re.findall(r"\w+", blank(code, keep_strings=False))
        for match in USING.finditer(code):
            if words.count(match.group(1)) < 2:
                problems.append((path, line_of(code, match.start(1)), f"does not use {match.group(1)}"))


def check_words(path, text, problems):
    for match in UNFINISHED.finditer(text):
        problems.append((path, line_of(text, match.start()), f"{match.group(1)} is left"))
    room = room_of(path)
    if room not in QUIET_ROOMS:
        return
    code = blank(text, keep_strings=False)
    for match in QUIET_FORBIDDEN_WORDS.finditer(code):
        word = match.group(0).rstrip("( ")
        problems.append((path, line_of(code, match.start()), f"{room} is part of a tick and does not use {word}"))
    if room == "daemon/engine" and not is_build_time(path):
        for match in re.finditer(r"\b(throw|try|catch)\b", code):
            problems.append((path, line_of(code, match.start()), f"{match.group(1)} outside the files that build scenes"))


def check_listed(root, path, problems):
    """Each source stands in a CMakeLists.txt of its folder or of one above."""
    if not path.endswith(".cpp"):
        return
    source = Path(path)
    for folder in source.parents:
        lists = root / folder / "CMakeLists.txt"
        if not lists.is_file():
            continue
        text = re.sub(r"#[^\n]*", "", lists.read_text(encoding="utf-8"))
        name = re.escape(source.relative_to(folder).as_posix())
        stem = re.escape(source.relative_to(folder).with_suffix("").as_posix())
        if re.search(rf'(?<![\w./-]){name}(?![\w./-])', text) or re.search(rf"haptic_\w+\(\s*{stem}[\s)]", text):
            return
    problems.append((path, 1, "is listed in no CMakeLists.txt"))


def check_cycles(graph, problems):
    done, trail = set(), []

    def visit(path):
        if path in trail:
            circle = trail[trail.index(path) :] + [path]
            problems.append((path, 1, "is in a circle of includes: " + " -> ".join(circle)))
            return
        if path in done:
            return
        trail.append(path)
        for target in graph.get(path, ()):
            visit(target)
        trail.pop()
        done.add(path)

    for path in sorted(graph):
        visit(path)


def check_tree(root):
    """All violations below `root`, as (path, line, text), sorted."""
    root = Path(root)
    problems, graph = [], {}
    files = [file for top in TOP_FOLDERS for file in (root / top).rglob("*") if file.suffix in (".h", ".cpp")]
    if not files:
        problems.append((".", 1, "there is no source"))
    for file in sorted(files):
        path = file.relative_to(root).as_posix()
        text = file.read_text(encoding="utf-8")
        code = blank(text, keep_strings=True)
        lines = text.count("\n")
        if lines > MAX_LINES:
            problems.append((path, lines, f"has {lines} lines; {MAX_LINES} are the limit"))
        if path.endswith(".h") and not re.search(r"^#pragma once$", text, re.MULTILINE):
            problems.append((path, 1, "has no #pragma once"))
        check_includes(root, path, code, problems, graph)
        check_own_header_first(root, path, code, problems)
        check_together(path, code, problems)
        check_words(path, text, problems)
        check_listed(root, path, problems)
    check_cycles(graph, problems)
    return sorted(problems)


def main(arguments):
    if len(arguments) != 2:
        print(__doc__, file=sys.stderr)
        return 64
    problems = check_tree(arguments[1])
    for path, line, text in problems:
        print(f"{path}:{line}: {text}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
