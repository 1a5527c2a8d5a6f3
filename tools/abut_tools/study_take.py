"""What a study keeps of a run's tables: errors over time, and curves short enough for a page.

The tables of a fine run have hundreds of megabytes; of these only the columns in question are read.
"""

import bisect
import csv
import json
import math
import re
from fnmatch import fnmatchcase
from pathlib import Path

from abut_tools.scene_keys import nearest
from abut_tools.study_file import Error, Study
from abut_tools.tables import ToolError, rounded, thinned, with_jumps

CURVE_POINTS = 1000
ENERGIES = ("kinetic", "stored", "total")


def read_columns(path: Path, wanted: set[str]) -> dict[str, list]:
    """Those of the wanted columns that the table has, and the time."""
    if not path.is_file():
        return {}
    with path.open(newline="", encoding="utf-8") as file:
        reader = csv.reader(file)
        names = [re.sub(r" \[.*\]$", "", name) for name in next(reader, [])]
        places = {name: i for i, name in enumerate(names) if name in wanted | {"time"}}
        rows = [[row[i] for i in places.values()] for row in reader if len(row) == len(names)]
    return {name: [float(row[k]) if row[k] else None for row in rows]
            for k, name in enumerate(places)}


def added(table: dict, names: list[str]) -> list | None:
    if any(name not in table for name in names):
        return None
    return [None if None in row else sum(row) for row in zip(*(table[name] for name in names))]


def at_times(times: list, values: list, wanted: list) -> list:
    """Straight lines between the rows of another table; no value outside of it."""
    found = []
    for t in wanted:
        k = bisect.bisect_left(times, t)
        if k < len(times) and times[k] == t:
            found.append(values[k])
        elif 0 < k < len(times) and values[k - 1] is not None and values[k] is not None:
            part = (t - times[k - 1]) / (times[k] - times[k - 1])
            found.append(values[k - 1] + part * (values[k] - values[k - 1]))
        else:
            found.append(None)
    return found


def history_error(error: Error, run: dict, exact: dict, reference: dict) -> float | None:
    got = added(run, error.history)
    other = exact if error.against == "closed_form" else reference
    right = added(other, error.history)
    if got is None or right is None:
        return None
    if other["time"] != run["time"]:
        right = at_times(other["time"], right, run["time"])
    pairs = [(g - r, r) for g, r in zip(got, right) if g is not None and r is not None]
    if not pairs:
        return None
    off = [abs(difference) for difference, _ in pairs]
    norm = {"max": max(off), "end": off[-1],
            "rms": math.sqrt(sum(each * each for each in off) / len(off))}[error.norm]
    scale = error.relative_to or max(abs(r) for _, r in pairs)
    return abs(norm / scale) if scale else None


# ---- curves ------------------------------------------------------------


def curve(times: list, values: list | None) -> dict | None:
    pairs = [(t, v) for t, v in zip(times, values or []) if t is not None and v is not None]
    if not pairs:
        return None
    x, y = thinned([t for t, _ in pairs], [v for _, v in pairs], CURVE_POINTS)
    return {"x": [rounded(t, 8) for t in x], "y": [rounded(v, 6) for v in y]}


def quantity_of(name: str, body: str, port: str, table: dict, summary: dict) -> list | None:
    """One of study_file.QUANTITIES but errors, from a table of columns."""
    facts = summary.get("ports", {}).get(port, {})
    if name == "position":
        column, offset, sign = table.get(f"{port}.u"), facts.get("position", 0.0), 1.0
    elif name == "velocity":
        column, offset, sign = table.get(f"{port}.v"), 0.0, 1.0
    elif name == "force":  # compression is positive
        column, offset, sign = table.get(f"{port}.force"), 0.0, -facts.get("normal", 1.0)
    else:
        column, offset, sign = table.get(f"{body}.{name}"), 0.0, 1.0
    return column and [None if v is None else sign * v + offset for v in column]


