"""Goal: dependencies point one way. Fails on any #include that layers.txt does not allow."""

import re
from fnmatch import fnmatch
from pathlib import Path
from typing import NamedTuple, Optional

from findings import CPP, Finding, project_files, read_lines, run

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


class Layer(NamedTuple):
    name: str
    files: list[str]
    layers: list[str]
    headers: list[str]


class Table(NamedTuple):
    layers: list[Layer]
    groups: dict[str, list[str]]

    def layer_of(self, path: str) -> Optional[Layer]:
        for layer in self.layers:
            if any(fnmatch(path, pattern) for pattern in layer.files):
                return layer
        return None

    def group_of(self, header: str) -> Optional[str]:
        for name, patterns in self.groups.items():
            if any(fnmatch(header, pattern) for pattern in patterns):
                return name
        return None


def read_table(path: Path) -> Table:
    table = Table([], {})
    for line in path.read_text(encoding="utf-8").splitlines():
        if not line.strip() or line.startswith("#"):
            continue
        if line.startswith("group "):
            _, name, *patterns = line.split()
            table.groups.setdefault(name, []).extend(patterns)
            continue
        name, *columns = line.split("|")
        table.layers.append(Layer(name.strip(), *(column.split() for column in columns)))
    return table


def judge(table: Table, layer: Layer, quoted: bool, header: str) -> Optional[tuple[str, str]]:
    """What is wrong with this include and what to do; None when it is allowed."""
    group = table.group_of(header)
    if group is not None:
        if "*" in layer.headers or group in layer.headers:
            return None
        return (f"layer {layer.name} must not see <{header}> ({group})",
                f"it may see {' '.join(layer.headers)}; move the code to a layer that may")
    target = table.layer_of(header)
    if not quoted or target is None or target.name == "main":
        if "*" in layer.headers:
            return None
        return (f"layer {layer.name} includes {header}, which belongs to no layer",
                'include our headers as "folder/file.hpp", or add the header to layers.txt')
    if target is layer or "*" in layer.layers or target.name in layer.layers:
        return None
    return (f"layer {layer.name} must not include layer {target.name} ({header})",
            f"it may include {' '.join(layer.layers) or 'itself'}; invert the dependency")


def check(root: Path) -> list[Finding]:
    table = read_table(Path(__file__).with_name("layers.txt"))
    found = []
    for name in project_files(root):
        if not name.endswith(CPP):
            continue
        layer = table.layer_of(name)
        if layer is None:
            found.append(Finding(name, 1, "file belongs to no layer", "add its row to layers.txt"))
            continue
        for number, line in enumerate(read_lines(root, name), start=1):
            match = INCLUDE.match(line)
            verdict = match and judge(table, layer, match[1] == '"', match[2])
            if verdict:
                found.append(Finding(name, number, *verdict))
    return found


if __name__ == "__main__":
    run(check)
