#!/usr/bin/env python3
"""Writes the mesh of a square plate with a round hole in its middle.

usage: plate_with_hole.py DIRECTORY   writes plate_with_hole.msh there

A plate of 20 by 20 with a hole of radius 1, of quadrilaterals on rays from the middle; rows of
cells grow outwards. Sides: hole, left, right, bottom, top.
"""
import math
import pathlib
import sys

from elliptic_rings import write

AROUND, ROWS = 40, 16  # AROUND is a multiple of 8: corners of the plate are nodes
HALF = 10.0  # of the plate


def place(ray, row):
    """Position of the point of a row, from the hole outwards, on a ray."""
    angle = 2.0 * math.pi * ray / AROUND
    x, y = math.cos(angle), math.sin(angle)
    far = HALF / max(abs(x), abs(y))
    to_edge = row / ROWS  # square near the edge, round near the hole
    round_to = HALF ** to_edge
    radius = (1 - to_edge ** 2) * round_to + to_edge ** 2 * far * HALF ** (to_edge - 1)
    return radius * x, radius * y, 0.0


def plate():
    """Positions by lattice point, and groups (dimension, name, cells)."""
    def cell(i, j):
        k = (j + 1) % AROUND
        return [(j, i), (j, i + 1), (k, i + 1), (k, i)]

    def side(first):
        quarter = AROUND // 4
        rays = [(first + n) % AROUND for n in range(quarter + 1)]
        return [[(a, ROWS), (b, ROWS)] for a, b in zip(rays, rays[1:])]

    cells = [cell(i, j) for i in range(ROWS) for j in range(AROUND)]
    eighth = AROUND // 8
    sides = {
        "hole": [[((j + 1) % AROUND, 0), (j, 0)] for j in range(AROUND)],
        "right": side(-eighth), "top": side(eighth),
        "left": side(3 * eighth), "bottom": side(5 * eighth),
    }
    points = {p: place(*p) for p in sorted({p for cell in cells for p in cell})}
    return points, [(2, "plate", cells)] + [(1, name, edges) for name, edges in sides.items()]


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    write(pathlib.Path(sys.argv[1]) / "plate_with_hole.msh", *plate())


if __name__ == "__main__":
    main()
