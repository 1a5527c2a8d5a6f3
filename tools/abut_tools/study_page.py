"""The page of a study: claims, costs against errors, orders, curves of all runs, tables."""

import html
import json
import re
from pathlib import Path
from typing import NamedTuple

from abut_tools.page import Html, canvas_of, filled, script_json, section, table_of
from abut_tools.study_ends import end_words, surprises, why
from abut_tools.study_file import COSTS, Study
from abut_tools.study_output import machine_text, timing_text, with_values
from abut_tools.study_results import Result, by_sweep, front, series_of
from abut_tools.study_take import matches
from abut_tools.study_units import StudyUnits
from abut_tools.tables import Figure, ToolError, scaled_unit, shown
from abut_tools.units import with_unit

MOST_CURVES = 20  # more are not told apart
NUMBER = re.compile(r"(\d(?:\.\d+)?e[-+]\d+)")  # 1e-06 is not to be broken at its sign
MOST_COMMANDS = 1000  # of a page; results.csv has all
# Neighbours differ in hue and in lightness.
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e0a100", "#5b5b5b", "#56b4e9", "#8a2b00",
           "#00573f", "#7b3fa0", "#8c6d1f", "#a31545", "#7fb800", "#243c8f", "#ff8fa3", "#00a7b5")
EXACT = "#1c2430"
TITLES = {
    "position": ("Position of {port}", "position", "m"),
    "velocity": ("Velocity of {port}", "velocity", "m/s"),
    "force": ("Contact force at {port}", "force, compression positive", "N"),
    "mean_velocity": ("Mean velocity of {body}", "mean velocity", "m/s"),
    "kinetic": ("Kinetic energy of {body}", "energy", "J"),
    "stored": ("Potential energy of {body}", "energy", "J"),
    "total": ("Total energy of {body}", "energy", "J"),
    "kinetic_error": ("Kinetic energy error of {body}", "error, of the exact total", "%"),
    "stored_error": ("Potential energy error of {body}", "error, of the exact total", "%"),
    "total_error": ("Total energy error of {body}", "error, of the exact total", "%"),
}
COST_WORDS = {
    "wall_s_median": "wall time, median [s]", "wall_s_min": "wall time, shortest [s]",
    "wall_s_max": "wall time, longest [s]", "compute_s": "computing of the bodies [s]",
    "exchanges": "exchanges", "iterations_mean": "Schwarz iterations, mean",
    "memory_mib": "memory [MiB]"}


class Shown(NamedTuple):
    """What the page is made of."""

    study: Study
    results: list[Result]
    facts: dict
    units: StudyUnits

    def error(self, name: str) -> str:
        return with_unit(words_of(name), self.units.errors[name])

    def knob(self, name: str) -> str:
        return with_unit(words_of(name), self.units.knobs.get(name, ""))


def colour(k: int) -> str:
    return COLOURS[k % len(COLOURS)]


def words_of(name: str) -> str:
    return name.replace("_", " ")


# ---- curves ------------------------------------------------------------


