#!/usr/bin/python3
"""What contact of surfaces costs beside the bodies that touch: ratios of runs that take turns.

usage: contact_cost.py DIRECTORY_OF_PROGRAMS

Prints medians of the ratios of pairs of runs, by processor time of runs in one process and by wall
time of runs in processes, beside their goals.
"""

import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time

REPEATS = 5

BALL = """meta: {{title: cost}}
time: {{begin: 0.0, end: {end}, window: 1.5e-4}}
bodies:
  ball:
    model: {{fe: {{dimension: 3, mesh: {{sphere: {{radius: 0.5, core: 8, layers: 4}}}}}}}}
    material: {{linear_elastic: {{youngs_modulus: 1.0e9, poissons_ratio: 0.3, density: 1000.0}}}}
    integrator: {{central_difference: {{step: 1.5e-5}}}}
    initial: {{position: [0.0, 0.0, {height}], velocity: [0.0, 0.0, -20.0]}}
    ports: {{skin: {{side: {side}}}}}
  wall:
    model:
      rigid_tool:
        dimension: 3
        mesh: {{box: {{lengths: [{size}, {size}, 0.2], elements: [{cells}, {cells}, 1]}}}}
    initial: {{position: [-{half}, -{half}, -0.2]}}
    ports: {{face: {{side: front}}}}
{interfaces}
"""

TOUCH = "interfaces: {impact: {sides: [ball.skin, wall.face], contact: {}}}\n"


def ball(cells=8, touches=True, height=0.51, end=0.006):
    size = 0.25 * cells
    return BALL.format(
        cells=cells,
        size=size,
        half=0.5 * size,
        height=height,
        end=end,
        side="surface",
        interfaces=TOUCH if touches else "",
    )


def run(abut, scene, placement):
    """Processor time of the run's own process [s] and wall time [s]."""
    with tempfile.TemporaryDirectory() as out:
        path = pathlib.Path(out, "scene.yaml")
        path.write_text(scene, encoding="utf-8")
        before, began = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime, time.monotonic()
        done = subprocess.run(
            [abut, "run", str(path), "--quiet", "--out", out + "/run", *placement]
            + ["--set", "meta.expect=[]"],
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode != 0:
            sys.exit(f"a run ended with {done.returncode}: {done.stderr}")
        used = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        return used, time.monotonic() - began


def ratio(abut, what, one, other, goal):
    """Of (scene, placement, which time): one over other."""
    pairs = []
    for _ in range(REPEATS):
        a, b = (run(abut, scene, place)[which] for scene, place, which in (one, other))
        pairs.append(a / b)
    print(f"{what:<72} {statistics.median(pairs):7.3f}   {goal}", flush=True)


def main(abut):
    local = ["--local"]
    far = dict(height=50.0, end=0.06)
    ratio(
        abut,
        "nothing near, over no interface (the layer on the ball's skin included)",
        (ball(**far), local, 0),
        (ball(touches=False, **far), local, 0),
        "1.02",
    )
    for cells in (32, 128):
        ratio(
            abut,
            f"a wall of {cells * cells} facets over one of 64, the same touched",
            (ball(cells=cells), local, 0),
            (ball(), local, 0),
            "1.05",
        )
    bars = pathlib.Path(__file__).resolve().parent.parent / "configs/contact/bars_3d.yaml"
    scene = bars.read_text(encoding="utf-8")
    for old, new in (("[20, 4, 4]", "[80, 16, 16]"), ("[20, 6, 6]", "[80, 18, 18]")):
        scene = scene.replace(old, new)
    scene = scene.replace("1.65e-05", "4.0e-06").replace("0.003003", "0.0004")
    scene = scene.replace("output: {fields: {every: 20}}", "")
    ratio(
        abut,
        "bars of 20,480 and 25,920 cells: wall time in processes over one process",
        (scene, [], 1),
        (scene, local, 1),
        "1.2",
    )


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(str(pathlib.Path(sys.argv[1]) / "abut"))
