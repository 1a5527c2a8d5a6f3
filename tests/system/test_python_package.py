"""Goal: what the Python package `abut` derives for a body is right: impulses, normals, kernels,
kept states, pictures; and solids, statics and several ports on it run like those of abut.
Oracles: closed forms, identities, the same scene with two bodies of abut.
usage: test_python_package.py ABUT ROOT [CLASS...]
"""

import math
import sys
import unittest

import numpy as np

sys.dont_write_bytecode = True
from support import ABUT, PACKAGE, ROOT, SystemTest, main  # noqa: E402

EXAMPLES = ROOT / "examples" / "python_body"
sys.path[:0] = [str(PACKAGE), str(EXAMPLES)]
from abut import Body, InputError, Point, Surface  # noqa: E402
from abut.answers import Answers  # noqa: E402
from abut.body import packed, unpacked  # noqa: E402
from abut.forces import impulses, values  # noqa: E402
from abut.served import Served  # noqa: E402
from abut.v1 import subdomain_pb2 as pb  # noqa: E402
from mass_on_spring import Mass  # noqa: E402
from my_body import Plate  # noqa: E402

ROUNDING = 1.0e-12  # of sums of a few terms
SCENE = EXAMPLES / "plates.yaml"


class Given(dict):
    """Keys in a test."""

    def positive(self, name, unit=""):
        return self[name]

    number = positive


MASS = Given(mass=0.2, stiffness=8.0e5, position=0.0, step=5.0e-6)
PLATE = Given(lengths=[1.0, 0.5], cells=[4, 2], corner=[0.0, 0.0], velocity=[1.0, -2.0],
              youngs_modulus=1.0e9, poissons_ratio=0.3, density=1000.0, step=1.0e-5)


def wave(support: int, time, f, points=()):
    width = np.size(f) // len(time)
    return pb.Waveform(support=support, time=time, f=np.ravel(f).tolist(), width=width,
                       points=points)


class Impulses(unittest.TestCase):
    def test_a_line_brings_its_integral_in_any_steps(self):
        time = [0.0, 0.3, 1.0]
        line = wave(pb.FORCE_SUPPORT_LINEAR, time, [[2.0 * t, -t] for t in time])
        at = np.array([0.0, 0.1, 0.45, 0.9, 1.0])
        got = impulses([line], at, 2)
        expected = np.diff(at**2)
        self.assertLess(np.abs(got - np.column_stack([expected, -expected / 2])).max(), ROUNDING)

    def test_steps_and_dual_cells_bring_theirs(self):
        time = [0.0, 0.4, 1.0]
        step = wave(pb.FORCE_SUPPORT_STEP, time, [9.0, 1.0, 2.0])
        self.assertLess(abs(impulses([step], [0.2, 0.7], 1)[0, 0] - (0.2 * 1 + 0.3 * 2)), ROUNDING)
        nodal = wave(pb.FORCE_SUPPORT_NODAL, time, [9.0, 1.0, 2.0])  # cells end at 0.2 and 0.7
        self.assertLess(abs(impulses([nodal], [0.1, 0.8], 1)[0, 0] -
                            (0.1 * 9 + 0.5 * 1 + 0.1 * 2)), ROUNDING)

    def test_a_body_without_inertia_balances_the_force_at_the_end_of_a_step(self):
        time = [0.0, 0.4, 1.0]
        for support, expected in ((pb.FORCE_SUPPORT_STEP, [1.0, 2.0]),
                                  (pb.FORCE_SUPPORT_LINEAR, [5.0, 2.0])):
            got = values([wave(support, time, [9.0, 1.0, 2.0])], [0.0, 0.2, 1.0], 1)
            self.assertLess(np.abs(got.ravel() - expected).max(), ROUNDING)

    def test_partners_add_up_and_may_press_some_points(self):
        all_points = wave(pb.FORCE_SUPPORT_STEP, [0.0, 1.0], [[0.0] * 6, [1.0] * 6])
        last = wave(pb.FORCE_SUPPORT_STEP, [0.0, 1.0], [[0.0, 0.0], [3.0, 4.0]], points=[2])
        self.assertEqual(impulses([all_points, pb.Waveform(), last], [0.0, 1.0], 6).tolist(),
                         [[1.0, 1.0, 1.0, 1.0, 4.0, 5.0]])


