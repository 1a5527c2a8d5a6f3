"""YAML as scenes use it: a number may be written 1e-7, a key stands once, errors name the line."""

import re
from pathlib import Path

import yaml

from abut_tools.tables import ToolError


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
        if key.value in seen:
            raise yaml.MarkedYAMLError(
                problem=f"key '{key.value}' stands twice, first in line {seen[key.value]}",
                problem_mark=key.start_mark)
        seen[key.value] = key.start_mark.line + 1
    return yaml.SafeLoader.construct_mapping(loader, node, deep=True)


Loader.add_constructor("tag:yaml.org,2002:map", map_of)


def read_yaml(path: Path) -> dict:
    try:
        found = yaml.load(path.read_text(encoding="utf-8"), Loader=Loader)
    except OSError as error:
        raise ToolError(f"{path}: {error.strerror}.", 2) from error
    except (yaml.YAMLError, UnicodeDecodeError) as error:
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
