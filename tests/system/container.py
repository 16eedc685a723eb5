"""A machine that shares this one's kernel: booted with its own systemd by systemd-nspawn, in two seconds."""

import subprocess
from pathlib import Path

import debian
from machine import PATIENCE, Machine, eventually


class Container(Machine):
    def __init__(self, root, log):
        self.root = root
        self.log = log
        self.nspawn = None
        self.leader = None

    def kind(self):
        return "a container with this machine's kernel"

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

    def run(self, *command, user=None, check=True, given=b""):
        inside = ["nsenter", f"--target={self.leader}", "--mount", "--uts", "--ipc", "--net", "--pid", "--cgroup",
                  "--root", "--wd=/", "env", "-i", "PATH=/usr/sbin:/usr/bin:/sbin:/bin", "LC_ALL=C.UTF-8",
                  "DEBIAN_FRONTEND=noninteractive"]
        if user is not None:
            inside += ["runuser", "-u", user, "--"]
        return debian.run(*inside, *command, check=check, given=given, timeout=PATIENCE)

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
