"""Goal: `output.fields` changes nothing that a run of a scene computes, and leaves the same files
in every placement.

Oracles: equality of state hashes and of files; the run without fields is that of RUNS, which CTest
makes first (tests/system/CMakeLists.txt).
usage: test_fields_unchanged.py ABUT ROOT RUNS SCENE
"""

import csv
import sys
from pathlib import Path

sys.dont_write_bytecode = True
from support import ROOT, SystemTest, main, shared_run  # noqa: E402

NAME = sys.argv[4]  # as below configs/


def files(folder: Path) -> dict:
    return {str(path.relative_to(folder)): path.read_bytes()
            for path in folder.glob("fields*/**/*") if path.is_file()}


def rows(folder: Path) -> list:
    with (folder / "history.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.reader(file))


class Unchanged(SystemTest):
    def run_in(self, name: str, *arguments: object) -> Path:
        folder = self.folder / name
        self.succeed(self.abut("run", ROOT / "configs" / f"{NAME}.yaml", "--out", folder,
                               *arguments))
        return folder

    def assert_same_history(self, one: Path, other: Path):
        """The same but for the times of records in free flight: they are counted from the begin of
        the flight, and rounded there."""
        ours, theirs = rows(one), rows(other)
        self.assertEqual(len(ours), len(theirs))
        rounding = 2.0 * sys.float_info.epsilon * max(abs(float(row[0])) for row in theirs[1:])
        for row, expected in zip(ours, theirs):
            self.assertEqual(row[1:], expected[1:])
            if row[0] != expected[0]:
                self.assertAlmostEqual(float(row[0]), float(expected[0]), delta=rounding)

    def test_fields_change_no_bit_and_are_the_same_in_every_placement(self):
        without = shared_run(NAME)
        self.assertFalse((without / "fields.pvd").exists())
        wanted = ("--set", "output.fields.every=7")
        local = self.run_in("local", "--local", *wanted)
        spawned = self.run_in("spawned", *wanted)
        for folder in (local, spawned):
            self.assertEqual(self.summary(folder)["state_hash"],
                             self.summary(without)["state_hash"])
            self.assert_same_history(folder, without)
        self.assertEqual(self.summary(local)["exchanges"],
                         self.summary(spawned)["exchanges"])
        self.assertEqual(files(local), files(spawned))
        self.assertGreater(len(files(local)), 2)


if __name__ == "__main__":
    main(4)
