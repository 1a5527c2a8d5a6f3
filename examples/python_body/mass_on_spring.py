#!/usr/bin/env python3
"""A mass on a spring as a body of abut. It needs the messages of abut/v1 and nothing else of abut.
usage: mass_on_spring.py --connect ENDPOINT --body NAME      (README.md beside this file)"""

import math

import body_server
import yaml
from abut.v1 import subdomain_pb2 as pb


class Mass:
    """Turns exactly on its spring; an impulse strikes in the middle of every substep."""

    def __init__(self, configure):
        if any(text.startswith(configure.path + ".model") for text in configure.overrides):
            raise ValueError("takes no --set; write its keys into the scene")
        keys = yaml.safe_load(configure.text)
        for key in [*configure.path.split("."), "model", "external"]:
            keys = keys[key]
        self.mass, self.stiffness, self.position, self.step = (
            float(keys[key]) for key in ("mass", "stiffness", "position", "step"))
        self.omega = math.sqrt(self.stiffness / self.mass)
        self.state = (0.0, 0.0, 0.0)  # u [m], v [m/s], force of the last substep [N]

    def describe(self, to):
        to.model, to.dim, to.dofs, to.conserves = "mass on a spring, in Python", 1, 1, True
        to.mass, to.step, to.stable_step = self.mass, self.step, math.inf
        to.can.force = to.can.kernel = True
        to.ports.add(name="face").surface.MergeFrom(
            pb.Surface(dim=1, points=[self.position], normals=[-1.0]))

    def probe(self, ask, to):
        """What a force over the first substep does, from rest: `count` substeps of the request's
        length. STEP says that the force is constant in it, as advance() takes forces."""
        to.step, to.support = ask.step, pb.FORCE_SUPPORT_STEP
        to.width, to.patterns = 1, len(ask.patterns)
        scale = ask.step / (self.mass * self.omega)
        to.displacement.extend(scale * force * math.sin((i + 0.5) * self.omega * ask.step)
                               for i in range(ask.count) for force in ask.patterns)

    def advance(self, ask, to):
        begin, length = ask.window.begin, ask.window.end - ask.window.begin
        per_record = max(1, round(length / self.step / ask.records)) if length > 0 else 0
        steps = per_record * ask.records
        forces = [piece for wave in ask.boundary[0].forces if wave.time for piece in pieces(wave)]
        port, now = to.ports.add(), begin
        port.trace.width, port.trace.support = 1, pb.FORCE_SUPPORT_STEP
        self.tell(port.trace, begin)
        for record in range(ask.records):
            swept = [self.state[0]]
            for i in range(record * per_record + 1, (record + 1) * per_record + 1):
                last, now = now, ask.window.end if i == steps else begin + length * i / steps
                port.work += self.substep(now - last, sum(
                    force * max(0.0, min(now, b) - max(last, a)) for a, b, force in forces))
                swept.append(self.state[0])
                if ask.sampling == pb.SAMPLING_SUBSTEPS or i == (record + 1) * per_record:
                    self.tell(port.trace, now)
            port.lower.append(self.position + min(swept))
            port.upper.append(self.position + max(swept))
            u, v, _ = self.state
            to.records.add(time=now, kinetic=0.5 * self.mass * v * v,
                           stored=0.5 * self.stiffness * u * u, momentum=[self.mass * v])
        port.speed_bound, to.steps = math.hypot(self.state[1], self.omega * self.state[0]), steps

    def substep(self, dt, impulse):
        """Answers the energy that the impulse has brought."""
        u, v = self.turned(self.state[0], self.state[1], dt / 2)
        struck = v + impulse / self.mass
        self.state = (*self.turned(u, struck, dt / 2), impulse / dt)
        return impulse * (v + struck) / 2

    def turned(self, u, v, time):
        c, s = math.cos(self.omega * time), math.sin(self.omega * time)
        return c * u + s * v / self.omega, c * v - s * self.omega * u

    def tell(self, trace, now):
        u, v, force = self.state
        a = (force - self.stiffness * u) / self.mass
        trace.MergeFrom(pb.Waveform(time=[now], u=[u], v=[v], a=[a], f=[force]))


def pieces(wave):
    """Pieces of time in which a force is constant: (begin, end, force)."""
    if wave.support == pb.FORCE_SUPPORT_STEP:
        return zip(wave.time, wave.time[1:], wave.f[1:])
    edges = [wave.time[0], *((a + b) / 2 for a, b in zip(wave.time, wave.time[1:])), wave.time[-1]]
    return zip(edges, edges[1:], wave.f)


if __name__ == "__main__":
    body_server.serve(Mass)
