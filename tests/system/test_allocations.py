"""Goal: memory that ends at any allocation ends a run in words, and costs nothing but that run.

One allocation of a process fails: the 1st, the 2nd and so on with growing distances, until one
that the run never comes to. Oracles: exit codes, the message, the files that are left; the run
that had all of its memory, byte for byte, is what the next run comes to, a resumed one where
there is a checkpoint.
usage: test_allocations.py ABUT ROOT FAILING_MEMORY [CLASS]
"""

import csv
import shutil
import sys
from pathlib import Path

from support import ABUT, ROOT, SystemTest, main

LIBRARY = Path(sys.argv[3]).resolve()
SCENE = ROOT / "configs" / "two_bars.yaml"
KEPT = ["--set", "output.checkpoint={windows: 20}"]
GROWTH = 1.2  # from one failure to the next: fifty of them up to the last of 3e4 allocations


def numbers(count: int) -> list:
    """Which allocations fail: 1, 2, 3, ... and the one after the last."""
    found = [1]
    while found[-1] <= count:
        found.append(max(found[-1] + 1, min(int(found[-1] * GROWTH), count + 1)))
    return found


class Allocations(SystemTest):
    def run_with(self, word: str, after: int, *placement: str):
        """A run of which the process with the word on its command line lacks memory once."""
        process = self.start_with(word, after, "run", SCENE, "--out", self.out, *KEPT, *placement)
        return self.end(process)

    def start_with(self, word: str, after: int, *arguments: object):
        whole = self.environment
        self.environment = {**whole, "LD_PRELOAD": str(LIBRARY), "FAILING_MEMORY_WORD": word,
                            "FAILING_MEMORY_AFTER": str(after),
                            "FAILING_MEMORY_COUNT": str(self.folder / "count")}
        try:
            return self.start(ABUT, *arguments)
        finally:
            self.environment = whole

    def walk(self, word: str, *placement: str):
        """Fails one allocation after the other; how many runs were ended by it."""
        self.succeed(self.run_with(word, 0, *placement))
        count = int((self.folder / "count").read_text(encoding="utf-8"))
        self.assertGreater(count, 1000, "allocations are counted")
        whole = self.told_of_the_motion()
        ended = 0
        for number in numbers(count):
            shutil.rmtree(self.out, ignore_errors=True)
            with self.subTest(word=word, placement=placement, allocation=number):
                result = self.run_with(word, number, *placement)
                if number > count:
                    self.succeed(result)
                if result.returncode != 0:
                    ended += 1
                    self.assert_told(result)
                    self.assert_left(result)
                    self.go_on(*placement)
                self.assertEqual(self.told_of_the_motion(), whole)
        return ended

    def told_of_the_motion(self) -> tuple:
        """All but the exchanges, some of which a resumed run asks for again."""
        summary = self.summary()
        measures = {name: value for name, value in summary["measures"].items()
                    if name != "exchanges"}
        return (summary["state_hash"], measures, (self.out / "history.csv").read_bytes(),
                (self.out / "events.jsonl").read_bytes())

    def assert_told(self, result):
        last = result.stderr.splitlines()[-1]
        self.assertTrue(last.startswith("error: "), result.stderr)
        self.assertIn("memory", result.stderr)
        # A body that does not fit is the scene's; all else is the machine's.
        of_scene = "takes more memory than there is" in last
        self.assertEqual(result.returncode, 2 if of_scene else 3, result.stderr)

    def assert_left(self, result):
        """No folder, or that of a run which tells that it failed; nothing that is half written."""
        if not self.out.exists():
            return
        self.assertEqual([path.name for path in self.out.rglob("*.tmp")], [])
        rows = []
        for path in self.out.glob("*.csv"):
            with path.open(encoding="utf-8", newline="") as file:
                header, *body = list(csv.reader(file))
            self.assertEqual({len(row) for row in body} - {len(header)}, set(), path)
            rows.append(len(body))
        # Memory may have ended after a record had come to one of two tables.
        self.assertLessEqual(max(rows, default=0) - min(rows, default=0), 1)
        if (self.out / "events.jsonl").exists():
            self.events()
        if (self.out / "summary.json").exists():
            self.assertIn(self.summary()["status"], ("failed", "completed"), result.stderr)

    def go_on(self, *placement: str):
        kept = (self.out / "checkpoint.abut").exists()
        again = ("run", SCENE, "--out", self.out, "--force", *KEPT)
        self.succeed(self.abut(*(("resume", self.out) if kept else again), *placement))


class OneProcess(Allocations):
    def test_every_failure_is_told_and_the_next_run_is_as_good(self):
        self.assertGreater(self.walk("run", "--local"), 40)


class Coordinator(Allocations):
    def test_every_failure_is_told_and_the_next_run_is_as_good(self):
        self.assertGreater(self.walk("run"), 40)


class Solver(Allocations):
    def test_every_failure_is_told_and_the_next_run_is_as_good(self):
        self.assertGreater(self.walk("left"), 30)


if __name__ == "__main__":
    main(arguments=3)
