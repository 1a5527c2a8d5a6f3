"""Goal: mesh files that a script beside them writes are what it writes.

usage: test_meshes.py ROOT
"""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(sys.argv.pop())
MESHES = ROOT / "configs" / "meshes"


class Meshes(unittest.TestCase):
    SCRIPTS = {
        "elliptic_rings.py": ["elliptic_membrane.msh", "elliptic_plate.msh"],
        "bolt.py": ["bolt.msh"],
        "flange_bolt.py": ["flange_bolt.msh"],
        "plate_with_hole.py": ["plate_with_hole.msh"],
        "gears.py": ["gear_12.msh", "gear_18.msh"],
    }

    def test_files_are_those_of_their_script(self):
        for script, names in self.SCRIPTS.items():
            with self.subTest(script), tempfile.TemporaryDirectory() as directory:
                subprocess.run([sys.executable, "-B", MESHES / script, directory], check=True)
                written = sorted(path.name for path in Path(directory).iterdir())
                self.assertEqual(written, names)
                for name in written:
                    same = (Path(directory) / name).read_text() == (MESHES / name).read_text()
                    self.assertTrue(same, f"{name} differs: run configs/meshes/{script}")


if __name__ == "__main__":
    unittest.main()
