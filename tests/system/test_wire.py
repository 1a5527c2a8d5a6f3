"""Goal: a bad network costs time, never a bit; a hopeless one ends the run in words.

Oracles: the state hash of a run without a wire; deadlines of the scene and of proto/README.md.
usage: test_wire.py ABUT ROOT
"""

import time
from pathlib import Path

from support import ABUT, CONNECTED, ROOT, SOLVER, SystemTest, free_port, main
from wire import LONG, Wire

SCENE = ROOT / "configs" / f"{CONNECTED}.yaml"
TWO_BARS = ROOT / "configs" / "two_bars.yaml"
FRAME_LIMIT = 256 << 20  # [bytes] of proto/README.md
RECONNECT = 10.0         # [s] that a lost connection may take to come back; the same
HALF_WAY = 60            # of the 120 frames or so that one solver sends in a run


def intact(_, head: bytes, content: bytes) -> bytes:
    return head + content


def flip_one_bit(content: bytes) -> bytes:
    return content[:-1] + bytes([content[-1] ^ 4])


class BadWires(SystemTest):
    def run_over(self, spoil, *arguments: object) -> tuple:
        """The coordinator's result and those of both solvers; `left` is behind the wire."""
        port = free_port()
        self.wire = Wire(spoil, port)
        coordinator = self.start(
            ABUT, "run", SCENE, "--out", self.out,
            "--set", f"network.endpoint=tcp://127.0.0.1:{port}",
            *arguments)
        solvers = [self.start(SOLVER, "--connect", where, "--body", body) for body, where in
                   (("left", self.wire.endpoint), ("right", f"tcp://127.0.0.1:{port}"))]
        try:
            result = self.end(coordinator, 30.0)
            time.sleep(0.5)  # what was sent last still arrives
        finally:
            self.wire.close()
        return result, [self.end(solver, 30.0) for solver in solvers]

    def assert_same_bits(self, spoil):
        local = self.folder / "local"
        self.succeed(self.abut("run", TWO_BARS, "--local", "--out", local))
        result, solvers = self.run_over(spoil)
        self.succeed(result)
        for solver in solvers:
            self.succeed(solver)
        for key in ("state_hash", "measures"):
            self.assertEqual(self.summary()[key], self.summary(local)[key])
        self.assertEqual((self.out / "history.csv").read_bytes(),
                         (local / "history.csv").read_bytes())

    def assert_fails(self, spoil, *words: str, arguments=(), seconds: float = 30.0):
        begin = time.monotonic()
        result, solvers = self.run_over(spoil, *arguments)
        self.assertLess(time.monotonic() - begin, seconds)
        self.assertEqual(result.returncode, 3, result.stdout + result.stderr)
        for word in words:
            self.assertIn(word, result.stderr.splitlines()[-1])
        self.assert_whole(self.out, rows=1)
        self.assertEqual(self.summary()["status"], "failed")
        self.assertEqual(self.events()[-1]["kind"], "failure")
        self.assertEqual([solver.returncode for solver in solvers], [3, 3])

    def test_a_wire_that_changes_nothing_changes_no_bit(self):
        self.assert_same_bits(intact)
        self.assertGreater(self.wire.frames, HALF_WAY, "the frames went through it")

    def test_every_tenth_frame_with_a_flipped_bit_changes_no_bit(self):
        self.assert_same_bits(lambda number, head, content: head + (
            content if number % 10 else flip_one_bit(content)))

    def test_a_lost_frame_changes_no_bit(self):
        self.assert_same_bits(lambda number, head, content: (
            b"" if number == HALF_WAY else head + content))

    def test_a_connection_that_is_cut_and_comes_back_changes_no_bit(self):
        self.assert_same_bits(lambda number, head, content: (
            None if number == HALF_WAY else head + content))

    def test_frames_that_are_all_corrupt_are_named_with_body_and_limit(self):
        self.assert_fails(
            lambda number, head, content: head + (
                content if number < HALF_WAY else flip_one_bit(content)),
            "body 'left' sent 16 corrupt frames", f"limit {FRAME_LIMIT} bytes", "abut-solver")

    def test_a_frame_that_would_take_all_memory_is_refused_with_the_limit(self):
        announced = bytes([LONG]) + (1 << 40).to_bytes(8, "big")  # a tebibyte
        self.assert_fails(
            lambda number, head, content: (
                head + content if number < HALF_WAY else announced + content),
            "body 'left' lost its connection 3 times", f"limit of {FRAME_LIMIT} bytes")

    def test_a_solver_leaves_although_somebody_else_accepts_at_the_address(self):
        # The coordinator is gone, its host's forwarding accepts and closes: no way back.
        port = free_port()
        self.wire = Wire(intact, port)
        coordinator = self.start(ABUT, "run", SCENE, "--out", self.out,
                                 "--set", f"network.endpoint=tcp://127.0.0.1:{port}")
        solver = self.start(SOLVER, "--connect", self.wire.endpoint, "--body", "left")
        try:
            until = time.monotonic() + 10.0
            while self.wire.frames < 2 and time.monotonic() < until:  # Hello and Configured
                time.sleep(0.02)
            coordinator.kill()
            self.end(coordinator)
            left = self.end(solver, RECONNECT + 5.0)
        finally:
            self.wire.close()
        self.assertEqual(left.returncode, 3)
        self.assertIn("the coordinator of body 'left' is gone", left.stderr)

    def test_a_wire_that_falls_silent_is_given_up_at_the_deadline(self):
        def spoil(number: int, head: bytes, content: bytes) -> bytes:
            self.wire.silent = number >= HALF_WAY
            return head + content

        self.assert_fails(spoil, "body 'left' has not answered", "within 1 s",
                          "network.request_deadline",
                          arguments=["--set", "network.request_deadline=1"], seconds=20.0)


LARGE_REPLY = """
meta: {title: A window whose reply no frame holds}
time: {begin: 0.0, end: 5.0e-3, window: 5.0e-4}
bodies:
  left:
    model: {fe: {dimension: 3, mesh: {box: {lengths: [0.01, 0.3, 0.3], elements: [1, 30, 30]}}}}
    material: {linear_elastic: {youngs_modulus: 1.0e9, poissons_ratio: 0.0, density: 1000.0}}
    integrator: {central_difference: {step: 1.0e-7}}
    initial: {position: [-0.02, 0.0, 0.0], velocity: [1.0, 0.0, 0.0]}
    ports: {tip: {side: right}}
  wall:
    model:
      rigid_tool: {dimension: 3, mesh: {box: {lengths: [0.1, 0.3, 0.3], elements: [1, 1, 1]}}}
    ports: {face: {side: left}}
interfaces: {impact: {sides: [left.tip, wall.face], contact: {}}}
"""


class Frames(SystemTest):
    def test_check_knows_what_no_frame_holds(self):
        scene = self.folder / "scene.yaml"
        scene.write_text(LARGE_REPLY, encoding="utf-8")
        words = (":3: time.window: the reply to a window of 5001 times of body 'left' takes 330 "
                 "MiB, more than a frame between processes holds, 256 MiB. Give shorter windows")
        for command in (("check", scene), ("run", scene, "--out", self.out)):
            result = self.abut(*command)
            self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
            self.assertIn(words, result.stderr)
        self.assertFalse(self.out.exists())
        shorter = self.abut("check", scene, "--set", "time.window=2.5e-4")
        self.assertIn("valid", self.succeed(shorter).stdout)


if __name__ == "__main__":
    main()
