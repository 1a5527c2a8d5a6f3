"""Goal: [M.n] leads somewhere. docs/METHOD.md defines every equation that is cited, once.

An equation is defined where its number stands apart at the end of a formula, which is indented by
four, or in a cell of its own at the end of a table's row.
"""

import re
from pathlib import Path

from findings import CODE, Finding, project_files, read_lines, run

METHOD = "docs/METHOD.md"
DEFINED = re.compile(r"(?: {4}.*  \[M\.(\d+)\]|\|.*\| \[M\.(\d+)\] \|)$")
CITED = re.compile(r"\[(M\.\d[^\]]*)\]")
ONE = re.compile(r"M\.(\d+)(?: to M\.(\d+))?")
READ = CODE + (".md", ".yaml", ".txt")


def definitions(root: Path) -> tuple[dict[int, int], list[Finding]]:
    """Line of every equation by its number, and those numbers that are given twice."""
    lines, twice = {}, []
    for line, text in enumerate(read_lines(root, METHOD), start=1):
        match = DEFINED.match(text)
        if not match:
            continue
        number = int(match[1] or match[2])
        if number in lines:
            what = f"[M.{number}] is the equation of line {lines[number]} already"
            twice.append(Finding(METHOD, line, what, "take the next free number"))
        lines.setdefault(number, line)
    return lines, twice


def numbers_in(citation: str) -> list[int]:
    """Of `M.1`, of `M.1, M.2` and of `M.1 to M.3`; none: it is written in another way."""
    numbers = []
    for part in citation.split(", "):
        match = ONE.fullmatch(part)
        if not match:
            return []
        numbers += range(int(match[1]), int(match[2] or match[1]) + 1)
    return numbers


def check(root: Path) -> list[Finding]:
    defined, twice = definitions(root)
    found = []
    for name in project_files(root):
        if not name.endswith(READ) or name.startswith("tests/tidy/"):
            continue
        for line, text in enumerate(read_lines(root, name), start=1):
            for citation in CITED.findall(text):
                numbers = numbers_in(citation)
                if not numbers:
                    found.append(Finding(name, line, f"[{citation}] is no citation",
                                         "write [M.1], [M.1, M.2] or [M.1 to M.3]"))
                for number in numbers:
                    if number not in defined:
                        what = f"[M.{number}] is no equation of {METHOD}"
                        found.append(Finding(name, line, what, "cite the one that is meant"))
    return found + twice


if __name__ == "__main__":
    run(check)
