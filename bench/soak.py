#!/usr/bin/python3
"""What long runs keep: memory, open files, and rest.

A box that is shaken holds sixty disks, each of the 64 bodies a process of its own, for as many
exchanges as asked; then a pressed block rests on another one in space, by friction, for as many
windows. Prints what grew from the middle of each run to its end beside limits; exit code 1 where
one is passed.

usage: soak.py DIRECTORY_OF_PROGRAMS [EXCHANGES [WINDOWS]]    (1e6 each; 0: without that run)
"""

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

GROWTH = 0.01  # of the resident memory of any process
DRIFT = 1.0e-9  # [m/s] of the block that rests; its pressure makes a wave of 1 m/s
EXCHANGES_PER_WINDOW = 275.0  # of the box, measured: for how long it runs

BOX = """\
meta: {title: Sixty disks in a box that is shaken}
time: {begin: 0.0, end: END, window: 1.0e-3}
bodies:
  disk:
    copies: {grid: {count: [10, 6], spacing: [0.21, 0.21]}}
    model:
      fe: {dimension: 2, plane: stress, mesh: {disk: {radius: 0.1, core: 2, layers: 1}}}
    material:
      saint_venant_kirchhoff: {youngs_modulus: 1.0e6, poissons_ratio: 0.3, density: 1000.0}
    integrator: {central_difference: {step: 5.0e-4}}
    body_force: [0.0, -9.81]
    ports: {skin: {side: mantle}}
    initial: {position: [0.15, 0.15]}
  floor:
    model: {rigid_tool: {dimension: 2, mesh: {rectangle: {lengths: [2.4, 0.1], elements: [1, 1]}},
                        way: ["0", "0.02 * sin(20 * t)"]}}
    initial: {position: [-0.1, -0.1]}
    ports: {face: {side: boundary}}
  lid:
    like: floor
    initial: {position: [-0.1, 1.8]}
  west:
    model: {rigid_tool: {dimension: 2, mesh: {rectangle: {lengths: [0.1, 2.4], elements: [1, 1]}},
                        way: ["0", "0"]}}
    initial: {position: [-0.1, -0.3]}
    ports: {face: {side: boundary}}
  east:
    like: west
    initial: {position: [2.2, -0.3]}
contact: {everything: {friction: 0.3}}
output: {records_per_window: 1}
"""

REST = """\
meta: {title: A pressed block rests on another one}
time: {begin: 0.0, end: END, window: 0.01}
bodies:
  block:
    model: {fe: {dimension: 3, mesh: {box: {lengths: [1.0, 1.0, 0.5], elements: [2, 2, 2]}}}}
    material: &rock
      linear_elastic: {youngs_modulus: 1.0e9, poissons_ratio: 0.3, density: 1000.0}
    integrator: &damped {generalized_alpha: {spectral_radius: 0.0, step: 0.01}}
    initial: {position: [0.5, 0.5, 0.0]}
    loads:
      press: {on: front, traction: ["2.0e5 * min(t, 1)", "0", "-1.0e6 * min(t, 1)"]}
    equations: {tolerance: 1.0e-14}
    ports: {sole: {side: back}}
  base:
    model: {fe: {dimension: 3, mesh: {box: {lengths: [2.0, 2.0, 0.5], elements: [3, 3, 2]}}}}
    material: *rock
    integrator: *damped
    initial: {position: [0.0, 0.0, -0.5]}
    constraints: {ground: {on: back, fixed: true}}
    ports: {face: {side: front}}
interfaces:
  joint: {sides: [block.sole, base.face], contact: {friction: 0.3}}
"""


def children(pid: int) -> list:
    """Its processes, as /proc has them; none where it has ended."""
    try:
        text = Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="utf-8")
    except OSError:
        return []
    return [int(word) for word in text.split()]


def taken(pid: int) -> tuple:
    """Resident memory in kB and open files of a process."""
    status = Path(f"/proc/{pid}/status").read_text(encoding="utf-8")
    resident = next(line for line in status.splitlines() if line.startswith("VmRSS"))
    return int(resident.split()[1]), len(list(Path(f"/proc/{pid}/fd").iterdir()))


def watched(abut: str, scene: str, *words: str) -> tuple:
    """The summary of a run, and of each of its processes what it has taken, as time went on."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "scene.yaml")
        path.write_text(scene, encoding="utf-8")
        run = subprocess.Popen([abut, "run", str(path), "--quiet", "--out", folder + "/run",
                                *words], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                               text=True)
        samples = {}
        while run.poll() is None:
            for pid in (run.pid, *children(run.pid)):
                try:
                    samples.setdefault(pid, []).append(taken(pid))
                except (OSError, StopIteration):  # it has just ended
                    pass
            time.sleep(0.2)
        if run.returncode != 0:
            sys.exit(f"{path} ended with {run.returncode}: {run.stderr.read()}")
        text = Path(folder, "run", "summary.json").read_text(encoding="utf-8")
        return json.loads(text), samples


def grown(samples: list) -> tuple:
    """Part of the memory and number of files by which the last tenth is above the middle tenth."""
    tenth = max(1, len(samples) // 10)
    middle = samples[len(samples) // 2:][:tenth]
    memory, files = ([max(sample[k] for sample in part) for part in (middle, samples[-tenth:])]
                     for k in (0, 1))
    return memory[1] / memory[0] - 1.0, files[1] - files[0]


def told(name: str, summary: dict, samples: dict) -> bool:
    """Prints a line; whether nothing grew."""
    growth = [grown(each) for each in samples.values() if len(each) >= 20]
    if not growth:
        sys.exit(f"{name}: too short to be watched")
    memory, files = (max(each[k] for each in growth) for k in (0, 1))
    largest = max(sample[0] for each in samples.values() for sample in each)
    print(f"{name}: {summary['windows']} windows, {summary['exchanges']} exchanges, "
          f"{len(growth)} processes of at most {largest / 1024.0:.1f} MiB: memory grew by "
          f"{100.0 * memory:+.2f} % (limit {100.0 * GROWTH:.0f} %), open files by {files} (0)",
          flush=True)
    return memory <= GROWTH and files <= 0


def main():
    abut = str(Path(sys.argv[1], "abut"))
    exchanges, windows = (int(sys.argv[k]) if len(sys.argv) > k else 1000000 for k in (2, 3))
    passed = True
    if exchanges > 0:
        end = 1.0e-3 * round(exchanges / EXCHANGES_PER_WINDOW)
        passed = told("box that is shaken", *watched(abut, BOX.replace("END", f"{end}")))
    if windows > 0:
        summary, samples = watched(abut, REST.replace("END", f"{0.01 * windows}"), "--local")
        passed = told("block at rest", summary, samples) and passed
        fastest = max(abs(value) for name, value in summary["measures"].items()
                      if name.startswith("mean_velocity.block"))
        print(f"block at rest: {fastest:.1e} m/s at the end (limit {DRIFT:.0e})")
        passed = passed and fastest <= DRIFT
    sys.exit(0 if passed else 1)


if __name__ == "__main__":
    main()
