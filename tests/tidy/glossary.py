"""Goal: one word per thing. Fails on words that docs/GLOSSARY.md replaces by another.

Only words that have no other meaning in this project are listed, so that a finding is never noise.
"""

import re
from pathlib import Path

from findings import CODE, Finding, project_files, read_lines, run

INSTEAD = {
    "master": "side (kinematic side, Dirichlet side)",
    "slave": "side, or subdomain",
    "federate": "subdomain",
    "participant": "subdomain",
    "penetration": "overlap",
    "subiteration": "Schwarz iteration, sweep",
    "subiterations": "Schwarz iteration, sweep",
    "coupling iteration": "Schwarz iteration, sweep",
    "coupling iterations": "Schwarz iteration, sweep",
    "macro step": "controller step, window",
    "communication step": "controller step, window",
    "micro step": "substep",
    "restart file": "checkpoint",
    "under relaxation": "relaxation",
    "input deck": "scene",
}
EXEMPT = ("docs/GLOSSARY.md", "tests/tidy/", "LICENSE")
WORDS = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])")


def words_of(line: str) -> str:
    """The line's words in lower case: MicroStep, micro_step and micro-step read alike."""
    return " " + " ".join(word.lower() for word in WORDS.findall(line)) + " "


def check(root: Path) -> list[Finding]:
    found = []
    for name in project_files(root):
        if name.startswith(EXEMPT) or not name.endswith(CODE + (".md", ".yaml")):
            continue
        for number, line in enumerate(read_lines(root, name), start=1):
            words = words_of(line)
            for term, better in INSTEAD.items():
                if f" {term} " in words:
                    found.append(Finding(name, number, f"'{term}'", f"the glossary says {better}"))
    return found


if __name__ == "__main__":
    run(check)
