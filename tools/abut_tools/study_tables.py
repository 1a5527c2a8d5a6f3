"""Tables of a study: a row per run, or a value spread over the values of a knob."""

from abut_tools.study_file import Study
from abut_tools.study_results import Result
from abut_tools.study_take import matches
from abut_tools.study_units import StudyUnits
from abut_tools.tables import shown
from abut_tools.units import with_unit


def cells(result: Result, columns: dict) -> list[str]:
    """What is asked of a run; a run that did not complete says so in place of its first value."""
    if result.status != "completed":
        return [result.status, *("" for _ in list(columns)[1:])]
    values = [expression.value(result.number) for expression in columns.values()]
    return ["" if value is None else f"{value:.3g}" for value in values]


def row_name(result: Result, knob: str) -> str:
    """All that tells the run from others but the knob."""
    words = [result.point.variant] if result.point.variant else []
    words += [f"{name} {shown(value)}" for name, value in result.point.knobs.items()
              if name != knob]
    return ", ".join(words) or "base"


def spread(title: str, chosen: list[Result], columns: dict, knob: str,
           units: StudyUnits) -> dict:
    """A column per value of the knob; several values in a cell stand behind each other."""
    heads, rows = [], {}
    for result in chosen:
        head = shown(result.point.knobs[knob])
        heads += [head] if head not in heads else []
        text = " / ".join(cell for cell in cells(result, columns) if cell)
        rows.setdefault(row_name(result, knob), {})[head] = text
    head = with_unit(knob.replace("_", " "), units.of_name(knob))
    return {"title": title, "note": " / ".join(headings_of(columns, units)),
            "headings": [head, *heads],
            "rows": [[name, *(found.get(head, "") for head in heads)]
                     for name, found in rows.items()]}


def headings_of(columns: dict, units: StudyUnits) -> list[str]:
    return [with_unit(name, units.of(expression)) for name, expression in columns.items()]


def tables_of(study: Study, results: list[Result], units: StudyUnits) -> list[dict]:
    """Title, headings and rows of texts; a column without any value is left out."""
    found = []
    for figure in study.figures:
        if "table" not in figure:
            continue
        columns, knob = figure["table"], figure.get("knob")
        chosen = [result for result in results if matches(result.label, figure.get("runs", "*"))
                  and (knob is None or knob in result.point.knobs)]
        title = figure.get("title", ", ".join(columns))
        if knob is not None:
            found.append(spread(title, chosen, columns, knob, units))
            continue
        rows = [cells(result, columns) for result in chosen]
        kept = [k for k in range(len(columns)) if any(row[k] for row in rows)]
        names = headings_of(columns, units)
        found.append({"title": title, "headings": ["run", *(names[k] for k in kept)],
                      "rows": [[result.label, *(row[k] for k in kept)]
                               for result, row in zip(chosen, rows)]})
    return found
