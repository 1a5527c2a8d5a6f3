"""Goal: every header stands alone.

All start with #pragma once and open no namespace for their readers. x.cpp includes its x.hpp
first, so compiling each file by itself compiles those headers alone. Releases compile several at
once: of every type of ours that a header names, that header or one that it includes must have a
declaration. contract/, which strangers include, and the headers of base/ without a .cpp are
compiled alone here when a compiler is named (second argument).
"""

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from findings import Finding, project_files, read_lines, run

ALONE = ("base/", "contract/")
INCLUDE = re.compile(r'\s*#\s*include\s*[<"]([^>"]+)')
DECLARED = re.compile(r"\b(?:struct|class|enum class|using|typename)\s+(\w+)")
DEFINED = re.compile(r"^(?:(?:struct|class|enum class) (\w+)[^;{]*\{|using (\w+) =)", re.MULTILINE)
NAMED = re.compile(r"(?<![\w.:>])[A-Z]\w+")  # what stands in a namespace or class is found by that


def check_text(root: Path, name: str) -> list[Finding]:
    found = []
    lines = read_lines(root, name)
    code = [line for line in lines if line.strip() and not line.lstrip().startswith("//")]
    if not code or code[0].strip() != "#pragma once":
        found.append(Finding(name, 1, "no #pragma once", "make it the first line of code"))
    for number, line in enumerate(lines, start=1):
        if re.match(r"\s*using\s+namespace\b", line):
            what = "using namespace in a header"
            found.append(Finding(name, number, what, "write names in full"))
    return found


def check_first_include(root: Path, name: str) -> list[Finding]:
    own = name[:-len(".cpp")] + ".hpp"
    if not (root / own).is_file():
        return []
    for number, line in enumerate(read_lines(root, name), start=1):
        match = INCLUDE.match(line)
        if match:
            if match[1] == own:
                return []
            return [Finding(name, number, f"first include is {match[1]}", f'include "{own}" first')]
    return [Finding(name, 1, f"does not include {own}", "include it first")]


def check_names(root: Path, headers: list[str]) -> list[Finding]:
    """Types of the product that a header names and nothing that it includes declares."""
    lines = {name: [line.split("//")[0] for line in read_lines(root, name)] for name in headers}
    code = {name: re.sub(r'"[^"]*"|#.*', "", "\n".join(lines[name])) for name in headers}
    included = {name: [match[1] for line in lines[name] if (match := INCLUDE.match(line))]
                for name in headers}
    declared = {name: set(DECLARED.findall(code[name])) for name in headers}
    places = {}
    for name in headers:
        if not name.startswith(("tests/", "bench/")):
            for match in DEFINED.finditer(code[name]):
                places.setdefault(match[1] or match[2], name)
    found = []
    for name in headers:
        reached, waiting = set(), [name]
        while waiting:
            one = waiting.pop()
            if one in code and one not in reached:
                reached.add(one)
                waiting += included[one]
        known = set().union(*(declared[one] for one in reached))
        for number, line in enumerate(code[name].split("\n"), start=1):
            found += [Finding(name, number, f"{kind} is declared by nothing included",
                              f'include "{places[kind]}"')
                      for kind in sorted(set(NAMED.findall(line)))
                      if kind in places and kind not in known]
    return found


def compile_alone(root: Path, names: list[str], compiler: str) -> list[Finding]:
    found = []
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            source = Path(folder) / "alone.cpp"
            source.write_text(f'#include "{name}"\n', encoding="utf-8")
            command = [compiler, "-std=c++20", "-fsyntax-only", f"-I{root}", str(source)]
            result = subprocess.run(command, capture_output=True, text=True, check=False)
            if result.returncode != 0:
                errors = [line for line in result.stderr.splitlines() if "error:" in line]
                what = errors[0] if errors else result.stderr.strip()
                found.append(Finding(name, 1, f"does not compile alone ({what})",
                                     "include what it uses"))
    return found


def check(root: Path) -> list[Finding]:
    found, alone = [], []
    names = project_files(root)
    found += check_names(root, [name for name in names if name.endswith(".hpp")])
    for name in names:
        if name.endswith(".hpp"):
            found += check_text(root, name)
            has_source = os.path.exists(root / (name[:-len(".hpp")] + ".cpp"))
            if name.startswith("contract/") or (name.startswith(ALONE) and not has_source):
                alone.append(name)
        elif name.endswith(".cpp"):
            found += check_first_include(root, name)
    if len(sys.argv) > 2:
        found += compile_alone(root, alone, sys.argv[2])
    return found


if __name__ == "__main__":
    run(check)
