"""Goal: `abut run` keeps its promises to shells: exit codes, silence, files, and no process left.

Oracles: the exit codes of docs/USE.md, the run directory, the process table.
usage: test_command_line.py ABUT ROOT
"""

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

ABUT = Path(sys.argv[1]).resolve()
ROOT = Path(sys.argv[2]).resolve()
# Runs take well below a second, many times that by sanitizers; only a hang takes longer.
SECONDS = 60 * int(os.environ.get("ABUT_SLOWER", "1"))

SCENE = """\
meta:
  title: Two bars collide
  expect:
    - {measure: momentum.total, equals: 0.0, absolute: 1.0e-12, because: round-off}
time: {begin: -2.0e-4, end: 8.0e-4, window: 1.0e-5}
bodies:
  left:
    model: {fe: {dimension: 1, mesh: {bar: {length: 0.25, elements: 50, area: 1.0e-6}}}}
    material: {linear_elastic: {youngs_modulus: 1.0e9, density: 1000.0}}
    integrator: {central_difference: {step: 1.0e-6}}
    initial: {position: [-0.27], velocity: [100.0]}
    ports: {tip: {side: right}}
  right:
    model: {fe: {dimension: 1, mesh: {bar: {length: 0.25, elements: 50, area: 1.0e-6}}}}
    material: {linear_elastic: {youngs_modulus: 1.0e9, density: 1000.0}}
    integrator: {central_difference: {step: 1.0e-6}}
    initial: {position: [0.02], velocity: [-100.0]}
    ports: {tip: {side: left}}
interfaces:
  impact: {sides: [left.tip, right.tip], contact: {}}
"""
# The bars part again after the impact: what follows is free flight for minutes.
LONG = ["--set", "time={begin: -2.0e-4, end: 9998.0e-4, window: 1.0e-5}",
        "--set", "bodies.left.integrator={central_difference: {step: 1.0e-9}}",
        "--set", "bodies.right.integrator={central_difference: {step: 1.0e-9}}"]


def children_of(parent: int) -> list:
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            text = stat.read_text(encoding="utf-8")
        except OSError:  # it has ended since
            continue
        state, father = text.rsplit(")", 1)[1].split()[:2]
        if int(father) == parent and state != "Z":
            found.append(int(stat.parent.name))
    return found


class CommandLine(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)
        self.scene = self.folder / "scene.yaml"
        self.scene.write_text(SCENE, encoding="utf-8")
        self.out = self.folder / "out"

    def abut(self, *arguments: object, cwd=None) -> subprocess.CompletedProcess:
        return subprocess.run([ABUT, *map(str, arguments)], cwd=cwd or self.folder,
                              capture_output=True, text=True, timeout=SECONDS, check=False)

    def state_hash(self, folder: Path) -> str:
        return json.loads((folder / "summary.json").read_text(encoding="utf-8"))["state_hash"]

    def test_a_run_that_meets_its_expectations_ends_with_0_and_a_table(self):
        result = self.abut("run", self.scene, "--local", "--out", self.out)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("momentum.total", result.stdout)
        names = {path.name for path in self.out.iterdir()}
        self.assertLessEqual({"scene.resolved.yaml", "history.csv", "events.jsonl", "summary.json"},
                             names)

    def test_a_run_that_misses_an_expectation_ends_with_1(self):
        miss = "meta.expect[0]={measure: momentum.total, at_least: 1.0, because: it cannot}"
        result = self.abut("run", self.scene, "--local", "--quiet", "--out", self.out,
                           "--set", miss)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("it cannot", result.stdout)

    def test_a_quiet_run_that_is_fine_says_nothing(self):
        result = self.abut("run", self.scene, "--local", "--quiet", "--out", self.out)
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))

    def test_without_out_the_run_is_named_after_its_scene(self):
        result = self.abut("run", self.scene, "--local", "--quiet")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue((self.folder / "runs" / "scene" / "summary.json").is_file())

    def test_force_replaces_a_run_and_leaves_other_files(self):
        self.out.mkdir()
        for name in ("summary.json", "report.html", "notes.txt"):
            (self.out / name).write_text("old", encoding="utf-8")
        result = self.abut("run", self.scene, "--local", "--quiet", "--force", "--out", self.out)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotEqual((self.out / "summary.json").read_text(encoding="utf-8"), "old")
        self.assertFalse((self.out / "report.html").exists(), "it would show the old run")
        self.assertEqual((self.out / "notes.txt").read_text(encoding="utf-8"), "old")

    def test_the_resolved_scene_runs_to_the_same_state(self):
        again = self.folder / "again"
        for scene, out in ((self.scene, self.out), (self.out / "scene.resolved.yaml", again)):
            result = self.abut("run", scene, "--local", "--quiet", "--out", out)
            self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.state_hash(again), self.state_hash(self.out))

    def test_a_signal_ends_the_run_and_its_bodies(self):
        for sent, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            for placement in ([], ["--local"]):
                with self.subTest(signal=sent, placement=placement):
                    command = [ABUT, "run", self.scene, "--out", self.out, "--force", *placement,
                               *LONG]
                    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                          text=True) as run:
                        time.sleep(1.0)  # it has bodies by now
                        bodies = children_of(run.pid)
                        self.assertEqual(len(bodies), 0 if placement else 2)
                        run.send_signal(sent)
                        _, errors = run.communicate(timeout=SECONDS)
                    self.assertEqual(run.returncode, code, errors)
                    for body in bodies:
                        self.assertFalse(os.path.exists(f"/proc/{body}"), "a process is left")

    def test_a_verb_of_another_program_gets_its_arguments_and_decides_the_exit_code(self):
        program = self.folder / "abut-echo"
        program.write_text('#!/bin/sh\necho "$@"\nexit 7\n', encoding="utf-8")
        program.chmod(0o755)
        environment = {**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}"}
        result = subprocess.run([ABUT, "echo", "a b", "--set"], env=environment, text=True,
                                capture_output=True, timeout=SECONDS, check=False)
        self.assertEqual((result.returncode, result.stdout), (7, "a b --set\n"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
