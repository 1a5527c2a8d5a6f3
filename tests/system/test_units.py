"""Goal: numbers with units, materials by name and a declared system mean the same scene as plain SI
numbers, and nothing is mixed silently. Oracles: the state at the end, bit for bit; measures times
the ratio of the units; the messages.
usage: test_units.py ABUT ROOT
"""

import math
import re
import sys
import unittest

sys.dont_write_bytecode = True
from support import PACKAGE, ROOT, SystemTest, main  # noqa: E402

sys.path.insert(0, str(PACKAGE))
from abut_tools import units as unit_words  # noqa: E402

PLAIN = """\
meta: {title: A steel bar hits a wall}
time: {end: 1.2e-4, window: 2.0e-6}
bodies:
  bar:
    model: {fe: {dimension: 1, mesh: {bar: {length: 0.25, elements: 50, area: 1.0e-4}}}}
    material: {linear_elastic: {youngs_modulus: 2.1e11, density: 7850.0}}
    integrator: {central_difference: {step: 5.0e-7}}
    initial: {position: -0.2501, velocity: 10.0}
    ports: {tip: right}
  wall: {model: rigid_wall, ports: {face: left}}
interfaces:
  impact: {sides: [bar.tip, wall.face], contact: {}}
"""

WITH_UNITS = """\
meta: {title: A steel bar hits a wall}
time: {end: 120 us, window: 2 us}
bodies:
  bar:
    model: {fe: {dimension: 1, mesh: {bar: {length: 250 mm, elements: 50, area: 1 cm^2}}}}
    material: steel
    integrator: {central_difference: {step: "0.5 us"}}
    initial: {position: -250.1 mm, velocity: [36 km/h]}
    ports: {tip: right}
  wall: {model: rigid_wall, ports: {face: left}}
interfaces:
  impact: {sides: [bar.tip, wall.face], contact: {}}
"""

MILLIMETRES = """\
units: mm t s
meta: {title: A steel bar hits a wall}
time: {end: 1.2e-4, window: 2 us}
bodies:
  bar:
    model: {fe: {dimension: 1, mesh: {bar: {length: 250.0, elements: 50, area: 1 cm^2}}}}
    material: steel
    integrator: {central_difference: {step: 5.0e-7}}
    initial: {position: -250.1, velocity: 10 m/s}
    ports: {tip: right}
  wall: {model: rigid_wall, ports: {face: left}}
interfaces:
  impact: {sides: [bar.tip, wall.face], contact: {}}
network: {request_deadline: 2 min}
"""

BLOCK = """\
time: {end: 10 us, window: 5 us}
bodies:
  block:
    copies: {grid: {count: [2, 1], spacing: [3 cm, 0 m]}}
    model:
      fe:
        dimension: 2
        thickness: 1 mm
        mesh: {rectangle: {lengths: [20 mm, 1 cm], elements: [2, 1]}}
    material: {neo_hookean: aluminium}
    integrator: {newmark: {step: 5 us}}
    initial: {position: [1 mm, 0.0]}
    loads: {top: {on: top, pressure: 2 MPa}}
    constraints: {foot: {on: bottom, y: 0.01 mm, x: "0"}}
"""