class Surfaces(unittest.TestCase):
    SQUARE = [[0, 0], [1, 0], [1, 1], [0, 1]]
    CUBE = [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    SIDES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]

    def test_normals_look_outward(self):
        for points, facets in ((self.SQUARE, [(0, 1), (1, 2), (2, 3), (3, 0)]),
                               (self.CUBE, self.SIDES)):
            surface = Surface(points, facets)
            away = surface.points - surface.points.mean(axis=0)
            away /= np.linalg.norm(away, axis=1)[:, None]
            self.assertLess(np.abs(surface.normals - away).max(), ROUNDING)
            self.assertEqual(surface.spacing, 1.0)

    def test_what_is_wrong_is_told(self):
        inside_out = [facet[::-1] for facet in self.SIDES]
        for points, facets, words in (
                (self.SQUARE, [(1, 0), (2, 1), (3, 2), (0, 3)], "facets look into the body"),
                (self.CUBE, inside_out, "facets look into the body"),
                (self.SQUARE, [(0, 4)], "is none of 4 points"),
                (self.SQUARE, [(0, 1, 2)], "lists (2,) points"),
                (self.SQUARE, [(0, 1)], "point 2 has no normal"),
                ([[0.0], [1.0]], [(0, 1)], "has a Point")):
            with self.subTest(words), self.assertRaises(InputError) as raised:
                Surface(points, facets)
            self.assertIn(words, str(raised.exception))


