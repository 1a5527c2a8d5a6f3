"""Goal: no input ends in an abort, a crash or an appetite without bound: what cannot be read or
computed is refused, or fails, in words, with little memory and in little time.

Oracle: exit codes of docs/USE.md, a limit of memory set by the system, words of the message.
usage: test_hostile_input.py ABUT ROOT
"""

import os
import resource
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
from support import ABUT, ROOT, SLOWER, SystemTest, main  # noqa: E402

MEGABYTE = 1 << 20
# The address sanitizer reserves terabytes of addresses, of which it uses few.
SANITIZED = SLOWER > 1
SECONDS = 30 * SLOWER  # refusals take milliseconds; only what reads without bound takes longer

SOLID = """\
meta: {title: A part}
time: {begin: 0.0, end: 1.0e-5, window: 1.0e-6}
bodies:
  part:
    model: {fe: {dimension: 3, mesh: {box: {lengths: [0.1, 0.1, 0.1], elements: [2, 2, 2]}}}}
    material: {linear_elastic: {youngs_modulus: 1.0e6, poissons_ratio: 0.3, density: 1000.0}}
    integrator: {newmark: {step: 1.0e-6}}
"""
BOX = "mesh: {box: {lengths: [0.1, 0.1, 0.1], elements: [2, 2, 2]}}"


