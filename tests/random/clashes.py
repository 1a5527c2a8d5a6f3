"""Goal: bodies of any shape, mesh, law, scheme and step that fly at each other, or fall on a floor
and on each other, run to their end with the settings that a scene has when it says nothing, make
no energy, and lose little of it. Written apart from abut_fuzz, as a user would: contact of
everything, no friction, schemes that conserve.
Oracles: the run's status; energy of bodies that nothing but contact acts on.

usage: clashes.py ABUT planar|space FIRST LAST [DIR]    scenes that fail are kept in DIR
"""

import json
import math
import random
import shutil
import statistics
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from coarse_steps import GAINED, outcome

TOUCHED = 1.0e-7  # of that: loads' work and schemes of finite strain aside, flight loses none
WITHIN = (0.05, 0.5, 5.0)  # [%]


@dataclass
class Body:
    law: str
    mesh: str
    low: list
    high: list
    element: str
    crossed: float  # [s] in which a wave crosses its smallest cell


class Clash:
    def __init__(self, seed: int, dim: int) -> None:
        self.draw, self.dim = random.Random(1000003 * dim + seed), dim
        self.size = 10 ** self.draw.uniform(-2.5, 0.5)
        self.speed = self.draw.choice([0.1, 1, 1, 5, 20])
        self.modulus = 10 ** self.draw.uniform(6, 11.3)
        self.falls = self.draw.random() < 0.5
        self.order = self.draw.choice(["row", "stack", "grid"])

    def shape(self) -> tuple:
        """Its mesh, both corners of its box, its element, the height [m] of its smallest cell."""
        draw, dim, planar = self.draw, self.dim, self.dim == 2
        element = draw.choice(["quad4"] * 4 + ["tri3", "tri3", "tri6", "quad8"] if planar else
                              ["hex8"] * 4 + ["tet4", "tet4", "tet10"])
        shrink = 2.5 if element in ("tri6", "quad8", "tet10") else 1.0
        sides = [self.size * draw.uniform(0.4, 1.2) for _ in range(dim)]
        if draw.random() < 2 / 3:
            counts = [draw.randint(1, 8 if planar else 3) for _ in range(dim)]
            name = "rectangle" if planar else "box"
            mesh = f"{name}: {{lengths: {sides}, elements: {counts}, element: {element}}}"
            cell = min(side / count for side, count in zip(sides, counts))
            return mesh, [0.0] * dim, sides, element, cell / shrink
        radius, most = sides[0] / 2, 3 if planar else 2
        core, layers = draw.randint(1, most), draw.randint(1, most)
        mesh = (f"{'disk' if planar else 'sphere'}: {{radius: {radius}, core: {core}, "
                f"layers: {layers}, element: {element}}}")
        cell = radius * 0.25 / max(core, layers)
        return mesh, [-radius] * dim, [radius] * dim, element, cell / shrink

    def body(self) -> Body:
        draw = self.draw
        modulus = self.modulus * 10 ** draw.uniform(-1.5, draw.choice([0, 1]))
        ratio, density = draw.choice([0, 0.2, 0.3, 0.3, 0.4, 0.45]), 10 ** draw.uniform(2.9, 4)
        wave = math.sqrt(modulus * (1 - ratio) / ((1 + ratio) * (1 - 2 * ratio)) / density)
        name = draw.choice(["linear_elastic"] * 3 + ["neo_hookean"] * 3 +
                           ["saint_venant_kirchhoff", "hencky"])
        law = (f"{{{name}: {{youngs_modulus: {modulus!r}, poissons_ratio: {ratio}, "
               f"density: {density!r}}}}}")
        mesh, low, high, element, cell = self.shape()
        return Body(law, mesh, low, high, element, cell / wave)

    def place(self, i: int, body: Body, top: float) -> list:
        draw, size, last = self.draw, self.size, self.dim - 1
        gap = size * draw.choice([0.01, 0.05, 0.2])
        at = [-(low + high) / 2 for low, high in zip(body.low, body.high)]
        if self.order == "grid":
            cells = [i % 2, i // 2, 0][:self.dim]
            at = [1.3 * size * cell - low + draw.uniform(0, 0.05) * size
                  for cell, low in zip(cells, body.low)]
            at[last] += 0.03 * size
            return at
        along = last if self.order == "stack" else 0
        aside = 0.1 if self.order == "stack" else 0.2
        at = [x + draw.uniform(-aside, aside) * size for x in at]
        at[along] = top + gap - body.low[along]
        if self.order == "row" and self.falls:
            at[last] = -body.low[last] + draw.uniform(0.02, 0.2) * size
        return at

    def scheme(self, body: Body, window: float) -> str:
        step = window / self.draw.choice([1, 2, 3, 4, 5, 8, 10])
        fits = step < 0.35 * body.crossed and self.draw.random() < 0.7
        return f"{{{'central_difference' if fits else 'newmark'}: {{step: {step!r}}}}}"

    def scene(self) -> str:
        draw, dim = self.draw, self.dim
        bodies = [self.body() for _ in range(draw.randint(2, 5))]
        window = (min(body.crossed for body in bodies) * draw.choice([0.3, 1, 3, 10, 30]) *
                  draw.choice([1, 2, 5]))
        text, top = "", 0.0
        along = dim - 1 if self.order == "stack" else 0
        for i, body in enumerate(bodies):
            at = self.place(i, body, top)
            top = at[along] + body.high[along]
            velocity = [draw.uniform(-0.2, 0.2) * self.speed for _ in range(dim)]
            share = 0.3 if self.order == "stack" and self.falls else 1.0
            velocity[along] += share * self.speed * (1 - 2 * i / (len(bodies) - 1))
            weight = f"\n    body_force: {[0] * (dim - 1) + [-9.81]}" if self.falls else ""
            text += f"""
  b{i}:
    model: {{fe: {{dimension: {dim}, mesh: {{{body.mesh}}}}}}}
    material: {body.law}
    integrator: {self.scheme(body, window)}
    initial: {{position: {at}, velocity: {velocity}}}{weight}
    ports: {{skin: {{side: boundary}}}}"""
        if self.falls:
            sides = [20 * self.size] * (dim - 1) + [self.size]
            mesh = (f"{'rectangle' if dim == 2 else 'box'}: "
                    f"{{lengths: {sides}, elements: {[1] * dim}}}")
            text += f"""
  floor:
    model: {{rigid_tool: {{dimension: {dim}, mesh: {{{mesh}}}}}}}
    initial: {{position: {[-10 * self.size] * (dim - 1) + [-self.size]}}}
    ports: {{skin: {{side: boundary}}}}"""
        end = window * draw.randint(40, 120 if dim == 2 else 60)
        return (f"time: {{end: {end!r}, window: {window!r}}}\nbodies:{text}\n"
                "contact: {everything: {}}\n")


def lost_share(folder: Path, measures: dict) -> float:
    """Of the most that was in motion and stored at once: bodies that fall begin with little."""
    drift = measures.get("energy.total.relative_drift_end", 0.0)
    begin = measures.get("energy.total.begin", 0.0)
    summary = json.loads((folder / "o" / "summary.json").read_text(encoding="utf-8"))
    most = summary.get("accuracy", {}).get("given_up", {}).get("largest_energy", 0.0)
    return -drift * begin / most if most > 0.0 else 0.0


def main() -> int:
    abut, kind, first, last = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
    failed, lost = 0, []
    for seed in range(first, last):
        with tempfile.TemporaryDirectory() as name:
            text = Clash(seed, 2 if kind == "planar" else 3).scene()
            said, measures = outcome(abut, text, Path(name))
            share = lost_share(Path(name), measures)
            if not said and -share > 2.0 * GAINED:
                said = f"energy grew by {-share:.2g}"
            if said:
                failed += 1
                print(f"{kind} {seed}: {said}", flush=True)
                if len(sys.argv) > 5:
                    shutil.copytree(name, Path(sys.argv[5]) / f"{kind}_{seed}", dirs_exist_ok=True)
            elif abs(share) > TOUCHED:
                lost.append(100.0 * share)
    print(f"{last - first - failed} of {last - first} {kind}")
    if lost:
        print(f"of {len(lost)} that changed their energy, lost within " + ", ".join(
            f"{most} %: {sum(one <= most for one in lost)}" for most in WITHIN) +
            f"; median {statistics.median(lost):.2g} %")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