class Curves:
    """Overlaid histories: one group of figures, with one switch per run for all of them."""

    def __init__(self, number: int, spec: dict, results: list[Result], out: Path,
                 units: StudyUnits):
        self.second = units.word("s")
        self.port, self.name = spec["of"], f"histories{number}"
        self.title = spec.get("title", f"Over time, {self.port}")
        chosen = [result for result in results if result.status == "completed"
                  and matches(result.label, spec.get("runs", "*"))]
        if len(chosen) > MOST_CURVES:
            raise ToolError(f"figures[{number}] overlays {len(chosen)} runs, at most {MOST_CURVES} "
                            "can be told apart: choose some with runs.", 2)
        self.runs, self.figures = [], []
        curves = {}
        for result in chosen:
            try:
                found = json.loads((out / result.record["folder"] / "curves.json").read_text(
                    encoding="utf-8")).get(self.port)
            except (OSError, ValueError):
                found = None
            if found:
                curves[result.label] = found
                self.runs.append(result.label)
        for quantity in spec["histories"]:
            title, axis, unit = (text.format(port=self.port, body=self.port.split(".")[0])
                                 for text in TITLES[quantity])
            figure = Figure(f"{self.name}_{quantity}", title, axis, units.word(unit))
            for k, label in enumerate(self.runs):
                if quantity in curves[label]:
                    figure.add(label, colour(k), curves[label][quantity]["x"],
                               curves[label][quantity]["y"])
            exact = next((found[f"exact:{quantity}"] for found in curves.values()
                          if f"exact:{quantity}" in found), None)
            if exact:
                figure.add("exact", EXACT, exact["x"], exact["y"], exact=True)
            if figure.curves:
                self.figures.append(figure)

    def data(self, limit: int) -> list[dict]:
        largest = max((abs(x) for figure in self.figures for each in figure.curves
                       for x in each["x"]), default=0.0)
        return [{**figure.data(limit, scaled_unit(largest, self.second)), "legend": False,
                 "group": self.name} for figure in self.figures]

    def html(self) -> str:
        if not self.figures:
            return ""
        chips = "".join(f'<button class="chip" data-group="{self.name}" aria-pressed="true" '
                        f'style="--c: {colour(k)}">{html.escape(label)}</button>'
                        for k, label in enumerate(self.runs))
        if any(each["exact"] for figure in self.figures for each in figure.curves):
            chips += (f'<button class="chip" data-group="{self.name}" aria-pressed="true" '
                      f'style="--c: {EXACT}">exact</button>')
        note = ('<p class="note">Touch a name to hide or show its curves in all figures; twice to '
                "see it alone. Dashed: closed form.</p>")
        plots = "".join(canvas_of(figure) for figure in self.figures)
        return section(self.title, f'{note}<div class="chips">{chips}</div>'
                       f'<div class="figures">{plots}</div>')


# ---- parts ------------------------------------------------------------


def claims_html(facts: dict) -> str:
    kinds = {"holds": "ok", "does not hold": "failed"}
    parts = []
    for claim in facts["claims"]:
        rows = ""
        for check in claim["checks"]:
            values = "".join(
                f'<li class="{"" if each["holds"] is None else "ok" if each["holds"] else "off"}">'
                f'<span>{html.escape(each["run"])}</span> <b>{html.escape(each["shown"])}</b></li>'
                for each in check["measured"])
            rows += (f'<p class="note"><code>{html.escape(check["value"])}</code> '
                     f'{html.escape(check["expected"])}</p><ul class="values">'
                     f'{values or "<li>no run</li>"}</ul>')
        note = f'<p>{html.escape(claim["note"])}</p>' if claim["note"] else ""
        kind = kinds.get(claim["verdict"], "part")
        parts.append(f'<details class="claim"><summary><span>{html.escape(claim["text"])}</span>'
                     f'<span class="badge {kind}">{claim["verdict"]}</span></summary>'
                     f"{note}{rows}</details>")
    note = '<p class="note">Open a claim to see the measured values behind its verdict.</p>'
    return section("Claims against measured values", note + "".join(parts)) if parts else ""


def fronts_html(page: Shown, sweep: str, results: list[Result]) -> str:
    cost, text = page.facts["cost_of_fronts"], ""
    for error in page.study.errors:
        rows = [[result.label, shown(result.cost[cost]), shown(result.errors[error.name])]
                for result in front(results, error.name, cost)]
        title = words_of(error.name).capitalize() + (f", {sweep}" if sweep else "")
        text += (f"<h3>{html.escape(title)}</h3>" + table_of(
            ["run", COST_WORDS[cost], with_unit("error", page.units.errors[error.name])],
            rows)) if rows else ""
    return text


def trade_html(page: Shown) -> str:
    study, results, facts = page.study, page.results, page.facts
    costs = [key for key in COSTS if any(result.cost[key] is not None for result in results)]
    if not costs:
        return ""
    options = "".join(
        f'<option value="{key}"{" selected" if key == facts["cost_of_fronts"] else ""}>'
        f"{html.escape(COST_WORDS[key])}</option>" for key in costs)
    choose = f'<label class="choose">Cost: <select id="cost">{options}</select></label>'
    sweeps = list(dict.fromkeys(result.point.sweep for result in results))
    if len(sweeps) > 1:
        words = "".join(f'<option value="{html.escape(name)}">{html.escape(name)}</option>'
                        for name in sweeps)
        choose += f' <label class="choose">Runs: <select id="sweep">{words}</select></label>'
    plots = "".join(canvas_of(Figure(f"trade_{error.name}", words_of(error.name).capitalize(),
                                     "", "")) for error in study.errors)
    tables = "".join(fronts_html(page, name, own)
                     for name, own in by_sweep(results).items())
    note = ('<p class="note">Ringed and joined: the front, runs that no other beats in both. Touch '
            f"a point for its settings. {html.escape(timing_text(facts))}</p>")
    return section("Cost against error", f'{choose}{note}<div id="groups" class="chips"></div>'
                   f'<div class="figures">{plots}</div><details><summary>Fronts as tables'
                   f"</summary>{tables}</details>")


