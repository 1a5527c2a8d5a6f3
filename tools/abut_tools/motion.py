"""The bodies of a run as they move: surfaces, displacements and colours at every chosen state."""

import array
import math
from pathlib import Path
from typing import NamedTuple

from abut_tools.run_files import damaged
from abut_tools.surfaces import Surface, clustered, surface_of
from abut_tools.units import Units
from abut_tools.vtu import LIST, Entry, Grid, State, listed_states

SAMPLES = 200_000
STRIP = 0.02  # half the height of a bar's strip, as a part of the length of the scene


class Shade(NamedTuple):
    """A quantity that may colour bodies, the arrays that have it, the first that is there wins."""

    key: str
    label: str
    unit: str
    arrays: tuple      # (PointData or CellData, name, components)
    component: int     # of a vector or tensor that one is shown of; -1: its magnitude


SOLID = (
    Shade("stress", "von Mises stress", "Pa", (("PointData", "nodal_von_mises", 1),
                                                ("CellData", "von_mises", 1)), 0),
    Shade("speed", "speed", "m/s", (("PointData", "velocity", 3),), -1),
    Shade("pressure", "contact pressure", "Pa", (("PointData", "contact_pressure", 1),), 0),
    Shade("displacement", "displacement", "m", (("PointData", "displacement", 3),), -1),
    Shade("plastic", "equivalent plastic strain", "",
          (("CellData", "equivalent_plastic_strain", 1),), 0))
# Of bars the sign is what one wants to see.
BARS = (
    Shade("stress", "axial stress, tension positive", "Pa", (("CellData", "stress", 6),), 0),
    Shade("speed", "velocity", "m/s", (("PointData", "velocity", 3),), 0),
    Shade("displacement", "displacement", "m", (("PointData", "displacement", 3),), 0),
    Shade("plastic", "equivalent plastic strain", "",
          (("CellData", "equivalent_plastic_strain", 1),), 0))


class Scale(NamedTuple):
    """Between which values colours run. What lies beyond has the last colour."""

    low: float
    high: float
    least: float
    most: float


