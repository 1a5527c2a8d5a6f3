#!/usr/bin/python3
"""Whole runs with one process per body against the same runs in one process.

usage: processes.py DIRECTORY_OF_PROGRAMS

Prints medians and ratios beside their limits; exit code 1 when a limit is passed. A ratio is the
median over pairs of runs that follow each other, with the quartiles of the pairs: it passes its
limit when the lower quartile does, so that noise does not decide.
"""

import json
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile
import time

REPEATS = 15
RATIO_LIMIT = 1.3  # a process that has slept for a millisecond wakes up late (bench/README.md)
SCENES = pathlib.Path(__file__).resolve().parent.parent / "configs"

# Bars of 20,000 elements at CFL 0.8 in windows of 100 steps: 0.08 ms of flight and as much contact.
LONG_BARS = [
    "time={begin: 0.0, end: 1.0e-4, window: 1.0e-6}",
    "bodies.left.initial.position=[-0.2505]",
    "bodies.right.initial.position=[0.0005]",
] + [
    override
    for body in ("left", "right")
    for override in (
        f"bodies.{body}.model.fe.mesh.bar.elements=20000",
        f"bodies.{body}.integrator.central_difference={{step: 1.0e-8}}",
        f"bodies.{body}.contact_layer={{massless: {{}}}}",
    )
] + ["meta.expect=[]"]


def run(abut, scene, overrides, placement):
    """Summary of one run."""
    with tempfile.TemporaryDirectory() as out:
        command = [abut, "run", str(SCENES / scene), "--quiet", "--out", out + "/run", *placement]
        for override in overrides:
            command += ["--set", override]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"{' '.join(command)} ended with {done.returncode}: {done.stderr}")
        return json.loads(pathlib.Path(out, "run", "summary.json").read_text())


def compare(abut, scene, overrides, repeats):
    """Median wall times [s] in processes and in one process, the quartiles of their ratio over
    pairs of runs that follow each other, the median start-up [s], and a summary."""
    walls = {"processes": [], "local": []}
    startups = []
    for _ in range(repeats):
        for name, placement in (("processes", []), ("local", ["--local"])):
            summary = run(abut, scene, overrides, placement)
            walls[name].append(summary["timing"]["wall_s"])
            if name == "processes":
                startups.append(summary["timing"]["startup_s"])
                spawned = summary
    median = {name: statistics.median(values) for name, values in walls.items()}
    ratios = [p / l for p, l in zip(walls["processes"], walls["local"])]
    return median, statistics.quantiles(ratios, n=4), statistics.median(startups), spawned


def bare_round_trip(bin_directory):
    """Bare ZeroMQ round trip [s] of the frames of a 100-step window, from abut_bench_round_trip."""
    program = bin_directory / "abut_bench_round_trip"
    text = subprocess.run([program], capture_output=True, text=True, check=False).stdout
    for line in text.splitlines():  # substeps, bytes there, bytes back, bare median, ...
        fields = re.findall(r"[0-9.]+", line)
        if len(fields) > 3 and fields[0] == "100":
            return float(fields[3]) * 1e-6
    sys.exit(f"{program} printed no line for 100 substeps:\n{text}")


def peak_memory(abut):
    """Largest resident memory [MiB] of a solver process of two_bars.yaml in windows of one step."""
    peak = 0.0
    with tempfile.TemporaryDirectory() as out:
        command = [abut, "run", str(SCENES / "two_bars_step_windows.yaml"), "--quiet"]
        process = subprocess.Popen(command + ["--out", out + "/run"], stdout=subprocess.DEVNULL)
        while process.poll() is None:
            children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children")
            try:
                for child in children.read_text().split():
                    status = pathlib.Path(f"/proc/{child}/status").read_text()
                    found = re.search(r"VmHWM:\s+(\d+) kB", status)
                    peak = max(peak, int(found.group(1)) / 1024.0) if found else peak
            except OSError:  # the child has just ended
                pass
            time.sleep(0.02)
    return peak


def main():
    """Runs all comparisons."""
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    bin_directory = pathlib.Path(sys.argv[1]).resolve()
    abut = str(bin_directory / "abut")
    passed = True

    def line(what, value, limit, unit):
        nonlocal passed
        good = value <= limit
        passed = passed and good
        verdict = "" if good else "PASSED THE LIMIT"
        print(f"{what:58} {value:10.3f}  at most {limit:8.3f} {unit:3} {verdict}")

    bare = bare_round_trip(bin_directory)
    wall, _, startup, summary = compare(abut, "two_bars.yaml", [], REPEATS)
    exchanges = summary["exchanges"]
    allowed = wall["local"] + exchanges * 1.5 * bare + startup
    print(f"two_bars.yaml, medians of {REPEATS}; bare round trip {bare * 1e6:.1f} us")
    line("exchanges", exchanges, 400, "")
    line("start-up of two bodies, program start to first window", startup * 1e3, 60.0, "ms")
    local = f"wall with processes (local {wall['local'] * 1e3:.2f} ms)"
    line(local, wall["processes"] * 1e3, allowed * 1e3, "ms")

    line("resident memory of a solver process, peak", peak_memory(abut), 40.0, "MiB")

    wall, (low, ratio, high), _, summary = compare(abut, "two_bars.yaml", LONG_BARS, REPEATS)
    count = summary["exchanges"]
    print(f"20,000 elements, CFL 0.8, 100-step windows: {count} exchanges, {REPEATS} pairs")
    print(f"wall with processes over local ({wall['local']:.3f} s), median of the pairs "
          f"{ratio:.3f}, quartiles {low:.3f} to {high:.3f}")
    line("the same, lower quartile", low, RATIO_LIMIT, "")
    sys.exit(0 if passed else 1)


if __name__ == "__main__":
    main()
