"""Goal: solids of others collide with ours as ours do with each other: expectations of the shipped
scenes are closed forms, which are held here; and their bodies keep the contract.

usage: test_foreign_solids.py ABUT ROOT CLASS      exit code 77 (skipped) without what a class needs
"""

import csv
import importlib.util
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import zipfile

import numpy as np
from support import ABUT, PACKAGE, ROOT, SystemTest, main

EXAMPLES = ROOT / "examples"


class ForeignTest(SystemTest):
    def setUp(self):
        super().setUp()
        self.environment["PYTHONPATH"] = str(PACKAGE)
        self.environment["PYTHONDONTWRITEBYTECODE"] = "1"

    def own_scene(self, folder: str, scene: str, program: str, other: str = ""):
        """Programs are named from the folder that a run is started in. other: in its place."""
        place = EXAMPLES / folder
        text = (place / scene).read_text("utf-8")
        self.assertIn(f"./{program}", text)
        own, started = self.folder / scene, place / (other or program)
        own.write_text(text.replace(f"./{program}", str(started)), encoding="utf-8")
        self.allow(started)
        return own

    def collide(self, folder: str, scene: str, program: str):
        self.succeed(self.abut("run", self.own_scene(folder, scene, program), "--out", self.out))
        self.assert_whole(self.out)

    def conform(self, program, keys: str, linear: bool = True):
        said = self.succeed(self.abut("conformance", program, "--keys", keys)).stdout
        for clause in ("restore", "momentum", "work", "checkpoint", "lost"):
            self.assertRegex(said, f"{clause} +kept")
        self.assertRegex(said, f"kernel +{'kept' if linear else 'not asked'}")


class Brick(ForeignTest):
    def test_a_brick_meets_a_bar_in_space(self):
        """Whose angular momentum nobody tells: so neither it nor that of both has a value."""
        self.collide("python_body", "bricks.yaml", "brick.py")
        measures = self.summary()["measures"]
        for name in ("total", "right.end_x", "right.end_y", "right.end_z"):
            self.assertIsNone(measures[f"angular_momentum.{name}"])
        self.assertIsNotNone(measures["angular_momentum.left.end_x"])

    def test_a_brick_keeps_the_contract(self):
        self.conform(EXAMPLES / "python_body" / "brick.py",
                     "{lengths: [0.3, 0.2, 0.2], cells: [3, 2, 2], corner: [0, 0, 0], velocity: "
                     "[0, 0, 0], youngs_modulus: 1.0e9, poissons_ratio: 0.3, density: 1000, "
                     "step: 1.0e-5}")


class Pair(ForeignTest):
    def test_two_bodies_of_the_package_meet(self):
        self.collide("python_body", "two_plates.yaml", "my_body.py")
        self.assertGreater(self.summary()["accuracy"]["given_up"]["passive_windows"], 0)


class Events(ForeignTest):
    def test_stages_end_with_contact_of_bodies_that_tell_no_bound_of_their_speed(self):
        """Gaps of 5 mm close at 20 m/s after 0.25 ms; contact lasts 2 ms, 4 % more where both
        bounce (two_plates.yaml). Events come with windows, of 25 us at most."""
        for scene, longer in (("plates.yaml", 1.02), ("two_plates.yaml", 1.05)):
            with self.subTest(scene):
                own = self.own_scene("python_body", scene, "my_body.py")
                text = own.read_text("utf-8").replace("end: 0.0035,",
                                                      "end: 0.002, until: {contact: impact},")
                own.write_text("meta: {title: Ends with events}\n" + text[text.index("time:"):] +
                               "stages:\n"
                               "  pressed: {time: {end: 0.0035, until: {apart: impact}}}\n")
                said = self.succeed(self.abut("run", own, "--out", self.out, "--force"))
                begun = re.search("next stage, from ([^ ]+) s", said.stdout + said.stderr)
                self.assertGreater(float(begun[1]), 2.5e-4 - 2.0 * 2.5e-5)
                self.assertLess(float(begun[1]), 2.5e-4 + 1.0e-12)
                reached = self.summary()["time"]["reached"]
                self.assertGreater(reached, 2.25e-3 - 2.5e-5)
                self.assertLess(reached, 2.5e-4 + longer * 2.0e-3 + 2.0 * 2.5e-5)


