#!/usr/bin/python3
"""What contact of surfaces costs beside the bodies that touch: ratios of runs that take turns.

usage: contact_cost.py DIRECTORY_OF_PROGRAMS

Prints medians of the ratios of pairs of runs beside their goals: of runs in one process by
processor time less that of their start, of runs in processes by wall time; and the coordinator's
share of the processor time of all processes.
"""

import json
import os
import pathlib
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


def processor_times(pid):
    """User's and system's time [s] of a process that has ended, and of those that it waited for."""
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rsplit(")", 1)[1].split()
    ticks = os.sysconf("SC_CLK_TCK")
    user, system, children, systems = (int(field) / ticks for field in fields[11:15])
    return user + system, children + systems


def run(abut, scene, placement, overrides=()):
    """Of a run [s]: wall time, its own processor time, and that of the bodies' processes."""
    with tempfile.TemporaryDirectory() as out:
        path = pathlib.Path(out, "scene.yaml")
        path.write_text(scene, encoding="utf-8")
        command = [abut, "run", str(path), "--quiet", "--out", out + "/run", *placement]
        for override in ("meta.expect=[]", *overrides):
            command += ["--set", override]
        with open(out + "/errors", "w+", encoding="utf-8") as errors:
            done = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=errors)
            os.waitid(os.P_PID, done.pid, os.WEXITED | os.WNOWAIT)  # its times go with it
            own, bodies = processor_times(done.pid)
            if done.wait() != 0:
                errors.seek(0)
                sys.exit(f"a run ended with {done.returncode}: {errors.read()}")
        timing = json.loads(pathlib.Path(out, "run", "summary.json").read_text())["timing"]
        return timing["wall_s"], own, bodies


def tell(what, values, goal):
    print(f"{what:<78} {statistics.median(values):7.3f}   {goal}", flush=True)


def ratio(abut, what, one, other, goal):
    """Of two scenes in one process, of all but their starts."""

    def solve(scene):
        start = run(abut, scene, ["--local"], ["time.end=1.5e-4"])[1]
        return run(abut, scene, ["--local"])[1] - start

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

    # Of 200 windows in contact: kernels, found once, and starts are in both runs of a pair.
    def later(placement):
        short, long = (run(abut, scene, placement, [f"time.end={end}"]) for end in (4e-4, 12e-4))
        return [b - a for a, b in zip(short, long)]

    shares, ratios = [], []
    for _ in range(BARS_REPEATS):
        wall, own, others = later([])
        shares.append(own / (own + others))
        ratios.append(wall / later(["--local"])[0])
    tell("bars of 46,400 cells in contact: the coordinator's share of the run", shares, "0.10")
    tell("the same: wall time in processes over one process", ratios, "1.2")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    program = str(pathlib.Path(sys.argv[1]) / "abut")
    balls(program)
    bars(program)