def axis_words(text: str) -> str:
    """What stands beside an axis has no more room than that."""
    return text if len(text) <= 36 else "error" + text[text.rindex(" ["):] * text.endswith("]")


def convergence_data(page: Shown) -> list[dict]:
    found = []
    for number, figure in enumerate(page.study.figures):
        series = series_of(page.results, figure) if "convergence" in figure else []
        if series:
            found.append({
                "name": f"convergence{number}", "knob": page.knob(figure["knob"]),
                "title": figure.get("title", f"{words_of(figure['convergence']).capitalize()} "
                                    f"against {words_of(figure['knob'])}"),
                "error": page.error(figure["convergence"]),
                "axis": axis_words(page.error(figure["convergence"])),
                "series": [{**each, "colour": colour(k)} for k, each in enumerate(series)]})
    return found


def order_text(value: float) -> str:
    return f"{round(value, 2) + 0.0:.2f}"  # no order is -0.00


def convergence_html(data: list[dict]) -> str:
    plots, rows = "", []
    for figure in data:
        names = "".join(f'<li style="--c: {each["colour"]}">{unbroken(each["label"])}: order '
                        f'{order_text(each["order"])}</li>' for each in figure["series"])
        plots += canvas_of(Figure(figure["name"], figure["title"], "", "")).replace(
            "</figure>", f'<ul class="legend">{names}</ul></figure>')
        rows += [[unbroken(each["label"]), figure["error"], figure["knob"],
                  order_text(each["order"]), "  ".join(map(order_text, each["steps"]))]
                 for each in figure["series"]]
    table = table_of(["series", "error", "against", "fitted order", "from point to point"], rows)
    return section("Orders of convergence", f'<div class="figures">{plots}</div>' + table.replace(
        "<table>", '<table class="orders">')) if data else ""


def number(value: float | None) -> str:
    if value is None or isinstance(value, int):
        return "" if value is None else str(value)
    return f"{value:.4g}"


def cost_text(result: Result, key: str) -> str:
    text = number(result.cost[key])
    if key == "wall_s_median" and text and result.cost["wall_s_min"] < result.cost["wall_s_max"]:
        text += f" ({result.cost['wall_s_min']:.3g} to {result.cost['wall_s_max']:.3g})"
    return text


def tables_html(facts: dict) -> str:
    return "".join(section(table["title"], (
        f'<p class="note">{html.escape(table["note"])}</p>' if table.get("note") else "") +
        table_of([unbroken(head) for head in table["headings"]],
                 [[unbroken(row[0]), *row[1:]] for row in table["rows"]]))
                   for table in facts["tables"])


def unbroken(text: str) -> Html:
    """No line ends inside a number."""
    return Html(NUMBER.sub(r'<span class="number">\1</span>', html.escape(text)))


def with_command(page: Shown, result: Result) -> str:
    """The run's name, which opens to the command that repeats it."""
    name = unbroken(result.label)
    if not result.command or len(page.results) > MOST_COMMANDS:
        return name
    return Html(f'<details class="repeat"><summary>{name}</summary>'
                f"<code>{html.escape(result.command)}</code></details>")


def runs_table(page: Shown, results: list[Result]) -> str:
    costs = with_values(results, [c for c in COSTS if c not in ("wall_s_min", "wall_s_max")],
                        "cost")
    errors = with_values(results, [error.name for error in page.study.errors], "errors")
    headings = ["run", "status", *(page.error(name) for name in errors),
                *(COST_WORDS[key] for key in costs)]
    rows = [[with_command(page, result), result.status,
             *(number(result.errors[name]) for name in errors),
             *(cost_text(result, key) for key in costs)] for result in results]
    off = {id(result) for result in surprises(results)}
    kinds = ["failed" if id(result) in off else "" for result in results]
    return table_of(headings, rows, kinds).replace("<table>", '<table class="sortable">')


