"""What a body is: the class that a solver of one's own subclasses."""

import io
import math
from typing import NamedTuple

import numpy as np

from abut.errors import InputError


class Energy(NamedTuple):
    """[J], of the whole body, in the form that its scheme conserves."""

    kinetic: float
    stored: float = 0.0
    dissipated: float = 0.0
    external_work: float = 0.0  # done by loads and supports that the scene knows nothing of


class Body:
    """Subclass it; write __init__, surface and step, and name what changes in `state`.

    The order of calls, in a run:

        __init__(keys)         once; keys are those below model.external of the scene
        surface()              once; places and facets of the ports
        kernel(...)            before contact: how the ports give way; by default found by trying
        then for every window, as often as the coordinator wants:
            save()             the state at the window's begin
            step(dt, force)    for every substep, the last of which ends on the window's end
              displacement(), velocity()                   after every one
            energy(), momentum(), speed_bound()            at the ends of records
            restore(saved)     the same window comes again with other forces, many times
        grid(), node_fields(), cell_fields()               where the scene has output.fields

    What step() does must follow from the state and the arguments alone: a window that is repeated
    with the same forces ends in the same bits.
    """

    dim = 1                 # of space: 1, 2 or 3
    model = ""              # one line for people; empty: the name of the class
    mass = math.nan         # [kg]; infinity: nothing moves it
    substep = 0.0           # [s] wanted length of a step; 0: one step takes a record's time
    stable_step = math.inf  # [s] limit of the step; infinity: none
    state = ()              # names of the attributes, numbers or arrays, that steps change
    conserves = False       # its energy changes by forces on ports and external work alone
    linear = False          # it answers forces linearly
    quasi_static = False    # it has no inertia: forces and springs balance after every step
    surface_mass = None     # [kg] least mass that moves with a point of a port; bounds its speed

    def surface(self):
        """A Point, a Surface, or several by their names: {"left": ..., "right": ...}. One alone
        is the port `face`."""
        raise NotImplementedError("a body says what its surface() is")

    def step(self, dt: float, force):
        """Advances the state by dt [s] under a force on the port's points [N], which is constant
        meanwhile; of a quasi-static body it is the force at the step's end. It is a number for a
        Point, an array (n, dim) for a Surface, a dict of these for several ports. May return the
        energy [J] that the force has brought (a dict for several ports); by default that is force
        times way."""
        raise NotImplementedError("a body can step()")

    def displacement(self):
        """[m] of the port's points from the reference configuration, shaped as force is."""
        return self.u

    def velocity(self):
        """[m/s], as displacement. Of a quasi-static body by default way over time of a step."""
        return self.v

    def energy(self) -> Energy:
        """By default of a body that moves as its first port does, all in one piece."""
        return Energy(0.0 if self.quasi_static or math.isinf(self.mass) else
                      0.5 * self.mass * float(np.sum(self._mean_velocity() ** 2)))

    def momentum(self):
        """[kg m/s] (dim); by default as energy."""
        if self.quasi_static or math.isinf(self.mass):
            return np.zeros(self.dim)
        return self.mass * self._mean_velocity()

    def _mean_velocity(self):
        v = self.velocity()
        first = next(iter(v.values())) if isinstance(v, dict) else v
        return np.reshape(np.asarray(first, float), (-1, self.dim)).mean(axis=0)

    def speed_bound(self) -> float:
        """[m/s] how fast a point of a port may come, from now on, while nothing touches the body.
        By default all energy in surface_mass; where that is not told it is infinity, and windows
        of free flight are then taken one by one."""
        if self.surface_mass is None or self.quasi_static:
            return math.inf
        energy = Energy(*self.energy())
        return math.sqrt(2.0 * max(0.0, energy.kinetic + energy.stored) / self.surface_mass)

    def acceleration_bound(self) -> float:
        """[m/s^2] by which loads of the body's own may raise that speed per second."""
        return 0.0

    def save(self):
        """All that steps change; by default copies of the attributes that `state` names."""
        return {name: np.array(getattr(self, name), copy=True) for name in self.state}

    def restore(self, saved):
        """Back to what save() gave, exactly; it may be wanted again."""
        for name, value in saved.items():
            setattr(self, name, value.item() if value.ndim == 0 else value.copy())

    def to_bytes(self, saved) -> bytes:
        """What save() gave, to be kept in a file; the same bytes for the same state."""
        return packed(saved)

    def from_bytes(self, data: bytes):
        return unpacked(data)

    def rest(self):
        """The state from which kernels are found: by default, where the body is at its begin."""

    def kernel(self, port: str, patterns, step: float, count: int):
        """[m] (count, patterns, n, dim): what forces [N] (patterns, n, dim) over the first of
        `count` steps of this length do to the port, at the end of each. None: found by trying."""
        return None

    def grid(self):
        """What is drawn of the body: points [m] (n, dim) and a list of cells, each a pair of VTK's
        number of its kind and its points. None: the surfaces of the ports."""
        return None

    def node_fields(self) -> dict:
        """Values on the points of grid() by name: (n), (n, 3) or (n, 6). By default displacement
        and velocity of the surfaces of the ports."""
        return {}

    def cell_fields(self) -> dict:
        """The same on its cells."""
        return {}


def packed(values: dict) -> bytes:
    """Names and arrays as bytes, the same for the same values; nothing but numbers."""
    out = io.BytesIO()
    for name in sorted(values):
        value = np.asarray(values[name])
        if value.dtype.kind not in "biuf":
            raise InputError(f"{name} holds no numbers", "state",
                             "Name numbers and arrays alone, or write save() and restore().")
        np.lib.format.write_array(out, np.array(list(name.encode()), np.uint8))
        np.lib.format.write_array(out, value, allow_pickle=False)
    return out.getvalue()


def unpacked(data: bytes) -> dict:
    values, source = {}, io.BytesIO(data)
    while source.tell() < len(data):
        name = np.lib.format.read_array(source, allow_pickle=False).tobytes().decode()
        values[name] = np.lib.format.read_array(source, allow_pickle=False)
    return values
