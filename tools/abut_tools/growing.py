"""Files that a run adds to while they are read: what is new since the last look, whole lines alone,
and of a long table few rows, none of which is made up."""

import csv
import math
import os
import re
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from abut_tools.run_files import damaged, is_there
from abut_tools.tables import Table

PIECE = 2_000_000    # bytes that are read at once
STRETCHES = 150      # of which a table keeps rows
ONE_BY_ONE = 6       # forces that are watched each


class Replaced(Exception):
    """Another file stands under the name, or it has lost what it had: all is read anew."""


class GrowingFile:
    def __init__(self, path: Path):
        self.path = path
        self.at, self.file = 0, None   # bytes that were read; which file it is

    def lines(self) -> list[str]:
        """New ones; a line that is being written waits for the next look."""
        if not is_there(self.path):
            if self.file is not None:
                raise Replaced
            return []
        with self.path.open("rb") as file:
            status = os.fstat(file.fileno())
            if self.file not in (None, (status.st_dev, status.st_ino)) or status.st_size < self.at:
                raise Replaced
            self.file = (status.st_dev, status.st_ino)
            file.seek(self.at)
            data = file.read(PIECE)
        end = data.rfind(b"\n") + 1
        self.at += end
        try:
            return data[:end].decode("utf-8").splitlines()
        except UnicodeDecodeError as error:
            raise damaged(self.path, f"is no text (byte {self.at - end + error.start})") from error

    def part(self) -> float:
        """Of what is there, how much was read: from 0 to 1."""
        size = self.path.stat().st_size if is_there(self.path) else 0
        return min(1.0, self.at / size) if size else 1.0


class Row:
    """A row of a table, and what it is kept for."""

    def __init__(self, cells: list[float | None], keys: list[float]):
        self.cells, self.keys = cells, keys


def watched(names: list[str]) -> Callable[[list[float | None]], list[float]]:
    """Numbers of a row whose largest values a thinned table keeps: forces, iterations, overlap,
    energies."""
    def places(pattern: str) -> list[int]:
        return [k for k, name in enumerate(names) if re.fullmatch(pattern, name)]
    forces = places(r".+\.(force|reaction)(_[xyz])?")
    sums = [places(r".+\.kinetic"), places(r".+\.stored")]
    iterations, gaps = places(r".+\.iterations"), places(r".+\.gap")

    def keys(cells: list[float | None]) -> list[float]:
        sizes = [abs(cells[k] or 0.0) for k in forces]
        out = sizes if len(sizes) <= ONE_BY_ONE else [max(sizes)]
        kinetic, stored = (sum([cells[k] or 0.0 for k in each]) for each in sums)
        out += [kinetic, -kinetic, stored]
        if iterations:
            out.append(max([cells[k] or 0.0 for k in iterations]))
        if gaps:
            apart = [cells[k] or 0.0 for k in gaps]
            out += [max(apart), -min(apart)]
        return out
    return keys


def telling(rows: list[Row]) -> list[Row]:
    """The first of them, and those with the largest of what is watched."""
    kept = {0}
    for k in range(len(rows[0].keys)):
        kept.add(max(range(len(rows)), key=lambda i, k=k: rows[i].keys[k]))
    return [rows[i] for i in sorted(kept)]


def cells_of(line: str) -> list[str]:
    return line.split(",")  # no quotes around numbers


class GrowingTable:
    """A table of a run that grows. It keeps every row of a short one; of a long one the rows that
    tell of each stretch, of which there are some hundred: when there are too many, two become one.
    """

    def __init__(self, path: Path):
        self.file = GrowingFile(path)
        self.names, self.keys = [], watched([])
        self.length, self.rows = 1, 0   # rows of a stretch; of the file so far
        self.closed, self.open = [], []
        self.latest = None
        self.turned = 0                 # how often stretches have become longer
        self.before = -math.inf

    def look(self, seconds: float) -> int:
        """Reads what is new, for about so long; the number of new rows."""
        count, until = self.rows, time.monotonic() + seconds
        while lines := self.file.lines():
            for cells in csv.reader(lines) if not self.names else map(cells_of, lines):
                self.add(cells)
            if time.monotonic() > until:
                break
        return self.rows - count

    def add(self, cells: list[str]) -> None:
        if not self.names:
            names = [re.sub(r" \[.*\]$", "", name) for name in cells]
            if not names or names[0] != "time":
                raise damaged(self.file.path, "is no table of a run")
            self.names, self.keys = names, watched(names)
            return
        try:
            if len(cells) != len(self.names):
                raise ValueError(f"has a row of {len(cells)} cells, the header has "
                                 f"{len(self.names)}")
            numbers = [float(cell) if cell else None for cell in cells]
            if not math.isfinite(sum(filter(None, numbers))):
                raise ValueError("has a number that is not finite")
            if numbers[0] is None or numbers[0] < self.before:
                raise ValueError("has times that do not ascend")
        except ValueError as error:
            raise damaged(self.file.path, str(error)) from error
        self.before = numbers[0]
        self.rows += 1
        self.latest = Row(numbers, self.keys(numbers))
        self.open.append(self.latest)
        if len(self.open) == self.length:
            self.closed.append(telling(self.open))
            self.open = []
        if len(self.closed) > 2 * STRETCHES:
            self.closed = [telling(one + other) for one, other in
                           zip(self.closed[::2], self.closed[1::2])] + \
                self.closed[len(self.closed) // 2 * 2:]
            self.length *= 2
            self.turned += 1

    def kept(self) -> Iterator[Row]:
        for stretch in self.closed:
            yield from stretch
        if self.open:
            yield from telling(self.open)

    def table(self) -> Table:
        rows = [row.cells for row in self.kept()]
        if self.latest and (not rows or rows[-1] is not self.latest.cells):
            rows.append(self.latest.cells)
        return Table(self.names or ["time"], rows, str(self.file.path))
