#!/usr/bin/python3
"""A run's folder as one self-contained page: tables and figures against the closed form.

Reads summary.json, history.csv, closed_form.csv and events.jsonl; needs Python's standard library
and Debian's packaged Chart.js, which goes into the page. The page itself is report.html beside this
file. Ends with 2 when the user can help (no run in the folder), with 3 when the machine must (no
chart library, page cannot be written).
"""

import argparse
import html
import sys
from pathlib import Path

from abut_tools.page import (CHART_LIBRARY, canvas_of, filled, fitting_page, named, script_json,
                             section, table_of, write_whole)
from abut_tools.run_files import (SUMMARY, cut_short, is_there, read_events, read_json,
                                  read_table)
from abut_tools.tables import (COLOURS, Figure, Table, ToolError, colour_of, less, plus,
                               scaled_unit, shown, since_begin, sum_of, with_jumps)
from abut_tools.version import TellVersion

TEMPLATE = Path(__file__).resolve().with_suffix(".html")
CURVE_POINTS = 2000     # more than a screen has columns


# ---- reading ------------------------------------------------------------


class Run:
    """What a folder holds. A run that was killed has no summary."""

    def __init__(self, folder: Path):
        paths = {name: folder / name
                 for name in ("summary.json", "history.csv", "closed_form.csv", "events.jsonl")}
        there = {name for name, path in paths.items() if is_there(path)}
        if not there & {"summary.json", "history.csv"}:
            raise ToolError(
                f"{folder} holds no run: neither summary.json nor history.csv is there. "
                f"Make one with: abut run SCENE --out {folder}", 2)
        name = folder.resolve().name.encode("utf-8", "replace").decode()
        self.summary = {"status": "unfinished", "title": name,
                        "notes": ["there is no summary.json: the run was ended from outside"]}
        if "summary.json" in there:
            self.summary = read_json(paths["summary.json"], SUMMARY)
        self.history, self.exact, self.events = Table(["time"], []), None, []
        if "history.csv" in there:
            self.history = read_table(paths["history.csv"])
            words = cut_short(self.history, self.summary)
            if words:
                self.summary["notes"] = [*self.summary.get("notes", []), words]
        if "closed_form.csv" in there:
            self.exact = read_table(paths["closed_form.csv"])
        if "events.jsonl" in there:
            self.events = read_events(paths["events.jsonl"])

    def bodies(self) -> list[str]:
        return [match[1] for match in self.history.matching(r"(.+)\.kinetic")]

    def ports(self) -> list[str]:
        return [match[1] for match in self.history.matching(r"(.+\..+)\.u")]

    def port(self, name: str) -> dict:
        return self.summary.get("ports", {}).get(name, {})


# ---- figures ------------------------------------------------------------


def exact_force_label(run: Run, port: str) -> str:
    """The exact force is the same on both sides of an interface: one curve, of its first side."""
    interfaces = run.summary.get("interfaces", {})
    described = [name for name in interfaces if f"{name}.gap" in run.exact]
    for name in described:
        if interfaces[name].get("sides", [])[:1] == [port]:
            return "exact" if len(described) == 1 else f"{name}, exact"
    return ""


def port_figures(run: Run) -> list[Figure]:
    located = all("position" in run.port(name) for name in run.ports())
    place = "Position" if located else "Displacement"
    position = Figure("position", f"{place} of the contact points", place.lower(), "m")
    velocity = Figure("velocity", "Velocity of the contact points", "velocity", "m/s")
    force = Figure("force", "Contact force", "force, compression positive", "N")
    form = run.summary.get("closed_form", {})
    jumps = [form[key] for key in ("begin", "end") if form.get(key) is not None]
    for table, word in ((run.history, ""), (run.exact, ", exact")):
        if table is None:
            continue
        times, exact = table["time"], bool(word)
        for name in run.ports():
            if f"{name}.u" not in table:
                continue
            colour = colour_of(run.bodies(), run.port(name).get("body", name.split(".")[0]))
            offset = run.port(name).get("position", 0.0) if located else 0.0
            sign = -run.port(name).get("normal", 1.0)
            position.add(name + word, colour, times, plus(table[f"{name}.u"], offset), exact)
            steps = [(velocity, name + word, table[f"{name}.v"])]
            label = exact_force_label(run, name) if exact else name
            if label:
                steps.append((force, label, plus(table[f"{name}.force"], 0.0, sign)))
            for figure, label, values in steps:
                t, v = with_jumps(times, values, jumps) if exact else (times, values)
                figure.add(label, colour, t, v, exact)
    return [position, velocity, force]


