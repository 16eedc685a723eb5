"""A machine with Debian's own kernel, in QEMU: where the kernel has modules, devices can be plugged in, and root may
give real-time rights. By KVM where that works, else emulated, which takes half a minute to boot."""

import base64
import json
import os
import select
import shutil
import socket
import subprocess
import time
from pathlib import Path

import debian
from machine import PATIENCE, Machine

AGENT = "/usr/local/lib/tests/agent.py"
UNIT = f"""[Unit]
Description=Does what the tests want
[Service]
ExecStart=/usr/bin/python3 -B {AGENT}
Restart=always
RestartSec=1
[Install]
WantedBy=multi-user.target
"""
DISK = "3G"
# some hosts have a KVM on which no kernel gets far
KVM_PATIENCE = 30.0
BOOT_PATIENCE = 300.0
TAIL = 40  # lines of the console


class Process:
    """A program inside that is told lines and answers each with one of JSON."""

    def __init__(self, machine, command):
        self.machine = machine
        self.number = machine.ask({"do": "start", "command": command})["process"]

    def ask(self, line, timeout=30.0):
        wish = {"do": "ask", "process": self.number, "line": line, "timeout": timeout}
        told = self.machine.ask(wish, timeout)["line"]
        if not told.startswith("{"):
            raise AssertionError(f"{line}: {told}")
        return json.loads(told)

    def end(self):
        return self.machine.ask({"do": "end", "process": self.number})["code"]


class VirtualMachine(Machine):
    def __init__(self, system, cache):
        """`system` is a Debian with a kernel; its folder is not needed afterwards."""
        self.disk = cache / "disk.img"
        self.kernel, self.first_files = cache / "vmlinuz", cache / "initrd.img"
        self.console = cache / "console.log"
        self.accelerator = None
        self.qemu = None
        self.host = None  # the agent's line
        self.serial = None  # of the USB serial port, which the kernel sees when it is given the module xhci_pci
        self.received = b""
        system.add(Path(__file__).with_name("agent.py"), AGENT)
        system.write("/etc/systemd/system/tests-agent.service", UNIT)
        system.run("systemctl", "enable", "tests-agent.service")
        system.write("/etc/modprobe.d/tests.conf", "blacklist xhci_pci\n")
        for name, place in (("vmlinuz", self.kernel), ("initrd.img", self.first_files)):
            shutil.copy(next(system.file("/boot").glob(f"{name}-*")), place)
        self.disk.unlink(missing_ok=True)
        with open(self.disk, "wb") as disk:
            disk.truncate(int(DISK.rstrip("G")) << 30)
        debian.run("mkfs.ext4", "-q", "-d", system.root, self.disk)

    def kind(self):
        return f"QEMU by {self.accelerator}, kernel {self.run('uname', '-r').stdout.strip()}"

    def boot(self):
        for accelerator, patience in (("kvm", KVM_PATIENCE), ("tcg,thread=multi", BOOT_PATIENCE)):
            if accelerator == "kvm" and not os.access("/dev/kvm", os.R_OK | os.W_OK):
                continue
            self.accelerator = accelerator
            self._start()
            try:
                self.ask(self._wish(["true"]), patience)
                break
            except AssertionError:
                self._end()
                if accelerator != "kvm":
                    raise
        state = self.ask(self._wish(["systemctl", "is-system-running", "--wait"]), BOOT_PATIENCE)
        told = base64.b64decode(state["output"]).decode().strip()
        if told not in ("running", "degraded"):
            raise AssertionError(f"the machine is {told}\n{self._tail()}")

    def _start(self):
        self.host, guest = socket.socketpair()
        self.serial, port = socket.socketpair()
        self.received = b""
        with guest, port:
            # it ends with who started it, however that ends
            self.qemu = subprocess.Popen(
                ["setpriv", "--pdeathsig=KILL", "qemu-system-x86_64", "-accel", self.accelerator, "-cpu", "max",
                 "-machine", "q35", "-m", "1024", "-smp", "2", "-display", "none", "-monitor", "none", "-no-reboot",
                 "-nic", "none", "-serial", f"file:{self.console}", "-kernel", str(self.kernel),
                 "-initrd", str(self.first_files),
                 "-append", "root=/dev/vda rw console=ttyS0 panic=-1 mitigations=off systemd.show_status=0",
                 "-drive", f"file={self.disk},if=virtio,format=raw,cache=unsafe,snapshot=on",
                 "-chardev", f"socket,id=agent,fd={guest.fileno()}", "-device", "virtio-serial-pci",
                 "-device", "virtserialport,chardev=agent,name=tests.agent",
                 "-chardev", f"socket,id=port,fd={port.fileno()}", "-device", "qemu-xhci",
                 "-device", "usb-serial,chardev=port,always-plugged=on"],
                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                pass_fds=[guest.fileno(), port.fileno()])

    def run(self, *command, user=None, check=True, given=b""):
        words = [*(["runuser", "-u", user, "--"] if user is not None else []), *map(str, command)]
        told = self.ask(self._wish(words, given))
        output = base64.b64decode(told["output"]).decode(errors="replace")
        return debian.checked(subprocess.CompletedProcess(command, told["code"], output), check)

    def start(self, *command):
        return Process(self, [str(word) for word in command])

    @staticmethod
    def _wish(command, given=b""):
        return {"do": "run", "command": command, "given": base64.b64encode(given).decode(), "timeout": PATIENCE}

    def ask(self, wish, timeout=PATIENCE):
        """The agent's answer; it has its own time limit, and a little beyond that for the way."""
        try:
            self.host.sendall(json.dumps(wish).encode() + b"\n")
            told = json.loads(self._receive_line(time.monotonic() + timeout + 10.0))
        except (OSError, TimeoutError) as error:
            raise AssertionError(f"the machine does not answer to {wish}: {error}\n{self._tail()}") from error
        if "error" in told:
            raise AssertionError(f"{wish}: {told['error']}")
        return told

    def _receive_line(self, deadline):
        while b"\n" not in self.received:
            if not select.select([self.host], [], [], max(0.0, deadline - time.monotonic()))[0]:
                raise TimeoutError("it is too slow, or stands still")
            piece = self.host.recv(65536)
            if not piece:
                raise OSError(f"QEMU has ended: {self.qemu.stderr.read().decode(errors='replace').strip()}")
            self.received += piece
        line, self.received = self.received.split(b"\n", 1)
        return line

    def _tail(self):
        if not self.console.exists():
            return "there is no console"
        lines = self.console.read_text(encoding="utf-8", errors="replace").splitlines()[-TAIL:]
        return "\n".join([f"the end of {self.console}:", *lines])

    def stop(self):
        """Without farewell: nobody wants its disk again."""
        self._end()
        self.disk.unlink(missing_ok=True)

    def _end(self):
        if self.qemu is None:
            return
        self.qemu.kill()
        self.qemu.wait()
        self.qemu.stderr.close()
        self.host.close()
        self.serial.close()
        self.qemu = None
