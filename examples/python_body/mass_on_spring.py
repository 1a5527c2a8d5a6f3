#!/usr/bin/python3
"""A mass on a spring as a body of abut.
usage: mass_on_spring.py --connect ENDPOINT --body NAME      (README.md beside this file)"""

from math import cos, hypot, sin, sqrt

from abut import Body, Energy, Point, serve


class Mass(Body):
    """Turns on its spring, exactly, about where the force of a substep holds it."""

    model, state, conserves, linear = "mass on a spring, in Python", ("u", "v"), True, True

    def __init__(self, keys):
        self.mass, self.stiffness = keys.positive("mass", "kg"), keys.positive("stiffness", "N/m")
        self.position, self.substep = keys.number("position", "m"), keys.positive("step", "s")
        self.omega, self.u, self.v = sqrt(self.stiffness / self.mass), 0.0, 0.0

    def surface(self):
        return Point(self.position, normal=-1.0)

    def step(self, dt, force):
        rest, c, s = force / self.stiffness, cos(self.omega * dt), sin(self.omega * dt)
        away = self.u - rest
        self.u, self.v = (rest + c * away + s * self.v / self.omega,
                          c * self.v - s * self.omega * away)

    def energy(self):
        return Energy(0.5 * self.mass * self.v**2, 0.5 * self.stiffness * self.u**2)

    def speed_bound(self):
        return hypot(self.v, self.omega * self.u)


if __name__ == "__main__":
    serve(Mass)
