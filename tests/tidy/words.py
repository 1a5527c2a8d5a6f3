"""Goal: the tree speaks of the project alone: no unfinished business, no paths of one machine."""

import re
from pathlib import Path

from findings import CODE, Finding, project_files, read_lines, run

RULES = [
    (re.compile(r"\b(TODO|FIXME|XXX|HACK)\b"), "unfinished business",
     "finish it, or open an issue and say what holds today"),
    (re.compile(r"(?<![\w.])/(home|root|work|Users)/\w"), "path of one machine",
     "use a path relative to the project, or one found at run time"),
    (re.compile(r"\b(https?|ftp)://(localhost|\d+\.\d+\.\d+\.\d+)[:/]"), "address of one machine",
     "take it from the scene or the command line"),
    (re.compile(r"^(<{7} |>{7} |={7}$)"), "mark of a merge",
     "decide between the two sides"),
]
EXEMPT = ("tests/tidy/",)
PLAIN = (".md", ".yaml", ".yml", ".txt", ".json")
NAMES = ("Makefile", "Dockerfile", "run")


def check(root: Path) -> list[Finding]:
    found = []
    for name in project_files(root):
        if name.startswith(EXEMPT):
            continue
        if not (name.endswith(CODE + PLAIN) or Path(name).name in NAMES):
            continue
        for number, line in enumerate(read_lines(root, name), start=1):
            for pattern, what, remedy in RULES:
                match = pattern.search(line)
                if match:
                    found.append(Finding(name, number, f"{what} '{match[0]}'", remedy))
    return found


if __name__ == "__main__":
    run(check)
