"""Goal: a body that goes on as another model or on another mesh keeps what the models have in
common. Oracles: momentum and angular momentum are numbers that a swap must not change; on the same
mesh rigid motion is the same motion; an energy that both meshes can have stays; the same impact
without a swap.

usage: test_swaps.py ABUT ROOT
"""

import csv
import itertools
import math
import sys

import yaml

sys.dont_write_bytecode = True
from support import ROOT, SystemTest, main  # noqa: E402

LAWS = {"linear": "linear_elastic", "kirchhoff": "saint_venant_kirchhoff", "neo": "neo_hookean"}
SCHEMES = {"explicit": "central_difference: {step: 1.0e-5}", "newmark": "newmark: {step: 1.0e-5}",
           "hht": "hht_alpha: {step: 1.0e-5}", "generalised": "generalized_alpha: {step: 1.0e-5}"}
RIGID = "rigid_motion: {step: 1.0e-5}"
ELEMENTS = {2: ("quad4", "tri3", "quad8"), 3: ("hex8", "tet4")}
# Of sums of products over a hundred nodes, and of their projections.
ROUNDING = 1.0e-12


def model(dim: int, kind: str, cells: list, element: str) -> str:
    box, lengths = ("rectangle", [0.2, 0.1]) if dim == 2 else ("box", [0.2, 0.1, 0.1])
    mesh = f"mesh: {{{box}: {{lengths: {lengths}, elements: {cells}, element: {element}}}}}"
    return f"{kind}: {{dimension: {dim}, {'modes: 6, ' if kind == 'modal' else ''}{mesh}}}"


def scene(dim: int, law: str, steps: list, field: list, more: str = "") -> str:
    """A free body. steps: a model and an integrator of every stage, which has two windows."""
    first, *rest = steps
    stages = "".join(f"""
  s{k}:
    time: {{end: {2.0e-5 * (k + 2)}}}
    bodies: {{block: {{model: {{{one}}}, integrator: {{{scheme}}}{more}}}}}"""
                     for k, (one, scheme) in enumerate(rest))
    return f"""meta: {{title: Swaps}}
time: {{end: 2.0e-5, window: 1.0e-5}}
bodies:
  block:
    model: {{{first[0]}}}
    material: {{{LAWS[law]}: {{youngs_modulus: 1.0e7, poissons_ratio: 0.3, density: 1000.0}}}}
    integrator: {{{first[1]}}}
    initial: {{velocity_field: {field}}}
    ports: {{skin: {{side: boundary}}}}
stages:{stages}
"""


def waves(dim: int) -> list:
    """No rigid motion, no polynomial: [m/s]."""
    return ["3 + sin(9*x + 4*y)", "7*x - 2 + cos(11*y)", "5*y + sin(8*x*z)"][:dim]


def spin(dim: int) -> list:
    return ["3 - 20*y", "20*x - 2 - 6*z", "6*y"][:dim] if dim == 3 else ["3 - 20*y", "20*x - 2"]


