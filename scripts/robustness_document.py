#!/usr/bin/python3
"""Measures the tables of docs/ROBUSTNESS.md anew: random scenes of two ranges of seeds.

usage: robustness_document.py DIRECTORY_OF_PROGRAMS [FIRST..LAST ...]

What lies between the two marks of the page is rewritten, the rest stays.
"""

import pathlib
import subprocess
import sys

PAGE = pathlib.Path(__file__).resolve().parent.parent / "docs" / "ROBUSTNESS.md"
BEGIN = "<!-- measured by make robustness -->\n"
END = "<!-- end of what was measured -->\n"
RANGES = ("1..52", "53..101", "10000..10059")


def tables(program, seeds):
    """The Markdown tables of a range of seeds, and the sentence below them."""
    run = subprocess.run([program, "--quiet", "--table", seeds], capture_output=True, text=True)
    if run.returncode not in (0, 1):  # 1: some seeds are not as they should be
        sys.exit(f"{program} {seeds}: {run.stderr}")
    lines = run.stdout.splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith("| scenes |"))
    return "\n".join(lines[first:-1]) + "\n\n" + lines[-1][0].upper() + lines[-1][1:] + ".\n"


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    program = str(pathlib.Path(sys.argv[1]) / "abut_fuzz")
    text = PAGE.read_text()
    before, rest = text.split(BEGIN)
    after = rest.split(END)[1]
    parts = [f"Seeds {seeds}:\n\n{tables(program, seeds)}" for seeds in sys.argv[2:] or RANGES]
    PAGE.write_text(before + BEGIN + "\n".join(parts) + END + after)


if __name__ == "__main__":
    main()
