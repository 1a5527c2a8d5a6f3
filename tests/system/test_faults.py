"""Goal: whatever fails, the run ends in time, says which body and what to do, and leaves nothing.

Oracles: deadlines that the scenes state, exit codes, words of the message, the process table.
usage: test_faults.py ABUT ROOT FAKE_SOLVER [CLASS]
"""

import os
import resource
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

from support import ABUT, CONNECTED, ROOT, SOLVER, SystemTest, free_port, main, marked

FAKE = Path(sys.argv[3]).resolve()
TWO_BARS = ROOT / "configs" / "two_bars.yaml"
# Windows of one short step: tens of thousands of requests, a few seconds in all.
BUSY = ["--set", "time.window=1.0e-8", "--set", "output.records_per_window=1",
        "--set", "bodies.left.integrator.central_difference.step=1.0e-8",
        "--set", "bodies.right.integrator.central_difference.step=1.0e-8"]
# The bars fly apart: a window of a million steps is a request that takes a second or more.
LONG = ["--set", "time={begin: 0.0, end: 1.0, window: 1.0e-3}",
        "--set", "bodies.left.model.fe.mesh.bar.elements=2000",
        "--set", "bodies.right.model.fe.mesh.bar.elements=2000",
        "--set", "bodies.left.initial.velocity=[-100.0]",
        "--set", "bodies.right.initial.velocity=[100.0]",
        "--set", "bodies.left.integrator.central_difference.step=1.0e-9",
        "--set", "bodies.right.integrator.central_difference.step=1.0e-9"]
DEADLINE = 1.0  # [s] of the scenes here
# To end processes: 0.5 s to SIGKILL, and what a loaded machine takes on top.
ENDING = 3.0
PATIENCE = 2.0  # [s] that a run has for its window when it is asked to end: --grace of this file


def limit(what: int, count: int):
    resource.setrlimit(what, (count, count))


def launch(body: str, how: str) -> list:
    return ["--set", f"bodies.{body}.launch={{{how}}}"]


class FaultTest(SystemTest):
    def setUp(self):
        super().setUp()
        text = TWO_BARS.read_text(encoding="utf-8")
        self.scene = self.folder / "scene.yaml"
        # It expects nothing and has no closed form, so that every time and velocity will do.
        self.scene.write_text("meta: {title: Two bars}\n" + text[text.index("\ntime:"):],
                              encoding="utf-8")

    def run_in_background(self, *arguments: object, **options):
        return self.start(ABUT, "run", self.scene, "--out", self.out, "--grace", str(int(PATIENCE)),
                          *arguments, **options)

    def wait_for_windows(self):
        """Until the run has come to its first contact, which the log of events tells."""
        until = time.monotonic() + 20.0
        log = self.out / "events.jsonl"
        while not log.is_file() or "closed" not in log.read_text(encoding="utf-8"):
            self.assertLess(time.monotonic(), until, "the run does not come to its contact")
            time.sleep(0.01)

    def assert_fails(self, run, seconds: float, *words: str):
        """The run ends in time with code 3 and a message with all of the words."""
        begin = time.monotonic()
        result = self.end(run)
        self.assertLess(time.monotonic() - begin, seconds + ENDING)
        self.assertEqual(result.returncode, 3, result.stdout + result.stderr)
        last = result.stderr.splitlines()[-1]
        for word in ("error: ", *words):
            self.assertIn(word, last)
        told = [line for line in result.stderr.splitlines() if words[0] in line]
        self.assertEqual(told, [last], "said once")

    def assert_failure_is_written(self, *words: str):
        self.assert_whole(self.out, rows=1)
        self.assertEqual(self.summary()["status"], "failed")
        self.assertIsNone(self.summary()["state_hash"], "the bodies are gone")
        last = self.events()[-1]
        self.assertEqual(last["kind"], "failure")
        self.assertIn(f"body '{last['subject']}'", last["text"])
        for word in words:
            self.assertIn(word, last["text"])


