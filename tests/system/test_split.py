"""Goal: `abut split` writes scenes that run as they are, one process per body, and nothing over
what is there. Oracles: the undivided run, the bytes of the files, exit codes.
usage: test_split.py ABUT ROOT
"""

import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
from support import SystemTest  # noqa: E402

SCENE = """\
meta:
  title: A plate is struck
  expect:
    - {measure: body.plate.corner.displacement.x, equals: 0.0, absolute: 1.0, because: any}
    - {measure: body.plate.displacement.x.max, at_most: 1.0, because: any}
    - {measure: body.plate.momentum.x, at_most: 1.0, because: any}
time: {begin: 0.0, end: 2.0, window: 0.1}
bodies:
  plate:
    model: {fe: {dimension: 2, mesh: {rectangle: {lengths: [2.0, 1.0], elements: [8, 4]}}}}
    material: {linear_elastic: {youngs_modulus: 1.0, poissons_ratio: 0.25, density: 1.0}}
    integrator: {newmark: {step: 0.05}}
    initial: {velocity_field: ["0.1*x*y", "0.01*x"]}
    points: {corner: {at: [2.0, 1.0]}}
    ports: {corner: {side: corner}}
"""


class Split(SystemTest):
    def setUp(self):
        super().setUp()
        (self.folder / "plate.yaml").write_text(SCENE, encoding="utf-8")

    def files(self, name: str) -> dict:
        return {path.name: path.read_bytes() for path in (self.folder / name).iterdir()}

    def split(self, *arguments: object):
        return self.abut("split", "plate.yaml", "--bodies", 3, *arguments)

    def test_the_divided_scene_runs_in_processes_and_moves_as_the_whole(self):
        said = self.succeed(self.split()).stdout
        self.assertIn("plate_2: ", said)
        self.assertIn("left out: what is expected of body.plate.momentum.x: it is the sum or the "
                      "mean over several parts", said)
        self.assertIn("plate_split_3/plate.yaml: valid", said)
        self.succeed(self.abut("run", "plate.yaml", "--out", "whole", "--local"))
        self.succeed(self.abut("run", "plate_split_3/plate.yaml", "--out", "parts"))
        whole = self.summary(self.folder / "whole")["measures"]
        parts = self.summary(self.folder / "parts")["measures"]
        corner = [value for name, value in parts.items()
                  if name.endswith(".corner.displacement.x")]
        self.assertEqual(len(corner), 1, "one part has the corner")
        self.assertAlmostEqual(corner[0], whole["body.plate.corner.displacement.x"], delta=1e-9)
        momentum = sum(value for name, value in parts.items()
                       if name.startswith("body.plate_") and name.endswith(".momentum.x"))
        self.assertAlmostEqual(momentum, whole["body.plate.momentum.x"], delta=1e-9)

    def test_the_same_scene_gives_the_same_bytes_and_replaces_nothing_unasked(self):
        self.succeed(self.split("--out", "a"))
        first = self.files("a")
        self.assertEqual(set(first), {"plate.yaml"} | {f"plate_{k}.msh" for k in (1, 2, 3)})
        again = self.split("--out", "a")
        self.assertEqual(again.returncode, 2)
        self.assertIn("plate_1.msh: is there already. Give another --out, or --force", again.stderr)
        self.assertEqual(self.files("a"), first)
        self.succeed(self.split("--out", "a", "--force", "--body", "plate"))
        self.assertEqual(self.files("a"), first)

    def test_what_the_command_line_sets_is_in_the_files(self):
        self.succeed(self.split("--out", "a", "--set", "time.end=0.3"))
        self.assertIn(b"end: 0.3", self.files("a")["plate.yaml"])
        refused = self.split("--out", "b", "--set", "bodies.plate.model={rigid: {dimension: 2, "
                             "mesh: {disk: {radius: 1.0, core: 2, layers: 1}}}}", "--set",
                             "bodies.plate.integrator={rigid_motion: {step: 0.05}}", "--set",
                             "bodies.plate.points=null", "--set", "bodies.plate.initial=null",
                             "--set", "bodies.plate.ports=null", "--body", "plate")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("has no cells to deal out", refused.stderr)
        self.assertFalse((self.folder / "b").exists())

    def test_bodies_without_inertia_are_divided(self):
        still = ["--set", "bodies.plate.integrator={quasi_static: {step: 0.5}}", "--set",
                 "bodies.plate.initial=null", "--set", "time.window=0.5", "--set",
                 "bodies.plate.constraints={foot: {on: left, fixed: true}}", "--set",
                 'bodies.plate.loads={pull: {on: right, traction: ["1.0e-3*t", "0"]}}']
        self.succeed(self.split("--out", "a", *still))
        self.succeed(self.abut("run", "a/plate.yaml", "--local", "--out", "parts"))
        self.succeed(self.abut("run", "plate.yaml", "--local", "--out", "whole", *still))
        found = [self.summary(self.folder / name)["measures"] for name in ("parts", "whole")]
        corner = [value for name, value in found[0].items()
                  if name.endswith(".corner.displacement.x")]
        self.assertAlmostEqual(corner[0], found[1]["body.plate.corner.displacement.x"],
                               delta=1e-9)  # of 2e-3, tolerance of the iteration 1e-6


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
