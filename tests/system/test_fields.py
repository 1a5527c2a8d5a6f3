"""Goal: `output.fields` leaves files that VTK reads, and changes nothing that a run computes.

Oracles: equality of state hashes and files; the records of history.csv; VTK itself where Debian's
python3-vtk9 or ParaView is installed.
usage: test_fields.py ABUT ROOT
"""

import base64
import csv
import struct
import unittest
import xml.etree.ElementTree as ElementTree
import zlib
from pathlib import Path

from support import ABUT, ROOT, SystemTest, main

TWO_BARS = ROOT / "configs" / "two_bars.yaml"
PAIR = ROOT / "configs" / "methods" / "penalty_explicit.yaml"
WALL = ROOT / "configs" / "rigid_wall.yaml"
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

    def assert_same_history(self, one: Path, other: Path):
        """The same but for the times of records in free flight: they are counted from the begin of
        the flight, and rounded there."""
        ours, theirs = self.rows(one), self.rows(other)
        self.assertEqual(len(ours), len(theirs))
        for row, expected in zip(ours, theirs):
            self.assertEqual(row[1:], expected[1:])
            if row[0] != expected[0]:  # sums of a few numbers of 1e-3 s at most
                self.assertAlmostEqual(float(row[0]), float(expected[0]), delta=1.0e-18)

    def test_fields_change_no_bit_and_are_the_same_in_every_placement(self):
        for scene in (TWO_BARS, PAIR, WALL):
            with self.subTest(scene=scene.stem):
                without = self.run_in(f"{scene.stem}_without", scene, "--local")
                self.assertFalse((without / "fields.pvd").exists())
                wanted = ("--set", "output.fields.every=7")
                local = self.run_in(f"{scene.stem}_local", scene, "--local", *wanted)
                spawned = self.run_in(f"{scene.stem}_spawned", scene, *wanted)
                for folder in (local, spawned):
                    self.assertEqual(self.summary(folder)["state_hash"],
                                     self.summary(without)["state_hash"])
                    self.assert_same_history(folder, without)
                self.assertEqual(self.summary(local)["exchanges"],
                                 self.summary(spawned)["exchanges"])
                self.assertEqual(self.files(local), self.files(spawned))
                self.assertGreater(len(self.files(local)), 10)

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

    def test_vtk_reads_what_we_read(self):
        try:
            from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
        except ImportError:
            self.skipTest("VTK for Python is not installed (Debian: python3-vtk9)")
        self.succeed(self.abut("run", TWO_BARS, "--local", "--out", self.out,
                               "--set", "output.fields.every=50"))
        for path in sorted((self.out / "fields").iterdir()):
            reader = vtkXMLUnstructuredGridReader()
            reader.SetFileName(str(path))
            reader.Update()
            grid = reader.GetOutput()
            self.assertEqual((grid.GetNumberOfPoints(), grid.GetNumberOfCells()), (201, 200))
            piece = ElementTree.parse(path).getroot().find("UnstructuredGrid/Piece")
            for part, data in (("PointData", grid.GetPointData()),
                               ("CellData", grid.GetCellData())):
                for name, ours in arrays(piece.find(part)).items():
                    theirs = data.GetArray(name)
                    self.assertEqual(theirs.GetNumberOfValues(), len(ours))
                    self.assertEqual([theirs.GetValue(i) for i in range(len(ours))], list(ours))


if __name__ == "__main__":
    main()
