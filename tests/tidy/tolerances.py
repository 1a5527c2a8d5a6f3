"""Goal: every tolerance has its reason beside it. A bare power of ten, a hundredth or less, says
nothing: derive it (support/tolerance.hpp: operations times eps times scale), or say in a comment of
the same line or the one above where it comes from.

tolerances.txt counts what is left by file; a count may only fall.
"""

import re
from pathlib import Path

from findings import CPP, Finding, project_files, read_lines, run

LEFT = "tests/tidy/tolerances.txt"
EXPECTATION = re.compile(r"\b(?:EXPECT|ASSERT)_(NEAR|LT|LE)\(")
POWER = re.compile(r"(?<![\w.-])(?<![<>] )(?:1(?:\.0*)?[eE]-\d+|0?\.0+1)(?![\w.])")
# Of support/tolerance.hpp, with a factor before or behind it.
REASON = re.compile(r"(?:[\w.-]+ \* )?\b(?:roundoff|iteration)\((?:[^()]|\([^()]*\))*\)"
                    r"(?: [*/] [\w.-]+)?")
NAMED = re.compile(r"\bconstexpr double (?:\w*tolerance|round\w*|exact|few|same\w*|left_open)"
                   r" = ([^;]*);")
STRING = re.compile(r'"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])\'')


def arguments(text: str, begin: int) -> tuple[list[str], int]:
    """What stands between the commas of a call whose bracket has been opened, and its end."""
    found, depth, at = [""], 1, begin
    while at < len(text):
        letter = text[at]
        depth += (letter in "([{") - (letter in ")]}")
        if depth == 0:
            break
        if letter == "," and depth == 1:
            found.append("")
        else:
            found[-1] += letter
        at += 1
    return found, at


def commented(lines: list[str], at: int) -> bool:
    return at > 0 and lines[at - 1].lstrip().startswith("//")


def bare(lines: list[str]) -> list[int]:
    """Lines of expectations whose tolerance is a power of ten for which no reason is given."""
    code = [STRING.sub(lambda match: " " * len(match[0]), line) for line in lines]
    comment = ["//" in line for line in code]
    text = "\n".join(line.partition("//")[0] for line in code)
    reasoned, found = {}, []  # by the last line of an expectation with a reason: its tolerance
    for match in NAMED.finditer(text):
        line = text.count("\n", 0, match.start())
        if POWER.search(match[1]) and not comment[line] and not commented(lines, line):
            found.append(line + 1)
    for match in EXPECTATION.finditer(text):
        given, end = arguments(text, match.end())
        tolerance = " ".join(given[-1].split())
        end = text.find(";", end)
        first, last = text.count("\n", 0, match.start()), text.count("\n", 0, end)
        if (any(comment[first:last + 1]) or commented(lines, first)
                or reasoned.get(first - 1) == tolerance):
            reasoned[last] = tolerance
        elif POWER.search(REASON.sub("", tolerance)):
            found.append(first + 1)
    return sorted(found)


def check(root: Path) -> list[Finding]:
    left = {}
    if (root / LEFT).is_file():
        for line in read_lines(root, LEFT):
            if line and not line.startswith("#"):
                count, name = line.split()
                left[name] = int(count)
    found = []
    for name in project_files(root):
        if not name.startswith("tests/") or not name.endswith(CPP):
            continue
        lines, allowed = bare(read_lines(root, name)), left.pop(name, 0)
        if len(lines) > allowed:
            what = f"{len(lines)} tolerances are bare powers of ten, {allowed} are listed"
            found.append(Finding(name, lines[-1], f"{what} (lines {', '.join(map(str, lines))})",
                                 "derive the new one, or say beside it where it comes from"))
        elif len(lines) < allowed:
            found.append(Finding(LEFT, 1, f"lists {allowed} of {name}, which has {len(lines)}",
                                 f"write {len(lines)}, so that it stays"))
    for name in left:
        found.append(Finding(LEFT, 1, f"lists {name}, which is not there", "take the line out"))
    return found


if __name__ == "__main__":
    run(check)
