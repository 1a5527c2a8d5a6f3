"""A small scene and a study of it, for tests, which begin with StudyTest."""

import json
from pathlib import Path

from support import SystemTest

BAR = """\
  {name}:
    model: {{fe: {{dimension: 1, mesh: {{bar: {{length: 0.25, elements: 10, area: 1.0e-6}}}}}}}}
    material: {{linear_elastic: {{youngs_modulus: 1.0e9, density: 1000.0}}}}
    integrator: {{central_difference: {{step: 5.0e-6}}}}
    initial: {{position: [{x}], velocity: [{v}]}}
    ports: {{tip: {{side: {side}}}}}
"""
SCENE = """\
meta:
  title: Two bars of ten elements
  closed_form: {bar_impact: {interface: impact}}
  expect:
    - {measure: momentum.total, at_most: 1.0e-30, because: "fails: a study must not mind"}
time: {begin: -2.0e-4, end: 8.0e-4, window: 1.0e-5}
bodies:
""" + BAR.format(name="left", x=-0.27, v=100.0, side="right") \
    + BAR.format(name="right", x=0.02, v=-100.0, side="left") + """\
interfaces:
  impact: {sides: [left.tip, right.tip], contact: {}}
"""
STUDY = """\
title: Small <bars>
base: scene.yaml
knobs:
  step: {values: [5.0e-6, 2.5e-6, 1e-6], set: [bodies.*.integrator.*.step]}
  elements:
    range: {from: 5, to: 20, points: 3, scale: log}
    set: [bodies.*.model.*.mesh.bar.elements]
errors:
  release: {measure: contact.impact.release_error, abs: true}
  kinetic: {history: left.kinetic, norm: rms, relative_to: 1.25}
repeats: 3
figures:
  - histories: [position, velocity, force, mean_velocity, kinetic, total_error]
    of: left.tip
    runs: "*elements 20"
  - {convergence: kinetic, knob: elements}
  - {table: {release: 100 * release, n: schwarz.iterations_max}, knob: elements, title: Spread}
  - {table: {release: release, wall: wall_s_median}, runs: "*elements 10", title: By run}
claims:
  - text: Released within a tenth
    checks: [{value: release, at_most: 0.1, percent: true}]
"""


def write(folder: Path, study: str = STUDY, scene: str = SCENE) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scene.yaml").write_text(scene, encoding="utf-8")
    (folder / "study.yaml").write_text(study, encoding="utf-8")
    return folder / "study.yaml"


class StudyTest(SystemTest):
    def study(self, *arguments: object, text: str = STUDY):
        path = write(self.folder / "s", text)
        return self.abut("study", path, "--out", self.out, *arguments)

    def rows(self) -> list:
        return json.loads((self.out / "results.json").read_text(encoding="utf-8"))
