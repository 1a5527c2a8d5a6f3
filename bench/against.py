#!/usr/bin/python3
"""Two builds of abut against each other: what a change of the code costs whole runs.

usage: against.py DIRECTORY_OF_PROGRAMS [DIRECTORY_OF_OTHER_PROGRAMS]

Prints, for scenes of every kind, the processor time of a run by the first build over that by the
second, with the quartiles over pairs of runs that follow each other; exit code 1 when a lower
quartile is above 1.05, which noise does not explain. With one directory: its build against itself,
which is what noise makes.
"""

import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile

REPEATS = 11
LIMIT = 1.05
CONFIGS = pathlib.Path(__file__).resolve().parent.parent / "configs"
SCENES = ["bars/wall_bounce_thousand", "two_bars_implicit_explicit", "methods/schwarz_published_ie",
          "contact/disks_oblique", "contact/cylinders_oblique", "contact/balls",
          "contact/block_slides_and_stops", "contact/bolted_joint", "contact/bars_3d_hex_tet",
          "joined/torsion_split_four", "joined/cantilever_overlap", "joined/notched_specimen",
          "joined/block_in_four_rests"]


def seconds(abut, scene):
    """Processor time of one run in one process [s]."""
    with tempfile.TemporaryDirectory() as out:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run([abut, "run", CONFIGS / f"{scene}.yaml", "--local", "--quiet",
                               "--out", f"{out}/run"], capture_output=True, text=True, check=False)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if done.returncode != 0:
            sys.exit(f"{abut} run {scene} ended with {done.returncode}: {done.stderr}")
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    now, before = (pathlib.Path(sys.argv[k], "abut") for k in (1, len(sys.argv) - 1))
    too_dear = []
    for scene in SCENES:
        pairs = [(seconds(now, scene), seconds(before, scene)) for _ in range(REPEATS)]
        low, middle, high = statistics.quantiles([a / b for a, b in pairs], n=4)
        print(f"{scene}: {statistics.median(a for a, _ in pairs):.3f} s over "
              f"{statistics.median(b for _, b in pairs):.3f} s, ratio {middle:.3f} "
              f"({low:.3f} to {high:.3f})", flush=True)
        if low > LIMIT:
            too_dear.append(scene)
    if too_dear:
        sys.exit(f"dearer by more than {LIMIT - 1.0:.0%}: {', '.join(too_dear)}")


if __name__ == "__main__":
    main()