class GetFem(ForeignTest):
    def test_a_bar_of_getfem_meets_one_of_ours(self):
        self.collide("getfem_body", "bars.yaml", "getfem_bar.py")

    def test_a_bar_of_getfem_keeps_the_contract(self):
        self.conform(EXAMPLES / "getfem_body" / "getfem_bar.py",
                     "{lengths: [1, 0.1], cells: [20, 2], corner: [0, 0], velocity: [0, 0], "
                     "youngs_modulus: 1.0e9, poissons_ratio: 0.3, density: 1000, step: 1.0e-5}")


# Makes the solver of these keys, and with it its compiled forms.
COMPILE = """
import sys
from mpi4py import MPI
from abut.keys import Keys
from fenicsx_solid import Engine, read
text = "body: {model: {external: " + sys.argv[1] + "}}"
Engine(MPI.COMM_WORLD, read(Keys("keys", text, "body")))
"""


class FEniCSx(ForeignTest):
    """The compiled forms are kept in a folder of these tests: nothing hangs on what is in ~."""

    place, program, ranks = EXAMPLES / "fenicsx_body", "fenicsx_solid.py", "on_two_ranks.sh"
    keys = ("{lengths: [1, 0.1, 0.1], cells: [10, 1, 1], corner: [0, 0, 0], velocity: [0, 0, 0], "
            "youngs_modulus: 1.0e9, poissons_ratio: 0.3, density: 1000, step: 1.0e-5, law: linear, "
            "faces: {tip: [-1, 0, 0]}}")

    @classmethod
    def setUpClass(cls):
        compiled = tempfile.TemporaryDirectory()
        cls.addClassCleanup(compiled.cleanup)
        cls.compiled = compiled.name

    def setUp(self):
        super().setUp()
        self.environment["XDG_CACHE_HOME"] = self.compiled
        if os.geteuid() == 0:  # mpirun refuses root otherwise
            self.environment["OMPI_ALLOW_RUN_AS_ROOT"] = "1"
            self.environment["OMPI_ALLOW_RUN_AS_ROOT_CONFIRM"] = "1"

    def conform(self, program, keys: str, linear: bool = True):
        """A trial waits ten seconds for a body, which compiling may exceed on a busy machine."""
        self.environment["PYTHONPATH"] = f"{PACKAGE}:{self.place}"
        self.succeed(self.end(self.start(sys.executable, "-c", COMPILE, keys)))
        super().conform(program, keys, linear)

    def end_what_is_left(self):
        """MPI's folders stay where it is killed, as by trials, or has not left in half a second."""
        self.marked_after(3.0)
        for folder in self.temporary.glob("ompi.*"):
            shutil.rmtree(folder)
        super().end_what_is_left()

    def refused(self, change: dict, words: str, program: str):
        text = (self.place / "bars.yaml").read_text("utf-8")
        for old, new in change.items():
            self.assertIn(old, text)
            text = text.replace(old, new)
        scene = self.folder / "bars.yaml"
        scene.write_text(text.replace(f"./{self.program}", str(self.place / program)), "utf-8")
        self.allow(self.place / program)
        result = self.abut("run", scene, "--out", self.out)
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        self.assertRegex(result.stderr, rf"bars.yaml:\d+: bodies.right.model.external.{words}")
        self.assertNotIn("Traceback", result.stderr)
        self.assertFalse(self.out.exists())


