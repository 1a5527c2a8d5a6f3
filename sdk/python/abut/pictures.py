"""What is drawn of a body: its grid and fields, as ours have them."""

import numpy as np

from abut.v1 import subdomain_pb2 as pb

KINDS = {1: 1, 2: 3, 3: 5, 4: 9}  # VTK's numbers of a point, line, triangle, quadrilateral
PLACES = {"node": pb.FIELD_PLACE_NODES, "cell": pb.FIELD_PLACE_CELLS}


def in_space(values):
    values = np.asarray(values, float)
    return np.pad(values, ((0, 0), (0, 3 - values.shape[1])))


class Picture:
    def __init__(self, served):
        self.served = served
        given = served.body.grid()
        self.of_ports = given is None
        self.points, self.cells = self._surfaces() if self.of_ports else given

    def _surfaces(self):
        points, cells = [], []
        for _, surface in self.served.ports:
            first = len(points)
            points.extend(surface.points)
            for facet in surface.facets or [(0,)]:
                cells.append((KINDS[len(facet)], [first + p for p in facet]))
        return np.array(points), cells

    def values(self):
        """(place, name, values (n, components)) of every field, now."""
        body, dim = self.served.body, self.served.body.dim
        nodes = {}
        if self.of_ports:
            for name, by_port in (("displacement", self.served.displacement()),
                                  ("velocity", self.served.velocity())):
                nodes[name] = in_space(np.concatenate(by_port).reshape(-1, dim))
        nodes.update(body.node_fields())
        for place, fields in (("node", nodes), ("cell", body.cell_fields())):
            for name, values in fields.items():
                values = np.asarray(values, float)
                yield place, name, values.reshape(len(values), -1)

    def describe(self, description):
        for place, name, values in self.values():
            description.fields.add(name=name, place=PLACES[place], components=values.shape[1])

    def fill_grid(self, reply):
        reply.points.extend(in_space(self.points).ravel().tolist())
        reply.offsets.append(0)
        for kind, nodes in self.cells:
            reply.types.append(kind)
            reply.connectivity.extend(int(node) for node in nodes)
            reply.offsets.append(len(reply.connectivity))

    def fill_fields(self, reply):
        for _, _, values in self.values():
            reply.values.add().values.extend(values.ravel().tolist())
