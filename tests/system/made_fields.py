"""A run with fields made by hand, for tests of pages and pictures: two bricks of two cells each
that meet, in space, in the plane or on a line; the right one's stress is known at every node."""

import base64
import csv
import json
import struct
import zlib
from pathlib import Path

TIMES = [0.0, 1e-3, 2e-3, 3e-3]
PUSH = 0.05      # [m] way of the right brick by the last state
PEAK = 2.0e6     # [Pa]


def encoded(code: str, numbers: list) -> str:
    """As VTK packs an array, in two blocks where there is enough for them."""
    data = struct.pack(f"<{len(numbers)}{code}", *numbers)
    size = max(8, (len(data) // 16 + 1) * 8)
    parts = [data[at: at + size] for at in range(0, len(data), size)]
    packed = [zlib.compress(part) for part in parts]
    head = struct.pack(f"<{3 + len(parts)}Q", len(parts), size, len(data) % size,
                       *map(len, packed))
    return (base64.b64encode(head) + base64.b64encode(b"".join(packed))).decode()


def array(kind: str, code: str, name: str, components: int, numbers: list) -> str:
    return (f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" '
            f'format="binary">{encoded(code, numbers)}</DataArray>')


def brick(shift: float, dimension: int) -> tuple[list, list, int]:
    """Nodes, cells and VTK's kind of cell: two cubes, squares or lines of edge 1 along x."""
    if dimension == 1:
        return [(shift + x, 0.0, 0.0) for x in (0.0, 1.0, 2.0)], [(0, 1), (1, 2)], 3
    layers = (0.0, 1.0) if dimension == 3 else (0.0,)
    points = [(shift + x, y, z) for z in layers for y in (0.0, 1.0) for x in (0.0, 1.0, 2.0)]
    flat = [(k, k + 1, k + 4, k + 3) for k in (0, 1)]
    if dimension == 2:
        return points, flat, 9
    return points, [(*low, *(node + 6 for node in low)) for low in flat], 12


def state(points: list, cells: list, kind: int, moved: list, stress: list) -> str:
    ends = [len(cells[0]) * (k + 1) for k in range(len(cells))]
    return f'''<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64"
 compressor="vtkZLibDataCompressor"><UnstructuredGrid><Piece NumberOfPoints="{len(points)}"
 NumberOfCells="{len(cells)}"><PointData>
{array("Float64", "d", "displacement", 3, [u for each in moved for u in each])}
{array("Float64", "d", "nodal_von_mises", 1, stress)}
</PointData><CellData></CellData><Points>
{array("Float64", "d", "Points", 3, [x for each in points for x in each])}
</Points><Cells>
{array("Int32", "i", "connectivity", 1, [node for cell in cells for node in cell])}
{array("Int32", "i", "offsets", 1, ends)}
{array("UInt8", "B", "types", 1, [kind] * len(cells))}
</Cells></Piece></UnstructuredGrid></VTKFile>
'''


def way(k: int) -> float:
    return PUSH * k / (len(TIMES) - 1)


def stress_at(points: list, k: int) -> list:
    """Of the right brick: falls from its left face, grows with time."""
    x = [point[0] for point in points]
    span = max(x) - min(x)
    return [PEAK * k / (len(TIMES) - 1) * (max(x) - each) / span for each in x]


def make_fields(folder: Path, dimension: int = 3) -> None:
    (folder / "fields").mkdir(parents=True)
    lines = ""
    for name, shift in (("left", -2.0), ("right", 0.01)):
        points, cells, kind = brick(shift, dimension)
        for k, time in enumerate(TIMES):
            ahead = -way(k) if name == "right" else 0.0
            stress = stress_at(points, k) if name == "right" else [0.0] * len(points)
            file = f"fields/{name}_{k:06}.vtu"
            (folder / file).write_text(
                state(points, cells, kind, [(ahead, 0.0, 0.0)] * len(points), stress))
            lines += f'<DataSet timestep="{time!r}" part="0" name="{name}" file="{file}"/>\n'
    (folder / "fields.pvd").write_text(
        f'<?xml version="1.0"?>\n<VTKFile type="Collection">\n<Collection>\n{lines}</Collection>\n'
        "</VTKFile>\n")


def make_run(folder: Path, dimension: int = 3) -> None:
    make_fields(folder, dimension)
    axes = "xyz"[:dimension]
    names = ["time [s]"]
    for body in ("left", "right"):
        names += [f"{body}.face.{key}_{axis} [{unit}]" for key, unit in
                  (("u", "m"), ("v", "m/s"), ("force", "N")) for axis in axes]
        names += [f"{body}.{kind} [J]" for kind in ("kinetic", "stored", "total", "dissipated",
                                                    "external_work")]
    with (folder / "history.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow([*names, "meet.closed", "meet.iterations"])
        for k, time in enumerate(TIMES):
            force = 3000.0 * k * (3 - k) / 2.0
            row = [time]
            for sign in (-1.0, 1.0):
                row += [0.0] * 2 * dimension + [sign * force] + [0.0] * (dimension - 1)
                row += [1.0 + k, 1.0, 2.0 + k, 0.0, float(k)]
            writer.writerow([*row, 1, 1])
    (folder / "events.jsonl").write_text(json.dumps(
        {"time": 1e-3, "kind": "warning", "subject": "right", "text": "right turns too far",
         "values": {}}) + "\n")
    (folder / "summary.json").write_text(json.dumps({
        "status": "completed", "title": "Two bricks <meet>", "windows": 300, "contact_windows": 200,
        "time": {"begin": 0.0, "end": 3e-3, "reached": 3e-3},
        "measures": {"contact.meet.begin": 1e-3, "contact.meet.force_peak": 3000.0,
                     "contact.meet.impulse": 2.0, "contact.meet.count": 1},
        "interfaces": {"meet": {"sides": ["left.face", "right.face"], "tied": False}},
        "bodies": [{"name": "left", "model": "made by hand", "mass": 1.0},
                   {"name": "right", "model": "made by hand", "mass": 1.0}]}))
