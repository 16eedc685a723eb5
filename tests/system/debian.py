"""A Debian 12 in a folder, with packages installed as a user would install them. Needs root; the first time it fetches
Debian's packages from where this machine has them from."""

import shutil
import subprocess
from pathlib import Path

SUITE = "bookworm"
BASE = ("systemd", "systemd-sysv", "dbus", "udev")
SOURCES = (Path("/etc/apt/sources.list.d/debian.sources"), Path("/etc/apt/sources.list"))
# what a kernel needs to boot from QEMU's disk: no more, so that its first file system is small
KERNEL = ("linux-image-amd64", "initramfs-tools", "kmod")
KERNEL_HOOK = """
mkdir -p "$1/etc/initramfs-tools/conf.d" "$1/usr/share/initramfs-tools/modules.d"
echo MODULES=list >"$1/etc/initramfs-tools/conf.d/machine"
printf '%s\\n' virtio_pci virtio_blk ext4 >"$1/usr/share/initramfs-tools/modules.d/machine"
"""


def run(*command, check=True, given=b"", timeout=None):
    done = subprocess.run([str(word) for word in command], input=given, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, check=False, timeout=timeout)
    return checked(subprocess.CompletedProcess(command, done.returncode, done.stdout.decode(errors="replace")), check)


def checked(done, check=True):
    if check and done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, done.args))}: exit code {done.returncode}\n{done.stdout}")
    return done


def bare_debian(cache, with_kernel):
    """The archive of the root file system, made once."""
    archive = cache / ("debian-12-kernel.tar" if with_kernel else "debian-12.tar")
    if not archive.exists():
        cache.mkdir(parents=True, exist_ok=True)
        print(f"making {archive}, once", flush=True)
        sources = next((path for path in SOURCES if path.exists() and path.stat().st_size > 0), None)
        unfinished = archive.with_suffix(".unfinished.tar")
        include = BASE + (KERNEL if with_kernel else ())
        hooks = [f"--essential-hook={KERNEL_HOOK}"] if with_kernel else []
        run("mmdebstrap", "--mode=root", "--variant=minbase", "--format=tar", f"--include={','.join(include)}", *hooks,
            SUITE, unfinished, *([sources] if sources else []))
        unfinished.rename(archive)
    return archive


class Debian:
    """What a machine is booted from."""

    def __init__(self, cache, name, with_kernel=False):
        self.root = cache / name
        self.remove()
        archive = bare_debian(cache, with_kernel)
        self.root.mkdir()
        run("tar", "-xf", archive, "-C", self.root)

    def file(self, path):
        return self.root / path.lstrip("/")

    def write(self, path, text):
        self.file(path).parent.mkdir(parents=True, exist_ok=True)
        self.file(path).write_text(text, encoding="utf-8")

    def add(self, here, path):
        self.file(path).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(here, self.file(path))

    def run(self, *command):
        """With this machine's network, and no systemd running."""
        return run("systemd-nspawn", "--quiet", "--register=no", "--keep-unit", "--as-pid2", "--console=pipe",
                   "--resolv-conf=copy-host", "--setenv=DEBIAN_FRONTEND=noninteractive", "-D", self.root, *command)

    def install(self, packages):
        """These files, with what they depend on."""
        for path in packages:
            self.add(path, f"/packages/{path.name}")
        self.run("sh", "-c", "apt-get update -q && apt-get install -q -y --no-install-recommends /packages/*.deb")

    def remove(self):
        shutil.rmtree(self.root, ignore_errors=True)
