#!/usr/bin/python3
"""Runs inside the virtual machine and does what virtual_machine.py wants over a virtio port: a line of JSON for each
wish, and one for each answer.

    {"do": "run", "command": [...], "given": base64, "timeout": s}    -> {"code": 0, "output": base64}
    {"do": "start", "command": [...]}                                 -> {"process": 1}
    {"do": "ask", "process": 1, "line": "...", "timeout": s}          -> {"line": "..."}
    {"do": "end", "process": 1}                                       -> {"code": 0}
    any of them                                                     -> {"error": "..."}
"""

import base64
import json
import select
import subprocess
import tempfile
import time

PORT = "/dev/virtio-ports/tests.agent"
TIMED_OUT = 124  # as timeout(1)
ENVIRONMENT = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "LC_ALL": "C.UTF-8", "DEBIAN_FRONTEND": "noninteractive"}


class Agent:
    def __init__(self):
        self.processes = []

    def run(self, wish):
        # files, not pipes: what a command leaves running may hold its output open
        with tempfile.TemporaryFile() as given, tempfile.TemporaryFile() as output:
            given.write(base64.b64decode(wish["given"]))
            given.seek(0)
            process = subprocess.Popen(wish["command"], stdin=given, stdout=output, stderr=subprocess.STDOUT,
                                       env=ENVIRONMENT, cwd="/")
            try:
                code = process.wait(wish["timeout"])
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
                code = TIMED_OUT
            output.seek(0)
            return {"code": code, "output": base64.b64encode(output.read()).decode()}

    def start(self, wish):
        self.processes.append(subprocess.Popen(wish["command"], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                               env=ENVIRONMENT, cwd="/", bufsize=0))
        return {"process": len(self.processes) - 1}

    def ask(self, wish):
        process = self.processes[wish["process"]]
        process.stdin.write(wish["line"].encode() + b"\n")
        deadline = time.monotonic() + wish["timeout"]
        line = b""
        while not line.endswith(b"\n"):
            left = deadline - time.monotonic()
            if left <= 0 or not select.select([process.stdout], [], [], left)[0]:
                return {"error": f"no answer to {wish['line']!r} in {wish['timeout']:g} s"}
            piece = process.stdout.read(4096)
            if not piece:
                return {"error": f"it has ended, with {process.wait()}"}
            line += piece
        return {"line": line.decode().strip()}

    def end(self, wish):
        process = self.processes[wish["process"]]
        process.stdin.close()
        try:
            return {"code": process.wait(10)}
        except subprocess.TimeoutExpired:
            process.kill()
            return {"code": process.wait()}

    def answer(self, line):
        try:
            wish = json.loads(line)
            return {"run": self.run, "start": self.start, "ask": self.ask, "end": self.end}[wish["do"]](wish)
        except (OSError, ValueError, LookupError) as error:
            return {"error": f"{type(error).__name__}: {error}"}


def main():
    agent = Agent()
    with open(PORT, "r+b", buffering=0) as port:
        line = b""
        while True:
            piece = port.read(65536)
            if not piece:  # nobody is at the other end yet
                time.sleep(0.1)
                continue
            line += piece
            while b"\n" in line:
                wish, line = line.split(b"\n", 1)
                told = memoryview(json.dumps(agent.answer(wish)).encode() + b"\n")
                while told:
                    told = told[port.write(told):]


if __name__ == "__main__":
    main()