class Swaps(SystemTest):
    def run_text(self, text: str, *words: str, code: int = 0) -> list:
        """Swaps of the run of a scene."""
        path = self.folder / "scene.yaml"
        path.write_text(text, encoding="utf-8")
        said = self.abut("run", path, "--force", "--out", self.out, *(words or ("--local",)))
        self.assertEqual(said.returncode, code, said.stdout + said.stderr)
        return self.summary().get("swaps", []) if code == 0 else said.stderr

    def assert_kept(self, swap: dict, what: object):
        mass, extent = swap["mass"]["before"], 0.2
        speed = math.sqrt(2.0 * swap["kinetic"]["before"] / mass)
        scales = {"momentum": mass * speed, "angular_momentum": mass * speed * extent}
        for name, scale in scales.items():
            for one, other in zip(swap[name]["before"], swap[name]["after"]):
                self.assertAlmostEqual(one / scale, other / scale, delta=ROUNDING,
                                       msg=f"{name} of {what}")
        before, after = (swap["kinetic"][at] + swap["stored"][at] for at in ("before", "after"))
        self.assertAlmostEqual(swap["given_up"], before - after, delta=ROUNDING * before)

    def assert_balanced(self, what: object):
        """What is given up is dissipated, what is added is work: the account has no step."""
        with open(self.out / "history.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        sums = [float(row["block.total [J]"]) + float(row["block.dissipated [J]"])
                - float(row["block.external_work [J]"]) for row in rows]
        # Schemes that damp take a part of 1e-4 in these few steps.
        for total in sums:
            self.assertAlmostEqual(total / sums[0], 1.0, delta=5.0e-4, msg=f"{what}")

    def test_momenta_are_kept_from_any_model_to_any_other(self):
        for dim, law in itertools.product((2, 3), LAWS):
            coarse, fine = ([4, 2], [7, 5]) if dim == 2 else ([4, 2, 2], [5, 3, 4])
            for number, element in enumerate(ELEMENTS[dim]):
                other = ELEMENTS[dim][number - 1]
                schemes = list(SCHEMES.values())
                one, two = schemes[number], schemes[(number + 1 + dim) % 4]
                steps = [(model(dim, "fe", coarse, element), one),
                         (model(dim, "fe", fine, other), two),
                         (model(dim, "fe", coarse, other), one),
                         (model(dim, "rigid", fine, element), RIGID),
                         (model(dim, "fe", coarse, element), two),
                         (model(dim, "rigid", coarse, element), RIGID)]
                if law == "linear":
                    steps[2:2] = [(model(dim, "modal", coarse, element), one),
                                  (model(dim, "fe", coarse, element), two)]
                with self.subTest(dim=dim, law=law, element=element):
                    swaps = self.run_text(scene(dim, law, steps, waves(dim)))
                    self.assertEqual(len(swaps), len(steps) - 1)
                    for k, swap in enumerate(swaps):
                        self.assert_kept(swap, (k, dim, law, element))
                        self.assertEqual(swap["time"], self.events()[k]["time"])
                    self.assert_balanced((dim, law, element))

    def test_every_scheme_takes_over_from_every_other(self):
        for one, two in itertools.permutations(SCHEMES.values(), 2):
            for law in LAWS:
                with self.subTest(one=one, two=two, law=law):
                    steps = [(model(2, "fe", [4, 2], "quad4"), one),
                             (model(2, "fe", [5, 3], "quad4"), two)]
                    for swap in self.run_text(scene(2, law, steps, waves(2))):
                        self.assert_kept(swap, (one, two, law))

    def test_rigid_motion_goes_from_model_to_model_as_it_is(self):
        for dim, law in itertools.product((2, 3), ("kirchhoff", "neo")):
            cells = [4, 2] if dim == 2 else [4, 2, 2]
            kinds = [("rigid", RIGID), ("fe", "newmark: {step: 1.0e-5, mass: consistent}")]
            element = ELEMENTS[dim][0]
            steps = [(model(dim, *(kind, cells, element)), scheme) for kind, scheme in kinds]
            with self.subTest(dim=dim, law=law):
                swap, = self.run_text(scene(dim, law, steps, spin(dim)))
                self.assert_kept(swap, (dim, law))
                self.assertAlmostEqual(swap["given_up"] / swap["kinetic"]["before"], 0.0,
                                       delta=ROUNDING)
                self.assertLess(swap["stored"]["after"], ROUNDING * swap["kinetic"]["before"])

    def test_what_both_meshes_can_have_keeps_its_energy(self):
        """From a mesh to one that divides its cells, whose fields hold those of the coarse one."""
        consistent = "newmark: {step: 1.0e-5, mass: consistent}"
        for dim, elements in ((2, ("quad4", "tri3")), (3, ("hex8",))):
            coarse, fine = ([4, 2], [8, 4]) if dim == 2 else ([4, 2, 2], [8, 4, 4])
            for element in elements:
                with self.subTest(dim=dim, element=element):
                    steps = [(model(dim, "fe", cells, element), consistent)
                             for cells in (coarse, fine)]
                    swap, = self.run_text(scene(dim, "linear", steps, waves(dim)))
                    for kind in ("kinetic", "stored"):
                        self.assertAlmostEqual(swap[kind]["after"] / swap[kind]["before"], 1.0,
                                               delta=1.0e-10, msg=f"{kind}: digits of solves")

    def test_energy_converges_with_the_coarser_mesh(self):
        """From fine to coarse: second order, so that half the cells give up a quarter."""
        lost = []
        for count in (2, 4, 8):
            steps = [(model(2, "fe", cells, "quad4"), "newmark: {step: 1.0e-5, mass: consistent}")
                     for cells in ([32, 16], [2 * count, count])]
            swap, = self.run_text(scene(2, "linear", steps, waves(2)))
            lost.append(abs(swap["kinetic"]["after"] - swap["kinetic"]["before"]))
        for coarse, fine in zip(lost, lost[1:]):
            self.assertGreater(coarse / fine, 3.5)

    def test_a_page_draws_bodies_that_change_their_mesh(self):
        steps = [(model(2, "rigid", [4, 2], "quad4"), RIGID),
                 (model(2, "fe", [7, 5], "tri3"), SCHEMES["newmark"])]
        self.run_text(scene(2, "neo", steps, spin(2)) + "output: {fields: {every: 1}}\n")
        self.succeed(self.abut("report", self.out))
        page = (self.out / "report.html").read_text(encoding="utf-8")
        self.assertIn("fe, 70 tri3", page)

    def test_a_stage_with_the_same_model_swaps_nothing(self):
        steps = [(model(2, "fe", [4, 2], "quad4"), SCHEMES["newmark"])] * 2
        self.assertEqual(self.run_text(scene(2, "neo", steps, waves(2))), [])

    def test_places_of_the_bodies_change_no_bit(self):
        path = ROOT / "configs" / "contact" / "rigid_until_contact.yaml"
        outs = [self.folder / "one", self.folder / "several"]
        for out, words in zip(outs, (["--local"], [])):
            self.succeed(self.abut("run", path, "--out", out, *words))
        one, several = (self.summary(out) for out in outs)
        self.assertEqual(one["state_hash"], several["state_hash"])
        self.assertEqual(one["swaps"], several["swaps"])
        self.assertEqual(*((out / "history.csv").read_bytes() for out in outs))

    def test_a_blow_is_that_of_bodies_without_a_swap(self):
        path = ROOT / "configs" / "contact" / "rigid_until_contact.yaml"
        text = path.read_text(encoding="utf-8")
        self.run_text(text)
        swapped = self.summary()
        begin, end = text.index("time:"), text.index("stages:")
        fe = text[begin:end]
        fe = fe.replace("{end: 2.0e-4, window: 5.0e-6, until: {contact: blow}}",
                        "{end: 8.0e-4, window: 2.0e-6}")
        fe = fe.replace("{rigid: {", "{fe: {plane: strain, ")
        fe = fe.replace("rigid_motion: {step: 5.0e-6}", "central_difference: {step: 1.0e-6}")
        self.run_text("meta: {title: Whole}\n" + fe)
        whole = self.summary()
        window = 2.0e-6
        for name, delta in (("begin", window), ("end", 2.0 * window)):
            key = f"contact.blow.{name}"
            self.assertAlmostEqual(swapped["measures"][key], whole["measures"][key], delta=delta)
        # Windows lie elsewhere against the blow: a step more or less of the front.
        for key, relative in (("contact.blow.impulse", 1.0e-3), ("contact.blow.force_peak", 0.05)):
            self.assertAlmostEqual(swapped["measures"][key] / whole["measures"][key], 1.0,
                                   delta=relative, msg=key)
        last = [swap for swap in swapped["swaps"] if "rigid" in swap["to"]]
        self.assertEqual(len(last), 2)
        # In flight only vibration is stored, and all of it is given up.
        for swap in last:
            self.assertGreaterEqual(swap["given_up"], 0.0)
            self.assertEqual(swap["stored"]["after"], 0.0)

    def two(self, models: list, more: str, stage: str, meeting: str = "interfaces: {meet: {sides: "
            "[low.face, up.face], contact: {}}}", law: str = "linear_elastic",
            keys: str = "") -> str:
        """Two blocks, one above the other, 1 mm apart unless they are tied; the upper one falls."""
        gap = 0.0 if "tied" in meeting else 1.0e-3
        bodies = "".join(f"""
  {name}:
    model: {{{kind}}}
    material: {{{law}: {{youngs_modulus: 1.0e7, poissons_ratio: 0.3, density: 1000.0{keys}}}}}
    integrator: {{{RIGID if 'rigid' in kind else SCHEMES['newmark']}}}
    initial: {{position: [0.0, {place}], velocity: [0.0, {speed}]}}
    ports: {{face: {{side: {side}}}}}"""
                         for name, kind, place, speed, side in (
                             ("low", models[0], 0.0, 0.0, "top"),
                             ("up", models[1], 0.1 + gap, 0.0 if gap == 0.0 else -10.0, "bottom")))
        return f"""meta: {{title: Two}}
time: {{end: 3.0e-4, window: 1.0e-5{more}}}
bodies:{bodies}
{meeting}
stages:
{stage}
"""

    FE = model(2, "fe", [4, 2], "quad4")
    FINE = model(2, "fe", [7, 3], "quad4")
    RUNG = model(2, "rigid", [4, 2], "quad4")

    def stage(self, kind: str, end: float = 6.0e-4, more: str = "") -> str:
        scheme = RIGID if "rigid" in kind else SCHEMES["newmark"]
        return (f"  s:\n    time: {{end: {end}{more}}}\n    bodies: "
                f"{{up: {{model: {{{kind}}}, integrator: {{{scheme}}}}}}}")

    def test_contact_begins_after_a_swap(self):
        """Whatever pairs of surfaces and models there are, the blow is that of finite elements."""
        everything = "contact: {everything: {}}"
        named = "interfaces: {meet: {sides: [low.face, up.face], contact: {friction: 0.3}}}"
        impulses = []
        for first, meeting in itertools.product((self.FE, self.RUNG, self.FINE),
                                                (named, everything)):
            name = "everything" if meeting == everything else "meet"
            for more in ("", f", until: {{contact: {name}}}"):
                text = self.two([self.FE, first], more, self.stage(self.FINE), meeting)
                if not more:
                    text = text.replace("end: 3.0e-4", "end: 5.0e-5")
                with self.subTest(first=first, meeting=name, more=more):
                    swaps = self.run_text(text)
                    self.assertEqual(len(swaps), 0 if first == self.FINE else 1)
                    for swap in swaps:
                        self.assert_kept(swap, first)
                        self.assertLess(swap["time"], 1.0e-4 + 1.0e-12, "1 mm at 10 m/s")
                        self.assertGreater(swap["time"], 4.9e-5 if not more else 6.0e-5)
                    impulses.append(self.summary()["measures"][f"contact.{name}.impulse"])
        for impulse in impulses:  # windows lie elsewhere against the blow
            self.assertAlmostEqual(impulse / impulses[-1], 1.0, delta=5.0e-3)

    def test_ties_are_made_for_the_new_body(self):
        tied = "interfaces: {meet: {sides: [low.face, up.face], tied: {}}}"
        text = self.two([self.FE, self.FE], "", self.stage(self.FINE), tied)
        text = text.replace("position: [0.0, 0.1], velocity: [0.0, 0.0]",
                            "position: [0.0, 0.1], velocity_field: [\"20*y - 2\", \"9*sin(9*x)\"]")
        swap, = self.run_text(text.replace("end: 3.0e-4", "end: 5.0e-5"))
        self.assert_kept(swap, "tied")
        with open(self.out / "history.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        for axis in "xy":  # momentum of both goes on after the swap as before
            sums = [sum(float(row[f"{body}.momentum_{axis} [kg m/s]"]) for body in ("low", "up"))
                    for row in rows]
            for each in sums:
                self.assertAlmostEqual(each, sums[0], delta=1.0e-9 * 20.0)

    def test_a_stage_waits_for_what_does_not_come(self):
        text = self.two([self.FE, self.RUNG], ", until: {apart: meet}", self.stage(self.FE))
        self.run_text(text.replace("end: 3.0e-4", "end: 5.0e-5"))
        told = [event["text"] for event in self.events() if event["kind"] == "warning"]
        words = "the end of contact 'meet' has not come"
        self.assertTrue(any(words in each for each in told), told)

    def test_an_event_ends_a_run_without_further_stages(self):
        text = self.two([self.FE, self.FE], ", until: {contact: meet}", "")
        self.run_text(text.replace("stages:\n", ""))
        summary = self.summary()
        self.assertEqual(summary["status"], "completed")
        # 1 mm at 10 m/s: they touch with the end of a window, and press in the next one.
        self.assertAlmostEqual(summary["time"]["reached"], 1.0e-4, delta=1.0e-12)
        self.assertEqual(summary["measures"]["contact.meet.count"], 0)

    def test_what_cannot_go_over_is_refused_in_words(self):
        plastic = ", yield_stress: 1.0e4, hardening: 1.0e5"
        cases = [
            (self.two([self.FE, self.FE], "", self.stage(self.FINE)).replace(
                "end: 3.0e-4", "end: 1.2e-4"), 3, "presses where a stage begins"),
            (self.two([self.FE, self.FE], "", self.stage(self.FINE, 9.0e-3), law="j2_plasticity",
                      keys=plastic).replace("end: 3.0e-4", "end: 8.0e-3"), 3,
             "has a history, equivalent_plastic_strain"),
            (self.two([self.FE, self.FE], "", self.stage(self.FINE)).replace(
                "newmark", "quasi_static", 2), 2, "is another after statics"),
            (self.two([self.FE, self.FE], ", until: {contact: nobody}", self.stage(self.FINE)), 2,
             "until.contact: is nobody, but the scene has no contact of that name. Choose one of: "
             "meet."),
            (self.two([self.FE, self.FE], "", self.stage("rigid_wall: {}")), 2,
             "is rigid_wall, and of another model no other one takes over"),
            (scene(2, "linear", [(self.RUNG, RIGID), (self.FE, SCHEMES["newmark"])],
                   ["-1000*y", "1000*x"]), 3, "has turned by 0.02 rad as a rigid one")]
        for text, code, words in cases:
            with self.subTest(words=words):
                self.assertIn(words, self.run_text(text, code=code))
                if code != 3:
                    continue
                summary = self.summary()
                self.assertEqual(summary["status"], "failed")
                self.assertIn(words, summary["reason"])

    def test_a_stage_that_cannot_begin_goes_on_as_another(self):
        """Keys of stages to come are no part of a state, but for whose model is another."""
        fine = model(2, "rigid", [7, 5], "quad4")
        turning = ["-1000*y", "1000*x"]  # 0.02 rad: too far for a law of small strain
        self.run_text(scene(2, "linear", [(self.RUNG, RIGID), (fine, RIGID)], turning))
        wanted = self.summary()["state_hash"]
        self.run_text(scene(2, "linear", [(self.RUNG, RIGID), (self.FE, SCHEMES["newmark"])],
                            turning), code=3)
        stage = next(iter(yaml.safe_load((self.folder / "scene.yaml").read_text())["stages"]))
        own = f"stages.{stage}.bodies.block"
        rigid = ["--set", f"{own}.integrator={{{RIGID}}}", "--set"]
        for words, change in (("is that of the stage before", f"{own}.model={{{self.RUNG}}}"),
                              ("stages.other: is no stage to come", "stages.other.time.end=1.0")):
            refused = self.abut("resume", self.out, "--local", *rigid, change)
            self.assertEqual(refused.returncode, 2, refused.stderr)
            self.assertIn(words, refused.stderr)
        self.succeed(self.abut("resume", self.out, "--local", *rigid, f"{own}.model={{{fine}}}"))
        self.assertEqual(self.summary()["state_hash"], wanted)


if __name__ == "__main__":
    main()
