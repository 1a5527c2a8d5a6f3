"""A study file: what to vary, what to measure, what to show. Every key is known or refused."""

import itertools
import math
from collections import Counter
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path

from abut_tools import study_knobs
from abut_tools.expressions import Expression
from abut_tools.scene_keys import KeyList, nearest
from abut_tools.tables import ToolError
from abut_tools.yaml_text import read_yaml

QUANTITIES = ("position", "velocity", "force", "mean_velocity", "kinetic", "stored", "total",
              "kinetic_error", "stored_error", "total_error")
COSTS = ("wall_s_median", "wall_s_min", "wall_s_max", "compute_s", "exchanges",
         "iterations_mean", "memory_mib")
LARGEST = 1e300  # numbers with room for sums and ratios
MOST_RUNS, MOST_REPEATS = 20_000, 1000
KEYS = {
    "": ("title", "about", "base", "set", "knobs", "variants", "sweeps", "errors", "reference",
         "repeats", "placement", "time_limit", "expected", "figures", "claims", "quick"),
    "expected": ("refused", "failed"),
    "variant": ("label", "scene", "set"),
    "sweep": ("title", "variants", "set", "knobs", "repeats"),
    "error": ("measure", "history", "norm", "abs", "minus", "relative_to", "against", "unit"),
    "reference": ("scene", "set"),
    "histories": ("histories", "of", "runs", "title"),
    "convergence": ("convergence", "knob", "runs", "title"),
    "table": ("table", "knob", "runs", "title"),
    "claim": ("text", "checks", "note"),
    "check": ("runs", "value", "at_most", "at_least", "below", "above", "percent"),
    "quick": ("set", "keep", "runs"),
}


@dataclass
class Error:
    name: str
    measure: Expression | None = None
    history: list[str] = field(default_factory=list)
    norm: str = "rms"
    absolute: bool = True
    minus: float = 0.0
    relative_to: float | None = None
    against: str = ""
    unit: str | None = None  # as the study says; None: that of the measure


@dataclass
class Point:
    """One setting: what to run, and where it stands in the study."""
    label: str
    sweep: str
    variant: str
    scene: Path
    knobs: dict
    settings: dict
    kind: str = "run"
    repeats: int = 1  # timed runs with --serial
    expected: str = "completed"  # how it is to end


@dataclass
class Study:
    path: Path
    title: str
    about: str
    points: list[Point]
    errors: list[Error]
    knobs: list[str]
    repeats: int
    placement: str
    time_limit: float
    figures: list[dict]
    claims: list[dict]
    knob_units: dict[str, str]  # as the study says, or in SI
    reference: Point | None = None


