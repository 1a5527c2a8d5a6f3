"""Goal: an element is one entry of the table: no other code decides by the name of one."""

import re
from pathlib import Path

from findings import CPP, Finding, project_files, read_lines, run

TABLE = "subdomain_solver/fe/elements.cpp"
PRODUCT = ("base/", "contract/", "coordinator/", "messaging/", "subdomain_solver/", "surface/")
# Kernels written for one element by hand: all others take the general one.
EXEMPT = ("subdomain_solver/fe/batched_cells.cpp",)
ENTRY = re.compile(r'^\s*\{(?:\.name = )?"([a-z]+[0-9]+)",')
DEFAULT = re.compile(r'^\s*std::string element = "[a-z0-9]+";')  # of a key: a choice, not a fact


def check(root: Path) -> list[Finding]:
    entries = [ENTRY.match(line) for line in read_lines(root, TABLE)]
    names = [entry[1] for entry in entries if entry]
    if len(names) < 11:
        return [Finding(TABLE, 1, f"has {len(names)} entries", "keep one per element, on a line")]
    name = re.compile(r'"(' + "|".join(names) + r')"')
    found = []
    for path in project_files(root):
        if not path.endswith(CPP) or not path.startswith(PRODUCT) or path in (TABLE, *EXEMPT):
            continue
        for number, line in enumerate(read_lines(root, path), start=1):
            match = name.search(line.partition("//")[0])
            if match and not DEFAULT.match(line):
                found.append(Finding(path, number, f"names the element {match[0]}",
                                     f"ask the table: add what you need to {TABLE}"))
    return found


if __name__ == "__main__":
    run(check)