def curves_of(port: str, own: str, wanted: list[str], run: dict, exact: dict,
              summary: dict) -> dict:
    """By name: the run's curve, and with `exact:` before it that of the closed form. `own` is what
    the run calls the port."""
    form, found, body = summary.get("closed_form", {}), {}, port.split(".")[0]
    jumps = [form[key] for key in ("begin", "end") if key in form]
    for name in wanted:
        kind = name.removesuffix("_error")
        got = quantity_of(kind, body, own, run, summary)
        if kind == name:
            found[name] = curve(run["time"], got)
            right = quantity_of(name, body, own, exact, summary)
            if right:
                times, right = (with_jumps(exact["time"], right, jumps)
                                if name in ("velocity", "force") else (exact["time"], right))
                found[f"exact:{name}"] = curve(times, right)
            continue
        right, total = exact.get(f"{body}.{kind}"), exact.get(f"{body}.total")
        largest = max((abs(v) for v in total or [] if v is not None), default=0.0)
        if got and right and largest > 0.0:
            found[name] = curve(run["time"], [
                None if g is None or r is None else 100.0 * (g - r) / largest
                for g, r in zip(got, right)])
    return {name: each for name, each in found.items() if each}


def columns_in(table: Path) -> list[str]:
    with table.open(newline="", encoding="utf-8") as file:
        return [re.sub(r" \[.*\]$", "", name) for name in next(csv.reader(file), [])]


def port_in(table: Path, port: str) -> str:
    """The port's name in this run: a body that holds `left` as a member may call it X.left_tip."""
    if not table.is_file():
        return port
    names = columns_in(table)
    found = [name.removesuffix(".u") for name in names
             if name.endswith(f".{port.replace('.', '_')}.u")]
    return port if f"{port}.u" in names or not found else found[0]


def read_table(table: Path, wanted: set[str]) -> dict[str, list]:
    """read_columns, with the columns of a member's port (`left.tip.u`) by the name asked for."""
    own = {}
    for name in wanted:
        port, _, quantity = name.rpartition(".")
        own[name] = f"{port_in(table, port)}.{quantity}" if "." in port else name
    found = read_columns(table, wanted | set(own.values()))
    return {**found, **{name: found[there] for name, there in own.items() if there in found}}


def figures_for(study: Study, label: str) -> dict[str, list[str]]:
    """Quantities to draw of a run, by port."""
    wanted = {}
    for figure in study.figures:
        if "histories" in figure and matches(label, figure.get("runs", "*")):
            own = wanted.setdefault(figure["of"], [])
            own += [name for name in figure["histories"] if name not in own]
    return wanted


def matches(label: str, patterns: str | list) -> bool:
    return any(fnmatchcase(label, pattern)
               for pattern in ([patterns] if isinstance(patterns, str) else patterns))


def refuse_unknown(study: Study, table: Path, run: dict, over_time: list, own: dict) -> None:
    """A misspelt column is told by the first run that ends. Of several scenes one may have it."""
    if len({point.scene for point in study.points}) > 1 or not table.is_file():
        return
    names = columns_in(table)
    for error in over_time:
        for name in error.history:
            if name not in run:
                raise ToolError(f"errors.{error.name}: history: there is no column '{name}'."
                                f"{nearest(name, names)} history.csv of a run has them all.", 2)
    ports = sorted(name.removesuffix(".u") for name in names if re.search(r"\.u(_[xyz])?$", name))
    for port, found in own.items():
        if not any(f"{found}.u{axis}" in names for axis in ("", "_x")):
            raise ToolError(f"figures: of: there is no port '{port}'.{nearest(port, ports)} There "
                            f"are: {', '.join(ports)}.", 2)


def take(study: Study, label: str, folder: Path, reference: Path | None) -> dict:
    """Errors over time and curves of one finished run."""
    over_time = [error for error in study.errors if error.history]
    wanted = {name for error in over_time for name in error.history}
    drawn = figures_for(study, label)
    own = {port: port_in(folder / "history.csv", port) for port in drawn}
    for port in drawn:
        body = port.split(".")[0]
        wanted |= {f"{own[port]}.{name}" for name in ("u", "v", "force")}
        wanted |= {f"{body}.{name}" for name in (*ENERGIES, "mean_velocity")}
    if not wanted:
        return {"errors": {}, "curves": {}}
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    run = read_table(folder / "history.csv", wanted)
    refuse_unknown(study, folder / "history.csv", run, over_time, own)
    exact = read_table(folder / "closed_form.csv", wanted)
    fine = read_table(reference / "history.csv", wanted) if reference else {}
    return {"errors": {error.name: history_error(error, run, exact, fine)
                       for error in over_time},
            "curves": {port: curves_of(port, own[port], names, run, exact, summary)
                       for port, names in drawn.items()}}
