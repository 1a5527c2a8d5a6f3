#!/usr/bin/python3
"""A bar in the plane as a body of abut; mesh, stiffness and mass are GetFEM's (python3-getfem).
usage: getfem_bar.py --connect ENDPOINT --body NAME      (README.md beside this file)"""

import getfem
import numpy as np

from abut import Body, Energy, Surface, serve


class Bar(Body):
    """Quadrilaterals in plane strain, lumped masses, central difference."""

    dim, model = 2, f"bar of GetFEM {getfem.getfem_env('version')}, central difference"
    state = ("u_all", "v_all")
    conserves = linear = True

    def __init__(self, keys):
        length, height = keys["lengths"]
        nx, ny = keys["cells"]
        self.substep, density = keys.positive("step"), keys.positive("density")
        modulus, ratio = keys.positive("youngs_modulus"), keys.number("poissons_ratio")
        x, y = keys["corner"]
        mesh = getfem.Mesh("cartesian", x + np.linspace(0.0, length, nx + 1),
                           y + np.linspace(0.0, height, ny + 1))
        self.fem = getfem.MeshFem(mesh, 2)
        self.fem.set_classical_fem(1)
        self.make_matrices(mesh, density, modulus, ratio)
        self.find_face(mesh, [-1.0, 0.0])
        self.mass = density * length * height  # [kg/m]
        self.u_all = np.zeros(self.fem.nbdof())
        self.v_all = np.tile(np.array(keys["velocity"], float), self.fem.nbdof() // 2)

    def make_matrices(self, mesh, density: float, modulus: float, ratio: float):
        integration = getfem.MeshIm(mesh, 3)
        constant = getfem.MeshFem(mesh, 1)
        constant.set_classical_fem(0)
        ones = np.ones(constant.nbdof())
        lame = modulus * ratio / ((1 + ratio) * (1 - 2 * ratio))
        self.k = getfem.asm_linear_elasticity(integration, self.fem, constant, lame * ones,
                                              modulus / (2 * (1 + ratio)) * ones)
        mass = getfem.asm_mass_matrix(integration, self.fem)
        self.masses = density * mass.mult(np.ones(self.fem.nbdof()))  # [kg/m], sums of rows

    def find_face(self, mesh, normal):
        """Nodes on the side that looks this way, and segments with the body to their left."""
        faces = mesh.outer_faces_with_direction(normal, 0.01)
        ends = [mesh.pid_in_faces(faces[:, [k]]) for k in range(faces.shape[1])]
        places = mesh.pts()
        ids = sorted({int(p) for pair in ends for p in pair}, key=lambda p: -places[1, p])
        self.points = places[:, ids].T  # from above down: the left side of the bar
        nodes = self.fem.basic_dof_nodes().T  # of every unknown: x and y one after the other
        self.dofs = np.array([np.flatnonzero(np.all(np.abs(nodes - p) < 1.0e-9, axis=1))
                              for p in self.points])

    def surface(self):
        return Surface(self.points, [(k, k + 1) for k in range(len(self.points) - 1)])

    def step(self, dt, force):
        push = np.zeros_like(self.u_all)
        push[self.dofs.ravel()] = force.ravel()
        self.v_all = self.v_all + dt / 2 * self.acceleration(push)
        self.u_all = self.u_all + dt * self.v_all
        self.v_all = self.v_all + dt / 2 * self.acceleration(push)

    def acceleration(self, push):
        return (push - self.k.mult(self.u_all)) / self.masses

    def displacement(self):
        return self.u_all[self.dofs]

    def velocity(self):
        return self.v_all[self.dofs]

    def energy(self):
        """What central differences conserve: velocities before and after a level, multiplied."""
        pull = self.k.mult(self.u_all)
        change = self.substep / 2 * pull / self.masses
        return Energy(0.5 * float(np.sum(self.masses * (self.v_all**2 - change**2))),
                      0.5 * float(self.u_all @ pull))

    def momentum(self):
        return np.sum((self.masses * self.v_all).reshape(-1, 2), axis=0)


if __name__ == "__main__":
    serve(Bar)
