#!/usr/bin/python3
"""What contact of many points at once costs: two blocks of n x n facets pressed face to face.

usage: many_points.py DIRECTORY_OF_PROGRAMS [--points LIST] [--pair LIST] [--friction MU]
                      [--cells DEPTH] [--windows A,B] [--repeats R] [--set KEY=VALUE]

A block of n x n facets lies before one of (n + 1) x (n + 1): no node meets a node. They collide,
and after a window all points of both press. Two runs of a pair, of A and of B windows, differ by
B - A windows in contact: their difference is what these take, and the rest of the run is its
start (meshes, factors, kernels). One process, processor time, medians over the repeats. Printed
beside the points in contact: start, time a window and point, the same over that of the first size,
sweeps a window, memory.

Pairs: ee both explicit; ie an implicit block finds the contact with an explicit one; ii both
implicit.
"""

import argparse
import json
import os
import pathlib
import statistics
import sys
import tempfile

BLOCK = """  {name}:
    model:
      fe:
        dimension: 3
        mesh: {{box: {{lengths: [{depth}, {side}, {side}], elements: [{cells}, {n}, {n}]}}}}
    material:
      linear_elastic: {{youngs_modulus: 1.0e9, poissons_ratio: 0.3, density: 1000.0}}
    integrator: {{{scheme}: {{step: {step}}}}}
    initial: {{position: [{at}, 0.0, 0.0], velocity: [{speed}, {shear}, 0.0]}}
    ports: {{tip: {{side: {face}}}}}
"""

SCENE = """meta: {{title: many points}}
time: {{begin: 0.0, end: {end}, window: {step}}}
bodies:
{left}{right}interfaces:
  impact:
    sides: [left.tip, right.tip]
    contact: {contact}
    transmission: {{unilateral: {{kinematic: left.tip}}}}
"""

STEP = 2.0e-4  # [s], of facets of 1 m, which a wave crosses in 8.6e-4 s
SCHEMES = {"e": "central_difference", "i": "newmark"}


def scene(n, pair, friction, cells, windows):
    common = dict(cells=cells, depth=float(cells), side=float(n), step=STEP)
    left = BLOCK.format(
        name="left", n=n, scheme=SCHEMES[pair[0]], at=-float(cells), speed=1.0,
        shear=0.5 if friction else 0.0, face="right", **common)
    right = BLOCK.format(
        name="right", n=n + 1, scheme=SCHEMES[pair[1]], at=1.0e-4, speed=-1.0, shear=0.0,
        face="left", **common)
    contact = f"{{friction: {friction}}}" if friction else "{}"
    return SCENE.format(end=windows * STEP, step=STEP, left=left, right=right, contact=contact)


def run(abut, text, overrides=()):
    """Of a run: processor time [s], or None; memory [MiB]; its summary, or what it said."""
    with tempfile.TemporaryDirectory() as out:
        path = pathlib.Path(out, "scene.yaml")
        path.write_text(text, encoding="utf-8")
        command = [abut, "run", str(path), "--quiet", "--local", "--out", out + "/run"]
        for override in overrides:
            command += ["--set", override]
        with open(out + "/errors", "w+", encoding="utf-8") as errors:
            said = [(os.POSIX_SPAWN_DUP2, errors.fileno(), 1),
                    (os.POSIX_SPAWN_DUP2, errors.fileno(), 2)]
            pid = os.posix_spawn(command[0], command, os.environ, file_actions=said)
            _, status, used = os.wait4(pid, 0)
            errors.seek(0)
            words = errors.read().strip()
        memory = used.ru_maxrss / 1024.0
        if status != 0:
            return None, memory, words
        summary = json.loads(pathlib.Path(out, "run", "summary.json").read_text())
        return used.ru_utime + used.ru_stime, memory, summary["measures"]


def measure(abut, n, pair, given):
    """(start [s], [us] a window and point, sweeps, memory [MiB]); exits where a run fails."""
    first, last = (int(w) for w in given.windows.split(","))
    starts, each, memory, sweeps = [], [], 0.0, 0.0
    for _ in range(given.repeats):
        short, long = (
            run(abut, scene(n, pair, given.friction, given.cells, w), given.set)
            for w in (first, last))
        for time, most, said in (short, long):
            if time is None:
                sys.exit(f"a run of {(n + 1) ** 2} points failed at {most:.0f} MiB: {said[:300]}")
            memory = max(memory, most)
        window = (long[0] - short[0]) / (last - first)
        each.append(window * 1.0e6 / (n + 1) ** 2)
        starts.append(short[0] - first * window)
        sweeps = long[2]["schwarz.iterations_mean"]
    return statistics.median(starts), statistics.median(each), sweeps, memory


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("programs")
    parser.add_argument("--points", default="1000,3000,10000,30000")
    parser.add_argument("--pair", default="ee")
    parser.add_argument("--friction", type=float, default=0.0)
    parser.add_argument("--cells", type=int, default=2)
    parser.add_argument("--windows", default="2,6")
    parser.add_argument("--repeats", type=int, default=1)
    parser.add_argument("--set", action="append", default=[])
    given = parser.parse_args()
    abut = str(pathlib.Path(given.programs, "abut").resolve())
    print("pair   points   start s  us/point   ratio  sweeps      MiB")
    for pair in given.pair.split(","):
        least = None
        for points in (int(p) for p in given.points.split(",")):
            n = round(points**0.5) - 1
            start, cost, sweeps, memory = measure(abut, n, pair, given)
            least = least or cost
            print(f"{pair:>4} {(n + 1) ** 2:8d} {start:9.2f} {cost:9.2f} {cost / least:7.2f} "
                  f"{sweeps:7.2f} {memory:8.0f}", flush=True)


if __name__ == "__main__":
    main()
