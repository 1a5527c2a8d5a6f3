"""A solid of FEniCSx (python3-dolfinx), divided among the ranks of MPI: mesh, matrices, steps. It
knows nothing of abut. All ranks call the same method at the same time; what it gives is whole on
rank 0, and in an order of nodes that does not depend on how many ranks there are."""

import numpy as np
import ufl
from dolfinx import fem, mesh
from dolfinx.fem import petsc
from petsc4py import PETSc

# Corners of a cell or facet in VTK's order, by how many there are; dolfinx counts along axes.
ROUND = {2: [0, 1], 3: [0, 1, 2], 4: [0, 1, 3, 2], 8: [0, 1, 3, 2, 4, 5, 7, 6]}
DEGREE = 2       # of quadrature: two points along an axis; dolfinx would take nine for some laws
POWERS = 200     # iterations for the fastest mode
ALONG = 1.0e-6   # facets look along a normal to this


class Engine:
    """A rectangle or box, lumped masses, central difference: force and state are kept by step."""

    def __init__(self, comm, spec: dict):
        # Sums of what other ranks send, in one order whenever it comes.
        PETSc.Options().setValue("matstash_reproduce", "1")
        self.comm, self.dim, self.substep = comm, len(spec["lengths"]), spec["step"]
        self.domain = self.make_mesh(spec)
        self.space = fem.VectorFunctionSpace(self.domain, ("CG", 1))
        self.owned = self.space.dofmap.index_map.size_local
        self.number_nodes()
        self.make_forces(spec)
        self.u = np.zeros((self.owned, self.dim))
        self.v = np.tile(np.array(spec["velocity"], float), (self.owned, 1))
        self.push, self.pull = np.zeros_like(self.u), self.pulled(self.u)
        self.kept = {}
        self.make_ports(spec["faces"])

    # ---- mesh

    def make_mesh(self, spec: dict):
        begin = np.array(spec["corner"], float)
        corners = [begin, begin + spec["lengths"]]
        kinds = {(2, False): mesh.CellType.quadrilateral, (2, True): mesh.CellType.triangle,
                 (3, False): mesh.CellType.hexahedron, (3, True): mesh.CellType.tetrahedron}
        make = mesh.create_rectangle if self.dim == 2 else mesh.create_box
        return make(self.comm, corners, spec["cells"], kinds[self.dim, spec["simplices"]])

    def number_nodes(self):
        """Place and number in the mesh of every node that this rank knows."""
        geometry, dofs = self.domain.geometry, self.space.dofmap
        of_node = np.zeros(self.owned + dofs.index_map.num_ghosts, int)
        for cell in range(self.count_of(self.dim, ghosts=True)):
            of_node[dofs.cell_dofs(cell)] = geometry.dofmap.links(cell)
        self.numbers = np.array(geometry.input_global_indices)[of_node]
        self.places = geometry.x[of_node, :self.dim]
        told = self.comm.gather(self.numbers[:self.owned])
        self.order = np.argsort(np.concatenate(told)) if told else None

    def count_of(self, dim: int, ghosts=False) -> int:
        count = self.domain.topology.index_map(dim)
        return count.size_local + (count.num_ghosts if ghosts else 0)

    def make_ports(self, faces: dict):
        """Facets by the side they look to; every rank then knows which nodes of them are its."""
        topology, below = self.domain.topology, self.dim - 1
        for pair in ((below, self.dim), (self.dim, below), (below, 0)):
            topology.create_connectivity(*pair)
        of_vertex = np.zeros(self.count_of(0, ghosts=True), int)
        for cell in range(self.count_of(self.dim, ghosts=True)):
            nodes = self.domain.geometry.dofmap.links(cell)
            of_vertex[topology.connectivity(self.dim, 0).links(cell)] = nodes
        found = [self.facet(of_vertex[topology.connectivity(below, 0).links(facet)],
                            topology.connectivity(below, self.dim).links(facet)[0])
                 for facet in mesh.exterior_facet_indices(topology)]
        told = self.comm.gather(found)
        self.ports = None
        if told:
            every = [facet for part in told for facet in part]
            self.ports = {name: sorted(facet for facet, normal in every if looks(normal, side))
                          for name, side in faces.items()}
        self.ports = self.comm.bcast(self.ports)
        self.port_numbers = {name: sorted({n for facet in facets for n in facet})
                             for name, facets in self.ports.items()}
        self.find_own(np.concatenate([np.array(n, int) for n in self.port_numbers.values()]))

    def facet(self, corners, cell: int):
        """Numbers of its corners, counterclockwise from outside (in the plane: the body to the
        left), and its normal."""
        geometry = self.domain.geometry
        inside = geometry.x[geometry.dofmap.links(cell)].mean(axis=0)[:self.dim]
        around = corners[ROUND[len(corners)]]
        at = geometry.x[around]
        normal = (np.cross(at[1] - at[0], [0.0, 0.0, 1.0]) if self.dim == 2 else
                  np.cross(at[2] - at[0], at[-1] - at[1]))[:self.dim]
        if normal @ (at.mean(axis=0)[:self.dim] - inside) < 0.0:
            around, normal = around[::-1], -normal
        numbers = np.array(geometry.input_global_indices)[around]
        return tuple(int(n) for n in numbers), normal / np.linalg.norm(normal)

    def find_own(self, numbers):
        """Which entries of all ports' points are nodes of this rank, and which of them."""
        sorting = np.argsort(self.numbers[:self.owned])
        sorted_numbers = self.numbers[:self.owned][sorting]
        at = np.minimum(np.searchsorted(sorted_numbers, numbers), max(0, self.owned - 1))
        self.mine = np.flatnonzero(sorted_numbers[at] == numbers) if self.owned else at[:0]
        self.nodes = sorting[at[self.mine]]
        self.all_mine = self.comm.gather(self.mine)
        self.points, self.gathered = len(numbers), None
        if self.all_mine:  # rank 0: where look() puts what ranks send
            self.sizes = [2 + self.dim + 2 * self.dim * len(at) for at in self.all_mine]
            buffer = np.zeros(sum(self.sizes))
            self.gathered = buffer, np.split(buffer, np.cumsum(self.sizes)[:-1])

    def surfaces(self):
        """Points and facets of each port, by numbers of its points."""
        places = self.whole(self.places[:self.owned])
        if places is None:
            return None
        return {name: (places[numbers], [tuple(np.searchsorted(numbers, facet)) for facet in
                                         self.ports[name]])
                for name, numbers in self.port_numbers.items()}

    # ---- forms

    def make_forces(self, spec: dict):
        modulus, ratio = spec["modulus"], spec["ratio"]
        shear = modulus / (2 * (1 + ratio))
        lame = modulus * ratio / ((1 + ratio) * (1 - 2 * ratio))
        self.now = fem.Function(self.space)
        test, trial = ufl.TestFunction(self.space), ufl.TrialFunction(self.space)
        dx = ufl.dx(metadata={"quadrature_degree": DEGREE})
        stored = LAWS[spec["law"]](self.now, shear, lame) * dx
        force = ufl.derivative(stored, self.now, test)
        ones = fem.Constant(self.domain, np.ones(self.dim))
        density = fem.Constant(self.domain, spec["density"])
        mass = petsc.assemble_vector(fem.form(density * ufl.inner(ones, test) * dx))
        mass.ghostUpdate(PETSc.InsertMode.ADD, PETSc.ScatterMode.REVERSE)
        self.masses = mass.array.reshape(-1, self.dim).copy()  # [kg] sums of rows
        self.mass = self.sum(self.masses[:, 0])
        self.matrix = petsc.assemble_matrix(fem.form(ufl.derivative(force, self.now, trial)))
        self.matrix.assemble()
        self.given, self.found = self.matrix.createVecs()
        self.linear = spec["law"] == "linear"
        if not self.linear:
            self.stored, self.force = fem.form(stored), fem.form(force)
            self.of_force = petsc.create_vector(self.force)

    def pulled(self, u):
        """[N] of the material against displacements."""
        if self.linear:
            return self.times_matrix(u)
        self.set_now(u)
        with self.of_force.localForm() as local:
            local.set(0.0)
        petsc.assemble_vector(self.of_force, self.force)
        self.of_force.ghostUpdate(PETSc.InsertMode.ADD, PETSc.ScatterMode.REVERSE)
        return self.of_force.array.reshape(-1, self.dim).copy()

    def times_matrix(self, u):
        self.given.array[:] = u.ravel()
        self.matrix.mult(self.given, self.found)
        return self.found.array.reshape(-1, self.dim).copy()

    def set_now(self, u):
        self.now.x.array[:u.size] = u.ravel()
        self.now.x.scatter_forward()

    def stable_step(self) -> float:
        """[s] 2 over the highest frequency of the undeformed solid, by powers from below."""
        some = np.cos(1.0 + self.numbers[:self.owned, None] * [1.0, 1.7, 2.9][:self.dim])
        root, highest = np.sqrt(self.masses), 0.0
        for _ in range(POWERS):
            more = self.times_matrix(some / root) / root
            highest = self.sum(some * more) / self.sum(some * some)
            some = more / np.sqrt(self.sum(more * more))
        return 2.0 / np.sqrt(highest)

    # ---- state and steps

    def step(self, dt: float, force):
        """force [N] on the points of all ports, constant meanwhile; gives what look() does."""
        self.push = np.zeros_like(self.u)
        np.add.at(self.push, self.nodes, force[self.mine])
        self.v += dt / 2 * (self.push - self.pull) / self.masses
        self.u += dt * self.v
        self.pull = self.pulled(self.u)
        self.v += dt / 2 * (self.push - self.pull) / self.masses
        return self.look()

    def look(self):
        """Of all ports' points (2, points, dim) displacements [m] and velocities [m/s]; and sums
        over the solid: kinetic energy, u * force / 2 [J], momentum [kg m/s] (dim). The energy is
        what central differences conserve, and what a force constant in a step changes by force
        times way: velocities before and after a level, as if the force went on, multiplied."""
        change = self.substep / 2 * (self.push - self.pull) / self.masses
        sums = [0.5 * np.sum(self.masses * (self.v**2 - change**2)),
                0.5 * np.sum(self.u * self.pull), *np.sum(self.masses * self.v, axis=0)]
        own = np.concatenate([sums, self.u[self.nodes].ravel(), self.v[self.nodes].ravel()])
        self.comm.Gatherv(own, self.gathered and (self.gathered[0], self.sizes))
        if self.gathered is None:
            return None
        seen, total = np.zeros((2, self.points, self.dim)), np.zeros(2 + self.dim)
        for part, at in zip(self.gathered[1], self.all_mine):
            total += part[:len(total)]
            seen[:, at] = part[len(total):].reshape(2, -1, self.dim)
        return seen, total

    def stored_energy(self) -> float:
        """[J] of a law that is not linear."""
        self.set_now(self.u)
        return self.comm.allreduce(fem.assemble_scalar(self.stored))

    def sum(self, values) -> float:
        return self.comm.allreduce(float(np.sum(values)))

    def keep(self, name: int, forgotten):
        """Copies of the state stay where they are, under a name; others are not wanted any more."""
        for each in forgotten:
            self.kept.pop(each, None)
        self.kept[name] = [each.copy() for each in (self.u, self.v, self.push, self.pull)]

    def back(self, name: int):
        self.u, self.v, self.push, self.pull = (each.copy() for each in self.kept[name])

    def kept_whole(self, name: int):
        """Displacement, velocity and force of a kept state, of all nodes."""
        return [self.whole(each) for each in self.kept[name][:3]]

    def set_whole(self, *values):
        """The state is that of these values of all nodes."""
        own = self.numbers[:self.owned]
        self.u, self.v, self.push = (each[own].copy() for each in values)
        self.pull = self.pulled(self.u)
        return self.look()

    def whole(self, own):
        """Values of the nodes of all ranks, on rank 0, in the order of the mesh's numbers."""
        told = self.comm.gather(own)
        return np.concatenate(told)[self.order] if told else None

    # ---- pictures

    def grid(self):
        """Points, and the numbers of each cell's in VTK's order."""
        geometry = self.domain.geometry
        numbers = np.array(geometry.input_global_indices)
        own = [numbers[geometry.dofmap.links(cell)] for cell in range(self.count_of(self.dim))]
        told = self.comm.gather([tuple(cell[ROUND[len(cell)]] if self.boxes() else cell)
                                 for cell in own])
        places = self.whole(self.places[:self.owned])
        return (places, sorted(cell for part in told for cell in part)) if told else None

    def boxes(self) -> bool:
        return self.domain.topology.cell_type in (mesh.CellType.quadrilateral,
                                                  mesh.CellType.hexahedron)

    def fields(self):
        return self.whole(self.u), self.whole(self.v)


def looks(normal, side) -> bool:
    """Whether a facet looks to this side; None: any."""
    return side is None or normal @ side > (1.0 - ALONG) * np.linalg.norm(side)


def linear_energy(u, shear: float, lame: float):
    strain = ufl.sym(ufl.grad(u))
    return shear * ufl.inner(strain, strain) + lame / 2 * ufl.tr(strain) ** 2


def neo_hookean_energy(u, shear: float, lame: float):
    """As abut's own (docs/METHOD.md, M.33); in the plane nothing moves across it."""
    f = ufl.Identity(len(u)) + ufl.grad(u)
    j = ufl.det(f)
    stretched = ufl.inner(f, f) + (3 - len(u))
    return ((lame + 2 * shear / 3) / 4 * (j**2 - 1 - 2 * ufl.ln(j))
            + shear / 2 * (j ** (-2 / 3) * stretched - 3))


LAWS = {"linear": linear_energy, "neo_hookean": neo_hookean_energy}  # [J/m^3]
