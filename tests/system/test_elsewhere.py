"""Goal: the scenes that run a second time elsewhere (test_scenes.py) have between them whatever
the other shipped scenes have that bodies in processes could get wrong; and what a run has written
as its resolved scene holds every value of the scene, whichever of the two runs next.

Oracle: the resolved scenes of all shared runs, and the texts of the scenes.
usage: test_elsewhere.py ABUT ROOT RUNS SCENE...  the scenes that run elsewhere
"""

import math
import re
import sys
import unittest
from pathlib import Path

import yaml

sys.dont_write_bytecode = True
from support import CONNECTED, ROOT, shared_run  # noqa: E402

CONFIGS = ROOT / "configs"
LISTED = sys.argv[4:]
# Keys by which texts of bodies come from elsewhere, or bodies get to their places.
WRITTEN = {"like", "copies", "table", "file", "launch", "group", "processes", "everything",
           "fields", "overlap", "adjust", "map"}


def read(path: Path) -> dict:
    return yaml.load(path.read_text(encoding="utf-8"), Loader=yaml.CSafeLoader)


def chosen(choice: object) -> str:
    """The name of a choice: a word, or the one key of a map."""
    return next(iter(choice), "") if isinstance(choice, dict) else str(choice or "")


def body_kind(body: dict) -> tuple:
    """Model, scheme and dimension; bars are not solids, nor linear bodies nonlinear ones."""
    model = chosen(body["model"])
    keys = body["model"][model] if isinstance(body["model"], dict) else None
    dimension = int((keys or {}).get("dimension", 1))
    if model == "fe":
        model = "bar" if dimension == 1 else "solid"
        if chosen(body["material"]) != "linear_elastic":
            model = f"nonlinear {model}"
    return model, chosen(body.get("integrator")), dimension


def joint_kind(interface: dict) -> str:
    if "tied" in interface:
        return "overlap" if "overlap" in (interface["tied"] or {}) else "tied"
    return "contact"


def combinations(scene: dict) -> set:
    """(body kind, scheme, joint kind) of every side; and of joints what their messages depend on:
    the transmission, the dimension, friction, and whether tied sides step alike."""
    bodies = {name: body_kind(body) for name, body in scene["bodies"].items()}
    everything = (scene.get("contact") or {}).get("everything") is not None
    found, joined = set(), set(bodies) if everything else set()
    for interface in (scene.get("interfaces") or {}).values():
        joint = joint_kind(interface)
        sides = [bodies[side.split(".")[0]] for side in interface["sides"]]
        joined |= {side.split(".")[0] for side in interface["sides"]}
        found |= {(model, scheme, joint) for model, scheme, _ in sides}
        dimension = sides[0][2]
        found.add((joint, dimension, chosen(interface.get("transmission"))))
        if str(dict(interface.get("contact") or {}).get("friction", "0")) != "0":
            found.add(("friction", dimension))
        if joint != "contact":
            found.add((joint, dimension, "alike" if sides[0][1] == sides[1][1] else "unlike"))
    found |= {(form, "form") for form in [(scene.get("schwarz") or {}).get("form")] if form}
    found |= {(*bodies[name][:2], "contact" if everything else "alone")
              for name in bodies if everything or name not in joined}
    return found


def keys_of(value: object) -> set:
    if isinstance(value, dict):
        return set(map(str, value)).union(*map(keys_of, value.values()))
    return set().union(*map(keys_of, value)) if isinstance(value, list) else set()


def same(said: object, resolved: object) -> bool:
    """Whether one value of a scene says what the resolved scene says."""
    if isinstance(said, bool) or isinstance(resolved, bool):
        return said == resolved
    try:
        return math.isclose(float(said), float(resolved), rel_tol=0.0)
    except (TypeError, ValueError):
        return str(said) == str(resolved)


def missing(said: object, resolved: object, path: str = "") -> list:
    """Paths of what a text says and the resolved one does not."""
    if isinstance(said, dict):
        if not isinstance(resolved, dict):
            return [path]
        found = []
        for key, value in said.items():
            if value is not None:
                found += missing(value, resolved.get(key), f"{path}.{key}")
        return found
    if isinstance(said, list) and isinstance(resolved, list) and len(said) == len(resolved):
        return [place for k, pair in enumerate(zip(said, resolved))
                for place in missing(*pair, f"{path}[{k}]")]
    if isinstance(resolved, dict):  # a choice without keys, as one word, or its one key's value
        return [] if [said] in (list(resolved), list(resolved.values())) else [path]
    if path.endswith(".file"):
        return [] if Path(str(resolved)).name == Path(str(said)).name else [path]
    return [] if same(said, resolved) else [path]


def bodies_own(text: dict, resolved: dict) -> dict:
    """The scene with what bodies say for themselves: the first copy under its own name."""
    bodies = {}
    for name, body in text["bodies"].items():
        own = {key: value for key, value in body.items() if key not in ("like", "copies")}
        if "copies" in body:  # each has a place, and may have motions, of its own
            own.pop("initial", None)
            first = re.compile(rf"{name}_0*1")
            name = next(other for other in resolved["bodies"] if first.fullmatch(other))
        bodies[name] = own
    return {**text, "bodies": bodies}


class Elsewhere(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        names = sorted(path.relative_to(CONFIGS).with_suffix("").as_posix()
                       for path in CONFIGS.rglob("*.yaml"))
        cls.texts = {name: read(CONFIGS / f"{name}.yaml") for name in names
                     if not name.startswith("invalid/") and name != CONNECTED
                     and (shared_run(name) / "scene.resolved.yaml").exists()}
        cls.resolved = {name: read(shared_run(name) / "scene.resolved.yaml") for name in cls.texts}

    def test_listed_scenes_have_every_combination_of_the_shipped_ones(self):
        self.assertGreater(len(self.texts), 150, "the runs are found")
        self.assertEqual(set(LISTED) - set(self.texts), set(), "they are shipped")
        has = {name: combinations(self.resolved[name]) |
               {("written with", key) for key in keys_of(self.texts[name]) & WRITTEN}
               for name in self.texts}
        covered = set().union(*(has[name] for name in LISTED))
        for combination in sorted(set().union(*has.values()) - covered, key=str):
            with self.subTest(combination=combination):
                some = [name for name in has if combination in has[name]]
                self.fail(f"no scene that runs elsewhere has it: list one of {some[:5]} in "
                          "tests/system/CMakeLists.txt")
        for name in LISTED:
            others = set().union(*(has[other] for other in LISTED if other != name))
            with self.subTest(scene=name):
                self.assertTrue(has[name] - others, "others have whatever it has: take it out")

    def test_resolved_scenes_hold_every_value_of_their_scenes(self):
        for name, text in self.texts.items():
            with self.subTest(scene=name):
                resolved = self.resolved[name]
                self.assertEqual(missing(bodies_own(text, resolved), resolved), [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
