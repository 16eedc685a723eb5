"""A bare Debian 12 in a folder, booted with its own systemd by systemd-nspawn. Needs root; the first time it fetches
Debian's packages from where this machine has them from."""

import shutil
import subprocess
import time
from pathlib import Path

SUITE = "bookworm"
BASE = ("systemd", "systemd-sysv", "dbus", "udev")
PATIENCE = 120.0  # s, for a loaded machine to boot or to stop
SOURCES = (Path("/etc/apt/sources.list.d/debian.sources"), Path("/etc/apt/sources.list"))


def run(*command, check=True, **options):
    done = subprocess.run([str(word) for word in command], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, check=False, **options)
    if check and done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stdout}")
    return done


def eventually(is_so, what, patience=PATIENCE):
    deadline = time.monotonic() + patience
    while not is_so():
        if time.monotonic() > deadline:
            raise AssertionError(f"not in {patience:g} s: {what}")
        time.sleep(0.1)


def bare_debian(cache):
    """The archive of the root file system, made once."""
    archive = cache / "debian-12.tar"
    if not archive.exists():
        cache.mkdir(parents=True, exist_ok=True)
        sources = next((path for path in SOURCES if path.exists() and path.stat().st_size > 0), None)
        unfinished = archive.with_suffix(".unfinished.tar")
        run("mmdebstrap", "--mode=root", "--variant=minbase", "--format=tar", f"--include={','.join(BASE)}", SUITE,
            unfinished, *([sources] if sources else []))
        unfinished.rename(archive)
    return archive


class Machine:
    """One machine. Commands run in it as root, or as a user of its own."""

    def __init__(self, cache, name="machine"):
        self.root = cache / name
        self.nspawn = None
        self.leader = None
        self.log = cache / f"{name}.log"
        if self.root.exists():
            shutil.rmtree(self.root)
        self.root.mkdir()
        run("tar", "-xf", bare_debian(cache), "-C", self.root)

    def offline(self, *command, check=True):
        """Before it is booted, with this machine's network."""
        return run("systemd-nspawn", "--quiet", "--register=no", "--keep-unit", "--as-pid2", "--console=pipe",
                   "--resolv-conf=copy-host", "--setenv=DEBIAN_FRONTEND=noninteractive", "-D", self.root, *command,
                   check=check)

    def boot(self):
        with open(self.log, "w", encoding="utf-8") as log:
            self.nspawn = subprocess.Popen(
                ["systemd-nspawn", "--quiet", "--register=no", "--keep-unit", "--boot", "--private-network",
                 "--capability=all", "--console=pipe", "-D", str(self.root)],
                stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT)
        eventually(self._find_leader, "the machine's first process")
        eventually(lambda: self.run("systemctl", "is-system-running", check=False).stdout.strip() in
                   ("running", "degraded"), "the machine is up")

    def _find_leader(self):
        if self.nspawn.poll() is not None:
            raise AssertionError(f"systemd-nspawn ended:\n{self.log.read_text(encoding='utf-8')}")
        children = Path(f"/proc/{self.nspawn.pid}/task/{self.nspawn.pid}/children").read_text(encoding="utf-8").split()
        for child in children:
            if Path(f"/proc/{child}/comm").read_text(encoding="utf-8").strip() == "systemd":
                self.leader = child
                return Path(f"/proc/{child}/root/run/systemd/private").exists()
        return False

    def run(self, *command, user=None, check=True):
        inside = ["nsenter", f"--target={self.leader}", "--mount", "--uts", "--ipc", "--net", "--pid", "--cgroup",
                  "--root", "--wd=/", "env", "-i", "PATH=/usr/sbin:/usr/bin:/sbin:/bin", "LC_ALL=C.UTF-8",
                  "DEBIAN_FRONTEND=noninteractive"]
        if user is not None:
            inside += ["runuser", "-u", user, "--"]
        return run(*inside, *command, check=check)

    def show(self, unit, key):
        return self.run("systemctl", "show", "--value", "-p", key, unit).stdout.strip()

    def journal(self, unit, since=None):
        return self.run("journalctl", "--no-pager", "-o", "cat", "-u", unit,
                        *([f"--since=@{since}"] if since else [])).stdout

    def file(self, path):
        return self.root / path.lstrip("/")

    def process_here(self, inside):
        """The number that a process of the machine has outside of it."""
        for status in Path("/proc").glob("[0-9]*/status"):
            try:
                numbers = [line.split()[1:] for line in status.read_text(encoding="utf-8").splitlines()
                           if line.startswith("NSpid:")][0]
            except (FileNotFoundError, ProcessLookupError):
                continue
            if len(numbers) == 2 and numbers[1] == str(inside) and self._is_ours(numbers[0]):
                return int(numbers[0])
        raise AssertionError(f"there is no process {inside}")

    def _is_ours(self, pid):
        try:
            return Path(f"/proc/{pid}/ns/pid").readlink() == Path(f"/proc/{self.leader}/ns/pid").readlink()
        except FileNotFoundError:
            return False

    def stop(self):
        if self.nspawn is None:
            return
        if self.nspawn.poll() is None and self.leader is not None:
            self.run("systemctl", "poweroff", check=False)
        try:
            self.nspawn.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self.nspawn.kill()
            self.nspawn.wait()
        self.nspawn = None
