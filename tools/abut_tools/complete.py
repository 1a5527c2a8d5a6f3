#!/usr/bin/python3
"""Completes the word behind --set, for the shells' completion functions: keys that a scene may
have, as `abut reference` prints them, with the names of this scene's bodies and interfaces, and the
values of keys that have few.

usage: complete.py ABUT SCENE WORD     prints completed words, one per line
"""

import itertools
import re
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from abut_tools.tables import ToolError  # noqa: E402
from abut_tools.yaml_text import read_yaml  # noqa: E402


def kinds_in(reference: str) -> dict[str, str]:
    """Of every key of `abut reference`, what may stand there: "number, at least 0". A row may
    be of several keys: {fe,modal} are these alternatives of a choice, * is each of them."""
    kinds = {}
    for row, kind in re.findall(r"^\| `([^`]+)` \| ([^|]*?) *\|", reference, re.MULTILINE):
        keys = [[]]
        for part in row.split("."):
            keys = [[*key, each] for key in keys for each in alternatives(part, kinds, key)]
        kinds.update(dict.fromkeys(map(".".join, keys), kind))
    return kinds


def alternatives(part: str, kinds: dict[str, str], above: list[str]) -> list[str]:
    if part == "*":
        return words_of(kinds.get(".".join(above), ""))
    pieces = re.split(r"\{([^}]*)\}", part)  # names, then what is in braces, in turns
    choices = [piece.split(",") if k % 2 else [piece] for k, piece in enumerate(pieces)]
    return ["".join(each) for each in itertools.product(*choices)]


def words_of(kind: str) -> list[str]:
    """What a value may be, where that is few words."""
    if kind.startswith("true or false"):
        return ["true", "false"]
    words = re.match(r"(?:one|choice) of ([\w, ]+)", kind)
    return listed(words)


def listed(words: re.Match | None) -> list[str]:
    return [each.strip() for each in words[1].split(",")] if words else []


def names_of(kind: str) -> list[str]:
    """Those that may stand in the place of a choice with its keys: steel."""
    return listed(re.search(r"; or the name ([\w, ]+)", kind))


def parts_of(key: str) -> list[str]:
    return key.split(".") if key else []


def is_at(pattern: str, part: str) -> bool:
    """Whether a part of a key that somebody writes is that part of a known key."""
    return (part == "*" and not pattern.endswith("]") or pattern == "<name>"
            or re.sub(r"\[\w+\]$", "[]", pattern) == re.sub(r"\[\d+\]$", "[]", part))


def values_at(scene: object, parts: list[str]) -> list:
    """What the scene has at a key; several where it has a `*`."""
    found = [scene]
    for depth, part in enumerate(parts):
        below = []
        for value in found:
            name, _, number = part.rstrip("]").partition("[")
            if not isinstance(value, dict):
                continue
            entries = [entry for key, entry in value.items() if part == "*" or str(key) == name]
            if depth == 1 and parts[0] == "bodies":
                entries = [with_like(value, entry) for entry in entries]
            if number:
                entries = [entry[int(number)] for entry in entries
                           if isinstance(entry, list) and int(number) < len(entry)]
            below += entries
        found = below
    return found


def with_like(bodies: dict, body: object, depth: int = 0) -> object:
    """A body with the keys of the one that it is like; map by map is close enough here."""
    other = bodies.get(body.get("like")) if isinstance(body, dict) else None
    if not isinstance(other, dict) or depth > 10:
        return body
    return {**with_like(bodies, other, depth + 1), **body}


def written(pattern: str, scene: object, above: list[str]) -> list[str]:
    """Parts that stand for one of a known key: names and numbers are those of the scene."""
    if pattern == "<name>":
        names = {str(name) for value in values_at(scene, above) if isinstance(value, dict)
                 for name in value}
        return [*sorted(names), "*"]
    if pattern.endswith("[i]"):
        stem = pattern.removesuffix("[i]")
        counts = [len(value) for value in values_at(scene, [*above, stem])
                  if isinstance(value, list)]
        return [f"{stem}[{i}]" for i in range(max([*counts, 1]))]
    return [pattern]


def chosen(kinds: dict, scene: object, above: list[str], pattern: list[str]) -> set[str]:
    """Of a choice, what the scene has chosen: keys of the others have no place. Empty: anything."""
    if not kinds.get(".".join(pattern), "").startswith("choice of "):
        return set()
    values = values_at(scene, above)
    return {name for value in values for name in (value if isinstance(value, dict) else [value])
            if isinstance(name, str)}


def completed(kinds: dict[str, str], scene: object, word: str) -> list[str]:
    """kinds: of every known key, what may stand there."""
    key, equals, begun = word.partition("=")
    if equals:
        return [f"{key}={value}" for value in values_of(kinds, key) if value.startswith(begun)]
    *above, last = key.split(".")
    found = {}
    for known, kind in kinds.items():
        pattern = parts_of(known)
        if len(pattern) <= len(above) or not all(map(is_at, pattern, above)):
            continue
        part, inner = pattern[len(above)], len(pattern) > len(above) + 1
        some = chosen(kinds, scene, above, pattern[:len(above)])
        if some and part not in some:
            continue
        for name in written(part, scene, above):
            if name.startswith(last):
                whole = ".".join([*above, name])
                # A map has no value that fits a command line; a choice may be one word.
                ends = ["."] if inner else [] if kind.startswith(("map", "list of maps")) else ["="]
                found.update(dict.fromkeys(whole + end for end in ends))
    return list(found)


def values_of(kinds: dict[str, str], key: str) -> list[str]:
    parts = parts_of(key)
    for known, kind in kinds.items():
        pattern = parts_of(known)
        if len(pattern) == len(parts) and all(map(is_at, pattern, parts)):
            return words_of(kind) + names_of(kind)
    return []


def main() -> int:
    if len(sys.argv) != 4:
        print(__doc__.strip().rsplit("\n\n", maxsplit=1)[-1], file=sys.stderr)
        return 2
    abut, scene, word = sys.argv[1:]
    asked = subprocess.run([abut, "reference"], capture_output=True, text=True, check=False)
    kinds = kinds_in(asked.stdout)
    try:
        tree = read_yaml(Path(scene)) if scene else {}
    except (ToolError, OSError):
        tree = {}
    for each in completed(kinds, tree, word):
        print(each)
    return 0


if __name__ == "__main__":
    sys.exit(main())
