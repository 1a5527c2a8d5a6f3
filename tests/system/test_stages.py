"""Goal: what rests goes on resting: a block that statics have pressed onto another one, or pulled
with one that it is joined to, does not move in a stage of motion under the same load, whatever law,
plane, element, contact and scheme. Oracles: balance of forces; no motion.

usage: test_stages.py ABUT ROOT
"""

import csv
import itertools
import re
import sys

sys.dont_write_bytecode = True
from pressed_stack import MOTION, PASSIVELY, PRESSURE, WIDTH, pressed_stack  # noqa: E402
from support import ROOT, SystemTest, main  # noqa: E402

PRESSURE = 1.0e5  # [Pa] on 0.6 m, 1 m thick, or 0.6 m x 0.6 m; grows until statics end
LAWS = {
    "linear": "linear_elastic: {youngs_modulus: 1.0e7, poissons_ratio: 0.3, density: 1000.0}",
    "kirchhoff": "saint_venant_kirchhoff: {youngs_modulus: 1.0e7, poissons_ratio: 0.3, "
                 "density: 1000.0}",
    "neo": "neo_hookean: {youngs_modulus: 1.0e7, poissons_ratio: 0.3, density: 1000.0}",
    "yields": "j2_plasticity: {youngs_modulus: 1.0e7, poissons_ratio: 0.3, density: 1000.0, "
              "yield_stress: 0.8e5, hardening: 1.0e6}"}
MEETINGS = {
    "contact": "interfaces: {meet: {sides: [low.face, up.face], contact: {}}}",
    "friction": "interfaces: {meet: {sides: [low.face, up.face], contact: {friction: 0.3}}}",
    "everything": "contact: {everything: {friction: 0.1}}",
    "tied": "interfaces: {meet: {sides: [low.face, up.face], tied: {}}}"}
EXPLICIT = "central_difference: {step: 1.0e-3, above_limit: clamp}"
NEWMARK = "newmark: {step: 1.0e-3}"
FINE = "central_difference: {step: 5.0e-4, above_limit: clamp}"
SCHEMES = {  # of the lower and the upper body
    "explicit": (EXPLICIT, EXPLICIT),
    "implicit": ("hht_alpha: {step: 1.0e-3}", NEWMARK),
    "unlike": ("generalized_alpha: {step: 1.0e-3}", FINE),
    "finder of statics in longer steps": (FINE, NEWMARK)}


def scene(dim: int, element: str, law: str, meeting: str, scheme: str) -> str:
    flat = dim == 2
    box = "rectangle" if flat else "box"
    plane = "plane: strain, " if flat else ""
    fixed = ", ".join(f'{axis}: "0"' for axis in "xyz"[:dim])
    guided = ", ".join(f'{axis}: "0"' for axis in "xy"[:dim - 1])
    load = ", ".join(['"0"'] * (dim - 1) + [f'"-{PRESSURE} * min(t, 1)"'])
    bottom, top = ("bottom", "top") if flat else ("back", "front")

    def body(name, lengths, cells, port, rest):
        sizes = lengths if flat else [lengths[0]] + lengths
        counts = cells if flat else [cells[0]] + cells
        return f"""
  {name}:
    model: {{fe: {{dimension: {dim}, {plane}mesh: {{{box}: {{lengths: {sizes},
                elements: {counts}, element: {element}}}}}}}}}
    material: {{{LAWS[law]}}}
    integrator: {{quasi_static: {{step: 0.25}}}}
    ports: {{face: {{side: {port}}}}}
{rest}"""

    held = f"    constraints: {{base: {{on: {bottom}, {fixed}}}}}"
    loaded = f"""    initial: {{position: {[0.2] * (dim - 1) + [1.0]}}}
    constraints: {{guide: {{on: {top}, {guided}}}}}
    loads: {{press: {{on: {top}, traction: [{load}]}}}}"""
    return f"""meta: {{title: Rest}}
time: {{end: 1.0, window: 0.25}}
bodies:{body("low", [1.0, 1.0], [3, 3], top, held)}{body("up", [0.6, 0.8], [2, 2], bottom, loaded)}
{MEETINGS[meeting]}
stages:
  rest:
    time: {{end: 1.05, window: 1.0e-3}}
    bodies:
      low: {{integrator: {{{SCHEMES[scheme][0]}}}}}
      up: {{integrator: {{{SCHEMES[scheme][1]}}}}}
"""


