"""What a study found: costs and errors of its runs, the front, orders, claims, the cheapest run."""

import math
import re
import statistics

from abut_tools.study_file import Point, Study
from abut_tools.study_take import matches
from abut_tools.study_units import StudyUnits

CLEARLY = 0.01
# Between the place and what is wrong: bodies.left.integrator.newmark.step
KEY = re.compile(r": ([a-z_]\w*(?:\.[\w<>*-]+|\[\d+\])*): ")


def costs_of(record: dict, timed: bool) -> dict:
    """A time that other runs disturbed is no time: it is left out."""
    summary, walls = record["summary"], record["walls"] if timed and record["timed"] else []
    measures = summary.get("measures", {})
    return {"wall_s_median": statistics.median(walls) if walls else None,
            "wall_s_min": min(walls, default=None), "wall_s_max": max(walls, default=None),
            "compute_s": record["compute_s"], "exchanges": summary.get("exchanges"),
            "iterations_mean": measures.get("schwarz.iterations_mean"),
            "memory_mib": record["memory_mib"] and round(record["memory_mib"], 2)}


def reason_of(message: str) -> str:
    """The first of a run's complaints."""
    return message.split("\n", 1)[0]


def key_of(message: str) -> str:
    """The key of the scene that the first complaint names; empty where it names none."""
    found = KEY.search(reason_of(message))
    return found[1] if found else ""


class Result:
    """A run of the study with its numbers by name."""

    def __init__(self, point: Point, record: dict, timed: bool):
        self.point, self.record = point, record
        self.label, self.status = point.label, record["status"]
        self.reason, self.key = reason_of(record["message"]), key_of(record["message"])
        self.command = ""  # that repeats it
        self.cost = costs_of(record, timed)
        self.errors = {}

    def number(self, name: str) -> float | None:
        """Errors of the study, costs, knobs, closed_form.x, then the run's measures."""
        if name in self.errors:
            return self.errors[name]
        if name in self.cost:
            return self.cost[name]
        if name in self.point.knobs and isinstance(self.point.knobs[name], (int, float)):
            return self.point.knobs[name]
        summary = self.record["summary"]
        if name.startswith("closed_form."):
            return summary.get("closed_form", {}).get(name.removeprefix("closed_form."))
        return summary.get("measures", {}).get(name)

    def row(self, study: Study) -> dict:
        row = {"label": self.label, "status": self.status, "expected": self.point.expected,
               "reason": self.reason, "key": self.key, "message": self.record["message"],
               "sweep": self.point.sweep, "variant": self.point.variant,
               "scene": self.point.scene.name, "knobs": self.point.knobs,
               "settings": self.point.settings, "cost": self.cost, "errors": self.errors,
               "folder": self.record["folder"], "command": self.command}
        return {key: value for key, value in row.items()
                if key not in ("sweep", "variant", "reason", "key") or value}


def results_of(study: Study, records: list[dict], reference: dict | None,
               timed: bool) -> list[Result]:
    found = [Result(point, record, timed) for point, record in zip(study.points, records)]
    fine = Result(study.reference, reference, timed) if reference else None
    for result in found:
        for error in study.errors:
            value = None
            if result.status == "completed" and error.measure is not None:
                value = error.measure.value(result.number)
                base = error.measure.value(fine.number) if error.against == "reference" else 0.0
                value = None if value is None or base is None else value - base - error.minus
                if value is not None:
                    value = value / (error.relative_to or 1.0)
                    value = abs(value) if error.absolute else value
            elif result.status == "completed":
                value = result.record["history_errors"].get(error.name)
            result.errors[error.name] = value
    return found


def cost_key(results: list[Result]) -> str:
    """What a run is judged by: its time where runs were timed, else the bodies' computing."""
    timed = any(result.cost["wall_s_median"] is not None for result in results)
    return "wall_s_median" if timed else "compute_s"


def front(results: list[Result], error: str, cost: str) -> list[Result]:
    """Those that no other beats in both, cheapest first; paying more must better the error by more
    than CLEARLY, else round-off alone would put runs on the front."""
    able = [result for result in results
            if result.cost[cost] is not None and result.errors[error] is not None]
    able.sort(key=lambda result: (result.cost[cost], abs(result.errors[error])))
    kept, best = [], math.inf
    for result in able:
        if abs(result.errors[error]) < (1.0 - CLEARLY) * best:
            best = abs(result.errors[error])
            kept.append(result)
    return kept


def by_sweep(results: list[Result]) -> dict[str, list[Result]]:
    found = {}
    for result in results:
        found.setdefault(result.point.sweep, []).append(result)
    return found


def fronts_of(study: Study, results: list[Result], cost: str) -> list[dict]:
    """Runs of one sweep are compared with each other only: they differ in their knobs alone."""
    found = [{"sweep": sweep, "error": error.name,
              "runs": [result.label for result in front(own, error.name, cost)]}
             for sweep, own in by_sweep(results).items() for error in study.errors]
    return [each for each in found if each["runs"]]


