"""Advances a body through a window, and tells of it: traces, boxes, bounds, records."""

import math

import numpy as np

from abut.errors import NotConverged
from abut.forces import impulses, values
from abut.served import one_number
from abut.v1 import subdomain_pb2 as pb

ROUNDING = 1.0e-6  # of a step: less than this is no step of its own
LARGEST = 1.0e150  # whose square is still a number


class Failure(Exception):
    """The window could not be advanced: a cause and a time for the reply."""

    def __init__(self, cause: int, time: float, detail: str):
        super().__init__(detail)
        self.cause, self.time, self.detail = cause, time, detail


class Track:
    """What one port has done so far in the window."""

    def __init__(self, points, dim: int):
        self.points, self.dim = points, dim
        self.times, self.u, self.v, self.a, self.f = [], [], [], [], []
        self.low = self.high = None          # of the record under way
        self.lower, self.upper = [], []
        self.slowest = np.full(dim, math.inf)
        self.fastest = np.full(dim, -math.inf)
        self.work = 0.0

    def tell(self, time: float, u, v, a, f):
        self.times.append(time)
        for values, value in ((self.u, u), (self.v, v), (self.a, a), (self.f, f)):
            values.append(value)

    def sweep(self, u):
        at = self.points + u.reshape(self.points.shape)
        low, high = at.min(axis=0), at.max(axis=0)
        self.low = low if self.low is None else np.minimum(self.low, low)
        self.high = high if self.high is None else np.maximum(self.high, high)

    def go(self, rate):
        rate = rate.reshape(self.points.shape)
        self.slowest = np.minimum(self.slowest, rate.min(axis=0))
        self.fastest = np.maximum(self.fastest, rate.max(axis=0))

    def end_record(self):
        self.lower.append(self.low)
        self.upper.append(self.high)
        self.low = self.high = None


class Window:
    """One request to advance."""

    def __init__(self, served, ask, alive):
        self.served, self.ask, self.alive = served, ask, alive
        self.begin, self.end = ask.window.begin, ask.window.end
        self.records = max(1, ask.records)
        self.tracks = [Track(surface.points, surface.dim) for _, surface in served.ports]
        length = self.end - self.begin
        nominal = served.body.substep
        each = length / self.records
        self.per_record = 0
        if length > 0.0:
            count = each / nominal if nominal > 0.0 else 1.0
            self.per_record = max(1, math.ceil(count - ROUNDING))
        self.steps = self.per_record * self.records
        self.dt = length / self.steps if self.steps else 0.0
        if abs(self.dt - nominal) <= ROUNDING * nominal:
            self.dt = nominal  # to the last bit, so that what was made for it is used again

    def time(self, i: int) -> float:
        share = i * (self.end - self.begin) / max(1, self.steps)
        return self.end if i == self.steps else self.begin + share

    def advance(self, reply):
        times = [self.time(i) for i in range(self.steps + 1)]
        pushed = self.pushed(times) if self.steps else []
        self.tell(self.begin)
        for record in range(1, self.records + 1):
            self.sweep()
            for i in range((record - 1) * self.per_record + 1, record * self.per_record + 1):
                self.substep(times[i], [force[i - 1] for force in pushed])
                if (self.ask.sampling == pb.SAMPLING_SUBSTEPS or i == record * self.per_record):
                    self.tell(times[i])
            self.tell_record(reply, record)
        self.fill(reply)

    def pushed(self, times):
        """[N] (steps, values) on every port: the mean of a step, so that impulses are exact; of a
        body without inertia the force at its end."""
        every = [(p, boundary.forces) for p, boundary in enumerate(self.ask.boundary)]
        if self.served.body.quasi_static:
            return [values(forces, times, self.served.width(p)) for p, forces in every]
        return [impulses(forces, times, self.served.width(p)) / self.dt for p, forces in every]

    def substep(self, time: float, forces):
        try:
            works = self.served.step(self.dt, forces)
        except NotConverged as error:
            raise Failure(pb.FAILURE_CAUSE_NO_CONVERGENCE, time, str(error)) from error
        for track, work, u, rate in zip(self.tracks, works, self.served.displacement(),
                                        self.served.rate):
            if not np.all(np.abs(u) < LARGEST):
                raise Failure(pb.FAILURE_CAUSE_NON_FINITE, time, "a displacement is no number")
            track.work += work
            track.go(rate)
        self.sweep()
        self.alive()

    def sweep(self):
        for track, u in zip(self.tracks, self.served.displacement()):
            track.sweep(u)

    def tell(self, time: float):
        served = self.served
        for track, *values in zip(self.tracks, served.displacement(), served.velocity(),
                                  served.acceleration, served.force):
            track.tell(time, *values)

    def tell_record(self, reply, record: int):
        length = self.end - self.begin
        self.served.tell_record(reply.records.add(), self.end if record == self.records else
                                self.begin + record * length / self.records)
        for track in self.tracks:
            track.end_record()

    def fill(self, reply):
        body = self.served.body
        bound = one_number(body.speed_bound(), "speed_bound()", "a speed [m/s]")
        rise = one_number(body.acceleration_bound(), "acceleration_bound()", "a rise [m/s^2]")
        for p, track in enumerate(self.tracks):
            port = reply.ports.add(work=track.work, speed_bound=bound, acceleration_bound=rise)
            port.lower.extend(np.concatenate(track.lower).tolist())
            port.upper.extend(np.concatenate(track.upper).tolist())
            if self.steps:
                port.slowest.extend(track.slowest.tolist())
                port.fastest.extend(track.fastest.tolist())
            self.fill_trace(port, track, self.ask.want[p] if self.ask.want else None)
        reply.steps = self.steps

    def fill_trace(self, port, track: Track, want):
        fields = [name for name in "uvaf" if want is None or getattr(want, name)]
        if not fields:
            return
        columns = slice(None)
        port.trace.support = self.served.support()
        if want is not None and want.points:
            port.trace.points.extend(want.points)
            listed = np.asarray(want.points)
            columns = (listed[:, None] * track.dim + np.arange(track.dim)).ravel()
        port.trace.time.extend(track.times)
        for name in fields:
            values = np.array(getattr(track, name))[:, columns]
            port.trace.width = values.shape[1]
            getattr(port.trace, name).extend(values.ravel().tolist())
