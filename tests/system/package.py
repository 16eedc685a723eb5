"""The packages that are tested: found, and one of them made anew as a later version."""

import subprocess
from pathlib import Path


def find(folder):
    """Paths by the packages' names."""
    packages = {}
    for path in sorted(Path(folder).glob("*.deb")):
        packages[path.name.split("_")[0]] = path
    return packages


def later_version(package, version, folder, changes=None):
    """The same package with another version, and with other texts in some of its files; its path."""
    tree = folder / "later"
    subprocess.run(["dpkg-deb", "-R", str(package), str(tree)], check=True)
    control = tree / "DEBIAN/control"
    lines = [f"Version: {version}" if line.startswith("Version:") else line
             for line in control.read_text(encoding="utf-8").splitlines()]
    control.write_text("\n".join(lines) + "\n", encoding="utf-8")
    for path, text in (changes or {}).items():
        (tree / path.lstrip("/")).write_text(text, encoding="utf-8")
    made = folder / f"later_{version}.deb"
    subprocess.run(["dpkg-deb", "--root-owner-group", "-b", str(tree), str(made)], check=True,
                   stdout=subprocess.DEVNULL)
    subprocess.run(["rm", "-rf", str(tree)], check=True)
    return made