class LostSolvers(FaultTest):
    def solver_of(self, body: str) -> int:
        for pid in self.solvers(2):
            if Path(f"/proc/{pid}/cmdline").read_bytes().split(b"\0")[-2] == body.encode():
                return pid
        self.fail(f"there is no solver of {body}")

    def test_a_killed_solver_is_named_at_once(self):
        run = self.run_in_background(*BUSY)
        self.wait_for_windows()
        os.kill(self.solver_of("right"), signal.SIGKILL)
        self.assert_fails(run, 1.0, "body 'right' was killed by signal 9", "tart the run again",
                          f"is in {self.out}", "no checkpoint was kept before it was lost")
        self.assert_failure_is_written("body 'right' was killed by signal 9")

    def test_a_solver_killed_in_the_middle_of_a_long_solve_is_named_at_once(self):
        run = self.run_in_background(*LONG)
        left = self.solver_of("left")
        time.sleep(1.0)  # both have begun to solve
        os.kill(left, signal.SIGKILL)
        self.assert_fails(run, 1.0, "body 'left' was killed by signal 9", "advance")
        self.assert_failure_is_written("body 'left' was killed by signal 9")

    def test_a_stopped_solver_is_given_up_at_the_request_deadline(self):
        run = self.run_in_background(*BUSY, "--set", f"network.request_deadline={DEADLINE}")
        self.wait_for_windows()
        os.kill(self.solver_of("left"), signal.SIGSTOP)
        self.assert_fails(run, DEADLINE, "body 'left' has not answered", f"within {DEADLINE:g} s",
                          "network.request_deadline")
        self.assert_failure_is_written("body 'left' has not answered")

    def test_solvers_that_left_a_stopped_coordinator_are_told_as_that(self):
        run = self.run_in_background(*BUSY)
        self.wait_for_windows()
        run.send_signal(signal.SIGSTOP)
        until = time.monotonic() + 60.0
        while len(marked(self.mark)) > 1 and time.monotonic() < until:  # the run itself stays
            time.sleep(0.1)
        run.send_signal(signal.SIGCONT)
        ended = self.end(run)
        self.assertEqual(ended.returncode, 3, ended.stderr)
        self.assertRegex(ended.stderr, r"exited with code 3, as (this process stood still for "
                         r"\d\d s|.* and so does a coordinator that is stopped for 10 s)")

    def test_a_long_solve_shows_progress_and_outlives_the_deadline(self):
        # The run's one window takes seconds, with signs of progress in between.
        deadline = 1.5
        self.succeed(self.end(self.run_in_background(
            *LONG, "--set", "time.end=1.0e-3", "--set", f"network.request_deadline={deadline}",
            "--set", "bodies.left.model.fe.mesh.bar.elements=4000")))
        longest = max(self.summary()["timing"]["compute_s"].values())
        self.assertGreater(longest, deadline, "the solve was too short to prove anything")

    def test_a_connected_solver_that_is_killed_is_given_up(self):
        endpoint = f"tcp://127.0.0.1:{free_port()}"
        run = self.run_in_background(*BUSY, *launch("left", "connect: {patience: 10}"),
                                     "--set", f"network.endpoint={endpoint}")
        solver = self.start(SOLVER, "--connect", endpoint, "--body", "left")
        self.wait_for_windows()
        solver.kill()
        self.end(solver)
        self.assert_fails(run, 10.0, "body 'left' closed its connection and did not come back",
                          "tart the run again")
        self.assert_failure_is_written("body 'left' ")


