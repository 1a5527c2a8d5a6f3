"""A user's Body with what the contract wants beside it: ports in their order, arrays in one shape,
the state as one thing."""

import math

import numpy as np
import xxhash

from abut.body import Body, Energy, packed, unpacked
from abut.errors import InputError
from abut.v1 import subdomain_pb2 as pb

OWN = 8  # bytes of the length that stands before the user's part of a kept state


def one_number(given, what: str, meaning: str) -> float:
    """Of a number, or of an array that holds one and nothing else."""
    try:
        value = np.asarray(given, float)
    except (TypeError, ValueError):
        value = None
    if value is None or value.size != 1:
        gives = "what is no number" if value is None else f"{value.size} numbers"
        raise InputError(f"gives {gives} where one is meant: {meaning}", what, "Give one number.")
    return value.item()


class Served:
    """Motion and force of all ports are arrays (points x dim) by port, whatever shape the user's
    body has them in."""

    def __init__(self, body):
        self.body = body
        surface = body.surface()
        self.several = isinstance(surface, dict)
        self.ports = list(surface.items()) if self.several else [("face", surface)]
        for name, each in self.ports:
            if each.dim != body.dim:
                raise InputError(f"port {name} has {each.dim} dimensions, the body {body.dim}",
                                 "surface()", "Set dim of the body.")
        if not (body.mass > 0.0 or (body.quasi_static and body.mass == 0.0)):
            raise InputError(f"mass is {body.mass}", type(body).__name__,
                             "Set mass [kg] in __init__; infinity: nothing moves it.")
        self.force = [np.zeros(self.width(p)) for p in range(len(self.ports))]  # of the last step
        self.acceleration = [np.zeros(self.width(p)) for p in range(len(self.ports))]
        self.rate = [np.zeros(self.width(p)) for p in range(len(self.ports))]  # way over time
        self.displacement()  # in the shape of the ports, or said so
        self.saved, self.initial = None, self.snapshot()
        self.known_compliance = None, None  # what was asked last for it, and the answer

    def width(self, port: int) -> int:
        return self.ports[port][1].points.size

    def support(self) -> int:
        """How it takes forces: constant over a step, or without inertia those of instants."""
        return (pb.FORCE_SUPPORT_NODAL if self.body.quasi_static else pb.FORCE_SUPPORT_STEP)

    # ---- motion

    def step(self, dt: float, forces):
        """Advances by dt; returns the energy that came through each port [J]."""
        before, speed = self.displacement(), self.velocity()
        brought = self.body.step(dt, self._shaped(forces))
        acting = forces
        if self.body.quasi_static:  # whose force grows with the way
            acting = [(last + now) / 2.0 for last, now in zip(self.force, forces)]
        self.force = [force.copy() for force in forces]
        ways = [now - last for now, last in zip(self.displacement(), before)]
        self.rate = [way / dt for way in ways]
        self.acceleration = [(now - last) / dt for now, last in zip(self.velocity(), speed)]
        if brought is None:
            return [float(force @ way) for force, way in zip(acting, ways)]
        return [one_number(work, "step()", "the energy [J] that came through a port")
                for work in self._by_port(brought)]

    def _by_port(self, brought):
        names = [name for name, _ in self.ports]
        if not self.several:
            return [brought]
        if not isinstance(brought, dict) or not set(names) <= set(brought):
            raise InputError("gives no dict with the energy [J] of every port", "step()",
                             f"Give one with {', '.join(names)}, or None.")
        return [brought[name] for name in names]

    def displacement(self):
        return self._flat(self.body.displacement(), "displacement()")

    def velocity(self):
        if self.body.quasi_static and type(self.body).velocity is Body.velocity:
            return [rate.copy() for rate in self.rate]
        return self._flat(self.body.velocity(), "velocity()")

    def _shaped(self, values):
        def one(port, value):
            surface = self.ports[port][1]
            return float(value[0]) if surface.dim == 1 else value.reshape(surface.points.shape)
        if not self.several:
            return one(0, values[0])
        return {name: one(p, values[p]) for p, (name, _) in enumerate(self.ports)}

    def _flat(self, values, what: str):
        flat = []
        for port, (name, surface) in enumerate(self.ports):
            given = values[name] if self.several else values
            value = np.array(given, float).ravel()
            if value.size != self.width(port):
                numbers = "1 number" if value.size == 1 else f"{value.size} numbers"
                raise InputError(f"has {numbers} at port {name}, not "
                                 f"{self.width(port)}", what,
                                 f"Give {surface.count} points of {surface.dim}.")
            flat.append(value)
        return flat

    def tell_record(self, to, time: float):
        """Energy and momentum, now."""
        energy = Energy(*(one_number(each, "energy()", "an energy [J]")
                          for each in self.body.energy()))
        to.time, to.kinetic, to.stored = time, energy.kinetic, energy.stored
        to.dissipated, to.external_work = energy.dissipated, energy.external_work
        if not math.isinf(self.body.mass):
            to.momentum.extend(np.ravel(self.body.momentum()).tolist())

    # ---- state

    def snapshot(self):
        own = [[each.copy() for each in values]
               for values in (self.force, self.acceleration, self.rate)]
        return self.body.save(), own

    def return_to(self, snapshot):
        users, own = snapshot
        self.body.restore(users)
        self.force, self.acceleration, self.rate = ([each.copy() for each in values]
                                                    for values in own)

    def to_bytes(self) -> bytes:
        users, own = self.snapshot()
        names = ("force", "acceleration", "rate")
        told = packed({f"{name} {p}": value for name, values in zip(names, own)
                       for p, value in enumerate(values)})
        return len(told).to_bytes(OWN, "little") + told + self.body.to_bytes(users)

    def from_bytes(self, data: bytes):
        length = int.from_bytes(data[:OWN], "little")
        told = unpacked(data[OWN:OWN + length])
        own = [[told[f"{name} {p}"] for p in range(len(self.ports))]
               for name in ("force", "acceleration", "rate")]
        self.return_to((self.body.from_bytes(data[OWN + length:]), own))

    def hash(self) -> int:
        return xxhash.xxh3_64_intdigest(self.to_bytes())
