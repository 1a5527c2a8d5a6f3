"""Goal: every scene that `abut init` writes runs at once, and does what it says. Oracles: the
scenes' own expectations, the contacts of the runs, the bytes of the files, exit codes.
usage: test_init.py ABUT ROOT
"""

import shlex
import sys
import unittest

sys.dont_write_bytecode = True
from support import ROOT, SystemTest, main  # noqa: E402

MESHES = ROOT / "configs" / "meshes"


class Init(SystemTest):
    def init(self, name: str, *arguments: object):
        return self.abut("init", name, *arguments)

    def run_scene(self, scene: str) -> dict:
        """The measures of a run that began as it was and met its expectations."""
        self.succeed(self.abut("run", scene, "--local", "--out", self.out, "--force"))
        return self.summary()["measures"]

    def refused(self, result, words: str):
        self.assertEqual((result.returncode, result.stdout), (2, ""), result.stderr)
        self.assertIn(words, result.stderr)

    def test_scenes_of_every_kind_run_and_meet_their_expectations(self):
        for kind in ("bars", "contact", "friction", "joined"):
            with self.subTest(kind):
                said = self.succeed(self.init(kind, "--from", kind)).stdout
                self.assertEqual(said, f"written: {kind}.yaml\nnext: abut run {kind}.yaml\n")
                text = (self.folder / f"{kind}.yaml").read_text(encoding="utf-8")
                self.assertNotIn("@", text)
                self.assertIn(f"#   abut run {kind}.yaml", text)
                self.run_scene(f"{kind}.yaml")
                told = self.summary()["expectations"]
                self.assertGreaterEqual(len(told), 2, "it says what it must produce")

    def test_two_bars_are_the_default_and_a_name_may_have_its_ending(self):
        self.succeed(self.init("a/mine.yaml"))
        self.succeed(self.init("bars", "--from", "bars"))
        mine = (self.folder / "a" / "mine.yaml").read_text(encoding="utf-8")
        bars = (self.folder / "bars.yaml").read_text(encoding="utf-8")
        self.assertEqual(mine.replace("a/mine.yaml", "bars.yaml").replace("mine", "bars"), bars)

    def test_a_study_runs_with_its_scene(self):
        said = self.succeed(self.init("mine", "--from", "study")).stdout
        self.assertIn("written: mine.yaml\nwritten: mine_study.yaml\n", said)
        self.run_scene("mine.yaml")
        study = self.abut("study", "mine_study.yaml", "--quick", "--out", "studied")
        self.assertIn("4 completed", self.succeed(study).stdout)

    def test_a_mesh_flies_against_a_wall(self):
        for mesh in ("gear_12", "block"):  # a plane one in millimetres, and quadratic tetrahedra
            with self.subTest(mesh):
                self.succeed(self.init(mesh, "--from", "gmsh", MESHES / f"{mesh}.msh"))
                measures = self.run_scene(f"{mesh}.yaml")
                self.assertGreaterEqual(measures[f"contact.{mesh}_wall.closings"], 1)
                self.assertLess(measures[f"mean_velocity.{mesh}.end_x"], 9.0, "it was stopped")

    def test_meshes_fly_against_each_other_and_have_their_groups_as_ports(self):
        names = ["gear_12", "plate_with_hole", "gear_12"]
        said = self.succeed(self.init("three", "--from", "gmsh",
                                      *(MESHES / f"{name}.msh" for name in names))).stdout
        self.assertIn("gear_12_2: 243 nodes, 180 quad4, 0.007866 x 0.01071 m\n", said)
        text = (self.folder / "three.yaml").read_text(encoding="utf-8")
        for line in ("      teeth: teeth\n", "      hole: hole\n", "scale: 1 mm}",
                     "    material: {neo_hookean: steel}   # there are steel, aluminium, "):
            self.assertIn(line, text)
        measures = self.run_scene("three.yaml")
        contact = "contact.gear_12_plate_with_hole"
        self.assertGreaterEqual(measures[f"{contact}.closings"], 1)
        self.assertGreater(measures[f"{contact}.impulse"], 0.0)

    def test_solids_meet_in_space(self):
        self.succeed(self.init("pair", "--from", "gmsh", *[MESHES / "block.msh"] * 2))
        measures = self.run_scene("pair.yaml")
        self.assertGreaterEqual(measures["contact.block_block_2.closings"], 1)
        self.assertGreater(measures["mean_velocity.block_2.end_x"], 1.0)

    def test_an_input_file_of_abaqus_is_a_body_with_its_surfaces_as_ports(self):
        said = self.succeed(self.init("part", "--from", "mesh", MESHES / "two_parts.inp")).stdout
        self.assertIn("two_parts: 3 hexahedra and 2 prisms divided into 24 tetrahedra\n", said)
        self.assertIn("two_parts: skipped, not applied: *MATERIAL, *ELASTIC, ", said)
        text = (self.folder / "part.yaml").read_text(encoding="utf-8")
        for line in ("mesh: {abaqus: {file: ", "scale: 1 m}", "      wedge_top: wedge.top\n"):
            self.assertIn(line, text)
        self.succeed(self.abut("check", "part.yaml"))

    def test_names_of_groups_and_files_become_names_of_a_scene(self):
        part = self.folder / "part of it.msh"
        part.write_bytes((MESHES / "block.msh").read_bytes())
        self.succeed(self.init("scenes/part", "--from", "gmsh", "part of it.msh"))
        text = (self.folder / "scenes" / "part.yaml").read_text(encoding="utf-8")
        self.assertIn('file: "../part of it.msh"', text)
        self.assertIn('top_of_it: "top of it"', text)
        self.assertIn("# sets of nodes, for constraints: between, edge, origin", text)
        self.succeed(self.abut("check", "scenes/part.yaml"))

    def test_the_next_command_may_be_typed_as_it_stands(self):
        said = self.succeed(self.init("it's a scene", "--from", "bars")).stdout
        command = said.split("next: abut ")[1].strip()
        self.assertEqual(shlex.split(command), ["run", "it's a scene.yaml"])

    def test_files_that_are_there_stay_unless_forced(self):
        (self.folder / "mine_study.yaml").write_text("mine", encoding="utf-8")
        self.refused(self.init("mine", "--from", "study"),
                     "mine_study.yaml: is there already. Give another name, or --force.")
        self.assertFalse((self.folder / "mine.yaml").exists(), "nothing was written")
        self.succeed(self.init("mine", "--from", "study", "--force"))

    def test_what_cannot_be_written_is_refused_in_words(self):
        names = ("box_surface", "block", "gear_12")
        surface, block, gear = (MESHES / f"{name}.msh" for name in names)
        for arguments, words in (
                (["a", "--from", "bar"], "--from: is bar, which is not known. Choose one of bars,"),
                (["a", "--from", "gmsh"], "--from gmsh: names no mesh. Give one .msh or .inp "),
                (["a", "b"], "b: is more than the scene's name. Give a single name; "),
                (["", "--from", "bars"], "names no file"),
                (["a", "--from", "gmsh", "none.msh"], "none.msh: "),
                (["a", "--from", "gmsh", surface], "Mesh the volume"),
                (["a", "--from", "gmsh", block, gear], "has 2 dimensions, but "),
        ):
            with self.subTest(arguments):
                self.refused(self.init(*arguments), words)
        self.assertEqual(list(self.folder.glob("*.yaml")), [])


if __name__ == "__main__":
    main()
