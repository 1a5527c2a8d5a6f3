#!/usr/bin/python3
"""A solid in space as a body of abut: a brick whose whole surface may touch others.
usage: brick.py --connect ENDPOINT --body NAME      (README.md beside this file)"""

import itertools

import numpy as np

from abut import Body, Energy, Surface, serve

# Corners of a cell in VTK's order, and its six sides, counterclockwise from outside.
CORNERS = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0),
                    (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)])
SIDES = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (2, 3, 7, 6), (0, 4, 7, 3), (1, 2, 6, 5)]


class Brick(Body):
    """Eight-node cells, linear elastic, central difference."""

    dim, model = 3, "brick of eight-node cells, in Python"
    state = ("u", "v")
    conserves = linear = True

    def __init__(self, keys):
        self.lengths, self.cells = np.array(keys["lengths"], float), tuple(keys["cells"])
        self.corner, self.substep = np.array(keys["corner"], float), keys.positive("step", "s")
        modulus, ratio = keys.positive("youngs_modulus", "Pa"), keys.number("poissons_ratio")
        self.make_mesh()
        self.mass = keys.positive("density", "kg/m^3") * float(np.prod(self.lengths))
        self.stiffness = self.stiffness_of_a_cell(modulus, ratio)
        self.masses = np.zeros((len(self.points), 1))
        np.add.at(self.masses, self.hexes.ravel(), self.mass / self.hexes.size)
        self.u = np.zeros_like(self.points)
        self.v = np.tile(np.array(keys["velocity"], float), (len(self.points), 1))

    def make_mesh(self):
        counts = np.array(self.cells) + 1
        steps = np.array(list(np.ndindex(*counts)))
        self.points = self.corner + steps * self.lengths / self.cells
        at = [cell + CORNERS for cell in np.ndindex(*self.cells)]
        self.hexes = np.ravel_multi_index(np.moveaxis(np.array(at), -1, 0), counts)
        sides = [tuple(cell[list(side)]) for cell in self.hexes for side in SIDES]
        seen = [tuple(sorted(side)) for side in sides]
        once = [side for side, key in zip(sides, seen) if seen.count(key) == 1]
        self.skin = np.unique(once)  # nodes of the surface
        self.facets = [tuple(np.searchsorted(self.skin, side)) for side in once]

    def stiffness_of_a_cell(self, modulus: float, ratio: float):
        size = self.lengths / self.cells
        lame = modulus * ratio / ((1 + ratio) * (1 - 2 * ratio))
        shear = modulus / (2 * (1 + ratio))
        law = np.diag([2 * shear] * 3 + [shear] * 3)
        law[:3, :3] += lame
        cell, signs = np.zeros((24, 24)), 2.0 * CORNERS - 1.0
        for gauss in itertools.product((-(3**-0.5), 3**-0.5), repeat=3):
            line = 1.0 + signs * gauss
            strain = np.zeros((6, 24))
            for axis in range(3):
                others = [k for k in range(3) if k != axis]
                slope = signs[:, axis] * np.prod(line[:, others], axis=1) / (4 * size[axis])
                strain[axis, axis::3] = slope
                for row, (a, b) in enumerate(((0, 1), (1, 2), (2, 0)), start=3):
                    if axis in (a, b):
                        strain[row, (b if axis == a else a)::3] += slope
            cell += strain.T @ law @ strain * np.prod(size) / 8
        return cell

    def pulled(self, u):
        """[N] (nodes, 3) of the springs, against displacements."""
        of_cells = u[self.hexes].reshape(len(self.hexes), 24) @ self.stiffness
        f = np.zeros_like(u)
        np.add.at(f, self.hexes.ravel(), of_cells.reshape(-1, 3))
        return f

    def surface(self):
        return Surface(self.points[self.skin], self.facets)

    def step(self, dt, force):
        self.v = self.v + dt / 2 * self.acceleration(force)
        self.u = self.u + dt * self.v
        self.v = self.v + dt / 2 * self.acceleration(force)

    def acceleration(self, force):
        f = -self.pulled(self.u)
        f[self.skin] += force
        return f / self.masses

    def displacement(self):
        return self.u[self.skin]

    def velocity(self):
        return self.v[self.skin]

    def energy(self):
        """What central differences conserve: velocities before and after a level, multiplied."""
        pull = self.pulled(self.u)
        change = self.substep / 2 * pull / self.masses
        return Energy(0.5 * float(np.sum(self.masses * (self.v**2 - change**2))),
                      0.5 * float(np.sum(self.u * pull)))

    def momentum(self):
        return np.sum(self.masses * self.v, axis=0)

    def grid(self):
        return self.points, [(12, each) for each in self.hexes]  # 12: VTK's hexahedron

    def node_fields(self):
        return {"displacement": self.u, "velocity": self.v}


if __name__ == "__main__":
    serve(Brick)
