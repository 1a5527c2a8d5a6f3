"""Files of a finished run, read once and checked whole: what a page finds in them is of the kind
that it expects, and whatever else they are is told in one sentence with the file and the place."""

import csv
import json
import math
import re
from pathlib import Path

from abut_tools.tables import Table, ToolError
from abut_tools.units import Units

MOST_BYTES = 4_000_000_000
AGAIN = "Run the scene again, or take the file from a copy of the run"
NOT_READ = "Make it readable, or name another folder"


def damaged(where: object, what: str) -> ToolError:
    return ToolError(f"{where}: {what}. {AGAIN}.", 2)


def is_there(path: Path) -> bool:
    """Whether there is a regular file; other things of that name are refused unread: what they are
    read from may never end."""
    try:
        if not path.exists():
            return False
        if not path.is_file():
            raise damaged(path, "is no regular file")
        if path.stat().st_size > MOST_BYTES:
            raise damaged(path, f"is larger than {MOST_BYTES // 1_000_000_000} GB")
    except OSError as error:
        raise ToolError(f"{path}: cannot be read: {error.strerror}. {NOT_READ}.", 2) from error
    return True


def text_of(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise ToolError(f"{path}: cannot be read: {error.strerror}. {NOT_READ}.", 2) from error
    except UnicodeDecodeError as error:
        raise damaged(path, f"is no text (byte {error.start})") from error


# ---- tables ------------------------------------------------------------


def number_of(cell: str) -> float | None:
    if not cell:
        return None
    value = float(cell)
    if not math.isfinite(value):
        raise ValueError(f"{cell[:20]} is no finite number")
    return value


def row_of(cells: list[str], width: int, before: float) -> list[float | None]:
    if len(cells) != width:
        raise ValueError(f"{len(cells)} cells, the header has {width}")
    row = [number_of(cell) for cell in cells]
    if row[0] is None:
        raise ValueError("there is no time")
    if row[0] < before:
        raise ValueError(f"the time {row[0]:.6g} lies before that of the row before")
    return row


def read_table(path: Path) -> Table:
    """Units leave the header. A last row that a killed run cut short is left out."""
    text = text_of(path)
    try:
        lines = list(csv.reader(text.splitlines()))
    except csv.Error as error:
        raise damaged(path, f"is no table of cells ({error})") from error
    names = [re.sub(r" \[.*\]$", "", name) for name in lines[0]] if lines else []
    if not names:
        raise damaged(path, "is empty")
    if names[0] != "time":
        raise damaged(path, f"is no table of a run: its first column is '{names[0][:40]}'")
    if len(set(names)) < len(names):
        raise damaged(path, f"has the column {max(names, key=names.count)[:40]} twice")
    rows, before = [], -math.inf
    for number, line in enumerate(lines[1:], start=2):
        try:
            rows.append(row_of(line, len(names), before))
        except ValueError as error:
            if number == len(lines) and not text.endswith("\n"):
                break
            raise damaged(f"{path}:{number}", str(error)) from error
        before = rows[-1][0]
    return Table(names, rows, str(path))


def cut_short(table: Table, summary: dict) -> str:
    """What a summary tells of a run that its table does not hold, in words; empty: nothing."""
    reached = summary.get("time", {}).get("reached")
    last = max(table["time"], default=-math.inf)
    if reached is None or last >= reached - 1e-9 * abs(reached):
        return ""
    unit = Units(summary.get("units")).word("s")
    return f"{table.where} ends before the run did, at {reached:.6g} {unit}: curves are cut short"


# ---- JSON ------------------------------------------------------------

TEXT, NUMBER, FLAG = "a text", "a number", "true or false"


class Maybe:
    """May be null as well: a number that the run could not tell."""

    def __init__(self, kind: object):
        self.kind = kind


class Either:
    def __init__(self, *kinds: object):
        self.kinds = kinds


VALUE = Maybe(NUMBER)
COUNTS = Either(NUMBER, [NUMBER])
CONTACT = {"begin": VALUE, "end": VALUE, "duration": VALUE, "force": VALUE, "impulse": VALUE}

# A map names its keys, those with ! in front must be there, and those that are not named are not
# read; a map whose only key is * has entries of one kind under names of their own.
SUMMARY = {
    "status": TEXT, "title": TEXT, "units": {"*": TEXT}, "notes": [TEXT], "measures": {"*": VALUE},
    "time": {"begin": VALUE, "end": VALUE, "reached": VALUE}, "reason": TEXT,
    "expectations": [{"!measure": TEXT, "!expected": TEXT, "!got": VALUE, "!pass": FLAG,
                      "because": TEXT}],
    "energy_scales": {"total": VALUE, "bodies": {"*": VALUE}},
    "closed_form": {**CONTACT, "interface": TEXT, "closing_speed": VALUE,
                    "interfaces": {"*": CONTACT},
                    "bodies": {"*": {"!wall": FLAG, "mean_velocity_end": VALUE}}},
    "ports": {"*": {"position": NUMBER, "normal": NUMBER, "body": TEXT}},
    "interfaces": {"*": {"sides": [TEXT], "tied": FLAG}}, "never_closed": [TEXT],
    "state_hash": Maybe(TEXT), "windows": NUMBER, "contact_windows": NUMBER, "exchanges": NUMBER,
    "timing": {"wall_s": VALUE, "compute_s": {"*": VALUE}, "waited_s": {"*": VALUE},
               "overhead_per_exchange_us_median": VALUE},
    "estimate": {"windows": COUNTS, "contact_windows": COUNTS, "exchanges": COUNTS,
                 "in_use": [TEXT], "not_built": [TEXT]},
    "bodies": [{"!name": TEXT, "!model": TEXT, "mass": VALUE, "members": [{"!name": TEXT}]}],
    "versions": {"*": TEXT},
    "overlaps": [{"!bodies": [TEXT], "!depth": VALUE, "!time": VALUE, "place": [VALUE]}],
    "accuracy": {"given_up": {
        **dict.fromkeys(("passive_windows", "halved_windows", "rigid_windows", "unanswered",
                         "near_windows"),
                        NUMBER),
        **dict.fromkeys(("joules", "largest_energy", "normal", "friction", "damped",
                         "changes_of_form", "push_out", "owed", "missed", "repaid",
                         "deepest"), VALUE),
        **dict.fromkeys(("lost_by_body", "taken_from_body", "refused_by_body"), {"*": VALUE}),
        "words": TEXT}},
}
EVENT = {"time": VALUE, "kind": TEXT, "subject": TEXT, "text": TEXT}


def is_a(value: object, kind: str) -> bool:
    if kind == TEXT:  # half a surrogate pair can stand in JSON and in no file
        return isinstance(value, str) and not re.search("[\ud800-\udfff]", value)
    if kind == FLAG:
        return isinstance(value, bool)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return False
    return abs(value) < 1e300 or isinstance(value, float) and math.isfinite(value)


def shown_key(key: str) -> str:
    return key.encode("ascii", "backslashreplace").decode()[:60]


def check(value: object, kind: object, key: str) -> None:
    """Raises ValueError with the key of the first value that is not of its kind."""
    if isinstance(kind, Maybe):
        if value is not None:
            check(value, kind.kind, key)
    elif isinstance(kind, Either):
        check(value, next((one for one in kind.kinds
                           if isinstance(one, list) == isinstance(value, list)), kind.kinds[0]),
              key)
    elif isinstance(kind, str):
        if not is_a(value, kind):
            raise ValueError(f"{key} is not {kind}")
    elif isinstance(kind, list):
        if not isinstance(value, list):
            raise ValueError(f"{key} is not a list")
        for i, item in enumerate(value):
            check(item, kind[0], f"{key}[{i}]")
    elif not isinstance(value, dict):
        raise ValueError(f"{key or 'what it holds'} is not a map")
    elif "*" in kind:
        for name, item in value.items():
            check(name, TEXT, f"a name in {key}")
            check(item, kind["*"], f"{key}.{shown_key(name)}")
    else:
        for name, inner in kind.items():
            plain = name.removeprefix("!")
            if plain in value:
                check(value[plain], inner, f"{key}.{plain}".lstrip("."))
            elif plain != name:
                raise ValueError(f"{key} has no {plain}")


def parsed(text: str, kind: object) -> dict:
    try:
        value = json.loads(text)
    except RecursionError as error:
        raise ValueError("its brackets are nested too deep") from error
    check(value, kind, "")
    return value


def read_json(path: Path, kind: object) -> dict:
    try:
        return parsed(text_of(path), kind)
    except json.JSONDecodeError as error:
        raise damaged(f"{path}:{error.lineno}", f"is not JSON ({error.msg})") from error
    except ValueError as error:
        raise damaged(path, str(error)) from error


def read_events(path: Path) -> list[dict]:
    """A last line that a killed run cut short is left out."""
    text = text_of(path)
    lines, events = text.split("\n"), []
    if lines[-1] == "":
        lines.pop()
    for number, line in enumerate(lines, start=1):
        try:
            events.append(parsed(line, EVENT))
        except ValueError as error:
            if number == len(lines) and not text.endswith("\n"):
                break
            what = "is not JSON" if isinstance(error, json.JSONDecodeError) else str(error)
            raise damaged(f"{path}:{number}", what) from error
    return events
