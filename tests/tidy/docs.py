"""Goal: documents hold. Every relative link resolves, headings named by a link included."""

import re
from pathlib import Path

from findings import Finding, project_files, read_lines, run

LINK = re.compile(r"(?<!\\)\[[^\]]*\]\(([^)\s]+)\)")
FENCE = re.compile(r"^\s*(```|~~~)")


def prose(lines: list[str]) -> list[tuple[int, str]]:
    """Numbered lines outside fenced blocks, without `code`."""
    kept, fenced = [], False
    for number, line in enumerate(lines, start=1):
        if FENCE.match(line):
            fenced = not fenced
        elif not fenced:
            kept.append((number, re.sub(r"`[^`]*`", "", line)))
    return kept


def anchors(lines: list[str]) -> set[str]:
    """What a heading is called in a link: lower case, words joined by hyphens."""
    names = set()
    for line in lines:
        match = re.match(r"#+\s+(.*)", line)
        if match:
            plain = re.sub(r"[^\w\- ]", "", match[1].lower())
            names.add(plain.strip().replace(" ", "-"))
    return names


def check_link(root: Path, name: str, target: str) -> str:
    """What is wrong with one link; empty when it resolves."""
    path, _, anchor = target.partition("#")
    file = (root / name).parent / path if path else root / name
    if not file.exists():
        return f"link to {path}, which does not exist"
    if anchor and file.suffix == ".md":
        if anchor not in anchors(file.read_text(encoding="utf-8").splitlines()):
            return f"link to heading #{anchor}, which {file.name} does not have"
    return ""


def check(root: Path) -> list[Finding]:
    found = []
    for name in project_files(root):
        if not name.endswith(".md"):
            continue
        for number, line in prose(read_lines(root, name)):
            for target in LINK.findall(line):
                if re.match(r"[a-z]+:", target):
                    continue
                what = check_link(root, name, target)
                if what:
                    found.append(Finding(name, number, what, "correct the link or add the target"))
    return found


if __name__ == "__main__":
    run(check)