BAR_FORCE = 2.5e5  # [N] = E A d / (2 L): 1e9 Pa, 0.25 m^2, 1 mm of interference, bars of 0.5 m


def pressed_bars(start: str, schemes: tuple, statics="quasi_static: {step: 0.25}", then=(),
                 loaded=False, modal=False) -> str:
    """Two bars between walls, drawn 1 mm into each other, or the second one a load on the first."""
    def body(name, at, cells, wall, tip, more, reduced=False):
        kind = "modal: {modes: 3, " if reduced else "fe: {"
        wall = f'wall: {{on: {wall}, x: "0"}}, ' if wall else ""
        return f"""
  {name}:
    model: {{{kind}dimension: 2, mesh: {{rectangle: {{lengths: [0.5, 0.25],
                elements: {cells}}}}}}}}}
    material: {{linear_elastic: {{youngs_modulus: 1.0e9, poissons_ratio: 0.0, density: 1000.0}}}}
    integrator: {{{statics}}}
    initial: {{position: [{at}, 0.0]{more}}}
    constraints: {{{wall}base: {{on: bottom, y: "0"}}}}
    ports: {{tip: {{side: {tip}}}}}"""

    def stage(these):
        names = zip(("low", "up"), these)
        return "\n    bodies:" + "".join(f"\n      {name}: {{integrator: {{{each}}}}}"
                                         for name, each in names)

    press = """
    loads: {press: {on: right, traction: ["-1.0e6 * min(t / 0.5, 1)", "0"]}}"""
    upper = body("up", 0.5, [12, 4], "", "left", "") + press
    if not loaded:
        upper = body("up", 0.499, [12, 4], "right", "left", "")
    return f"""time: {{end: 1.0, window: 0.25}}
bodies:{body("low", 0.0, [9, 3], "left", "right", start, modal)}{upper}
interfaces: {{meet: {{sides: [low.tip, up.tip], contact: {{}}}}}}
output: {{checkpoint: {{windows: 50}}}}
stages:
  go:
    time: {{end: 1.001, window: 1.0e-5}}
{stage(schemes)}
  on:
    time: {{end: 1.002}}{stage(then) if then else ""}
"""


def dropped(then: str, end: float) -> str:
    """A cell falls onto the ground, where contact is passive; then a stage by another scheme."""
    return f"""
time: {{begin: 0.0, end: {end}, window: 1.0e-3}}
bodies:
  block:
    model: {{fe: {{dimension: 2, mesh: {{rectangle: {{lengths: [0.2, 0.2], elements: [1, 1]}}}}}}}}
    material: {{{LAWS["linear"]}}}
    integrator: {{newmark: {{step: 1.0e-3}}}}
    body_force: [0.0, -9.81]
    initial: {{position: [0.0, 1.0e-3]}}
    ports: {{skin: {{side: boundary}}}}
  ground:
    model: {{rigid_tool: {{dimension: 2, mesh: {{rectangle: {{lengths: [4.0, 0.2],
             elements: [1, 1]}}}}}}}}
    initial: {{position: [-2.0, -0.2]}}
    ports: {{face: {{side: top}}}}
interfaces: {{under: {{sides: [block.skin, ground.face], contact: {{}}}}}}
stages:
  after:
    time: {{end: 0.1, window: 1.0e-3}}
    bodies: {{block: {{integrator: {{{then}}}}}}}
"""


