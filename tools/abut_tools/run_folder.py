"""What a run's folder holds, but for its fields: summary, history, exact solution, events."""

import math
from pathlib import Path

from abut_tools.run_files import (SUMMARY, cut_short, is_there, read_events, read_json,
                                  read_table)
from abut_tools.tables import Table, ToolError, measured, scaled_unit
from abut_tools.units import Units

AXES = ("x", "y", "z")


class RunView:
    """What is told of a run, wherever it was read."""

    def __init__(self, summary: dict, history: Table, exact: Table | None = None,
                 events: list[dict] | None = None):
        self.summary, self.history, self.exact = summary, history, exact
        self.events = events or []
        self.units = Units(summary.get("units"))
        self.measured = None  # measures over time, where the scene asks for some

    def title(self) -> str:
        return self.summary.get("title") or "Run"

    def told(self, value: float | None, unit: str) -> str:
        """A number in the scene's word for a unit of SI, with few digits."""
        return measured(value, self.units.word(unit))

    def time_scale(self) -> tuple[float, str]:
        """Factor and unit of axes of time."""
        times = [abs(t) for t in self.history["time"] if t is not None]
        return scaled_unit(max(times, default=0.0), self.units.word("s"))

    def measures(self) -> dict:
        return self.summary.get("measures", {})

    def measure(self, name: str) -> float | None:
        return self.measures().get(name)

    def bodies(self) -> list[str]:
        return [match[1] for match in self.history.matching(r"(.+)\.kinetic")]

    def ports(self) -> list[str]:
        """Those of bars: points of a line."""
        return [match[1] for match in self.history.matching(r"(.+\..+)\.u")]

    def port(self, name: str) -> dict:
        return self.summary.get("ports", {}).get(name, {})

    def vector_ports(self) -> list[str]:
        """Those in the plane and in space."""
        return [match[1] for match in self.history.matching(r"(.+\..+)\.u_x")]

    def vector(self, name: str) -> list[tuple[str, list]]:
        """Axes and columns of a quantity with components."""
        return [(axis, self.history[f"{name}_{axis}"]) for axis in AXES
                if f"{name}_{axis}" in self.history]

    def speed_scale(self) -> float:
        """[m/s] The largest speed that the kinetic energy of a body stands for: what is far below
        is round-off."""
        scale = 0.0
        for body in self.summary.get("bodies", []):
            column, mass = f"{body['name']}.kinetic", body.get("mass")
            if mass and mass > 0.0 and column in self.history:
                most = max((v for v in self.history[column] if v is not None), default=0.0)
                scale = max(scale, math.sqrt(2.0 * max(most, 0.0) / mass))
        return scale

    def interfaces(self) -> dict[str, dict]:
        return self.summary.get("interfaces", {})

    def side_alone(self, interface: str) -> str:
        """The side whose port has no other partner, so that its force is this interface's; empty
        where both have."""
        sides = self.interfaces()[interface].get("sides", [])
        every = [each.get("sides", []) for each in self.interfaces().values()]
        if [] in every:  # an interface of any two surfaces
            return ""
        return next((side for side in sides if sum(side in one for one in every) == 1), "")

    def is_tie(self, interface: str) -> bool:
        return bool(self.interfaces().get(interface, {}).get("tied"))


class Run(RunView):
    """A run's folder, read whole. A run that was killed has no summary."""

    def __init__(self, folder: Path):
        paths = {name: folder / name
                 for name in ("summary.json", "history.csv", "closed_form.csv", "measures.csv",
                              "events.jsonl")}
        there = {name for name, path in paths.items() if is_there(path)}
        if not there & {"summary.json", "history.csv"}:
            raise ToolError(
                f"{folder} holds no run: neither summary.json nor history.csv is there. "
                f"Make one with: abut run SCENE --out {folder}", 2)
        name = folder.resolve().name.encode("utf-8", "replace").decode()
        summary = {"status": "unfinished", "title": name,
                   "notes": ["there is no summary.json: the run was ended from outside"]}
        if "summary.json" in there:
            summary = read_json(paths["summary.json"], SUMMARY)
        history, exact, events = Table(["time"], []), None, []
        if "history.csv" in there:
            history = read_table(paths["history.csv"])
            words = cut_short(history, summary)
            if words:
                summary["notes"] = [*summary.get("notes", []), words]
        if "closed_form.csv" in there:
            exact = read_table(paths["closed_form.csv"])
        if "events.jsonl" in there:
            events = read_events(paths["events.jsonl"])
        super().__init__(summary, history, exact, events)
        if "measures.csv" in there:
            self.measured = read_table(paths["measures.csv"])
