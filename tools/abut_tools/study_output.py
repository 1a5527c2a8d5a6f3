"""Files of a study: results.json and .csv and .md, study.json, the scene of a target."""

import csv
import io
import json
import os
import platform
import re
import subprocess
from pathlib import Path

from abut_tools.page import write_whole
from abut_tools.study_file import COSTS, Study
from abut_tools.study_ends import counts_of, end_words, surprises
from abut_tools.study_results import (Result, by_sweep, claims_of, cost_key, fronts_of,
                                      series_of)
from abut_tools.study_tables import tables_of
from abut_tools.study_units import StudyUnits
from abut_tools.tables import ToolError
from abut_tools.units import COSTS as COST_UNITS, with_unit


MANY_RUNS = 6  # more in one cell of a table are not read


def machine() -> dict:
    model, memory = platform.processor() or platform.machine(), None
    try:
        found = re.search(r"^model name\s*:\s*(.+)$",
                          Path("/proc/cpuinfo").read_text(encoding="utf-8"), re.MULTILINE)
        model = found[1] if found else model
        total = re.search(r"^MemTotal:\s*(\d+) kB",
                          Path("/proc/meminfo").read_text(encoding="utf-8"), re.MULTILINE)
        memory = round(int(total[1]) / 1024.0 / 1024.0, 1) if total else None
    except OSError:
        pass
    cores = len(os.sched_getaffinity(0))
    return {"cpu": model, "cores": cores, "memory_gib": memory,
            "system": f"{platform.system()} {platform.release()}"}


def commit_of(folder: Path) -> str | None:
    """The commit of the study file's tree, with a word when the tree holds more than it."""
    def git(*words: str) -> str:
        return subprocess.run(["git", "-C", str(folder), *words], capture_output=True, text=True,
                              check=True, timeout=10).stdout.strip()
    try:
        return git("rev-parse", "--short=12", "HEAD") + (
            " and changes" if git("status", "--porcelain", "--untracked-files=no") else "")
    except (OSError, subprocess.SubprocessError):
        return None


def definition_of(study: Study) -> list[dict]:
    found = []
    for error in study.errors:
        what = error.measure.text if error.measure else " + ".join(error.history)
        how = f"{error.norm} of the difference over time" if error.history else ""
        against = {"closed_form": "closed form", "reference": "reference run"}.get(error.against)
        scale = f"{error.relative_to:g}" if error.relative_to else (
            "largest exact value" if error.history else "")
        found.append({"name": error.name, "of": what, "how": how,
                      "against": against or "", "relative_to": scale})
    return found


def facts_of(study: Study, results: list[Result], reference: dict | None, seconds: float,
             made: int, timed: bool, units: StudyUnits) -> dict:
    """`made`: runs of this time, the others were there before."""
    versions = next((result.record["summary"]["versions"] for result in results
                     if "versions" in result.record["summary"]), {})
    orders = [{key: each[key] for key in ("label", "error", "knob", "order", "steps")}
              for figure in study.figures if "convergence" in figure
              for each in series_of(results, figure)]
    cost = cost_key(results)
    return {
        "title": study.title, "study": study.path.name, "runs": len(results), "runs_made": made,
        "status": counts_of(results), "unexpected": [result.label for result in surprises(results)],
        "timed": timed, "repeats": study.repeats if timed else 1,
        "placement": study.placement, "seconds": round(seconds, 1), "machine": machine(),
        "versions": versions, "commit": commit_of(study.path.parent),
        "errors": definition_of(study), "units": {"knobs": units.knobs, "errors": units.errors},
        "reference": reference and {"settings": study.reference.settings,
                                    "scene": study.reference.scene.name,
                                    "folder": reference["folder"]},
        "cost_of_fronts": cost,
        "fronts": fronts_of(study, results, cost),
        "orders": orders, "claims": claims_of(study, results, units),
        "tables": tables_of(study, results, units)}


def csv_of(study: Study, results: list[Result]) -> str:
    text, names = io.StringIO(), [error.name for error in study.errors]
    keys = sorted({key for result in results for key in result.point.settings})
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["label", "status", "expected", *study.knobs, *COSTS, *names, *keys, "key",
                     "reason", "message", "command"])
    for result in results:
        cells = [result.point.knobs.get(knob) for knob in study.knobs]
        cells += [result.cost[name] for name in COSTS] + [result.errors[n] for n in names]
        cells += [result.point.settings.get(key) for key in keys]
        writer.writerow(["" if cell is None else cell for cell in
                         (result.label, result.status, result.point.expected, *cells, result.key,
                          result.reason, result.record["message"], result.command)])
    return text.getvalue()


def cell(value: object) -> str:
    text = "" if value is None else f"{value:.4g}" if isinstance(value, float) else str(value)
    return text.replace("|", "\\|").replace("\n", " ")


