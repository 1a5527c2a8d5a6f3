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
    def test_files_are_those_of_their_script(self):
        with tempfile.TemporaryDirectory() as directory:
            script = MESHES / "elliptic_rings.py"
            subprocess.run([sys.executable, "-B", script, directory], check=True)
            written = sorted(path.name for path in Path(directory).iterdir())
            self.assertEqual(written, ["elliptic_membrane.msh", "elliptic_plate.msh"])
            for name in written:
                same = (Path(directory) / name).read_text() == (MESHES / name).read_text()
                self.assertTrue(same, f"{name} differs: run configs/meshes/elliptic_rings.py")


if __name__ == "__main__":
    unittest.main()
