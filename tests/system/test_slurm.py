"""Goal: a job that abut writes for Slurm runs the scene to the bits of one process, ends with its
exit code, keeps what it was told to and leaves no key behind.

Oracles: the state hash of the same run in one process; what Slurm says of the job; bash and, where
it is there, shellcheck.
usage: test_slurm.py ABUT ROOT CLASS      exit code 77 (skipped) where Node has no Slurm to run
"""

import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

from slurm_node import SlurmNode
from support import ABUT, ROOT, SystemTest, marked

SCENE = ROOT / "configs" / "two_bars.yaml"
# Seconds of wall time: what interrupts a job must find it under way.
LONG = ["--set", "time.end=3.6e-1", "--set", "meta.expect=[]"]
GOLDEN = ROOT / "tests" / "data" / "jobs" / "two_bars.sbatch"


class Scripts(SystemTest):
    def script(self, *arguments: object, scene: Path = SCENE) -> str:
        return self.succeed(self.abut("slurm", scene, "--out", self.out, *arguments)).stdout

    def test_the_text(self):
        text = self.script("--sbatch=--time=2:00:00", "--sbatch=--partition=main", "--set",
                           "network.processes=1", "--set", "meta.title=It's short")
        for place, name in ((str(ABUT.parent), "PROGRAMS"), (str(self.out), "OUT"),
                            (str(ROOT), "ROOT")):
            text = text.replace(place, name)
        self.assertEqual(text, GOLDEN.read_text(encoding="utf-8"))

    def test_shells_find_nothing_wrong(self):
        scene = self.folder / "it's $(a) scene.yaml"
        shutil.copy(SCENE, scene)
        again = ["--set", "network.on_lost_body=restart", "--set",
                 "output.checkpoint={windows: 10}"]
        for more in ([], ["--set", "network.processes=1"], again):
            file = self.folder / "job.sh"
            file.write_text(self.script(*more, scene=scene), encoding="utf-8")
            checks = [["bash", "-n", file]]
            if shutil.which("shellcheck"):
                # SC2016: what looks like $(a) in single quotes is meant to stay so.
                checks.append(["shellcheck", "--severity=style", "--exclude=SC2016", file])
            for check in checks:
                said = subprocess.run(check, capture_output=True, text=True, check=False)
                self.assertEqual(said.returncode, 0, said.stdout + said.stderr)

    def test_a_task_for_each_process_with_the_threads_of_the_largest(self):
        scene = ROOT / "configs" / "solids" / "torsion_column.yaml"
        body = "bodies.column.model.fe.threads=3"
        text = self.script("--set", body, scene=scene)
        self.assertIn("#SBATCH --ntasks=2\n#SBATCH --cpus-per-task=3\n", text)
        self.assertIn("\nstep 3 \"${programs}abut-solver\" --patience 600 '--body' 'column'\n",
                      text)

    def test_a_program_of_somebody_else_must_be_listed(self):
        scene = ROOT / "examples" / "python_body" / "two_plates.yaml"
        keys = {name: launch for name, launch in re.findall(
            r"^  (\w+):\n(?:    .*\n)*?    launch: (.*)\n", scene.read_text(encoding="utf-8"),
            re.MULTILINE)}
        self.assertTrue(keys, "the example has bodies of its own program")
        program = self.folder / "solver"
        program.write_text("#!/bin/sh\n", encoding="utf-8")
        program.chmod(0o700)
        more = [word for name in keys for word in
                ("--set", f"bodies.{name}.launch={{spawn: {{program: {program}}}}}")]
        refused = self.abut("slurm", scene, *more)
        self.assertEqual(refused.returncode, 2, refused.stderr)
        self.assertIn(f"would start {program}, which is not on your list of programs",
                      refused.stderr)
        self.allow(program)
        self.assertIn(f"step 1 '{program}' '--body'", self.script(*more, scene=scene))
        near = [word.replace(str(program), "./solver") for word in more]
        self.assertIn(f"step 1 '{program}' '--body'", self.script(*near, scene=scene))
        self.assertRegex(self.script(*near, scene=scene),
                         r"\nexport PYTHONPATH=.*share/abut/python")
        self.assertNotIn("PYTHONPATH", self.script())
        connect = [word for name in keys for word in
                   ("--set", f"bodies.{name}.launch={{connect: {{}}}}")]
        unknown = self.abut("slurm", scene, *connect)
        self.assertEqual(unknown.returncode, 2)
        self.assertIn("does not say which program the body is of", unknown.stderr)

    def test_a_file_is_not_overwritten(self):
        file = self.folder / "job.sh"
        self.succeed(self.abut("slurm", SCENE, "-o", file))
        self.assertEqual(self.abut("slurm", SCENE, "-o", file).returncode, 2)
        self.succeed(self.abut("slurm", SCENE, "-o", file, "--force"))

    def test_what_is_no_option_of_sbatch_is_refused(self):
        for option in ("time", "--time=1\n#SBATCH --x", "--a b", "--", "--comment=a#b"):
            result = self.abut("slurm", SCENE, f"--sbatch={option}")
            self.assertEqual(result.returncode, 2, option)
            self.assertIn("is no option of sbatch in one word", result.stderr)


