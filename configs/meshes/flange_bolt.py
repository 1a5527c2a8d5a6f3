#!/usr/bin/env python3
"""Writes the mesh of a quarter of a drilled bolt with its head and nut.

usage: flange_bolt.py DIRECTORY   writes flange_bolt.msh there

A shank from radius 1 to 5, between a head and a nut of radius 8 that are 5 high. Head and nut are
19.97 apart: 0.03 less than the plates that they hold together. Sides: x_zero and y_zero, the planes
of symmetry; head_seat and nut_seat, where head and nut press on plates; hexahedra of first order.
"""
import itertools
import math
import pathlib
import sys

from elliptic_rings import write

RADII = [1.0, 3.0, 5.0, 6.5, 8.0]
HEIGHTS = [-4.97, -2.5, 0.03, 5.0, 10.0, 15.0, 20.0, 22.5, 25.0]
AROUND = 6
SHANK, NUT, HEAD = 2, 2, 6  # rows of cells outwards; levels of the seats
QUAD = [(0, 0), (1, 0), (1, 1), (0, 1)]


def place(i, j, k):
    """Of a point: i outwards, j around from the x axis, k upwards."""
    angle = math.pi / 2 * j / AROUND
    x = 0.0 if j == AROUND else RADII[i] * math.cos(angle)  # exactly on the planes
    y = 0.0 if j == 0 else RADII[i] * math.sin(angle)
    return x, y, HEIGHTS[k]


def bolt():
    """Positions by lattice point, and groups (dimension, name, cells)."""
    rows, levels = range(len(RADII) - 1), range(len(HEIGHTS) - 1)
    solid = [(i, k) for i in rows for k in levels if i < SHANK or not NUT <= k < HEAD]
    cells = [[(i + a, j + b, k + c) for c in (0, 1) for a, b in QUAD]
             for (i, k), j in itertools.product(solid, range(AROUND))]

    def seat(level):
        return [[(i + a, j + b, level) for a, b in QUAD]
                for i in rows if i >= SHANK for j in range(AROUND)]

    sides = {
        "y_zero": [[(i + a, 0, k + b) for a, b in QUAD] for i, k in solid],
        "x_zero": [[(i + a, AROUND, k + b) for a, b in QUAD] for i, k in solid],
        "head_seat": seat(HEAD),
        "nut_seat": seat(NUT),
    }
    points = {p: place(*p) for p in sorted({p for cell in cells for p in cell})}
    return points, [(3, "bolt", cells)] + [(2, name, faces) for name, faces in sides.items()]


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    write(pathlib.Path(sys.argv[1]) / "flange_bolt.msh", *bolt())


if __name__ == "__main__":
    main()
