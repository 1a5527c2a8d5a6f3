"""What a page says of a run in words and tables, the most important first."""

import html
import math
import re

from abut_tools.page import table_of
from abut_tools.run_folder import Run
from abut_tools.tables import few, measured, scaled_unit, shown
from abut_tools.units import measure_unit

MOST_ROWS = 24       # of bodies and of contacts that are told one by one
MOST_WARNINGS = 20
ROUND_OFF = 1e-11    # of the energy


# ---- what happened -------------------------------------------------------


def contact_names(run: Run) -> list[str]:
    return [name for name in run.interfaces() if f"contact.{name}.force_peak" in run.measures()]


def table_without_gaps(headings: list[str], rows: list[list[str]]) -> str:
    """Columns in which nothing is told are left out."""
    kept = [k for k in range(len(headings)) if any(row[k] for row in rows)]
    return table_of([headings[k] for k in kept], [[row[k] for k in kept] for row in rows])


def units_table(run: Run, headings: list[str], rows: list[list[str]]) -> str:
    """Headings name units of SI; shown are the scene's."""
    return table_of([run.units.text(text) for text in headings], rows)


def moment_words(run: Run, value: float | None) -> str:
    """A time; round-off of the run's length is zero."""
    times = [abs(t) for t in run.history["time"] if t is not None]
    if value is not None and abs(value) < 1e-9 * max(times, default=0.0):
        value = 0.0
    span = run.summary.get("time", {})
    length = (span.get("end") or 0.0) - (span.get("begin") or 0.0)
    if value and 0.0 < length < abs(value):  # in a stage that begins late
        factor, unit = scaled_unit(abs(value), run.units.word("s"))
        digits = 4 + min(10, math.ceil(math.log10(abs(value) / length)))
        return f"{value * factor:.{digits}g} {unit}"
    return run.told(value, "s")


def joints_table(run: Run) -> str:
    names = contact_names(run)
    rows = []
    for name in names[:MOST_ROWS]:
        def of(what, unit, name=name):
            value = run.measure(f"contact.{name}.{what}")
            if unit == "s":
                return moment_words(run, value)
            return run.told(value, unit) if value else ""
        sides = " and ".join(run.interfaces()[name].get("sides", []))
        if run.is_tie(name):
            rows.append([name, sides, "tied", "", "", "", of("force_peak", "N"), "", ""])
            continue
        count = run.measure(f"contact.{name}.count")
        touched = run.measure(f"contact.{name}.begin") is not None
        rows.append([name, sides, of("begin", "s") if touched else "never", of("end", "s"),
                     of("duration", "s"), f"{count:.0f}" if count and count != 1 else "",
                     of("force_peak", "N"), of("impulse", "N s"), of("dissipated", "J")])
    if not rows:
        return ""
    more = len(names) - len(rows)
    note = f'<p class="note">and {more} more, in All measures</p>' if more > 0 else ""
    return table_without_gaps(["joint", "of", "touch", "parting", "duration", "contacts",
                               "peak force", "impulse", "heat of friction"], rows) + note


def speed(run: Run, body: str, at: int, scale: float) -> str:
    """In one dimension with its sign."""
    if f"{body}.mean_velocity" in run.history:
        return run.told(clean(run.history[f"{body}.mean_velocity"][at], scale), "m/s")
    parts = [column[at] for _, column in run.vector(f"{body}.mean_velocity")]
    return run.told(clean(math.hypot(*parts), scale), "m/s") if parts and None not in parts else ""