class FEniCSxAlone(FEniCSx):
    def test_a_bar_meets_one_of_ours(self):
        self.collide("fenicsx_body", "bars.yaml", self.program)

    def test_half_a_bar_is_tied_to_one_of_ours(self):
        self.collide("fenicsx_body", "tied_bar.yaml", self.program)
        self.assertLess(self.summary()["measures"]["schwarz.iterations_max"], 3)

    def test_a_block_hits_one_of_ours_as_ours_would(self):
        """Of the same mesh, law and steps; only what is known of mass behind a surface differs."""
        self.collide("fenicsx_body", "blocks.yaml", self.program)
        own = self.folder / "blocks.yaml"
        text, count = re.subn(
            r"  right:\n.*faces: [^\n]*\n",
            "  right:\n    like: left\n    model: {fe: {mesh: {box: {lengths: [0.15, 0.1, 0.1], "
            "elements: [6, 4, 4]}}}}\n    initial: {position: [0.0005, 0.06, 0.13], "
            "velocity: [-5.0, 0.0, 0.0]}\n    ports: {tip: {side: left}}\n",
            own.read_text("utf-8"), flags=re.DOTALL)
        self.assertEqual(count, 1)
        own.write_text(text, encoding="utf-8")
        self.out = self.folder / "ours"
        self.succeed(self.abut("run", own, "--out", self.out, "--local"))

    def test_linear_solids_in_space_keep_the_contract(self):
        self.conform(self.place / self.program, self.keys)

    def test_triangles_of_finite_strain_keep_the_contract(self):
        self.conform(self.place / self.program,
                     "{lengths: [1, 0.2], cells: [10, 2], corner: [0, 0], velocity: [0, 0], "
                     "youngs_modulus: 1.0e9, poissons_ratio: 0.3, density: 1000, step: 1.0e-5, "
                     "law: neo_hookean, simplices: true, faces: {tip: [-1, 0], rest: [1, 0]}}",
                     linear=False)

    def test_wrong_keys_are_told_with_file_and_line(self):
        for change, words in (
                ({"step: 2.4e-6    ": "step: 2.6e-6    ", "window: 2.4e-6": "window: 2.6e-6",
                  "{step: 2.4e-6}": "{step: 1.3e-6}"}, "step: 2.6e-06 is above the stable step"),
                ({"cells: [400, 1, 1]": "cells: [400, 1]"}, "cells: must be 3 numbers"),
                ({"cells: [400, 1, 1]": "cells: many"}, "cells: must be 3 numbers"),
                ({"cells: [400, 1, 1]": "cells: [400, 1, 0.5]"}, "cells: must be counts"),
                ({"{tip: [-1, 0, 0]}": "{tip: [-1, 1, 0]}"}, "faces: no facet looks along"),
                ({"{tip: [-1, 0, 0]}": "[tip]"}, "faces: must be ports by their names"),
                ({"{tip: [-1, 0, 0]}": "{tip: [-1, 0]}"}, "faces: must be a normal of 3 numbers")):
            with self.subTest(words):
                self.refused(change, words, self.program)


class FEniCSxOnTwoRanks(FEniCSx):
    def test_they_keep_the_contract(self):
        self.conform(self.place / self.ranks, self.keys)

    def test_what_comes_out_is_that_of_one_rank(self):
        """But for the order of sums: 3e-12 of the largest value of its kind is measured, in forces
        and velocities, which are differences over short steps."""
        for scene, until in (("bars.yaml", 0.0024), ("blocks.yaml", 0.0008),
                             ("tied_bar.yaml", 0.0009)):  # the wave has passed the tie
            with self.subTest(scene):
                told = [self.history(scene, program, until)
                        for program in (self.program, self.ranks)]
                self.assert_same(*told)

    def history(self, scene: str, program: str, until: float, *changes: str):
        own = self.own_scene("fenicsx_body", scene, self.program, program)
        out = self.folder / f"{scene} {program}"
        whole = f"end: {until}" in own.read_text("utf-8")
        self.succeed(self.abut("run", own, "--out", out, "--set", f"time.end={until}", *changes,
                               *(() if whole else ("--set", "meta.expect=[]"))))
        return self.read(out)

    def read(self, out):
        with (out / "history.csv").open(encoding="utf-8", newline="") as file:
            header, *rows = list(csv.reader(file))
        return header, np.array([[float(cell or 0.0) for cell in row] for row in rows])

    def assert_same(self, one, two):
        for unit, (a, b) in same_units(one, two).items():
            self.assertLess(np.max(np.abs(a - b)), 1.0e-10 * np.max(np.abs(a)), unit)

    def test_a_run_of_one_rank_goes_on_with_two(self):
        keep = ("--set", "output.checkpoint={windows: 50}", "--set", "output.fields=~")
        whole = self.history("bars.yaml", self.program, 4.8e-4, "--force", *keep)
        self.history("bars.yaml", self.program, 3.6e-4, "--force", *keep)  # contact is from 2.5e-4
        scene = self.own_scene("fenicsx_body", "bars.yaml", self.program, self.ranks)
        out = self.folder / f"bars.yaml {self.program}"
        self.succeed(self.abut("resume", out, "--scene", scene, *keep,
                               "--set", "time.end=4.8e-4", "--set", "meta.expect=[]"))
        self.assert_same(whole, self.read(out))

    def test_wrong_keys_are_told_and_no_rank_stays(self):
        self.refused({"{tip: [-1, 0, 0]}": "{tip: [-1, 1, 0]}"}, "faces: no facet", self.ranks)

    def test_no_rank_stays_when_the_coordinator_is_killed(self):
        own = self.own_scene("fenicsx_body", "bars.yaml", self.program, self.ranks)
        run = self.start(ABUT, "run", own, "--out", self.out)
        until = time.monotonic() + 60.0
        while not (self.out / "history.csv").exists() and time.monotonic() < until:
            time.sleep(0.05)
        self.assertTrue((self.out / "history.csv").exists())
        run.send_signal(signal.SIGKILL)
        self.end(run)
        self.assertEqual(self.marked_after(20.0), [])
        self.leaves_sockets = True


