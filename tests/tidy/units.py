"""Goal: files of a target may be compiled at once (cmake/unity.cmake). Functions in their unnamed
namespaces become overloads of each other then, and a call could find a neighbour's: each name is
one file's. (What repeats to the letter is an error of the compiler.)
"""

import re
from collections import defaultdict
from pathlib import Path

from definitions import NAMESPACE, TYPE
from findings import Finding, project_files, read_lines, run
from lengths import LITERALS, blank, without_template

TARGET = re.compile(r"(?:add_library|add_executable|abut_gtest)\(([\w-]+)([^)]*)\)")
FUNCTION = re.compile(r"([\w:]+)\s*\(")
UNNAMED = "unnamed"
# Macros, and what std::function<double(...)> shows.
NOT_FUNCTIONS = {"TEST", "TEST_P", "TEST_F", "INSTANTIATE_TEST_SUITE_P", "double"}
BY_TYPE = {"encode", "decode"}  # of messages, whose types nothing converts into each other


def functions_of(text: str) -> list[tuple[str, int]]:
    """(name with its namespace, line) of every function that is defined in an unnamed namespace."""
    text = LITERALS.sub(blank, text)
    text = re.sub(r"^[ \t]*#(?:\\\n|[^\n])*", blank, text, flags=re.MULTILINE)
    found, scopes, begin = [], [], 0
    for at, letter in enumerate(text):
        if letter == "{":
            head = without_template(text[begin:at])
            namespace, name = NAMESPACE.match(text[begin:at]), FUNCTION.search(head)
            if scopes and scopes[-1] == UNNAMED and name and not TYPE.match(head) and \
                    "::" not in name[1] and name[1] not in NOT_FUNCTIONS:
                space = "::".join(scope for scope in scopes if scope != UNNAMED)
                found.append((f"{space}::{name[1]}", text.count("\n", 0, at) + 1))
            scopes.append((namespace[1] or UNNAMED) if namespace else "")
        elif letter == "}" and scopes:
            scopes.pop()
        if letter in "{};":
            begin = at + 1
    return found


def check(root: Path) -> list[Finding]:
    found = []
    for name in project_files(root):
        if not name.endswith("CMakeLists.txt"):
            continue
        folder = Path(name).parent
        for target in TARGET.finditer("\n".join(read_lines(root, name))):
            places = defaultdict(list)
            for file in re.findall(r"[\w./-]+\.cpp", target[2]):
                path = folder / file
                if not (root / path).is_file():
                    continue
                own = {}
                for function, line in functions_of("\n".join(read_lines(root, str(path)))):
                    own.setdefault(function, line)
                for function, line in own.items():
                    places[function].append((str(path), line))
            for function, known in places.items():
                if function.rpartition("::")[2] in BY_TYPE:
                    continue
                for path, line in known[1:]:
                    what = f"{function}() is in an unnamed namespace of {known[0][0]} too"
                    remedy = f"give it a name of its own within {target[1]}, or share one"
                    found.append(Finding(path, line, what, remedy))
    return found


if __name__ == "__main__":
    run(check)
