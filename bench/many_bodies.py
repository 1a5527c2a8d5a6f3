#!/usr/bin/python3
"""Cost of a body and window where everything may touch everything, from 10 to 1000 bodies.

usage: many_bodies.py DIRECTORY_OF_PROGRAMS

Columns of ten disks fall on one floor and on each other, so that a body has as many neighbours in
a scene of a thousand as in one of ten. Prints medians and their ratios to those of ten bodies
beside the limit; exit code 1 when it is passed.
"""

import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

COLUMNS = {1: 9, 10: 3, 100: 1}  # how often each is run
LIMIT = 1.3

SCENE = """\
meta: {{title: Columns of disks}}
time: {{begin: 0.0, end: 0.04, window: 1.0e-3}}
bodies:
  disk:
    copies: {{grid: {{count: [{columns}, 10], spacing: [0.25, 0.2005]}}}}
    model:
      fe: {{dimension: 2, plane: stress, mesh: {{disk: {{radius: 0.1, core: 4, layers: 3}}}}}}
    material: {{linear_elastic: {{youngs_modulus: 1.0e6, poissons_ratio: 0.3, density: 1000.0}}}}
    integrator: {{central_difference: {{step: 1.0e-4}}}}
    ports: {{skin: {{side: mantle}}}}
    initial: {{position: [0.0, 0.1015], velocity: [0.0, -0.2]}}
  floor:
    model:
      rigid_tool:
        dimension: 2
        mesh: {{rectangle: {{lengths: [{width}, 0.1], elements: [1, 1]}}}}
        way: ["0", "0"]
    initial: {{position: [-1.0, -0.1]}}
    ports: {{face: {{side: top}}}}
contact: {{everything: {{friction: 0.3}}}}
schwarz: {{tolerance: 1.0e-3}}
"""


def cost(abut, columns):
    """[us] of wall time per body and window, sweeps per window, of one run."""
    with tempfile.TemporaryDirectory() as out:
        scene = pathlib.Path(out, "scene.yaml")
        scene.write_text(SCENE.format(columns=columns, width=2.0 + 0.25 * columns),
                         encoding="utf-8")
        command = [abut, "run", str(scene), "--local", "--quiet", "--out", out + "/run"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"{' '.join(command)} ended with {done.returncode}: {done.stderr}")
        summary = json.loads(pathlib.Path(out, "run", "summary.json").read_text(encoding="utf-8"))
    work = (10 * columns + 1) * summary["windows"]
    return (1.0e6 * summary["timing"]["wall_s"] / work,
            summary["measures"]["schwarz.iterations_mean"])


def main():
    """Prints the figures; the exit code says whether they keep their limit."""
    abut = str(pathlib.Path(sys.argv[1]) / "abut")
    first, passed = None, True
    for columns, repeats in COLUMNS.items():
        runs = [cost(abut, columns) for _ in range(repeats)]
        median = statistics.median(run[0] for run in runs)
        first = first or median
        ratio = median / first
        passed = passed and ratio <= LIMIT
        print(f"{10 * columns:5d} bodies: {median:7.1f} us per body and window, "
              f"{ratio:.2f} of ten bodies (limit {LIMIT}), {runs[0][1]:.2f} sweeps per window",
              flush=True)
    sys.exit(0 if passed else 1)


if __name__ == "__main__":
    main()
