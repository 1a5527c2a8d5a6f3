"""Goal: scenes that somebody else would write, in steps far longer than waves need, run to their
end: bars of unlike steps and schemes that hit each other, and blocks that are pressed without
inertia, by tools and by each other, of which nothing but contact holds those in the middle.
Oracles: the run's status; contact makes no energy; what presses a stack at its top presses at its
bottom.

usage: coarse_steps.py ABUT bars|pressed FIRST LAST [DIR]    scenes that fail are kept in DIR
"""

import json
import math
import random
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SECONDS = 60
GAINED = 1.0e-3  # of the most there is in motion: what EnergyGuard lets stand
UNBALANCED = 0.02  # of the force: what stabilisation may bear, and the iteration's tolerance


def bars(seed: int) -> str:
    draw = random.Random(seed)
    count = draw.randint(2, 4)
    kinds = []
    for _ in range(count):
        modulus, density = 10 ** draw.uniform(8, 11), 10 ** draw.uniform(2.8, 4)
        length, elements = draw.uniform(0.1, 1), draw.randint(3, 60)
        kinds.append((modulus, density, length, elements, 10 ** draw.uniform(-4, -2),
                      length / elements / math.sqrt(modulus / density),
                      draw.choice([1, 2, 3, 4, 5, 7, 8, 10])))
    window = max(kind[5] for kind in kinds) * draw.choice([0.5, 1, 2, 4])
    bodies, place = "", 0.0
    for i, (modulus, density, length, elements, area, transit, parts) in enumerate(kinds):
        step = window / parts
        fits = step < 0.9 * transit and draw.random() < 0.6
        scheme = "central_difference" if fits else "newmark"
        speed = draw.uniform(-10, 10) + (10 if i == 0 else -10 if i == count - 1 else 0)
        mesh = f"{{length: {length!r}, elements: {elements}, area: {area!r}}}"
        bodies += f"""
  b{i}:
    model: {{fe: {{dimension: 1, mesh: {{bar: {mesh}}}}}}}
    material: {{linear_elastic: {{youngs_modulus: {modulus!r}, density: {density!r}}}}}
    integrator: {{{scheme}: {{step: {step!r}}}}}
    initial: {{position: {place!r}, velocity: {speed!r}}}
    ports: {{left: left, right: right}}"""
        place += length * (1 + draw.choice([0, 1e-4, 1e-2])) + 1e-9
    pairs = "".join(f"\n  p{i}: {{sides: [b{i}.right, b{i + 1}.left], contact: {{}}}}"
                    for i in range(count - 1))
    return (f"time: {{end: {window * draw.randint(30, 200)!r}, window: {window!r}}}\n"
            f"bodies:{bodies}\ninterfaces:{pairs}\n")