class Strangers(FaultTest):
    def program(self, text: str) -> Path:
        path = self.folder / "solver"
        path.write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
        path.chmod(0o755)
        self.allow(path)
        return path

    def assert_start_fails(self, seconds: float, arguments: list, *words: str):
        self.assert_fails(self.run_in_background(*arguments), seconds, *words)
        self.assertFalse(self.out.exists(), "a run that never begins leaves nothing behind")

    def test_a_spawned_program_that_never_connects_is_given_up(self):
        mute = self.program("exec sleep 600")
        self.assert_start_fails(
            DEADLINE, [*launch("left", f"spawn: {{program: {mute}}}"),
                       "--set", f"network.startup_deadline={DEADLINE}"],
            "body 'left' did not connect", f"within {DEADLINE:g} s", "network.startup_deadline")

    def test_a_spawned_program_that_ends_is_named_with_its_code(self):
        self.assert_start_fails(
            0.5, launch("right", f"spawn: {{program: {self.program('exit 7')}}}"),
            "the solver of body 'right' exited with code 7")

    def test_a_program_that_is_not_there_is_named(self):
        self.allow("/nowhere/solver")
        self.assert_start_fails(
            0.5, launch("right", "spawn: {program: /nowhere/solver}"),
            "cannot start /nowhere/solver: No such file or directory")

    def test_a_body_that_nobody_starts_is_named_with_the_missing_command(self):
        endpoint = f"tcp://127.0.0.1:{free_port()}"
        self.assert_start_fails(
            DEADLINE, [*launch("right", f"connect: {{patience: {DEADLINE}}}"),
                       "--set", f"network.endpoint={endpoint}"],
            "body 'right' did not connect",
            f"abut-solver --connect {endpoint} --body right")

    def test_another_protocol_version_is_named_at_both_ends(self):
        self.environment["ABUT_FAKE_left"] = "old_version"
        self.assert_start_fails(
            0.5, launch("left", f"spawn: {{program: {FAKE}}}"),
            "the solver of body 'left'", "speaks protocol", "Install the same version")

    def test_a_first_frame_of_noise_is_named_with_its_size(self):
        self.environment["ABUT_FAKE_right"] = "babble"
        self.assert_start_fails(
            0.5, launch("right", f"spawn: {{program: {FAKE}}}"),
            "body 'right' did not say hello", "99 bytes", "Connect an abut-solver")

    def test_a_solver_of_a_body_that_is_not_there_is_told_the_names_and_the_run_goes_on(self):
        endpoint = f"tcp://127.0.0.1:{free_port()}"
        stranger = self.start(SOLVER, "--connect", endpoint, "--body", "middle")
        run = self.run_in_background(*launch("left", "connect: {}"),
                                     "--set", f"network.endpoint={endpoint}")
        self.assertIn(f"waiting for body 'left': abut-solver --connect {endpoint} --body left",
                      run.stderr.readline())
        refused = self.end(stranger)
        self.assertEqual(refused.returncode, 3)
        self.assertIn("left, right", refused.stderr)
        solver = self.start(SOLVER, "--connect", endpoint, "--body", "left")
        self.succeed(self.end(run))
        self.succeed(self.end(solver))

    def test_a_solver_without_a_coordinator_leaves_when_its_patience_ends(self):
        result = self.end(self.start(SOLVER, "--connect", f"tcp://127.0.0.1:{free_port()}",
                                     "--body", "left", "--patience", 0.5), 0.5 + ENDING)
        self.assertEqual(result.returncode, 3)
        self.assertIn("no coordinator has answered body 'left' within 0.5 s", result.stderr)

    def test_an_endpoint_that_is_taken_is_refused_with_the_key(self):
        endpoint = f"tcp://127.0.0.1:{free_port()}"
        arguments = [*launch("left", "connect: {patience: 5}"),
                     "--set", f"network.endpoint={endpoint}"]
        first = self.run_in_background(*arguments)
        self.solvers(1)  # it listens by the time it has started the other body
        second = self.abut("run", self.scene, "--out", self.folder / "second", *arguments)
        self.assertEqual(second.returncode, 2, second.stderr)
        self.assertIn("network.endpoint", second.stderr)
        self.assertIn("Address already in use", second.stderr)
        first.terminate()
        self.assertEqual(self.end(first).returncode, 128 + signal.SIGTERM)


