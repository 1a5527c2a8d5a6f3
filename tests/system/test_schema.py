"""Goal: the JSON Schema that `abut reference --json-schema` prints takes every shipped scene, and
refuses what a scene is refused for by its form. Oracles: the shipped scenes; the messages of
configs/invalid.
usage: test_schema.py ABUT ROOT      exit code 77 (skipped) without Python's jsonschema
"""

import json
import re
import subprocess
import sys
import unittest
from pathlib import Path

import yaml

sys.dont_write_bytecode = True
from test_invalid_scenes import rows  # noqa: E402
from support import ABUT, ROOT, SystemTest, main  # noqa: E402

try:
    from jsonschema import Draft7Validator
except ImportError:
    sys.exit(77)

INVALID = ROOT / "configs" / "invalid"
# What a schema can know of a key alone, in the words of the messages.
FORM = re.compile(r"is not a known key\.|is missing\. (Give|Write its|Choose)|not a known choice|"
                  r": must be (?!after|finite|given|a multiple)|: is stel, ")
# And what is told in the same words, but follows from other keys, or from the number's last bits.
ACROSS = {"density_of_nothing", "body_against_itself", "internal_between_bodies",
          "copies_listed_with_a_wrong_key", "tool_turned_about_no_axis",
          "box_of_too_many_elements"}


class Loader(yaml.SafeLoader):
    """YAML 1.2, as editors read it: 1e-6 is a number, and yes a word."""


Loader.yaml_implicit_resolvers = {}
for tag, pattern, first in (
        ("null", r"~|null|", ["~", "n", ""]), ("bool", r"true|false", list("tf")),
        ("int", r"[-+]?[0-9]+", list("-+0123456789")),
        ("float", r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?", list("-+.0123456789"))):
    Loader.add_implicit_resolver(f"tag:yaml.org,2002:{tag}", re.compile(f"^(?:{pattern})$"), first)


def read(text: str) -> object:
    return yaml.load(text, Loader)


def put(scene: dict, setting: str) -> None:
    """As --set does; a key with a list's index is of no row that is used here."""
    path, value = setting.split("=", 1)
    *steps, last = path.split(".")
    for step in steps:
        if not isinstance(scene.get(step), dict):
            scene[step] = {}
        scene = scene[step]
    if read(value) is None:
        scene.pop(last, None)
    else:
        scene[last] = read(value)


class Schema(SystemTest):
    @classmethod
    def setUpClass(cls):
        said = subprocess.run([ABUT, "reference", "--json-schema"], capture_output=True, text=True,
                              check=True).stdout
        cls.schema = json.loads(said)
        Draft7Validator.check_schema(cls.schema)
        cls.validator = Draft7Validator(cls.schema)

    def faults(self, scene: object) -> list:
        return [f"{'.'.join(map(str, error.path))}: {error.message[:200]}"
                for error in self.validator.iter_errors(scene)]

    def test_every_shipped_scene_is_taken(self):
        scenes = [path for path in (ROOT / "configs").rglob("*.yaml")
                  if INVALID not in path.parents]
        self.assertGreater(len(scenes), 150)
        for path in scenes:
            with self.subTest(path.relative_to(ROOT)):
                self.assertEqual(self.faults(read(path.read_text(encoding="utf-8"))), [])

    def test_scenes_to_begin_with_are_taken(self):
        for kind in ("bars", "contact", "friction", "joined"):
            self.succeed(self.abut("init", kind, "--from", kind))
        self.succeed(self.abut("init", "gmsh", "--from", "gmsh",
                               ROOT / "configs" / "meshes" / "block.msh"))
        for path in self.folder.glob("*.yaml"):
            with self.subTest(path.name):
                self.assertEqual(self.faults(read(path.read_text(encoding="utf-8"))), [])

    def test_what_scenes_are_refused_for_by_their_form_is_refused(self):
        refused = 0
        for row in rows():
            if not FORM.search(row.messages[0]) or re.search(r"[\[*]", row.sets[0].split("=")[0]):
                continue
            scene = read((INVALID / "base" / f"{row.base}.yaml").read_text(encoding="utf-8"))
            for setting in row.sets:
                put(scene, setting)
            refused += 1
            with self.subTest(row.name):
                self.assertEqual(not self.faults(scene), row.name in ACROSS)
        self.assertGreater(refused, 20, "rows of this kind are found")

    def test_units_are_those_of_the_quantity(self):
        text = (ROOT / "configs" / "two_bars.yaml").read_text(encoding="utf-8")
        for setting, taken in (
                ("time.end=150 us", True), ("time.end=1.5e-4s", True), ("time.end=0.1 m/m*s", True),
                ("time.end=150 kg", False), ("time.end=150 parsec", False),
                ("time.end=150 m/parsec", False), ("units=SI", True), ("units=mm t s", True),
                ("units=ms, mm, kg", True), ("units=furlong", False), ("units=mm t", False)):
            scene = read(text)
            put(scene, setting)
            with self.subTest(setting):
                self.assertEqual(self.faults(scene) == [], taken)

    def test_refused_files_are_refused_by_their_form(self):
        for name in ("missing_key", "missing_section", "unknown_key", "unknown_section",
                     "not_a_scene", "several_errors", "empty"):
            with self.subTest(name):
                scene = read((INVALID / f"{name}.yaml").read_text(encoding="utf-8"))
                self.assertNotEqual(self.faults(scene), [])


if __name__ == "__main__":
    main()
