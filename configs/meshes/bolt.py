#!/usr/bin/env python3
"""Writes the mesh of one half of a bolt.

usage: bolt.py DIRECTORY   writes bolt.msh there

A shank of 0.25 by 50 with a head of 1.55 by 6 on it, of quadrilaterals; the seat is the lower side
of the head, from the shank outwards. Cells are small where shank and head meet.
"""
import pathlib
import sys

from elliptic_rings import write


def grid(lines_x, lines_y, inside):
    """Cells between lines, those whose numbers are inside."""
    return [[(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            for j in range(len(lines_y) - 1) for i in range(len(lines_x) - 1) if inside(i, j)]


def bolt():
    """Positions by lattice point, and groups (dimension, name, cells)."""
    across = [0.0, 0.125, 0.25] + [0.3 + 0.125 * i for i in range(11)]
    along = [50 * (1 - (1 - i / 20) ** 2) for i in range(20)]
    along += [50 + 6 * (i / 10) ** 1.5 for i in range(11)]
    shank, neck = 2, 20
    cells = grid(across, along, lambda i, j: i < shank or j >= neck)
    columns = range(len(across) - 1)
    sides = {
        "axis": [[(0, j), (0, j + 1)] for j in range(len(along) - 1)],
        "foot": [[(i, 0), (i + 1, 0)] for i in range(shank)],
        "seat": [[(i, neck), (i + 1, neck)] for i in columns if i >= shank],
        "lid": [[(i, len(along) - 1), (i + 1, len(along) - 1)] for i in columns],
    }
    corners = sorted({p for cell in cells for p in cell})
    points = {p: (across[p[0]], along[p[1]], 0.0) for p in corners}
    return points, [(2, "bolt", cells)] + [(1, name, edges) for name, edges in sides.items()]


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    write(pathlib.Path(sys.argv[1]) / "bolt.msh", *bolt())


if __name__ == "__main__":
    main()
