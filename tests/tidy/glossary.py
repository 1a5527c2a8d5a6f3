"""Goal: one word per thing. Fails on words that docs/GLOSSARY.md replaces by another, and where it
defines a term twice.

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
THEIRS = ("canHandleVariableCommunicationStepSize",)  # attributes that FMI names
GLOSSARY = "docs/GLOSSARY.md"
EXEMPT = (GLOSSARY, "tests/tidy/", "LICENSE")
WORDS = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])")


def words_of(line: str) -> str:
    """The line's words in lower case: MicroStep, micro_step and micro-step read alike."""
    return " " + " ".join(word.lower() for word in WORDS.findall(line)) + " "


def defined_twice(root: Path) -> list[Finding]:
    found, terms = [], set()
    for number, line in enumerate(read_lines(root, GLOSSARY), start=1):
        term = line.split(" | ")[0] if line.startswith("| ") else None
        if term in terms:
            found.append(Finding(GLOSSARY, number, f"'{term[2:]}' is defined above",
                                 "give one of the two a name of its own"))
        elif term:
            terms.add(term)
    return found


def check(root: Path) -> list[Finding]:
    found = defined_twice(root) if (root / GLOSSARY).is_file() else []
    for name in project_files(root):
        if name.startswith(EXEMPT) or not name.endswith(CODE + (".md", ".yaml")):
            continue
        for number, line in enumerate(read_lines(root, name), start=1):
            for name_of_others in THEIRS:
                line = line.replace(name_of_others, "")
            words = words_of(line)
            for term, better in INSTEAD.items():
                if f" {term} " in words:
                    found.append(Finding(name, number, f"'{term}'", f"the glossary says {better}"))
    return found


if __name__ == "__main__":
    run(check)
