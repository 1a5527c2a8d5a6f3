"""The fields that a run writes for ParaView, read without VTK: fields.pvd and the .vtu files."""

import array
import base64
import binascii
import math
import struct
import xml.etree.ElementTree as ElementTree
import zlib
from pathlib import Path
from typing import NamedTuple

from abut_tools.run_files import damaged, is_there, text_of

LIST = "fields.pvd"
TYPES = {"Float64": "d", "Int32": "i", "UInt8": "B"}
MOST_VALUES = 200_000_000


class Entry(NamedTuple):
    """A line of the list: one state of one body."""

    time: float
    body: str
    path: Path


class Grid(NamedTuple):
    """A body's cells in the reference configuration, numbered as VTK does."""

    points: array.array        # 3 numbers per node
    connectivity: array.array
    offsets: array.array       # the end of each cell in connectivity
    types: array.array         # VTK's number of each cell's kind


class State:
    """One file. Its arrays are decoded when they are asked for."""

    def __init__(self, path: Path):
        self.path = path
        if not is_there(path):
            raise damaged(path, f"is listed in {LIST} and is not there")
        try:
            piece = ElementTree.fromstring(text_of(path)).find("UnstructuredGrid/Piece")
        except ElementTree.ParseError as error:
            raise damaged(path, f"is not XML ({error})") from error
        if piece is None:
            raise damaged(path, "holds no grid of cells")
        self.piece = piece
        self.nodes, self.cells = (self.count(name) for name in ("NumberOfPoints", "NumberOfCells"))

    def count(self, name: str) -> int:
        text = self.piece.get(name, "")
        if not text.isdigit() or int(text) > MOST_VALUES:
            raise damaged(self.path, f"does not tell its {name}")
        return int(text)

    def found(self, place: str, name: str) -> ElementTree.Element | None:
        return next((one for one in self.piece.iterfind(f"{place}/DataArray")
                     if one.get("Name") == name), None)

    def has(self, place: str, name: str) -> bool:
        return self.found(place, name) is not None

    def values(self, place: str, name: str, kind: str, size: int | None) -> array.array:
        """The numbers of an array, all finite, as many as expected where that is known."""
        element = self.found(place, name)
        if element is None:
            raise damaged(self.path, f"has no array {name}")
        if element.get("type") != kind:
            raise damaged(self.path, f"has {name} of another type than {kind}")
        try:
            numbers = decoded((element.text or "").strip(), TYPES[kind])
        except (ValueError, struct.error, zlib.error, binascii.Error) as error:
            raise damaged(self.path, f"has {name} cut short or overwritten") from error
        if size is not None and len(numbers) != size:
            raise damaged(self.path, f"has {len(numbers)} numbers in {name} instead of {size}")
        if kind == "Float64" and not all(map(math.isfinite, numbers)):
            raise damaged(self.path, f"has numbers in {name} that are not finite")
        return numbers

    def at_nodes(self, name: str, components: int) -> array.array:
        return self.values("PointData", name, "Float64", components * self.nodes)

    def at_cells(self, name: str, components: int) -> array.array:
        return self.values("CellData", name, "Float64", components * self.cells)

    def grid(self) -> Grid:
        offsets = self.values("Cells", "offsets", "Int32", self.cells)
        grid = Grid(self.values("Points", "Points", "Float64", 3 * self.nodes),
                    self.values("Cells", "connectivity", "Int32", offsets[-1] if offsets else 0),
                    offsets, self.values("Cells", "types", "UInt8", self.cells))
        ascending = all(a <= b for a, b in zip([0, *offsets], offsets))
        if not ascending or not all(0 <= node < self.nodes for node in grid.connectivity):
            raise damaged(self.path, "has cells of nodes that are not there")
        return grid


def decoded(text: str, code: str) -> array.array:
    """VTK's form: the sizes of packed blocks, then the blocks, each part in base64."""
    blocks = struct.unpack("<Q", base64.b64decode(text[:12])[:8])[0]
    if blocks > len(text):
        raise ValueError("more blocks than text")
    head = (8 * (3 + blocks) + 2) // 3 * 4
    sizes = struct.unpack(f"<{3 + blocks}Q", base64.b64decode(text[:head]))
    packed, data, at = base64.b64decode(text[head:]), bytearray(), 0
    for size in sizes[3:]:
        # No block unpacks to more than the head tells: a short file cannot fill the memory.
        data += zlib.decompressobj().decompress(packed[at:at + size], sizes[1])
        at += size
    numbers = array.array(code)
    numbers.frombytes(bytes(data))
    return numbers


def listed_states(folder: Path) -> list[Entry]:
    """What fields.pvd lists, in its order; nothing where the run wrote no fields."""
    path = folder / LIST
    if not is_there(path):
        return []
    try:
        tree = ElementTree.fromstring(text_of(path))
    except ElementTree.ParseError as error:
        raise damaged(path, f"is not XML ({error})") from error
    entries = []
    for number, element in enumerate(tree.iter("DataSet"), start=1):
        time, name, file = (element.get(key, "") for key in ("timestep", "name", "file"))
        try:
            moment = float(time)
        except ValueError:
            moment = math.nan
        if not math.isfinite(moment) or not name:
            raise damaged(path, f"has no time or no body in its state {number}")
        if Path(file).parent != Path("fields") or not file.endswith(".vtu"):
            raise damaged(path, f"lists '{file[:60]}', which is no file of fields/")
        entries.append(Entry(moment, name, folder / file))
    return entries