class Endings(FaultTest):
    def test_solvers_end_with_a_killed_coordinator(self):
        for arguments in (BUSY, LONG):
            with self.subTest(arguments=arguments[1]):
                run = self.run_in_background("--force", *arguments)
                self.solvers(2)
                time.sleep(0.5)
                run.kill()
                self.end(run)
                self.assertEqual(self.marked_after(1.0), [])
                self.assertEqual(list(self.temporary.iterdir()), [])

    def test_connected_solvers_leave_a_killed_coordinator_after_the_time_to_reconnect(self):
        endpoint = f"tcp://127.0.0.1:{free_port()}"
        run = self.start(ABUT, "run", ROOT / "configs" / f"{CONNECTED}.yaml", "--out", self.out,
                         "--set", f"network.endpoint={endpoint}", *BUSY)
        solvers = [self.start(SOLVER, "--connect", endpoint, "--body", body)
                   for body in ("left", "right")]
        self.wait_for_windows()
        run.kill()
        self.end(run)
        for solver in solvers:
            result = self.end(solver, 10.0 + ENDING)  # proto/README.md: 10 s to come back
            self.assertEqual(result.returncode, 3)
            self.assertIn("the coordinator of body", result.stderr)

    def test_an_interrupted_run_is_whole_and_leaves_no_solver(self):
        placements = {"spawned": [], "local": ["--local"]}
        for sent in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGPIPE):
            for name, placement in placements.items():
                for arguments in (BUSY, LONG):
                    with self.subTest(signal=sent, placement=name, arguments=arguments[1]):
                        (self.out / "events.jsonl").unlink(missing_ok=True)
                        run = self.run_in_background("--force", *placement, *arguments)
                        if arguments is BUSY:
                            self.wait_for_windows()
                        else:
                            time.sleep(1.0)  # in the middle of a solve
                        run.send_signal(sent)
                        # The window under way is waited for; with a second Ctrl-C it is not.
                        twice = arguments is LONG and sent == signal.SIGINT
                        if twice:
                            time.sleep(0.1)
                            run.send_signal(sent)
                        waits = arguments is LONG and not twice
                        result = self.end(run, ENDING + (PATIENCE if waits else 0.0))
                        self.assertEqual(result.returncode, 128 + sent, result.stderr)
                        self.assertEqual(marked(self.mark), [])
                        self.assertEqual(self.summary()["status"], "interrupted")
                        self.assert_whole(self.out, rows=1)
                        kinds = {event["kind"] for event in self.events()}
                        self.assertNotIn("failure", kinds)
                        if sent != signal.SIGPIPE:  # then nobody reads
                            self.assertIn("once more: ends now", result.stderr)
                        if sent != signal.SIGPIPE:
                            self.assertRegex(result.stdout, r"go on  (nothing is kept|abut resume)")

    def test_connected_solvers_are_told_of_an_interrupted_run(self):
        endpoint = f"tcp://127.0.0.1:{free_port()}"
        run = self.run_in_background(*BUSY, *launch("left", "connect: {}"),
                                     "--set", f"network.endpoint={endpoint}")
        solver = self.start(SOLVER, "--connect", endpoint, "--body", "left")
        self.wait_for_windows()
        run.terminate()
        self.assertEqual(self.end(run, ENDING).returncode, 128 + signal.SIGTERM)
        told = self.end(solver, ENDING)
        self.assertEqual(told.returncode, 3)
        self.assertIn("the run has ended early", told.stderr)

    def test_a_second_run_into_the_same_folder_changes_nothing(self):
        self.succeed(self.abut("run", self.scene, "--local", "--out", self.out))
        before = {path: path.read_bytes() for path in self.out.iterdir()}
        result = self.abut("run", self.scene, "--local", "--out", self.out)
        self.assertEqual(result.returncode, 2)
        self.assertIn("--force", result.stderr)
        self.assertEqual({path: path.read_bytes() for path in self.out.iterdir()}, before)

    def test_a_full_disk_ends_the_run_with_the_file_that_did_not_fit(self):
        # bytes per file: the summary fits, the table does not
        run = self.run_in_background("--set", "output.records_per_window=10",
                                     preexec_fn=lambda: limit(resource.RLIMIT_FSIZE, 20_000))
        self.assert_fails(run, 5.0, "history.csv", "cannot be written", "space left")
        self.assertEqual(self.summary()["status"], "failed")
        self.assertIn("history.csv", self.events()[-1]["text"])

    def test_what_is_printed_into_a_full_device_is_an_error(self):
        placed = ["run", self.scene, "--out", self.out, "--force"]
        for arguments in (["check", self.scene], ["reference"], ["--help"], placed,
                          [*placed, "--local"]):
            with self.subTest(arguments=arguments), open("/dev/full", "wb") as full:
                result = self.end(subprocess.Popen(
                    [ABUT, *arguments], stdout=full, stderr=subprocess.PIPE, text=True,
                    env=self.environment, cwd=self.folder))
                self.assertEqual(result.returncode, 3, result.stderr)
                self.assertIn("No space left", result.stderr)
        self.assertEqual(self.summary()["status"], "completed", "its files are elsewhere")

    def test_printing_into_a_file_at_its_limit_is_an_error(self):
        with (self.folder / "reference.md").open("wb") as file:
            result = self.end(subprocess.Popen(
                [ABUT, "reference"], stdout=file, stderr=subprocess.PIPE, text=True,
                preexec_fn=lambda: limit(resource.RLIMIT_FSIZE, 5_000)))
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("File too large", result.stderr)

    def test_few_descriptors_end_in_words_or_are_enough(self):
        codes = set()
        for placement in ([], ["--local"]):
            for count in (8, 12, 16, 24, 32, 48, 256):
                with self.subTest(count=count, placement=placement):
                    result = self.abut("run", self.scene, "--out", self.out, "--force", *placement,
                                       preexec_fn=lambda: limit(resource.RLIMIT_NOFILE, count))
                    self.assertIn(result.returncode, (0, 3), result.stderr)
                    if result.returncode == 3:
                        self.assertIn("Too many open files", result.stderr)
                    codes.add((count, result.returncode))
        self.assertIn((16, 3), codes)
        self.assertIn((256, 0), codes)
        self.assertNotIn((256, 3), codes)

    def test_a_reader_that_goes_away_leaves_a_whole_run(self):
        for placement in ([], ["--local"]):
            with self.subTest(placement=placement):
                run = subprocess.Popen([ABUT, "run", self.scene, "--out", self.out, "--force",
                                        *placement, *BUSY], stdout=subprocess.PIPE,
                                       stderr=subprocess.STDOUT, env=self.environment,
                                       cwd=self.folder)
                run.stdout.readline()
                run.stdout.close()
                self.assertEqual(run.wait(60), 128 + signal.SIGPIPE)
                self.assertEqual(self.summary()["status"], "interrupted")
                self.assert_whole(self.out, rows=1)