def bodies_table(run: Run) -> str:
    if not run.history["time"]:
        return ""
    rows, scale = [], run.speed_scale()
    for body in run.bodies():
        kinds = [run.history[f"{body}.{kind}"] for kind in ("kinetic", "stored")
                 if f"{body}.{kind}" in run.history]
        if len(kinds) < 2 or not any(v for column in kinds for v in column):
            continue  # a wall
        kinetic, stored = kinds
        most = max((v for column in kinds for v in column if v is not None), default=0.0)
        energies = (kinetic[0], kinetic[-1], max(filter(None, stored), default=0.0))
        rows.append([body, speed(run, body, 0, scale), speed(run, body, -1, scale)] +
                    [run.told(clean(value, most), "J") for value in energies])
    if not rows or len(rows) > MOST_ROWS:
        return ""
    flat = any(f"{body}.mean_velocity" in run.history for body in run.bodies())
    word = "mean velocity" if flat else "speed of its centre"
    return table_of(["body", f"{word}, begin", f"{word}, end", "kinetic energy, begin",
                     "kinetic energy, end", "most energy stored"], rows)


def swaps_table(run: Run) -> str:
    """Bodies that went on as another model or on another mesh."""
    rows = []
    for swap in run.summary.get("swaps", []):
        mass, kinetic, stored = swap["mass"], swap["kinetic"], swap["stored"]
        most = kinetic["before"] + stored["before"]
        size = math.sqrt(2.0 * mass["before"] * most) or 1.0
        change = math.dist(swap["momentum"]["before"], swap["momentum"]["after"]) / size
        energies = (kinetic["before"], kinetic["after"], stored["before"], stored["after"],
                    swap["given_up"])
        models = [", ".join(swap[at].split(", ")[:2]) for at in ("from", "to")]
        rows.append([moment_words(run, swap["time"]), swap["body"], *models,
                     "kept" if change < ROUND_OFF else f"changed by {100.0 * change:.2g} %"] +
                    [run.told(clean(value, most), "J") for value in energies])
    if not rows:
        return ""
    more = len(rows) - MOST_ROWS
    note = f'<p class="note">and {more} more, in summary.json</p>' if more > 0 else ""
    return table_of(["at", "body", "was", "is", "momentum", "kinetic energy before", "after",
                     "stored before", "after", "given up"], rows[:MOST_ROWS]) + note


def energy_error(run: Run) -> float | None:
    """What no account has, relative to the run's own scale: passive windows tell what they took
    beside the bodies' accounts."""
    drift = run.measure("energy.total.relative_drift_end")
    scale = run.summary.get("energy_scales", {}).get("total")
    up = run.summary.get("accuracy", {}).get("given_up", {})
    taken = [up.get("friction"), up.get("joules")]
    if drift is None or not scale or not up.get("passive_windows") or None in taken:
        return drift
    there = sum(column[0] for column in energies_of(run, "total") + energies_of(run, "dissipated"))
    done = sum(column[-1] - column[0] for column in energies_of(run, "external_work"))
    return (drift * scale + sum(taken)) / max(scale, there + max(0.0, done))


def energies_of(run: Run, kind: str) -> list:
    """Columns of bodies, of those that are written."""
    names = [f"{body}.{kind}" for body in run.bodies()]
    return [run.history[name] for name in names if name in run.history and run.history[name]]


def course(run: Run) -> str:
    """The run in one sentence."""
    summary, told = run.summary, []
    time = summary.get("time", {})
    begin, reached = time.get("begin"), time.get("reached")
    first = next((t for t in run.history["time"] if t is not None), None)
    if begin is not None and first is not None:  # of the first stage, where there are several
        begin = min(begin, first)
    if begin is not None and reached is not None:
        told.append(f"From {moment_words(run, begin)} to {moment_words(run, reached)}")
    if "windows" in summary:
        contact = summary.get("contact_windows")
        told.append(f"{summary['windows']} windows" +
                    (f", {contact} of them in contact" if contact else ""))
    wall = summary.get("timing", {}).get("wall_s")
    if wall is not None:
        told.append(f"computed in {measured(wall, 's')}")
    error = energy_error(run)
    if error is not None:
        told.append("error of the total energy " +
                    (f"{100.0 * error:.2g} %" if abs(error) > ROUND_OFF else "round-off alone"))
    return f"<p>{html.escape('; '.join(told))}.</p>" if told else ""


def what_happened(run: Run) -> str:
    return course(run) + joints_table(run) + swaps_table(run) + bodies_table(run)


# ---- warnings -----------------------------------------------------------


