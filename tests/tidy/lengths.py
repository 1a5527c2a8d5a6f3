"""Goal: everything fits a head. File <= 500 lines, header <= 200, function <= 70, line <= 100."""

import ast
import re
from pathlib import Path

from findings import CODE, CPP, Finding, project_files, read_lines, run

FILE, HEADER, FUNCTION, LINE = 500, 200, 70, 100
LITERALS = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"'                       # comments, raw strings
    r'|"(?:\\.|[^"\\\n])*"|(?<!\w)\'(?:\\.|[^\'\\\n])+\'',  # strings, characters, not 1'000
    re.DOTALL)
TRANSPARENT = re.compile(
    r"(inline\s+)?(namespace|class|struct|union|enum|extern)\b[^()]*$", re.DOTALL)


def blank(match: re.Match) -> str:
    """A comment or literal replaced by its own line breaks, so that line numbers stay."""
    return "\n" * match[0].count("\n")


def without_template(head: str) -> str:
    """A declaration's head without `template <...>` and attributes in front."""
    head = re.sub(r"^\s*(\[\[.*?\]\]\s*)*", "", head)
    while head.startswith("template"):
        depth, at = 0, 0
        for at, letter in enumerate(head):
            depth += (letter == "<") - (letter == ">")
            if letter == ">" and depth == 0:
                break
        head = head[at + 1:].lstrip()
    return head


def cpp_functions(text: str) -> list[tuple[int, int]]:
    """(first line, last line) of every outermost function body, its signature included."""
    text = LITERALS.sub(blank, text)
    text = re.sub(r"^[ \t]*#(?:\\\n|[^\n])*", blank, text, flags=re.MULTILINE)
    functions, stack = [], []
    head_begin, first = 0, 0
    for at, letter in enumerate(text):
        inside_function = "function" in stack
        if letter == "{":
            head = without_template(text[head_begin:at])
            if inside_function:
                kind = "block"
            elif TRANSPARENT.match(head):
                kind = "scope"
            elif re.search(r"=\s*$", head) or "(" not in head:
                kind = "list"
            else:
                kind = "function"
                lead = len(text[head_begin:at]) - len(text[head_begin:at].lstrip())
                first = text.count("\n", 0, head_begin + lead) + 1
            stack.append(kind)
        elif letter == "}" and stack:
            if stack.pop() == "function":
                functions.append((first, text.count("\n", 0, at) + 1))
        if letter in "{};" and "function" not in stack:
            head_begin = at + 1
    return functions


def python_functions(text: str) -> list[tuple[int, int]]:
    kinds = (ast.FunctionDef, ast.AsyncFunctionDef)
    nodes = [node for node in ast.walk(ast.parse(text)) if isinstance(node, kinds)]
    return [(node.lineno, node.end_lineno or node.lineno) for node in nodes]


def check_file(name: str, lines: list[str]) -> list[Finding]:
    found = []
    limit = HEADER if name.endswith(".hpp") else FILE
    if len(lines) > limit:
        what = f"file has {len(lines)} lines, limit {limit}"
        found.append(Finding(name, limit + 1, what, "one concept per file: split it"))
    for number, line in enumerate(lines, start=1):
        if len(line) > LINE:
            what = f"line has {len(line)} columns, limit {LINE}"
            found.append(Finding(name, number, what, "break it, or run clang-format"))
    text = "\n".join(lines)
    functions = []
    if name.endswith(CPP):
        functions = cpp_functions(text)
    elif name.endswith(".py"):
        functions = python_functions(text)
    for first, last in functions:
        if last - first + 1 > FUNCTION:
            what = f"function has {last - first + 1} lines, limit {FUNCTION}"
            found.append(Finding(name, first, what, "name its phases and move them out"))
    return found


def check(root: Path) -> list[Finding]:
    found = []
    for name in project_files(root):
        if name.endswith(CODE) or Path(name).name == "CMakeLists.txt":
            found += check_file(name, read_lines(root, name))
    return found


if __name__ == "__main__":
    run(check)