def slope(pairs: list[tuple[float, float]]) -> float:
    """Least squares in logarithms."""
    logs = [(math.log(x), math.log(y)) for x, y in pairs]
    mean_x, mean_y = (statistics.fmean(each) for each in zip(*logs))
    return (sum((x - mean_x) * (y - mean_y) for x, y in logs)
            / sum((x - mean_x) ** 2 for x, _ in logs))


def series_of(results: list[Result], figure: dict) -> list[dict]:
    """Error against a knob, one series for every combination of all the rest, with its order.

    A count (elements) goes up as the error goes down; its order is that of its inverse.
    """
    error, knob, groups = figure["convergence"], figure["knob"], {}
    for result in results:
        x, y = result.point.knobs.get(knob), result.errors[error]
        if not matches(result.label, figure.get("runs", "*")) or not isinstance(x, (int, float)):
            continue
        others = {k: v for k, v in result.point.knobs.items() if k != knob}
        words = [result.point.variant] if result.point.variant else []
        words += [f"{k} {v}" for k, v in others.items()]
        label = ", ".join(words) or error.replace("_", " ")
        group = groups.setdefault((result.point.sweep, label), {"label": label, "pairs": []})
        if y is not None and y > 0.0 and x > 0:
            group["pairs"].append((x, y))
    found = []
    for group in groups.values():
        pairs = sorted(group["pairs"])
        if len({x for x, _ in pairs}) < 2:
            continue
        sign = -1.0 if all(isinstance(x, int) for x, _ in pairs) else 1.0
        steps = [sign * slope([one, other]) for one, other in zip(pairs, pairs[1:])
                 if one[0] != other[0]]
        found.append({"label": group["label"], "error": error, "knob": knob,
                      "x": [x for x, _ in pairs], "y": [y for _, y in pairs],
                      "order": sign * slope(pairs), "steps": steps})
    return found


# ---- claims ------------------------------------------------------------


def check_of(check: dict, results: list[Result], unit: str = "") -> dict:
    """The measured values of a check's runs, each with whether it stands."""
    def shown_as(value: float | None) -> str:
        if value is None:
            return "no value"
        if check.get("percent"):
            return f"{100.0 * value:.3g} %"
        return f"{value:.4g} {unit}".strip()

    own = [result for result in results if matches(result.label, check.get("runs", "*"))]
    values = [(result.label, check["value"].value(result.number)) for result in own
              if result.status == "completed"]

    def others(word: str) -> list[float]:
        found = (check["value"].value(result.number) for result in results
                 if result.status == "completed" and matches(result.label, check[word]))
        return [value for value in found if value is not None]

    bounds = []
    if "at_most" in check:
        bounds.append((f"at most {shown_as(check['at_most'])}",
                       lambda value: value <= check["at_most"]))
    if "at_least" in check:
        bounds.append((f"at least {shown_as(check['at_least'])}",
                       lambda value: value >= check["at_least"]))
    for word, edge, test in (("below", min, float.__lt__), ("above", max, float.__gt__)):
        if word in check and others(word):
            bound = edge(others(word))
            names = check[word] if isinstance(check[word], str) else ", ".join(check[word])
            bounds.append((f"{word} {names} ({shown_as(bound)})",
                           lambda value, bound=bound, test=test: test(float(value), float(bound))))
    measured = [{"run": label, "value": value, "shown": shown_as(value),
                 "holds": None if value is None or not bounds
                 else all(test(value) for _, test in bounds)}
                for label, value in values]
    return {"value": check["value"].text, "expected": ", ".join(text for text, _ in bounds),
            "measured": measured}


def claims_of(study: Study, results: list[Result], units: StudyUnits) -> list[dict]:
    found = []
    for claim in study.claims:
        checks = [check_of(check, results, units.of(check["value"])) for check in claim["checks"]]
        holds = [each["holds"] for check in checks for each in check["measured"]
                 if each["holds"] is not None]
        empty = any(not check["measured"] for check in checks)
        verdict = ("not measured" if not holds else
                   "holds in part" if empty and any(holds) or any(holds) and not all(holds) else
                   "holds" if all(holds) else "does not hold")
        found.append({"text": claim["text"], "verdict": verdict, "checks": checks,
                      "note": claim.get("note", "")})
    return found


# ---- target ------------------------------------------------------------


def cheapest(results: list[Result], targets: dict[str, float]) -> Result | None:
    cost = cost_key(results)
    able = [result for result in results if result.cost[cost] is not None and all(
        result.errors[name] is not None and abs(result.errors[name]) <= value
        for name, value in targets.items())]
    return min(able, key=lambda result: result.cost[cost], default=None)


def nearest_miss(results: list[Result], targets: dict[str, float]) -> Result | None:
    """The run whose worst error, relative to its target, is smallest."""
    able = [result for result in results
            if all(result.errors[name] is not None for name in targets)]
    return min(able, default=None, key=lambda result: max(
        abs(result.errors[name]) / value for name, value in targets.items()))
