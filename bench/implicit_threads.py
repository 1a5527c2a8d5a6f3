#!/usr/bin/python3
"""Whole runs of implicit bodies on two threads over one: wall time, least of some runs.

A neo-Hookean cube of 104,544 unknowns in statics, most of it factors, and a block of 52,920 in
motion, most of it substitution. Prints ratios beside the goal of the first, 1/1.7; their bits must
be the same.

usage: implicit_threads.py DIRECTORY_OF_PROGRAMS [RUNS]
"""

import json
import subprocess
import sys
import tempfile
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


def run(abut: str, words: dict, threads: int) -> tuple:
    """Wall time [s] from the first window to the end, and the state's hash."""
    text = SCENE
    for word, value in {**words, "THREADS": str(threads)}.items():
        text = text.replace(word, value)
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder, "scene.yaml")
        scene.write_text(text, encoding="utf-8")
        subprocess.run([abut, "run", str(scene), "--local", "--quiet", "--out", folder + "/run"],
                       check=True)
        summary = json.loads(Path(folder, "run", "summary.json").read_text(encoding="utf-8"))
    return summary["timing"]["wall_s"], summary["state_hash"]


def main():
    abut = str(Path(sys.argv[1], "abut"))
    runs = int(sys.argv[2]) if len(sys.argv) > 2 else 3
    for name, words in BODIES.items():
        taken = {1: [], 2: []}
        for _ in range(runs):
            for threads, list_of in taken.items():
                list_of.append(run(abut, words, threads))
        if len({state for list_of in taken.values() for _, state in list_of}) != 1:
            sys.exit(f"{name}: threads change bits")
        one, two = (min(wall for wall, _ in list_of) for list_of in taken.values())
        print(f"{name}: {one:.2f} s on one thread, {two:.2f} s on two: 1 / {one / two:.2f} "
              "(goal 1 / 1.7)", flush=True)


if __name__ == "__main__":
    main()
