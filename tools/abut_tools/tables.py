"""What readers of finished runs share: tables, numbers for people, short curves."""

import math
import re

# Told apart by all eyes.
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#8c6d1f", "#5b5b5b")
# Of quantities of one sign from low to high, each lighter than the one before, and of both signs.
RAMPS = {"plain": ("#403a8c", "#3a6ab4", "#2898b8", "#38b890", "#a0d058", "#fde04c"),
         "signed": ("#143f94", "#5f9bd8", "#e9ecef", "#ea9164", "#9c2b0c"),
         "signed_dark": ("#7ab8ff", "#3d70b8", "#2b3440", "#b8663c", "#ffa478")}
PREFIXES = {-12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T"}
PREFIXED_UNITS = ("s", "m", "N", "J", "Pa", "N s", "Hz")


def ramp_of(low: float, dark: bool = False) -> tuple[str, ...]:
    """Nothing looks like the ground: light on a light one, dark on a dark one."""
    if low >= 0.0:
        return RAMPS["plain"]
    return RAMPS["signed_dark" if dark else "signed"]


class ToolError(Exception):
    """What is wrong and what to do, with the exit code that says whose turn it is."""

    def __init__(self, message: str, code: int):
        super().__init__(message)
        self.code = code


class Table:
    """Columns of numbers by name; an empty cell is None."""

    def __init__(self, names: list[str], rows: list[list[float | None]], where: str = ""):
        self.columns = {name: [row[i] for row in rows] for i, name in enumerate(names)}
        self.where = where

    def __contains__(self, name: str) -> bool:
        return name in self.columns

    def __getitem__(self, name: str) -> list[float | None]:
        if name not in self.columns:
            raise ToolError(f"{self.where}: has no column {name}. Run the scene again, or take the "
                            "file from a copy of the run.", 2)
        return self.columns[name]

    def matching(self, pattern: str) -> list[re.Match]:
        found = (re.fullmatch(pattern, name) for name in self.columns)
        return [match for match in found if match]


class Figure:
    """Curves over time with one unit."""

    def __init__(self, name: str, title: str, quantity: str, unit: str, points: bool = False):
        self.name, self.title, self.quantity, self.unit = name, title, quantity, unit
        self.points = points  # values of windows: dots, not a line
        self.curves = []

    def add(self, label, colour, times, values, exact=False, dash=0):
        # Differences of the largest numbers are none.
        pairs = [(t, v) for t, v in zip(times, values)
                 if t is not None and v is not None and math.isfinite(v)]
        if pairs:
            self.curves.append({"label": label, "colour": colour, "exact": exact, "dash": dash,
                                "x": [t for t, _ in pairs], "y": [v for _, v in pairs]})

    def words(self, factor: float, unit: str, time_scale: tuple[float, str]) -> str:
        """What the curves show, for those who do not see them."""
        ends = [t * time_scale[0] for curve in self.curves for t in (curve["x"][0], curve["x"][-1])]
        told = [f"{curve['label'] or self.quantity} from {few(factor * min(curve['y']))} to "
                f"{few(factor * max(curve['y']))}" for curve in self.curves[:8]]
        span = f"from {few(min(ends))} to {few(max(ends))} {time_scale[1]}" if ends else ""
        return f"{self.title} [{unit}] {span}: {'; '.join(told)}".replace(" []", "")

    def data(self, limit: int, time_scale: tuple[float, str]) -> dict:
        largest = max((abs(y) for curve in self.curves for y in curve["y"]), default=0.0)
        factor, unit = scaled_unit(largest, self.unit)
        curves = []
        for curve in self.curves:
            x, y = thinned(curve["x"], curve["y"], limit)
            curves.append({**curve, "x": [rounded(t * time_scale[0], 8) for t in x],
                           "y": [rounded(v * factor, 7) for v in y]})
        label = f"{self.quantity} [{unit}]" if unit else self.quantity
        lowest = min((y for curve in self.curves for y in curve["y"]), default=0.0)
        # Round-off below zero must not open half a figure of empty space.
        floor = 0 if -0.005 * largest < lowest <= 0.0 else None
        return {"name": self.name, "label": label, "unit": unit, "points": self.points,
                "words": self.words(factor, unit, time_scale), "time": time_scale[1],
                "floor": floor, "curves": curves}


def scaled_unit(largest: float, unit: str) -> tuple[float, str]:
    """Factor and unit with an SI prefix so that the largest value has one to three digits."""
    if unit not in PREFIXED_UNITS or largest == 0.0 or not math.isfinite(largest):
        return 1.0, unit
    # A little more than the value: a thousand that rounding left short is one of the next prefix.
    exponent = 3 * math.floor((math.log10(largest) + 4e-7) / 3)
    exponent = min(12, max(-12, exponent))
    return 10.0 ** -exponent, PREFIXES[exponent] + unit


def rounded(value: float, digits: int) -> float:
    return float(f"{value:.{digits}g}")


def thinned(x: list, y: list, limit: int) -> tuple[list, list]:
    """At most about `limit` points; every stretch keeps its smallest and its largest value."""
    if len(x) <= limit:
        return x, y
    stretches = max(1, limit // 2 - 1)
    keep = {0, len(x) - 1}
    for k in range(stretches):
        stretch = range(k * len(x) // stretches, (k + 1) * len(x) // stretches)
        keep.add(min(stretch, key=y.__getitem__))
        keep.add(max(stretch, key=y.__getitem__))
    order = sorted(keep)
    return [x[i] for i in order], [y[i] for i in order]


def with_jumps(times: list, values: list, jumps: list[float]) -> tuple[list, list]:
    """A step function that is sampled now and then, made vertical where its jumps are known."""
    out_t, out_v = [], []
    for k, (time, value) in enumerate(zip(times, values)):
        if k > 0 and values[k - 1] is not None and value is not None:
            for jump in jumps:
                if times[k - 1] < jump <= time:
                    out_t += [jump, jump]
                    out_v += [values[k - 1], value]
        out_t.append(time)
        out_v.append(value)
    return out_t, out_v


def plus(values: list, offset: float, factor: float = 1.0) -> list:
    return [None if v is None else factor * v + offset for v in values]


def less(values: list, others: list) -> list:
    return [None if v is None or w is None else v - w for v, w in zip(values, others)]


def since_begin(values: list) -> list:
    first = next((v for v in values if v is not None), 0.0)
    return plus(values, -first)


def sum_of(columns: list[list]) -> list:
    return [None if None in row else sum(row) for row in zip(*columns)]


def colour_of(names: list[str], name: str) -> str:
    place = names.index(name) if name in names else len(names)
    return COLOURS[place % len(COLOURS)]


def few(value: float) -> str:
    """Four digits: as many as a person takes in."""
    text = f"{value:.4g}"
    return f"{float(text):.0f}" if "e+" in text and abs(value) < 1e6 else text


def measured(value: float | None, unit: str) -> str:
    """Few digits, and a unit with a prefix that keeps them short."""
    if value is None:
        return ""
    factor, prefixed = scaled_unit(abs(value), unit)
    return f"{few(value * factor)} {prefixed}".strip()


def shown(value) -> str:
    if value is None:
        return "no value"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.6g}" if isinstance(value, (int, float)) else str(value)