class MovingBody:
    def __init__(self, name: str, grid: Grid, surface: Surface):
        self.name, self.surface = name, surface
        self.cells_of_node = {}
        self.rest = [tuple(grid.points[3 * node: 3 * node + 3]) for node in surface.nodes]
        self.displacements = []  # per state an array of 3 numbers per node of the surface
        self.values = {}         # key -> per state an array of one number per node
        self.grid = grid
        self.nearest = {}        # of another mesh: its nearest node for every node of the surface

    def averaging(self) -> dict[int, list[int]]:
        """The cells of every node of the surface: values of cells are shown as means of these."""
        if not self.cells_of_node:
            self.cells_of_node = {node: [] for node in self.surface.nodes}
            begin = 0
            for cell, end in enumerate(self.grid.offsets):
                for node in self.grid.connectivity[begin:end]:
                    if node in self.cells_of_node:
                        self.cells_of_node[node].append(cell)
                begin = end
        return self.cells_of_node

    def shade(self, state: State, shade: Shade) -> array.array | None:
        for place, name, components in shade.arrays:
            if not state.has(place, name):
                continue
            if place == "PointData":
                numbers = state.at_nodes(name, components)
                return array.array("d", (one_of(numbers, components * node, components,
                                                shade.component) for node in self.surface.nodes))
            numbers = state.at_cells(name, components)
            told = [one_of(numbers, components * cell, components, shade.component)
                    for cell in range(state.cells)]
            cells = self.averaging()
            return array.array("d", (sum(told[c] for c in cells[node]) / max(len(cells[node]), 1)
                                     for node in self.surface.nodes))
        return None

    def add(self, state: State, shades: tuple[Shade, ...]) -> None:
        if (state.nodes, state.cells) != (len(self.grid.points) // 3, len(self.grid.offsets)):
            return self.add_by_nearest(state, shades)
        moved = array.array("d", bytes(24 * len(self.surface.nodes)))
        if state.has("PointData", "displacement"):
            numbers = state.at_nodes("displacement", 3)
            moved = array.array("d", (numbers[3 * node + i] for node in self.surface.nodes
                                      for i in range(3)))
        self.displacements.append(moved)
        for shade in shades:
            self.values.setdefault(shade.key, []).append(self.shade(state, shade))
        return None

    def add_by_nearest(self, state: State, shades: tuple[Shade, ...]) -> None:
        """Of a body that has gone on as another mesh: what its nearest nodes tell, on the first."""
        key = (state.nodes, state.cells)
        if key not in self.nearest:
            points = state.grid().points
            there = [tuple(points[3 * k: 3 * k + 3]) for k in range(state.nodes)]
            self.nearest[key] = [min(range(len(there)), key=lambda k, x=x: math.dist(x, there[k]))
                                 for x in self.rest]
        nodes = self.nearest[key]
        moved = array.array("d", bytes(24 * len(nodes)))
        if state.has("PointData", "displacement"):
            numbers = state.at_nodes("displacement", 3)
            moved = array.array("d", (numbers[3 * node + i] for node in nodes for i in range(3)))
        self.displacements.append(moved)
        for shade in shades:
            told = None
            for place, name, components in shade.arrays:
                if told is None and place == "PointData" and state.has(place, name):
                    numbers = state.at_nodes(name, components)
                    told = array.array("d", (one_of(numbers, components * node, components,
                                                    shade.component) for node in nodes))
            self.values.setdefault(shade.key, []).append(told)


def one_of(numbers: array.array, at: int, components: int, component: int) -> float:
    if component >= 0:
        return numbers[at + component]
    return math.hypot(*numbers[at: at + components])


class Motion:
    """All bodies at the same times."""

    def __init__(self, times: list[float], bodies: list[MovingBody], dimension: int,
                 shades: tuple[Shade, ...], states: int, thinned: bool):
        self.times, self.bodies, self.dimension = times, bodies, dimension
        self.states_there, self.thinned = states, thinned
        self.low, self.high = box_of(bodies)
        self.scales = {}
        for shade in shades:
            scale = scale_of(self, shade.key)
            if scale:
                self.scales[shade.key] = scale
        self.shades = [shade for shade in shades if shade.key in self.scales]
        self.length, self.time = "m", "s"

    def in_words_of(self, units: Units) -> "Motion":
        """Units as the scene calls them."""
        self.shades = [shade._replace(unit=units.word(shade.unit)) for shade in self.shades]
        self.length, self.time = units.word(self.length), units.word(self.time)
        return self

    def state_of_most(self) -> int:
        """The state at which the first quantity is largest over all nodes."""
        if not self.shades:
            return 0
        rows = [[values[k] for body in self.bodies
                 if (values := body.values[self.shades[0].key])[k] is not None]
                for k in range(len(self.times))]
        totals = [sum(sum(map(abs, row)) for row in each) for each in rows]
        return max(range(len(totals)), key=totals.__getitem__)

    def size(self) -> float:
        return math.dist(self.low, self.high) or 1.0


def box_of(bodies: list[MovingBody]) -> tuple[list[float], list[float]]:
    """Around all bodies at all times."""
    low, high = [math.inf] * 3, [-math.inf] * 3
    for body in bodies:
        for moved in body.displacements:
            for i in range(3):
                places = [x[i] + u for x, u in zip(body.rest, moved[i::3])]
                low[i], high[i] = min(low[i], *places), max(high[i], *places)
    return low, high


def scale_of(motion: Motion, key: str) -> Scale | None:
    """Without the highest hundredth where these would leave all others one colour. None
    where nothing is told, or all is zero. Of a contact pressure, which most nodes have none of,
    from zero on: of the side that does not find the contact nodes may have a part of the force
    that is shared out to them against its sign."""
    rows = [values for body in motion.bodies for values in body.values.get(key, [])
            if values is not None and len(values)]
    least, most = min(map(min, rows), default=0.0), max(map(max, rows), default=0.0)
    if not (least or most):
        return None
    step = 1 + sum(map(len, rows)) // SAMPLES
    numbers = sorted(v for row in rows for v in row[::step]) or [least, most]
    presses = key == "pressure" and most > 0.0
    if presses:
        numbers = [v for v in numbers if v > 1e-9 * most] or [most]
    rest = (len(numbers) - 1) // 100
    low, high = numbers[rest], numbers[-1 - rest]
    if least < -1e-6 * abs(most) and not presses:  # of both signs: zero is in the middle
        reach = max(abs(low), abs(high))
        bound = max(abs(least), abs(most))
        reach = bound if bound < 1.5 * reach or not reach else reach
        return Scale(-reach, reach, least, most)
    if most < 1.5 * high or high <= 0.0:
        high = most
    return Scale(0.0, high, least, most)


def chosen_times(times: list[float], most: int) -> list[float]:
    if len(times) <= most:
        return times
    return [times[round(k * (len(times) - 1) / (most - 1))] for k in range(most)]


def by_body(entries: list[Entry]) -> dict[str, dict[float, Entry]]:
    found = {}
    for entry in entries:
        found.setdefault(entry.body, {})[entry.time] = entry
    return found


def strip_height(bodies: list[MovingBody]) -> float:
    """Half the height of bars: they have an area and no shape."""
    low, high = box_of(bodies)
    return STRIP * ((high[0] - low[0]) or 1.0)


def motion_of(folder: Path, most_states: int, most_nodes: int | None = None,
              also: float | None = None) -> Motion | None:
    """The run's bodies at some of its states, evenly chosen, and at one that is wanted also. None
    where it wrote no fields."""
    files = by_body(listed_states(folder))
    if not files:
        return None
    times = sorted(set.intersection(*(set(states) for states in files.values())))
    if not times:
        raise damaged(folder / LIST, "lists no time at which all bodies have a state")
    chosen = chosen_times(times, most_states)
    if also is not None:
        chosen = sorted({*chosen, min(times, key=lambda time: abs(time - also))})
    grids = {name: State(states[times[0]].path).grid() for name, states in files.items()}
    surfaces = {name: surface_of(grid) for name, grid in grids.items()}
    total = sum(len(surface.nodes) for surface in surfaces.values())
    bodies = []
    for name, grid in grids.items():
        surface = surfaces[name]
        if most_nodes is not None and total > most_nodes:
            points = [tuple(grid.points[3 * node: 3 * node + 3]) for node in surface.nodes]
            share = max(60, most_nodes * len(points) // total)
            surface = clustered(surface, points, share)
        bodies.append(MovingBody(name, grid, surface))
    flat = max(body.surface.dimension for body in bodies) <= 1
    shades = BARS if flat else SOLID
    for body in bodies:
        for time in chosen:
            body.add(State(files[body.name][time].path), shades)
    dimension = dimension_of(bodies, flat)
    if flat:
        raise_strips(bodies)
    kept = sum(len(body.surface.nodes) for body in bodies)
    return Motion(chosen, bodies, dimension, shades, len(times), kept < total)


def dimension_of(bodies: list[MovingBody], flat: bool) -> int:
    if flat:
        return 1
    low, high = box_of(bodies)
    return 3 if high[2] - low[2] > 1e-9 * max(high[0] - low[0], high[1] - low[1]) else 2


def raise_strips(bodies: list[MovingBody]) -> None:
    half = strip_height(bodies)
    for body in bodies:
        reach = half * (1.0 if body.surface.dimension == 1 else 2.0)
        body.rest = [(x, y + side * reach, z)
                     for (x, y, z), side in zip(body.rest, body.surface.side)]
