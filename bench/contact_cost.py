#!/usr/bin/python3
"""What contact of surfaces costs beside the bodies that touch: ratios of runs that take turns.

usage: contact_cost.py DIRECTORY_OF_PROGRAMS

Prints medians of the ratios of pairs of runs beside their goals: of runs in one process by
processor time less that of their start, of runs in processes by wall time; and the coordinator's
share.
"""

import json
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile

REPEATS = 5
BARS_REPEATS = 3

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


def run(abut, scene, placement, overrides=()):
    """Processor time of the run's own process [s], and what it tells of its times."""
    with tempfile.TemporaryDirectory() as out:
        path = pathlib.Path(out, "scene.yaml")
        path.write_text(scene, encoding="utf-8")
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        command = [abut, "run", str(path), "--quiet", "--out", out + "/run", *placement]
        for override in ("meta.expect=[]", *overrides):
            command += ["--set", override]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"a run ended with {done.returncode}: {done.stderr}")
        used = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        return used, json.loads(pathlib.Path(out, "run", "summary.json").read_text())["timing"]


def tell(what, values, goal):
    print(f"{what:<78} {statistics.median(values):7.3f}   {goal}", flush=True)


def ratio(abut, what, one, other, goal):
    """Of two scenes in one process, of all but their starts."""

    def solve(scene):
        start = run(abut, scene, ["--local"], ["time.end=1.5e-4"])[0]
        return run(abut, scene, ["--local"])[0] - start

    tell(what, [solve(one) / solve(other) for _ in range(REPEATS)], goal)


def balls(abut):
    far = dict(height=50.0, end=0.06)
    ratio(
        abut,
        "nothing near, over no interface (the layer on the ball's skin included)",
        ball(**far),
        ball(touches=False, **far),
        "1.02",
    )
    ratio(
        abut,
        "nothing near but looked for in every window, over a partner beyond the horizon",
        ball(height=1.72, end=0.06),
        ball(**far),
        "1.02",
    )
    for cells in (32, 128):
        ratio(
            abut,
            f"a wall of {cells * cells} facets over one of 64, the same touched",
            ball(cells=cells),
            ball(),
            "1.05",
        )


def bars(abut):
    """Of 46,400 cells together, 16 x 16 facets on 18 x 18."""
    path = pathlib.Path(__file__).resolve().parent.parent / "configs/contact/bars_3d.yaml"
    scene = path.read_text(encoding="utf-8")
    for old, new in (("[20, 4, 4]", "[80, 16, 16]"), ("[20, 6, 6]", "[80, 18, 18]")):
        scene = scene.replace(old, new)
    scene = scene.replace("1.65e-05", "4.0e-06").replace("0.003003", "0.0004")
    scene = scene.replace("output: {fields: {every: 20}}", "")
    # Of 100 windows in contact: kernels, found once, and starts are in both runs of a pair.
    def later(placement):
        short, long = (run(abut, scene, placement, [f"time.end={end}"])[1] for end in (4e-4, 8e-4))
        wall = long["wall_s"] - short["wall_s"]
        return wall, sum(long["compute_s"].values()) - sum(short["compute_s"].values())

    shares, ratios = [], []
    for _ in range(BARS_REPEATS):
        wall, bodies = later(["--local"])
        shares.append(1.0 - bodies / wall)
        ratios.append(later([])[0] / wall)
    tell("bars of 46,400 cells in contact: the coordinator's share of the run", shares, "0.10")
    tell("the same: wall time in processes over one process", ratios, "1.2")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    program = str(pathlib.Path(sys.argv[1]) / "abut")
    balls(program)
    bars(program)
