"""Goal: whoever finds the port of a run cannot take its memory, nor change a bit of its results.

Oracles: the peak of the coordinator's memory as the kernel counts it (VmHWM); the same run that
nobody has disturbed. usage: test_strangers.py ABUT ROOT
"""

import re
import time
from pathlib import Path

import zmq
from support import ABUT, CONNECTED, ROOT, SOLVER, SystemTest, free_port, main

SCENE = ROOT / "configs" / f"{CONNECTED}.yaml"
STRANGERS, SIZE = 20, 100 << 20  # frames of 100 MiB: kept, they would be 2 GiB
# A stranger's connection ends when it has sent more than a Hello is long; what has come until a
# thread has looked is a few MiB, and more on a busy machine.
BOUND = 64 << 20
CALM = 4.0  # [s]


def peak(pid: int) -> int:
    """[B] of physical memory, the most so far."""
    status = Path(f"/proc/{pid}/status").read_text(encoding="utf-8")
    return int(re.search(r"VmHWM:\s*(\d+) kB", status)[1]) << 10


class Strangers(SystemTest):
    def setUp(self):
        super().setUp()
        self.port = free_port()
        self.context = zmq.Context()
        self.addCleanup(self.context.destroy, linger=0)

    def coordinator(self, *arguments: object):
        return self.start(ABUT, "run", SCENE, "--out", self.out,
                          "--set", f"network.endpoint=tcp://127.0.0.1:{self.port}", *arguments)

    def connect(self):
        return [self.start(SOLVER, "--connect", f"tcp://127.0.0.1:{self.port}", "--body", body)
                for body in ("left", "right")]

    def attack(self, pid: int) -> int:
        """Long frames of many, all at once; by how much [B] they have raised the peak of the
        process when it does not rise any more."""
        before = peak(pid)
        frame = bytes(SIZE)
        strangers = [self.context.socket(zmq.DEALER) for _ in range(STRANGERS)]
        for k, stranger in enumerate(strangers):
            stranger.setsockopt(zmq.ROUTING_ID, f"stranger {k}".encode())
            stranger.connect(f"tcp://127.0.0.1:{self.port}")
            for _ in range(3):
                stranger.send(frame, copy=False)
        begun = time.monotonic()
        risen, grown = begun, 0
        while time.monotonic() < min(risen + CALM, begun + 60.0):
            time.sleep(0.05)
            if peak(pid) - before > grown:
                risen, grown = time.monotonic(), peak(pid) - before
        for stranger in strangers:
            stranger.close(linger=0)
        return grown

    def wait_for(self, so, what: str):
        until = time.monotonic() + 20.0
        while not so():
            self.assertLess(time.monotonic(), until, what)
            time.sleep(0.01)

    def test_before_a_run_they_take_no_memory_and_the_run_is_the_same(self):
        quiet = self.folder / "quiet"
        self.succeed(self.abut("run", ROOT / "configs" / "two_bars.yaml", "--local",
                               "--out", quiet))
        run = self.coordinator()
        time.sleep(0.5)
        self.assertLess(self.attack(run.pid), BOUND)
        solvers = self.connect()
        self.succeed(self.end(run))
        for solver in solvers:
            self.succeed(self.end(solver))
        for key in ("state_hash", "measures"):
            self.assertEqual(self.summary()[key], self.summary(quiet)[key])

    def test_during_a_run_they_take_no_memory(self):
        run = self.coordinator("--set", "time.end=10.0", "--set", "meta.expect=[]")
        solvers = self.connect()
        history = self.out / "history.csv"
        self.wait_for(lambda: history.exists() and history.stat().st_size > 0, "no window")
        self.assertLess(self.attack(run.pid), BOUND)
        self.assertIsNone(run.poll(), "the run goes on")
        run.terminate()
        self.end(run)
        for solver in solvers:
            self.end(solver)


if __name__ == "__main__":
    main()
