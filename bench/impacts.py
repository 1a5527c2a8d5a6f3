#!/usr/bin/python3
"""Figures of impacts of surfaces that no scene's expectation tells: noise of the force, three
dimensions with 200 elements along a bar, contact that stays, and the problem of the peers.

usage: impacts.py DIRECTORY_OF_PROGRAMS

Prints every figure beside its goal. Nothing is timed: figures are the same on every machine.
"""

import csv
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

SCENES = pathlib.Path(__file__).resolve().parent.parent / "configs" / "contact"


def run(abut, scene, overrides):
    """Measures and history of one run."""
    summary, history = results(abut, scene, overrides)
    return summary["measures"], history


def results(abut, scene, overrides):
    """Summary and history of one run."""
    with tempfile.TemporaryDirectory() as out:
        command = [abut, "run", str(SCENES / scene), "--local", "--quiet", "--out", out + "/run"]
        for override in [*overrides, "meta.expect=[]", "output=null"]:
            command += ["--set", override]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"{' '.join(command)} ended with {done.returncode}: {done.stderr}")
        summary = json.loads(pathlib.Path(out, "run", "summary.json").read_text())
        with open(pathlib.Path(out, "run", "history.csv"), encoding="utf-8") as table:
            return summary, list(csv.DictReader(table))


def noise(history, column="left.tip.force_x [N]"):
    """Standard deviation over mean of the force from 5 to 95 % of the contact."""
    force = [abs(float(row[column])) for row in history]
    pressed = [i for i, f in enumerate(force) if f > 0.0]
    first, length = pressed[0], pressed[-1] - pressed[0]
    middle = force[first + round(0.05 * length) : first + round(0.95 * length) + 1]
    return statistics.pstdev(middle) / statistics.mean(middle)


def tell(what, value, goal):
    print(f"{what:<66} {value:>12}   {goal}")


def bars(along, across, step):
    """Overrides that give both bars of bars_2d or bars_3d as many elements."""
    window = f"time={{begin: 0.0, end: {3.0e-3 + 10 * step}, window: {step}}}"
    return [window] + [
        override
        for body, cells in zip(("left", "right"), across)
        for override in (
            f"bodies.{body}.model.fe.mesh.{'box' if len(cells) > 1 else 'rectangle'}.elements="
            + str([along, *cells]),
            f"bodies.{body}.integrator={{central_difference: {{step: {step}}}}}",
        )
    ]


def percent(value):
    return f"{100.0 * value:.4f} %"


def impacts(abut):
    for along, goal in ((80, "0.5 %"), (200, "0.02 %")):
        _, history = run(abut, "bars_2d.yaml", bars(along, ([2], [3]), 0.5e-3 / along))
        tell(f"bars in the plane, {along} along: noise of the force", percent(noise(history)), goal)
    measures, history = run(abut, "bars_3d.yaml", bars(200, ([4, 4], [6, 6]), 0.33e-3 / 200))
    drift = measures["energy.total.relative_drift_end"]
    tell("bars in space, 200 along, 4 x 4 on 6 x 6: energy", percent(drift), "0.01 %")
    tell("the same: noise of the force", percent(noise(history)), "0.02 %")


def peers(abut):
    measures, history = run(abut, "bars_3d.yaml", bars(50, ([5, 5], [5, 5]), 0.33e-3 / 50))
    before, after = (
        float(history[i]["right.momentum_x [kg m/s]"])
        - float(history[i]["left.momentum_x [kg m/s]"])
        for i in (0, -1)
    )
    tell("two bars of 50 x 5 x 5 cells: rebound", f"{after / before:.4f}", "peers -0.98 to -0.996")
    tell("the same: ripple of the force", percent(noise(history)), "peers 3 to 80 %")
    kept = 1.0 + measures["energy.total.relative_drift_end"]
    tell("the same: energy kept", f"{kept:.6f}", "peers 0.98 to 1.001")


def persistent(abut):
    """Two bars pressed together over 50 of their transits of 1 ms, the load rising within five."""
    push = "1.0e5 * (1 - exp(-t / 1.0e-3))"
    overrides = [
        "schwarz={energy_guard: 1.0}",  # of the energy so far, which begins at nothing
        "time={begin: 0.0, end: 0.05, window: 5.0e-5}",
        "bodies.left.initial={position: [-1.0, 0.0]}",
        "bodies.right.initial={position: [0.0, 0.0]}",
        f"bodies.left.loads={{push: {{on: left, traction: [\"{push}\", \"0\"]}}}}",
        f"bodies.right.loads={{push: {{on: right, traction: [\"-{push}\", \"0\"]}}}}",
    ]
    measures, _ = run(abut, "bars_2d.yaml", overrides)
    drift = measures["energy.total.relative_drift_end"]
    tell("bars pressed together over 50 transits: drift of the energy", percent(drift), "0.01 %")
    tell("the same: closings", f"{measures['contact.impact.closings']:g}", "1")


def zones(abut):
    """A disk on a wall: nodes close and open one after the other. Its stable step is 2.676e-5 s."""
    for scheme, step, goal in (
        ("central_difference", 1.25e-5, "0.05 %"),
        ("newmark", 2.5e-5, "0.2 %"),
    ):
        measures, _ = run(
            abut,
            "disk_on_wall.yaml",
            [f"bodies.disk.integrator={{{scheme}: {{step: {step}}}}}"],
        )
        drift = measures["energy.total.relative_drift_end"]
        cfl = step / 2.676e-5
        tell(f"a disk on a wall, {scheme} at CFL {cfl:.2f}: energy", percent(drift), goal)
        changes = measures["contact.impact.closings"] + measures["contact.impact.count"]
        tell("the same: changes of the interface, on and off", f"{changes:g}", "2")


def flights(abut):
    """Requests to each of two bodies until they touch: flights, and windows that are near."""
    for scene in ("disks_head_on.yaml", "balls.yaml", "bars_3d.yaml"):
        measures, _ = run(abut, scene, [])
        touch = measures["contact.impact.begin"]
        summary, _ = results(abut, scene, [f"time.end={touch}"])
        requests = f"{summary['exchanges'] / 2:g}"
        tell(f"{scene[:-5]}: requests to a body until the touch", requests, "10")


def beyond_memory(abut):
    """What yields by a kernel does not where the kernel has no room."""
    for scene in ("bars_2d.yaml", "bars_2d_implicit.yaml"):
        measures, _ = run(
            abut,
            scene,
            ["interfaces.impact.transmission={unilateral: {kernel_memory: 1.0e-6}}"],
        )
        tell(
            f"{scene[:-5]} without a kernel: iterations, mean / max",
            f"{measures['schwarz.iterations_mean']:.2f} / {measures['schwarz.iterations_max']:g}",
            "6 (mean)",
        )


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    program = str(pathlib.Path(sys.argv[1]) / "abut")
    impacts(program)
    peers(program)
    persistent(program)
    zones(program)
    flights(program)
    beyond_memory(program)
