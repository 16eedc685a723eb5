"""clang-tidy over what a build directory compiles of the product, each source once.

Sources that the build compiles together are checked together, as one, so that their headers are read once. What was
found clean is remembered under a hash of all that it was made of, and is not checked again.
"""

import argparse
import concurrent.futures
import hashlib
import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PRODUCT = ("daemon/", "drivers/", "client/", "proto/")
# Together, sources stand where headers do. Two checks do not go with that; tests/structure has them in its own way:
# that no source includes a source, and that each using-declaration is used.
TOGETHER = [
    "--header-filter=/(daemon|drivers|client|proto|tests)/[^.]*\\.(h|cpp)$",
    "--checks=-bugprone-suspicious-include,-misc-unused-using-decls",
]
UNITY_INCLUDE = re.compile(r'^#include "([^"]+)"$', re.MULTILINE)


def sources_of(entry):
    """The sources that a compile command is of, relative to the root."""
    file = Path(entry["directory"], entry["file"])
    if "/Unity/unity_" in str(file):
        sources = UNITY_INCLUDE.findall(file.read_text(encoding="utf-8"))
    else:
        sources = [str(file)]
    return [os.path.relpath(source, ROOT) for source in sources]


def dependencies(build):
    """What each object of the build was made of, as ninja remembers it: absolute paths."""
    made_of, current = {}, None
    output = subprocess.run(["ninja", "-C", build, "-t", "deps"], check=True, capture_output=True, text=True).stdout
    for line in output.splitlines():
        if line.startswith("    ") and current is not None:
            current.append(os.path.normpath(Path(build, line.strip())))
        elif ": #deps" in line:
            current = made_of.setdefault(line.split(": #deps")[0], [])
    return made_of


class Fingerprint:
    """Hashes of files; those of the system by size and time."""

    def __init__(self):
        version = subprocess.run(["clang-tidy", "--version"], check=True, capture_output=True, text=True).stdout
        self._known = {}
        self._common = version + (ROOT / ".clang-tidy").read_text(encoding="utf-8") + repr(TOGETHER)

    def _of_file(self, path):
        if path not in self._known:
            if path.startswith(str(ROOT) + "/"):
                content = Path(path).read_bytes().replace(os.fsencode(ROOT), b"")
                self._known[path] = hashlib.sha256(content).hexdigest()
            else:
                status = os.stat(path)
                self._known[path] = f"{status.st_size} {status.st_mtime_ns}"
        return f"{path.removeprefix(str(ROOT))} {self._known[path]}"

    def of(self, entry, files):
        lines = [self._common, entry["command"].replace(str(ROOT), "")]
        lines += sorted(self._of_file(path) for path in files)
        return hashlib.sha256("\n".join(lines).encode()).hexdigest()


def check(build, entry, sources):
    command = ["clang-tidy", "--quiet", "-p", str(build)]
    if "/Unity/unity_" in entry["file"]:
        command += TOGETHER
    done = subprocess.run(command + [entry["file"]], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        print(f"in {' '.join(sources)}:\n{done.stdout}{done.stderr}", flush=True)
    return done.returncode == 0


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=Path, help="a build directory in which all is built, with clang")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--clean", type=Path, default=ROOT / "build/tidy", help="where what is clean is remembered")
    options = parser.parse_args(arguments)
    build = options.build.resolve()
    entries = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    made_of = dependencies(build)
    fingerprint = Fingerprint()
    options.clean.mkdir(parents=True, exist_ok=True)

    work, known, seen = [], 0, set()
    for entry in entries:
        sources = [source for source in sources_of(entry) if source.startswith(PRODUCT)]
        if not sources or seen.issuperset(sources):
            continue
        seen.update(sources)
        words = shlex.split(entry["command"])
        files = made_of.get(words[words.index("-o") + 1])
        if not files:
            sys.exit(f"{entry['file']} has not been built in {build}")
        stamp = options.clean / fingerprint.of(entry, files)
        if stamp.exists():
            known += 1
        else:
            work.append((len(files), entry, sources, stamp))

    def run(item):
        _, entry, sources, stamp = item
        clean = check(build, entry, sources)
        if clean:
            stamp.touch()
        return clean

    work.sort(key=lambda item: -item[0])  # the longest first
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        results = list(pool.map(run, work))
    parts = f"{len(seen)} sources in {known + len(work)} parts"
    print(f"{parts}: {known} known as clean, {results.count(False)} with findings")
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
