"""Goal: `abut conformance` tells what is wrong with a body by the clause that is meant for it, and
by no other; and finds nothing wrong with ours.

Wrong bodies are made wrong on purpose, in one thing each (wrong_body.py), so what must be found is
known. usage: test_conformance.py ABUT ROOT CLASS [SCENE...]
"""

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from support import ABUT, PACKAGE, ROOT, SystemTest, main

WRONG = Path(__file__).resolve().parent / "wrong_body.py"
SCENES = sys.argv[4:]
AT_ONCE = 3  # most of the time is silence that is waited for

# What is wrong, and the clauses that must be broken by it.
BODIES = {
    "looks_inward": {"orientation"},
    "takes_long_steps": {"ends", "kernel"},  # a kernel is told at steps of its description
    "slows_down_by_windows": {"parts"},
    "moves_in_no_time": {"no length"},
    "ignores_the_length_of_steps": {"motion", "momentum"},
    "ignores_it_and_tells_what_it_would_be": {"motion", "momentum"},
    "tells_speeds_backwards": {"motion"},
    "tells_no_speeds": {"motion"},
    "tells_points_in_another_order": {"points", "work"},
    "presses_on_neighbours": {"points", "work"},
    "presses_on_neighbours_and_is_damped": {"points"},  # no energy tells it
    "remembers": {"restore"},
    "has_one_hash": {"hash"},
    "tells_small_boxes": {"boxes"},
    "bounds_too_low": {"speed"},
    "tells_small_velocities": {"speed"},
    "loses_momentum": {"momentum"},
    "takes_one_partner": {"momentum"},
    "takes_all_forces_as_nodal": {"momentum", "kernel"},  # which is of a force by steps
    "tells_double_work": {"work"},
    "tells_half_the_energy": {"work"},
    "tells_no_stored_energy": {"work"},
    "has_a_soft_kernel": {"kernel"},
    "moves_by_probes": {"kernel"},
    "keeps_half": {"checkpoint"},
}
SOLVERS = {
    "has_a_fixed_session": {"greeting"},
    "reads_damaged_frames": {"damage"},
    "reads_all_sessions": {"session"},
    "executes_again": {"repeats"},
    "overlooks_gaps": {"gaps"},
    "saves_before_it_restores": {"riding"},
    "answers_anything": {"unknown"},
    "takes_anything": {"refusals"},
    "is_silent": {"alive"},
    "stays": {"finish"},
    "overlooks_refusal": {"refused"},
    "overlooks_loss": {"lost"},
}
LINES = {"looks_inward_on_a_line": {"orientation"}}
OF_BODIES = ["orientation", "ends", "parts", "no length", "restore", "hash", "boxes", "speed",
             "momentum", "kernel", "work", "motion", "points", "checkpoint"]
OF_SOLVERS = sorted(set().union(*SOLVERS.values()))


class ConformanceTest(SystemTest):
    def setUp(self):
        super().setUp()
        self.environment["PYTHONPATH"] = str(PACKAGE)
        self.environment["PYTHONDONTWRITEBYTECODE"] = "1"

    def tried(self, *arguments: object, wrong: str = "nothing"):
        """Exit code, clauses that are broken, clauses that are kept, and all that is said."""
        result = subprocess.run([ABUT, "conformance", *map(str, arguments)], cwd=self.folder,
                                env={**self.environment, "WRONG_BODY": wrong}, timeout=600,
                                capture_output=True, text=True, check=False)
        verdicts = {"BROKEN": set(), "kept": set()}
        for line in result.stdout.splitlines():
            for word, clauses in verdicts.items():
                if line.startswith("  ") and line[15:].startswith(word):
                    clauses.add(line[2:15].strip())
        said = result.stdout + result.stderr
        return result.returncode, verdicts["BROKEN"], verdicts["kept"], said


