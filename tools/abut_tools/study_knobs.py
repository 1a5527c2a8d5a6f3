"""Knobs of a study: a list or a range of values, and the scene keys that take them."""

import math
from dataclasses import dataclass

from abut_tools.scene_keys import nearest

MOST_VALUES = 10_000  # of one knob
KNOB = ("values", "range", "set", "unit")
RANGE = ("from", "to", "points", "scale")


@dataclass
class Knob:
    name: str
    values: list
    keys: dict  # scene key -> None (the knob's value), or a list with one value each
    unit: str = ""  # as the study says; empty: that of the keys

    def settings(self, i: int) -> dict:
        return {key: self.values[i] if own is None else own[i] for key, own in self.keys.items()}


def shown(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def spread(reader, found: dict, key: str) -> list:
    for name in reader.a_map(found, key):
        if name not in RANGE:
            reader.refuse(f"{key}.{name}", f"is not a known key.{nearest(str(name), list(RANGE))} "
                          f"Allowed here: {', '.join(RANGE)}.")
    low = reader.a_number(found.get("from"), f"{key}.from")
    high = reader.a_number(found.get("to"), f"{key}.to")
    points = reader.a_count(found.get("points"), f"{key}.points", 2, MOST_VALUES)
    scale = reader.choice(found.get("scale", "linear"), f"{key}.scale", ("linear", "log"))
    if scale == "log" and min(low, high) <= 0:
        reader.refuse(key, "a log scale needs from and to above 0.")
    parts = [k / (points - 1) for k in range(points)]
    values = [low * (high / low) ** part if scale == "log" else low + (high - low) * part
              for part in parts]
    if not all(math.isfinite(value) for value in values):
        reader.refuse(key, "has ends so far apart that there are no numbers between them.")
    if all(isinstance(end, int) for end in (low, high)):  # counts stay counts
        return list(dict.fromkeys(round(value) for value in values))
    return [float(f"{value:.12g}") for value in values]


def read(reader, found: dict, key: str) -> list[Knob]:
    knobs = []
    for name, spec in reader.a_map(found, key).items():
        place = f"{key}.{name}"
        if isinstance(spec, list):
            spec = {"values": spec}
        for word in reader.a_map(spec, place):
            if word not in KNOB:
                reader.refuse(f"{place}.{word}", "is not a known key."
                              f"{nearest(str(word), list(KNOB))} Allowed here: {', '.join(KNOB)}.")
        if ("values" in spec) == ("range" in spec):
            reader.refuse(place, "needs either values or range.")
        values = (reader.a_list(spec["values"], f"{place}.values") if "values" in spec
                  else spread(reader, spec["range"], f"{place}.range"))
        if not 0 < len(values) <= MOST_VALUES:
            reader.refuse(place, f"has {len(values)} values. Give 1 to {MOST_VALUES}.")
        keys = spec.get("set", [name])
        keys = {keys: None} if isinstance(keys, str) else keys
        if isinstance(keys, list):
            keys = {scene_key: None for scene_key in keys}
        for scene_key, own in reader.a_map(keys, f"{place}.set").items():
            own = None if own is None else reader.a_list(own, f"{place}.set.{scene_key}")
            if own is not None and len(own) != len(values):
                reader.refuse(f"{place}.set.{scene_key}",
                              f"has {len(own)} values, the knob has {len(values)}.")
        unit = reader.a_text(spec["unit"], f"{place}.unit") if "unit" in spec else ""
        knobs.append(Knob(name, list(values), keys, unit))
    return knobs
