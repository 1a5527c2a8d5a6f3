"""Goal: whatever became of a run's files, `abut report` makes a page or says in one line which file
is damaged, where and what to do. Oracle: no other way out of the program, over some hundred
mutations of real runs that a seed makes the same every time.

usage: test_damaged_runs.py ABUT ROOT RUNS
"""

import contextlib
import io
import json
import os
import random
import re
import shutil
import subprocess
import sys
from pathlib import Path
from unittest import mock

sys.dont_write_bytecode = True
from support import ABUT, PACKAGE, SystemTest, main, shared_run, strict_json  # noqa: E402

sys.path.insert(0, str(PACKAGE))
from abut_tools import report  # noqa: E402

SCENES = ("two_bars", "bars/three_bars_with_gap")  # one contact in closed form, and several
NAMES = ("summary.json", "history.csv", "closed_form.csv", "events.jsonl")
ROUNDS = 60  # of every scene and file
EVERY = 20  # of the rows of a table is kept: what a damage does to one it does to any
NOBODY = 65534


def whole_file(scene: str, name: str) -> bytes:
    """A file of a real run, its tables with a row in twenty and the last."""
    data = (shared_run(scene) / name).read_bytes()
    if not name.endswith(".csv"):
        return data
    header, *rows = data.splitlines(keepends=True)
    return b"".join([header, *rows[:-1:EVERY], rows[-1]])


def places_in(value: object, path: tuple = ()):
    """Every place in JSON, the whole first."""
    yield path
    inner = value.items() if isinstance(value, dict) else (
        enumerate(value) if isinstance(value, list) else ())
    for key, each in inner:
        yield from places_in(each, (*path, key))


WRONG = (None, True, -1, 0, 0.0, 1e308, -1e308, 5e-324, 10**400, "", "\ud800", "<b>", [], {},
         [None], [[]], {"*": None}, {"sides": []}, "nan", [1e308, "x"])


def json_damaged(chance: random.Random, text: str) -> str:
    """One value of another kind, or one key less."""
    value = json.loads(text)
    path = chance.choice(list(places_in(value)))
    if not path:
        return json.dumps(chance.choice(WRONG))
    at = value
    for key in path[:-1]:
        at = at[key]
    if chance.random() < 0.3:
        del at[path[-1]]
    else:
        at[path[-1]] = chance.choice(WRONG)
    return json.dumps(value)


def line_damaged(chance: random.Random, text: str) -> str:
    """Lines of JSON, one of them damaged; cells of a table, one of them another."""
    lines = text.split("\n")
    k = chance.choice((0, chance.randrange(len(lines)), chance.randrange(len(lines))))
    if lines[k].startswith("{"):
        lines[k] = json_damaged(chance, lines[k])
    else:
        cells = lines[k].split(",")
        word = chance.choice(("nan", "-inf", "1e999", "", "x", '"', "1e308", "-1e308", "1_0", "\0"))
        cells[chance.randrange(len(cells))] = word
        if chance.random() < 0.3:
            del cells[chance.randrange(len(cells))]
        lines[k] = ",".join(cells)
    return "\n".join(lines)


def lines_moved(chance: random.Random, text: str) -> str:
    lines = text.split("\n")
    k, other = chance.randrange(len(lines)), chance.randrange(len(lines))
    if chance.random() < 0.5:
        lines[k], lines[other] = lines[other], lines[k]
    else:
        del lines[k]
    return "\n".join(lines)


def bytes_damaged(chance: random.Random, data: bytes) -> bytes:
    """Cut, overwritten, or filled with what is no text."""
    k = chance.randrange(len(data))
    length = chance.choice((1, 3, 300))
    return chance.choice((
        data[:k], data[k:], data[:k] + chance.randbytes(length) + data[k + length:],
        data[:k] + bytes(length) + data[k:], chance.randbytes(length), b"", b"\n", b"[" * 100_000,
        b'{"a":' * 100_000))


def damaged(chance: random.Random, name: str, data: bytes) -> bytes:
    kind = chance.randrange(3)
    if kind == 0:
        return bytes_damaged(chance, data)
    text = data.decode("utf-8")
    if kind == 1 and name != "summary.json":
        return lines_moved(chance, text).encode("utf-8")
    change = json_damaged if name == "summary.json" else line_damaged
    return change(chance, text).encode("utf-8")