def body_figures(run: Run) -> list[Figure]:
    mean = Figure("mean_velocity", "Mean velocity of the bodies", "mean velocity", "m/s")
    energies = []
    for body in run.bodies():
        energy = Figure(f"energy_{body}", f"Energy of {body}", "energy", "J")
        for table, word in ((run.history, ""), (run.exact, ", exact")):
            if table is None or f"{body}.kinetic" not in table:
                continue
            times, exact = table["time"], bool(word)
            if f"{body}.mean_velocity" in table:
                mean.add(body + word, colour_of(run.bodies(), body), times,
                         table[f"{body}.mean_velocity"], exact)
            for colour, kind in zip(COLOURS, ("kinetic", "stored", "total")):
                energy.add(kind + word, colour, times, table[f"{body}.{kind}"], exact)
        if any(y for curve in energy.curves for y in curve["y"]):  # a wall holds none
            energies.append(energy)
    return [mean] + energies


def own_energy(run: Run, body: str) -> list:
    """Kinetic, stored and what became heat, less what loads have put in."""
    held = [run.history[f"{body}.total"]]
    if f"{body}.dissipated" in run.history:
        held.append(run.history[f"{body}.dissipated"])
    return less(sum_of(held), run.history[f"{body}.external_work"])


def energy_error_figure(run: Run) -> Figure:
    """What the measures energy.*.relative_* are the largest and last values of, in per cent: only
    where there is something to compare with, relative to the run's own scales."""
    figure = Figure("energy_error", "Energy error", "error", "%")
    scales = run.summary.get("energy_scales", {})
    times = run.history["time"]
    for body, scale in scales.get("bodies", {}).items():
        exact = run.exact is not None and f"{body}.total" in run.exact
        error = (less(run.history[f"{body}.total"], run.exact[f"{body}.total"]) if exact
                 else since_begin(own_energy(run, body)))
        if scale and any(error):
            figure.add(body, colour_of(run.bodies(), body), times, plus(error, 0.0, 100.0 / scale))
    members = {member["name"] for body in run.summary.get("bodies", [])
               for member in body.get("members", [])}
    held = [own_energy(run, body) for body in run.bodies() if body not in members]
    held += [run.history[match[0]] for match in run.history.matching(r"(.+)\.whole")]
    if scales.get("total") and held:
        drift = since_begin(sum_of(held))
        figure.add("all bodies", COLOURS[2], times, plus(drift, 0.0, 100.0 / scales["total"]))
    return figure


def interface_figures(run: Run) -> list[Figure]:
    gap = Figure("gap", "Gap", "gap", "m")
    iterations = Figure("iterations", "Schwarz iterations per window", "iterations", "", True)
    names = [match[1] for match in run.history.matching(r"(.+)\.iterations")]
    for name in names:
        colour = colour_of(names, name)
        for table, word in ((run.history, ""), (run.exact, ", exact")):
            if table is not None and f"{name}.gap" in table:
                gap.add(name + word, colour, table["time"], table[f"{name}.gap"], bool(word))
        iterations.add(name, colour, run.history["time"], run.history[f"{name}.iterations"])
    return [gap, iterations]


def figures_of(run: Run) -> list[Figure]:
    figures = (port_figures(run) + body_figures(run) + [energy_error_figure(run)] +
               interface_figures(run))
    return [figure for figure in figures if figure.curves]


# ---- tables ------------------------------------------------------------


def expectations_table(run: Run) -> str:
    results = run.summary.get("expectations", [])
    rows = [[result["measure"], result["expected"].replace("+-", "±"), shown(result["got"]),
             "ok" if result["pass"] else "failed", result.get("because", "")] for result in results]
    kinds = ["ok" if result["pass"] else "failed" for result in results]
    return table_of(["measure", "expected", "got", "", "because"], rows, kinds) if rows else ""


def clean(value: float | None, scale: float | None) -> float | None:
    """Round-off around zero is shown as zero."""
    return 0.0 if value is not None and scale and abs(value) < 1e-12 * scale else value


