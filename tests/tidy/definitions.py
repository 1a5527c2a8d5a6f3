"""Goal: one definition of every type. Two of one name in one namespace that both get linked break
C++'s one definition rule, and no compiler says so. Types in anonymous namespaces are their file's.
"""

import re
from pathlib import Path

from findings import CPP, Finding, project_files, read_lines, run
from lengths import LITERALS, blank, without_template

NOT_PRODUCT = ("tests/", "bench/")
NAMESPACE = re.compile(r"\s*(?:inline\s+)?namespace\b\s*([\w:]*)\s*$")
TYPE = re.compile(r"\s*(?:struct|class|union|enum(?:\s+(?:class|struct))?)\s+(?:\[\[.*?\]\]\s*|"
                  r"alignas\([^)]*\)\s*)*([\w:]+)\s*(?:final\s*)?(?::[^:].*)?$", re.DOTALL)


def types_of(text: str) -> list[tuple[str, int]]:
    """(name with its namespace, line) of every type that stands in named namespaces alone."""
    text = LITERALS.sub(blank, text)
    text = re.sub(r"^[ \t]*#(?:\\\n|[^\n])*", blank, text, flags=re.MULTILINE)
    found, scopes, begin = [], [], 0  # of the scopes around: a namespace's name, or none
    for at, letter in enumerate(text):
        if letter == "{":
            head = text[begin:at]
            namespace, kind = NAMESPACE.match(head), TYPE.match(without_template(head))
            if kind and all(scopes):
                found.append(("::".join([*scopes, kind[1]]), text.count("\n", 0, at) + 1))
            scopes.append(namespace[1] if namespace else "")
        elif letter == "}" and scopes:
            scopes.pop()
        if letter in "{};":
            begin = at + 1
    return found


def check(root: Path) -> list[Finding]:
    found, places = [], {}
    for name in project_files(root):
        if not name.endswith(CPP) or name.startswith(NOT_PRODUCT):
            continue
        for kind, line in types_of("\n".join(read_lines(root, name))):
            if not kind.startswith("abut::"):
                continue
            if kind in places:
                what = f"{kind} is defined in {places[kind]} already"
                found.append(Finding(name, line, what, "give it a name of its own, or share one"))
            places.setdefault(kind, f"{name}:{line}")
    return found


if __name__ == "__main__":
    run(check)