class Passively(SystemTest):
    """A stage may end in the midst of passive windows, wherever the bounce of a cell then is."""

    def run_scene(self, then, end):
        path, out = self.folder / "drop.yaml", self.folder / "drop"
        path.write_text(dropped(then, end), encoding="utf-8")
        return self.abut("run", str(path), "--out", str(out), "--force", "--local"), out

    def test_motion_goes_on_by_another_scheme(self):
        for then, end in itertools.product(
                ("central_difference: {step: 1.0e-4, above_limit: clamp}",
                 "hht_alpha: {step: 5.0e-4}"), (0.014, 0.015, 0.0301, 0.05)):
            with self.subTest(then=then, end=end):
                done, out = self.run_scene(then, end)
                self.assertEqual(done.returncode, 0, done.stderr)
                with open(out / "history.csv", encoding="utf-8") as file:
                    rows = list(csv.DictReader(file))

                def energy(row):
                    return (float(row["block.kinetic [J]"]) + float(row["block.stored [J]"])
                            - float(row["block.external_work [J]"]))
                last = [row for row in rows if float(row["time [s]"]) < end + 0.5e-4][-1]
                begun = rows[rows.index(last) + 1]
                fallen = 40.0 * 9.81 * 1.0e-3  # [J]
                # None is made, but for the rounding of the sums. Central differences tell what
                # vibrates lower by m (h a)^2/8; measured 0.22 %.
                self.assertLess(energy(begun), energy(last) + 1.0e-9 * fallen)
                self.assertGreater(energy(begun), energy(last) - 0.005 * fallen)

    def test_statics_cannot_go_on_from_motion(self):
        done, _ = self.run_scene("quasi_static: {step: 1.0e-3}", 0.05)
        self.assertEqual(done.returncode, 3)
        self.assertIn("body 'block': moves, and a stage without inertia cannot go on from there. "
                      "Give statics before motion, or an implicit integrator", done.stderr)


