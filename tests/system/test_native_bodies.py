"""Goal: a body in C++, C or Fortran, in a project that knows nothing of abut but what is installed,
keeps the contract and collides with ours as the closed forms of its scene say.

usage: test_native_bodies.py ABUT ROOT CLASS CMAKE      exit code 77 (skipped) without a compiler
"""

import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from support import ABUT, ROOT, SystemTest, main

CMAKE = sys.argv[4]
BUILD = ABUT.parents[1]
EXAMPLES = ROOT / "examples"
MASS = "{mass: 0.2, stiffness: 8.0e5, position: 0.0, step: 4.0e-6}"
SOLID = ("lengths: [0.25, 0.1], corner: [0.0, 0.0], velocity: [0.0, 0.0], step: 1.0e-5, "
         "youngs_modulus: 1.0e9, poissons_ratio: 0.3, density: 1000.0")
BAR = ("{length: 0.25, area: 1.0e-6, elements: 20, position: 0.0, velocity: 0.0, step: 1.0e-6, "
       "youngs_modulus: 1.0e9, density: 1000.0}")
# What a user's file may read beside its own library: the compiler's.
OTHERS = re.compile(r"Eigen|google|zmq|fmt|spdlog|yaml|contract/|messaging/|base/")


class NativeTest(SystemTest):
    example, places = "", EXAMPLES

    @classmethod
    def setUpClass(cls):
        if not cls.example:
            return
        said = subprocess.run([ABUT, "--version"], capture_output=True, text=True, check=True)
        if "sanitizers" in said.stdout:
            raise unittest.SkipTest("a program would have to be built with the same sanitizers")
        holder = tempfile.TemporaryDirectory(dir="/tmp")
        cls.addClassCleanup(holder.cleanup)
        cls.prefix = Path(holder.name) / "prefix"
        cls.project = Path(holder.name) / cls.example
        shutil.copytree(cls.places / cls.example, cls.project)
        build = cls.project / "build"
        for words in ((CMAKE, "--install", BUILD, "--component", "development", "--prefix",
                       cls.prefix),
                      (CMAKE, "-S", cls.project, "-B", build, f"-DCMAKE_PREFIX_PATH={cls.prefix}"),
                      (CMAKE, "--build", build)):
            subprocess.run([*map(str, words)], check=True, stdout=subprocess.DEVNULL, timeout=600)

    def call(self, *words: object) -> str:
        result = subprocess.run([*map(str, words)], cwd=self.folder, text=True, check=False,
                                env=self.environment, capture_output=True, timeout=300)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return result.stdout

    def program(self, name: str) -> Path:
        return self.project / "build" / name

    def run_scene(self, scene: Path, program: str, *more: str):
        """A scene names its program from the folder that a run is started in."""
        own = self.folder / scene.name
        text = scene.read_text("utf-8").replace(f"./build/{program}", str(self.program(program)))
        text = text.replace(f"./{program}.py", str(self.program(program)))
        own.write_text(text, encoding="utf-8")
        self.allow(self.program(program))
        return self.abut("run", own, "--out", self.out, *more)

    def collide(self, scene: str, program: str):
        self.succeed(self.run_scene(EXAMPLES / self.example / scene, program))
        self.assert_whole(self.out)

    def meet_a_bar(self, *more: str):
        launch = f"bodies.mass.launch={{spawn: {{program: {self.program('mass_on_spring')}}}}}"
        return self.run_scene(EXAMPLES / "python_body" / "bar_meets_mass.yaml", "mass_on_spring",
                              "--set", launch, "--set", "network.endpoint=null", *more)

    def conform(self, program: str, keys: str):
        """Every clause is kept; of those of a body that moves, each was asked."""
        said = self.succeed(self.abut("conformance", self.program(program), "--keys", keys)).stdout
        for clause in ("ends", "restore", "boxes", "momentum", "work", "kernel", "checkpoint"):
            self.assertRegex(said, f"\n  {clause} +kept", said)
        self.assertNotIn("BROKEN", said)


