"""Man pages of the programs and of every verb of abut, from what they say with --help.

usage: man_pages.py FOLDER-OF-THE-PROGRAMS FOLDER-OF-THE-PAGES
"""

import gzip
import re
import subprocess
import sys
from pathlib import Path

from help_text import Help, help_of, verbs_of

HEADINGS = {"arguments": "ARGUMENTS", "options": "OPTIONS", "commands": "COMMANDS"}


def roff(text: str) -> str:
    """A text that troff prints as it stands."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text.startswith((".", "'")) else text


def sentence(text: str) -> str:
    text = text.strip().rstrip(".")
    return (text if text.startswith("abut") else text[:1].upper() + text[1:]) + "."


def bold(names: str) -> str:
    """Options bold, their operands in italics."""
    out = []
    for word in names.replace(",-", ", -").split(" "):
        font = "B" if word.startswith("-") or not word.isupper() else "I"
        out.append(f"\\f{font}{roff(word)}\\fR")
    return " ".join(out)


def page(name: str, version: str, purpose: str, said: Help, others: list[str]) -> str:
    lines = [f'.TH {name.upper()} 1 "" "abut {version}" "abut"', ".SH NAME",
             f"{roff(name)} \\- {roff(purpose)}", ".SH SYNOPSIS", ".nh", roff(said.usage), ".hy"]
    said_above = (purpose.lower(), f"{name}: {purpose}".lower())
    texts = [text for text in said.texts if text.rstrip(".").lower() not in said_above]
    lines.append(".SH DESCRIPTION")
    for k, text in enumerate(texts or [purpose]):
        lines += [".PP"] * (k > 0) + [roff(sentence(text))]
    for part, items in said.parts.items():
        lines.append(f".SH {HEADINGS[part]}")
        for item in items:
            more = f"; {item.beside}" if item.beside else ""
            lines += [".TP", bold(item.term.replace(" REQUIRED", "")), roff(item.meaning + more)]
    see = [other for other in others if other != name]
    lines += [".SH SEE ALSO", ",\n".join(f".BR {roff(other)} (1)" for other in see), ".PP",
              "The documents in share/doc/abut, and the scenes in share/abut/configs, below the "
              "prefix where abut is installed."]
    return "\n".join(lines) + "\n"


def first_words(said: Help, name: str) -> str:
    """What a program is for, of its own first sentence."""
    text = re.split(r"[.;:] ", said.texts[0].removeprefix("abut: ") + " ")[0].strip().rstrip(".")
    return text[:1].lower() + text[1:] if name != "abut" else text


def main() -> int:
    programs, out = Path(sys.argv[1]), Path(sys.argv[2])
    version = subprocess.run([programs / "abut", "--version"], capture_output=True, text=True,
                             check=True).stdout.split()[1]
    verbs = verbs_of(programs)
    helps = {"abut": help_of(programs / "abut"),
             "abut-solver": help_of(programs / "abut-solver")}
    helps |= {f"abut-{verb}": help_of(programs / "abut", verb) for verb in verbs}
    purposes = {f"abut-{verb}": meaning for verb, meaning in verbs.items()}
    out.mkdir(parents=True, exist_ok=True)
    for old in out.iterdir():
        old.unlink()
    for name, said in helps.items():
        purpose = purposes.get(name) or first_words(said, name)
        text = page(name, version, purpose, said, sorted(helps))
        # The same bytes from the same build: no name, no time.
        with (out / f"{name}.1.gz").open("wb") as file, \
                gzip.GzipFile("", "wb", mtime=0, fileobj=file) as packed:
            packed.write(text.encode())
    return 0


if __name__ == "__main__":
    sys.exit(main())
