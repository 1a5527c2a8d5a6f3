#!/usr/bin/python3
"""Whole runs of implicit bodies on two threads over one: wall time, and processor time of the
thread that has most, which tells the same where other programs take a core; least of some runs.

A neo-Hookean cube of 104,544 unknowns in statics, most of it factors, and a block of 52,920 in
motion, most of it substitution. Prints ratios beside the goal of the first, 1/1.7; their bits must
be the same.

usage: implicit_threads.py DIRECTORY_OF_PROGRAMS [RUNS]
"""

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SCENE = """\
meta: {title: An implicit block}
time: {begin: 0.0, end: END, window: STEP}
bodies:
  block:
    model: {fe: {dimension: 3, threads: THREADS, mesh: {box: {lengths: SIZE, elements: CELLS}}}}
    material: {neo_hookean: {youngs_modulus: 1.0e9, poissons_ratio: 0.3, density: 1000.0}}
    integrator: {SCHEME: {step: STEP}}
    constraints: {wall: {on: left, fixed: true}}
    loads: {bend: {on: right, traction: ["0", "1.0e7 * min(t / END, 1)", "0"]}}
"""
BODIES = {
    "cube, statics": {"END": "1.0", "STEP": "1.0", "SCHEME": "quasi_static",
                      "SIZE": "[1.0, 1.0, 1.0]", "CELLS": "[32, 32, 32]"},
    "block, motion": {"END": "2.0e-3", "STEP": "1.0e-4", "SCHEME": "newmark",
                      "SIZE": "[2.0, 1.0, 1.0]", "CELLS": "[40, 20, 20]"},
}


def busiest_thread(command: list) -> float:
    """Processor time [s] of the thread that has most, until 10 ms before it ends."""
    taken = {}
    process = subprocess.Popen(command)
    while process.poll() is None:
        for file in Path(f"/proc/{process.pid}/task").glob("*/schedstat"):
            try:
                taken[file.parent.name] = int(file.read_text(encoding="ascii").split()[0]) / 1e9
            except (OSError, IndexError):  # it has ended
                pass
        time.sleep(0.01)
    if process.returncode != 0:
        sys.exit(f"a run ended with {process.returncode}")
    return max(taken.values())


def run(abut: str, words: dict, threads: int) -> tuple:
    """Wall time [s] from the first window to the end, that of the busiest thread, the hash."""
    text = SCENE
    for word, value in {**words, "THREADS": str(threads)}.items():
        text = text.replace(word, value)
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder, "scene.yaml")
        scene.write_text(text, encoding="utf-8")
        busiest = busiest_thread([abut, "run", str(scene), "--local", "--quiet", "--out",
                                  folder + "/run"])
        summary = json.loads(Path(folder, "run", "summary.json").read_text(encoding="utf-8"))
    return summary["timing"]["wall_s"], busiest, summary["state_hash"]


def main():
    abut = str(Path(sys.argv[1], "abut"))
    runs = int(sys.argv[2]) if len(sys.argv) > 2 else 3
    for name, words in BODIES.items():
        taken = {1: [], 2: []}
        for _ in range(runs):
            for threads, list_of in taken.items():
                list_of.append(run(abut, words, threads))
        if len({state for list_of in taken.values() for *_, state in list_of}) != 1:
            sys.exit(f"{name}: threads change bits")
        for what, k in (("wall time", 0), ("the busiest thread's processor time", 1)):
            one, two = (min(times[k] for times in list_of) for list_of in taken.values())
            print(f"{name}, {what}: {one:.2f} s on one thread, {two:.2f} s on two: "
                  f"1 / {one / two:.2f} (goal 1 / 1.7)", flush=True)


if __name__ == "__main__":
    main()