class Cpp(NativeTest):
    example = "cpp_body"

    def test_a_plate_meets_a_bar_of_ours(self):
        self.collide("plates.yaml", "my_body")
        self.conform("my_body", f"{{{SOLID}, cells: [4, 2]}}")

    def test_a_mass_meets_a_bar_of_ours(self):
        self.succeed(self.meet_a_bar())
        self.conform("mass_on_spring", MASS)

    def test_two_plates_meet(self):
        self.succeed(self.run_scene(EXAMPLES / "python_body" / "two_plates.yaml", "my_body"))
        self.assertGreater(self.summary()["accuracy"]["given_up"]["passive_windows"], 0)

    def test_wrong_keys_are_told_with_file_line_and_key(self):
        for change, words in (("mass=-1", "mass: must be positive, but is -1 kg"),
                              ("mass=null", "mass: is missing. Give the mass in kg"),
                              ("colour=3", "colour: is not a known key"),
                              ("step=1 kg", "step: ")):
            with self.subTest(change):
                result = self.meet_a_bar("--set", f"bodies.mass.model.external.{change}")
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn(f"bodies.mass.model.external.{words}", result.stderr)

    def test_the_chapter_runs_as_it_stands(self):
        text = (ROOT / "docs" / "SOLVER.md").read_text("utf-8")
        whole = re.DOTALL | re.MULTILINE
        files = re.findall(r"^```\w+\n((?:#|//) file: (\S+)\n.*?)^```$", text, whole)
        self.assertEqual([name for _, name in files], ["floating.yaml", "floating.cpp"])
        for content, name in files:
            (self.folder / name).write_text(content, encoding="utf-8")
        self.allow(self.folder / "floating")
        self.environment["PKG_CONFIG_PATH"] = str(self.prefix / "lib/pkgconfig")
        self.environment["PATH"] = f"{ABUT.parent}:{self.environment['PATH']}"
        commands = re.search(r"^```sh\n(.*?)^```$", text, whole)[1].splitlines()
        self.assertEqual(len(commands), 3)
        said = [self.call("sh", "-c", command) for command in commands]
        self.assertNotIn("BROKEN", said[2])
        measures = self.summary(self.folder / "runs" / "floating")["measures"]
        exact = 0.2 * (1.0 - math.exp(-100.0 * 1.0e-3 / 0.2))  # as in test_first_hour.py
        self.assertLess(abs(measures["momentum.mass.end"] / exact - 1.0), 0.005)

    def test_other_machines_need_keys_or_the_users_word(self):
        call = [self.program("mass_on_spring"), "--connect", "tcp://machine.example:5555",
                "--body", "mass"]
        refused = self.end(self.start(*call))
        self.assertEqual(refused.returncode, 2, refused.stderr)
        self.assertIn("--insecure on a network that you trust.", refused.stderr)
        insisting = self.start(*call, "--insecure")
        self.addCleanup(insisting.communicate)
        self.addCleanup(insisting.kill)
        self.assertIn("warning: --insecure: whoever is at tcp://machine.example:5555 can read",
                      insisting.stderr.readline())

    def test_its_header_reads_nothing_else_of_abut_nor_of_its_libraries(self):
        source = self.folder / "alone.cpp"
        source.write_text("#include <abut.hpp>\n", encoding="utf-8")
        read = self.call("g++", "-std=c++17", "-M", f"-I{self.prefix / 'include'}", source)
        self.assertIn("abut.h ", read + " ")
        self.assertEqual([name for name in read.split() if OTHERS.search(name)], [])

    def test_pkg_config_tells_what_to_compile_and_link(self):
        self.environment["PKG_CONFIG_PATH"] = str(self.prefix / "lib/pkgconfig")
        flags = self.call("pkg-config", "--cflags", "--libs", "abut-sdk").split()
        self.call("g++", "-std=c++17", self.project / "mass_on_spring.cpp", "-o", "mass", *flags)
        said = self.call("sh", "-c", "./mass; test $? = 2 && echo it runs")
        self.assertIn("it runs", said)


class Kinds(NativeTest):
    """What the examples do not have: statics, space, several ports, what a body may say itself."""

    example, places = "native", Path(__file__).resolve().parent

    def run_text(self, text: str, *more: str):
        scene = self.folder / "scene.yaml"
        scene.write_text(text.replace("PROGRAM", str(self.program("kinds"))), encoding="utf-8")
        self.allow(self.program("kinds"))
        return self.abut("run", scene, "--out", self.out, "--force", *more)

    def test_all_kinds_keep_the_contract(self):
        for keys, others in (("{kind: spring, stiffness: 1.0e5}", set()),
                             ("{kind: box}", {"momentum", "orientation"}),
                             ("{kind: two_ends}", {"momentum"})):
            with self.subTest(keys):
                said = self.succeed(self.abut("conformance", self.program("kinds"), "--keys",
                                              keys)).stdout
                self.assertNotIn("BROKEN", said)
                for clause in {"ends", "restore", "work", "kernel", "checkpoint"} | others:
                    self.assertRegex(said, f"\n  {clause} +kept", said)

    def test_a_body_with_two_ports_hands_an_impact_on_until_it_breaks(self):
        """A bar hits two masses with a spring between, and they hit a second bar."""
        text = (ROOT / "configs" / "two_bars.yaml").read_text("utf-8")
        left = text[text.index("  left:"):text.index("  right:")]
        scene = ("time: {end: 1.2e-3, window: 1.0e-5}\nbodies:\n" + left +
                 "  spring:\n    launch: {spawn: {program: PROGRAM}}\n"
                 "    model: {external: {kind: two_ends}}\n"
                 "  right: {like: left, initial: {position: [0.1], velocity: [0.0]}, "
                 "ports: {tip: {side: left}}}\n"
                 "interfaces:\n  one: {sides: [left.tip, spring.left], contact: {}}\n"
                 "  two: {sides: [spring.right, right.tip], contact: {}}\n")
        self.succeed(self.run_text(scene))
        measures = self.summary()["measures"]
        self.assertLess(measures["momentum.total"], 1.0e-12)  # round-off
        self.assertGreaterEqual(measures["contact.two.closings"], 1)
        # explicit steps of 1e-6 s against a period of 1.4e-4 s, and what layers of bars leave
        self.assertLess(abs(measures["energy.total.relative_drift_end"]), 1.0e-3)
        broken = self.run_text(scene, "--set", "bodies.spring.model.external.breaks=1.0e-5",
                               "--set", "schwarz.on_nonconvergence=stop")
        self.assertEqual(broken.returncode, 1, broken.stderr)
        self.assertIn("the spring has broken", broken.stderr)

    def test_fields_are_those_that_a_body_tells(self):
        scene = ("time: {end: 1.0e-2, window: 1.0e-3}\nbodies:\n  box:\n"
                 "    launch: {spawn: {program: PROGRAM}}\n    model: {external: {kind: box}}\n"
                 "output: {fields: {every: 5}}\n")
        self.succeed(self.run_text(scene))
        drawn = next((self.out / "fields").rglob("*.vtu")).read_bytes()
        for name in (b'Name="height"', b'Name="velocity"'):
            self.assertIn(name, drawn)


