"""Goal: a shipped scene meets its expectations, and gives the same bits wherever its bodies live
and from whichever text.

The scene runs once in this process tree, into RUNS, where every other test finds that run: CTest
makes it first (tests/system/CMakeLists.txt). Oracles: the scene's own expectations, equality of
state hashes and of files.
usage: test_scenes.py ABUT ROOT RUNS SCENE Shared     the run that others read
       test_scenes.py ABUT ROOT RUNS SCENE Elsewhere  its bodies in processes
       test_scenes.py ABUT ROOT RUNS SCENE Files      the same from the scene's own text
"""

import shutil
import sys
from pathlib import Path

sys.dont_write_bytecode = True
from support import ROOT, SystemTest, bits, lacks_library, main, shared_run  # noqa: E402

SCENE = ROOT / "configs" / f"{sys.argv[4]}.yaml"


class SceneTest(SystemTest):
    def run_in(self, folder: Path, scene: Path, *arguments: object) -> Path:
        self.succeed(self.abut("run", scene, "--out", folder, *arguments))
        self.assert_whole(folder)
        self.assertEqual(self.summary(folder)["status"], "completed")
        return folder


class Shared(SceneTest):
    def test_the_scene_meets_its_expectations_and_its_page_tells_them(self):
        shared = shared_run(sys.argv[4])
        shutil.rmtree(shared, ignore_errors=True)  # what a failure leaves is none of this program
        if lacks_library(SCENE):
            refused = self.abut("run", SCENE, "--local", "--out", shared)
            self.assertEqual(refused.returncode, 2)
            self.assertIn("make build WITH=", refused.stderr)
            return
        told = self.succeed(self.abut("check", SCENE, "--probe", "0")).stdout
        self.assertIn("valid", told)
        self.assertNotIn("warning:", told, "numbers of shipped scenes are meant")
        self.run_in(shared, SCENE, "--local")
        self.assertTrue(self.summary(shared)["expectations"], "the scene expects something")
        self.assert_page_tells_the_measures(shared)


class Elsewhere(SceneTest):
    def setUp(self):
        super().setUp()
        if lacks_library(SCENE):
            self.skipTest("this program was built without the library that the scene needs")

    def test_processes_that_read_the_resolved_scene_reach_the_same_bits(self):
        """Two things change at once: whichever of them changes a bit is seen, and then told."""
        expected = bits(shared_run(sys.argv[4]))
        resolved = shared_run(sys.argv[4]) / "scene.resolved.yaml"
        if bits(self.run_in(self.folder / "spawned", resolved)) == expected:
            return
        with self.subTest("the resolved scene in one process"):
            self.assertEqual(bits(self.run_in(self.folder / "again", resolved, "--local")),
                             expected)
        with self.subTest("the scene in processes"):
            self.assertEqual(bits(self.run_in(self.folder / "own", SCENE)), expected)
        self.fail("the resolved scene in processes gives other bits")


class Files(Elsewhere):
    test_processes_that_read_the_resolved_scene_reach_the_same_bits = None

    def test_processes_find_the_files_that_the_scene_names(self):
        """The resolved scene names them in full; the scene does so from its own folder."""
        self.assertEqual(bits(self.run_in(self.folder / "own", SCENE)),
                         bits(shared_run(sys.argv[4])))


if __name__ == "__main__":
    main(4)
