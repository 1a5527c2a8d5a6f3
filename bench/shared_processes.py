#!/usr/bin/python3
"""Whole runs of bodies that share processes, against a process for each body and against --local.

usage: shared_processes.py DIRECTORY_OF_PROGRAMS

Prints medians and ratios beside their limits; exit code 1 when a limit is passed. Ratios are of
runs that follow each other; they pass their limit when the lower quartile does, so that noise does
not decide.
"""

import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

REPEATS = 9
REPEATS_OF_MANY = 5
TWO_BARS = pathlib.Path(__file__).resolve().parent.parent / "configs" / "two_bars.yaml"
# One connection and no second process to wake: an exchange costs no more than with a process each.
RATIO_LIMIT = 1.0

HEAD = """\
meta: {title: Pairs of squares of which each flies against the other}
time: {begin: 0.0, end: 0.02, window: 1.0e-3}
bodies:
  b0:
    model: {fe: {dimension: 2, mesh: {rectangle: {lengths: [1.0, 1.0], elements: [2, 2]}}}}
    material: {linear_elastic: {youngs_modulus: 1.0e6, poissons_ratio: 0.3, density: 1000.0}}
    integrator: {central_difference: {step: 1.0e-3}}
    initial: {position: [0.0, 0.0], velocity: [0.1, 0.0]}
"""
PORTS = "    ports: {left: {side: left}, right: {side: right}}\n"


def squares(count, meet):
    """Text of a scene of so many squares, two and two one behind the other."""
    text = HEAD + (PORTS if meet else "")
    for i in range(1, count):
        place = 3.0 * (i // 2) + (1.001 if i % 2 else 0.0)
        speed = -0.1 if i % 2 else 0.1
        text += (f"  b{i}: {{like: b0, initial: {{position: [{place:g}, 0.0], "
                 f"velocity: [{speed:g}, 0.0]}}}}\n")
    if meet:
        text += "interfaces:\n"
        for i in range(0, count - 1, 2):
            text += f"  c{i}: {{sides: [b{i}.right, b{i + 1}.left], contact: {{}}}}\n"
    return text


def run(abut, scene, *arguments):
    """Summary of one run."""
    with tempfile.TemporaryDirectory() as out:
        command = [abut, "run", str(scene), "--quiet", "--out", out + "/run", *arguments]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"{' '.join(command)} ended with {done.returncode}: {done.stderr}")
        return json.loads(pathlib.Path(out, "run", "summary.json").read_text())


def dealt(processes):
    """Arguments that place all bodies in so many processes."""
    return ("--set", f"network.processes={processes}")


def quartiles_of_ratio(abut, scene, one, other):
    """Of the wall times of runs with the one placement over those with the other."""
    ratios = []
    for _ in range(REPEATS):
        first, second = run(abut, scene, *one), run(abut, scene, *other)
        if first["state_hash"] != second["state_hash"]:
            sys.exit(f"{scene}: the placements differ in their bits")
        ratios.append(first["timing"]["wall_s"] / second["timing"]["wall_s"])
    return statistics.quantiles(ratios, n=4)


def many(abut, folder, count, meet, placements):
    """Median start-up and wall of a scene of many bodies, by placement."""
    scene = pathlib.Path(folder) / f"{count}_{meet}.yaml"
    scene.write_text(squares(count, meet), encoding="utf-8")
    kind = "pairs that meet" if meet else "that fly"
    hashes = set()
    for name, arguments in placements.items():
        runs = [run(abut, scene, *arguments) for _ in range(REPEATS_OF_MANY)]
        hashes |= {summary["state_hash"] for summary in runs}
        walls = sorted(summary["timing"]["wall_s"] for summary in runs)
        wall = statistics.median(walls)
        start = statistics.median(summary["timing"]["startup_s"] for summary in runs)
        exchanges, windows = runs[0]["exchanges"], runs[0]["windows"]
        print(f"{count:5} squares {kind:16} {name:13} start-up {start:7.3f} s, wall {wall:7.3f} s "
              f"({walls[0]:.3f} to {walls[-1]:.3f}): "
              f"{wall / count / windows * 1e6:7.2f} us a body and window, "
              f"{wall / exchanges * 1e6:7.1f} us an exchange")
    if len(hashes) != 1:
        sys.exit(f"{scene}: the placements differ in their bits")


def main():
    """Runs all comparisons."""
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    abut = str(pathlib.Path(sys.argv[1]).resolve() / "abut")
    low, ratio, high = quartiles_of_ratio(abut, TWO_BARS, dealt(1), dealt(2))
    passed = low <= RATIO_LIMIT
    print(f"two_bars.yaml, both bodies in one process over a process each: {ratio:.3f}, quartiles "
          f"{low:.3f} to {high:.3f}; lower quartile at most {RATIO_LIMIT:.3f}"
          f"{'' if passed else ' PASSED THE LIMIT'}")
    with tempfile.TemporaryDirectory() as folder:
        few = {"here": ("--local",), "60 processes": (), "1 process": dealt(1),
               "2 processes": dealt(2), "8 processes": dealt(8)}
        most = {"here": ("--local",), "2 processes": dealt(2), "8 processes": dealt(8)}
        many(abut, folder, 60, True, few)
        many(abut, folder, 200, True, most)
        many(abut, folder, 200, False, most)
        many(abut, folder, 1000, False, most)
    sys.exit(0 if passed else 1)


if __name__ == "__main__":
    main()
