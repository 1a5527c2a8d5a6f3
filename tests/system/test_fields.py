"""Goal: `output.fields` leaves files that hold the run's states and that VTK reads.

Oracles: the records of history.csv, closed forms of the scenes, VTK itself where Debian's
python3-vtk9 or ParaView is installed. A run without fields is that of RUNS, which CTest makes first
(tests/system/CMakeLists.txt).
usage: test_fields.py ABUT ROOT RUNS
"""

import base64
import csv
import math
import struct
import sys
import unittest
import xml.etree.ElementTree as ElementTree
import zlib
from pathlib import Path

from support import ABUT, ROOT, SystemTest, main, shared_run

TWO_BARS = ROOT / "configs" / "two_bars.yaml"
SOLIDS = ROOT / "configs" / "solids"
CUBE = """\
meta: {{title: A cube of one element that flies}}
time: {{begin: 0.0, end: 1.0e-6, window: 1.0e-6}}
bodies:
  cube:
    model: {{fe: {{dimension: {dimension}, mesh: {mesh}}}}}
    material: {{neo_hookean: {{youngs_modulus: 1.0e9, poissons_ratio: 0.25, density: 1000.0}}}}
    integrator: {{newmark: {{step: 1.0e-6, mass: consistent}}}}
output: {{fields: {{every: 1}}}}
"""
UNITS = {"Float64": ("d", 8), "Int32": ("i", 4), "UInt8": ("B", 1)}


def decode(array: ElementTree.Element) -> tuple:
    """The numbers of a DataArray: sizes of compressed blocks, then the blocks, each base64."""
    text = array.text.strip()
    blocks = struct.unpack("<Q", base64.b64decode(text[:12])[:8])[0]
    head = (8 * (3 + blocks) + 2) // 3 * 4
    sizes = struct.unpack(f"<{3 + blocks}Q", base64.b64decode(text[:head]))
    packed = base64.b64decode(text[head:])
    data, at = b"", 0
    for size in sizes[3:]:
        data += zlib.decompress(packed[at:at + size])
        at += size
    code, width = UNITS[array.get("type")]
    return struct.unpack(f"<{len(data) // width}{code}", data)


def arrays(parent: ElementTree.Element) -> dict:
    return {array.get("Name"): decode(array) for array in parent.iter("DataArray")}


