"""Goal: bad input ends with exit code 2 and a paragraph that says what to change;
files stay as they are.

The oracle stands at the head of every configs/invalid/*.yaml: `# refused with: <message>`, and
where there are several errors, ` And with: ` before each further message. Where line numbers do
not matter, it is a row of configs/invalid/rows.txt: what to --set in a valid scene, and all but the
place of each message.
usage: test_invalid_scenes.py ABUT ROOT
"""

import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from typing import NamedTuple

ABUT = Path(sys.argv[1]).resolve()
ROOT = Path(sys.argv[2]).resolve()
INVALID = ROOT / "configs" / "invalid"
# A refusal takes milliseconds, many times that by sanitizers; only a hang takes longer.
SECONDS = 20 * int(os.environ.get("ABUT_SLOWER", "1"))

VALID = """\
meta: {title: A bar that flies}
time: {begin: 0.0, end: 1.0e-5, window: 1.0e-6}
bodies:
  bar:
    model: {fe: {dimension: 1, mesh: {bar: {length: 0.25, elements: 20, area: 1.0e-6}}}}
    material: {linear_elastic: {youngs_modulus: 1.0e9, density: 1000.0}}
    integrator: {central_difference: {step: 1.0e-6}}
"""


def abut(*arguments: object) -> subprocess.CompletedProcess:
    return subprocess.run([ABUT, *map(str, arguments)], cwd=ROOT, capture_output=True, text=True,
                          timeout=SECONDS, check=False)


def expected_messages(scene: Path) -> list:
    """The comment lines at the head of a scene, joined into the paragraphs they quote."""
    words = []
    for line in scene.read_text(encoding="utf-8").splitlines():
        if not line.startswith("# "):
            break
        words.append(line[2:])
    text = " ".join(words)
    mark = "refused with: "
    assert text.startswith(mark), f"{scene} does not begin with '# {mark}'"
    return text[len(mark):].split(" And with: ")


class Row(NamedTuple):
    """A base scene, what is set in it, and the messages without their places."""
    base: str
    name: str
    sets: list
    messages: list


def rows() -> list:
    """The table of scenes that differ from a valid one by little."""
    lines = []
    for line in (INVALID / "rows.txt").read_text(encoding="utf-8").splitlines():
        if line.startswith("    "):
            lines[-1] += " " + line.strip()
        elif line.strip() and not line.startswith("#"):
            lines.append(line)
    found, base = [], ""
    for line in lines:
        if line.startswith("base "):
            base = line[len("base "):]
        elif not line.startswith("  "):
            found.append(Row(base, line, [], []))
        elif line.startswith("  --set "):
            found[-1].sets.append(line[len("  --set "):])
        else:
            found[-1].messages.append(line.strip())
    return found


def without_place(line: str, scene: Path, sets: list) -> str:
    """The message of a line that begins with the scene's path and a line, or with what was set."""
    start = f"error: {scene}"
    places = [re.escape(f", from --set {word}") for word in sets] + [r":\d+"]
    match = re.match(f"{re.escape(start)}(?:{'|'.join(places)}): ", line)
    return line[match.end():] if match else f"no place of this scene: {line}"


def files_below(folder: Path) -> dict:
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


class RefusalTest(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)

    def assert_refused(self, result: subprocess.CompletedProcess, *messages: str):
        self.assertEqual(result.stderr, "".join(f"error: {message}\n" for message in messages))
        self.assertEqual(result.stdout, "")
        self.assertEqual(result.returncode, 2)


class InvalidScenes(RefusalTest):
    def test_an_empty_scene_is_said_to_be_empty(self):
        for text in ("", "\n\n", "---\n", "# nothing\n", "null\n"):
            with self.subTest(text=text):
                scene = self.folder / "scene.yaml"
                scene.write_text(text, encoding="utf-8")
                self.assert_refused(abut("check", scene),
                                    f"{scene}: is empty. Write a scene as key: value lines, "
                                    "beginning with time:, bodies:.")

    def test_every_scene_is_refused_with_its_message_and_writes_nothing(self):
        scenes = sorted(INVALID.glob("*.yaml"))
        self.assertGreater(len(scenes), 10, "the scenes are found")
        for scene in scenes:
            with self.subTest(scene=scene.name):
                name, messages = scene.relative_to(ROOT), expected_messages(scene)
                for result in self.whoever_reads(name):
                    self.assert_refused(result, *messages)

    def test_every_row_is_refused_with_its_message_and_writes_nothing(self):
        table = rows()
        self.assertGreater(len(table), 150, "the rows are found")
        self.assertEqual(len({row.name for row in table}), len(table), "each has a name of its own")
        for row in table:
            with self.subTest(row=row.name):
                self.assertTrue(row.sets and row.messages)
                scene = (INVALID / "base" / f"{row.base}.yaml").relative_to(ROOT)
                overrides = [word for change in row.sets for word in ("--set", change)]
                for result in self.whoever_reads(scene, *overrides):
                    said = [without_place(line, scene, row.sets)
                            for line in result.stderr.splitlines()]
                    self.assertEqual(said, row.messages)
                    self.assertEqual((result.stdout, result.returncode), ("", 2))

    def test_every_base_of_a_row_is_valid_and_used(self):
        scenes = sorted((INVALID / "base").glob("*.yaml"))
        self.assertEqual([scene.stem for scene in scenes], sorted({row.base for row in rows()}))
        for scene in scenes:
            with self.subTest(scene=scene.name):
                result = abut("check", scene)
                self.assertEqual((result.returncode, result.stderr), (0, ""))

    def whoever_reads(self, scene: Path, *overrides: str):
        """What check says, and what both ways to run say, which leave their folders as they are."""
        fresh, kept = self.folder / "fresh", self.folder / "kept"
        kept.mkdir(exist_ok=True)
        (kept / "notes.txt").write_text("mine", encoding="utf-8")
        (kept / "summary.json").write_text("{}", encoding="utf-8")
        before = files_below(kept)
        yield abut("check", scene, *overrides)
        yield abut("run", scene, "--out", fresh, *overrides)
        self.assertFalse(fresh.exists())
        yield abut("run", scene, "--local", "--force", "--out", kept, *overrides)
        self.assertEqual(files_below(kept), before)


