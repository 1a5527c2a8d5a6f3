#!/usr/bin/env python3
"""What becomes of runs that end at any moment: killed or out of space, and resumed until done.

Each trial runs a scene with checkpoints, ends the coordinator or a solver by SIGKILL at a random
moment, or lets the files grow no further, and resumes it; the end is held against the run that
nothing has ended, byte for byte, and no solver may outlive its trial. Trials go on until every
scene has been killed KILLS times, half of them at its coordinator, and a tenth as often had no
space. Prints docs/RELIABILITY.md; exit code 1 where a trial fails.

usage: reliability.py BIN [KILLS [SEED]]
"""

import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
# A scene of each kind that runs for a while, and windows from one checkpoint to the next.
SCENES = (
    ("two_bars", 20, ["bodies.*.model.fe.mesh.bar.elements=1000",
                      "bodies.*.integrator.*.step=2.0e-8", "output.records_per_window=1"]),
    ("contact/ball_slides_then_rolls_3d", 20, ["time.end=0.02"]),
    ("joined/blocks_2x2x2", 2, []),
    ("robust/dominoes", 60, []),
    ("contact/balls", 10, ["time.end=0.0024"]),
)
PATIENCE = 120.0  # [s] for a whole run
FAREWELL = 20.0  # [s] a solver may outlive its coordinator: silence counts as its end after 10


class Runs:
    def __init__(self, program: Path, scene: str, every: int, overrides: list, folder: Path):
        self.program, self.folder = program, folder
        self.scene = ROOT / "configs" / f"{scene}.yaml"
        self.set = [word for text in [f"output.checkpoint={{windows: {every}}}", "meta.expect=[]",
                                      *overrides] for word in ("--set", text)]
        self.whole = folder / "whole"
        begin = time.monotonic()
        code = self.start("run", self.scene, "--out", self.whole, *self.set).wait(PATIENCE)
        self.seconds = time.monotonic() - begin
        if code != 0:
            sys.exit(f"{scene} ends with {code}")

    def start(self, *words, **options) -> subprocess.Popen:
        return subprocess.Popen([self.program, words[0], *map(str, words[1:]), "--quiet"],
                                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                start_new_session=True, **options)

    def differs(self, out: Path) -> str:
        """The first file that is another one; empty: all are the same."""
        for path in sorted(self.whole.rglob("*")):
            name = path.relative_to(self.whole)
            if path.suffix in (".csv", ".jsonl", ".vtu", ".pvd"):
                if not (out / name).is_file() or (out / name).read_bytes() != path.read_bytes():
                    return str(name)
        one, other = (json.loads((each / "summary.json").read_text(encoding="utf-8"))
                      for each in (self.whole, out))
        return "" if one["state_hash"] == other["state_hash"] else "state hash"


def completed(out: Path) -> bool:
    try:
        summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return False
    return summary["status"] == "completed"


def children(pid: int) -> list:
    try:
        text = Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="utf-8")
        return [int(word) for word in text.split()]
    except OSError:
        return []


def stay(pids: set) -> bool:
    """Whether a solver among those processes is still there in the end."""
    end = time.monotonic() + FAREWELL
    for pid in pids:
        name = Path(f"/proc/{pid}/comm")
        while True:
            try:
                if not name.read_text(encoding="utf-8").startswith("abut"):
                    break  # the number is another process's
                state = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rsplit(") ")[1]
            except OSError:
                break
            if state.startswith("Z"):
                break
            if time.monotonic() > end:
                return True
            time.sleep(0.05)
    return False


def trial(runs: Runs, kind: str, rng: random.Random) -> tuple:
    """How often the run was ended, and what was wrong in the end; empty: nothing."""
    started = set()
    ended, wrong = ends_of(runs, kind, rng, started)
    return ended, wrong or ("a solver stays" if stay(started) else "")


def ends_of(runs: Runs, kind: str, rng: random.Random, started: set) -> tuple:
    """The same but for solvers that stay; adds them to those that were started."""
    out = runs.folder / "out"
    shutil.rmtree(out, ignore_errors=True)
    ended, words = 0, ("run", runs.scene, "--out", out, *runs.set)
    for _ in range(3):
        options = {}
        if kind == "no space":
            most = rng.randrange(1, 1 + max(p.stat().st_size for p in runs.whole.rglob("*")))
            options["preexec_fn"] = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
        run = runs.start(*words, **options)
        if kind != "no space":
            begin = time.monotonic()
            try:
                run.wait(rng.uniform(0.0, runs.seconds))
                if words[0] == "run":  # faster than it was: what else the machine does changes
                    runs.seconds = min(runs.seconds, time.monotonic() - begin)
            except subprocess.TimeoutExpired:
                pass
            solvers = children(run.pid)
            started.update(solvers)
            victim = rng.choice(solvers) if kind == "solver killed" and solvers else run.pid
            if run.poll() is None:
                try:
                    os.kill(victim, signal.SIGKILL)
                except ProcessLookupError:
                    pass
        try:
            code = run.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            run.kill()
            return ended, "hangs"
        if code == 0:
            return ended, runs.differs(out)
        if code not in (-signal.SIGKILL, 3):
            return ended, f"exit code {code}"
        ended += 1
        if completed(out):  # killed after it had told of its end
            return ended, runs.differs(out)
        if any((out / name).is_file() for name in ("checkpoint.abut", "checkpoint.before.abut")):
            words = ("resume", out)
        else:  # ended before the first checkpoint
            words = ("run", runs.scene, "--out", out, "--force", *runs.set)
    code = runs.start(*words).wait(PATIENCE)
    return ended, runs.differs(out) if code == 0 else f"exit code {code}"


def main():
    program = Path(sys.argv[1]).resolve() / "abut"
    kills = int(sys.argv[2]) if len(sys.argv) > 2 else 200
    least = {"coordinator killed": (kills + 1) // 2, "solver killed": (kills + 1) // 2,
             "no space": (kills + 9) // 10}
    rng = random.Random(int(sys.argv[3]) if len(sys.argv) > 3 else 1)
    print("# What runs survive\n\nPrinted by `make reliability`. Each trial ends a run up to three "
          "times at a random moment and resumes it each time;\n`same` are those whose history, "
          "events, fields and state hash are those of the run that nothing has ended,\nbyte for "
          "byte, and of whose solvers none stayed.\n\n"
          "| scene | what ends it | trials | times ended | same |\n|---|---|---|---|---|")
    failed = []
    for scene, every, overrides in SCENES:
        with tempfile.TemporaryDirectory() as folder:
            runs = Runs(program, scene, every, overrides, Path(folder))
            for kind, most in least.items():
                wrong, ended, count = [], 0, 0
                while ended < most:
                    ends, what = trial(runs, kind, rng)
                    ended, count = ended + ends, count + 1
                    if what:
                        wrong.append(what)
                failed += [f"{scene}, {kind}: {what}" for what in wrong]
                print(f"| `{scene}` | {kind} | {count} | {ended} | {count - len(wrong)} |",
                      flush=True)
    print("\nMessages that are dropped, delayed, repeated and damaged: a thousand seeds, and each "
          "single one lost, in\n`tests/transport/at_most_once_test.cpp` (`ctest -R Transport`).")
    if failed:
        print("\n## What was wrong\n")
    for what in failed:
        print(f"- {what}")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