def closed_form_table(run: Run) -> str:
    form, measures = run.summary.get("closed_form"), run.summary.get("measures", {})
    if not form:
        return ""
    contacts = form.get("interfaces", {form.get("interface"): form})
    compared = []
    for interface, exact in contacts.items():
        contact, lasts = f"contact.{interface}", exact.get("duration")
        if lasts is None:  # no contact, or none that ends
            continue
        of = f"{interface}: " if len(contacts) > 1 else ""
        word, unit, key, name = (("mean contact force", "N", "force", "force_mean")
                                 if "interface" in form else
                                 (f"{of}impulse", "N s", "impulse", "impulse"))
        last = (word, unit, exact.get(key), f"{contact}.{name}", exact.get(key))
        compared += [
            (f"{of}begin of contact", "s", exact.get("begin"), f"{contact}.begin", lasts),
            (f"{of}end of contact", "s", exact.get("end"), f"{contact}.end", lasts),
            (f"{of}duration of contact", "s", lasts, f"{contact}.duration", lasts), last]
    for body, exact in form.get("bodies", {}).items():
        if not exact["wall"]:
            compared.append((f"mean velocity of {body} at the end", "m/s",
                             exact.get("mean_velocity_end"), f"mean_velocity.{body}.end",
                             form.get("closing_speed")))
    rows = []
    for quantity, unit, exact, name, scale in compared:
        got = measures.get(name)
        exact, got = (clean(value, scale) for value in (exact, got))
        error = ("" if got is None or exact is None or not scale
                 else f"{100.0 * (got - exact) / scale:.3g} %")
        rows.append([f"{quantity} [{unit}]", shown(exact), shown(got), error])
    note = ("<p class='note'>Errors are relative: times to the exact duration of contact, "
            "velocities to the closing speed.</p>")
    return table_of(["quantity", "exact", "computed", "error"], rows) + note


def details(run: Run) -> str:
    summary = run.summary
    timing = summary.get("timing", {})
    rows = [["wall time [s]", shown(timing.get("wall_s"))]] if timing else []
    rows += [[f"computing in {body} [s]", shown(seconds)]
             for body, seconds in timing.get("compute_s", {}).items()]
    if "overhead_per_exchange_us_median" in timing:
        rows.append(["overhead per exchange, median [µs]",
                     shown(timing["overhead_per_exchange_us_median"])])
    for key in ("windows", "contact_windows", "exchanges", "state_hash"):
        if key in summary:
            rows.append([key.replace("_", " "), str(summary[key])])
    guess = summary.get("estimate", {})
    for key in ("windows", "contact_windows", "exchanges"):
        if key in guess and key in summary:
            told = guess[key] if isinstance(guess[key], list) else [guess[key]]
            told = " to ".join(str(count) for count in dict.fromkeys(told))
            rows.append([f"{key.replace('_', ' ')}: estimate, fact", f"{told}, {summary[key]}"])
    for key in ("in_use", "not_built"):
        if guess.get(key):
            rows.append([f"features {key.replace('_', ' ')}", ", ".join(guess[key])])
    rows += [[f"{body['name']}", body["model"]] for body in summary.get("bodies", [])]
    rows += [[f"version of {name}", text] for name, text in summary.get("versions", {}).items()]
    events = [[shown(event.get("time")), event.get("kind", ""), event.get("subject", ""),
               event.get("text", "")] for event in run.events[:200]]
    measures = [[name, shown(value)] for name, value in summary.get("measures", {}).items()]
    parts = [("The run", table_of(["", ""], rows) if rows else ""),
             ("Events", table_of(["time [s]", "event", "of", ""], events) if events else ""),
             ("All measures", table_of(["measure", "value"], measures) if measures else "")]
    return "".join(f"<details><summary>{title}</summary>{content}</details>"
                   for title, content in parts if content)


def given_up_table(run: Run) -> str:
    """What windows that the accurate method could not take have cost."""
    up = run.summary.get("accuracy", {}).get("given_up", {})
    if not up.get("passive_windows") and not up.get("repaid"):
        return ""
    windows = max(run.summary.get("windows", 0), 1)
    shares = [(windows - up["passive_windows"], "windows by the accurate method"),
              (up["passive_windows"], "windows passively"),
              (up.get("halved_windows", 0), "of these in shorter steps"),
              (up.get("rigid_windows", 0), "of these with bodies rigid for an instant")]
    rows = [[what, str(count), f"{100.0 * count / windows:.3g} %"] for count, what in shares]
    largest = up.get("largest_energy")
    for key, words in (("joules", "given up"), ("normal", "in normal contact"),
                       ("push_out", "paid back to part what was too near"),
                       ("damped", "by damping"),
                       ("changes_of_form", "where bodies changed their form"),
                       ("repaid", "gained in accurate windows and taken back"),
                       ("friction", "taken by friction, no loss of accuracy")):
        value = up.get(key)
        if value or key == "joules":
            part = f"{100.0 * value / largest:.3g} %" if value is not None and largest else ""
            rows.append([f"{words} [J]", shown(value), part])
    rows.append(["deepest behind a partner's surface [m]", shown(up.get("deepest")), ""])
    for key, words in (("lost_by_body", "lost in contact of {} [J]"),
                       ("taken_from_body", "taken from {} [J]"),
                       ("refused_by_body", "steps refused by {}")):
        rows += [[words.format(body), shown(value), ""] for body, value in up.get(key, {}).items()]
    words = html.escape(up.get("words", ""))
    return f"<p>{words}.</p>" + table_of(["", "", "share"], rows)


