"""Goal: scripts/packages.txt is complete. Every Python module that is neither Python's own nor
ours comes from a package of the list."""

import ast
import sys
from pathlib import Path

from findings import Finding, project_files, read_lines, run

LIST = "scripts/packages.txt"
NAMES = {"PIL": "pil"}  # modules that their package is not named after
OPTIONAL = {"vtkmodules"}  # an independent reader: its tests are skipped where it is missing


def listed(root: Path) -> set[str]:
    lines = read_lines(root, LIST) if (root / LIST).is_file() else []
    return {line.split()[1] for line in lines if line.strip() and not line.startswith("#")}


def imported(text: str) -> list[tuple[int, str]]:
    """Line and first name of every module that a file imports, wherever in it."""
    names = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            names += [(node.lineno, alias.name.split(".")[0]) for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            names.append((node.lineno, node.module.split(".")[0]))
    return names


def check(root: Path) -> list[Finding]:
    sources = [name for name in project_files(root) if name.endswith(".py")]
    schemas = [name for name in project_files(root) if name.endswith(".proto")]  # protoc's modules
    schemas = [name.removeprefix("proto/") for name in schemas]
    ours = {part for name in sources + schemas for part in Path(name).with_suffix("").parts}
    packages = listed(root)
    found = []
    for name in sources:
        for line, module in imported((root / name).read_text(encoding="utf-8")):
            known = module in sys.stdlib_module_names | ours | OPTIONAL
            package = f"python3-{NAMES.get(module, module)}"
            if not known and package not in packages:
                found.append(Finding(name, line, f"imports '{module}', which {LIST} lacks",
                                     f"add {package} there with its reason"))
    return found


if __name__ == "__main__":
    run(check)
