"""Goal: two ranks of PETSc solve the equations of one body, and a run ends as any other: with them
killed it ends in words and leaves no process behind. Oracle: the rod's closed form, and factors.

usage: test_petsc.py ABUT ROOT      exit code 77 (skipped) without PETSc in the build, or mpirun
"""

import shutil
import subprocess
import sys

sys.dont_write_bytecode = True
from support import ABUT, ROOT, SystemTest, main  # noqa: E402

FOLDER = ROOT / "examples" / "petsc_body"


class Petsc(SystemTest):
    def setUp(self):
        super().setUp()
        self.environment["ABUT_SOLVER"] = str(ABUT.parent / "abut-solver")
        self.environment["OMPI_ALLOW_RUN_AS_ROOT"] = "1"
        self.environment["OMPI_ALLOW_RUN_AS_ROOT_CONFIRM"] = "1"
        self.environment["PETSC_OPTIONS"] = "-pc_mpi_minimum_count_per_rank 1000"

    def rod(self, *changes: tuple) -> object:
        text = (FOLDER / "rod.yaml").read_text(encoding="utf-8")
        for old, new in (("./on_two_ranks.sh", str(FOLDER / "on_two_ranks.sh")), *changes):
            self.assertIn(old, text)
            text = text.replace(old, new)
        scene = self.folder / "rod.yaml"
        scene.write_text(text, encoding="utf-8")
        return scene

    def test_two_ranks_solve_the_equations_of_a_rod(self):
        self.allow(FOLDER / "on_two_ranks.sh")
        self.succeed(self.abut("run", self.rod(), "--out", self.out))
        one = self.summary()["state_hash"]
        self.succeed(self.abut("run", self.rod(), "--out", self.out, "--force"))
        self.assertEqual(self.summary()["state_hash"], one, "the same ranks, the same bits")

    def test_in_its_own_process_a_body_moves_as_by_factors(self):
        ends = []
        for solver in ("petsc: {}", "petsc: {tolerance: 1.0e-12}", "direct: {}"):
            scene = self.rod(
                ("petsc: {}", solver), ("elements: [80, 8, 8]", "elements: [12, 3, 3]"),
                ("quasi_static: {step: 0.5}", "newmark: {step: 1.0e-4}"),
                ("window: 0.5", "window: 1.0e-4"), ("end: 1.0,", "end: 1.0e-2,"))
            self.abut("run", scene, "--local", "--out", self.out, "--force", "--set",
                      "meta.expect=[]")
            ends.append(self.summary()["measures"]["body.rod.end.displacement.x"])
        for end, tolerance in ((ends[0], 1.0e-7), (ends[1], 1.0e-9)):
            # 100 steps, each of which adds a residual of the tolerance.
            self.assertAlmostEqual(end / ends[2], 1.0, delta=tolerance)


if __name__ == "__main__":
    told = subprocess.run([str(ABUT), "--version"], capture_output=True, text=True, check=True)
    if "petsc" not in told.stdout or shutil.which("mpirun") is None:
        print("skipped: a build without PETSc, or no mpirun")
        sys.exit(77)
    main()