class Node(SystemTest):
    slurm: SlurmNode

    def setUp(self):
        super().setUp()
        self.shared = self.folder / "shared"
        self.shared.mkdir()
        self.marks = {key: self.environment[key] for key in ("ABUT_SYSTEM_TEST", "TMPDIR")}
        # A container may not know its own name.
        self.marks["ABUT_HOST"] = "127.0.0.1"

    def submit(self, *arguments: object, sbatch: tuple = ()) -> str:
        script = self.shared / "job.sh"
        if not script.exists():
            self.succeed(self.abut("slurm", SCENE, "-o", script, "--out", self.out, *arguments))
        said = self.slurm.run("sbatch", "--parsable", *sbatch, script, cwd=self.shared,
                              env=self.marks)
        return said.stdout.strip()

    def told(self, job: str) -> dict:
        said = self.slurm.run("scontrol", "--oneliner", "show", "job", job).stdout
        return dict(re.findall(r"(\w+)=(\S+)", said))

    def wait_for(self, job: str, seconds: float = 60.0) -> str:
        """Its exit code, as CODE:SIGNAL."""
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            told = self.told(job)
            if told["JobState"] not in ("PENDING", "RUNNING", "COMPLETING", "CONFIGURING"):
                return told["ExitCode"]
            time.sleep(0.1)
        self.fail(f"not ended: {self.told(job)}{self.log(job)}")

    def log(self, job: str) -> str:
        return (self.shared / f"two_bars-{job}.log").read_text(encoding="utf-8")

    def wait_for_file(self, pattern: str):
        until = time.monotonic() + 40.0
        while not (self.out.exists() and list(self.out.glob(pattern))):
            self.assertLess(time.monotonic(), until, f"no {pattern}")
            time.sleep(0.02)

    def local(self, *arguments: object) -> dict:
        folder = self.folder / "here"
        self.succeed(self.abut("run", SCENE, "--local", "--out", folder, *arguments))
        return self.summary(folder)

    def assert_same(self, here: dict):
        for key in ("state_hash", "measures", "exchanges"):
            self.assertEqual(self.summary()[key], here[key], key)
        self.assertEqual(list(self.shared.glob("abut-keys-*")), [], "keys are left behind")

    def test_a_step_for_each_body_or_one_for_both(self):
        here = self.local()
        for more in ([], ["--set", "network.processes=1"]):
            shutil.rmtree(self.out, ignore_errors=True)
            (self.shared / "job.sh").unlink(missing_ok=True)
            job = self.submit(*more)
            self.assertEqual(self.wait_for(job), "0:0", self.log(job))
            self.assert_same(here)

    def test_the_exit_code_is_that_of_the_run(self):
        miss = "meta.expect[0].equals=1.0e9"
        job = self.submit("--set", miss)
        self.assertEqual(self.wait_for(job), "1:0", self.log(job))

    def test_a_signal_keeps_the_state_and_the_next_job_goes_on(self):
        here = self.local(*LONG)
        job = self.submit(*LONG)
        self.wait_for_file("history.csv")
        self.slurm.run("scancel", "--batch", "--signal=TERM", job)
        self.assertEqual(self.wait_for(job), "143:0", self.log(job))
        self.assertIn("abut resume", self.log(job))
        again = self.submit()
        self.assertEqual(self.wait_for(again), "0:0", self.log(again))
        self.assertIn("goes on from", self.log(again))
        self.assert_same(here)

    def test_lost_bodies_begin_again(self):
        more = [*LONG, "--set", "output.checkpoint={windows: 2000}", "--set",
                "network.on_lost_body=restart"]
        here = self.local(*more)
        job = self.submit(*more)
        self.wait_for_file("checkpoint.abut")
        os.kill(next(filter(self.is_abut_solver, marked(self.mark))), signal.SIGKILL)
        self.assertEqual(self.wait_for(job, 100.0), "0:0", self.log(job))
        self.assertIn("all bodies go on from", self.log(job))
        self.assert_same(here)

    @staticmethod
    def is_abut_solver(pid: int) -> bool:
        try:
            return Path(f"/proc/{pid}/comm").read_text(encoding="utf-8") == "abut-solver\n"
        except OSError:  # it has ended since
            return False

    def test_every_stage_has_its_processes(self):
        scene = ROOT / "configs" / "contact" / "preload_then_impact.yaml"
        self.succeed(self.abut("run", scene, "--local", "--out", self.folder / "here"))
        script = self.shared / "job.sh"
        self.succeed(self.abut("slurm", scene, "-o", script, "--out", self.out))
        job = self.submit()
        self.assertEqual(self.wait_for(job, 100.0), "0:0")
        self.assert_same(self.summary(self.folder / "here"))

    def test_a_requeued_job_goes_on(self):
        more = [*LONG, "--set", "output.checkpoint={windows: 2000}"]
        here = self.local(*more)
        job = self.submit(*more)
        self.wait_for_file("checkpoint.abut")
        self.slurm.run("scontrol", "requeue", job)
        until = time.monotonic() + 60.0
        while self.told(job)["Restarts"] == "0":  # until then it looks like one that has failed
            self.assertLess(time.monotonic(), until, self.told(job))
            time.sleep(0.1)
        # Slurm lets a requeued job wait for two minutes. The node refuses the job within the second
        # of its requeue (its credentials are revoked by times of whole seconds).
        self.slurm.run("scontrol", "update", f"jobid={job}", "starttime=now+3")
        self.assertEqual(self.wait_for(job, 200.0), "0:0", self.log(job))
        self.assertIn("goes on from", self.log(job))
        self.assert_same(here)


if __name__ == "__main__":
    if sys.argv[3:] != ["Node"]:
        unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
    with tempfile.TemporaryDirectory(dir="/tmp") as place:
        try:
            Node.slurm = SlurmNode(Path(place))
        except (OSError, subprocess.SubprocessError) as error:
            print(f"skipped: {error}")
            sys.exit(77)
        try:
            ended = unittest.main(argv=[sys.argv[0], "Node"], verbosity=2, exit=False)
        finally:
            Node.slurm.close()
    sys.exit(0 if ended.result.wasSuccessful() else 1)
