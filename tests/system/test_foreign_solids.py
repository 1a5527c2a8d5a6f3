"""Goal: solids of others collide with ours as ours do with each other: expectations of the shipped
scenes are closed forms, which are held here; and their bodies keep the contract.

usage: test_foreign_solids.py ABUT ROOT CLASS      exit code 77 (skipped) without what a class needs
"""

import importlib.util
import sys

from support import PACKAGE, ROOT, SystemTest, main

EXAMPLES = ROOT / "examples"


class ForeignTest(SystemTest):
    def setUp(self):
        super().setUp()
        self.environment["PYTHONPATH"] = str(PACKAGE)
        self.environment["PYTHONDONTWRITEBYTECODE"] = "1"

    def collide(self, folder: str, scene: str, program: str):
        """Programs are named from the folder that a run is started in."""
        place = EXAMPLES / folder
        text = (place / scene).read_text("utf-8")
        self.assertIn(f"./{program}", text)
        own = self.folder / scene
        own.write_text(text.replace(f"./{program}", str(place / program)), encoding="utf-8")
        self.allow(place / program)
        self.succeed(self.abut("run", own, "--out", self.out))
        self.assert_whole(self.out)

    def conform(self, program, keys: str):
        said = self.succeed(self.abut("conformance", program, "--keys", keys)).stdout
        for clause in ("restore", "momentum", "work", "kernel", "checkpoint", "lost"):
            self.assertRegex(said, f"{clause} +kept")


class Brick(ForeignTest):
    def test_a_brick_meets_a_bar_in_space(self):
        self.collide("python_body", "bricks.yaml", "brick.py")

    def test_a_brick_keeps_the_contract(self):
        self.conform(EXAMPLES / "python_body" / "brick.py",
                     "{lengths: [0.3, 0.2, 0.2], cells: [3, 2, 2], corner: [0, 0, 0], velocity: "
                     "[0, 0, 0], youngs_modulus: 1.0e9, poissons_ratio: 0.3, density: 1000, "
                     "step: 1.0e-5}")


class Pair(ForeignTest):
    def test_two_bodies_of_the_package_meet(self):
        self.collide("python_body", "two_plates.yaml", "my_body.py")
        self.assertGreater(self.summary()["accuracy"]["given_up"]["passive_windows"], 0)


class GetFem(ForeignTest):
    def test_a_bar_of_getfem_meets_one_of_ours(self):
        self.collide("getfem_body", "bars.yaml", "getfem_bar.py")

    def test_a_bar_of_getfem_keeps_the_contract(self):
        self.conform(EXAMPLES / "getfem_body" / "getfem_bar.py",
                     "{lengths: [1, 0.1], cells: [20, 2], corner: [0, 0], velocity: [0, 0], "
                     "youngs_modulus: 1.0e9, poissons_ratio: 0.3, density: 1000, step: 1.0e-5}")


if __name__ == "__main__":
    if "GetFem" in sys.argv and importlib.util.find_spec("getfem") is None:
        print("skipped: Python's getfem is not installed (Debian: python3-getfem)")
        sys.exit(77)
    main()