class HostileInput(SystemTest):
    def limited(self, megabytes: int, *arguments: object) -> subprocess.CompletedProcess:
        """The program with a limit of memory; a signal shows as a negative code."""
        def limit():
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            if not SANITIZED:
                resource.setrlimit(resource.RLIMIT_AS, (megabytes * MEGABYTE,) * 2)
        environment = self.environment
        if SANITIZED:  # it ends what takes more itself
            options = environment.get("ASAN_OPTIONS", "")
            environment = environment | {
                "ASAN_OPTIONS": f"{options}:hard_rss_limit_mb={4 * megabytes}"}
        return subprocess.run([ABUT, *map(str, arguments)], cwd=self.folder, text=True,
                              capture_output=True, timeout=SECONDS, check=False,
                              env=environment, preexec_fn=limit)

    def refused(self, result: subprocess.CompletedProcess, words: str):
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertTrue(result.stderr.startswith("error: "), result.stderr)
        self.assertIn(words, result.stderr)

    def scene(self, text: str):
        path = self.folder / "scene.yaml"
        path.write_text(text, encoding="utf-8")
        return path

    def test_texts_that_begin_nothing_take_no_memory(self):
        for text in (",", "]", "}", "a: 1\n]", "{a: 1}\n}", ",,,,", "? ,", "- ,\n,", "%", "\x00",
                     "&", "*", "!", "[" * 4000, "{" * 4000, "- " * 4000, "a: " * 4000):
            with self.subTest(text=text[:12]):
                self.refused(self.limited(500, "check", self.scene(text)), "scene.yaml")

    def test_large_texts_are_refused_before_a_tree_is_made_of_them(self):
        # Seven million values of two bytes: their tree takes 3 GB.
        self.refused(self.limited(500, "check", self.scene("a: [" + "1," * 7_000_000 + "1]")),
                     "holds more than")
        self.refused(self.limited(500, "check", self.scene("a: " + "x" * 17_000_000)),
                     "is larger than 16 MB")
        self.refused(self.limited(500, "check", ROOT / "configs" / "two_bars.yaml", "--set",
                                  "meta.expect=,"), "is not readable as YAML")

    def test_what_is_no_file_is_not_read(self):
        self.refused(self.limited(500, "check", "/dev/zero"), "is a device")
        self.refused(self.limited(500, "check", self.folder), "is a folder")
        hole = self.folder / "hole.msh"
        with hole.open("wb") as file:
            file.truncate(1 << 40)  # a terabyte that takes no disk
        scene = self.scene(SOLID)
        for mesh in (hole, "/dev/zero", self.folder):
            with self.subTest(mesh=str(mesh)):
                self.refused(self.limited(500, "check", scene, "--set",
                                          f"bodies.part.model.fe.mesh={{gmsh: {{file: {mesh}}}}}"),
                             "bodies.part.model.fe.mesh.gmsh.file")

    def test_named_pipes_are_refused_unread(self):
        pipe = self.folder / "pipe"
        os.mkfifo(pipe)  # nobody writes: to open it is to wait for ever
        self.refused(self.limited(500, "check", pipe), "is a device or a pipe")
        scene = self.scene(SOLID)
        for key, value in (("model.fe.mesh", f"{{gmsh: {{file: {pipe}}}}}"),
                           ("copies", f"{{table: {{file: {pipe}}}}}")):
            self.refused(self.limited(500, "check", scene, "--set", f"bodies.part.{key}={value}"),
                         f"bodies.part.{key}")

    def test_more_modes_than_there_are_are_refused_before_any_is_computed(self):
        scene = self.scene(SOLID.replace("fe: {", "modal: {modes: 1000000000, ").replace(
            "[2, 2, 2]", "[10, 10, 10]"))  # 3993 less 6 motions: all take minutes
        self.refused(self.limited(2000, "check", scene),
                     "1000000000 modes are wanted, but the mesh has 3987")

    def test_a_pipe_is_a_scene(self):
        result = subprocess.run(["/bin/sh", "-c", 'cat "$1" | "$0" check /dev/stdin', ABUT,
                                 self.scene(SOLID)], capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)

    @unittest.skipIf(SANITIZED, "the program asks the system for its limit of memory")
    def test_bodies_larger_than_the_memory_are_named_with_their_key(self):
        bars = ROOT / "configs" / "two_bars.yaml"
        self.refused(self.limited(500, "check", bars, "--set",
                                  "bodies.right.model.fe.mesh.bar.elements=150000000"),
                     "bodies.right.model.fe.mesh.bar.elements")
        scene = self.scene(SOLID)
        for elements in ("[1000, 1000, 100]", "[30000, 30000, 30000]", "[1.0e+300, 1, 1]"):
            self.refused(self.limited(500, "check", scene, "--set",
                                      f"bodies.part.model.fe.mesh.box.elements={elements}"),
                         "bodies.part.model.fe.mesh.box.elements")
        # Small enough to begin with: the memory ends while the body is built.
        self.refused(self.limited(400, "check", scene, "--set",
                                  "bodies.part.model.fe.mesh.box.elements=[80, 80, 80]"),
                     "bodies.part.model")

    @unittest.skipIf(SANITIZED, "the address sanitizer ends a program whose memory ends")
    def test_a_run_whose_memory_ends_names_the_body(self):
        options = ["--set", "bodies.left.model.fe.mesh.bar.elements=2000000", "--set",
                   "bodies.left.integrator={newmark: {step: 1.0e-7}}", "--set",
                   "meta={title: a long bar}"]
        for place in (["--local"], []):
            with self.subTest(place=place):
                result = self.limited(330, "run", ROOT / "configs" / "two_bars.yaml", "--quiet",
                                      "--force", "--out", self.out, *place, *options)
                self.assertIn(result.returncode, (2, 3), result.stderr)
                self.assertIn("left", result.stderr)
                self.assertIn("memory", result.stderr)

    def test_numbers_at_their_end_are_refused_or_fail(self):
        scene = self.scene(SOLID)
        models = {f"fe: {{dimension: 3, {BOX}}}": ("newmark", "central_difference"),
                  f"modal: {{dimension: 3, modes: 2, {BOX}}}": ("newmark", "central_difference"),
                  f"rigid: {{dimension: 3, {BOX}}}": ("rigid_motion",)}
        values = ["density=5e-324", "density=1e-306", "density=1e308", "youngs_modulus=1e308",
                  "youngs_modulus=5e-324", "poissons_ratio=0.49999999999999994"]
        law = "bodies.part.material={linear_elastic: {density: 1000.0, poissons_ratio: "
        values += [f"{law}0.3, {key}: {value}}}}}" for value in ("1e308", "1e-320")
                   for key in ("shear_modulus", "bulk_modulus", "lame_modulus")]
        values += [f"{law}-0.99999999999999, shear_modulus: 1e100}}}}"]
        for model, integrators in models.items():
            for integrator in integrators:
                for value in values:
                    with self.subTest(model=model[:5], integrator=integrator, value=value):
                        result = self.limited(
                            2000, "run", scene, "--local", "--quiet", "--force", "--out", self.out,
                            "--set", f"bodies.part.model={{{model}}}", "--set",
                            f"bodies.part.integrator={{{integrator}: {{step: 1.0e-6}}}}", "--set",
                            f"bodies.part.material.linear_elastic.{value}")
                        self.assertIn(result.returncode, (0, 1, 2), result.stderr)
                        if value.startswith("density"):
                            self.refused(result, "density")

    def test_counts_are_refused_before_they_overflow(self):
        bars = ROOT / "configs" / "two_bars.yaml"
        for setting, key in (("time.end=1.0e+300", "time.window"),
                             ("time={begin: 0.0, end: 10.0, window: 10.0}", "time.window"),
                             ("time={begin: -1.0e+308, end: 1.0e+308, window: 1.0}", "time.window"),
                             ("bodies.left.integrator.central_difference.step=1.0e-300",
                              "bodies.left.integrator"),
                             ("network={request_deadline: 1.0e+300}", "network.request_deadline"),
                             ("schwarz={max_iterations: 99999999999999999999}",
                              "schwarz.max_iterations"),
                             ("output={records_per_window: 4294967297}",
                              "output.records_per_window")):
            with self.subTest(setting=setting):
                result = self.limited(500, "check", bars, "--probe", "0", "--set", setting)
                self.refused(result, key)
                self.assertNotIn("-9", result.stdout)


if __name__ == "__main__":
    main()