class Units(SystemTest):
    def state(self, text: str, *arguments: str) -> str:
        (self.folder / "scene.yaml").write_text(text, encoding="utf-8")
        self.succeed(self.abut("run", "scene.yaml", "--local", "--force", "--out", self.out,
                               *arguments))
        return self.summary()["state_hash"]

    def resolved(self) -> str:
        return (self.out / "scene.resolved.yaml").read_text(encoding="utf-8")

    def refused(self, text: str, *changes: str) -> str:
        (self.folder / "scene.yaml").write_text(text, encoding="utf-8")
        said = self.abut("check", "scene.yaml", *[w for one in changes for w in ("--set", one)])
        self.assertEqual((said.returncode, said.stdout), (2, ""), said.stderr)
        return said.stderr

    def test_numbers_with_units_are_the_plain_ones_bit_for_bit(self):
        with_units = WITH_UNITS.replace("[36 km/h]", "10 m/s")
        self.assertEqual(self.state(with_units), self.state(PLAIN))
        self.assertEqual(self.state(with_units.replace("10 m/s", "[10 m/s]")), self.state(PLAIN))

    def test_they_are_the_same_in_processes(self):
        here = self.state(MILLIMETRES)
        self.succeed(self.abut("run", "scene.yaml", "--force", "--out", self.out))
        self.assertEqual(self.summary()["state_hash"], here)

    def test_a_declared_system_is_the_same_collision_in_its_own_numbers(self):
        self.state(PLAIN)
        metres = self.summary()["measures"]
        self.state(MILLIMETRES)
        millimetres = self.summary()["measures"]
        for measure, ratio in (("mean_velocity.bar.end", 1.0e3), ("contact.impact.force_peak", 1.0),
                               ("contact.impact.begin", 1.0), ("momentum.bar.end", 1.0)):
            self.assertTrue(math.isclose(millimetres[measure], ratio * metres[measure],
                                         rel_tol=1.0e-9), measure)

    def test_what_is_told_of_a_run_has_the_words_of_its_system(self):
        self.state(MILLIMETRES)
        closed = [event for event in self.events() if event["kind"] == "contact_closed"]
        self.assertIn("closes at 10000 mm/s;", closed[0]["text"])
        milliseconds = MILLIMETRES.replace("mm t s", "mm kg ms").replace(
            "end: 1.2e-4", "end: 0.12").replace("step: 5.0e-7", "step: 5.0e-4")
        self.state(milliseconds)
        bar = next(body for body in self.summary()["bodies"] if body["name"] == "bar")
        self.assertIn("step 0.0005 ms", bar["model"])
        checked = self.succeed(self.abut("check", "scene.yaml", "--probe", "0"))
        self.assertIn("step 0.0005 ms", checked.stdout)
        told = self.abut("run", "scene.yaml", "--local", "--force", "--out", self.out)
        self.assertRegex(told.stderr, r"e-02 ms: contact 'impact' closes at 10 mm/ms;")

    def test_what_is_refused_once_bodies_are_there_has_the_words_of_its_system(self):
        self.assertIn("overlap by 0.5 mm at the start",
                      self.refused(MILLIMETRES.replace("-250.1", "-249.5")))

    def test_what_is_resolved_tells_the_systems_words_and_runs_again(self):
        state = self.state(MILLIMETRES)
        text = self.resolved()
        for line in ("units: \"mm t s\"\n", "youngs_modulus: 210000.0  # [MPa]\n",
                     "density: 7.85e-09  # [t/mm^3]\n", "velocity: [10000.0]  # [mm/s]\n",
                     "area: 100.0  # [mm^2]\n", "request_deadline: 120.0  # [s (clock)]\n"):
            self.assertIn(line, text)
        self.assertEqual(self.state(text), state)
        self.state(WITH_UNITS.replace("[36 km/h]", "10 m/s"))
        self.assertIn("youngs_modulus: 210000000000.0  # [Pa]\n", self.resolved())

    def test_copies_expressions_and_laws_take_them_too(self):
        self.state(BLOCK)
        text = self.resolved()
        for line in ("position: [0.001, 0.0]", "position: [0.031, 0.0]", "pressure: \"2000000\"",
                     "      neo_hookean:\n        youngs_modulus: 70000000000.0", "y: \"1e-05\"",
                     "thickness: 0.001"):
            self.assertIn(line, text)

    def test_pages_have_the_units_that_the_document_of_the_output_tells_of_measures(self):
        """Of the first name of every row of its table."""
        text = (ROOT / "docs" / "OUTPUT.md").read_text(encoding="utf-8")
        table = text[text.index("| `contact.INTERFACE.begin` |"):]
        rows = re.findall(r"^\| `([^`]+)`[^|]*\|([^|,]*)[^|]*\|",
                          table[:table.index("\n\n")], re.MULTILINE)
        units = [unit for _, unit in rows if unit.strip(" -")]
        self.assertGreater(len(units), 35, "the table is found")
        self.assertGreater(len(rows), len(units) + 15, "and what has no unit")
        for name, unit in rows:
            with self.subTest(name):
                self.assertEqual(unit_words.measure_unit(name), unit.strip(" -"))

    def test_words_of_units_that_no_summary_lists_are_made_of_those_that_it_does(self):
        units = unit_words.Units({
            "m": "mm", "s": "s", "kg": "t", "N*s": "t*mm/s", "Pa": "MPa"})
        for unit, word in (("m", "mm"), ("N s", "t mm/s"), ("kg m^2/s", "t mm^2/s"), ("Pa", "MPa"),
                           ("rad", "rad"), ("%", "%"), ("", ""), ("s (clock)", "s (clock)")):
            self.assertEqual(units.word(unit), word)
        self.assertEqual(units.text("depth [m], share [%]"), "depth [mm], share [%]")
        self.assertEqual(unit_words.Units().word("kg m^2/s"), "kg m^2/s")

    def test_a_divided_scene_keeps_the_system(self):
        block = "units: mm t s\n" + BLOCK.replace("    copies: {grid: {count: [2, 1], "
                                                  "spacing: [3 cm, 0 m]}}\n", "")
        (self.folder / "scene.yaml").write_text(block, encoding="utf-8")
        self.succeed(self.abut("split", "scene.yaml", "--bodies", 2, "--out", "parts"))
        text = (self.folder / "parts" / "scene.yaml").read_text(encoding="utf-8")
        self.assertIn("units: \"mm t s\"\n", text)
        self.assertIn("youngs_modulus: 70000.0  # [MPa]\n", text)

    def test_units_beside_plain_numbers_are_refused_where_nothing_says_what_those_are(self):
        self.assertEqual(
            self.refused(PLAIN, "bodies.bar.material=steel"),
            "error: scene.yaml:2: time.end: is a number without a unit, but bodies.bar.material "
            "stands for numbers with units. Give it a unit, or say what numbers without one are "
            "in: units: SI, or units: mm t s.\n")
        self.assertIn("time.window: is a number without a unit, but time.end has one.",
                      self.refused(PLAIN, "time.end=120 us"))
        self.assertIn("bodies.block.loads.top.pressure: is a number without a unit, but "
                      "bodies.block.copies.grid.spacing[0] has one.", self.refused(
                          BLOCK, "bodies.block.loads.top.pressure=1.0e6 * t"))
        self.state(PLAIN, "--set", "units=SI", "--set", "bodies.bar.material=steel")

    def test_a_unit_of_another_kind_is_refused(self):
        for change, words in (
                ("bodies.bar.material={linear_elastic: {youngs_modulus: 1 GPa, density: 5 mm}}",
                 "density: is 5 mm, a length, but must be a density. Give the reference density in "
                 "kg/m^3, greater than 0."),
                ("bodies.bar.initial.velocity=3 m/s^2",
                 "velocity: is 3 m/s^2, an acceleration, but must be a velocity."),
                ("bodies.bar.initial.velocity=[3 furlong]",
                 "velocity[0]: is 3 furlong, but furlong is not a known unit. Give the uniform "),
                ("bodies.bar.model.fe.mesh.bar.elements=5 mm",
                 "elements: must be a whole number, but is 5 mm."),
                ("bodies.bar.model.fe.mesh.bar.grading=2 mm",
                 "grading: is 2 mm, a length, but must be a pure number."),
                ("bodies.bar.model.fe.mesh.bar.length=-5 mm",
                 "length: must be positive, but is -5 mm. Give the length of the bar in m, "),
                ("network.request_deadline=5 mm",
                 "request_deadline: is 5 mm, a length, but must be a time."),
                ("units=mm t", "units: is mm t, which is no system of units. Write SI, or a "),
                ("units=[mm, t, s]", "units: must be text, but is a list.")):
            with self.subTest(change):
                self.assertIn(words, self.refused(WITH_UNITS, change))
        self.assertIn("Give the reference density in t/mm^3, greater than 0.", self.refused(
            MILLIMETRES, "bodies.bar.material={linear_elastic: {youngs_modulus: 1 GPa, "
            "density: -1.0}}"))

    def test_a_material_that_is_not_known_is_refused_with_those_that_are(self):
        self.assertIn("bodies.bar.material: is stel, which is not a known choice. Did you mean "
                      "steel? Choose one of linear_elastic, ",
                      self.refused(WITH_UNITS, "bodies.bar.material=stel"))
        self.assertIn("bodies.bar.material.hencky: is stel, which is not a known choice. Did you "
                      "mean steel? Give a map of keys, or one of steel, ",
                      self.refused(WITH_UNITS, "bodies.bar.material={hencky: stel}"))

    def test_materials_are_listed_with_their_sources(self):
        page = (ROOT / "docs" / "REFERENCE.md").read_text(encoding="utf-8")
        self.assertIn("| steel | `{linear_elastic: {youngs_modulus: 210 GPa, poissons_ratio: "
                      "0.3, density: 7850 kg/m^3}}` | structural steel: EN 1993-1-1:2005", page)


if __name__ == "__main__":
    main()
