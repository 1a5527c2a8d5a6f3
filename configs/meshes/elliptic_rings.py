#!/usr/bin/env python3
"""Writes the meshes of NAFEMS' benchmarks LE1 and LE10: a quarter of a ring between two ellipses.

usage: elliptic_rings.py DIRECTORY   writes elliptic_membrane.msh and elliptic_plate.msh there

Between the ellipses (x/2)^2 + y^2 = 1 and (x/3.25)^2 + (y/2.75)^2 = 1 nodes lie on straight lines
that join points of the same parameter angle. Cells are quadratic (quad8; hex20 in Gmsh's order),
their sides curved.
"""
import itertools
import math
import pathlib
import sys

RADIAL, AROUND = 8, 10
GROWTH = 1.25  # of a row of cells over the one before it: small cells lie at the point (2, 0)
HEIGHTS = (-0.3, -0.25, 0.0, 0.25, 0.3)  # of layers: stress changes fast near the surfaces
LAYERS = len(HEIGHTS) - 1
# Nodes of a cell on the lattice of half cells, in Gmsh's order.
QUAD8 = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
HEX20 = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2),
         (1, 0, 0), (0, 1, 0), (0, 0, 1), (2, 1, 0), (2, 0, 1), (1, 2, 0), (2, 2, 1), (0, 2, 1),
         (1, 0, 2), (0, 1, 2), (2, 1, 2), (1, 2, 2)]
# Dimension and nodes of a cell: Gmsh's number of it.
GMSH_TYPES = {(1, 2): 1, (2, 4): 3, (1, 3): 8, (2, 8): 16, (3, 8): 5, (3, 20): 17}


def graded(half, count):
    """Part of the way that ends at a half of one of count rows."""
    rows = [GROWTH ** row for row in range(count)]
    return (sum(rows[: half // 2]) + sum(rows[: (half + 1) // 2])) / 2 / sum(rows)


def place(i, j):
    """Of a point of the lattice of half cells: i outwards, j from the x axis to the y axis."""
    part = graded(i, RADIAL)
    angle = math.pi / 2 * graded(j, AROUND)
    inner = (2.0 * math.cos(angle), math.sin(angle))
    outer = (3.25 * math.cos(angle), 2.75 * math.sin(angle))
    # Exactly on the axes, so that these sides are plane.
    x = 0.0 if j == 2 * AROUND else (1 - part) * inner[0] + part * outer[0]
    y = 0.0 if j == 0 else (1 - part) * inner[1] + part * outer[1]
    return x, y


def height(k):
    """Of a level of half layers."""
    return (HEIGHTS[k // 2] + HEIGHTS[(k + 1) // 2]) / 2


def membrane():
    """Positions by lattice point, and groups (dimension, name, cells)."""
    cells = [[(2 * i + a, 2 * j + b) for a, b in QUAD8]
             for i, j in itertools.product(range(RADIAL), range(AROUND))]
    along_i = [[(2 * i, 0), (2 * i + 2, 0), (2 * i + 1, 0)] for i in range(RADIAL)]
    along_j = [[(0, 2 * j), (0, 2 * j + 2), (0, 2 * j + 1)] for j in range(AROUND)]
    end = 2 * AROUND, 2 * RADIAL
    sides = {
        "y_zero": along_i,
        "x_zero": [[(i, end[0]) for i, _ in edge] for edge in along_i],
        "inner": along_j,
        "outer": [[(end[1], j) for _, j in edge] for edge in along_j],
    }
    points = {p: place(*p) + (0.0,) for p in sorted({p for cell in cells for p in cell})}
    groups = [(2, "membrane", cells)] + [(1, name, edges) for name, edges in sides.items()]
    return points, groups


def plate():
    """The same in space, z from the lower to the upper surface."""
    counts = range(RADIAL), range(AROUND), range(LAYERS)
    cells = [[(2 * i + a, 2 * j + b, 2 * k + c) for a, b, c in HEX20]
             for i, j, k in itertools.product(*counts)]
    highest = 2 * RADIAL, 2 * AROUND, 2 * LAYERS

    def faces(axis, value):
        others = [count for a, count in enumerate(counts) if a != axis]
        found = []
        for first, second in itertools.product(*others):
            face = [(2 * first + a, 2 * second + b) for a, b in QUAD8]
            found.append([p[:axis] + (value,) + p[axis:] for p in face])
        return found

    sides = {
        "y_zero": faces(1, 0),
        "x_zero": faces(1, highest[1]),
        "outer": faces(0, highest[0]),
        "upper": faces(2, highest[2]),
    }
    middle = [[(highest[0], j, LAYERS) for j in (2 * n, 2 * n + 2, 2 * n + 1)]
              for n in range(AROUND)]
    points = {p: place(*p[:2]) + (height(p[2]),)
              for p in sorted({p for cell in cells for p in cell})}
    groups = [(3, "plate", cells)] + [(2, name, all_faces) for name, all_faces in sides.items()]
    return points, groups + [(1, "middle", middle)]


def write(path, points, groups):
    """As MSH 4.1, one entity for each group, with tags from 1 in the order of the groups."""
    number = {point: n + 1 for n, point in enumerate(points)}
    lines = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(groups))]
    lines += [f'{dim} {tag} "{name}"' for tag, (dim, name, _) in enumerate(groups, 1)]
    tags = {d: [t for t, group in enumerate(groups, 1) if group[0] == d] for d in (1, 2, 3)}
    counts = ["0"] + [str(len(of_dim)) for of_dim in tags.values()]
    lines += ["$EndPhysicalNames", "$Entities", " ".join(counts)]
    lines += [f"{tag} 0 0 0 4 4 1 1 {tag} 0" for dim in (1, 2, 3) for tag in tags[dim]]
    count = len(points)
    lines += ["$EndEntities", "$Nodes", f"1 {count} 1 {count}", f"{groups[0][0]} 1 0 {count}"]
    lines += [str(n) for n in number.values()]
    lines += [" ".join(f"{x:.12g}" for x in position) for position in points.values()]
    total = sum(len(cells) for _, _, cells in groups)
    lines += ["$EndNodes", "$Elements", f"{len(groups)} {total} 1 {total}"]
    element = 0
    for tag, (dim, _, cells) in enumerate(groups, 1):
        lines.append(f"{dim} {tag} {GMSH_TYPES[dim, len(cells[0])]} {len(cells)}")
        for cell in cells:
            element += 1
            lines.append(" ".join(str(n) for n in [element] + [number[p] for p in cell]))
    path.write_text("\n".join(lines + ["$EndElements", ""]))


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    directory = pathlib.Path(sys.argv[1])
    write(directory / "elliptic_membrane.msh", *membrane())
    write(directory / "elliptic_plate.msh", *plate())


if __name__ == "__main__":
    main()
