"""Words of units: what a scene that declares its own system calls those of SI, and the units that
measures have."""

import re

COSTS = {"wall_s_median": "s", "wall_s_min": "s", "wall_s_max": "s", "compute_s": "s",
         "memory_mib": "MiB"}  # of the machine, whatever the scene's system is
# By the whole name of a measure, the first that fits; what none fits has no unit.
# docs/OUTPUT.md tells the same of every measure.
MEASURES = [(re.compile(pattern), unit) for pattern, unit in (
    (r"contact\..+\.(begin|end|duration)", "s"),
    (r"contact\..+\.impulse", "N s"),
    (r"contact\..+\.(force_mean|force_peak|force_peak_filtered)", "N"),
    (r"contact\..+\.dissipated", "J"),
    (r"contact\..+\.velocity_rms", "m/s"),
    (r"contact\..+\.(gap_min|jump_max)", "m"),
    (r"energy\.total\.begin", "J"),
    (r"momentum\..+\.end(_[xyz])?", "kg m/s"),
    (r"angular_momentum\..+\.end(_[xyz])?", "kg m^2/s"),
    (r"mean_velocity\..+\.end(_[xyz])?", "m/s"),
    (r"position\..+\.max", "m"),
    (r"body\..+\.contact\.(area|stick_area)", "m^2"),
    (r"body\..+\.contact\.spread", "m"),
    (r"body\..+\.contact\.pressure_max", "Pa"),
    (r"body\..+\.(nodal_)?(stress\.[xyz]{2}|von_mises)(\.\w+)?", "Pa"),
    (r"body\..+\.displacement\.[xyz](\.\w+)?", "m"),
    (r"body\..+\.velocity\.[xyz](\.\w+)?", "m/s"),
    (r"body\..+\.stabilisation\.force", "N"),
    (r"body\..+\.stabilisation\.work", "J"),
    (r"body\..+\.(reaction|force)\.[xyz]", "N"),
    (r"body\..+\.energy\.(kinetic|stored|dissipated|external_work|hourglass)", "J"),
    (r"body\..+\.stable_step\.min", "s"),
    (r"body\..+\.(rotation\.max|angle)", "rad"),
    (r"body\..+\.moment", "N m"),
    (r"body\..+\.angular_momentum\.[xyz]", "kg m^2/s"),
    (r"body\..+\.momentum\.[xyz]", "kg m/s"),
    (r"closed_form\.(begin|end|duration)", "s"),
    (r"closed_form\.force", "N"),
    (r"closed_form\.impulse", "N s"),
    (r"closed_form\.closing_speed", "m/s"),
)]


def measure_unit(name: str) -> str:
    """In SI; empty: a number without a unit."""
    return COSTS.get(name) or next(
        (unit for pattern, unit in MEASURES if pattern.fullmatch(name)), "")


class Units:
    """`words`: the scene's word for each unit of SI, as summary.json has them; none: SI."""

    def __init__(self, words: dict[str, str] | None = None):
        self.words = words or {}

    def word(self, unit: str) -> str:
        """N s is t mm/s in mm, t and s; what is no unit of the system stays."""
        if not self.words or unit in self.words:
            return self.words.get(unit, unit).replace("*", " ")
        joined = unit.replace(" ", "*")
        if joined in self.words:
            return self.words[joined].replace("*", " ")
        if "(" in unit or "/" not in unit and " " not in unit:
            return unit
        return re.sub(r"[A-Za-z]+", lambda each: self.words.get(each[0], each[0]), unit)

    def text(self, text: str) -> str:
        """`depth [m]` with the scene's word between the brackets."""
        return re.sub(r"\[([^\[\]]+)\]", lambda each: f"[{self.word(each[1])}]", text)


def common(systems: list[dict[str, str]]) -> Units | None:
    """None: scenes of several systems, whose numbers no axis can hold together."""
    first = systems[0] if systems else {}
    return Units(first) if all(words == first for words in systems) else None


def with_unit(name: str, unit: str) -> str:
    return f"{name} [{unit}]" if unit and "[" not in name else name
