#!/usr/bin/python3
"""The plate of examples/python_body, made to break one clause of the contract: WRONG_BODY, of the
environment, says how; `nothing` breaks none. usage: wrong_body.py --connect ENDPOINT --body NAME"""

import os
import pathlib
import time

import numpy as np

from abut import Body, Energy, NotConverged, Point, Surface
from abut import answers, probing, served, serve, server, window
from abut.v1 import subdomain_pb2 as pb

STEPS_THAT_END_WELL = 40  # of a body that is lost afterwards: some clauses are kept before


def plate():
    """The class of examples/python_body/my_body.py, wherever that is."""
    folder = pathlib.Path(__file__).resolve().parents[2] / "examples" / "python_body"
    text = (folder / "my_body.py").read_text(encoding="utf-8")
    scope = {"__name__": "my_body"}
    exec(compile(text, "my_body.py", "exec"), scope)  # noqa: S102, it is a part of this project
    return scope["Plate"]


class Keys:
    """Of a small plate: mesh and material are not what is on trial."""

    values = {"lengths": [0.3, 0.2], "cells": [3, 2], "corner": [0.0, 0.0], "step": 1.0e-5,
              "youngs_modulus": 1.0e9, "poissons_ratio": 0.3, "density": 1000.0,
              "velocity": [0.0, 0.0]}

    def __getitem__(self, name):
        return self.values[name]

    def positive(self, name, unit=""):
        return self.values[name]

    number = positive


class Wrong(plate()):
    """What is wrong with it, the functions below say."""

    def __init__(self, _):
        super().__init__(Keys())
        self.used = 0
        BODIES.get(WRONG, nothing)(self)

    def open_surface(self, turned: bool):
        points = self.points[self.rim]
        facets = [(k + 1, k) if turned else (k, k + 1) for k in range(self.cells[0])]
        return Surface(points[:self.cells[0] + 1], facets)


class Line(Body):
    """A mass in one dimension whose grid says where it lies: right of its point."""

    state = ("u", "v")
    conserves = linear = True
    mass, substep, u, v = 0.2, 4.0e-6, 0.0, 0.0

    def __init__(self, _):
        pass

    def surface(self):
        return Point(0.0, normal=1.0 if WRONG == "looks_inward_on_a_line" else -1.0)

    def step(self, dt, force):
        before = self.v
        self.v += dt * force / self.mass
        self.u += dt * (before + self.v) / 2.0

    def grid(self):
        return np.array([[0.0], [1.0]]), [(3, (0, 1))]  # 3: VTK's line

    def node_fields(self):
        return {"height": np.zeros((2, 1))}


def replace(owner, name: str, make):
    """The attribute becomes make(what it was)."""
    setattr(owner, name, make(getattr(owner, name)))


# ---- what a body can get wrong -------------------------------------------------------------------

def ends_early(_):
    replace(window.Window, "time", lambda right: lambda self, i:
            right(self, i) - (1.0e-9 if self.steps and i == self.steps else 0.0))


def takes_long_steps(body):
    def init(right):
        def longer(self, *given):
            body.substep *= 2.0
            right(self, *given)
            body.substep /= 2.0
        return longer
    body.substep /= 2.0
    replace(window.Window, "__init__", init)


def looks_inward(body):
    body.surface = lambda: body.open_surface(turned=True)
    body.displacement = lambda: body.u[body.rim][:body.cells[0] + 1]
    body.velocity = lambda: body.v[body.rim][:body.cells[0] + 1]

    def acceleration(force):
        f = -(body.stiffness @ body.u.ravel()).reshape(-1, 2)
        f[body.rim[:body.cells[0] + 1]] += force
        return f / body.masses
    body.acceleration = acceleration


def slows_down_by_windows(body):
    def advance(right):
        def slower(self, reply):
            if self.steps:
                body.v = body.v * (1.0 - 1.0e-3)
            right(self, reply)
        return slower
    replace(window.Window, "advance", advance)


def moves_in_no_time(body):
    def advance(right):
        def moved(self, reply):
            if not self.steps:
                body.u = body.u + 1.0e-9
            right(self, reply)
        return moved
    replace(window.Window, "advance", advance)


def ignores_the_length_of_steps(body):
    body.step = lambda _, force: Wrong.step(body, body.substep, force)


