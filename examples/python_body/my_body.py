#!/usr/bin/python3
"""A solid in the plane as a body of abut: copy it and put your own solver in its place.
usage: my_body.py --connect ENDPOINT --body NAME      (README.md beside this file)

The order of calls, and which part of yours belongs where:

    __init__(keys)    read your keys, your mesh; build mass and stiffness; set the initial state
    surface()         the points and facets of your boundary that may touch others
    step(dt, force)   one step of your integrator; `force` [N] on the points of surface() is
                      constant in it. After it the state is at the step's end
    displacement(), velocity()    of the points of surface(), now
    energy(), momentum()          of the whole body, now
    save(), restore()             the attributes that `state` names: everything that step() changes!
                                  A window comes again with other forces until both bodies agree
    node_fields()                 what pictures show
"""

import numpy as np

from abut import Body, Energy, Surface, serve


class Plate(Body):
    """A rectangle of four-node cells in plane strain, central difference."""

    dim, model = 2, "plate of four-node cells, in Python"
    state = ("u", "v")
    conserves = linear = True

    def __init__(self, keys):
        self.lengths, self.cells = np.array(keys["lengths"], float), keys["cells"]
        self.corner = np.array(keys["corner"], float)
        self.substep = keys.positive("step", "s")
        modulus, ratio = keys.positive("youngs_modulus", "Pa"), keys.number("poissons_ratio")
        self.make_mesh()
        self.mass = keys.positive("density", "kg/m^3") * float(np.prod(self.lengths))
        self.make_matrices(modulus, ratio)
        self.u = np.zeros_like(self.points)
        self.v = np.tile(np.array(keys["velocity"], float), (len(self.points), 1))

    def make_mesh(self):
        nx, ny = self.cells
        x, y = np.meshgrid(np.arange(nx + 1), np.arange(ny + 1), indexing="ij")
        node = np.arange(x.size).reshape(x.shape)
        counts = np.column_stack([x.ravel(), y.ravel()])
        self.points = self.corner + counts * self.lengths / (nx, ny)
        self.quads = np.stack([node[:-1, :-1], node[1:, :-1], node[1:, 1:], node[:-1, 1:]],
                              axis=-1).reshape(-1, 4)
        # Once around with the body to the left: below, right, above, left.
        self.rim = np.concatenate([node[:-1, 0], node[-1, :-1], node[:0:-1, -1], node[0, :0:-1]])

    def make_matrices(self, modulus: float, ratio: float):
        size = self.lengths / self.cells
        lame = modulus * ratio / ((1 + ratio) * (1 - 2 * ratio))
        shear = modulus / (2 * (1 + ratio))
        law = np.array([[lame + 2 * shear, lame, 0], [lame, lame + 2 * shear, 0], [0, 0, shear]])
        cell = np.zeros((8, 8))  # of four points of Gauss
        for gx in (-1, 1):
            for gy in (-1, 1):
                xi, eta = gx / 3**0.5, gy / 3**0.5
                dx = np.array([eta - 1, 1 - eta, 1 + eta, -1 - eta]) / (2 * size[0])
                dy = np.array([xi - 1, -1 - xi, 1 + xi, 1 - xi]) / (2 * size[1])
                strain = np.zeros((3, 8))
                strain[0, 0::2], strain[1, 1::2] = dx, dy
                strain[2, 0::2], strain[2, 1::2] = dy, dx
                cell += strain.T @ law @ strain * np.prod(size) / 4
        count = len(self.points)
        self.stiffness, self.masses = np.zeros((2 * count, 2 * count)), np.zeros((count, 1))
        for quad in self.quads:
            dofs = np.repeat(2 * quad, 2) + np.tile([0, 1], 4)
            self.stiffness[np.ix_(dofs, dofs)] += cell
            self.masses[quad] += self.mass / len(self.quads) / 4

    def surface(self):
        count = len(self.rim)
        facets = [(k, (k + 1) % count) for k in range(count)]
        speed = (np.max(np.diag(self.stiffness)) / np.max(self.masses)) ** 0.5
        return Surface(self.points[self.rim], facets, transit=1.0 / speed)

    def step(self, dt, force):
        self.v = self.v + dt / 2 * self.acceleration(force)
        self.u = self.u + dt * self.v
        self.v = self.v + dt / 2 * self.acceleration(force)

    def acceleration(self, force):
        f = -(self.stiffness @ self.u.ravel()).reshape(-1, 2)
        f[self.rim] += force
        return f / self.masses

    def displacement(self):
        return self.u[self.rim]

    def velocity(self):
        return self.v[self.rim]

    def energy(self):
        u = self.u.ravel()
        return Energy(0.5 * float(np.sum(self.masses * self.v**2)), 0.5 * u @ self.stiffness @ u)

    def momentum(self):
        return np.sum(self.masses * self.v, axis=0)

    def grid(self):
        return self.points, [(9, quad) for quad in self.quads]  # 9: VTK's quadrilateral

    def node_fields(self):
        flat = np.zeros((len(self.points), 1))
        return {"displacement": np.hstack([self.u, flat]), "velocity": np.hstack([self.v, flat])}


if __name__ == "__main__":
    serve(Plate)