def same_units(one, two) -> dict:
    """All values of both by their unit."""
    (header, a), (other, b) = one, two
    assert header == other and a.shape == b.shape
    units = [re.search(r"\[.*\]|$", name)[0] for name in header]
    columns = {unit: [k for k, each in enumerate(units) if each == unit] for unit in units}
    return {unit: (a[:, at], b[:, at]) for unit, at in columns.items() if np.any(a[:, at])}


class CalculiX(ForeignTest):
    """Every step is a run of ccx: the whole scene takes minutes, its beginning is held here."""

    PROGRAM = EXAMPLES / "calculix_body" / "calculix_bar.py"

    def test_a_bar_of_calculix_keeps_the_contract(self):
        self.conform(self.PROGRAM,
                     "{lengths: [0.4, 0.1, 0.1], cells: [4, 1, 1], corner: [0, 0, 0], velocity: "
                     "[0, 0, 0], youngs_modulus: 1.0e9, poissons_ratio: 0.3, density: 1000, step: "
                     "2.0e-5}")

    def test_wrong_keys_are_told(self):
        for change, words in (("lengths=[1, 1]", "lengths: must be three numbers above 0"),
                              ("cells=[4, 0, 1]", "cells: must be three numbers above 0"),
                              ("cells=[4.5, 1, 1]", "cells: must be whole numbers"),
                              ("velocity=[1, 0]", "velocity: must be three numbers"),
                              ("poissons_ratio=0.5", "poissons_ratio: must be above -1")):
            with self.subTest(change):
                self.allow(self.PROGRAM)
                text = (self.PROGRAM.parent / "tied.yaml").read_text("utf-8")
                own = self.folder / "tied.yaml"
                own.write_text(text.replace("./calculix_bar.py", str(self.PROGRAM)), "utf-8")
                result = self.abut("run", own, "--out", self.out, "--force", "--set",
                                   f"bodies.right.model.external.{change}")
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn(words.split(": ")[1], result.stderr)

    def test_a_wave_passes_a_tie_into_a_bar_of_calculix(self):
        self.collide("calculix_body", "tied.yaml", "calculix_bar.py")

    def test_a_bar_of_calculix_is_pushed_as_by_a_wave(self):
        """Until a wave comes back both bars press by rho c A v, v half of 20 m/s: 4000 N."""
        text = (self.PROGRAM.parent / "bars.yaml").read_text("utf-8")
        own = self.folder / "bars.yaml"
        own.write_text(text.replace("./calculix_bar.py", str(self.PROGRAM)), encoding="utf-8")
        self.allow(self.PROGRAM)
        self.succeed(self.abut("run", own, "--out", self.out, "--set", "time.end=4.0e-5", "--set",
                               "meta.expect=[]"))
        measures = self.summary()["measures"]
        touch = 3.99e-5 / 20.0  # [s] gap over speed
        pushed = measures["momentum.right.end_x"] + 4.0  # [kg m/s]
        # 19 steps, and a force that alternates from step to step by less than a third of itself
        self.assertLess(abs(pushed / (4000.0 * (4.0e-5 - touch)) - 1.0), 0.02)
        self.assertLess(abs(measures["energy.total.relative_drift_end"]), 2.0e-4)
        self.assertLess(measures["momentum.total"], 1.0e-11)  # round-off


