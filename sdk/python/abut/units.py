"""Numbers with units: "200 g", "210 GPa", "7850 kg/m^3", as the scene's own keys take them."""

import re

# Powers of length, mass and time; mantissa and power of ten in SI; whether it takes prefixes.
SYMBOLS = {
    "m": ((1, 0, 0), 1.0, 0, True), "g": ((0, 1, 0), 1.0, -3, True),
    "s": ((0, 0, 1), 1.0, 0, True), "N": ((1, 1, -2), 1.0, 0, True),
    "Pa": ((-1, 1, -2), 1.0, 0, True), "J": ((2, 1, -2), 1.0, 0, True),
    "W": ((2, 1, -3), 1.0, 0, True), "Hz": ((0, 0, -1), 1.0, 0, True),
    "bar": ((-1, 1, -2), 1.0, 5, True), "t": ((0, 1, 0), 1.0, 3, False),
    "min": ((0, 0, 1), 60.0, 0, False), "h": ((0, 0, 1), 3600.0, 0, False),
    "rad": ((0, 0, 0), 1.0, 0, False), "deg": ((0, 0, 0), 0.017453292519943295, 0, False),
    "in": ((1, 0, 0), 254.0, -4, False), "ft": ((1, 0, 0), 3048.0, -4, False),
    "lb": ((0, 1, 0), 45359237.0, -8, False), "lbf": ((1, 1, -2), 44482216152605.0, -13, False),
    "psi": ((-1, 1, -2), 6894.757293168361, 0, False),
    "ksi": ((-1, 1, -2), 6894.757293168361, 3, False), "1": ((0, 0, 0), 1.0, 0, False),
}
PREFIXES = {"T": 12, "G": 9, "M": 6, "k": 3, "d": -1, "c": -2, "m": -3, "u": -6, "\u00b5": -6,
            "\u03bc": -6, "n": -9, "p": -12}
NONE = (0, 0, 0)


def _symbol(word):
    if word in SYMBOLS:
        return SYMBOLS[word][:3]
    for prefix, exponent in PREFIXES.items():
        known = SYMBOLS.get(word.removeprefix(prefix)) if word.startswith(prefix) else None
        if known is not None and known[3]:
            return known[0], known[1], known[2] + exponent
    return None


def unit_of(text: str):
    """(powers of length, mass and time; mantissa; power of ten) of "kg/m^3"; None: it is none."""
    powers, mantissa, exponent = NONE, 1.0, 0
    for sign, factor in re.findall(r"(^|[*/])([^*/]*)", text.strip()):
        parts = re.fullmatch(r"\s*(1|[^\W\d_]+)(?:\^?(-?\d))?\s*", factor)
        symbol = _symbol(parts[1]) if parts else None
        if symbol is None:
            return None
        times = int(parts[2] or 1) * (-1 if sign == "/" else 1)
        powers = tuple(sum(pair) for pair in zip(powers, (p * times for p in symbol[0])))
        mantissa, exponent = mantissa * symbol[1] ** times, exponent + symbol[2] * times
    return powers, mantissa, exponent


def system_of(text: str):
    """The units of length, mass and time that a scene declares, "mm t s"; None: SI."""
    units = {unit[0]: unit for unit in map(unit_of, text.split()) if unit is not None}
    base = [units.get(powers) for powers in ((1, 0, 0), (0, 1, 0), (0, 0, 1))]
    return None if None in base else base


def _scaled(number: str, mantissa: float, exponent: int) -> float:
    # Powers of ten move the point, so that 250 mm is the same number as 0.25 m.
    digits, _, power = number.lower().partition("e")
    return float(f"{digits}e{int(power or 0) + exponent}") * mantissa


def in_si(value, unit: str, system):
    """The number in SI, or in the unit where that is none of length, mass and time. Text is a
    number with a unit, which must be of this one's kind; a number alone is in the units of the
    system. None: it is neither, or of another kind."""
    wanted = unit_of(unit) if unit else (NONE, 1.0, 0)
    if isinstance(value, str):
        parts = re.fullmatch(r"\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*(.*?)\s*", value)
        given = unit_of(parts[2]) if parts and parts[2] and unit else None
        if given is None or wanted is None or given[0] != wanted[0]:
            return None
        return _scaled(parts[1], given[1], given[2])
    if system is None or wanted is None:
        return float(value)
    mantissa, exponent = 1.0, 0
    for times, (_, own, ten) in zip(wanted[0], system):
        mantissa, exponent = mantissa * own ** times, exponent + ten * times
    return _scaled(repr(float(value)), mantissa, exponent)
