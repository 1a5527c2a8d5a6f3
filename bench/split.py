#!/usr/bin/python3
"""A long explicit bar of hexahedra in two tied processes against one process with two threads.

usage: split.py DIRECTORY_OF_PROGRAMS [CELLS_ACROSS CELLS_ALONG [LAW]]

Prints the time of a step in either way, start and kernels taken off as the difference of runs of
two lengths, and their ratio beside its limit; exit code 1 when that is passed. The default is 1e6
cells of linear_elastic, of 10 x 10 across so that a joint has few rows.
"""

import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

REPEATS = 5
RATIO_LIMIT = 1.15
STEPS = (20, 60)
SCENE = """\
meta: {{title: A long bar shakes}}
time: {{begin: 0.0, end: {end}, window: {window}}}
bodies:
  bar:
    model:
      fe:
        dimension: 3
        mesh:
          box:
            lengths: [{across}.0, {across}.0, {along}.0]
            elements: [{across}, {across}, {along}]
        threads: {threads}
    material: {{{law}: {{youngs_modulus: 1.0, poissons_ratio: 0.25, density: 1.0}}}}
    integrator: {{central_difference: {{step: 0.25}}}}
    initial: {{velocity_field: ["0.01*sin(0.3*z)", "0.01*cos(0.2*z)", "0.01*sin(0.1*z)"]}}
"""


def call(*command):
    done = subprocess.run([*map(str, command)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))} ended with {done.returncode}: {done.stderr}")


def wall(abut, scene, out):
    call(abut, "run", scene, "--quiet", "--force", "--out", out)
    timing = json.loads((out / "summary.json").read_text())["timing"]
    return timing["wall_s"]


def main():
    abut = pathlib.Path(sys.argv[1]).resolve() / "abut"
    across, along = map(int, sys.argv[2:4]) if len(sys.argv) > 3 else (10, 10000)
    law = sys.argv[4] if len(sys.argv) > 4 else "linear_elastic"
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        scenes = {}
        for steps in STEPS:
            for way, threads in (("threads", 2), ("processes", 1)):
                scene = folder / f"{way}_{steps}.yaml"
                scene.write_text(SCENE.format(end=0.25 * steps, window=0.25, across=across,
                                              along=along, threads=threads, law=law))
                if way == "processes":
                    call(abut, "split", scene, "--bodies", 2, "--out", folder / scene.stem)
                    scene = folder / scene.stem / scene.name
                scenes[way, steps] = scene
        each = {"threads": [], "processes": []}
        for _ in range(REPEATS):
            for way, times in each.items():
                first, last = (wall(abut, scenes[way, steps], folder / "run") for steps in STEPS)
                times.append((last - first) / (STEPS[1] - STEPS[0]))
        ratios = [p / t for p, t in zip(each["processes"], each["threads"])]
        low, ratio, high = statistics.quantiles(ratios, n=4)
        print(f"{across * across * along} hex8, a step: one process of two threads "
              f"{1e3 * statistics.median(each['threads']):.1f} ms, two tied processes "
              f"{1e3 * statistics.median(each['processes']):.1f} ms")
        print(f"ratio {ratio:.3f} ({low:.3f} to {high:.3f}), limit {RATIO_LIMIT}")
        sys.exit(1 if low > RATIO_LIMIT else 0)


if __name__ == "__main__":
    main()