class Reader:
    """Reads with the file and the key at hand for every complaint."""

    def __init__(self, path: Path, keys: KeyList):
        self.path, self.keys, self.scenes = path, keys, {}
        self.known, self.asked = {}, set()
        self.knob_units = {}

    def refuse(self, key: str, what: str):
        raise ToolError(f"{self.path}: {key}: {what}" if key else f"{self.path}: {what}", 2)

    def a_map(self, value: object, key: str, kind: str | None = None) -> dict:
        if not isinstance(value, dict):
            self.refuse(key, "must be a map of keys.")
        if kind is not None:
            for name in value:
                if name not in KEYS[kind]:
                    self.refuse(f"{key}.{name}".lstrip("."), "is not a known key."
                                f"{nearest(str(name), list(KEYS[kind]))} "
                                f"Allowed here: {', '.join(KEYS[kind])}.")
        return value

    def a_list(self, value: object, key: str) -> list:
        return value if isinstance(value, list) else self.refuse(key, "must be a list.")

    def a_text(self, value: object, key: str) -> str:
        if not isinstance(value, str) or not value.strip():
            self.refuse(key, "must be a text.")
        return value

    def a_number(self, value: object, key: str, least: float = float("-inf")) -> float:
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not (
                least <= value and abs(value) < LARGEST):
            bound = f" of at least {least:g}" if least > float("-inf") else ""
            self.refuse(key, f"must be a number{bound}.")
        return value

    def a_count(self, value: object, key: str, least: int, most: int) -> int:
        """Bounded before anything is made of it."""
        count = self.a_number(value, key, least)
        if count != int(count) or count > most:
            self.refuse(key, f"is {count:g}. Give a whole number from {least} to {most}.")
        return int(count)

    def choice(self, value: object, key: str, known: tuple) -> str:
        if value not in known:
            self.refuse(key, f"'{value}' is none of {', '.join(known)}."
                        f"{nearest(str(value), list(known))}")
        return value

    def scene(self, name: str, key: str) -> Path:
        path = (self.path.parent / self.a_text(name, key)).resolve()
        if path not in self.scenes:
            if not path.is_file():
                self.refuse(key, f"there is no scene {name} beside the study "
                            f"(paths are relative to {self.path.parent}).")
            self.scenes[path] = read_yaml(path)
        return path

    # ---- settings ------------------------------------------------------------

    def apply(self, scene: Path, settings: dict, found: dict, where: str) -> None:
        """Notes settings in their order: what a `*` stands for, the program finds in the scene as
        it is by then."""
        for key, value in found.items():
            key = str(key)
            if (scene, key) not in self.known:
                added = {name.split(".")[1]: {} for name in settings if name.count(".") == 1
                         and name.startswith("bodies.")}
                bodies = self.scenes[scene].get("bodies")
                self.keys.refuse_unknown(key, {**(bodies if isinstance(bodies, dict) else {}),
                                               **added}, f"{self.path}: {where}")
                self.known[scene, key] = f"{self.path}: {where}"
            settings.pop(key, None)  # the last word counts, and is said last
            settings[key] = value

    def look_for_stars(self, scene: Path, settings: dict) -> None:
        """Once for all points that differ in values alone."""
        if (scene, *settings) in self.asked or not any("*" in key.split(".") for key in settings):
            return
        self.asked.add((scene, *settings))
        places = {key: self.known[scene, key] for key in settings}
        self.keys.refuse_idle_stars(scene, settings, places)

    def points_of(self, spec: dict, sweep: dict, key: str, quick: dict | None) -> list[Point]:
        knobs = study_knobs.read(self, sweep.get("knobs", {}), f"{key}knobs")
        for knob in knobs:
            own = {self.keys.unit(name) for name, values in knob.keys.items() if values is None}
            words = any(isinstance(value, str) for value in knob.values)  # 5 mm has its unit
            self.knob_units[knob.name] = knob.unit or (
                own.pop() if len(own) == 1 and not words else "")
        if quick is not None:
            for knob in knobs:
                knob.values = knob.values[:quick.get("keep", 2)]
        points = []
        repeats = self.a_count(sweep.get("repeats", spec.get("repeats", 1)),
                               f"{key}repeats" if "repeats" in sweep else "repeats", 1,
                               MOST_REPEATS)
        variants = self.variants_of(spec, sweep, key)
        runs = math.prod(len(knob.values) for knob in knobs) * len(variants)
        if runs > MOST_RUNS:
            self.refuse(f"{key}knobs", f"make {runs} runs: all combinations of their values. A "
                        f"study has at most {MOST_RUNS}; give fewer values, or several sweeps.")
        for variant, where in variants:
            path = self.scene(variant.get("scene", spec.get("base")),
                              where + "scene" if "scene" in variant else "base")
            for values in itertools.product(*(range(len(knob.values)) for knob in knobs)):
                chosen = {knob.name: knob.values[i] for knob, i in zip(knobs, values)}
                settings = {}
                steps = [(spec.get("set", {}), "set"), (variant.get("set", {}), where + "set"),
                         (sweep.get("set", {}), f"{key}set")]
                steps += [(knob.settings(i), f"{key}knobs.{knob.name}")
                          for knob, i in zip(knobs, values)]
                steps += [((quick or {}).get("set", {}), "quick.set")]
                for found, place in steps:
                    self.apply(path, settings, self.a_map(found, place), place)
                self.look_for_stars(path, settings)
                words = [variant["label"]] if variant.get("label") else []
                words += [f"{name} {study_knobs.shown(value)}" for name, value in chosen.items()]
                points.append(Point(", ".join(words) or "base", sweep.get("title", ""),
                                    variant.get("label", ""), path, chosen, settings,
                                    repeats=1 if quick is not None else repeats))
        return points

    def variants_of(self, spec: dict, sweep: dict, key: str) -> list[tuple[dict, str]]:
        found = []
        for i, variant in enumerate(self.a_list(spec.get("variants", []), "variants")):
            where = f"variants[{i}]."
            self.a_map(variant, where[:-1], "variant")
            self.a_text(variant.get("label"), where + "label")
            if "scene" not in variant and "base" not in spec:
                self.refuse(where + "scene", "is needed, because the study has no base.")
            found.append((variant, where))
        labels = [variant["label"] for variant, _ in found]
        for label, count in Counter(labels).items():
            if count > 1:
                self.refuse("variants", f"two are labelled '{label}'.")
        if "variants" in sweep and sweep is not spec:
            wanted = self.a_list(sweep["variants"], f"{key}variants")
            for pattern in wanted:
                if not any(fnmatchcase(label, str(pattern)) for label in labels):
                    self.refuse(f"{key}variants", f"no variant is labelled '{pattern}'."
                                f"{nearest(str(pattern), labels)}")
            found = [pair for pair in found
                     if any(fnmatchcase(pair[0]["label"], str(pattern)) for pattern in wanted)]
        if not found and "base" not in spec:
            self.refuse("base", "is needed: name a scene, or variants with scenes of their own.")
        return found or [({}, "")]

    def kept(self, points: list[Point], patterns: list) -> list[Point]:
        for pattern in self.a_list(patterns, "quick.runs"):
            if not any(fnmatchcase(point.label, str(pattern)) for point in points):
                self.refuse("quick.runs", f"no run is labelled '{pattern}'."
                            f"{nearest(str(pattern), [point.label for point in points])}")
        return [point for point in points
                if any(fnmatchcase(point.label, str(pattern)) for pattern in patterns)]

    def expect(self, points: list[Point], found: dict, is_quick: bool) -> None:
        """Notes which runs are to be refused or to fail; the others are to complete."""
        for status, patterns in self.a_map(found, "expected", "expected").items():
            key = f"expected.{status}"
            patterns = [patterns] if isinstance(patterns, str) else self.a_list(patterns, key)
            for pattern in patterns:
                own = [point for point in points if fnmatchcase(point.label, str(pattern))]
                if not own and not is_quick:  # the short form has not all runs
                    self.refuse(key, f"no run is labelled '{pattern}'."
                                f"{nearest(str(pattern), [point.label for point in points])}")
                for point in own:
                    if point.expected not in ("completed", status):
                        self.refuse(key, f"run '{point.label}' is expected to be "
                                    f"{point.expected} as well.")
                    point.expected = status

    # ---- what is measured ------------------------------------------------------------

    def errors(self, found: dict, has_reference: bool) -> list[Error]:
        errors = []
        if not found:
            self.refuse("errors", "name at least one: it is what the study measures.")
        for name, spec in found.items():
            key = f"errors.{name}"
            spec = {"measure": spec} if isinstance(spec, str) else self.a_map(spec, key, "error")
            if ("measure" in spec) == ("history" in spec):
                self.refuse(key, "needs either measure or history.")
            error = Error(name, absolute=spec.get("abs", True) is True)
            if "measure" in spec:
                error.measure = Expression(self.a_text(spec["measure"], f"{key}.measure"),
                                           f"{self.path}: {key}.measure")
                error.against = self.choice(spec.get("against", ""), f"{key}.against",
                                            ("", "reference"))
            else:
                history = spec["history"]
                error.history = history if isinstance(history, list) else [history]
                error.norm = self.choice(spec.get("norm", "rms"), f"{key}.norm",
                                         ("rms", "max", "end"))
                error.against = self.choice(spec.get("against", "closed_form"), f"{key}.against",
                                            ("closed_form", "reference"))
            if error.against == "reference" and not has_reference:
                self.refuse(f"{key}.against", "the study has no reference run; say reference: "
                            "{set: {...}} with finer settings.")
            if "unit" in spec:
                error.unit = self.a_text(spec["unit"], f"{key}.unit")
            error.minus = self.a_number(spec.get("minus", 0.0), f"{key}.minus")
            if "relative_to" in spec:
                error.relative_to = self.a_number(spec["relative_to"], f"{key}.relative_to")
                if error.relative_to == 0:
                    self.refuse(f"{key}.relative_to", "must not be 0.")
            errors.append(error)
        return errors

    def figures(self, found: list, errors: list[Error], knobs: list[str]) -> list[dict]:
        for i, figure in enumerate(self.a_list(found, "figures")):
            key = f"figures[{i}]"
            self.a_map(figure, key)
            kind = next((word for word in ("convergence", "table") if word in figure), "histories")
            self.a_map(figure, key, kind)
            if kind == "convergence":
                self.choice(figure["convergence"], f"{key}.convergence",
                            tuple(error.name for error in errors))
            if kind == "convergence" or "knob" in figure:
                self.choice(figure.get("knob"), f"{key}.knob", tuple(knobs))
            if kind == "table":
                where = f"{key}.table"
                figure["table"] = {
                    str(name): Expression(self.a_text(text, f"{where}.{name}"),
                                          f"{self.path}: {where}.{name}")
                    for name, text in self.a_map(figure["table"], where).items()}
                if not figure["table"]:
                    self.refuse(where, "needs at least one column: NAME: EXPRESSION.")
            if kind == "histories":
                for quantity in self.a_list(figure.get("histories"), f"{key}.histories"):
                    self.choice(quantity, f"{key}.histories", QUANTITIES)
                if self.a_text(figure.get("of"), f"{key}.of").count(".") != 1:
                    self.refuse(f"{key}.of", "names a port, as body.port.")
        return found

    def claims(self, found: list) -> list[dict]:
        claims = []
        for i, claim in enumerate(self.a_list(found, "claims")):
            key = f"claims[{i}]"
            self.a_map(claim, key, "claim")
            self.a_text(claim.get("text"), f"{key}.text")
            checks = []
            for j, check in enumerate(self.a_list(claim.get("checks"), f"{key}.checks")):
                place = f"{key}.checks[{j}]"
                self.a_map(check, place, "check")
                value = Expression(self.a_text(check.get("value"), f"{place}.value"),
                                   f"{self.path}: {place}.value")
                if not any(word in check for word in ("at_most", "at_least", "below", "above")):
                    self.refuse(place, "needs at_most, at_least, below or above.")
                checks.append({**check, "value": value})
            claims.append({**claim, "checks": checks})
        return claims


