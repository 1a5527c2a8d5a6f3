"""Goal: measures of bodies over time are what bodies tell, whoever starts them and however often
the run is cut. Oracles: the run's own summary, the plane wave of a blow, the file of the
uninterrupted run.

usage: test_measures.py ABUT ROOT
"""

import csv
import signal
import sys
import time

sys.dont_write_bytecode = True
from support import ABUT, SystemTest, main  # noqa: E402

# Two steel bars, clamped in width, so that the wave of the blow is plane: in their middle stands
# -rho c v until it comes back from the ends.
SCENE = """\
units: SI
time: {end: 6.0e-5, window: 1.0e-6}
bodies:
  left:
    model:
      fe: {dimension: 3, mesh: {box: {lengths: [0.2, 0.01, 0.01], elements: [80, 2, 2]}}}
    material: {linear_elastic: {youngs_modulus: 2.0e11, poissons_ratio: 0.0, density: 8000.0}}
    integrator: {central_difference: {step: 2.5e-7}}
    initial: {position: [-0.2, 0, 0], velocity: [5, 0, 0]}
    points: {middle: {at: [-0.1, 0.005, 0.005]}}
    ports: {face: right, gauge: middle}
  right:
    like: left
    initial: {position: [0.0, 0, 0], velocity: [-5, 0, 0]}
    points: {middle: {at: [0.1, 0.005, 0.005]}}
    ports: {face: left, gauge: middle}
interfaces: {hit: {sides: [left.face, right.face], contact: {}}}
output:
  checkpoint: {windows: 5}
  measures: {of: [body.left.gauge.stress.xx, body.right.displacement.x.max], every: 3}
"""


class Measures(SystemTest):
    def setUp(self):
        super().setUp()
        self.scene = self.folder / "scene.yaml"
        self.scene.write_text(SCENE, encoding="utf-8")

    def run_scene(self, *arguments: object):
        return self.abut("run", self.scene, "--out", self.out, "--force", *arguments)

    def rows(self) -> list[dict]:
        with (self.out / "measures.csv").open(encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_they_are_the_stress_of_the_blow_and_end_as_the_summary_tells(self):
        self.succeed(self.run_scene())
        rows = self.rows()
        stress = [(float(row["time [s]"]), float(row["body.left.gauge.stress.xx [Pa]"]))
                  for row in rows]
        self.assertEqual(len(rows), 1 + 20, "the begin, and every third of 60 windows")
        # It is there 20 us after the touch, and leaves 40 us later; 5 us around are its front.
        blow = 8000.0 * 5000.0 * 5.0
        self.assertTrue(all(abs(value) < 0.05 * blow for at, value in stress if at < 1.5e-5))
        within = [value for at, value in stress if 3.0e-5 < at < 5.5e-5]
        self.assertGreater(len(within), 5)
        for value in within:  # 4 % of it rings behind the front on these cells
            self.assertAlmostEqual(value / -blow, 1.0, delta=0.08)
        told = self.summary()["measures"]
        for name, unit in (("body.left.gauge.stress.xx", "Pa"),
                           ("body.right.displacement.x.max", "m")):
            self.assertEqual(float(rows[-1][f"{name} [{unit}]"]), told[name])

    def test_they_are_the_same_in_one_process_and_after_a_kill(self):
        self.succeed(self.run_scene())
        whole = (self.out / "measures.csv").read_bytes()
        self.succeed(self.run_scene("--local"))
        self.assertEqual((self.out / "measures.csv").read_bytes(), whole)
        run = self.start_run()
        until = time.monotonic() + 20.0
        while run.poll() is None and time.monotonic() < until:
            if (self.out / "checkpoint.abut").is_file():
                break
            time.sleep(0.002)
        run.send_signal(signal.SIGKILL)
        self.end(run)
        self.leaves_sockets = True
        if not (self.out / "summary.json").exists():
            self.succeed(self.abut("resume", self.out))
        self.assertEqual((self.out / "measures.csv").read_bytes(), whole)

    def start_run(self):
        self.out = self.folder / "cut"
        return self.start(ABUT, "run", self.scene, "--out", self.out, "--force")

    def test_the_page_draws_them(self):
        self.succeed(self.run_scene("--local"))
        self.succeed(self.abut("report", self.out))
        page = (self.out / "report.html").read_text(encoding="utf-8")
        for curve in ("left.gauge.stress.xx", "right.displacement.x.max"):
            self.assertIn(f'"{curve}"', page)

    def test_what_no_body_tells_is_refused(self):
        result = self.run_scene("--set", "output.measures.of=[body.left.gauge.strain.xx]")
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("output.measures.of", result.stderr)
        self.assertIn("names 'body.left.gauge.strain.xx', which no body tells. "
                      "The nearest are: body.left.gauge.stress.xx, ", result.stderr)
        self.assertFalse(self.out.exists())


if __name__ == "__main__":
    main()