class Pressed:
    """Blocks in the plane on one that is held, pressed by a tool or by the lid of a stack."""

    def __init__(self, seed: int) -> None:
        self.draw = random.Random(seed)
        self.modulus = 10 ** self.draw.uniform(6, 11.3)
        self.ratio = self.draw.choice([0, 0.2, 0.3, 0.3, 0.4, 0.45])
        self.size = 10 ** self.draw.uniform(-2, 0.5)
        self.window = 1.0 / self.draw.randint(5, 20)
        self.lid = ""  # the body that presses, where it is no tool

    def law(self, factor: float) -> str:
        modulus = self.modulus * factor
        name = self.draw.choice(["linear_elastic"] * 2 + ["neo_hookean"] * 2 +
                                ["saint_venant_kirchhoff", "hencky", "j2_plasticity"])
        more = ""
        if name == "j2_plasticity":
            more = (f", yield_stress: {modulus * self.draw.uniform(1e-3, 1e-2)}"
                    f", hardening: {modulus * self.draw.uniform(0, 0.05)}")
        return (f"{{{name}: {{youngs_modulus: {modulus}, poissons_ratio: {self.ratio}, "
                f"density: 1000.0{more}}}}}")

    def block(self, name: str, lengths: list, place: list, factor: float, more: str) -> str:
        elements = [self.draw.randint(2, 10), self.draw.randint(2, 10)]
        element = self.draw.choice(["quad4"] * 4 + ["tri3", "tri6", "quad8"])
        mesh = f"{{lengths: {lengths}, elements: {elements}, element: {element}}}"
        return f"""
  {name}:
    model: {{fe: {{dimension: 2, mesh: {{rectangle: {mesh}}}}}}}
    material: {self.law(factor)}
    integrator: {{quasi_static: {{step: {self.window!r}}}}}
    initial: {{position: {place}}}
    ports: {{skin: boundary}}{more}"""

    def scene(self) -> str:
        draw, size = self.draw, self.size
        way = size * draw.choice([0.01, 0.03, 0.1])
        wide, high = size * draw.uniform(1, 3), size * draw.uniform(0.5, 1.2)
        bodies = self.block("base", [wide, high], [-wide / 2, -high], 1.0,
                            "\n    constraints: {base: {on: bottom, fixed: true}}")
        friction = draw.choice([0.1, 0.3, 0.5])
        names = ["base"]
        if draw.random() < 0.4:
            names.append("tool")
            radius = size * draw.uniform(0.2, 0.8)
            tool = f"{{dimension: 2, mesh: {{disk: {{radius: {radius}, core: 3, layers: 2}}}}"
            bodies += f"""
  tool:
    model: {{rigid_tool: {tool}, way: ["0", "-{way} * t"]}}}}
    initial: {{position: [0, {radius}]}}
    ports: {{skin: boundary}}"""
        else:
            bodies += self.stack(names, way)
        pairs = "".join(f"\n  c{i}: {{sides: [{one}.skin, {other}.skin], "
                        f"contact: {{friction: {friction}}}}}"
                        for i, (one, other) in enumerate(zip(names, names[1:])))
        return (f"time: {{end: 1.0, window: {self.window!r}}}\n"
                f"bodies:{bodies}\ninterfaces:{pairs}\n")

    def stack(self, names: list, way: float) -> str:
        bodies, top, count = "", 0.0, self.draw.randint(1, 3)
        for i in range(count):
            lengths = [self.size * self.draw.uniform(0.4, 1.5),
                       self.size * self.draw.uniform(0.3, 0.8)]
            last = i == count - 1
            held = f'\n    constraints: {{top: {{on: top, x: "0", y: "-{way} * t"}}}}'
            bodies += self.block(f"u{i}", lengths, [-lengths[0] / 2, top],
                                 10 ** self.draw.uniform(-1, 1), held if last else "")
            names.append(f"u{i}")
            top += lengths[1]
            self.lid = f"u{i}"
        return bodies


def outcome(abut: str, text: str, folder: Path) -> tuple:
    """Why a scene does not run to its end, empty: it does; its measures."""
    scene = folder / "scene.yaml"
    scene.write_text(text, encoding="utf-8")
    try:
        ran = subprocess.run([abut, "run", "--local", "--force", "--out", folder / "o", scene],
                             capture_output=True, text=True, timeout=SECONDS, check=False)
    except subprocess.TimeoutExpired:
        return f"longer than {SECONDS} s", {}
    if ran.returncode != 0:
        errors = [line for line in ran.stderr.splitlines() if "error" in line]
        return f"exit {ran.returncode}: {' '.join(errors)[:300]}", {}
    return "", json.loads((folder / "o" / "summary.json").read_text("utf-8"))["measures"]


def trouble(abut: str, text: str, folder: Path, lid: str, statics: bool) -> str:
    """What is wrong with a scene; empty: nothing."""
    ended, measures = outcome(abut, text, folder)
    if ended:
        return ended
    if not statics:
        drift = measures["energy.total.relative_drift_end"]
        return f"energy grew by {drift:.2g}" if drift > 2.0 * GAINED else ""
    if not lid:
        return ""
    up, down = measures["body.base.base.reaction.y"], measures[f"body.{lid}.top.reaction.y"]
    off = abs(up + down) / max(abs(up), abs(down), sys.float_info.min)
    return f"forces of {up:.4g} and {down:.4g} N do not balance" if off > UNBALANCED else ""


def main() -> int:
    abut, kind, first, last = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
    failed = 0
    for seed in range(first, last):
        pressed = Pressed(seed)
        text = bars(seed) if kind == "bars" else pressed.scene()
        with tempfile.TemporaryDirectory() as name:
            said = trouble(abut, text, Path(name), pressed.lid, kind != "bars")
            if said:
                failed += 1
                print(f"{kind} {seed}: {said}", flush=True)
                if len(sys.argv) > 5:
                    shutil.copytree(name, Path(sys.argv[5]) / f"{kind}_{seed}", dirs_exist_ok=True)
    print(f"{last - first - failed} of {last - first} {kind}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