class Fields(SystemTest):
    def run_in(self, name: str, scene: Path, *arguments: object) -> Path:
        folder = self.folder / name
        self.succeed(self.abut("run", scene, "--out", folder, *arguments))
        return folder

    def listed(self, folder: Path) -> list:
        """Time, body and file of every state."""
        tree = ElementTree.parse(folder / "fields.pvd")
        return [(float(entry.get("timestep")), entry.get("name"), folder / entry.get("file"))
                for entry in tree.iter("DataSet")]

    def files(self, folder: Path) -> dict:
        return {str(path.relative_to(folder)): path.read_bytes()
                for path in folder.glob("fields*/**/*") if path.is_file()}

    def rows(self, folder: Path) -> list:
        with (folder / "history.csv").open(encoding="utf-8", newline="") as file:
            return list(csv.reader(file))

    def test_loads_that_depend_on_time_are_rounded_otherwise_and_meet_the_same_expectations(self):
        cube = SOLIDS / "cube_j2.yaml"
        without = self.summary(shared_run("solids/cube_j2"))
        stopped = self.summary(self.run_in("with", cube, "--local",
                                           "--set", "output.fields.every=7"))
        self.assertTrue(stopped["expectations"], "the scene expects something")
        self.assertGreater(stopped["exchanges"], without["exchanges"])

    def test_states_are_at_the_begin_at_every_interval_and_at_the_end(self):
        folder = self.run_in("run", TWO_BARS, "--local", "--set", "output.fields.every=30")
        listed = self.listed(folder)
        self.assertEqual([name for _, name, _ in listed], ["left", "right"] * 5)
        times = [time for time, _, _ in listed[::2]]
        # 100 windows of 1e-5 s from -2e-4 s, of which release cuts one in two: 101 in all
        windows = [0.0, 30.0, 60.0, 90.0]
        for time, count in zip(times, windows):
            self.assertAlmostEqual(time, -2.0e-4 + count * 1.0e-5, delta=1.0e-5)
        self.assertEqual(times[-1], 8.0e-4)
        for _, _, path in listed:
            self.assertTrue(path.is_file(), path)
        self.assertEqual(len(list((folder / "fields").iterdir())), len(listed), "none besides")

    def test_fields_at_the_ports_are_the_rows_of_the_history(self):
        folder = self.run_in("run", TWO_BARS, "--local", "--set", "output.fields.every=1")
        header, *body = self.rows(folder)
        rows = {float(row[0]): dict(zip(header, row)) for row in body}
        compared = 0
        for time, body, path in self.listed(folder):
            piece = ElementTree.parse(path).getroot().find("UnstructuredGrid/Piece")
            nodes, cells = arrays(piece.find("PointData")), arrays(piece.find("CellData"))
            self.assertEqual(len(nodes["displacement"]), 3 * 201)
            self.assertEqual(len(cells["stress"]), 6 * 200)
            at = 200 if body == "left" else 0
            self.assertEqual(nodes["displacement"][3 * at], float(rows[time][f"{body}.tip.u [m]"]))
            self.assertEqual(nodes["velocity"][3 * at], float(rows[time][f"{body}.tip.v [m/s]"]))
            compared += 1
        self.assertGreater(compared, 200)

    def last(self, folder: Path) -> ElementTree.Element:
        _, _, path = self.listed(folder)[-1]
        return ElementTree.parse(path).getroot().find("UnstructuredGrid/Piece")

    def test_fields_of_solids_hold_what_their_scenes_expect(self):
        column = self.last(self.run_in("column", SOLIDS / "torsion_column.yaml", "--local",
                                       "--set", "output.fields.every=50"))
        at_nodes = arrays(column.find("PointData"))
        # the scene's own expectations, and their tolerances
        self.assertAlmostEqual(min(at_nodes["displacement"][0::3]), -0.0443808576, delta=5.0e-10)
        self.assertAlmostEqual(max(at_nodes["displacement"][2::3]), 8.0338e-5, delta=1.0e-9)
        cube = self.last(self.run_in("cube", SOLIDS / "cube_j2.yaml", "--local",
                                     "--set", "output.fields.every=5"))
        at_cells = arrays(cube.find("CellData"))
        # ln(1.05) = tau/E + a with tau = s0 + h a
        plastic = (2.0e11 * math.log(1.05) - 2.5e8) / (2.0e11 + 2.0e9)
        self.assertAlmostEqual(at_cells["equivalent_plastic_strain"][0] / plastic, 1.0, delta=1e-8)
        self.assertAlmostEqual(at_cells["stress"][0] / 343902157.23, 1.0, delta=1e-8)
        self.assertAlmostEqual(at_cells["von_mises"][0] / 343902157.23, 1.0, delta=1e-8)

    def test_the_state_of_paraview_names_the_list_and_the_largest_stress(self):
        folder = self.run_in("run", TWO_BARS, "--local", "--set", "output.fields.every=10")
        state = ElementTree.parse(folder / "fields.pvsm").getroot()
        words = {element.get("id"): [each.get("value") for each in element]
                 for element in state.iter("Property")}
        self.assertEqual(words["1.FileName"], [str(folder / "fields.pvd")])
        largest = max(max(arrays(ElementTree.parse(path).getroot().find(
            "UnstructuredGrid/Piece/CellData"))["von_mises"]) for _, _, path in self.listed(folder))
        self.assertAlmostEqual(float(words["3.RGBPoints"][20]) / largest, 1.0, delta=1e-12)

    def test_a_forced_run_leaves_no_state_of_the_last_one(self):
        self.run_in("run", TWO_BARS, "--local", "--set", "output.fields.every=10")
        folder = self.run_in("run", TWO_BARS, "--local", "--force")
        self.assertEqual(self.files(folder), {})

    def test_a_run_says_where_its_fields_are(self):
        said = self.succeed(self.abut("run", TWO_BARS, "--local", "--out", self.out,
                                      "--set", "output.fields.every=50")).stdout
        self.assertIn(f"fields {self.out}/fields.pvd", said)


