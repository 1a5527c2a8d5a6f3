"""Goal: what can be added has few places, those that CONTRIBUTING names: no other code decides by
the name of an element, an integrator, a number of a friction law or a transmission.
"""

import re
from pathlib import Path
from typing import NamedTuple

from findings import CPP, Finding, project_files, read_lines, run

PRODUCT = ("base/", "contract/", "coordinator/", "messaging/", "subdomain_solver/", "surface/")
GUIDE = "CONTRIBUTING.md"
MAKE = "subdomain_solver/make/"
DEFAULT = re.compile(r'^\s*std::string element = "[a-z0-9]+";')  # of a key: a choice, not a fact
PATH = re.compile(r"`((?:\w+/)*\w+\.(?:cpp|hpp|proto|txt|md|yaml|\*))`")


class Kind(NamedTuple):
    what: str
    declared: str  # the file that declares them all
    entry: re.Pattern[str]  # a name, in a line of this file
    least: int  # names, or the pattern has missed them
    quoted: bool  # told by text, not by identifier
    places: tuple[str, ...]  # that may name them beside


KINDS = (
    Kind("element", "subdomain_solver/fe/elements.cpp",
         re.compile(r'^\s*\{(?:\.name = )?"([a-z]+[0-9]+)",'), 11, True,
         # Kernels written for one element by hand: all others take the general one.
         ("subdomain_solver/fe/batched_cells.cpp",)),
    Kind("number of the friction law", "contract/friction_law.hpp",
         re.compile(r"(?:^  double |, )(\w+) = 0\.0(?=[,;])"), 2, False,
         ("coordinator/interface_spec.cpp", "messaging/codec/meeting.cpp")),
    # A maker of bodies each, and a scheme that is of pairs of bars alone.
    Kind("integrator", MAKE + "integrator_spec.hpp", re.compile(r"^struct (\w+Spec) \{"), 7, False,
         (MAKE + "body.cpp", MAKE + "scheme.cpp", MAKE + "rigid_body.cpp", MAKE + "pair_body.cpp",
          MAKE + "body_spec.cpp")),
    # Beside couple.cpp: sides that a rule names, dashpots of tied surfaces, memory of kernels.
    Kind("transmission", "coordinator/transmission_spec.hpp",
         re.compile(r"^struct (\w+Transmission) \{"), 4, False,
         ("coordinator/couple.cpp", "coordinator/scene.cpp", "coordinator/port_roles.cpp",
          "coordinator/split/split_scene.cpp", "coordinator/tied_surfaces.cpp",
          "coordinator/estimate.cpp")),
)


def names_of(root: Path, kind: Kind) -> list[str]:
    return [name for line in read_lines(root, kind.declared) for name in kind.entry.findall(line)]


def check_kind(root: Path, kind: Kind, paths: list[str]) -> list[Finding]:
    names = names_of(root, kind)
    if len(names) < kind.least:
        return [Finding(kind.declared, 1, f"declares {len(names)} of kind {kind.what}",
                        "keep one per line, as the others are")]
    edge = '"' if kind.quoted else r"\b"
    name = re.compile(edge + "(" + "|".join(names) + ")" + edge)
    found = []
    for path in paths:
        if path == kind.declared or path in kind.places:
            continue
        for number, line in enumerate(read_lines(root, path), start=1):
            match = name.search(line.partition("//")[0])
            if match and not DEFAULT.match(line):
                found.append(Finding(path, number, f"names the {kind.what} {match[0]}",
                                     f"ask what {kind.declared} declares: add there what you need"))
    return found


def check_guide(root: Path, files: list[str]) -> list[Finding]:
    """Paths in the guide's tables are those of files, by their ends; `x` is the new one."""
    found = []
    for number, line in enumerate(read_lines(root, GUIDE), start=1):
        if not line.startswith("|"):
            continue
        for path in PATH.findall(line):
            folder, _, file = path.rpartition("/")
            stem = re.escape(path[:-1]) if path.endswith(".*") else re.escape(path) + "$"
            if re.match(r"x\.|x$", file):
                stem = re.escape(folder) + r"/[^/]+$"
            if not any(re.search(r"(?:^|/)" + stem, name) for name in files):
                found.append(Finding(GUIDE, number, f"names {path}, which does not exist",
                                     "name the file in which the work is"))
    return found


def check(root: Path) -> list[Finding]:
    files = project_files(root)
    product = [path for path in files if path.endswith(CPP) and path.startswith(PRODUCT)]
    found = [finding for kind in KINDS if (root / kind.declared).is_file()
             for finding in check_kind(root, kind, product)]
    return found + (check_guide(root, files) if GUIDE in files else [])


if __name__ == "__main__":
    run(check)
