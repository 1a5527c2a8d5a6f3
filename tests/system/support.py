"""What the system tests share: runs in a folder of their own, and a look at what they leave."""

import csv
import json
import math
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
import uuid
from pathlib import Path

ABUT = Path(sys.argv[1]).resolve()
SOLVER = ABUT.with_name("abut-solver")
PACKAGE = ABUT.parents[1] / "share" / "abut" / "python"  # with abut_tools
ROOT = Path(sys.argv[2]).resolve()
CHECKPOINTS = {"checkpoint.abut", "checkpoint.before.abut"}  # of runs that were kept
SLOWER = int(os.environ.get("ABUT_SLOWER", "1"))  # how many times, by sanitizers
SECONDS = 120 * SLOWER  # the longest run takes a few seconds; only a hang takes longer
CONNECTED = "two_bars_processes"  # the scene whose solvers somebody else starts
FILES = {"scene.resolved.yaml", "history.csv", "events.jsonl", "summary.json"}
MOST_CURVES = 8  # of a figure of a page (tools/abut_tools/run_figures.py)
MARK = "ABUT_SYSTEM_TEST"  # in the environment of every process that a test starts


def lacks_library(scene: Path) -> bool:
    """Whether the scene is refused because an optional library was not there at build time."""
    if scene.parent.name != "optional":
        return False
    said = subprocess.run([ABUT, "check", scene, "--probe", "0"], capture_output=True, text=True,
                          check=False)
    return said.returncode == 2 and "this program was built without" in said.stderr


def shared_run(scene: str) -> Path:
    """The run of a shipped scene, named as below configs/, that CTest has made before this test."""
    return Path(sys.argv[3]).resolve() / scene


def measures_of(scene: str) -> dict:
    summary = (shared_run(scene) / "summary.json").read_text(encoding="utf-8")
    return strict_json(summary)["measures"]


def bits(folder: Path) -> tuple:
    """What must not depend on anything but the scene."""
    summary = strict_json((folder / "summary.json").read_text(encoding="utf-8"))
    return (summary["state_hash"], summary["measures"], summary["exchanges"],
            (folder / "history.csv").read_bytes(), (folder / "events.jsonl").read_bytes())


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def marked(mark: str) -> list:
    """Process ids below this one that carry the mark, those that have ended left out."""
    found = []
    wanted = f"{MARK}={mark}".encode()
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            # A process that has ended but is not waited for has no environment any more.
            if wanted in (entry / "environ").read_bytes().split(b"\0"):
                found.append(int(entry.name))
        except OSError:  # it has ended since, or belongs to somebody else
            continue
    return found


def is_solver(pid: int) -> bool:
    try:
        return b"--body" in Path(f"/proc/{pid}/cmdline").read_bytes()
    except OSError:
        return False


def strict_json(text: str) -> object:
    def refuse(word: str):
        raise ValueError(f"{word} is no JSON")
    return json.loads(text, parse_constant=refuse)


