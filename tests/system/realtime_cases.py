"""What the unit gives the daemon by systemd alone, where systemd may give it: nothing is added to the unit here."""

import json

from service_cases import SERVICE, OnTheMachine

FIFO = 1  # sched.h
PRIORITY = 80  # of the config that is shipped


def scheduling(stat):
    """Policy and real-time priority: fields 41 and 40 of /proc/PID/stat, whose second is in parentheses."""
    fields = stat.rsplit(")", 1)[1].split()
    return int(fields[41 - 3]), int(fields[40 - 3])


class RealTime(OnTheMachine):
    def status(self):
        lines = self.run("cat", f"/proc/{self.main_process()}/status").stdout.splitlines()
        return dict(line.split(":\t", 1) for line in lines if ":\t" in line)

    def kilobytes(self, key):
        return int(self.status()[key].split()[0])

    def test_the_unit_is_as_it_was_installed(self):
        self.assertEqual(self.machine.show(SERVICE, "DropInPaths"), "")

    def test_one_thread_ticks_at_the_priority_of_the_config_and_no_other_has_any(self):
        stats = self.run("sh", "-c", f"cat /proc/{self.main_process()}/task/*/stat").stdout.splitlines()
        with_priority = [told for told in map(scheduling, stats) if told != (0, 0)]
        self.assertEqual(with_priority, [(FIFO, PRIORITY)])

    def test_memory_is_locked_what_is_allocated_later_too(self):
        self.assertGreaterEqual(self.kilobytes("VmLck"), self.kilobytes("VmRSS"))
        self.assertGreater(self.kilobytes("VmLck"), 8192)  # kB, what a user may lock without the unit's limit

    def test_limits_are_those_of_the_unit(self):
        limits = self.run("cat", f"/proc/{self.main_process()}/limits").stdout
        self.assertRegex(limits, r"Max realtime priority +95 +95 ")
        self.assertRegex(limits, r"Max locked memory +unlimited +unlimited ")
        self.assertRegex(limits, r"Max realtime timeout +200000 +200000 +us")

    def test_the_daemon_was_refused_nothing(self):
        told = json.loads(self.run("hapticctl", "--json", "status", user="viewer").stdout)["real_time"]
        self.assertEqual((told["fifo"], told["priority"], told["memory_locked"]), (True, PRIORITY, True))
        self.assertEqual(told["warning"], [])

    def test_processors_are_kept_awake_while_it_is_armed_and_only_then(self):
        held = ("sh", "-c", f"readlink /proc/{self.main_process()}/fd/* | grep -c /dev/cpu_dma_latency")
        self.arm()
        self.assertEqual(self.run(*held, check=False).stdout.strip(), "1")
        self.ctl("driver", "disarm")
        self.assertEqual(self.run(*held, check=False).stdout.strip(), "0")


CASES = (RealTime,)
