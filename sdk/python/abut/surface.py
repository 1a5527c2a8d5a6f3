"""Surfaces of ports in the reference configuration."""

import numpy as np

from abut.errors import InputError

WHERE = "surface()"


class Surface:
    """Points and facets of a port in two or three dimensions.

    points [m] (n, dim); facets: lists of point numbers, 2 in the plane, 3 or 4 in space. In the
    plane the body lies to the left of who walks along a facet; in space the points of a facet turn
    counterclockwise for who looks at the body from outside. Normals follow from the facets.
    spacing [m]: distance of mesh nodes behind the surface, by default the mean edge of the facets.
    transit [s]: time in which the fastest wave crosses it; 0: rigid or unknown.
    """

    def __init__(self, points, facets, spacing=None, transit=0.0):
        self.points = np.asarray(points, float)
        self.facets = [tuple(int(p) for p in facet) for facet in facets]
        self.count, self.dim = self.points.shape
        self._require_facets()
        self.normals = self._facing()
        edges = [np.linalg.norm(self.points[a] - self.points[b]) for a, b in self._edges()]
        self.spacing = float(np.mean(edges)) if spacing is None else spacing
        self.transit = transit

    def _require_facets(self):
        sizes = {2: (2,), 3: (3, 4)}.get(self.dim)
        if sizes is None:
            raise InputError(f"points have {self.dim} coordinates", WHERE,
                             "Give 2 or 3; a body in one dimension has a Point.")
        for facet in self.facets:
            if len(facet) not in sizes or not set(facet) <= set(range(self.count)):
                raise InputError(f"facet {facet} is none of {self.count} points", WHERE,
                                 f"A facet in {self.dim} dimensions lists {sizes} points.")
        if self._closed() and self._enclosed() < 0.0:
            raise InputError("facets look into the body", WHERE,
                             "Turn their order of points around: the body lies to the left in the "
                             "plane, points turn counterclockwise from outside in space.")

    def _edges(self):
        for facet in self.facets:
            yield from zip(facet, facet[1:] + facet[:1] if self.dim == 3 else facet[1:])

    def _closed(self) -> bool:
        """Whether facets enclose a body: every edge (in the plane every point) has two sides."""
        if self.dim == 2:
            begins, ends = zip(*self.facets)
            return sorted(begins) == sorted(ends)
        edges = sorted(self._edges())
        return edges == sorted((b, a) for a, b in edges)

    def _enclosed(self) -> float:
        """Twice the area or six times the volume that closed facets enclose."""
        at = self.points - self.points.mean(axis=0)
        if self.dim == 2:
            return sum(np.linalg.det([at[a], at[b]]) for a, b in self.facets)
        return sum(np.linalg.det([at[f[0]], at[f[k]], at[f[k + 1]]])
                   for f in self.facets for k in range(1, len(f) - 1))

    def _facing(self):
        """Unit normals of points: means of those of the facets around, by their size."""
        normals = np.zeros_like(self.points)
        for facet in self.facets:
            at = self.points[list(facet)]
            if self.dim == 2:
                along = at[1] - at[0]
                size = np.array([along[1], -along[0]])
            else:
                across = at[3] - at[1] if len(facet) == 4 else at[2] - at[1]
                size = np.cross(at[2] - at[0], across)
            normals[list(facet)] += size
        lengths = np.linalg.norm(normals, axis=1)
        if not np.all(lengths > 0.0):
            raise InputError(f"point {int(np.argmin(lengths))} has no normal", WHERE,
                             "Every point belongs to a facet that has a size.")
        return normals / lengths[:, None]


class Point:
    """The port of a body in one dimension: a place [m] and the way it looks, 1.0 or -1.0."""

    def __init__(self, position: float, normal: float, spacing=0.0, transit=0.0):
        self.points = np.array([[float(position)]])
        self.normals = np.array([[float(normal)]])
        self.facets, self.count, self.dim = [], 1, 1
        self.spacing, self.transit = spacing, transit