class RunDirectories(RefusalTest):
    def setUp(self):
        super().setUp()
        self.scene = self.folder / "scene.yaml"
        self.scene.write_text(VALID, encoding="utf-8")

    def test_a_valid_scene_is_accepted(self):
        result = abut("check", self.scene)
        self.assertEqual((result.returncode, result.stderr), (0, ""))

    def test_a_directory_that_holds_a_run_is_refused_and_kept(self):
        for name in ("summary.json", "scene.resolved.yaml"):
            out = self.folder / f"run_{name}"
            out.mkdir()
            (out / name).write_text("mine", encoding="utf-8")
            before = files_below(out)
            self.assert_refused(
                abut("run", self.scene, "--out", out),
                f"{out}: holds a run already. Give another directory with --out, or --force to "
                "replace that run.")
            self.assertEqual(files_below(out), before)

    def test_a_directory_that_cannot_be_written_is_refused(self):
        (self.folder / "file").write_text("mine", encoding="utf-8")
        out = self.folder / "file" / "run"
        self.assert_refused(
            abut("run", self.scene, "--out", out),
            f"{out}: cannot be a run directory: {self.folder / 'file'} is a file. Give another "
            "directory with --out.")
        result = abut("run", self.scene, "--out", "/proc/abut")  # where not even root may write
        self.assertEqual(result.returncode, 2)
        self.assertTrue(result.stderr.startswith("error: /proc/abut: cannot be "), result.stderr)


class CommandLines(RefusalTest):
    def test_a_scene_that_is_not_there_is_refused(self):
        self.assert_refused(abut("check", "no/such.yaml"),
                            "no/such.yaml: cannot be opened. Give the path of a scene file.")

    def test_an_override_says_where_the_value_came_from(self):
        scene = self.folder / "scene.yaml"
        scene.write_text(VALID, encoding="utf-8")
        self.assert_refused(
            abut("check", scene, "--set", "time.window=-1"),
            f"{scene}, from --set time.window=-1: time.window: must be positive, but is -1 s. Give "
            "the length of the controller step in s, greater than 0.")

    def test_a_misspelt_override_is_blamed_itself(self):
        scene = self.folder / "scene.yaml"
        scene.write_text(VALID, encoding="utf-8")
        cases = {
            "tme.window=1.0e-6": "tme: is not a known key. Did you mean time?",
            "time.windw=1.0e-6": "time.windw: is not a known key. Did you mean window?",
            "bodies.bra.initial.velocity=[1.0]": ", which adds bodies.bra: bodies.bra.model: is "
            "missing.",
            "bodies.bar.integrator.newmark.step=1.0e-6": "bodies.bar.integrator.newmark: stands "
            "beside central_difference, but only one can be chosen.",
            "bodies.bar.model.fe.mesh.bra.length=1": "bodies.bar.model.fe.mesh.bra: stands beside "
            "bar, but only one can be chosen."}
        for override, words in cases.items():
            with self.subTest(override=override):
                result = abut("check", scene, "--set", override)
                self.assertEqual(result.returncode, 2)
                first = result.stderr.splitlines()[0]
                self.assertTrue(first.startswith(f"error: {scene}, from --set {override}"), first)
                self.assertIn(words, first)

    def test_unused_features_are_told_when_asked_for(self):
        scene = self.folder / "scene.yaml"
        scene.write_text(VALID, encoding="utf-8")
        self.assertNotIn("closed form", abut("check", scene).stdout)
        self.assertIn("unused     ", abut("check", scene, "--verbose").stdout)

    def test_an_unknown_verb_is_refused(self):
        self.assert_refused(
            abut("rum"),
            "there is no verb rum, and no program abut-rum beside abut or on PATH. "
            "The verbs are listed by abut --help.")

    def test_an_unknown_option_is_refused(self):
        result = abut("run", "scene.yaml", "--fast")
        self.assertEqual((result.returncode, result.stdout), (2, ""))
        self.assertIn("--fast", result.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