def sorted_notes(run: Run) -> tuple[list[str], list[str]]:
    """Notes that warn, and those that only say why a measure has no value."""
    warn, plain = [], []
    for note in run.summary.get("notes", []):
        (plain if note.split(": ")[0] in run.measures() else warn).append(note)
    return warn, plain


def warnings_of(run: Run) -> list[str]:
    lines = {}
    for event in run.events:
        if event.get("kind") == "warning" and event.get("text"):
            when = moment_words(run, event.get("time"))
            lines.setdefault(event["text"], f"{when}: {event['text']}" if when else event["text"])
    told = [f"{name} never closed, though its sides went past each other"
            for name in run.summary.get("never_closed", [])]
    told += [note for note in sorted_notes(run)[0]
             if note not in lines and note not in reasons_of(run)]
    return [*lines.values(), *told]


def warnings_list(run: Run) -> str:
    """Those that differ in numbers alone are told once."""
    kinds = {}
    for line in warnings_of(run):
        kinds.setdefault(re.sub(r"\d[\d.e+-]*", "#", line), []).append(line)
    items = [each[0] + (f" ({len(each) - 1} more of this kind, under Events)" if len(each) > 1
                        else "") for each in kinds.values()]
    text = "".join(f"<li>{html.escape(line)}</li>" for line in items[:MOST_WARNINGS])
    if len(items) > MOST_WARNINGS:
        text += f"<li>and {len(items) - MOST_WARNINGS} more, under Events</li>"
    return f'<ul class="warnings">{text}</ul>' if text else ""


def overlaps_table(run: Run) -> str:
    rows = [[" and ".join(overlap["bodies"]), shown(overlap["depth"]),
             ", ".join(shown(x) for x in overlap.get("place", [])), shown(overlap["time"])]
            for overlap in run.summary.get("overlaps", [])]
    heads = ["bodies", "depth [m]", "at [m]", "time [s]"]
    return units_table(run, heads, rows) if rows else ""


