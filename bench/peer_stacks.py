#!/usr/bin/python3
"""What a step of bodies that go passively costs, by node and by contact.

usage: peer_stacks.py DIRECTORY_OF_PROGRAMS

Walls of five layers of tetrahedral cubes fall onto a floor and onto each other, as a stack of the
peer does that docs/ROBUSTNESS.md names: its law, its steps of 25 ms, its scheme, no friction. A
wall of more bricks has more contacts in one island. Prints processor time less that of the start,
by step that was taken and node, and its growth by the number of pairs in contact; exit code 1
where that grows faster than the pairs do.
"""

import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

WIDTHS = (1, 2, 4, 8, 16)
CELLS = 2
LIMIT = 1.1  # exponent of the pairs: 1 is linear, and times of short runs scatter by a tenth

BRICK = """\
  brick_{row}_{column}:
    model:
      fe:
        dimension: 3
        mesh: {{box: {{lengths: [1, 1, 1], elements: [{cells}, {cells}, {cells}], element: tet4}}}}
    material: {{neo_hookean: {{youngs_modulus: 1.0e6, poissons_ratio: 0.4, density: 1000.0}}}}
    integrator: {{generalized_alpha: {{spectral_radius: 0.0, step: 0.025}}}}
    body_force: [0.0, -9.80665, 0.0]
    initial: {{position: [{x:.3f}, {y:.3f}, 0.0]}}
    ports: {{skin: {{side: boundary}}}}
"""

FLOOR = """\
  floor:
    model:
      rigid_tool:
        dimension: 3
        mesh: {{box: {{lengths: [{length}, 0.5, 4.0], elements: [1, 1, 1]}}}}
    initial: {{position: [-1.0, -0.5, -1.5]}}
    ports: {{skin: {{side: boundary}}}}
contact: {{everything: {{}}}}
"""


def scene(width, end):
    """A wall of five rows, each brick over the joint of two below."""
    bricks = [
        BRICK.format(row=row, column=column, cells=CELLS, x=1.01 * column + 0.5 * (row % 2),
                     y=0.003 + 1.003 * row)
        for row in range(5)
        for column in range(width)
    ]
    head = f"meta: {{title: wall}}\ntime: {{begin: 0.0, end: {end}, window: 0.025}}\nbodies:\n"
    return head + "".join(bricks) + FLOOR.format(length=width + 3.0)


def processor_time(command):
    """User's and system's time [s] of a command that must end well."""
    before = os.times()
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    after = os.times()
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)} ended with {done.returncode}: {done.stderr}")
    return (after.children_user - before.children_user
            + after.children_system - before.children_system)


def passed_steps(summary):
    """Steps that were taken: shorter ones of the passive way, and windows of the accurate one."""
    given_up = summary["accuracy"]["given_up"]
    return given_up["passive_steps"] + summary["windows"] - given_up["passive_windows"]


def cost(abut, width):
    """Processor time of the windows [s], steps, and the part of the windows that were passive."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "scene.yaml")
        seconds = []
        for end in (0.025, 0.5):  # the first: reading, building, and a step in flight
            path.write_text(scene(width, end), encoding="utf-8")
            run = [abut, "run", str(path), "--local", "--quiet", "--force", "--out", folder + "/o"]
            seconds.append(processor_time(run))
        summary = json.loads(pathlib.Path(folder, "o", "summary.json").read_text(encoding="utf-8"))
    share = summary["accuracy"]["given_up"]["passive_windows"] / summary["windows"]
    return seconds[1] - seconds[0], passed_steps(summary), share


def main():
    """Prints the figures; the exit code says whether the exponent keeps its limit."""
    abut = str(pathlib.Path(sys.argv[1]) / "abut")
    nodes = (CELLS + 1) ** 3
    pairs, times = [], []
    for width in WIDTHS:
        seconds, steps, share = cost(abut, width)
        pairs.append(width + 4 * (2 * width - 1))  # on the floor, and over the joints below
        times.append(seconds / steps)
        each = 1e6 * times[-1] / (5 * width * nodes)
        print(f"{5 * width:4d} bodies, {pairs[-1]:4d} pairs: {each:6.1f} us by step and node, "
              f"{1e3 * times[-1] / pairs[-1]:6.2f} ms by step and pair; {steps} steps, "
              f"{100 * share:.0f} % of the windows passive", flush=True)
    logs = [(math.log(p), math.log(t)) for p, t in zip(pairs, times)]
    mean = [sum(column) / len(logs) for column in zip(*logs)]
    exponent = (sum((p - mean[0]) * (t - mean[1]) for p, t in logs)
                / sum((p - mean[0]) ** 2 for p, _ in logs))
    print(f"grows as the pairs to the power of {exponent:.2f} (limit {LIMIT})")
    sys.exit(0 if exponent <= LIMIT else 1)


if __name__ == "__main__":
    main()