class Wrong(ConformanceTest):
    def hold(self, bodies: dict, clauses: list):
        with ThreadPoolExecutor(AT_ONCE) as pool:
            runs = {wrong: pool.submit(self.tried, WRONG, "--only", ",".join(clauses), wrong=wrong)
                    for wrong in bodies}
        for wrong, found in runs.items():
            with self.subTest(wrong):
                code, broken, _, said = found.result()
                self.assertEqual(broken, bodies[wrong], said)
                self.assertEqual(code, 1, said)

    def test_a_wrong_body_breaks_the_clause_that_is_meant_for_it(self):
        self.hold(BODIES, OF_BODIES)

    def test_a_wrong_body_in_one_dimension_breaks_the_clause_that_is_meant_for_it(self):
        self.hold(LINES, ["orientation", "momentum"])
        code, broken, kept, said = self.tried(WRONG, "--only", "orientation",
                                              wrong="nothing_on_a_line")
        self.assertEqual((code, broken, kept), (0, set(), {"orientation"}), said)

    def test_a_body_that_fails_has_a_table_all_the_same(self):
        for wrong, kept_before in (("is_lost_in_numbers", {"ends", "no length"}),
                                   ("converges_never", {"orientation"})):
            with self.subTest(wrong):
                code, broken, kept, said = self.tried(WRONG, "--only", ",".join(OF_BODIES),
                                                      wrong=wrong)
                self.assertEqual(code, 1, said)
                self.assertLessEqual(kept_before, kept, said)
                self.assertLessEqual({"restore", "motion", "checkpoint"}, broken, said)
                self.assertEqual(said.count("kept ") + said.count("BROKEN ") +
                                 said.count("not asked "), len(OF_BODIES), said)

    def test_a_wrong_solver_breaks_the_clause_that_is_meant_for_it(self):
        self.hold(SOLVERS, OF_SOLVERS)

    def test_a_window_that_ends_early_is_told_by_time(self):
        code, broken, _, said = self.tried(WRONG, "--only", "ends", wrong="ends_early")
        self.assertEqual((code, broken), (1, {"ends"}), said)
        self.assertIn("time", said)

    def test_nothing_wrong_is_found_where_nothing_is(self):
        code, broken, kept, said = self.tried(WRONG)
        self.assertEqual((code, broken), (0, set()), said)
        self.assertEqual(kept, {*OF_BODIES, *OF_SOLVERS}, said)  # every clause was asked

    def test_an_unknown_clause_is_refused_by_the_names_of_those_that_there_are(self):
        code, _, _, said = self.tried(WRONG, "--only", "restores")
        self.assertEqual(code, 2, said)
        self.assertIn("restore, ", said)

    def test_a_scene_starts_no_program_that_its_user_has_not_listed(self):
        scene = self.folder / "scene.yaml"
        scene.write_text("time: {end: 1.0e-3, window: 1.0e-4}\nbodies:\n  one:\n"
                         f"    launch: {{spawn: {{program: {WRONG}}}}}\n"
                         "    model: {external: {}}\n", encoding="utf-8")
        code, _, _, said = self.tried(scene)
        self.assertEqual(code, 2, said)
        self.assertIn("not on your list of programs", said)


class Ours(ConformanceTest):
    def test_bodies_of_ours_keep_every_clause(self):
        for scene in SCENES:
            with self.subTest(scene):
                code, broken, kept, said = self.tried(ROOT / "configs" / f"{scene}.yaml", "--only",
                                                      ",".join(OF_BODIES))
                self.assertEqual((code, broken), (0, set()), said)
                self.assertLessEqual({"ends", "restore", "checkpoint"}, kept, said)

    def test_the_solver_of_ours_keeps_every_clause_of_the_wire(self):
        code, broken, kept, said = self.tried(ROOT / "configs" / "contact" / "disks_oblique.yaml",
                                              "--only", ",".join(OF_SOLVERS))
        self.assertEqual((code, broken), (0, set()), said)
        self.assertLessEqual({*OF_SOLVERS} - {"alive"}, kept, said)  # fast ones have no long window


class Examples(ConformanceTest):
    def test_bodies_of_the_examples_keep_every_clause(self):
        folder = ROOT / "examples" / "python_body"
        mass = "{mass: 0.2, stiffness: 8.0e5, position: 0.0, step: 4.0e-6}"
        plate = ("{lengths: [0.25, 0.1], cells: [4, 2], corner: [0.0, 0.0], velocity: [0.0, 0.0], "
                 "step: 1.0e-5, youngs_modulus: 1.0e9, poissons_ratio: 0.3, density: 1000.0}")
        for program, keys in (("mass_on_spring.py", mass), ("my_body.py", plate)):
            with self.subTest(program):
                code, broken, _, said = self.tried(folder / program, "--keys", keys)
                self.assertEqual((code, broken), (0, set()), said)


if __name__ == "__main__":
    del sys.argv[4:]
    main()