def runs_html(page: Shown) -> str:
    parts = by_sweep(page.results)
    commands = ("results.csv has the command of each." if len(page.results) > MOST_COMMANDS else
                "Open a run for the command that repeats it.")
    note = f'<p class="note">Touch a heading to sort. {commands}</p>'
    if len(parts) == 1:
        return section("All runs", note + runs_table(page, page.results))
    return section("All runs", note + "".join(
        f"<details><summary>{html.escape(name)}, {len(own)} runs</summary>"
        f"{runs_table(page, own)}</details>" for name, own in parts.items()))


def ends_table(page: Shown, results: list[Result]) -> str:
    rows = [[with_command(page, result), end_words(result), Html(
        f"<code>{html.escape(result.key)}</code>" if result.key else ""), why(result)]
            for result in results]
    return table_of(["run", "ended", "key", "reason"], rows).replace("<table>",
                                                                     '<table class="outcomes">')


def ends_html(page: Shown) -> tuple[str, str]:
    """Runs that ended otherwise than the study says, and those that did not complete as it says."""
    off = surprises(page.results)
    meant = [result for result in page.results
             if result.status != "completed" and result.status == result.point.expected]
    note = ('<p class="note">A study that is to show how runs end names them under its key '
            "<code>expected</code>.</p>")
    return (section(f"Ended unexpectedly: {len(off)} of {len(page.results)} runs",
                    ends_table(page, off) + note) if off else "",
            section("Did not complete, as expected", ends_table(page, meant)) if meant else "")


def details_html(facts: dict) -> str:
    rows = [[each["name"], each["of"], each["how"], each["against"], each["relative_to"]]
            for each in facts["errors"]]
    parts = table_of(["error", "of", "how", "against", "relative to"], rows)
    if facts["reference"]:
        settings = ", ".join(f"{k} = {shown(v)}"
                             for k, v in facts["reference"]["settings"].items())
        parts += (f"<p>Reference run: {html.escape(facts['reference']['scene'])} with "
                  f"{html.escape(settings or 'its own values')}.</p>")
    parts += (f"<p>{html.escape(machine_text(facts))}. Bodies: "
              f"{'in one process' if facts['placement'] == 'local' else 'a process each'}.</p>")
    return section("How it was measured", parts)


def settings_of(page: Shown, result: Result) -> list[str]:
    if not result.point.knobs:
        return [f"{key} = {shown(value)}" for key, value in result.point.settings.items()]
    return [f"{name} = {shown(value)} {page.units.knobs.get(name, '')}".strip()
            for name, value in result.point.knobs.items()]


def runs_data(page: Shown) -> list[dict]:
    first = page.study.knobs[0] if page.study.knobs else ""
    names = [result.point.variant or (f"{words_of(first)} {shown(result.point.knobs[first])}"
                                      if first in result.point.knobs else "")
             for result in page.results]
    kinds = list(dict.fromkeys(names))
    return [{"label": result.label, "sweep": result.point.sweep, "group": name,
             "colour": colour(kinds.index(name)), "status": result.status,
             "settings": settings_of(page, result), "cost": result.cost, "errors": result.errors}
            for result, name in zip(page.results, names)]


def page_of(page: Shown, out: Path, template: Path, library: str, limit: int) -> str:
    study, facts = page.study, page.facts
    groups = [Curves(number, spec, page.results, out, page.units)
              for number, spec in enumerate(study.figures) if "histories" in spec]
    orders = convergence_data(page)
    status = ", ".join(f"{count} {word}" for word, count in facts["status"].items())
    some = any(result.status == "completed" for result in page.results)
    kind = "ok" if not facts["unexpected"] else "warned" if some else "failed"
    data = {"runs": runs_data(page), "errors": [error.name for error in study.errors],
            "units": page.units.errors, "costs": COST_WORDS, "convergence": orders,
            "histories": [each for group in groups for each in group.data(limit)]}
    about = "".join(f"<p>{html.escape(text)}</p>" for text in study.about.split("\n\n") if text)
    off, meant = ends_html(page)
    return filled(
        template, library, ("page.js",), title=html.escape(study.title), status=html.escape(status),
        kind=kind, about=about, off=off, claims=claims_html(facts), tables=tables_html(facts),
        trade=trade_html(page), convergence=convergence_html(orders),
        histories="".join(each.html() for each in groups), meant=meant,
        runs=runs_html(page), details=details_html(facts), data=script_json(data))
