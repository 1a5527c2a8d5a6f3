#!/usr/bin/python3
"""A solid of FEniCSx as a body of abut, on one rank of MPI or several, of which rank 0 speaks.
usage: fenicsx_solid.py --connect ENDPOINT --body NAME      (README.md beside this file)"""

import itertools
import logging
import math
import signal
import sys

import dolfinx
import numpy as np
from mpi4py import MPI
from petsc4py import PETSc

from abut import Body, Energy, InputError, Surface, serve
from engine import LAWS, Engine
from team import Team

ROOM = 1.0e-6  # of a step, for rounding in scenes


class Kept:
    """A state that all ranks have kept under this name, until nobody holds it any more."""

    names, forgotten = itertools.count(), []

    def __init__(self, seen):
        self.name, self.seen = next(self.names), seen

    def __del__(self):  # at any moment: ranks are told when they keep the next one
        self.forgotten.append(self.name)


class Solid(Body):
    """What abut asks for, by asking the ranks. team: that of this process."""

    conserves = True

    def __init__(self, keys, team):
        if np.issubdtype(PETSc.ScalarType, np.complexfloating):
            raise InputError("computes with complex numbers here", "FEniCSx",
                             "Install python3-dolfinx-real, and name no other PETSC_DIR.")
        self.team, spec = team, read(keys)
        self.dim, self.substep = len(spec["lengths"]), spec["step"]
        self.linear = spec["law"] == "linear"
        self.model = (f"{spec['law']} solid of FEniCSx {dolfinx.__version__}, central difference, "
                      f"{count(team.comm.size, 'rank')}")
        team.start(spec)
        self.mass, self.stable_step = team.engine.mass, team.ask("stable_step")
        if self.substep > self.stable_step * (1.0 + ROOM):
            raise InputError(f"{self.substep:g} is above the stable step {self.stable_step:g}",
                             keys.where("step"), "Give a smaller one, or larger cells.")
        surfaces = team.ask("surfaces")
        for name, (_, facets) in surfaces.items():
            if not facets:
                raise InputError(f"no facet looks along face {name}", keys.where("faces"),
                                 "Give the outward normal of a side.")
        self.ports = {name: Surface(*each) for name, each in surfaces.items()}
        counts = [surface.count for surface in self.ports.values()]
        self.edges = np.cumsum(counts)[:-1]
        self.seen = team.ask("look")

    def surface(self):
        return self.ports

    def step(self, dt, force):
        self.seen = self.team.ask("step", dt, np.concatenate(list(force.values())))

    def displacement(self):
        return self.by_port(self.seen[0][0])

    def velocity(self):
        return self.by_port(self.seen[0][1])

    def by_port(self, values):
        return dict(zip(self.ports, np.split(values, self.edges)))

    def energy(self):
        kinetic, stored = self.seen[1][:2]
        return Energy(kinetic, stored if self.linear else self.team.ask("stored_energy"))

    def momentum(self):
        return self.seen[1][2:]

    def save(self):
        kept, forgotten = Kept(self.seen), []
        while Kept.forgotten:
            forgotten.append(Kept.forgotten.pop())
        self.team.later("keep", kept.name, forgotten)
        return kept

    def restore(self, saved):
        self.team.later("back", saved.name)
        self.seen = saved.seen

    def to_bytes(self, saved):
        return np.stack(self.team.ask("kept_whole", saved.name)).tobytes()

    def from_bytes(self, data):
        self.seen = self.team.ask("set_whole", *np.frombuffer(data).reshape(3, -1, self.dim))
        return self.save()

    def grid(self):
        points, cells = self.team.ask("grid")
        simplices = len(cells[0]) == self.dim + 1
        kind = {(2, True): 5, (2, False): 9, (3, True): 10, (3, False): 12}  # VTK's numbers
        return points, [(kind[self.dim, simplices], cell) for cell in cells]

    def node_fields(self):
        pad = [(0, 0), (0, 3 - self.dim)]
        return {name: np.pad(values, pad) for name, values in
                zip(("displacement", "velocity"), self.team.ask("fields"))}


def read(keys) -> dict:
    """The keys as plain values, sound ones: ranks that disagree about an error would hang."""
    lengths = numbers(keys, "lengths", (2, 3))
    dim = (len(lengths),)
    require(min(lengths) > 0.0, keys, "lengths", "above 0")
    counts = numbers(keys, "cells", dim)
    require(all(each >= 1.0 and each == int(each) for each in counts), keys, "cells", "counts")
    ratio, law = keys.number("poissons_ratio"), keys.get("law", "linear")
    require(-1.0 < ratio < 0.5, keys, "poissons_ratio", "above -1 and below 0.5")
    require(law in LAWS, keys, "law", " or ".join(LAWS))
    simplices = keys.get("simplices", False)
    require(isinstance(simplices, bool), keys, "simplices", "true or false")
    return {"lengths": lengths, "cells": [int(each) for each in counts], "simplices": simplices,
            "corner": numbers(keys, "corner", dim), "velocity": numbers(keys, "velocity", dim),
            "modulus": keys.positive("youngs_modulus"), "ratio": ratio, "law": law,
            "density": keys.positive("density"), "step": keys.positive("step"),
            "faces": read_faces(keys, dim)}


def read_faces(keys, dim) -> dict:
    faces = keys["faces"]
    require(isinstance(faces, dict) and faces, keys, "faces", "ports by their names")
    sides = {name: None if side == "all" else as_numbers(side, dim) for name, side in faces.items()}
    for name, side in faces.items():
        require(side == "all" or (sides[name] and any(sides[name])), keys, "faces",
                f"a normal of {dim[0]} numbers, or all, for each port")
    return sides


def as_numbers(given, counts):
    """None: they are not. YAML takes 1e-3 for a word."""
    try:
        found = [math.nan if isinstance(each, bool) else float(each) for each in given]
    except (TypeError, ValueError):
        return None
    return found if len(found) in counts and all(map(math.isfinite, found)) else None


def numbers(keys, name: str, counts) -> list:
    found = as_numbers(keys[name], counts)
    require(found, keys, name, f"{' or '.join(map(str, counts))} numbers")
    return found


def require(holds, keys, name: str, wanted: str):
    if not holds:
        raise InputError(f"must be {wanted}, but is {keys[name]}", keys.where(name),
                         "Correct it.")


def count(many: int, what: str) -> str:
    return f"{many} {what}" + ("s" if many > 1 else "")


def main():
    team = Team(MPI.COMM_WORLD, Engine)
    if team.comm.rank > 0:
        signal.signal(signal.SIGTERM, signal.SIG_IGN)  # rank 0 ends it
        team.follow()
        return
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))  # MPI tidies up
    try:
        serve(lambda keys: Solid(keys, team))
    finally:
        team.end()


if __name__ == "__main__":
    logging.getLogger().setLevel(logging.WARNING)  # FEniCSx tells of every form that it compiles
    main()
