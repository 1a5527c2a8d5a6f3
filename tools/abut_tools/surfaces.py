"""What one sees of a body: the facets that no two of its cells share, as triangles and edges."""

from typing import NamedTuple

from abut_tools.vtu import Grid

# Facets of VTK's cells by its numbers of kinds: corners in a circle, and of cells of second order
# the nodes on their edges in the same circle.
HEXAHEDRON = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
TETRAHEDRON = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))
WEDGE = ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0))
PYRAMID = ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4))
TETRAHEDRON_10 = ((0, 2, 1, 6, 5, 4), (0, 1, 3, 4, 8, 7), (1, 2, 3, 5, 9, 8), (2, 0, 3, 6, 7, 9))
HEXAHEDRON_20 = ((0, 3, 2, 1, 11, 10, 9, 8), (4, 5, 6, 7, 12, 13, 14, 15),
                 (0, 1, 5, 4, 8, 17, 12, 16), (1, 2, 6, 5, 9, 18, 13, 17),
                 (2, 3, 7, 6, 10, 19, 14, 18), (3, 0, 4, 7, 11, 16, 15, 19))
SOLIDS = {10: TETRAHEDRON, 12: HEXAHEDRON, 13: WEDGE, 14: PYRAMID, 24: TETRAHEDRON_10,
          25: HEXAHEDRON_20, 29: HEXAHEDRON_20}
FLAT = {5: (0, 1, 2), 9: (0, 1, 2, 3), 22: (0, 1, 2, 3, 4, 5), 23: (0, 1, 2, 3, 4, 5, 6, 7),
        28: (0, 1, 2, 3, 4, 5, 6, 7)}
POINT, LINES = 1, (3, 21)
TRIANGLES = {
    3: ((0, 1, 2),), 4: ((0, 1, 2), (0, 2, 3)), 6: ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)),
    8: ((0, 4, 7), (4, 1, 5), (5, 2, 6), (6, 3, 7), (4, 5, 6), (4, 6, 7))}
CIRCLES = {3: (0, 1, 2), 4: (0, 1, 2, 3), 6: (0, 3, 1, 4, 2, 5), 8: (0, 4, 1, 5, 2, 6, 3, 7)}


class Surface(NamedTuple):
    """Triangles and edges by the places of their nodes in `nodes`, which are numbers of the grid.
    A body in one dimension is drawn as a strip: its nodes are there twice, above and below."""

    nodes: list[int]
    side: list[float]  # of strips 1 above, -1 below; else empty
    triangles: list[tuple[int, int, int]]
    edges: list[tuple[int, int]]
    dimension: int     # of the cells: 0 to 3


def facets_of(grid: Grid) -> tuple[list[tuple], int]:
    """Facets by numbers of the grid's nodes, and the dimension of the cells that have them."""
    outer, flat, begin = {}, [], 0
    for end, kind in zip(grid.offsets, grid.types):
        cell = grid.connectivity[begin:end]
        begin = end
        if kind in FLAT and len(cell) >= len(FLAT[kind]):
            flat.append(tuple(cell[: len(FLAT[kind])]))
        for facet in SOLIDS.get(kind, ()):
            if max(facet) >= len(cell):
                continue
            nodes = tuple(cell[k] for k in facet)
            corners = nodes[: len(nodes) // 2 if len(nodes) > 4 else None]
            key = tuple(sorted(corners))
            if key in outer:
                del outer[key]  # a facet between two cells is seen by nobody
            else:
                outer[key] = nodes
    return flat + list(outer.values()), 3 if outer else 2 if flat else 0


def lines_of(grid: Grid) -> list[tuple[int, int]]:
    lines, begin = [], 0
    for end, kind in zip(grid.offsets, grid.types):
        if kind in LINES and end - begin >= 2:
            lines.append((grid.connectivity[begin], grid.connectivity[begin + 1]))
        begin = end
    return lines


def surface_of(grid: Grid) -> Surface:
    facets, dimension = facets_of(grid)
    if not facets:
        return strip_of(grid)
    nodes = sorted({node for facet in facets for node in facet})
    place = {node: k for k, node in enumerate(nodes)}
    triangles, edges = [], set()
    for facet in facets:
        own = [place[node] for node in facet]
        triangles += [(own[a], own[b], own[c]) for a, b, c in TRIANGLES[len(own)]]
        circle = [own[k] for k in CIRCLES[len(own)]]
        for a, b in zip(circle, circle[1:] + circle[:1]):
            edges.add((min(a, b), max(a, b)))
    return Surface(nodes, [], triangles, sorted(edges), dimension)


def strip_of(grid: Grid) -> Surface:
    """A bar as a strip of some height, a wall that is a point as a line across."""
    lines = lines_of(grid)
    along = range(len(grid.points) // 3)
    nodes = sorted({node for line in lines for node in line} or along,
                   key=lambda node: grid.points[3 * node])
    count = len(nodes)
    place = {node: k for k, node in enumerate(nodes)}
    triangles, edges = [], set()
    for one, other in lines:
        a, b = place[one], place[other]
        triangles += [(a, b, b + count), (a, b + count, a + count)]
        edges |= {(min(a, b), max(a, b)), (min(a, b) + count, max(a, b) + count)}
    ends = nodes if not lines else [node for node in nodes
                                    if sum(node in line for line in lines) == 1]
    edges |= {(place[node], place[node] + count) for node in ends}
    return Surface(nodes + nodes, [1.0] * count + [-1.0] * count, triangles, sorted(edges),
                   1 if lines else 0)


def clustered(surface: Surface, points: list[tuple], most: int) -> Surface:
    """A surface of at most about `most` nodes: nodes of one cell of a lattice become one of them.
    For pictures alone; values at the nodes that are left are those of the run."""
    if len(surface.nodes) <= most or surface.side:
        return surface
    low = [min(p[i] for p in points) for i in range(3)]
    size = max(max(p[i] for p in points) - low[i] for i in range(3)) or 1.0
    fine, coarse = 1, 4096
    while coarse - fine > 1:  # the finest lattice that leaves no more
        middle = (fine + coarse) // 2
        cells = {tuple(int((p[i] - low[i]) / size * middle) for i in range(3)) for p in points}
        fine, coarse = (middle, coarse) if len(cells) <= most else (fine, middle)
    first, stands_for = {}, []
    for k, p in enumerate(points):
        cell = tuple(int((p[i] - low[i]) / size * fine) for i in range(3))
        stands_for.append(first.setdefault(cell, k))
    kept = sorted(set(stands_for))
    place = {k: new for new, k in enumerate(kept)}
    own = [place[k] for k in stands_for]
    triangles = {}
    for triangle in surface.triangles:
        a, b, c = (own[k] for k in triangle)
        if a != b and b != c and a != c:
            triangles.setdefault(tuple(sorted((a, b, c))), (a, b, c))
    edges = {(min(own[a], own[b]), max(own[a], own[b])) for a, b in surface.edges
             if own[a] != own[b]}
    return Surface([surface.nodes[k] for k in kept], [], list(triangles.values()), sorted(edges),
                   surface.dimension)