class LongSolids(FaultTest):
    """A body that nothing touches could go from begin to end in one request; it must not."""

    def start_column(self, *arguments: object):
        return self.start(ABUT, "run", ROOT / "configs" / "solids" / "torsion_column.yaml",
                          "--set", "time.end=1.0", "--out", self.out, "--force", *arguments)

    def wait_for_rows(self, count: int) -> int:
        until = time.monotonic() + 60.0
        table = self.out / "history.csv"
        while not table.is_file() or len(table.read_bytes().splitlines()) < count:
            self.assertLess(time.monotonic(), until, "the records do not come")
            time.sleep(0.05)

    def test_an_interrupted_one_keeps_its_records(self):
        for placement in ([], ["--local"]):
            with self.subTest(placement=placement):
                run = self.start_column(*placement)
                self.wait_for_rows(20)
                run.send_signal(signal.SIGINT)
                self.assertEqual(self.end(run, 10.0).returncode, 128 + signal.SIGINT)
                self.assertGreater(self.summary()["time"]["reached"], 15.0e-5)
                self.assert_whole(self.out, rows=19)
                shutil.rmtree(self.out)

    def test_a_killed_one_keeps_what_was_flushed(self):
        run = self.start_column("--local")
        self.wait_for_rows(20)
        run.kill()
        self.end(run)
        self.assertGreaterEqual(len((self.out / "history.csv").read_bytes().splitlines()), 20)

    def test_a_failed_one_keeps_the_records_before(self):
        # Twisted so fast that an element turns inside out after eleven windows of one request.
        twist = 'bodies.column.initial.velocity_field=["-1.0e6 * y * z", "1.0e6 * x * z", "0"]'
        result = self.end(self.start_column("--local", "--set", "time.window=1.0e-6",
                                            "--set", twist))
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(self.summary()["status"], "failed")
        self.assert_whole(self.out, rows=3)