class DamagedRuns(SystemTest):
    def setUp(self):
        super().setUp()
        self.library = self.folder / "library.js"  # a short one: it is copied into every page
        self.library.write_text("", encoding="utf-8")

    def copy_of(self, scene: str) -> Path:
        copy = self.folder / "run"
        shutil.rmtree(copy, ignore_errors=True)
        copy.mkdir()
        for name in NAMES:
            if (shared_run(scene) / name).is_file():
                (copy / name).write_bytes(whole_file(scene, name))
        return copy

    def outcome(self, folder: Path) -> tuple[int, str]:
        """Exit code and words; whatever else leaves the program ends the test with a traceback."""
        said = io.StringIO()
        words = ["abut-report", str(folder), "--chart-library", str(self.library)]
        with mock.patch.object(sys, "argv", words), contextlib.redirect_stderr(said), \
                contextlib.redirect_stdout(io.TextIOWrapper(io.BytesIO())):
            code = report.main()
        return code, said.getvalue()

    def assert_told(self, outcome: tuple[int, str], folder: Path, name: str):
        """A page whose numbers are numbers, or one line with the file and what to do."""
        code, said = outcome
        if code == 0:
            page = (folder / "report.html").read_text(encoding="utf-8")
            strict_json(re.search(r"<script>const figures = (.*?);</script>", page, re.DOTALL)[1])
            return
        self.assertEqual(code, 2, said)
        self.assertRegex(said, r"\Aabut report: [^\n]+\. [A-Z][^\n]+\.\n\Z")
        self.assertIn(f"{folder.name}/{name}", said)

    def test_damage_by_chance_is_told_in_one_line(self):
        for scene in SCENES:
            for name in NAMES:
                whole = whole_file(scene, name)
                refused = 0
                for seed in range(ROUNDS):
                    with self.subTest(scene=scene, file=name, seed=seed):
                        folder = self.copy_of(scene)
                        data = damaged(random.Random(f"{scene} {name} {seed}"), name, whole)
                        (folder / name).write_bytes(data)
                        outcome = self.outcome(folder)
                        self.assert_told(outcome, folder, name)
                        refused += outcome[0] == 2
                self.assertGreater(refused, ROUNDS // 4, "these are no damages")

    def test_what_is_no_file_is_refused_unread(self):
        for name in NAMES:
            for make in (lambda path: path.mkdir(), os.mkfifo,
                         lambda path: path.symlink_to("/dev/zero")):
                with self.subTest(file=name):
                    folder = self.copy_of(SCENES[0])
                    (folder / name).unlink()
                    make(folder / name)
                    code, said = self.outcome(folder)
                    self.assertEqual(code, 2)
                    self.assertIn(f"{name}: is no regular file", said)

    def test_missing_and_foreign_files_are_told(self):
        folder = self.copy_of(SCENES[0])
        (folder / "summary.json").unlink()
        self.assertEqual(self.outcome(folder)[0], 0, "a run that was killed has a page")
        (folder / "history.csv").unlink()
        self.assertIn("holds no run", self.outcome(folder)[1])
        (folder / "history.csv").write_text("x,y\n1,2\n", encoding="utf-8")
        self.assertIn("history.csv: is no table of a run", self.outcome(folder)[1])
        (folder / "summary.json").write_text('{"status": "completed"}', encoding="utf-8")
        (folder / "history.csv").unlink()
        self.assertEqual(self.outcome(folder)[0], 0, "nothing that is there is wrong")

    def test_a_table_that_ends_before_its_run_is_told_on_the_page(self):
        folder = self.copy_of(SCENES[0])
        lines = (folder / "history.csv").read_text(encoding="utf-8").splitlines(keepends=True)
        (folder / "history.csv").write_text("".join(lines[:len(lines) // 2]), encoding="utf-8")
        self.assertEqual(self.outcome(folder)[0], 0)
        self.assertIn("ends before the run did",
                      (folder / "report.html").read_text(encoding="utf-8"))

    def test_a_folder_that_cannot_be_read_is_the_users_to_open(self):
        folder = self.copy_of(SCENES[0])
        folder.chmod(0)
        self.addCleanup(folder.chmod, 0o700)
        if os.geteuid() == 0:  # whom no permission stops
            self.folder.chmod(0o755)
        who = {"user": NOBODY} if os.geteuid() == 0 else {}
        result = subprocess.run([ABUT.with_name("abut-report"), folder], text=True, check=False,
                                capture_output=True, timeout=60, **who)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertRegex(result.stderr, r"\A[^\n]*run/\S+: cannot be read: Permission[^\n]*\n\Z")


if __name__ == "__main__":
    main(3)
