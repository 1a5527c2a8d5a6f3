"""Keys of scenes: which there are, as `abut reference` prints them."""

import difflib
import re
import subprocess
from pathlib import Path

from abut_tools.tables import ToolError
from abut_tools.yaml_text import flow_text


def nearest(word: str, known: list[str]) -> str:
    """A sentence, or nothing when no known word is near."""
    found = difflib.get_close_matches(word, known, n=3, cutoff=0.6)
    return f" Did you mean {' or '.join(found)}?" if found else ""


def has_body(bodies: dict, name: str) -> bool:
    """As written, or as a copy, whose number the program knows: ball_3 where ball has copies."""
    copied = bodies.get(name.rpartition("_")[0]) if re.search(r"_\d+$", name) else None
    return name in bodies or isinstance(copied, dict) and "copies" in copied


def may_be(key: str, path: str) -> bool:
    """Whether a key of a setting may be that of a row of the reference: <name>, * and {a,b} there,
    * in the key."""
    parts, rows = key.split("."), path.split(".")
    return len(parts) == len(rows) and all(
        "*" in (part, row) or row.startswith("<") or
        re.sub(r"\[\w*\]$", "", part) in row.strip("{}").split(",")
        for part, row in zip(parts, rows))


class KeyList:
    """What the program calls a key; <name> stands for the scene's own names. What a `*` in a key
    stands for the program alone knows: it is asked."""

    def __init__(self, abut: Path):
        self.abut, self.units = abut, {}
        self.keys = list(dict.fromkeys(self.reference("--keys").split()))

    def reference(self, *options: str) -> str:
        try:
            return subprocess.run([self.abut, "reference", *options], capture_output=True,
                                  text=True, check=True, timeout=30).stdout
        except (OSError, subprocess.SubprocessError) as error:
            raise ToolError(f"{self.abut} does not answer ({error}). Build the programs first.",
                            3) from error

    def unit(self, key: str) -> str:
        """Of the key's values, in SI; empty: none, or several that the key may stand for."""
        if not self.units:
            rows = re.findall(r"^\| `([^`]+)` \| [^|]* \| ([^|]*) \|", self.reference(),
                              re.MULTILINE)
            self.units = {path: unit.strip() for path, unit in rows}
        found = {unit for path, unit in self.units.items() if unit and may_be(key, path)}
        return found.pop() if len(found) == 1 else ""

    def refuse_unknown(self, key: str, bodies: dict, where: str) -> None:
        parts = key.split(".")
        for known in self.keys:
            pattern = known.split(".")
            if len(pattern) == len(parts) and all(
                    p == k or k == "*" or p.startswith("<") or re.sub(r"\[\w+\]$", "", p) ==
                    re.sub(r"\[\d+\]$", "", k) for p, k in zip(pattern, parts)):
                if (parts[0] == "bodies" and len(parts) > 1 and parts[1] != "*"
                        and not has_body(bodies, parts[1])):
                    raise ToolError(f"{where}: the scene has no body '{parts[1]}' (key '{key}'); "
                                    f"its bodies are {', '.join(bodies)}.", 2)
                return
        own = [known.replace("<name>", parts[1], 1) if len(parts) > 1 else known
               for known in self.keys]
        raise ToolError(f"{where}: '{key}' is not a key of a scene.{nearest(key, own)} "
                        "abut reference prints them all.", 2)

    def refuse_idle_stars(self, scene: Path, settings: dict, places: dict) -> None:
        """Keys with `*` that mean no key of the scene; `places`: where each of the keys stands."""
        command = [str(self.abut), "check", str(scene), "--probe", "0"]  # keys take no step
        for key, value in settings.items():
            command += ["--set", f"{key}={flow_text(value)}"]
        try:
            said = subprocess.run(command, capture_output=True, text=True, check=False,
                                  timeout=60).stderr
        except subprocess.TimeoutExpired:  # in the bodies: keys are looked up before
            return
        found = re.search(r"^error: --set ([^=]+)=.*?: (matches no key.*)$", said, re.MULTILINE)
        if found:
            place = places.get(found[1], "")
            raise ToolError(f"{place}: '{found[1]}' {found[2]}".removeprefix(": "), 2)