class InVtk(SystemTest):
    """An independent reader, where there is one."""

    def setUp(self):
        super().setUp()
        try:
            from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
        except ImportError:
            self.skipTest("VTK for Python is not installed (Debian: python3-vtk9)")
        self.make_reader = vtkXMLUnstructuredGridReader

    def read(self, path: Path):
        reader = self.make_reader()
        reader.SetFileName(str(path))
        reader.Update()
        return reader.GetOutput()

    def test_vtk_reads_what_we_read(self):
        self.succeed(self.abut("run", TWO_BARS, "--local", "--out", self.out,
                               "--set", "output.fields.every=50"))
        for path in sorted((self.out / "fields").iterdir()):
            grid = self.read(path)
            self.assertEqual((grid.GetNumberOfPoints(), grid.GetNumberOfCells()), (201, 200))
            piece = ElementTree.parse(path).getroot().find("UnstructuredGrid/Piece")
            for part, data in (("PointData", grid.GetPointData()),
                               ("CellData", grid.GetCellData())):
                for name, ours in arrays(piece.find(part)).items():
                    theirs = data.GetArray(name)
                    self.assertEqual(theirs.GetNumberOfValues(), len(ours))
                    self.assertEqual([theirs.GetValue(i) for i in range(len(ours))], list(ours))

    def test_vtk_sees_straight_edges_and_the_whole_volume_of_every_element(self):
        flat = "{{rectangle: {{lengths: [1.0, 2.0], elements: [2, 2], element: {}}}}}"
        solid = "{{box: {{lengths: [1.0, 2.0, 3.0], elements: [2, 2, 2], element: {}}}}}"
        elements = [(2, flat, name) for name in ("tri3", "tri6", "quad4", "quad8", "quad9")]
        elements += [(3, solid, name) for name in ("tet4", "tet10", "hex8", "hex20")]
        for dimension, mesh, name in elements:
            with self.subTest(element=name):
                scene = self.folder / f"{name}.yaml"
                scene.write_text(CUBE.format(dimension=dimension, mesh=mesh.format(name)),
                                 encoding="utf-8")
                out = self.folder / name
                self.succeed(self.abut("run", scene, "--local", "--out", out))
                grid = self.read(out / "fields" / "cube_000000.vtu")
                self.assertAlmostEqual(self.size(grid), 2.0 if dimension == 2 else 6.0, delta=1e-12)
                for c in range(grid.GetNumberOfCells()):
                    self.assert_straight(grid.GetCell(c))

    def size(self, grid) -> float:
        """Sum over VTK's own simplices of the cells, each positive."""
        from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter
        sizes = vtkCellSizeFilter()
        sizes.SetInputData(grid)
        sizes.Update()
        data = sizes.GetOutput().GetCellData()
        name = "Volume" if grid.GetCell(0).GetCellDimension() == 3 else "Area"
        values = [data.GetArray(name).GetValue(c) for c in range(grid.GetNumberOfCells())]
        self.assertGreater(min(values), 0.0)
        return sum(values)

    def assert_straight(self, cell):
        for e in range(cell.GetNumberOfEdges()):
            points = cell.GetEdge(e).GetPoints()
            if points.GetNumberOfPoints() < 3:
                continue
            one, two, middle = (points.GetPoint(i) for i in range(3))
            for a, b, m in zip(one, two, middle):
                self.assertAlmostEqual(0.5 * (a + b), m, delta=1e-15)


if __name__ == "__main__":
    main(3)
