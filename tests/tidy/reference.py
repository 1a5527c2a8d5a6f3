"""Goal: docs/REFERENCE.md is what the program says of its own scene keys.

usage: reference.py ROOT PROGRAM      exit code 77 (skipped) when the program is not built
"""

import difflib
import subprocess
import sys
from pathlib import Path

SKIPPED = 77


def main() -> int:
    root, program = Path(sys.argv[1]), Path(sys.argv[2])
    if not program.is_file():
        print(f"skipped: {program.name} is not built here; `make build` builds it")
        return SKIPPED
    said = subprocess.run([program, "reference"], capture_output=True, text=True, check=True).stdout
    document = root / "docs" / "REFERENCE.md"
    written = document.read_text(encoding="utf-8") if document.is_file() else ""
    if written == said:
        return 0
    lines = difflib.unified_diff(written.splitlines(), said.splitlines(), "docs/REFERENCE.md",
                                 "abut reference", lineterm="")
    print("\n".join(list(lines)[:40]))
    print("docs/REFERENCE.md:1: out of date: run `abut reference > docs/REFERENCE.md`")
    return 1


if __name__ == "__main__":
    sys.exit(main())