class Fmu(ForeignTest):
    """An FMU of FMI 3.0 that the example compiles and packs."""

    KEYS = ("{fmu: mass_on_spring.fmu, parameters: {mass: 0.2, stiffness: 8.0e+5}, points: {face: "
            "{position: 0.0, normal: -1.0, force: force, displacement: u, velocity: v}}, energy: "
            "[kinetic, stored], momentum: [momentum], mass: 0.2, step: 4.0e-6, conserves: true, "
            "linear: true}")

    def setUp(self):
        super().setUp()
        self.place = self.folder / "fmu"
        shutil.copytree(EXAMPLES / "fmu_body", self.place)
        subprocess.run([sys.executable, self.place / "make_fmu.py",
                        self.place / "mass_on_spring.fmu"], check=True, timeout=60)
        self.program = self.place / "fmu_body.py"

    def test_a_bar_meets_an_fmu(self):
        self.collide(self.place, "bar_meets_fmu.yaml", "fmu_body.py")

    def test_an_fmu_keeps_the_contract(self):
        self.conform(self.program, self.KEYS)

    def test_what_is_no_fmu_for_a_body_is_told(self):
        """Not one, not where this program is, of another standard, without a state; a name."""
        def other(name: str, old: str, new: str) -> str:
            with zipfile.ZipFile(self.place / "mass_on_spring.fmu") as good, \
                    zipfile.ZipFile(self.place / name, "w") as bad:
                for each in good.namelist():
                    bad.writestr(each, good.read(each).replace(old.encode(), new.encode()))
            return name
        (self.place / "text.fmu").write_text("no archive", encoding="utf-8")
        for change, words in (
                ("fmu: ../mass.fmu", "is not in the folder of this program"),
                ("fmu: text.fmu", "is no FMU"),
                ("fmu: " + other("two.fmu", 'fmiVersion="3.0"', 'fmiVersion="2.0"'),
                 "is not of FMI 3.0"),
                ("fmu: " + other("once.fmu", "canSerializeFMUState", "canNot"),
                 "does not say canSerializeFMUState"),
                ("fmu: " + other("token.fmu", 'Token="{abut-', 'Token="{other-'),
                 "the token is that of another FMU"),
                ("velocity: w", "has no variable w"),
                ("stiffness: soft", "must be numbers by name"),
                ("position: 0.0, colour: 1", "must have displacement, force")):
            with self.subTest(change):
                key = change.split(":", maxsplit=1)[0]
                keys = re.sub(rf"{key}: [^,}}]*", change, self.KEYS, count=1)
                result = self.abut("conformance", self.program, "--keys", keys)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn(words, result.stdout + result.stderr)


if __name__ == "__main__":
    for name, module in (("GetFem", "getfem"), ("FEniCSx", "dolfinx")):
        if any(word.startswith(name) for word in sys.argv) and not importlib.util.find_spec(module):
            print(f"skipped: Python's {module} is not installed (Debian: python3-{module})")
            sys.exit(77)
    if "FEniCSxOnTwoRanks" in sys.argv and shutil.which("mpirun") is None:
        print("skipped: mpirun is not installed (Debian: openmpi-bin)")
        sys.exit(77)
    if "CalculiX" in sys.argv and not shutil.which("ccx"):
        print("skipped: there is no ccx (Debian: calculix-ccx)")
        sys.exit(77)
    if "Fmu" in sys.argv and not shutil.which("cc"):
        print("skipped: there is no C compiler to make the FMU (Debian: gcc)")
        sys.exit(77)
    main()