class Fits(SystemTest):
    """Interference that statics have pressed in stays so: there is nothing to strike or to grow."""

    def run_scene(self, text, *options):
        path, out = self.folder / "fit.yaml", self.folder / "fit"
        path.write_text(text, encoding="utf-8")
        return self.abut("run", str(path), "--out", str(out), "--force", "--local", *options), out

    def test_fits_of_statics_stay_as_they_are(self):
        explicit, newmark = "central_difference: {step: 1.0e-5}", "newmark: {step: 1.0e-5}"
        for start, schemes in itertools.product(
                [", interference: {over: 0}", "", ", interference: {over: 0.5}"],
                [(explicit, explicit), (newmark, newmark), (explicit, newmark)]):
            with self.subTest(start=start, schemes=schemes):
                done, out = self.run_scene(pressed_bars(start, schemes))
                self.assertEqual(done.returncode, 0, done.stderr)
                with open(out / "history.csv", encoding="utf-8") as file:
                    rows = list(csv.DictReader(file))
                self.assertEqual(len(rows), 1 + 4 + 200)
                for row in rows[5:]:  # the tolerance of the sweeps, 1e-6, is of the deformation
                    self.assertAlmostEqual(float(row["low.tip.force_x [N]"]) / -BAR_FORCE, 1.0,
                                           delta=1.0e-8)

    def test_statics_that_go_passively_take_an_overlap(self):
        """The floor and what stabilises bear the load; no stage of motion strikes the floor."""
        load = PRESSURE * WIDTH
        for start in (", interference: {over: 0}", ", interference: {over: 0.5}"):
            with self.subTest(start=start):
                done, out = self.run_scene(pressed_stack(start), *PASSIVELY)
                self.assertEqual(done.returncode, 0, done.stderr)
                summary = self.summary(out)
                self.assertGreater(summary["accuracy"]["given_up"]["passive_windows"], 0)
                measures = summary["measures"]
                held = sum(value for name, value in measures.items()
                           if name.endswith(".stabilisation.force.y"))
                floor = measures["body.b0.floor.reaction.y"]
                # Forces on nodes that are right to some hundredths are in balance far better.
                self.assertAlmostEqual((floor + held) / load, 1.0, delta=1.0e-3)
                done, out = self.run_scene(pressed_stack(start, MOTION))
                self.assertEqual(done.returncode, 0, done.stderr)
                # 0.1 ms is short: no wave of the upper bodies has come through the lowest one.
                after = self.summary(out)["measures"]["body.b0.floor.reaction.y"]
                self.assertAlmostEqual(after / floor, 1.0, delta=1.0e-3)

    def test_a_summary_counts_all_stages(self):
        text = pressed_stack(", interference: {over: 0}", MOTION)
        before = text[:text.index("\nstages:") + 1]
        counts = []
        for scene in (before, text):
            done, out = self.run_scene(scene, *PASSIVELY)
            self.assertEqual(done.returncode, 0, done.stderr)
            told = self.summary(out)
            self.assertEqual(told["contact_windows"], told["measures"]["contact_windows"])
            counts.append((told["accuracy"]["given_up"]["passive_windows"], told["exchanges"]))
        for first, both in zip(*counts):
            self.assertGreater(first, 0)
            self.assertGreater(both, first)

    def test_a_load_presses_on_from_stage_to_stage(self):
        """Of modes or cells below; the second stage of motion changes nothing, or the schemes."""
        explicit, newmark = "central_difference: {step: 1.0e-5}", "newmark: {step: 1.0e-5}"
        alpha = "hht_alpha: {step: 1.0e-5}"
        for modal, first, then in itertools.chain(
                itertools.product([False], (explicit, newmark),
                                  ((), (explicit,) * 2, (alpha,) * 2)),
                itertools.product([True], (newmark,), ((), (alpha,) * 2))):
            with self.subTest(modal=modal, first=first, then=then):
                done, out = self.run_scene(
                    pressed_bars("", (first,) * 2, then=then, loaded=True, modal=modal))
                self.assertEqual(done.returncode, 0, done.stderr)
                with open(out / "history.csv", encoding="utf-8") as file:
                    rows = list(csv.DictReader(file))
                moving = [float(row["low.tip.force_x [N]"]) / -BAR_FORCE for row in rows
                          if float(row["time [s]"]) > 1.0]
                self.assertEqual(len(moving), 200)
                # The upper bar is held by contact alone: what stabilises bore some 1e-5.
                self.assertLess(max(abs(force - 1.0) for force in moving), 1.0e-4)

    def test_weights_of_statics_are_those_of_motion(self):
        """A surface gives its mass to the nodes inside, and its weight stays where it stood."""
        space = "box: {lengths: [0.2, 0.2, 0.1], elements: [3, 3, 2]"
        plane = "rectangle: {lengths: [0.2, 0.1], elements: [5, 3]"
        ground = "mesh: {box: {lengths: [2, 2, 1], elements: [1, 1, 1]}}}}"
        for mesh, scheme in itertools.product(
                [f"3, mesh: {{{space}}}}}", f"3, mesh: {{{space}, element: tet4}}}}",
                 f"2, mesh: {{{plane}}}}}", f"2, mesh: {{{plane}, element: quad8}}}}"],
                ["newmark: {step: 0.002}", "central_difference: {step: 0.0002}",
                 "generalized_alpha: {step: 0.002}", "hht_alpha: {step: 0.002}"]):
            dim = int(mesh[0])
            zeros = "0, " * (dim - 1)
            floor = ground if dim == 3 else ground.replace("box", "rectangle").replace(
                "[2, 2, 1]", "[2, 1]").replace("[1, 1, 1]", "[1, 1]")
            text = f"""
time: {{end: 1.0, window: 0.25}}
bodies:
  floor:
    model: {{rigid_tool: {{dimension: {dim}, {floor}
    initial: {{position: [{"-0.9, " * (dim - 1)}-1]}}
    ports: {{face: {"front" if dim == 3 else "top"}}}
  block:
    model: {{fe: {{dimension: {mesh}}}}}
    material: {{neo_hookean: {{youngs_modulus: 1.0e6, poissons_ratio: 0.3, density: 1000.0}}}}
    integrator: {{quasi_static: {{step: 0.25}}}}
    body_force: [{zeros}-9.81]
    ports: {{skin: boundary}}
interfaces: {{meet: {{sides: [block.skin, floor.face], contact: {{}}}}}}
stages:
  go: {{time: {{end: 1.1, window: 0.002}}, bodies: {{block: {{integrator: {{{scheme}}}}}}}}}
"""
            with self.subTest(mesh=mesh, scheme=scheme):
                done, out = self.run_scene(text)
                self.assertEqual(done.returncode, 0, done.stderr)
                with open(out / "history.csv", encoding="utf-8") as file:
                    rows = [row for row in csv.DictReader(file) if float(row["time [s]"]) > 1.0]
                self.assertGreater(len(rows), 40)
                weight = 9.81 * 1000.0 * (0.004 if dim == 3 else 0.02)
                axis = "z" if dim == 3 else "y"
                for row in rows:  # what stabilises has borne 1e-12 of the weight
                    force = float(row[f"block.skin.force_{axis} [N]"])
                    self.assertAlmostEqual(force / weight, 1.0, delta=1.0e-6)

    def test_modes_of_another_mass_are_refused(self):
        text = pressed_bars("", ("newmark: {step: 1.0e-5, mass: lumped}",) * 2, loaded=True,
                            statics="newmark: {step: 0.25}", modal=True)
        done, _ = self.run_scene(text)
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn("body 'low': goes on with modes of lumped mass, and its state is of "
                      "averaged mass. Give its integrator the same mass in all stages", done.stderr)

    def test_a_later_stage_is_refused_before_the_first_window_by_its_line(self):
        text = pressed_stack(", interference: {over: 0}", MOTION.replace("1.0e-5", "1.0"))
        path, out = self.folder / "fit.yaml", self.folder / "fit"
        for verb in ("check", "run"):
            path.write_text(text, encoding="utf-8")
            done = self.abut(verb, str(path), *(("--out", str(out)) if verb == "run" else ()))
            self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
            self.assertIn("(stage ", done.stderr)
            line = int(re.search(r"fit\.yaml:(\d+): ", done.stderr)[1])
            self.assertIn("1.0", text.splitlines()[line - 1])
            self.assertFalse(out.exists())

    def test_bodies_of_no_stage_have_no_statics_before(self):
        text = pressed_bars(", after_statics: true", ("newmark: {step: 1.0e-5}",) * 2)
        for words in (("run", "--out", str(self.folder / "not")), ("check", "--probe", "0")):
            path = self.folder / "fit.yaml"
            path.write_text(text, encoding="utf-8")
            done = self.abut(words[0], str(path), *words[1:])
            self.assertEqual(done.returncode, 2)
            self.assertIn("bodies.low.initial.after_statics: is true, but nothing was before",
                          done.stderr)


