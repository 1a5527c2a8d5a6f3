"""Keys of scenes: which there are (as `abut reference` prints them), and what a `*` stands for."""

import copy
import difflib
import re
import subprocess
from pathlib import Path

from abut_tools.tables import ToolError


def nearest(word: str, known: list[str]) -> str:
    """A sentence, or nothing when no known word is near."""
    found = difflib.get_close_matches(word, known, n=3, cutoff=0.6)
    return f" Did you mean {' or '.join(found)}?" if found else ""


def has_body(bodies: dict, name: str) -> bool:
    """As written, or as a copy, whose number the program knows: ball_3 where ball has copies."""
    copied = bodies.get(name.rpartition("_")[0]) if re.search(r"_\d+$", name) else None
    return name in bodies or isinstance(copied, dict) and "copies" in copied


class KeyList:
    """What the program calls a key; <name> stands for the scene's own names."""

    def __init__(self, abut: Path):
        try:
            text = subprocess.run([abut, "reference"], capture_output=True, text=True, check=True,
                                  timeout=30).stdout
        except (OSError, subprocess.SubprocessError) as error:
            raise ToolError(f"{abut} does not answer ({error}). Build the programs first.",
                            3) from error
        self.keys = re.findall(r"^\| `([^`]+)` \|", text, re.MULTILINE)

    def refuse_unknown(self, key: str, scene: dict, where: str) -> None:
        parts, bodies = key.split("."), scene.get("bodies") or {}
        for known in self.keys:
            pattern = known.split(".")
            if len(pattern) == len(parts) and all(
                    p == k or p.startswith("<") or re.sub(r"\[\w+\]$", "", p) ==
                    re.sub(r"\[\d+\]$", "", k) for p, k in zip(pattern, parts)):
                if parts[0] == "bodies" and len(parts) > 1 and not has_body(bodies, parts[1]):
                    raise ToolError(f"{where}: the scene has no body '{parts[1]}' (key '{key}'); "
                                    f"its bodies are {', '.join(bodies)}.", 2)
                return
        own = [known.replace("<name>", parts[1], 1) if len(parts) > 1 else known
               for known in self.keys]
        raise ToolError(f"{where}: '{key}' is not a key of a scene.{nearest(key, own)} "
                        "abut reference prints them all.", 2)


def put(scene: dict, key: str, value: object) -> None:
    *folders, last = key.split(".")
    for folder in folders:
        inner = scene.get(folder)
        if not isinstance(inner, dict):  # absent, or a choice that is written as its name alone
            inner = scene[folder] = {inner: {}} if isinstance(inner, str) else {}
        scene = inner
    if value is None:  # takes the key out, as --set key=null does
        scene.pop(last, None)
    else:
        scene[last] = copy.deepcopy(value)


def expanded(scene: dict, key: str, where: str) -> list[str]:
    """The keys of this scene that a key with `*` means; a key without one means itself."""
    if "*" not in key.split("."):
        return [key]
    found = [("", scene)]
    parts = key.split(".")
    for k, part in enumerate(parts):
        inner = []
        for path, value in found:
            if isinstance(value, str):  # a choice that is written as its name alone
                value = {value: {}}
            if not isinstance(value, dict):
                continue
            last = k == len(parts) - 1
            names = list(value) if part == "*" else [part] if part in value or last else []
            inner += [(f"{path}.{name}".lstrip("."), value.get(name)) for name in names]
        found = inner
    if not found:
        raise ToolError(f"{where}: '{key}' matches no key of the scene.", 2)
    return [path for path, _ in found]
