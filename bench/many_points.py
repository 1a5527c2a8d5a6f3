#!/usr/bin/python3
"""What contact of many points at once costs: two blocks of n x n facets pressed face to face.

usage: many_points.py DIRECTORY_OF_PROGRAMS [--points LIST] [--pair LIST] [--friction MU]
                      [--cells DEPTH] [--windows A,B] [--repeats R]

A block of n x n facets lies before one of (n + 1) x (n + 1): no node meets a node. They collide, and
after some windows all points of both press. Two runs of a pair, of A and of B windows, differ by
B - A windows in contact: their difference is what these take, and the rest of the run is its start
(meshes, factors, kernels). One process, one thread; medians over the repeats. Printed beside a size:
points in contact, start, time per window and point, the same over that of the smallest size of the
list, sweeps per window, memory.

Pairs: ee both explicit; ie the finder implicit; passive: the nodes that touch have mass.
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

SCENE = """meta: {{title: many points}}
time: {{begin: 0.0, end: {end}, window: {window}}}
bodies:
  left:
    model: {{fe: {{dimension: 3, mesh: {{box: {{lengths: [{depth}, {side}, {side}], elements: [{cells}, {n}, {n}]}}}}}}}}
    material: &steel {{linear_elastic: {{youngs_modulus: 1.0e9, poissons_ratio: 0.3, density: 1000.0}}}}
    integrator: {left}
    initial: {{position: [-{depth}, 0.0, 0.0], velocity: [1.0, {shear}, 0.0]}}
    ports: {{tip: {{side: right}}}}
  right:
    model: {{fe: {{dimension: 3, mesh: {{box: {{lengths: [{depth}, {side}, {side}], elements: [{cells}, {more}, {more}]}}}}}}}}
    material: *steel
    integrator: {right}
    initial: {{position: [{gap}, 0.0, 0.0], velocity: [-1.0, 0.0, 0.0]}}
    ports: {{tip: {{side: left}}}}
interfaces:
  impact:
    sides: [left.tip, right.tip]
    contact: {contact}
{transmission}"""

STEP = 2.0e-4  # [s], of facets of 1 m, which a wave crosses in 8.6e-4 s


def scene(n, pair, friction, cells, windows):
    explicit, implicit = (f"{{{name}: {{step: {STEP}}}}}" for name in ("central_difference", "newmark"))
    left, right = {"ee": (explicit, explicit), "ie": (implicit, explicit),
                   "ii": (implicit, implicit)}.get(pair, (explicit, explicit))
    return SCENE.format(
        end=(windows - 0.5) * STEP if False else windows * STEP,
        window=STEP, depth=float(cells), side=float(n), cells=cells, n=n, more=n + 1,
        left=left, right=right, gap=1.0e-4, shear=0.5 if friction else 0.0,
        contact=f"{{friction: {friction}}}" if friction else "{}",
        transmission="    transmission: {unilateral: {kinematic: left.tip}}\n")


def run(abut, text, overrides=()):
    """Of a run: processor time [s], memory [MiB], and its summary."""
    with tempfile.TemporaryDirectory() as out:
        path = pathlib.Path(out, "scene.yaml")
        path.write_text(text, encoding="utf-8")
        command = [abut, "run", str(path), "--quiet", "--local", "--out", out + "/run"]
        for override in overrides:
            command += ["--set", override]
        with open(out + "/errors", "w+", encoding="utf-8") as errors:
            pid = os.posix_spawn(command[0], command, os.environ,
                                 file_actions=[(os.POSIX_SPAWN_DUP2, errors.fileno(), 2)])
            _, status, used = os.wait4(pid, 0)
            errors.seek(0)
            said = errors.read()
        if status != 0:
            return None, used.ru_maxrss / 1024.0, said.strip()
        summary = json.loads(pathlib.Path(out, "run", "summary.json").read_text())
        return used.ru_utime + used.ru_stime, used.ru_maxrss / 1024.0, summary


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("programs")
    parser.add_argument("--points", default="1000,3000,10000,30000,100000")
    parser.add_argument("--pair", default="ee")
    parser.add_argument("--friction", type=float, default=0.0)
    parser.add_argument("--cells", type=int, default=4)
    parser.add_argument("--windows", default="4,10")
    parser.add_argument("--repeats", type=int, default=1)
    parser.add_argument("--set", action="append", default=[])
    given = parser.parse_args()
    abut = str(pathlib.Path(given.programs, "abut"))
    first, last = (int(w) for w in given.windows.split(","))
    print(f"{'pair':>8} {'points':>8} {'start s':>9} {'us/point':>9} {'ratio':>6} {'sweeps':>7} {'MiB':>8}")
    for pair in given.pair.split(","):
        least = None
        for points in (int(p) for p in given.points.split(",")):
            n = round(points**0.5) - 1
            each, starts, memory, sweeps = [], [], 0.0, 0.0
            for _ in range(given.repeats):
                some = [run(abut, scene(n, pair, given.friction, given.cells, w), given.set)
                        for w in (first, last)]
                memory = max(some[0][1], some[1][1])
                bad = [s for s in some if s[0] is None]
                if bad:
                    print(f"{pair:>8} {(n + 1) ** 2:8d}  {bad[0][2][:200]}  ({memory:.0f} MiB)", flush=True)
                    break
                window = (some[1][0] - some[0][0]) / (last - first)
                each.append(window * 1.0e6 / (n + 1) ** 2)
                starts.append(some[0][0] - first * window)
                sweeps = some[1][2]["measures"]["schwarz.iterations_mean"]
            if len(each) < given.repeats:
                continue
            cost = statistics.median(each)
            least = least or cost
            print(f"{pair:>8} {(n + 1) ** 2:8d} {statistics.median(starts):9.2f} {cost:9.2f} {cost / least:6.2f} "
                  f"{sweeps:7.2f} {memory:8.0f}", flush=True)


if __name__ == "__main__":
    main()