def ignores_it_and_tells_what_it_would_be(body):
    """Its velocity is way over the time that was asked for."""
    body.state, body.gone = (*body.state, "gone"), 0.0 * body.v

    def step(dt, force):
        before = body.u
        Wrong.step(body, body.substep, force)
        body.gone = (body.u - before) / dt
    body.step = step
    body.velocity = lambda: body.gone[body.rim]


def tells_speeds_backwards(body):
    body.velocity = lambda: -body.v[body.rim]


def tells_no_speeds(body):
    body.velocity = lambda: 0.0 * body.v[body.rim]


def tells_points_in_another_order(body):
    body.displacement = lambda: body.u[body.rim][::-1]
    body.velocity = lambda: body.v[body.rim][::-1]


def presses_on_neighbours(body):
    body.step = lambda dt, force: Wrong.step(body, dt, np.roll(force, 1, axis=0))


def presses_on_neighbours_and_is_damped(body):
    """It does not conserve: no energy tells it."""
    body.conserves = False
    presses_on_neighbours(body)


def is_lost_in_numbers(body):
    def step(dt, force):
        body.used += 1
        Wrong.step(body, dt, force)
        if body.used > STEPS_THAT_END_WELL:
            body.u = body.u * np.nan
    body.step = step


def converges_never(body):
    def step(*_):
        raise NotConverged("no step converges")
    body.step = step


def remembers(body):
    def step(dt, force):
        body.used += 1
        Wrong.step(body, dt, force * (1.0 + 1.0e-11 * body.used))
    body.step = step


def has_one_hash(_):
    served.Served.hash = lambda self: 1


def tells_small_boxes(_):
    def end_record(self):
        at = self.points + self.u[-1].reshape(self.points.shape)
        self.lower.append(at.min(axis=0))
        self.upper.append(at.max(axis=0))
        self.low = self.high = None
    window.Track.end_record = end_record


def bounds_too_low(body):
    body.speed_bound = lambda: 0.9 * float(np.max(np.linalg.norm(body.v[body.rim], axis=1)))

    def fill(right):
        def without(self, reply):
            right(self, reply)
            for port in reply.ports:
                del port.slowest[:], port.fastest[:]
        return without
    replace(window.Window, "fill", fill)


def tells_small_velocities(_):
    replace(window.Track, "go", lambda right: lambda self, rate: right(self, 0.9 * rate))


def loses_momentum(body):
    body.momentum = lambda: 0.9 * Wrong.momentum(body)


def takes_one_partner(_):
    replace(window, "impulses", lambda right: lambda waves, times, width:
            right(waves[:1], times, width))


def takes_all_forces_as_nodal(_):
    def nodal(right):
        def impulses(waves, times, width):
            for wave in waves:
                wave.support = pb.FORCE_SUPPORT_NODAL
            return right(waves, times, width)
        return impulses
    replace(window, "impulses", nodal)


def tells_double_work(body):
    def step(dt, force):
        before = body.displacement()
        Wrong.step(body, dt, force)
        return 2.0 * float(np.sum(force * (body.displacement() - before)))
    body.step = step


def tells_half_the_energy(body):
    body.energy = lambda: Energy(0.5 * Wrong.energy(body).kinetic, 0.5 * Wrong.energy(body).stored)


def tells_no_stored_energy(body):
    body.energy = lambda: Energy(Wrong.energy(body).kinetic)


def has_a_soft_kernel(body):
    def kernel(_, patterns, step, count):
        ask = pb.Probe(port=0, step=step, count=count, patterns=patterns.ravel())
        return 1.1 * probing.found_by_trying(body.served, ask, patterns.reshape(len(patterns), -1),
                                             [0])
    body.kernel = kernel
    replace(served.Served, "__init__", lambda right: lambda self, own:
            (setattr(own, "served", self), right(self, own))[1])


def moves_by_probes(body):
    def kernel(*_):
        body.u = body.u + 1.0e-9
    body.kernel = kernel


def keeps_half(body):
    def from_bytes(data):
        saved = Wrong.from_bytes(body, data)
        return {"u": saved["u"], "v": 0.5 * saved["v"]}
    body.from_bytes = from_bytes


# ---- what a solver can get wrong on the wire -----------------------------------------------------