class Derived(unittest.TestCase):
    def probe(self, served, **asked):
        reply = pb.Reply()
        answers = Answers(None, lambda: None)
        answers.served = served
        answers.answer(pb.Request(probe=pb.Probe(**asked)), reply)
        return reply.kernel

    def test_the_kernel_of_a_mass_on_a_spring_is_found_by_trying(self):
        served = Served(Mass(MASS))
        served.step(1.0e-4, [np.array([50.0])])  # its present state does not matter
        before = served.to_bytes()
        h, count = 3.0e-5, 4
        kernel = self.probe(served, port=0, step=h, count=count, patterns=[1.0, -2.0])
        self.assertEqual(served.to_bytes(), before, "a probe leaves the state as it is")
        k, w = MASS["stiffness"], math.sqrt(MASS["stiffness"] / MASS["mass"])
        unit = [(math.cos(w * i * h) - math.cos(w * (i + 1) * h)) / k for i in range(count)]
        expected = np.outer(unit, [1.0, -2.0]).ravel()
        # cosines near 1 leave w h = 0.06 of their digits
        self.assertLess(np.abs(np.array(kernel.displacement) / expected - 1.0).max(), 1.0e-11)
        self.assertEqual((kernel.support, kernel.patterns, kernel.width),
                         (pb.FORCE_SUPPORT_STEP, 2, 1))

    def test_kernels_are_symmetric_whatever_velocity_the_body_begins_with(self):
        served = Served(Plate(PLATE))
        n = served.width(0)
        kernel = self.probe(served, port=0, step=1.0e-5, count=3, patterns=np.eye(n).ravel())
        told = np.array(kernel.displacement).reshape(3, n, n)
        for each in told:  # ways of 1e-5 m hide 1e-21 m in their last digit, and these are 1e-11 m
            self.assertLess(np.abs(each - each.T).max() / np.abs(each).max(), 1.0e-8)

    def test_a_state_comes_back_to_the_bit(self):
        rng = np.random.default_rng(1)
        forces = [rng.normal(size=Served(Plate(PLATE)).width(0)) * 1e5 for _ in range(6)]
        served = Served(Plate(PLATE))
        served.step(1.0e-5, [forces[0]])
        kept, written = served.snapshot(), served.to_bytes()
        ends = []
        for way in range(3):
            if way == 2:  # a new process
                served = Served(Plate(PLATE))
                served.from_bytes(written)
            for force in forces[1:]:
                served.step(1.0e-5, [force])
            ends.append(served.to_bytes())
            served.return_to(kept)
        self.assertEqual(ends[0], ends[1])
        self.assertEqual(ends[0], ends[2])
        self.assertEqual(served.to_bytes(), written)

    def test_kept_numbers_are_exact_and_nothing_else_is_kept(self):
        values = {"a": np.array([0.1, -0.0, 1e-310]), "b": np.array(3), "c": np.eye(2, dtype=bool)}
        back = unpacked(packed(values))
        self.assertEqual({name: value.tobytes() for name, value in back.items()},
                         {name: value.tobytes() for name, value in values.items()})
        with self.assertRaises(InputError):
            packed({"a": np.array("word")})

    def test_what_a_body_forgets_is_told(self):
        class Forgetful(Body):
            u = v = 0.0

            def surface(self):
                return Point(0.0, 1.0)
        with self.assertRaises(InputError) as raised:
            Served(Forgetful())
        self.assertIn("Set mass [kg]", str(raised.exception))
        body = Mass(MASS)
        body.u = [0.0, 1.0]
        with self.assertRaises(InputError) as raised:
            Served(body)
        self.assertIn("has 2 numbers at port face, not 1", str(raised.exception))

    def test_arrays_of_one_number_are_taken_for_it_and_others_refused(self):
        """What is told of a window, where a user's methods give arrays."""
        def told(own):
            body = type("Own", (Mass,), own)(MASS)
            reply, answers = pb.Reply(), Answers(None, lambda: None)
            answers.served = Served(body)
            force = wave(pb.FORCE_SUPPORT_STEP, [0.0, 1.0e-5], [[50.0], [50.0]])
            ask = pb.Advance(window=pb.TimeWindow(begin=0.0, end=1.0e-5), records=1,
                             boundary=[pb.BoundaryData(forces=[force])])
            answers.answer(pb.Request(advance=ask), reply)
            self.assertEqual(reply.WhichOneof("body"), "advanced")
            return reply.advanced

        def step(given):
            return {"step": lambda body, dt, force: Mass.step(body, dt, force) or given}
        for array in (np.array([0.25]), np.array([[0.25]]), np.float32(0.25), [0.25]):
            self.assertEqual(told(step(array)).ports[0].work, 0.5)  # of two steps
            own = {"energy": lambda body, e=array: (e, 0.0), "speed_bound": lambda body, e=array: e}
            self.assertEqual(told(own).records[0].kinetic, 0.25)
            self.assertEqual(told(own).ports[0].speed_bound, 0.25)
        for wrong, words in ((np.zeros(2), "gives 2 numbers where one is meant: the energy [J]"),
                             ("much", "gives what is no number"), ({}, "gives what is no number")):
            with self.subTest(words), self.assertRaises(InputError) as raised:
                told(step(wrong))
            self.assertIn("step(): " + words, str(raised.exception))

    def test_patches_of_a_plate_stretch_without_force_inside(self):
        """The example's own mechanics: a linear motion is in balance at inner nodes."""
        plate = Plate(PLATE)
        plate.u = plate.points @ np.array([[1e-3, 2e-4], [-5e-4, 3e-4]])
        force = (plate.stiffness @ plate.u.ravel()).reshape(-1, 2)
        inner = np.setdiff1d(np.arange(len(plate.points)), plate.rim)
        self.assertLess(np.abs(force[inner]).max(), ROUNDING * np.abs(force).max())


