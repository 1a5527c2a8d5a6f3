"""YAML as scenes use it: a number may be written 1e-7, a key stands once, errors name the line."""

import re
from pathlib import Path

import yaml

from abut_tools.tables import ToolError

MOST_BYTES, MOST_VALUES = 16_000_000, 1_000_000  # as the program reads of a scene


class Loader(yaml.SafeLoader):
    """PyYAML reads YAML 1.1, where 1e-7 is a word and `off` is false, and keeps the last of two
    equal keys without a word; the program reads YAML 1.2."""


# A list of its own: PyYAML shares that of the parent.
Loader.yaml_implicit_resolvers = {
    letter: [(tag, pattern) for tag, pattern in found
             if tag not in ("tag:yaml.org,2002:float", "tag:yaml.org,2002:bool")]
    for letter, found in yaml.SafeLoader.yaml_implicit_resolvers.items()}
Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float",
    re.compile(r"^[-+]?(\d+\.\d*([eE][-+]?\d+)?|\.\d+([eE][-+]?\d+)?|\d+[eE][-+]?\d+)$"),
    list("-+.0123456789"))
Loader.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile(r"^(true|false)$"), list("tf"))


def map_of(loader: Loader, node: yaml.MappingNode) -> dict:
    seen = {}
    for key, _ in node.value:
        if not isinstance(key, yaml.ScalarNode):
            raise yaml.MarkedYAMLError(problem="a key is no word", problem_mark=key.start_mark)
        if key.value in seen:
            raise yaml.MarkedYAMLError(
                problem=f"key '{key.value}' stands twice, first in line {seen[key.value]}",
                problem_mark=key.start_mark)
        seen[key.value] = key.start_mark.line + 1
    return yaml.SafeLoader.construct_mapping(loader, node, deep=True)


Loader.add_constructor("tag:yaml.org,2002:map", map_of)


def count_of(node: yaml.Node, counted: dict) -> int:
    """Values below a node with all aliases written out, as they will be; those that hold themselves
    have no end."""
    if id(node) in counted:
        if counted[id(node)] is None:
            raise yaml.MarkedYAMLError(problem="holds itself", problem_mark=node.start_mark)
        return counted[id(node)]
    counted[id(node)] = None
    below = [each for entry in node.value for each in (
        entry if isinstance(entry, tuple) else (entry,))] if not isinstance(
            node, yaml.ScalarNode) else []
    counted[id(node)] = 1 + sum(count_of(each, counted) for each in below)
    return counted[id(node)]


def tree_of(text: str) -> object:
    loader = Loader(text)
    try:
        node = loader.get_single_node()
        if node is not None and count_of(node, {}) > MOST_VALUES:
            raise yaml.MarkedYAMLError(problem=f"holds more than {MOST_VALUES} values",
                                       problem_mark=node.start_mark)
        return None if node is None else loader.construct_document(node)
    finally:
        loader.dispose()


def read_yaml(path: Path) -> dict:
    try:
        if path.exists() and not path.is_file():
            raise ToolError(f"{path}: is no regular file. Give the path of a file.", 2)
        if path.stat().st_size > MOST_BYTES:
            raise ToolError(f"{path}: is larger than {MOST_BYTES // 1_000_000} MB.", 2)
        found = tree_of(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ToolError(f"{path}: {error.strerror}.", 2) from error
    except RecursionError as error:
        raise ToolError(f"{path}: is nested too deep.", 2) from error
    except (yaml.YAMLError, UnicodeDecodeError, ValueError) as error:
        mark = getattr(error, "problem_mark", None)
        line = f":{mark.line + 1}" if mark else ""
        what = getattr(error, "problem", None) or str(error)
        raise ToolError(f"{path}{line}: {what}.", 2) from error
    if not isinstance(found, dict):
        raise ToolError(f"{path} is not a map of keys.", 2)
    return found


def flow_text(value: object) -> str:
    """A value in one line, as --set takes it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return repr(value)
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {flow_text(each)}" for key, each in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(flow_text(each) for each in value) + "]"
    if isinstance(value, str) and not re.fullmatch(r"[A-Za-z_][\w.]*", value):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    return "null" if value is None else str(value)
