#!/usr/bin/python3
"""A bar in space as a body of abut; every step is a run of CalculiX (calculix-ccx) by *RESTART.
usage: calculix_bar.py --connect ENDPOINT --body NAME      (README.md beside this file)"""

import itertools
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from abut import Body, Energy, InputError, NotConverged, Surface, serve

POINTS = 27  # of integration, for which CalculiX leaves room in every element
CORNERS = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))


def three(keys, name: str, above=-np.inf):
    """The values of a key along x, y and z."""
    values = keys[name]
    if not (isinstance(values, list) and len(values) == 3
            and all(isinstance(each, (int, float)) and each > above for each in values)):
        raise InputError("must be three numbers" + (" above 0" if above == 0.0 else ""),
                         keys.where(name), "Give one for each axis.")
    return np.array(values, float)


class Bar(Body):
    """C3D8 elements, *DYNAMIC by the trapezoidal rule (ALPHA=0), one increment in each run."""

    dim, model = 3, "bar of CalculiX, C3D8, trapezoidal rule"
    state = ("restart", "u_all", "v_all", "stored", "mises")  # bytes of the file; what it says
    conserves = linear = True

    def __init__(self, keys):
        if shutil.which("ccx") is None:
            raise InputError("there is no ccx", "CalculiX", "Debian: apt-get install calculix-ccx")
        self.lengths = three(keys, "lengths", 0.0)
        self.cells = three(keys, "cells", 0.0).astype(int)
        if np.any(self.cells != keys["cells"]):
            raise InputError("must be whole numbers", keys.where("cells"), "Give such.")
        self.law = keys.positive("youngs_modulus"), keys.number("poissons_ratio")
        if not -1.0 < self.law[1] < 0.5:
            raise InputError("must be above -1 and below 0.5", keys.where("poissons_ratio"),
                             "Give such a number.")
        self.density, self.substep = keys.positive("density"), keys.positive("step")
        self.mass = self.density * float(np.prod(self.lengths))
        self.make_mesh(three(keys, "corner"))
        self.restart = np.zeros(0, np.uint8)  # none before the first step
        self.u_all = np.zeros_like(self.places)
        self.v_all = np.tile(three(keys, "velocity"), (len(self.places), 1))
        self.first, self.stored = self.v_all.copy(), 0.0
        self.mises = np.zeros(len(self.elements))

    def make_mesh(self, corner):
        n = self.cells + 1
        grid = np.array(list(itertools.product(*map(range, n))))  # z runs fastest
        self.places = corner + grid * self.lengths / self.cells
        number = np.arange(len(grid)).reshape(n)
        self.elements = np.array([[number[tuple(np.add(cell, c))] for c in CORNERS]
                                  for cell in itertools.product(*map(range, self.cells))])
        self.face = number[0].ravel()  # nodes of the left side
        own = np.arange(len(self.face)).reshape(number[0].shape)
        self.facets = [(own[j, k], own[j, k + 1], own[j + 1, k + 1], own[j + 1, k])
                       for j in range(self.cells[1]) for k in range(self.cells[2])]
        near = np.array([[2.0 if a == b else 1.0 for b in (0, 1)] for a in (0, 1)]) / 6.0
        self.share = np.array([[np.prod([near[i, j] for i, j in zip(a, b)]) for b in CORNERS]
                               for a in CORNERS]) * self.mass / len(self.elements)

    def surface(self):
        return Surface(self.places[self.face], self.facets)

    # ---- a run of CalculiX

    def beginning(self):
        """The model and its initial state; numbers have the 20 places that ccx reads."""
        lines = ["*NODE,NSET=ALL"]
        lines += [f"{k + 1},{x:.12e},{y:.12e},{z:.12e}" for k, (x, y, z) in enumerate(self.places)]
        lines.append("*ELEMENT,TYPE=C3D8,ELSET=SOLID")
        lines += [f"{k + 1}," + ",".join(str(n + 1) for n in each)
                  for k, each in enumerate(self.elements)]
        lines += ["*MATERIAL,NAME=OWN", "*ELASTIC", f"{self.law[0]:.12e},{self.law[1]:.12e}",
                  "*DENSITY", f"{self.density:.12e}", "*SOLID SECTION,ELSET=SOLID,MATERIAL=OWN",
                  "*AMPLITUDE,NAME=STEADY", "0.,1.,1.,1.", "*INITIAL CONDITIONS,TYPE=VELOCITY"]
        lines += [f"{k + 1},{i + 1},{v:.12e}" for k, row in enumerate(self.first)
                  for i, v in enumerate(row)]
        return lines

    def step(self, dt, force):
        lines = ["*RESTART,READ"] if self.restart.size else self.beginning()
        lines += ["*STEP", "*DYNAMIC,DIRECT,ALPHA=0", f"{dt:.12e},{dt:.12e}",
                  "*CLOAD,OP=NEW,AMPLITUDE=STEADY"]
        lines += [f"{node + 1},{i + 1},{f:.12e}" for node, row in zip(self.face, force)
                  for i, f in enumerate(row)]
        lines += ["*RESTART,WRITE,OVERLAY", "*END STEP"]
        with tempfile.TemporaryDirectory(prefix="abut_ccx_") as name:
            place = Path(name)
            (place / "step.rin").write_bytes(self.restart.tobytes())
            (place / "step.inp").write_text("\n".join(lines) + "\n", "ascii")
            said = subprocess.run(["ccx", "step"], cwd=place, check=False, capture_output=True,
                                  text=True, env={**os.environ, "OMP_NUM_THREADS": "1"})
            if said.returncode or not (place / "step.rout").exists():
                raise NotConverged("CalculiX: " + said.stdout[-500:] + said.stderr[-500:])
            self.read((place / "step.rout").read_bytes())

    def read(self, data: bytes):
        """Fortran's records, by their lengths: displacements and velocities (nodes, 4), the first
        of which is a temperature; stresses and strains (elements, points, 6)."""
        self.restart, nodes, points, at = np.frombuffer(data, np.uint8), [], [], 0
        while at < len(data):
            length = int.from_bytes(data[at:at + 4], "little")
            if length == 32 * len(self.places):
                nodes.append(np.frombuffer(data, float, length // 8, at + 4).reshape(-1, 4)[:, 1:])
            if length == 48 * POINTS * len(self.elements):
                points.append(np.frombuffer(data, float, length // 8, at + 4))
            at += length + 8
        if len(nodes) != 2 or len(points) != 2:
            raise RuntimeError("*RESTART of this ccx writes other records than that of 2.20")
        self.u_all, self.v_all = nodes[0].copy(), nodes[1].copy()
        stress, strain = (each.reshape(-1, POINTS, 6)[:, :8] for each in points)
        density = 0.5 * np.sum(stress * strain * [1, 1, 1, 2, 2, 2]) / 8.0  # [J/m^3], summed
        self.stored = float(density) * float(np.prod(self.lengths)) / len(self.elements)
        x, y, z, *sliding = stress.mean(axis=1).T
        self.mises = np.sqrt(((x - y)**2 + (y - z)**2 + (z - x)**2) / 2
                             + 3 * np.sum(np.square(sliding), axis=0))

    # ---- what others see

    def displacement(self):
        return self.u_all[self.face]

    def velocity(self):
        return self.v_all[self.face]

    def energy(self):
        v = self.v_all[self.elements]  # (elements, 8, 3)
        return Energy(0.5 * float(np.einsum("eai,ab,ebi->", v, self.share, v)), self.stored)

    def momentum(self):
        return self.share.sum(axis=0) @ self.v_all[self.elements].sum(axis=0)

    def grid(self):
        return self.places, [(12, list(each)) for each in self.elements]  # VTK's hexahedron

    def node_fields(self):
        return {"displacement": self.u_all, "velocity": self.v_all}

    def cell_fields(self):
        return {"von_mises": self.mises}


if __name__ == "__main__":
    serve(Bar)
