#!/usr/bin/env python3
"""How near `abut check` comes to what a run takes, in time and memory.

Each scene is checked and then run as `abut run` does, in processes of its own. Prints a table in
Markdown; exit code 1 where a time is wrong by more than a factor of two.

usage: predictions.py BIN [SCENE[@PROBE][=SET,SET...]...]
"""

import re
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
# Of every kind, each longer than the probe; and what is set to make it so.
SCENES = (
    "two_bars=bodies.*.model.fe.mesh.bar.elements=4000,bodies.*.integrator.*.step=5.0e-9",
    "solids/torsion_column=time.end=2.0e-3",
    "joined/cantilever_split=time.end=4.0e-3",
    "joined/torsion_split_four=time.end=2.0e-3",
    "contact/plate_and_ball@10",  # its first window makes a kernel for seconds
    "contact/balls_100",
    "contact/ball_slides_then_rolls_3d",
    "contact/maw_barber",
    "contact/gears",
    "contact/taylor_bar",
    "contact/ironing",
    "contact/brick_on_corner",
)
UNITS = {"s": 1.0, "min": 60.0, "h": 3600.0, "d": 86400.0}
FACTOR = 2.0


def seconds_of(words: str) -> float:
    """Of "3 min 20 s"."""
    parts = re.findall(r"([\d.e+-]+) (d|h|min|s)\b", words)
    return sum(float(number) * UNITS[unit] for number, unit in parts)


def memory_of(process: str) -> float:
    """[MiB] the most that a process has had; 0: it is gone."""
    try:
        text = Path(f"/proc/{process}/status").read_text(encoding="utf-8")
    except OSError:
        return 0.0
    found = re.search(r"VmHWM:\s+(\d+) kB", text)
    return float(found[1]) / 1024.0 if found else 0.0


def children_of(process: int) -> list:
    try:
        path = Path(f"/proc/{process}/task/{process}/children")
        return path.read_text(encoding="utf-8").split()
    except OSError:
        return []


def run(command: list) -> tuple:
    """Seconds and MiB that a run takes with its solver processes."""
    began = time.monotonic()
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as run_of:
        most = {}

        def watch():
            while run_of.poll() is None:
                for process in [str(run_of.pid), *children_of(run_of.pid)]:
                    most[process] = max(most.get(process, 0.0), memory_of(process))
                time.sleep(0.05)

        watcher = threading.Thread(target=watch)
        watcher.start()
        run_of.wait()
        seconds = time.monotonic() - began
        watcher.join()
    return seconds, sum(most.values())


def main() -> int:
    abut = Path(sys.argv[1]) / "abut"
    wrong = 0
    print("| scene | predicted | measured | ratio | memory, MiB: predicted, measured | dear |\n"
          "|---|---|---|---|---|---|")
    for entry in sys.argv[2:] or SCENES:
        name, _, settings = entry.partition("=")
        name, _, probe = name.partition("@")
        overrides = [word for one in settings.split(",") if one for word in ("--set", one)]
        probed = ["--probe", probe] if probe else []
        scene = str(ROOT / "configs" / f"{name}.yaml")
        said = subprocess.run([abut, "check", scene, *overrides, *probed], capture_output=True,
                              text=True, check=True).stdout
        told = re.search(r"^  time +about ([^,;\n]+)", said, re.MULTILINE)
        memory = re.search(r"^  memory +about (\d+) MiB", said, re.MULTILINE)
        dear = re.search(r"^  dear +(.*)$", said, re.MULTILINE)
        if not told:
            print(f"| {name} | none: {said.splitlines()[-1].strip()} | | | | |")
            wrong += 1
            continue
        with tempfile.TemporaryDirectory() as folder:
            taken, used = run([abut, "run", scene, *overrides, "--quiet", "--out", f"{folder}/run"])
        predicted = seconds_of(told[1])
        ratio = predicted / taken
        wrong += not 1.0 / FACTOR <= ratio <= FACTOR
        told_apart = [f"`--probe {probe}`"] if probe else []
        shown = ", ".join([name, *told_apart, *(f"`{one}`" for one in settings.split(",") if one)])
        print(f"| {shown} | {predicted:.3g} s | {taken:.3g} s | {ratio:.2f} | {memory[1]}, "
              f"{used:.0f} | {dear[1]} |", flush=True)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