class C(NativeTest):
    example = "c_body"

    def test_a_mass_meets_a_bar_of_ours(self):
        self.succeed(self.meet_a_bar())
        self.conform("mass_on_spring", MASS)


class Fortran(NativeTest):
    example = "fortran_body"

    def test_a_bar_meets_one_of_ours(self):
        self.collide("bars.yaml", "bar")
        self.conform("bar", BAR)

    def test_a_block_meets_a_bar_of_ours_in_the_plane(self):
        self.collide("blocks.yaml", "block")
        self.conform("block", f"{{{SOLID}, cells_along: 4, cells_across: 2}}")


class Bullet(NativeTest):
    example = "bullet_body"

    def test_a_bar_of_ours_meets_boxes_of_bullet(self):
        self.collide("row.yaml", "boxes")

    def test_boxes_of_bullet_keep_the_contract(self):
        keys = ("{boxes: [2, 1, 1], edge: 0.1, density: 1000, corner: [0, 0, 0], "
                "velocity: [0, 0, 0], step: 1.0e-5}")
        said = self.succeed(self.abut("conformance", self.program("boxes"), "--keys", keys)).stdout
        self.assertNotIn("BROKEN", said)
        for clause in ("ends", "restore", "boxes", "momentum", "work", "checkpoint"):
            self.assertRegex(said, f"\n  {clause} +kept", said)


class DealII(NativeTest):
    example = "dealii_body"
    LAW = "youngs_modulus: 1.0e9, poissons_ratio: 0.3, density: 1000"

    def test_a_bar_of_ours_meets_one_of_dealii(self):
        self.collide("bars.yaml", "solid")

    def test_a_ball_of_dealii_hits_a_block_of_ours(self):
        self.collide("ball.yaml", "solid")

    def test_a_wave_passes_a_tie_into_a_bar_of_dealii(self):
        self.collide("tied.yaml", "solid")

    def test_solids_of_dealii_keep_the_contract(self):
        for keys in ("lengths: [1, 0.1], cells: [20, 2], corner: [0, 0], velocity: [0, 0], "
                     "step: 1.0e-5",
                     "lengths: [1, 0.2, 0.2], cells: [4, 2, 2], corner: [0, 0, 0], degree: 2, "
                     "side: right, velocity: [0, 0, 0], step: 1.0e-5",
                     "radius: 0.1, centre: [0, 0, 0], refinements: 2, velocity: [0, 0, 0], "
                     "step: 1.0e-6"):
            with self.subTest(keys):
                self.conform("solid", f"{{{keys}, {self.LAW}}}")

    def test_wrong_keys_are_told(self):
        for change, words in (("degree=3", "degree: must be 1 or 2"),
                              ("side=top", "side: must be left or right"),
                              ("cells=[400, 0]", "cells: must be whole numbers above 0"),
                              ("lengths=[1.0, -0.02]", "lengths: must be above 0"),
                              ("poissons_ratio=0.5", "poissons_ratio: must be above -1"),
                              ("velocity=null", "velocity: ")):
            with self.subTest(change):
                result = self.run_scene(EXAMPLES / self.example / "bars.yaml", "solid",
                                        "--set", f"bodies.right.model.external.{change}")
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn(f"bodies.right.model.external.{words}", result.stderr)


def lacks_bullet() -> bool:
    found = subprocess.run(["pkg-config", "--exists", "bullet"], check=False)
    return found.returncode != 0


def lacks_dealii() -> bool:
    return ("DEAL_II_DIR" not in os.environ
            and not Path("/usr/include/deal.II/base/config.h").exists())


if __name__ == "__main__":
    if "Bullet" in sys.argv and lacks_bullet():
        print("skipped: Bullet is not installed (Debian: libbullet-dev)")
        sys.exit(77)
    if "DealII" in sys.argv and lacks_dealii():
        print("skipped: deal.II is not installed (Debian: libdeal.ii-dev)")
        sys.exit(77)
    if "Fortran" in sys.argv and not shutil.which("gfortran"):
        print("skipped: there is no gfortran (Debian: gfortran)")
        sys.exit(77)
    del sys.argv[4:]
    main()
