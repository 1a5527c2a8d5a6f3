"""Goal: what `abut check` tells before a run holds what the run takes. Oracle: shipped scenes of
every kind: their exchanges, and the calls of joined bodies.

usage: test_estimates.py ABUT ROOT RUNS SCENE...
"""

import sys

sys.dont_write_bytecode = True
from support import SystemTest, shared_run, strict_json  # noqa: E402

import unittest  # noqa: E402

SCENES = sys.argv[4:]


class Estimates(SystemTest):
    def test_bounds_hold_what_shipped_scenes_take(self):
        self.assertGreater(len(SCENES), 10)
        tied = 0
        for scene in SCENES:
            with self.subTest(scene=scene):
                summary = strict_json(
                    (shared_run(scene) / "summary.json").read_text(encoding="utf-8"))
                low, high = summary["estimate"]["exchanges"]
                self.assertLessEqual(low, summary["exchanges"])
                self.assertLessEqual(summary["exchanges"], high)
                for net in summary["estimate"]["ties"]:
                    tied += 1
                    fewest, most = net["calls"]
                    mean = summary["measures"]["schwarz.iterations_mean"]
                    self.assertLessEqual(fewest, mean)
                    if most is not None:  # the first windows have trials: one call more in two
                        self.assertLessEqual(mean, most + 2.0 / summary["windows"])
        self.assertGreater(tied, 4)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
