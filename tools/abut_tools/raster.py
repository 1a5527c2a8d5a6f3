"""Pictures of triangles, each pixel with the depth of what it shows: no display, no graphics
processor, and right where bodies are in each other. As bodies.js does in a page."""

import numpy

LIGHT = numpy.array([0.3, 0.4, 0.87])
SMALLEST_EDGE = 5.0   # pixels: finer meshes are drawn without


def stops_of(colours: tuple[str, ...]) -> numpy.ndarray:
    return numpy.array([[int(c[k: k + 2], 16) for k in (1, 3, 5)] for c in colours], float)


def ramp(colours: tuple[str, ...], values: numpy.ndarray) -> numpy.ndarray:
    """(n, 3) colours of values from 0 to 1, linear between stops."""
    stops = stops_of(colours)
    at = numpy.clip(values, 0.0, 1.0) * (len(stops) - 1)
    return numpy.stack([numpy.interp(at, range(len(stops)), stops[:, i]) for i in range(3)], -1)


def lit(corners: numpy.ndarray) -> numpy.ndarray:
    """(t,) light of triangles (t, 3, 3) on the screen, y up, z towards the viewer."""
    normal = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = numpy.linalg.norm(normal, axis=1)
    normal /= numpy.where(size > 0.0, size, 1.0)[:, None]
    normal *= numpy.where(normal[:, 2] < 0.0, -1.0, 1.0)[:, None]
    return 0.42 + 0.58 * numpy.clip(normal @ LIGHT, 0.0, 1.0)


class Picture:
    def __init__(self, width: int, height: int, ground: tuple[int, int, int]):
        self.width, self.height = width, height
        self.colour = numpy.empty((height * width, 3), numpy.float32)
        self.colour[:] = ground
        self.depth = numpy.full(height * width, -numpy.inf)

    def image(self, finer: int) -> numpy.ndarray:
        """(height, width, 3) bytes, of `finer` times `finer` pixels each, which smooths edges."""
        shaped = self.colour.reshape(self.height // finer, finer, self.width // finer, finer, 3)
        shaped = shaped.mean((1, 3))
        return numpy.clip(shaped + 0.5, 0.0, 255.0).astype(numpy.uint8)

    def put(self, pixels: numpy.ndarray, depths: numpy.ndarray, colours: numpy.ndarray) -> None:
        """Of what falls on one pixel the nearest is seen: it is written last."""
        order = numpy.argsort(depths)
        order = order[depths[order] > self.depth[pixels[order]]]
        self.depth[pixels[order]] = depths[order]
        self.colour[pixels[order]] = colours[order]

    def triangles(self, points: numpy.ndarray, triangles: numpy.ndarray, colours: numpy.ndarray,
                  shaded: bool) -> None:
        """Points (n, 3) in pixels, y down, z towards the viewer; colours (n, 3) at the points."""
        if not len(triangles):
            return
        corners = points[triangles]
        light = lit(corners * [1.0, -1.0, 1.0]) if shaded else numpy.ones(len(triangles))
        low = numpy.floor(corners[:, :, :2].min(1)).astype(int)
        high = numpy.ceil(corners[:, :, :2].max(1)).astype(int)
        low, high = numpy.maximum(low, 0), numpy.minimum(high, [self.width - 1, self.height - 1])
        seen = numpy.flatnonzero((high >= low).all(1))
        room = 2 ** numpy.ceil(numpy.log2(numpy.maximum(high - low + 1, 4)))[seen].astype(int)
        for width, height in numpy.unique(room, axis=0):  # those of like size at once
            some = seen[(room == (width, height)).all(1)]
            for part in numpy.array_split(some, 1 + len(some) * width * height // 1_000_000):
                self.batch(corners[part], low[part], (width, height), colours[triangles[part]],
                           light[part])

    def batch(self, corners, low, size, colours, light) -> None:
        if not len(corners):
            return
        x = low[:, 0, None, None] + numpy.arange(size[0])[None, None, :]
        y = low[:, 1, None, None] + numpy.arange(size[1])[None, :, None]
        (ax, ay), (bx, by), (cx, cy) = (
            (corners[:, k, 0, None, None], corners[:, k, 1, None, None]) for k in range(3))
        area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
        area = numpy.where(area == 0.0, numpy.inf, area)
        u = ((bx - x) * (cy - y) - (cx - x) * (by - y)) / area
        v = ((cx - x) * (ay - y) - (ax - x) * (cy - y)) / area
        inside = (u >= -1e-6) & (v >= -1e-6) & (u + v <= 1.0 + 1e-6) & numpy.isfinite(area)
        inside &= (x < self.width) & (y < self.height)
        which, row, column = numpy.nonzero(inside)
        if not len(which):
            return
        weights = numpy.stack([u[which, row, column], v[which, row, column]], 1)
        weights = numpy.column_stack([weights, 1.0 - weights.sum(1)])
        pixels = (low[which, 1] + row) * self.width + low[which, 0] + column
        depths = (weights * corners[which, :, 2]).sum(1)
        mixed = (weights[:, :, None] * colours[which]).sum(1) * light[which, None]
        self.put(pixels, depths, mixed)

    def edges(self, points: numpy.ndarray, edges: numpy.ndarray, always: bool,
              bare: bool) -> None:
        """Darker lines on what is there already, where facets are large enough; on bare ground of
        bodies that are nothing but lines."""
        if not len(edges):
            return
        begin, way = points[edges[:, 0]], points[edges[:, 1]] - points[edges[:, 0]]
        length = numpy.hypot(way[:, 0], way[:, 1])
        if length.mean() < SMALLEST_EDGE and not always:
            return
        counts = numpy.minimum(numpy.ceil(length).astype(int) + 1, 4 * self.width)
        which = numpy.repeat(numpy.arange(len(edges)), counts)
        step = numpy.arange(counts.sum()) - numpy.repeat(numpy.cumsum(counts) - counts, counts)
        part = step / numpy.maximum(counts[which] - 1, 1)
        places = begin[which] + part[:, None] * way[which]
        x, y = numpy.rint(places[:, 0]).astype(int), numpy.rint(places[:, 1]).astype(int)
        there = (x >= 0) & (y >= 0) & (x < self.width) & (y < self.height)
        pixels = y[there] * self.width + x[there]
        near = places[there, 2] + 3e-3 * self.width >= self.depth[pixels]
        there = near & ~numpy.isinf(self.depth[pixels])
        self.colour[numpy.unique(pixels[there])] *= 0.75
        if bare:
            self.colour[numpy.unique(pixels[near & ~there])] = 128.0