def given_up_table(run: Run) -> str:
    """What windows that the accurate method could not take have cost."""
    up = run.summary.get("accuracy", {}).get("given_up", {})
    if not any(up.get(key) for key in ("passive_windows", "near_windows", "repaid")):
        return ""
    windows = max(run.summary.get("windows", 0), 1)
    shares = [(windows - up["passive_windows"], "windows by the accurate method"),
              (up["passive_windows"], "windows passively"),
              (up.get("halved_windows", 0), "of these in shorter steps"),
              (up.get("rigid_windows", 0), "of these with bodies rigid for an instant"),
              (up.get("near_windows", 0), "windows that have nearly converged")]
    rows = [[what, str(count), f"{100.0 * count / windows:.3g} %"] for count, what in shares]
    largest = up.get("largest_energy")
    for key, words in (("joules", "given up"), ("normal", "in normal contact"),
                       ("push_out", "paid back to part what was too near"),
                       ("owed", "given back as what touches at the end parts"),
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
    rows = [[run.units.text(row[0]), *row[1:]] for row in rows]
    return f"<p>{words}.</p>" + table_of(["", "", "share"], rows)


# ---- against what was expected --------------------------------------------


def with_word(run: Run, measure: str, value: float | None) -> str:
    """A measure with its unit in the scene's words."""
    unit = run.units.word(measure_unit(measure))
    return shown(value) if value is None else f"{shown(value)} {unit}".strip()


def expectations_table(run: Run) -> str:
    results = run.summary.get("expectations", [])
    rows = [[result["measure"], result["expected"].replace("+-", "±"),
             with_word(run, result["measure"], result["got"]),
             "ok" if result["pass"] else "failed", result.get("because", "")]
            for result in results]
    kinds = ["ok" if result["pass"] else "failed" for result in results]
    headings = ["measure", "expected", "got", "", "because"]
    return table_of(headings, rows, kinds) if rows else ""


def clean(value: float | None, scale: float | None) -> float | None:
    """Round-off around zero is shown as zero."""
    return 0.0 if value is not None and scale and abs(value) < 1e-9 * scale else value


def closed_form_table(run: Run) -> str:
    form, measures = run.summary.get("closed_form"), run.measures()
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
        rows.append([f"{quantity} [{run.units.word(unit)}]", shown(exact), shown(got), error])
    note = ("<p class='note'>Errors are relative: times to the exact duration of contact, "
            "velocities to the closing speed.</p>")
    return table_of(["quantity", "exact", "computed", "error"], rows) + note


# ---- the rest ------------------------------------------------------------


def run_rows(run: Run) -> list[list[str]]:
    summary = run.summary
    timing = summary.get("timing", {})
    rows = [["wall time [s]", shown_few(timing.get("wall_s"))]] if timing else []
    rows += [[f"computing in {body} [s]", shown_few(seconds)]
             for body, seconds in timing.get("compute_s", {}).items()]
    if "overhead_per_exchange_us_median" in timing:
        rows.append(["overhead per exchange, median [µs]",
                     shown_few(timing["overhead_per_exchange_us_median"])])
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
    return rows + [[f"version of {name}", text]
                   for name, text in summary.get("versions", {}).items()]


def shown_few(value: float | None) -> str:
    return few(value) if value is not None else "no value"


def details(run: Run) -> str:
    rows = run_rows(run)
    events = [[shown_few(event.get("time")), event.get("kind", "").replace("_", " "),
               event.get("subject", ""), event.get("text", "")] for event in run.events[:200]]
    measures = [[name, shown(value), run.units.word(measure_unit(name))]
                for name, value in run.measures().items()]
    notes = "".join(f"<li>{html.escape(note)}</li>" for note in sorted_notes(run)[1])
    heads = ["time [s]", "event", "of", ""]
    parts = [("The run", table_of(["", ""], rows) if rows else ""),
             ("Events", units_table(run, heads, events) if events else ""),
             ("Measures without a value", f"<ul>{notes}</ul>" if notes else ""),
             ("All measures", table_of(["measure", "value", "unit"], measures) if measures else "")]
    return "".join(f"<details><summary>{title}</summary>{content}</details>"
                   for title, content in parts if content)


# ---- status -------------------------------------------------------------


def status_of(run: Run) -> tuple[str, str]:
    """Words for the badge and its kind."""
    status = run.summary.get("status", "unfinished")
    failed = sum(not result["pass"] for result in run.summary.get("expectations", []))
    if status != "completed":
        return status, "failed"
    if failed:
        return f"completed, {failed} expectation{'s' if failed > 1 else ''} failed", "failed"
    warnings = len(warnings_of(run)) + len(run.summary.get("overlaps", []))
    passive = run.summary.get("accuracy", {}).get("given_up", {}).get("passive_windows")
    if warnings or passive:
        words = f"{warnings} warning{'s' if warnings > 1 else ''}" if warnings else "partly passive"
        return f"completed, {words}", "warned"
    return "completed", "ok"


def reasons_of(run: Run) -> list[str]:
    """Why a run is no success: what ended it, or else what it missed."""
    missed = [result for result in run.summary.get("expectations", []) if not result["pass"]]
    if run.summary.get("status", "unfinished") == "completed" and not missed:
        return []
    failures = [event for event in run.events if event.get("kind") == "failure"]
    second = run.units.word("s")
    lines = [f"{shown_few(event.get('time'))} {second}: {event.get('text', '')}"
             for event in failures[-1:]]
    reason = run.summary.get("reason", "")
    if reason and not any(reason in line for line in lines):
        lines.append(reason)
    if run.summary.get("status") != "completed":
        lines += [note for note in run.summary.get("notes", []) if "finite" in note or not lines]
    if run.summary.get("status") == "completed":
        lines += [f"{result['measure']} is {with_word(run, result['measure'], result['got'])}, "
                  f"expected {result['expected']}" for result in missed]
    return lines


def reason_of(run: Run) -> str:
    return "".join(f'<p class="reason">{html.escape(line)}</p>' for line in reasons_of(run))