def overlaps_table(run: Run) -> str:
    rows = [[" and ".join(overlap["bodies"]), shown(overlap["depth"]),
             ", ".join(shown(x) for x in overlap.get("place", [])), shown(overlap["time"])]
            for overlap in run.summary.get("overlaps", [])]
    return table_of(["bodies", "depth [m]", "at [m]", "time [s]"], rows) if rows else ""


# ---- page ------------------------------------------------------------


def status_of(run: Run) -> tuple[str, str]:
    """Words for the badge and its kind."""
    status = run.summary.get("status", "unfinished")
    failed = sum(not result["pass"] for result in run.summary.get("expectations", []))
    if status != "completed":
        return status, "failed"
    if failed:
        return f"completed, {failed} expectation{'s' if failed > 1 else ''} failed", "failed"
    return "completed", "ok"


def reason_of(run: Run) -> str:
    """Why a run is no success: what ended it, or else what it missed."""
    if status_of(run)[1] == "ok":
        return ""
    failures = [event for event in run.events if event.get("kind") == "failure"]
    lines = [f"{shown(event.get('time'))} s: {event.get('text', '')}" for event in failures[-1:]]
    if run.summary.get("status") != "completed":
        lines += [note for note in run.summary.get("notes", []) if "finite" in note or not lines]
    lines += [f"{result['measure']} is {shown(result['got'])}, expected {result['expected']}"
              for result in run.summary.get("expectations", [])
              if not result["pass"] and run.summary.get("status") == "completed"]
    return "".join(f'<p class="reason">{html.escape(line)}</p>' for line in lines)


def page_of(run: Run, library: str, limit: int) -> str:
    figures = figures_of(run)
    times = [abs(t) for t in run.history["time"] if t is not None]
    time_scale = scaled_unit(max(times, default=0.0), "s")
    title = run.summary.get("title") or "Run"
    status, kind = status_of(run)
    notes = "".join(f"<li>{html.escape(note)}</li>" for note in run.summary.get("notes", []))
    plots = "".join(canvas_of(figure) for figure in figures)
    dashes = ('<p class="note">Solid: computed. Dashed: closed form. Touch a curve for values; '
              "touch a name to hide its curve.</p>")
    return filled(
        TEMPLATE, library,
        title=html.escape(title), status=html.escape(status), kind=kind,
        summary=section("Why this is no success", reason_of(run)) +
        section("Bodies that are in each other", overlaps_table(run)) +
        section("Accuracy given up", given_up_table(run)) +
        section("Expectations", expectations_table(run)) +
        section("Against the closed form", closed_form_table(run)),
        figures=section("Figures", dashes + f'<div class="figures">{plots}</div>') if plots else "",
        details=details(run), notes=section("Notes", f"<ul>{notes}</ul>") if notes else "",
        data=script_json([figure.data(limit, time_scale) for figure in figures]))


def make_page(folder: Path, library_path: Path) -> str:
    run = Run(folder)
    return fitting_page(lambda library, limit: page_of(run, library, limit), library_path,
                        CURVE_POINTS)


def main() -> int:
    parser = argparse.ArgumentParser(prog="abut report", description="Makes a page of a run.")
    parser.add_argument("directory", type=named, metavar="DIR", help="the run's folder")
    parser.add_argument("--out", type=named, metavar="FILE", help="default: DIR/report.html")
    parser.add_argument("--chart-library", type=Path, metavar="FILE", default=CHART_LIBRARY,
                        help="Chart.js 3 (default: that of Debian's package libjs-chart.js)")
    parser.add_argument("--version", action=TellVersion)
    options = parser.parse_args()
    sys.stdout.reconfigure(errors="backslashreplace")  # names of files may be no text
    out = options.out or options.directory / "report.html"
    try:
        page = make_page(options.directory, options.chart_library)
        write_whole(out, page)
    except ToolError as error:
        print(f"abut report: {error}", file=sys.stderr)
        return error.code
    except OSError as error:
        print(f"abut report: {error.filename}: {error.strerror}. Check that it can be read and "
              "written.", file=sys.stderr)
        return 3
    print(out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