STATICS = """from my_body import Plate
import numpy as np
from abut import serve

class Block(Plate):
    quasi_static, state = True, ("u",)
    def __init__(self, keys):
        super().__init__(keys)
        free = np.ones(self.points.shape, bool)
        free[self.points[:, 1] == 0.0, 1] = False
        free[0, 0] = False
        self.free = np.flatnonzero(free.ravel())
        self.inverse = np.linalg.inv(self.stiffness[np.ix_(self.free, self.free)])
    def step(self, dt, force):
        f = np.zeros_like(self.u)
        f[self.rim] = force
        u = np.zeros(self.u.size)
        u[self.free] = self.inverse @ f.ravel()[self.free]
        self.u = u.reshape(-1, 2)
    def momentum(self):
        return np.zeros(2)
serve(Block)
"""

ONE_END = """from abut import Body, Point, serve


class Mass(Body):
    state = ("u", "v")
    conserves = linear = True

    def __init__(self, keys):
        self.mass, self.substep, self.u = keys.positive("mass"), 5.0e-6, 0.0
        self.v, self.surface_mass = keys.number("velocity"), self.mass
        self.at, self.looks, self.spacing = map(keys.number, ("at", "looks", "spacing"))

    def surface(self):
        return Point(self.at, self.looks, spacing=self.spacing)

    def step(self, dt, force):
        before = self.v
        self.v += dt * force / self.mass
        self.u += dt * (before + self.v) / 2


serve(Mass)
"""
TWO_ENDS = """from math import cos, sin
from abut import Body, Energy, Point, serve

class Spring(Body):
    \"\"\"Two masses and the spring between them: half the mass at either end.\"\"\"
    mass, substep, state, conserves, linear = 2.0e-4, 1.0e-6, ("u", "v"), True, True
    def __init__(self, keys):
        self.k, self.at = keys.positive("stiffness"), keys.number("at")
        self.u, self.v = [0.0, 0.0], [0.0, 0.0]
    def surface(self):
        return {"left": Point(self.at, -1.0), "right": Point(self.at + 0.1, 1.0)}
    def step(self, dt, force):
        m, f = self.mass / 2, (force["left"], force["right"])
        half = [self.v[i] + dt / 2 * self.pull(i, f[i]) / m for i in (0, 1)]
        self.u = [self.u[i] + dt * half[i] for i in (0, 1)]
        self.v = [half[i] + dt / 2 * self.pull(i, f[i]) / m for i in (0, 1)]
    def pull(self, i, f):
        return f + self.k * (self.u[1 - i] - self.u[i])
    def displacement(self):
        return {"left": self.u[0], "right": self.u[1]}
    def velocity(self):
        return {"left": self.v[0], "right": self.v[1]}
    def energy(self):
        return Energy(self.mass / 4 * (self.v[0]**2 + self.v[1]**2),
                      self.k / 2 * (self.u[1] - self.u[0])**2)
    def momentum(self):
        return [self.mass / 2 * sum(self.v)]
    def save(self):
        return {"u": list(self.u), "v": list(self.v)}
    def restore(self, saved):
        self.u, self.v = list(saved["u"]), list(saved["v"])
    def from_bytes(self, data):
        return {name: value.tolist() for name, value in super().from_bytes(data).items()}
serve(Spring)
"""


