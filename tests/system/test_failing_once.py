"""Goal: whatever fails once in a run ends it in words, and costs nothing but that run.

One allocation of a process fails, or one call by which it writes a file: the 1st, the 2nd and so
on with growing distances, until one that the run never comes to. Oracles: exit codes, the message,
the files that are left; the run in which nothing has failed, byte for byte, is what the next run
comes to, a resumed one where there is a checkpoint.
usage: test_failing_once.py ABUT ROOT FOLDER_OF_LIBRARIES [CLASS]
"""

import csv
import shutil
import sys
from pathlib import Path

from support import ABUT, ROOT, SystemTest, main

LIBRARIES = Path(sys.argv[3]).resolve()
SCENE = ROOT / "configs" / "two_bars.yaml"
KEPT = ["--set", "output.checkpoint={windows: 20}"]
GROWTH = 1.2  # from one failure to the next: fifty of them up to the last of 3e4 allocations


class FailingOnce(SystemTest):
    library = ""
    told = ()  # one of these is in the message

    def run_with(self, word: str, after: int, *placement: str):
        """A run in which a call of the process with the word on its command line fails."""
        whole = self.environment
        self.environment = {**whole, "LD_PRELOAD": str(LIBRARIES / self.library),
                            "FAILING_WORD": word, "FAILING_AFTER": str(after),
                            "FAILING_COUNT": str(self.folder / "count")}
        try:
            run = self.start(ABUT, "run", SCENE, "--out", self.out, *KEPT, *placement)
        finally:
            self.environment = whole
        return self.end(run)

    def fail_at(self, number: int, whole: tuple, word: str, *placement: str) -> tuple:
        """Whether it ended the run, and how many calls there were."""
        shutil.rmtree(self.out, ignore_errors=True)
        (self.folder / "count").unlink(missing_ok=True)
        with self.subTest(word=word, placement=placement, call=number):
            result = self.run_with(word, number, *placement)
            calls = self.calls_of_the_run(number)
            if result.returncode != 0:
                self.assertGreaterEqual(calls, number, result.stderr)
                self.assert_told(result)
                self.assert_left(result)
                self.go_on(*placement)
            self.assertEqual(self.told_of_the_motion(), whole)
        return result.returncode != 0, calls

    def walk(self, word: str, *placement: str) -> int:
        """Fails one call after the other; how many runs were ended by it."""
        self.succeed(self.run_with(word, 0, *placement))
        whole = self.told_of_the_motion()
        number, calls, ended = 0, 0, 0
        while calls >= number:  # the latest one was come to
            number = max(number + 1, int(number * GROWTH))
            has_ended, calls = self.fail_at(number, whole, word, *placement)
            ended += has_ended
        return ended

    def calls_of_the_run(self, number: int) -> int:
        """A solver that has failed is ended by the coordinator, and then tells no count."""
        path = self.folder / "count"
        return int(path.read_text(encoding="utf-8")) if path.exists() else number

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
        self.assertTrue(any(word in result.stderr for word in self.told), result.stderr)
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
                table = list(csv.reader(file))  # empty: ended before its first record
            self.assertLessEqual(len({len(row) for row in table}), 1, path)
            rows.append(len(table))
        # The run may have been ended after a record had come to one of two tables.
        self.assertLessEqual(max(rows, default=0) - min(rows, default=0), 1)
        if (self.out / "events.jsonl").exists():
            self.events()
        if (self.out / "summary.json").exists():
            self.assertIn(self.summary()["status"], ("failed", "completed"), result.stderr)

    def go_on(self, *placement: str):
        told = self.out / "summary.json"
        if told.exists() and self.summary()["status"] == "completed":
            return  # what failed came after the last file
        kept = (self.out / "checkpoint.abut").exists()
        again = ("run", SCENE, "--out", self.out, "--force", *KEPT)
        self.succeed(self.abut(*(("resume", self.out) if kept else again), *placement))


class Allocations(FailingOnce):
    library = "libabut_failing_memory.so"
    told = ("memory",)

    def test_in_one_process(self):
        self.assertGreater(self.walk("run", "--local"), 40)

    def test_where_the_run_ends(self):
        """What is written there is taken down there as well, by destructors that allocate."""
        self.succeed(self.run_with("run", 0, "--local"))
        whole = self.told_of_the_motion()
        _, calls = self.fail_at(10**9, whole, "run", "--local")
        for number in range(calls - 900, calls, 29):
            self.fail_at(number, whole, "run", "--local")

    def test_of_the_coordinator(self):
        self.assertGreater(self.walk("run"), 40)

    def test_of_a_solver(self):
        self.assertGreater(self.walk("left"), 30)


class Files(FailingOnce):
    library = "libabut_failing_files.so"
    told = ("No space left on device",)

    def test_in_one_process(self):
        self.assertGreater(self.walk("run", "--local"), 15)

    def test_of_the_coordinator(self):
        self.assertGreater(self.walk("run"), 15)


if __name__ == "__main__":
    main(arguments=3)
