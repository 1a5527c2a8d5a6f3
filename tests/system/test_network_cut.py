"""Goal: a network that is cut for a moment changes no bit of a run; cut for longer, it ends the run
at both ends with words and a checkpoint, from which the run reaches the same bits.

Oracle: the state hash of the same run in one process. The network is a pair of virtual interfaces
between two namespaces, which take root and iproute2: skipped where they cannot be made.
usage: test_network_cut.py ABUT ROOT [CLASS]
"""

import contextlib
import os
import shutil
import subprocess
import sys
import time

from support import ABUT, ROOT, SOLVER, SystemTest, main

SCENE = ROOT / "configs" / "joined" / "pulse_split.yaml"
BODIES = ("lower", "upper")
# Both bodies exchange in each of these windows: some seconds, in which there is time to cut.
LONG = ("--set", "time.end=4.0e-3", "--set", "meta.expect=[]", "--set", "output.fields.every=400",
        "--set", "output.checkpoint={windows: 10}")
# 10 s until heartbeats tell, 10 s in which a connection may come back (Deadlines::reconnect), and
# some for a machine with much else to do.
LOST_AFTER = 60.0


def ip(*words: str):
    return subprocess.run(["ip", *words], check=True, capture_output=True, text=True)


class Network:
    """Two namespaces and a wire between them."""

    def __init__(self):
        self.here, self.there = f"abut{os.getpid()}a", f"abut{os.getpid()}b"
        for name in (self.here, self.there):
            ip("netns", "add", name)
        ip("link", "add", "wire0", "netns", self.here, "type", "veth",
           "peer", "name", "wire0", "netns", self.there)
        for name, address in ((self.here, "10.7.0.1/24"), (self.there, "10.7.0.2/24")):
            ip("-n", name, "addr", "add", address, "dev", "wire0")
            for link in ("lo", "wire0"):
                ip("-n", name, "link", "set", link, "up")

    def switch(self, state: str):
        ip("-n", self.there, "link", "set", "wire0", state)

    def remove(self):
        for name in (self.here, self.there):
            with contextlib.suppress(subprocess.CalledProcessError):
                ip("netns", "del", name)


class CutTest(SystemTest):
    def setUp(self):
        super().setUp()
        self.network = Network()
        self.addCleanup(self.network.remove)
        self.keys = self.folder / "keys"
        self.succeed(self.abut("keygen", self.keys, *BODIES))
        here = self.folder / "here"
        self.succeed(self.abut("run", SCENE, "--local", "--out", here, *LONG))
        self.whole = self.summary(here)

    def over_the_network(self, *words: object) -> list:
        """The coordinator on one side of the wire, each body's program on the other."""
        endpoint = "tcp://10.7.0.1:5555"
        run = self.start("ip", "netns", "exec", self.network.here, ABUT, *words,
                         "--await", endpoint, "--keys", self.keys)
        return [run, *(self.start("ip", "netns", "exec", self.network.there, SOLVER, "--connect",
                                  endpoint, "--body", body, "--keys", self.keys)
                       for body in BODIES)]

    def started(self) -> list:
        """A run that has kept its state at least once."""
        programs = self.over_the_network("run", SCENE, "--out", self.out, *LONG)
        until = time.monotonic() + 60.0
        while not (self.out / "checkpoint.abut").exists():
            self.assertLess(time.monotonic(), until, "no checkpoint")
            time.sleep(0.01)
        for program in programs:
            self.assertIsNone(program.poll(), "ended before the cut")
        return programs

    def assert_same(self):
        for key in ("state_hash", "body_hashes", "windows"):
            self.assertEqual(self.summary()[key], self.whole[key], key)

    def assert_lost(self, programs: list):
        run, *solvers = [self.end(program, LOST_AFTER) for program in programs]
        self.assertEqual(run.returncode, 3, run.stderr)
        self.assertIn("closed its connection and did not come back", run.stderr)
        self.assertIn(f"abut resume {self.out} goes on", run.stderr)
        for solver in solvers:
            self.assertEqual(solver.returncode, 3, solver.stderr)
            self.assertIn("is gone", solver.stderr)


class ForAMoment(CutTest):
    def test_cut_for_a_second_changes_no_bit(self):
        programs = self.started()
        for _ in range(2):
            self.network.switch("down")
            time.sleep(1.0)
            self.network.switch("up")
            time.sleep(0.5)
        for program in programs:
            self.succeed(self.end(program, LOST_AFTER))
        self.assert_same()


class ForLong(CutTest):
    def test_cut_for_half_a_minute_goes_on_over_the_same_network(self):
        programs = self.started()
        self.network.switch("down")
        time.sleep(30.0)
        self.network.switch("up")
        self.assert_lost(programs)
        for program in self.over_the_network("resume", self.out):
            self.succeed(self.end(program, LOST_AFTER))
        self.assert_same()


class ForGood(CutTest):
    def test_cut_for_good_goes_on_on_one_machine(self):
        programs = self.started()
        self.network.switch("down")
        self.assert_lost(programs)
        self.succeed(self.abut("resume", self.out, "--local"))
        self.assert_same()


def possible() -> bool:
    """Whether this user may make networks here."""
    if shutil.which("ip") is None:
        return False
    with contextlib.suppress(subprocess.CalledProcessError):
        Network().remove()
        return True
    return False


if __name__ == "__main__":
    if not possible():
        print("skipped: no network namespaces here (they take root, and ip of iproute2)")
        sys.exit(77)
    main()
