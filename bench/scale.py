#!/usr/bin/python3
"""What a coordinator pays for processes that somebody else starts, by their number: the figures of
docs/SCALE.md.

usage: scale.py DIRECTORY_OF_PROGRAMS [NUMBER ...]

Pairs of small squares collide, a process each, over TCP of this machine without keys. Printed are,
of the coordinator alone, processor time of an exchange, its start included, and memory; the time to
the first window; and the largest memory of any process. Bits are compared with those of a run in
one process.
"""

import json
import os
import pathlib
import resource
import socket
import subprocess
import sys
import tempfile

from shared_processes import squares

LEAST_AND_MORE = (2, 8, 32, 128)  # pairs need even numbers


def run_awaited(programs, scene, count, out):
    """Processor time [s] and largest memory [MiB] of a coordinator, and that of a solver."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        endpoint = f"tcp://127.0.0.1:{probe.getsockname()[1]}"
    coordinator = subprocess.Popen([programs / "abut", "run", scene, "--quiet", "--out", out,
                                    "--await", endpoint, "--patience", "300"])
    solvers = [subprocess.Popen([programs / "abut-solver", "--connect", endpoint, "--body",
                                 f"b{i}", "--patience", "300"]) for i in range(count)]
    _, status, used = os.wait4(coordinator.pid, 0)
    coordinator.returncode = os.waitstatus_to_exitcode(status)
    for solver in solvers:
        solver.wait()
    if coordinator.returncode != 0:
        sys.exit(f"a run of {count} processes ended with {coordinator.returncode}")
    largest = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024.0
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1024.0, largest


def main():
    programs = pathlib.Path(sys.argv[1]).resolve()
    counts = [int(word) for word in sys.argv[2:]] or LEAST_AND_MORE
    print("processes  exchanges  us of the coordinator each  us of wall each  start-up s  "
          "MiB of the coordinator  MiB of the largest process")
    for count in counts:
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder, "scene.yaml")
            scene.write_text(squares(count, True).replace("end: 0.02", "end: 0.1"),
                             encoding="utf-8")
            here = pathlib.Path(folder, "here")
            subprocess.run([programs / "abut", "run", scene, "--quiet", "--local", "--out", here],
                           check=True)
            away = pathlib.Path(folder, "away")
            seconds, memory, largest = run_awaited(programs, scene, count, away)
            one, other = (json.loads((place / "summary.json").read_text(encoding="utf-8"))
                          for place in (here, away))
            if one["state_hash"] != other["state_hash"]:
                sys.exit(f"{count} processes make other bits")
            timing, exchanges = other["timing"], other["exchanges"]
            print(f"{count:9d}  {exchanges:9d}  {1e6 * seconds / exchanges:26.1f}  "
                  f"{1e6 * timing['wall_s'] / exchanges:15.1f}  {timing['startup_s']:10.2f}  "
                  f"{memory:22.0f}  {largest:26.0f}", flush=True)


if __name__ == "__main__":
    main()
