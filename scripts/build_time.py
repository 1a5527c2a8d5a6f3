#!/usr/bin/env python3
"""What the first build costs: `make demo`, or another target, from nothing, in a clone.

usage: scripts/build_time.py [TARGET]      without a compiler cache; packages are there already
Prints wall and processor time, and the files that take longest.
"""

import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path


def children() -> float:
    """Processor time [s] of programs that have ended."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def slowest(log: Path, count: int) -> list[tuple[float, str]]:
    """(wall time [s], object file) of what took longest to compile."""
    times = {}
    for line in log.read_text(encoding="utf-8").splitlines():
        if line.startswith("#"):
            continue
        begin, end, _, output, _ = line.split("\t")
        times[output] = (int(end) - int(begin)) / 1000.0
    return sorted(((seconds, name) for name, seconds in times.items()), reverse=True)[:count]


def main() -> None:
    target = sys.argv[1] if len(sys.argv) > 1 else "demo"
    source = Path(__file__).resolve().parent.parent
    with tempfile.TemporaryDirectory() as folder:
        clone = Path(folder) / "abut"
        subprocess.run(["git", "clone", "--quiet", source, clone], check=True)
        wall, processor = time.monotonic(), children()
        subprocess.run(["make", target], cwd=clone, check=True, stdout=subprocess.DEVNULL,
                       env=dict(os.environ, CCACHE_DISABLE="1"))
        wall, processor = time.monotonic() - wall, children() - processor
        print(f"make {target}, {os.cpu_count()} cores: {wall / 60:.1f} min wall, "
              f"{processor / 60:.1f} min processor")
        for seconds, name in slowest(clone / "build/release/.ninja_log", 12):
            print(f"{seconds:8.1f} s  {name}")


if __name__ == "__main__":
    main()
