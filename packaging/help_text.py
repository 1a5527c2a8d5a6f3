"""What a program says with --help, as data: man pages and completions are made from it. Reads the
two forms that our programs have, of CLI11 and of argparse."""

import os
import re
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

SECTIONS = {"positionals": "arguments", "positional arguments": "arguments",
            "options": "options", "subcommands": "commands"}


@dataclass
class Item:
    term: str      # "--out DIR"
    meaning: str
    beside: str = ""   # "not with --keys": what else the command line may say

    def names(self) -> list[str]:
        """Of an option: -h, --help."""
        return re.findall(r"(?<![\w-])--?\w[\w-]*", self.term)

    def operand(self) -> str:
        """What stands behind the names: DIR; empty: a flag."""
        words = re.sub(r"[,\s]*(?<![\w-])--?\w[\w-]*", " ", self.term, count=len(self.names()))
        return words.replace("REQUIRED", "").replace("...", "").strip(" ,")


@dataclass
class Help:
    usage: str = ""
    texts: list[str] = field(default_factory=list)   # paragraphs outside the sections
    parts: dict[str, list[Item]] = field(default_factory=dict)

    def items(self, part: str) -> list[Item]:
        return self.parts.get(part, [])


def help_of(program: Path, *words: str) -> Help:
    # As wide as can be: nothing is broken into lines, whatever terminal is there.
    environment = os.environ | {"COLUMNS": "10000", "LC_ALL": "C.UTF-8"}
    said = subprocess.run([program, *words, "--help"], capture_output=True, text=True, check=True,
                          env=environment, timeout=60).stdout
    return parsed(said)


def parsed(text: str) -> Help:
    found, part, items = Help(), "", []
    for block in re.split(r"\n\s*\n", text.strip("\n")):
        for line in block.split("\n"):
            heading = re.fullmatch(r"(\w[\w ]*):", line.strip())
            usage = re.match(r"\s*usage: *(.*)", line, re.IGNORECASE)
            if usage:
                found.usage, part = usage[1], "usage"
            elif heading and heading[1].lower() in SECTIONS:
                part = SECTIONS[heading[1].lower()]
                items = found.parts.setdefault(part, [])
            elif part == "usage" and line.startswith("  "):
                found.usage += " " + line.strip()
            elif part in found.parts and line.startswith(" "):
                add(items, line)
            elif line.strip():
                part = "text"
                found.texts.append(line.strip())
    if not found.usage or not found.parts:
        raise ValueError(f"this is no help that can be read:\n{text}")
    return found


def add(items: list[Item], line: str) -> None:
    """A line of a section: an item, or more of the last one's meaning."""
    item = re.fullmatch(r"  (\S.*?)(?:\s{2,}(\S.*))?", line)
    if item:
        term, *more = re.split(r" (?=Excludes:|Needs:)", item[1])  # CLI11's
        words = [each.replace("Excludes: ", "not with ").replace("Needs: ", "only with ")
                 for each in more]
        items.append(Item(term, item[2] or "", "; ".join(words)))
    elif items:
        items[-1].meaning = f"{items[-1].meaning} {line.strip()}".strip()


def verbs_of(programs: Path) -> dict[str, str]:
    """What `abut --help` lists: verbs and what they do."""
    return {item.term: item.meaning for item in help_of(programs / "abut").items("commands")}