class Directories(FaultTest):
    def test_a_second_run_is_refused_while_the_first_one_writes(self):
        run = self.run_in_background(*BUSY)
        self.wait_for_windows()
        for force in ([], ["--force"]):
            second = self.abut("run", self.scene, "--local", "--out", self.out, *force)
            self.assertEqual(second.returncode, 2, second.stderr)
            self.assertIn("is in use by another run", second.stderr)
        run.send_signal(signal.SIGINT)
        self.assertEqual(self.end(run, ENDING).returncode, 128 + signal.SIGINT)
        self.assert_whole(self.out)
        self.succeed(self.abut("run", self.scene, "--local", "--force", "--out", self.out))

    def test_a_file_that_is_removed_or_replaced_meanwhile_is_told(self):
        for name in ("history.csv", "events.jsonl"):
            for replaced in (False, True):
                with self.subTest(name=name, replaced=replaced):
                    run = self.run_in_background(*BUSY, "--local", "--force")
                    self.wait_for_windows()
                    (self.out / name).unlink()
                    if replaced:
                        (self.out / name).write_text("mine", encoding="utf-8")
                    result = self.end(run)
                    self.assertEqual(result.returncode, 3, result.stderr)
                    told = f"{name}: was removed or replaced while the run wrote it"
                    self.assertIn(told, result.stderr)
                    self.assertEqual(self.summary()["status"], "failed")
                    self.assertIn(told, self.summary()["reason"])
                    shutil.rmtree(self.out)

    def test_an_empty_folder_name_is_refused(self):
        for verb in (["run", self.scene], ["split", self.scene, "--bodies", 2],
                     ["report", self.folder], ["study", self.scene]):
            with self.subTest(verb=verb[0]):
                result = self.abut(*verb, "--out", "")
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn("is empty: name a ", result.stderr)

    def test_a_killed_run_blocks_nobody(self):
        run = self.run_in_background(*BUSY)
        self.wait_for_windows()
        run.kill()
        self.end(run)
        self.succeed(self.abut("run", self.scene, "--local", "--force", "--out", self.out))
        self.assert_whole(self.out)

    def test_an_ipc_endpoint_never_takes_the_place_of_a_file(self):
        precious = self.folder / "precious"
        precious.write_text("mine", encoding="utf-8")
        result = self.abut("run", self.scene, "--out", self.out, *launch("left", "connect: {}"),
                           "--set", f"network.endpoint=ipc://{precious}")
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("this file exists", result.stderr)
        self.assertEqual(precious.read_text(encoding="utf-8"), "mine")

    def test_a_connected_body_of_another_mesh_is_refused(self):
        """Same topology, same mass: only a digest can tell."""
        text = (ROOT / "configs" / "solids" / "gmsh_part.yaml").read_text(encoding="utf-8")
        mesh = (ROOT / "configs" / "meshes" / "block.msh").read_text(encoding="utf-8")
        for place in ("here", "there"):
            (self.folder / place).mkdir()
            (self.folder / place / "block.msh").write_text(mesh, encoding="utf-8")
        scene = self.folder / "here" / "scene.yaml"
        scene.write_text(text.replace("../meshes/block.msh", "block.msh"), encoding="utf-8")
        # Without a file here there is none to differ from: no body is built in the coordinator.
        for change, here, code in (("", True, 0), ("\n", True, 2), ("\n", False, 0)):
            (self.folder / "there" / "block.msh").write_text(mesh + change, encoding="utf-8")
            if not here:
                (self.folder / "here" / "block.msh").unlink()
            endpoint = f"tcp://127.0.0.1:{free_port()}"
            run = self.start("sh", "-c", f"cd here && exec {ABUT} run scene.yaml --force --out out "
                             f"--set 'bodies.part.launch={{connect: {{}}}}' "
                             f"--set network.endpoint={endpoint}")
            solver = self.start("sh", "-c", f"cd there && exec {SOLVER} --connect {endpoint} "
                                "--body part")
            result = self.end(run)
            self.assertEqual(result.returncode, code, result.stderr)
            self.assertEqual(self.end(solver).returncode, 0 if code == 0 else 3)
            if code != 0:
                self.assertIn("is another file than the one beside the scene", result.stderr)
                self.assertIn("bodies.part.model.fe.mesh.gmsh.file", result.stderr)


if __name__ == "__main__":
    main(arguments=3)
