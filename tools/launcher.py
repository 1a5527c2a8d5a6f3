#!/usr/bin/python3
"""Runs the command of the package abut_tools that this program is named after: abut-report is
abut_tools/report.py. The package is in share/abut/python beside the folder of the programs, in a
build folder and wherever abut is installed."""

import sys
from importlib import import_module
from pathlib import Path

sys.dont_write_bytecode = True  # root would leave files that no uninstall knows
PROGRAM = Path(__file__).resolve()
PACKAGE = PROGRAM.parents[1] / "share" / "abut" / "python"
sys.path.insert(0, str(PACKAGE))

if __name__ == "__main__":
    verb = PROGRAM.name.removeprefix("abut-")
    if not (PACKAGE / "abut_tools" / f"{verb}.py").is_file():
        print(f"abut {verb}: {PACKAGE}/abut_tools/{verb}.py is not there. Install abut again: its "
              "folders bin and share stay beside each other.", file=sys.stderr)
        sys.exit(3)
    sys.exit(import_module(f"abut_tools.{verb}").main())