def has_a_fixed_session():
    replace(server.Server, "__init__", lambda right: lambda self, *given:
            (right(self, *given), setattr(self, "session", 1))[1])


def reads_damaged_frames():
    def opened(right):
        def careless(self, frame):
            payload = frame[server.HEADER:]
            if frame[:server.HEADER] == server.header(payload):
                return right(self, frame)
            return pb.Request(number=self.executed + 1, session=self.session, ping=pb.Ping())
        return careless
    replace(server.Server, "opened", opened)


def reads_all_sessions():
    def opened(right):
        def careless(self, frame):
            if frame[:server.HEADER] == server.header(frame[server.HEADER:]):
                ask = pb.Request.FromString(frame[server.HEADER:])
                if not ask.HasField("refuse"):
                    ask.session = self.session
                    frame = server.sealed(ask)
            return right(self, frame)
        return careless
    replace(server.Server, "opened", opened)


def executes_again():
    def opened(right):
        def forgetful(self, frame):
            ask = right(self, frame)
            if ask is not None and ask.HasField("advance") and ask.number == self.executed:
                self.executed -= 1
            return ask
        return forgetful
    replace(server.Server, "opened", opened)


def overlooks_gaps():
    def execute(right):
        def tolerant(self, ask):
            self.executed = ask.number - 1
            right(self, ask)
        return tolerant
    replace(server.Server, "execute", execute)


def saves_before_it_restores():
    def answer(right):
        def reversed_order(self, ask, reply):
            if ask.save_first and ask.restore_first:
                self.served.saved, ask.save_first = self.served.snapshot(), False
            right(self, ask, reply)
        return reversed_order
    replace(answers.Answers, "answer", answer)


def answers_anything():
    def answer(right):
        def obliging(self, ask, reply):
            if ask.WhichOneof("body") is None:
                reply.pong.SetInParent()
            else:
                right(self, ask, reply)
        return obliging
    replace(answers.Answers, "answer", answer)


def takes_anything():
    answers.require_sound = lambda *_: None


def is_silent():
    server.Server.alive = lambda self: None


def stays():
    replace(server.Server, "run", lambda right: lambda self: (right(self), time.sleep(30.0)))


def overlooks_refusal():
    def opened(right):
        def deaf(self, frame):
            try:
                return right(self, frame)
            except SystemExit:
                return None
        return deaf
    replace(server.Server, "opened", opened)


def overlooks_loss():
    def execute(right):
        def without(self, ask):
            self.lost = type("Quiet", (), {"poll": lambda *_: 0})()
            right(self, ask)
        return without
    replace(server.Server, "execute", execute)


def nothing(_):
    pass


def looks_inward_on_a_line(_):
    """Of Line, which knows."""


def nothing_on_a_line(_):
    """Of Line."""


BODIES = {each.__name__: each for each in (
    ends_early, takes_long_steps, looks_inward, slows_down_by_windows, moves_in_no_time,
    ignores_the_length_of_steps, ignores_it_and_tells_what_it_would_be, tells_speeds_backwards,
    tells_no_speeds, tells_points_in_another_order, presses_on_neighbours,
    presses_on_neighbours_and_is_damped, is_lost_in_numbers, converges_never, remembers,
    has_one_hash, tells_small_boxes, bounds_too_low, tells_small_velocities, loses_momentum,
    takes_one_partner, takes_all_forces_as_nodal, tells_double_work, tells_half_the_energy,
    tells_no_stored_energy, has_a_soft_kernel, moves_by_probes, keeps_half)}
LINES = {each.__name__: each for each in (looks_inward_on_a_line, nothing_on_a_line)}
SOLVERS = {each.__name__: each for each in (
    has_a_fixed_session, reads_damaged_frames, reads_all_sessions, executes_again, overlooks_gaps,
    saves_before_it_restores, answers_anything, takes_anything, is_silent, stays,
    overlooks_refusal, overlooks_loss)}
WRONG = os.environ["WRONG_BODY"]


if __name__ == "__main__":
    if WRONG not in BODIES | LINES | SOLVERS | {"nothing": nothing}:
        raise SystemExit(f"nothing is called {WRONG}")
    SOLVERS.get(WRONG, lambda: None)()
    serve(Line if WRONG in LINES else Wrong)