def refuse_idle_patterns(reader: Reader, study: Study) -> None:
    """A claim about runs that do not exist would be a claim about nothing."""
    labels = [point.label for point in study.points]
    named = [(figure, ("runs",), f"figures[{i}]") for i, figure in enumerate(study.figures)]
    named += [(check, ("runs", "below", "above"), f"claims[{i}].checks[{j}]")
              for i, claim in enumerate(study.claims) for j, check in enumerate(claim["checks"])]
    for spec, words, key in named:
        for word in words:
            patterns = spec.get(word, [])
            for pattern in [patterns] if isinstance(patterns, str) else patterns:
                if not any(fnmatchcase(label, pattern) for label in labels):
                    reader.refuse(f"{key}.{word}", f"no run is labelled '{pattern}'."
                                  f"{nearest(pattern, labels)} The first is '{labels[0]}'.")
    counts = Counter((point.sweep, point.label) for point in study.points)
    for (_, label), count in counts.items():
        if count > 1:
            reader.refuse("knobs", f"two runs are labelled '{label}': a value stands twice.")


def read_study(path: Path, abut: Path, is_quick: bool) -> Study:
    reader = Reader(path, KeyList(abut))
    spec = reader.a_map(read_yaml(path), "", "")
    title = reader.a_text(spec.get("title"), "title")
    quick = reader.a_map(spec.get("quick", {}), "quick", "quick") if is_quick else None
    if "sweeps" in spec and "knobs" in spec:
        reader.refuse("knobs", "stand in each of the sweeps when there are sweeps.")
    sweeps = reader.a_list(spec.get("sweeps", [spec]), "sweeps")
    points, knobs = [], []
    for i, sweep in enumerate(sweeps):
        key = "" if sweep is spec else f"sweeps[{i}]."
        if sweep is not spec:
            reader.a_map(sweep, key[:-1], "sweep")
            reader.a_text(sweep.get("title"), f"{key}title")
        else:
            sweep = {"knobs": spec.get("knobs", {})}
        points += reader.points_of(spec, sweep, key, quick)
        if len(points) > MOST_RUNS:
            reader.refuse("sweeps", f"make more than {MOST_RUNS} runs. Write several studies.")
        knobs += [name for name in sweep.get("knobs", {}) if name not in knobs]
    if quick is not None and "runs" in quick:
        points = reader.kept(points, quick["runs"])
    reader.expect(points, spec.get("expected", {}), is_quick)
    reference = None
    if "reference" in spec:
        found = reader.a_map(spec["reference"], "reference", "reference")
        scene, settings = reader.scene(found.get("scene", spec.get("base")), "reference.scene"), {}
        for step, place in ((spec.get("set", {}), "set"), (found.get("set", {}), "reference.set")):
            reader.apply(scene, settings, reader.a_map(step, place), place)
        reader.look_for_stars(scene, settings)
        reference = Point("reference", "", "", scene, {}, settings, "reference")
    errors = reader.errors(reader.a_map(spec.get("errors", {}), "errors"), reference is not None)
    study = Study(
        path, title, str(spec.get("about", "")), points, errors, knobs,
        max(point.repeats for point in points),
        reader.choice(spec.get("placement", "local"), "placement", ("local", "processes")),
        reader.a_number(spec.get("time_limit", 600.0), "time_limit", 0.0),
        reader.figures(spec.get("figures", []), errors, knobs),
        reader.claims(spec.get("claims", [])), reader.knob_units, reference)
    if not is_quick:  # the short form has not all runs
        refuse_idle_patterns(reader, study)
    return study
