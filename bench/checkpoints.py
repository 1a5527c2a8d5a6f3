#!/usr/bin/python3
"""What checkpoints cost: runs with them against the same runs without.

usage: checkpoints.py DIRECTORY_OF_PROGRAMS

Prints medians of pairs of runs that follow each other beside their limits; exit code 1 when a limit
is passed. Cost is processor time, of all processes of a run: what other programs take of the
machine does not count, nor does the wait for the disk. So that a checkpoint is measured many times
over in a short run, runs are kept far more often than the limits are for.
"""

import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

SCENES = pathlib.Path(__file__).resolve().parent.parent / "configs"
# Of the run, with one every 100 windows. In one process a run takes half the time, and a checkpoint
# nearly what it takes in processes: most of it is the disk's.
PLACES = (("in processes", [], 0.03), ("--local", ["--local"], 0.05))
SOLIDS_LIMIT = 0.05  # of a minute, with one in it
# The shipped scene with windows of ten steps: 1000 of them, 500 of which are kept.
BARS = ["time.window=1.0e-6"]
BARS_KEPT = 500
BARS_MEANT = 10  # one every 100 windows
# 2 x 50,000 cells on their way to contact; a window is a step.
WINDOWS = 20
SOLIDS = ["time={begin: 0.0, end: 4.0e-5, window: 2.0e-6}", "output={}"] + [
    override
    for body in ("left", "right")
    for override in (
        f"bodies.{body}.model.fe.mesh.box.elements=[125, 20, 20]",
        f"bodies.{body}.integrator.central_difference.step=2.0e-6")
]


def run(abut: str, scene: str, overrides: list, placement: list) -> tuple:
    """Processor time [s] of a run, and the bytes of its latest checkpoint; 0: there is none."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder, "run")
        command = [abut, "run", str(SCENES / scene), "--quiet", "--out", str(out), *placement]
        for override in ["meta.expect=[]", *overrides]:
            command += ["--set", override]
        with subprocess.Popen(command, stdout=subprocess.DEVNULL) as process:
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            sys.exit(f"{' '.join(command)} ended with {process.returncode}")
        kept = out / "checkpoint.abut"
        return used.ru_utime + used.ru_stime, kept.stat().st_size if kept.is_file() else 0


def costs(abut: str, scene: str, overrides: list, placement: list, every: int, kept: int,
          count: int) -> tuple:
    """Of pairs of runs: median [s] of those without checkpoints, quartiles [s] of what each of the
    `kept` checkpoints of the others costs, one `every` so many windows, and its bytes."""
    without, each, size = [], [], 0
    for _ in range(count):
        without.append(run(abut, scene, overrides, placement)[0])
        checkpoints = f"output.checkpoint={{windows: {every}}}"
        spent, size = run(abut, scene, [*overrides, checkpoints], placement)
        each.append((spent - without[-1]) / kept)
    return statistics.median(without), statistics.quantiles(each, n=4), size


def main():
    abut = str(pathlib.Path(sys.argv[1]) / "abut")
    failed = False
    for name, placement, limit in PLACES:
        whole, quartiles, size = costs(abut, "two_bars.yaml", BARS, placement, 2, BARS_KEPT, 11)
        low, share, high = (BARS_MEANT * each / whole for each in quartiles)
        # Noise does not decide: the limit is passed when the lower quartile is.
        failed = failed or low > limit
        print(f"two bars {name}: {whole:.3f} s; a checkpoint of {size} bytes "
              f"{1e3 * quartiles[1]:.2f} ms: one every 100 of 1000 windows {100 * share:.1f} % "
              f"({100 * low:.1f} to {100 * high:.1f} %), limit {100 * limit:.0f} %")
    whole, quartiles, size = costs(abut, "contact/bars_3d.yaml", SOLIDS, ["--local"], 1, WINDOWS, 3)
    low, share, high = (each / 60.0 for each in quartiles)
    failed = failed or low > SOLIDS_LIMIT
    print(f"solids of 1e5 cells: {whole:.2f} s for {WINDOWS} windows; a checkpoint of {size} bytes "
          f"{1e3 * quartiles[1]:.0f} ms: one a minute {100 * share:.3f} % ({100 * low:.3f} to "
          f"{100 * high:.3f} %), limit {100 * SOLIDS_LIMIT:.0f} %")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