class Runs(SystemTest):
    def write(self, name: str, text: str):
        path = self.folder / name
        if name.endswith(".py"):
            text = f"#!{sys.executable}\nimport sys\nsys.path.insert(0, {str(EXAMPLES)!r})\n{text}"
        path.write_text(text, encoding="utf-8")
        path.chmod(0o755)
        self.allow(path)
        return path

    def plates(self):
        text = SCENE.read_text("utf-8").replace("./my_body.py", str(EXAMPLES / "my_body.py"))
        self.environment["PYTHONDONTWRITEBYTECODE"] = "1"
        self.allow(EXAMPLES / "my_body.py")
        return self.write("plates.yaml", text)

    def test_a_solid_in_the_plane_collides_and_is_drawn_as_ours(self):
        self.succeed(self.abut("run", self.plates(), "--out", self.out))
        self.assert_whole(self.out)
        drawn = self.folder / "plates.png"
        self.succeed(self.abut("picture", self.out, "--time", "2.0e-3", "--field", "displacement",
                               "--out", drawn))
        self.assertEqual(drawn.read_bytes()[:4], b"\x89PNG")

    def test_such_a_run_goes_on_to_the_same_bits(self):
        scene, keep = self.plates(), ["--set", "output.checkpoint={windows: 50}"]
        self.succeed(self.abut("run", scene, "--out", self.out, *keep))
        part = self.folder / "part"
        self.succeed(self.abut("run", scene, "--out", part, *keep, "--set", "time.end=1.25e-3",
                               "--set", "meta.expect=[]"))
        self.succeed(self.abut("resume", part, "--scene", scene))
        self.assertEqual(self.summary(part)["state_hash"], self.summary()["state_hash"])
        self.assertEqual((part / "history.csv").read_bytes(),
                         (self.out / "history.csv").read_bytes())

    def test_a_run_goes_on_from_another_folder_than_it_began_in(self):
        """Its program is named from the folder where it began."""
        self.write("mass.py", ONE_END)
        body = ("    launch: {spawn: {program: ./mass.py}}\n    model: {external: {mass: 0.2, "
                "at: %s, looks: %s, velocity: %s, spacing: 0.01}}\n")
        scene = self.write("masses.yaml", "time: {end: 1.0e-3, window: 2.0e-5}\nbodies:\n  one:\n"
                           + body % (0.0, 1.0, 1.0) + "  two:\n" + body % (0.001, -1.0, 0.0) +
                           "interfaces:\n  impact: {sides: [one.face, two.face], contact: {}}\n"
                           "output: {checkpoint: {windows: 10}}\n")
        self.succeed(self.abut("run", scene, "--out", self.out))
        resolved = (self.out / "scene.resolved.yaml").read_text("utf-8")
        self.assertEqual(resolved.count(f'program: "{self.folder}/mass.py"'), 2)
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        self.succeed(self.end(self.start("env", "-C", elsewhere, ABUT, "resume", self.out, "--end",
                                         "2.0e-3")))
        self.assertEqual(self.summary()["status"], "completed")

    def test_a_body_without_inertia_passes_the_patch_test(self):
        program = self.write("block.py", STATICS)
        text = (ROOT / "configs/contact/patch_2d.yaml").read_text("utf-8")
        ours = text[text.index("  lower:"):text.index("interfaces:")]
        keys = ("{lengths: [1.0, 0.5], cells: [6, 3], corner: [0.0, 0.0], velocity: [0.0, 0.0], "
                "youngs_modulus: 1.0e+9, poissons_ratio: 0.3, density: 1000.0, step: 1.0}")
        text = text.replace(ours, f"  lower:\n    launch: {{spawn: {{program: {program}}}}}\n"
                                  f"    model: {{external: {keys}}}\n")
        text = "\n".join(line for line in text.splitlines() if "body.lower" not in line)
        self.succeed(self.abut("run", self.write("patch.yaml", text), "--out", self.out))
        stress = self.summary()["measures"]["body.upper.nodal_stress.yy.max"]
        # what the coordinator knows of a stranger is its kernel and its replies, as of our block
        self.assertLess(abs(stress / -1.098901098901099e5 - 1.0), 1.0e-9)

    def test_two_masses_in_one_dimension_exchange_momentum_and_lose_nothing(self):
        """Neither finds contact: they meet passively."""
        program = self.write("mass.py", ONE_END)
        body = ("    launch: {{spawn: {{program: {}}}}}\n    model: {{external: {{mass: {}, "
                "at: {}, looks: {}, velocity: {}, spacing: {}}}}}\n")
        for spacing, code in ((0.01, 0), (0.0, 2)):
            scene = ("time: {end: 2.0e-3, window: 2.0e-5}\nbodies:\n"
                     f"  one:\n{body.format(program, 0.2, 0.0, 1.0, 1.0, spacing)}"
                     f"  two:\n{body.format(program, 0.1, 0.001, -1.0, 0.0, 0.0)}"
                     "interfaces:\n  impact: {sides: [one.face, two.face], contact: {}}\n")
            result = self.abut("run", self.write("masses.yaml", scene), "--out",
                               self.folder / f"out {code}")
            self.assertEqual(result.returncode, code, result.stdout + result.stderr)
            if code:
                self.assertIn("neither tells the spacing", result.stderr)
                continue
            measures = self.summary(self.folder / "out 0")["measures"]
            # 2 m M / (m + M) (v - V): elastic; impulses are found to some millionths
            self.assertLess(abs(measures["contact.impact.impulse"] / (0.4 / 3.0) - 1.0), 1.0e-4)
            self.assertLess(abs(measures["energy.total.relative_drift_end"]), 1.0e-5)  # the same
            self.assertLess(measures["momentum.total"], 1.0e-12)  # round-off

    def test_a_bar_in_modes_meets_a_mass(self):
        """Neither finds contact. The bar is a dashpot Z = rho c A to the mass for 2 L/c."""
        program = self.write("mass.py", ONE_END)
        scene = ("time: {end: 2.0e-3, window: 2.0e-5}\nbodies:\n  bar:\n    model: {modal: "
                 "{dimension: 1, mesh: {bar: {length: 0.5, elements: 200, area: 1.0e-4}}, "
                 "modes: 40}}\n    material: {linear_elastic: {youngs_modulus: 1.0e9, "
                 "density: 1000.0}}\n    integrator: {newmark: {step: 2.0e-6}}\n"
                 "    initial: {position: [-0.5001], velocity: [1.0]}\n    ports: {tip: right}\n"
                 f"  mass:\n    launch: {{spawn: {{program: {program}}}}}\n    model: {{external: "
                 "{mass: 0.2, at: 0.0, looks: -1.0, velocity: 0.0, spacing: 0.0}}\n"
                 "interfaces:\n  impact: {sides: [bar.tip, mass.face], contact: {}}\n")
        self.succeed(self.abut("run", self.write("modal.yaml", scene), "--out", self.out))
        measures = self.summary()["measures"]
        # 40 modes round the front: measured 0.7 % of momentum, 0.4 % of the duration
        exact = 0.2 * (1.0 - math.exp(-100.0 * 1.0e-3 / 0.2))
        self.assertLess(abs(measures["momentum.mass.end"] / exact - 1.0), 0.01)
        self.assertLess(abs(measures["contact.impact.duration"] / 1.0e-3 - 1.0), 0.01)  # as above
        self.assertLess(measures["momentum.total"], 1.0e-12)  # round-off

    def test_a_body_with_two_ports_hands_an_impact_on(self):
        """A bar hits two masses with a spring between, and they hit a second bar."""
        program = self.write("spring.py", TWO_ENDS)
        text = (ROOT / "configs/two_bars.yaml").read_text("utf-8")
        left = text[text.index("  left:"):text.index("  right:")]
        scene = ("time: {end: 1.2e-3, window: 1.0e-5}\nbodies:\n" + left +
                 f"  spring:\n    launch: {{spawn: {{program: {program}}}}}\n"
                 "    model: {external: {stiffness: 1.0e+5, at: -0.01}}\n"
                 "  right: {like: left, initial: {position: [0.1], velocity: [0.0]}, "
                 "ports: {tip: {side: left}}}\n"
                 "interfaces:\n  one: {sides: [left.tip, spring.left], contact: {}}\n"
                 "  two: {sides: [spring.right, right.tip], contact: {}}\n")
        self.succeed(self.abut("run", self.write("row.yaml", scene), "--out", self.out))
        measures = self.summary()["measures"]
        self.assertLess(measures["momentum.total"], 1.0e-12)  # round-off
        self.assertGreaterEqual(measures["contact.two.closings"], 1)
        # explicit steps of 1e-6 s against a period of 1.4e-4 s, and what layers of bars leave
        self.assertLess(abs(measures["energy.total.relative_drift_end"]), 1.0e-3)


if __name__ == "__main__":
    main()
