"""Goal: what befalls a process with several bodies is told of all of them and leaves nothing; one
that waits for the solve of another is not lost.

Oracles: deadlines that the scenes state, exit codes, words of the message, the process table.
usage: test_shared_processes.py ABUT ROOT FAKE_SOLVER
"""

import os
import signal
import time

from support import SOLVER, free_port, main, marked
from test_faults import BUSY, DEADLINE, ENDING, LONG, PATIENCE, FaultTest


class SharedProcesses(FaultTest):
    TOGETHER = ("--set", "network.processes=1")

    def test_a_killed_process_is_named_with_all_its_bodies(self):
        run = self.run_in_background(*BUSY, *self.TOGETHER)
        self.wait_for_windows()
        os.kill(self.solvers(1)[0], signal.SIGKILL)
        self.assert_fails(run, 1.0, "shares a process with", "left", "right",
                          "which was killed by signal 9", f"is in {self.out}")
        self.assert_failure_is_written("shares a process with", "which was killed by signal 9")

    def test_a_stopped_process_is_given_up_at_the_request_deadline(self):
        run = self.run_in_background(*BUSY, *self.TOGETHER,
                                     "--set", f"network.request_deadline={DEADLINE}")
        self.wait_for_windows()
        os.kill(self.solvers(1)[0], signal.SIGSTOP)
        self.assert_fails(run, DEADLINE, "has not answered", f"within {DEADLINE:g} s")
        self.assert_failure_is_written("has not answered")

    def test_a_body_that_waits_for_a_long_solve_of_another_outlives_the_deadline(self):
        # Both are asked at once; the second is begun when the first has been solved.
        deadline = 1.5
        self.succeed(self.end(self.run_in_background(
            *LONG, *self.TOGETHER, "--set", "time.end=1.0e-3",
            "--set", f"network.request_deadline={deadline}",
            "--set", "bodies.left.model.fe.mesh.bar.elements=4000")))
        longest = self.summary()["timing"]["compute_s"]["left"]
        self.assertGreater(longest, deadline, "the solve was too short to prove anything")

    def test_an_interrupted_run_is_whole_and_leaves_no_process(self):
        for arguments in (BUSY, LONG):
            with self.subTest(arguments=arguments[1]):
                (self.out / "events.jsonl").unlink(missing_ok=True)
                run = self.run_in_background("--force", *self.TOGETHER, *arguments)
                if arguments is BUSY:
                    self.wait_for_windows()
                else:
                    time.sleep(1.0)  # in the middle of a solve
                run.send_signal(signal.SIGINT)
                result = self.end(run, ENDING + PATIENCE)
                self.assertEqual(result.returncode, 128 + signal.SIGINT, result.stderr)
                self.assertEqual(marked(self.mark), [])
                self.assertEqual(self.summary()["status"], "interrupted")

    def test_several_bodies_need_the_name_of_their_process(self):
        result = self.end(self.start(SOLVER, "--connect", f"tcp://127.0.0.1:{free_port()}",
                                     "--body", "left", "--body", "right"), ENDING)
        self.assertEqual(result.returncode, 2)
        self.assertIn("several bodies need --process", result.stderr)

    def test_a_process_ends_with_a_killed_coordinator(self):
        run = self.run_in_background(*LONG, *self.TOGETHER)
        self.solvers(1)
        time.sleep(0.5)
        run.kill()
        self.end(run)
        self.assertEqual(self.marked_after(1.0), [])


if __name__ == "__main__":
    main(arguments=3)
