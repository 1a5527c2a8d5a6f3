#!/usr/bin/env python3
"""Writes meshes of two gears that mate.

usage: gears.py DIRECTORY [PARTS]   writes gear_12.msh and gear_18.msh there

Involute teeth of module 1 and a pressure angle of 25 degrees, without undercut, the middle of a
tooth at the angle zero. Quadrilaterals: rings from the hub to the root circle, a grid in each
tooth, and in the gear of 18 teeth a disk around its middle node; PARTS, 1 by default, is how many
cells stand for one along each edge. Of the gear of 12 teeth there are only those that mate. Names:
hub, a circle; teeth, flanks, tips and gaps of the teeth that mate.
"""
import math
import pathlib
import sys

from elliptic_rings import write

PRESSURE_ANGLE = math.radians(25)
ADDENDUM, DEDENDUM = 1.0, 1.25
BACKLASH = 0.04  # a tooth is narrower by half of it on the pitch circle
HUB = 0.5  # radius of the hub over that of the root circle
MATING = {12: (9, 10, 11, 0, 1), 18: (7, 8, 9, 10, 11, 12)}  # of each gear, in a row


def half_angle(teeth, radius):
    """Of a tooth at a radius: involute, and straight inwards of the base circle."""
    pitch = teeth / 2
    base = pitch * math.cos(PRESSURE_ANGLE)
    angle = math.acos(min(1.0, base / radius))
    on_pitch = (math.pi / 2 - BACKLASH / 2) / teeth
    return on_pitch + math.tan(PRESSURE_ANGLE) - PRESSURE_ANGLE - (math.tan(angle) - angle)


def gear(teeth, mating, parts):
    """Positions by lattice point, and groups (dimension, name, cells).

    Points are (ring, number around) in the annulus, (tooth, row, column) in teeth.
    """
    across, rows, gap, rings = 4 * parts, 6 * parts, 2 * parts, 2 * parts
    whole = teeth == max(MATING)
    pitch = teeth / 2
    root, tip = pitch - DEDENDUM, pitch + ADDENDUM
    foot = half_angle(teeth, root)
    sector, around = across + gap, (across + gap) * teeth

    def on_circle(radius, angle):
        return radius * math.cos(angle), radius * math.sin(angle), 0.0

    def angle_of(number):
        tooth, column = divmod(number, sector)
        middle = 2 * math.pi * tooth / teeth
        if column <= across:
            return middle + foot * (2 * column / across - 1)
        return middle + foot + (2 * math.pi / teeth - 2 * foot) * (column - across) / gap

    points = {(0, 0): (0.0, 0.0, 0.0)}
    for ring in range(1, rings + 2):
        radius = root * (HUB + (1 - HUB) * (ring - 1) / rings)
        points.update({(ring, n): on_circle(radius, angle_of(n)) for n in range(around)})
    there = [n for n in range(around) if whole or n // sector in mating]
    pairs = range(0, around, 2) if whole else []
    cells = [[(0, 0), (1, n), (1, n + 1), (1, (n + 2) % around)] for n in pairs]
    cells += [[(ring, n), (ring + 1, n), (ring + 1, (n + 1) % around), (ring, (n + 1) % around)]
              for ring in range(1, rings + 1) for n in there]

    def node(tooth, row, column):
        return (rings + 1, tooth * sector + column) if row == 0 else (tooth, row, column)

    edges = []
    for tooth in range(teeth) if whole else mating:
        middle = 2 * math.pi * tooth / teeth
        for row in range(1, rows + 1):
            radius = root + (tip - root) * row / rows
            half = half_angle(teeth, radius)
            points.update({(tooth, row, c): on_circle(radius, middle + half * (2 * c / across - 1))
                           for c in range(across + 1)})
        cells += [[node(tooth, r + i, c + j) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]
                  for r in range(rows) for c in range(across)]
        if tooth not in mating:
            continue
        way = [node(tooth, r, 0) for r in range(rows)]
        way += [node(tooth, rows, c) for c in range(across)]
        way += [node(tooth, r, across) for r in range(rows, 0, -1)]
        way += [(rings + 1, tooth * sector + c) for c in range(across, sector)]
        way.append((rings + 1, (tooth + 1) * sector % around))
        edges += [list(pair) for pair in zip(way, way[1:])]
    hub = [[(1, n), (1, (n + 1) % around)] for n in there]
    used = {p for cell in cells for p in cell}
    points = {p: place for p, place in points.items() if p in used}
    return points, [(2, "gear", cells), (1, "teeth", edges), (1, "hub", hub)]


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    parts = int(sys.argv[2]) if len(sys.argv) == 3 else 1
    for teeth, mating in MATING.items():
        write(pathlib.Path(sys.argv[1]) / f"gear_{teeth}.msh", *gear(teeth, mating, parts))


if __name__ == "__main__":
    main()