class SystemTest(unittest.TestCase):
    """Every test has a folder, a mark on its processes, and a TMPDIR that must end empty."""

    def setUp(self):
        # Short, because the sockets of a run live below it.
        holder = tempfile.TemporaryDirectory(dir="/tmp")
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)
        self.out = self.folder / "out"
        self.temporary = self.folder / "t"
        self.temporary.mkdir()
        self.mark = uuid.uuid4().hex
        self.programs = self.folder / "programs"
        self.environment = {**os.environ, MARK: self.mark, "TMPDIR": str(self.temporary),
                            "ABUT_PROGRAMS": str(self.programs)}
        self.leaves_sockets = False  # only what SIGKILL ends may
        self.addCleanup(self.end_what_is_left)

    def end_what_is_left(self):
        left = self.marked_after(3.0)
        for pid in left:
            os.kill(pid, signal.SIGKILL)
        self.assertEqual(left, [], "processes are left behind")
        if not self.leaves_sockets:
            self.assertEqual(list(self.temporary.iterdir()), [], "temporary files are left behind")

    def allow(self, program: object):
        """Lets scenes start this program."""
        with self.programs.open("a", encoding="utf-8") as file:
            file.write(f"{program}\n")
        self.programs.chmod(0o600)

    def marked_after(self, patience: float) -> list:
        """The processes that are still there when the patience is over."""
        until = time.monotonic() + patience
        while marked(self.mark) and time.monotonic() < until:
            time.sleep(0.02)
        return marked(self.mark)

    def solvers(self, count: int) -> list:
        """The solver processes of a run, as soon as there are so many."""
        until = time.monotonic() + 10.0 * SLOWER
        while time.monotonic() < until:
            found = [pid for pid in marked(self.mark) if is_solver(pid)]
            if len(found) == count:
                return found
            time.sleep(0.01)
        self.fail(f"there are not {count} solvers")

    def start(self, *command: object, **options) -> subprocess.Popen:
        return subprocess.Popen([*map(str, command)], cwd=self.folder, text=True,
                                env=self.environment, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, **options)

    def abut(self, *arguments: object, **options) -> subprocess.CompletedProcess:
        return self.end(self.start(ABUT, *arguments, **options))

    def end(self, process: subprocess.Popen, seconds: float = SECONDS):
        """Waits for the end; a hang ends the test, not the suite."""
        try:
            output, errors = process.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            process.kill()
            output, errors = process.communicate()
            self.fail(f"not ended after {seconds} s: {output}{errors}")
        return subprocess.CompletedProcess(process.args, process.returncode, output, errors)

    def succeed(self, result: subprocess.CompletedProcess) -> subprocess.CompletedProcess:
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return result

    def summary(self, folder: Path = None) -> dict:
        return strict_json(((folder or self.out) / "summary.json").read_text(encoding="utf-8"))

    def events(self, folder: Path = None) -> list:
        text = ((folder or self.out) / "events.jsonl").read_text(encoding="utf-8")
        return [strict_json(line) for line in text.splitlines()]

    def assert_whole(self, folder: Path, rows: int = 2):
        """Every file that docs/OUTPUT.md promises, readable, without a number that is none.

        A run that was cut short may have no more than the row of its begin.
        """
        names = {path.name for path in folder.iterdir()} - CHECKPOINTS
        summary = self.summary(folder)
        tables = ["history.csv"] + (["closed_form.csv"] if "closed_form" in summary else [])
        resolved = (folder / "scene.resolved.yaml").read_text(encoding="utf-8")
        pictures = re.search(r"^output:\n(?:  .*\n)*?  fields:", resolved, re.MULTILINE)
        fields = {"fields", "fields.pvd", "fields.pvsm"} if pictures else set()
        self.assertEqual(names, FILES | fields | set(tables))
        self.events(folder)
        columns = []
        for name in tables:
            with (folder / name).open(encoding="utf-8", newline="") as file:
                header, *body = list(csv.reader(file))
            self.assertGreaterEqual(len(body), rows, f"{name} has rows")
            self.assertEqual({len(row) for row in body}, {len(header)}, f"{name} is rectangular")
            cells = [cell for row in body for cell in row if cell]
            self.assertTrue(all(math.isfinite(float(cell)) for cell in cells), name)
            times = [float(row[0]) for row in body]
            self.assertEqual(times, sorted(times), f"{name} walks forward")
            columns.append((times, header))
        if len(columns) == 2:
            self.assertEqual(columns[0][0], columns[1][0], "both tables have the same times")
            self.assertLessEqual(set(columns[1][1]), set(columns[0][1]), "and the same names")


    def assert_page_tells_the_measures(self, folder: Path):
        """The curves of the energy errors on a run's page, held against the run's own measures."""
        self.succeed(self.abut("report", folder))
        page = (folder / "report.html").read_text(encoding="utf-8")
        data = re.search(r"<script>const figures = (.*?);</script>", page, re.DOTALL)
        drawn = {curve["label"]: curve["y"] for figure in json.loads(data[1])
                 if figure["name"] == "energy_error" for curve in figure["curves"]}
        measures = self.summary(folder)["measures"]
        told = {match[1]: name for name in measures
                if (match := re.fullmatch(r"energy\.(.+)\.relative_(error|drift)_max", name))}
        self.assertIn("total", told)
        least = min((max(map(abs, values)) for body, values in drawn.items()
                     if body != "all bodies"), default=0.0)
        for body, name in told.items():
            of = "all bodies" if body == "total" else body
            percent = [abs(value) for value in drawn.get(of, [])]
            if measures[name] is None:
                self.assertEqual(percent, [], f"{name} has no value, so {of} has no curve")
            elif not percent and len(drawn) >= MOST_CURVES - 1:
                self.assertLessEqual(100.0 * measures[name], least * (1.0 + 1e-6), name)
            elif percent or measures[name] > 1e-15:
                # Cells of the history are exact; pages round to seven digits, differences of
                # energies to an eps of the energy itself.
                self.assertAlmostEqual(max(percent), 100.0 * measures[name],
                                       delta=1e-6 * 100.0 * measures[name] + 1e-12, msg=name)


def main(arguments: int = 2):
    """The tests of a file; the words after its own arguments choose among them."""
    unittest.main(argv=[sys.argv[0], *sys.argv[1 + arguments:]], verbosity=2)