def md_table(headings: list[str], rows: list[list]) -> str:
    lines = ["| " + " | ".join(headings) + " |", "|" + "---|" * len(headings)]
    lines += ["| " + " | ".join(cell(value) for value in row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def measured_text(claim: dict) -> str:
    """What was asked, then every run's value; of many runs the smallest and the largest."""
    parts = []
    for check in claim["checks"]:
        measured = [each for each in check["measured"] if each["value"] is not None]
        values = [f"{each['run']} {each['shown']}" for each in measured]
        if len(values) > MANY_RUNS:
            measured.sort(key=lambda each: each["value"])
            values = [f"{len(values)} runs, from {measured[0]['shown']} ({measured[0]['run']}) to "
                      f"{measured[-1]['shown']} ({measured[-1]['run']})"]
        parts.append(f"`{check['value']}` {check['expected']}: {', '.join(values) or 'no value'}")
    return "; ".join(parts)


def claims_md(facts: dict) -> str:
    return md_table(["claim", "verdict", "measured", "note"],
                    [[claim["text"], claim["verdict"], measured_text(claim), claim["note"]]
                     for claim in facts["claims"]])


def orders_md(facts: dict) -> str:
    return md_table(["series", "error", "knob", "fitted order", "from point to point"],
                    [[each["label"], each["error"], each["knob"], f"{each['order']:.2f}",
                      " ".join(f"{step:.2f}" for step in each["steps"])]
                     for each in facts["orders"]])


def with_values(results: list[Result], names: list[str], kind: str) -> list[str]:
    """The costs or errors (`kind`) that at least one of the runs has."""
    return [name for name in names
            if any(getattr(result, kind).get(name) is not None for result in results)]


def runs_md(study: Study, results: list[Result], units: StudyUnits) -> str:
    costs = with_values(results, [c for c in COSTS if c not in ("wall_s_min", "wall_s_max")],
                        "cost")
    errors = with_values(results, [error.name for error in study.errors], "errors")
    return md_table(
        ["run", "status", *(with_unit(key, COST_UNITS.get(key, "")) for key in costs),
         *(with_unit(name, units.errors[name]) for name in errors)],
        [[result.label, end_words(result) + (f": {result.record['message']}"
                                             if result.record["message"] else ""),
          *(result.cost[key] for key in costs), *(result.errors[name] for name in errors)]
         for result in results])


def machine_text(facts: dict) -> str:
    place = facts["machine"]
    memory = f", {place['memory_gib']} GiB" if place["memory_gib"] else ""
    parts = [f"{place['cpu']}, {place['cores']} cores{memory}", place["system"]]
    parts += [f"{name} {text}" for name, text in facts["versions"].items()]
    parts += [f"commit {facts['commit']}"] if facts["commit"] else []
    return "; ".join(parts)


def timing_text(facts: dict) -> str:
    if facts["timed"]:
        times = f"up to {facts['repeats']} repeats" if facts["repeats"] > 1 else "one repeat"
        return f"Runs were timed one after another, {times}; wall time is that of all windows."
    return ("Runs were not timed, because several may have run at once: compute_s is the time "
            "that bodies spent computing. Time them with --serial.")


def md_of(study: Study, results: list[Result], facts: dict, units: StudyUnits) -> str:
    sweeps = len(by_sweep(results))
    parts = [f"# {study.title}\n\n{study.about.strip()}\n" if study.about else f"# {study.title}\n"]
    if facts["claims"]:
        parts.append("## Claims\n\n" + claims_md(facts))
    parts += [f"## {table['title']}\n\n{md_table(table['headings'], table['rows'])}"
              for table in facts["tables"]]
    parts += [f"## Runs{f': {name}' if name else ''}\n\n{runs_md(study, own, units)}"
              for name, own in by_sweep(results).items()]
    if facts["orders"]:
        parts.append("## Orders\n\n" + orders_md(facts))
    rows = [[each["error"], label] for each in facts["fronts"] for label in each["runs"]]
    parts.append(f"## Fronts\n\nNo other run {'of its set ' if sweeps > 1 else ''}is cheaper "
                 f"({facts['cost_of_fronts']}) and better.\n\n"
                 + md_table(["error", "run, cheapest first"], rows))
    parts.append(f"## Measured with\n\n{machine_text(facts)}.\n\n{timing_text(facts)}\n")
    return "\n".join(parts)


def write_results(out: Path, study: Study, results: list[Result], facts: dict,
                  units: StudyUnits) -> None:
    rows = [result.row(study) for result in results]
    write_whole(out / "results.json", json.dumps(rows, indent=1, allow_nan=False) + "\n")
    write_whole(out / "study.json", json.dumps(facts, indent=1, allow_nan=False) + "\n")
    write_whole(out / "results.csv", csv_of(study, results))
    write_whole(out / "results.md", md_of(study, results, facts, units))


def target_scene(out: Path, study: Study, result: Result, targets: dict[str, float]) -> Path:
    """The run's resolved scene; its expectations become the target, where a measure says it."""
    source = out / result.record["folder"] / "scene.resolved.yaml"
    try:
        lines = source.read_text(encoding="utf-8").splitlines()
    except OSError as error:
        raise ToolError(f"{source}: {error.strerror}. Run the study again with --force.",
                        3) from error
    asked = ", ".join(f"{name} at most {value:g}" for name, value in targets.items())
    expects = []
    for error in study.errors:
        plain = error.measure and re.fullmatch(r"(abs\()?([A-Za-z_][\w.]*)\)?", error.measure.text)
        if error.name not in targets or not plain or error.against:
            continue
        bound = targets[error.name] * abs(error.relative_to or 1.0)
        expects.append(f"    - {{measure: {plain[2]}, equals: {error.minus:.17g}, "
                       f"absolute: {bound:.17g}, because: \"target: {error.name}\"}}")
    kept, inside = [], False
    for line in lines:
        if line.startswith("#"):
            continue
        if line.rstrip() == "  expect:" or line.startswith("  expect: "):
            inside = True
            kept += ["  expect:", *expects] if expects else []
        elif not inside or not line.startswith("    "):
            inside = False
            kept.append(line)
    head = [f"# Cheapest setting of the study {study.path.name} with {asked}: {result.label}.",
            *(f"# {key}: {value}" for key, value in result.point.settings.items())]
    name = "_".join(f"{name}_{value:g}" for name, value in targets.items())
    path = out / f"target_{name}.yaml"
    write_whole(path, "\n".join(head + kept) + "\n")
    return path
