"""Goal: interfaces hold what several classes do. A virtual function that one class alone overrides
is that class's own: it belongs to an optional object, or to data. Which interfaces are held to
this is told by interfaces.txt, a line each: the class and the file that defines it.

A function counts as overridden by every class of the product below the interface, however deep,
that declares a function of the same name and number of parameters with `override` or `final`.
"""

import re
from pathlib import Path
from typing import NamedTuple

from findings import CPP, Finding, project_files, read_lines, run
from lengths import LITERALS, blank, without_template

NOT_PRODUCT = ("tests/", "bench/")
LIST = "tests/tidy/interfaces.txt"
CLASS = re.compile(r"\s*(?:struct|class)\s+(?:\[\[.*?\]\]\s*|alignas\([^)]*\)\s*)*"
                   r"([\w:]+)\s*(?:final\s*)?(?::([^:].*))?$", re.DOTALL)
ACCESS = re.compile(r"\s*(?:public|protected|private)\s*:(?!:)")


class Function(NamedTuple):
    name: str
    parameters: int  # how many
    line: int
    virtual: bool
    overrides: bool


class Class(NamedTuple):
    name: str
    bases: list[str]
    functions: list[Function]


def flat(text: str) -> str:
    """What stands outside of all angle brackets: no types of templates, nor their commas."""
    kept, depth = [], 0
    for at, letter in enumerate(text):
        if letter == "<":
            depth += 1
        elif letter == ">" and text[at - 1:at] != "-":
            depth = max(0, depth - 1)
        elif depth == 0:
            kept.append(letter)
    return "".join(kept)


def function_of(head: str, line: int) -> Function | None:
    """A member's declaration, up to its body, if it is one of a function."""
    head = flat(without_template(ACCESS.sub("", head)))
    start = re.search(r"(~?\w+)\s*\(", head)
    if start is None or start[1].startswith("~"):
        return None
    depth, parameters, empty = 1, 1, True
    end = start.end()
    while end < len(head) and depth > 0:
        letter = head[end]
        depth += (letter in "([{") - (letter in ")]}")
        parameters += letter == "," and depth == 1
        empty = empty and (letter.isspace() or depth == 0)
        end += 1
    before, after = head[:start.start()], head[end:]
    return Function(start[1], 0 if empty else parameters, line,
                    re.search(r"\bvirtual\b", before) is not None,
                    re.search(r"\b(override|final)\b", after) is not None)


def classes_of(text: str) -> list[Class]:
    """All classes of a file, nested ones too, with their own functions."""
    text = LITERALS.sub(blank, text)
    text = re.sub(r"^[ \t]*#(?:\\\n|[^\n])*", blank, text, flags=re.MULTILINE)
    found, scopes, begin = [], [], 0  # of the scopes around: the class that it is, or none

    def see(at: int) -> None:
        if scopes and scopes[-1] is not None:
            skipped = len(text[begin:at]) - len(ACCESS.sub("", text[begin:at]).lstrip())
            line = text.count("\n", 0, begin + skipped) + 1
            function = function_of(text[begin:at], line)
            if function:
                scopes[-1].functions.append(function)

    for at, letter in enumerate(text):
        head = text[begin:at] if letter in "{};" else ""
        if head.count("(") > head.count(")"):  # braces and bodies among parameters are values
            continue
        if letter == "{":
            head = without_template(ACCESS.sub("", head))
            kind = CLASS.match(head)
            if kind:
                bases = [re.sub(r"\b(public|protected|private|virtual)\b", "", base)
                         for base in flat(kind[2] or "").split(",")]
                names = [base.strip().split("::")[-1] for base in bases if base.strip()]
                found.append(Class(kind[1].split("::")[-1], names, []))
            else:
                see(at)
            scopes.append(found[-1] if kind else None)
        elif letter == "}" and scopes:
            scopes.pop()
        elif letter == ";":
            see(at)
        if letter in "{};":
            begin = at + 1
    return found


def overriders(function: Function, below: list[Class]) -> list[str]:
    return [each.name for each in below
            if any(own.name == function.name and own.parameters == function.parameters and
                   own.overrides for own in each.functions)]


def below(name: str, classes: list[Class]) -> list[Class]:
    """All that derive from a class, directly or not."""
    found, names = [], {name}
    while True:
        more = [each for each in classes if each not in found and names & set(each.bases)]
        if not more:
            return found
        found += more
        names |= {each.name for each in more}


def check(root: Path) -> list[Finding]:
    classes, of_file = [], {}
    for name in project_files(root):
        if name.endswith(CPP) and not name.startswith(NOT_PRODUCT):
            of_file[name] = classes_of("\n".join(read_lines(root, name)))
            classes += of_file[name]
    found = []
    for number, line in enumerate(read_lines(root, LIST), 1):
        if not line.strip() or line.startswith("#"):
            continue
        interface, file = line.split()
        own = [each for each in of_file.get(file, []) if each.name == interface]
        if not own or not any(function.virtual for function in own[0].functions):
            found.append(Finding(LIST, number, f"{file} defines no interface {interface}",
                                 "name the class and its file, or take the line out"))
            continue
        for function in own[0].functions:
            by = overriders(function, below(interface, classes)) if function.virtual else ["", ""]
            if len(by) < 2:
                what = (f"{interface}::{function.name} is overridden by "
                        f"{by[0] + ' alone' if by else 'nobody'}")
                found.append(Finding(file, function.line, what,
                                     "make it an optional object or data (CONTRIBUTING, Style)"))
    return found


if __name__ == "__main__":
    run(check)
