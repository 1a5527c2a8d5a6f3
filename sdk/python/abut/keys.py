"""The keys of a body below model.external, as the scene has them."""

import math
import re

import yaml

from abut.errors import InputError
from abut.units import in_si, system_of

# A decimal number, as abut itself takes it.
NUMBER = re.compile(r"[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?")


class Keys:
    """Reads `keys["mass"]`, `keys.positive("mass")`, `keys.get("words", "")`. What is missing or
    impossible is an InputError with file, line and key; so is a key that nobody has read."""

    def __init__(self, document: str, text: str, path: str, overrides=()):
        self._document, self._path, self._unread = document, f"{path}.model.external", set()
        node = yaml.compose(text, Loader=yaml.SafeLoader)
        for name in self._path.split("."):
            node = dict((key.value, value) for key, value in node.value)[name]
        self._lines = {}
        if isinstance(node, yaml.MappingNode):
            self._lines = {key.value: key.start_mark.line + 1 for key, _ in node.value}
        values = yaml.safe_load(text)
        declared = values.get("units") if isinstance(values, dict) else None
        self._system = system_of(declared) if isinstance(declared, str) else None
        for name in self._path.split("."):
            values = values[name]
        self._values = dict(values or {})
        for change in overrides:
            self._override(*change.split("=", 1))
        self._unread = set(self._values)

    def _override(self, key: str, value: str):
        if not key.startswith(self._path + "."):
            return
        name = key.removeprefix(self._path + ".")
        if "." in name or "[" in name:
            raise InputError("is deeper than --set reaches into keys of this body", key,
                             "Write the value into the scene.")
        self._values[name] = yaml.safe_load(value)
        self._lines.pop(name, None)
        if self._values[name] is None:
            del self._values[name]

    def where(self, name: str) -> str:
        line = f":{self._lines[name]}" if name in self._lines else ""
        return f"{self._document}{line}: {self._path}.{name}"

    def __contains__(self, name: str) -> bool:
        return name in self._values

    def __getitem__(self, name: str):
        """The value; of what looks like a number the number, since YAML takes 1e5 for a word."""
        if name not in self._values:
            raise InputError("is missing", self.where(name), "Give it a value.")
        self._unread.discard(name)
        value = self._values[name]
        return float(value) if isinstance(value, str) and NUMBER.fullmatch(value) else value

    def get(self, name: str, otherwise):
        return self[name] if name in self else otherwise

    def number(self, name: str, unit: str = "") -> float:
        """The number in SI. With a unit, as "kg", the scene may give it as "200 g", and as a number
        of the units that it declares."""
        value = self[name]
        number = None
        if not isinstance(value, bool) and isinstance(value, (int, float, str)):
            number = in_si(value, unit, self._system)
        if number is None or not math.isfinite(number):
            raise InputError(f"must be a number, but is {value!r}", self.where(name),
                             f"Give one, as 0.5 or 0.5 {unit}." if unit else "Give one.")
        return number

    def positive(self, name: str, unit: str = "") -> float:
        value = self.number(name, unit)
        if not value > 0.0:
            raise InputError(f"must be positive, but is {value:g}", self.where(name),
                             "Give a number above 0.")
        return value

    def require_all_read(self):
        for name in sorted(self._unread):
            raise InputError("is a key that this body does not read", self.where(name),
                             "Remove it, or correct its name.")