class Rest(SystemTest):
    def check(self, *kind, above="[2, 2]"):
        path = self.folder / "scene.yaml"
        text = scene(*kind).replace("elements: [2, 2]", f"elements: {above}")
        path.write_text(text, encoding="utf-8")
        out = self.folder / "run"
        self.succeed(self.abut("run", path, "--local", "--force", "--out", out))
        with open(out / "history.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        kinetic, stored = (max(sum(float(value) for name, value in row.items()
                                   if name.endswith(f"{energy} [J]")) for row in rows)
                           for energy in (".kinetic", ".stored"))
        # Waves that a change of the force by 3e-4 of it would set up.
        self.assertLess(kinetic, 1.0e-7 * stored)
        self.assertGreater(stored, 0.0)
        pressed = [(float(row["time [s]"]), float(row[f"low.face.force_{'xyz'[kind[0] - 1]} [N]"]))
                   for row in rows]
        statics = next(force for time, force in pressed if time >= 1.0 - 1.0e-9)
        self.assertLess(statics, -0.9 * PRESSURE * 0.6 ** (kind[0] - 1))
        for time, force in pressed:
            if time > 1.0:  # of what stabilises, some 1e-5 of the force, and of the sweeps
                self.assertAlmostEqual(force / statics, 1.0, delta=1.0e-3, msg=f"at {time}")

    def test_in_the_plane(self):
        for kind in itertools.product(("quad4", "tri3"), LAWS, MEETINGS, SCHEMES):
            with self.subTest(kind=kind):
                self.check(2, *kind)

    def test_bodies_without_a_node_inside(self):
        """They have massless surfaces in statics alone, and passive contact in motion."""
        for kind in itertools.product(LAWS, ("friction", "everything"), SCHEMES):
            with self.subTest(kind=kind):
                self.check(2, "quad4", *kind, above="[1, 1]")

    def test_quotes_make_no_other_model(self):
        """As scenes in JSON have them; the body goes on with what statics have left."""
        self.check(2, '"quad4"', "linear", "contact", "implicit")

    def test_in_space(self):
        for law, meeting in (("linear", "friction"), ("neo", "tied"), ("yields", "contact")):
            with self.subTest(law=law, meeting=meeting):
                self.check(3, "hex8", law, meeting, "implicit")

    def test_places_of_the_bodies_change_no_bit(self):
        """What presses at the end of statics goes on pressing in other processes, too."""
        path = ROOT / "configs" / "contact" / "preload_then_impact.yaml"
        outs = [self.folder / "one", self.folder / "several"]
        for out, words in zip(outs, (["--local"], [])):
            self.succeed(self.abut("run", path, "--out", out, "--set", "meta.expect=[]", "--set",
                                   "stages.impact.time.end=1.00005", "--set",
                                   "output.force_filter=null", *words))
        one, several = (self.summary(out) for out in outs)
        self.assertEqual(one["state_hash"], several["state_hash"])
        self.assertEqual(*((out / "history.csv").read_bytes() for out in outs))


if __name__ == "__main__":
    main()
