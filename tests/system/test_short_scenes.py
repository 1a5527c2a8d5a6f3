"""Goal: a scene may be short: what is left out or shortened means what the long form says. Oracle:
the state at the end of the same scene written out, bit for bit.
usage: test_short_scenes.py ABUT ROOT
"""

import sys
import unittest

sys.dont_write_bytecode = True
from support import ROOT, SystemTest, main  # noqa: E402

LONG = """\
meta: {title: Two bars collide}
time: {begin: 0.0, end: 1.5e-4, window: 1.0e-6}
bodies:
  left:
    model: {fe: {dimension: 1, mesh: {bar: {length: 0.25, elements: 100, area: 1.0e-6}}}}
    material: {linear_elastic: {youngs_modulus: 2.1e11, density: 7850.0}}
    integrator: {central_difference: {step: 2.5e-7}}
    initial: {position: [-0.2501], velocity: [10.0]}
    ports: {tip: {side: right}}
  right:
    model: {fe: {dimension: 1, mesh: {bar: {length: 0.25, elements: 100, area: 1.0e-6}}}}
    material: {linear_elastic: {youngs_modulus: 2.1e11, density: 7850.0}}
    integrator: {central_difference: {step: 2.5e-7}}
    initial: {position: [0.0001], velocity: [-10.0]}
    ports: {tip: {side: left}}
interfaces:
  impact: {sides: [left.tip, right.tip], contact: {}}
"""

SCALARS = """\
time: {end: 1.5e-4, window: 1.0e-6}
bodies:
  left:
    model: {fe: {dimension: 1, mesh: {bar: {length: 0.25, elements: 100, area: 1.0e-6}}}}
    material: {linear_elastic: {youngs_modulus: 2.1e11, density: 7850.0}}
    integrator: {central_difference: {step: 2.5e-7}}
    initial: {position: -0.2501, velocity: 10.0}
    ports: {tip: right}
  right: {like: left, initial: {position: 0.0001, velocity: -10.0}, ports: {tip: left}}
interfaces:
  impact: {sides: [left.tip, right.tip], contact: {}}
"""

WITH_UNITS = """\
meta: {title: Two bars collide}
time: {end: 150 us, window: 1 us}
bodies:
  left:
    model: {fe: {dimension: 1, mesh: {bar: {length: 250 mm, elements: 100, area: 1 mm^2}}}}
    material: steel
    integrator: {central_difference: {step: 0.25 us}}
    initial: {position: -250.1 mm, velocity: 10 m/s}
    ports: {tip: right}
  right: {like: left, initial: {position: 0.1 mm, velocity: -10 m/s}, ports: {tip: left}}
interfaces:
  impact: {sides: [left.tip, right.tip], contact: {}}
"""

COPIES = """\
time: {end: 1.0e-5, window: 1.0e-6}
bodies:
  bar:
    copies: {list: [{position: 0.5}, {position: 1.5, velocity: 2.0}]}
    model: {fe: {dimension: 1, mesh: {bar: {length: 0.25, elements: 4, area: 1.0e-6}}}}
    material: {linear_elastic: {youngs_modulus: 1.0e9, density: 1000.0}}
    integrator: {central_difference: {step: 1.0e-6}}
    initial: {position: 0.25, velocity: 1.0, velocity_field: 0.5 * x}
    points: {middle: 0.375}
  alone: {like: bar, copies: null, initial: {position: 4.0}, points: {middle: 4.125}}
"""


class ShortScenes(SystemTest):
    def state(self, name: str, text: str, *arguments: str) -> str:
        (self.folder / f"{name}.yaml").write_text(text, encoding="utf-8")
        self.succeed(self.abut("run", f"{name}.yaml", "--local", "--force", "--out", self.out,
                               *arguments))
        return self.summary()["state_hash"]

    def resolved(self) -> str:
        return (self.out / "scene.resolved.yaml").read_text(encoding="utf-8")

    def test_two_bars_in_twelve_lines_are_the_long_scene(self):
        self.assertLessEqual(len(SCALARS.splitlines()), 12)
        self.assertEqual(self.state("short", SCALARS), self.state("long", LONG))
        self.assertEqual(len(WITH_UNITS.splitlines()), 12)
        self.assertEqual(self.state("units", WITH_UNITS), self.state("long", LONG))
        self.assertIn(WITH_UNITS, (ROOT / "docs" / "USE.md").read_text(encoding="utf-8"))

    def test_what_is_resolved_is_the_long_form_and_runs_as_the_short_one(self):
        state = self.state("short", SCALARS)
        text = self.resolved()
        for line in ("  title: short\n", "  begin: 0.0  # [s]\n", "      position: [-0.2501]",
                     "      tip:\n        side: right\n"):
            self.assertIn(line, text)
        self.assertEqual(self.state("again", text), state)

    def test_a_list_of_one_is_set_as_a_list(self):
        by_item = self.state("short", SCALARS, "--set", "bodies.left.initial.velocity[0]=20.0")
        self.assertEqual(by_item, self.state("short", SCALARS, "--set",
                                             "bodies.left.initial.velocity=20.0"))
        self.assertNotEqual(by_item, self.state("short", SCALARS))

    def test_copies_move_what_is_written_short_and_null_means_none(self):
        self.state("copies", COPIES)
        text = self.resolved()
        for line in ("position: [0.75]", "position: [1.75]", "velocity: [3.0]", "at: [0.875]",
                     "at: [1.875]", "position: [4.0]", "at: [4.125]",
                     'velocity_field: ["0.5 * (x - 1.5)"]'):
            self.assertIn(line, text)
        self.assertIn("\n  alone:\n", text)
        self.assertNotIn("alone_1", text)

    def test_what_is_too_short_is_refused_as_before(self):
        (self.folder / "short.yaml").write_text(SCALARS, encoding="utf-8")
        for change, words in (
                ("bodies.left.initial.velocity=fast",
                 "bodies.left.initial.velocity: must be a list of numbers, but is fast."),
                ("bodies.left.initial.velocity={x: 1}",
                 "bodies.left.initial.velocity: must be a list of numbers, but is a map."),
                ("bodies.left.ports.tip=null", "has no port tip"),
                ("bodies.left.ports={tip: [right]}", "ports.tip.side: must be text, but is a list"),
                ("bodies.left.copies=null", "")):
            with self.subTest(change):
                said = self.abut("check", "short.yaml", "--set", change)
                self.assertEqual(said.returncode, 2 if words else 0, said.stderr)
                self.assertIn(words, said.stderr)


if __name__ == "__main__":
    main()
