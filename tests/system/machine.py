"""What tests want of a machine, whichever kind it is."""

import time

PATIENCE = 120.0  # s, for a loaded machine to boot, to stop, or to do what it is told


def eventually(is_so, what, patience=PATIENCE):
    deadline = time.monotonic() + patience
    while not is_so():
        if time.monotonic() > deadline:
            raise AssertionError(f"not in {patience:g} s: {what}")
        time.sleep(0.1)


class Machine:
    """Commands run in it as root, or as a user of its own."""

    def kind(self):
        """What it is, in words."""
        raise NotImplementedError

    def run(self, *command, user=None, check=True, given=b""):
        """`given` is its standard input; the result has its returncode, and what it printed as stdout."""
        raise NotImplementedError

    def stop(self):
        """However far it has come; a second time it does nothing."""
        raise NotImplementedError

    def show(self, unit, key):
        return self.run("systemctl", "show", "--value", "-p", key, unit).stdout.strip()

    def journal(self, unit, since=None):
        """`since` is what now() told."""
        return self.run("journalctl", "--no-pager", "-o", "cat", "-u", unit,
                        *([f"--since=@{since}"] if since else [])).stdout

    def now(self):
        """Its own clock."""
        return self.run("date", "+%s.%N").stdout.strip()

    def exists(self, path):
        return self.run("test", "-e", path, check=False).returncode == 0

    def read(self, path):
        return self.run("cat", path).stdout

    def write(self, path, content):
        """Over what is there, which keeps its owner and mode. Text, or bytes."""
        self.run("cp", "/dev/stdin", path, given=content.encode() if isinstance(content, str) else content)
