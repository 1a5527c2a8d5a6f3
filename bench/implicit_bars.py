"""Two bars of 50 x 5 x 5 hexahedra collide, implicit, 100 steps: processor time of abut with the
linear and the neo-Hookean law, in one process, and of CalculiX (Debian's calculix-ccx) with the
same mesh, law, scheme and step where it is installed; kinetic energy at the end beside it.

usage: implicit_bars.py BIN [STEPS]
"""

import json
import os
import resource
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

CELLS = (50, 5, 5)
STEP = 0.1  # [s]
SPEED = 0.05  # [m/s], of waves about 1
LAWS = {"linear": "linear_elastic", "neo-Hookean": "neo_hookean"}
SCENE = """\
time: {{end: {end}, window: {step}}}
bodies:
  left:
    model:
      fe: {{dimension: 3, mesh: {{box: {{lengths: [50.0, 5.0, 5.0], elements: [50, 5, 5]}}}}}}
    material: {{{law}: {{youngs_modulus: 1.0, poissons_ratio: 0.3, density: 1.0}}}}
    integrator: {{newmark: {{step: {step}}}}}
    initial: {{position: [-50.0, 0.0, 0.0], velocity: [{speed}, 0.0, 0.0]}}
    ports: {{face: right}}
  right:
    like: left
    initial: {{position: [0.0, 0.0, 0.0], velocity: [-{speed}, 0.0, 0.0]}}
    ports: {{face: left}}
interfaces:
  impact: {{sides: [left.face, right.face], contact: {{}}}}
"""


def timed(command: list, folder: str, **more) -> float:
    """Processor time [s] of a command and of what it starts."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, cwd=folder, stdout=subprocess.DEVNULL, check=True, **more)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def abut(bin_folder: Path, law: str, steps: int) -> tuple:
    with tempfile.TemporaryDirectory() as folder:
        scene = SCENE.format(end=steps * STEP, step=STEP, speed=SPEED, law=law)
        (Path(folder) / "bars.yaml").write_text(scene, encoding="utf-8")
        spent = timed([bin_folder / "abut", "run", "bars.yaml", "--out", "run", "--local",
                       "--quiet"], folder)
        summary = json.loads((Path(folder) / "run" / "summary.json").read_text(encoding="utf-8"))
        return spent, summary["measures"]


def nodes_of(first: int, x: float) -> list:
    nx, ny, nz = (n + 1 for n in CELLS)
    return [(first + i + nx * (j + ny * k), x + i, j, k)
            for k in range(nz) for j in range(ny) for i in range(nx)]


def cells_of(first_cell: int, first: int) -> list:
    nx, ny = CELLS[0] + 1, CELLS[1] + 1
    cells = []
    for k in range(CELLS[2]):
        for j in range(CELLS[1]):
            for i in range(CELLS[0]):
                a = first + i + nx * (j + ny * k)
                low = [a, a + 1, a + 1 + nx, a + nx]
                cells.append([first_cell + len(cells), *low, *[n + nx * ny for n in low]])
    return cells


def deck(steps: int) -> str:
    """Neo-Hookean by C10 = mu / 2 and D1 = 2 / K; contact by a linear penalty of 5 moduli per edge
    of a cell: with 50 CalculiX 2.20 gives up at 1.1 s (its energy is not among those printed)."""
    mu, bulk = 1.0 / 2.6, 1.0 / 1.2
    count = (CELLS[0] + 1) * (CELLS[1] + 1) * (CELLS[2] + 1)
    number = CELLS[0] * CELLS[1] * CELLS[2]
    bars = [(1, 1, -float(CELLS[0])), (count + 1, number + 1, 0.0)]
    lines = ["*NODE, NSET=ALL"]
    for first, _, x in bars:
        lines += ["%d, %g, %g, %g" % node for node in nodes_of(first, x)]
    for name, (first, cell, _) in zip(("LEFT", "RIGHT"), bars):
        lines.append(f"*ELEMENT, TYPE=C3D8, ELSET={name}")
        lines += [", ".join(map(str, row)) for row in cells_of(cell, first)]
    lines += ["*ELSET, ELSET=BOTH", "LEFT, RIGHT"]
    for name, first in (("NLEFT", 1), ("NRIGHT", count + 1)):
        lines += [f"*NSET, NSET={name}, GENERATE", f"{first}, {first + count - 1}"]
    faces = range(0, number, CELLS[0])  # C3D8: S4 is +x, S6 is -x
    lines += ["*SURFACE, NAME=SLEFT"] + [f"{f + CELLS[0]}, S4" for f in faces]
    lines += ["*SURFACE, NAME=SRIGHT"] + [f"{number + f + 1}, S6" for f in faces]
    lines += ["*MATERIAL, NAME=RUBBER", "*HYPERELASTIC, NEO HOOKE",
              f"{mu / 2:.12g}, {2 / bulk:.12g}",
              "*DENSITY", "1.0", "*SOLID SECTION, ELSET=BOTH, MATERIAL=RUBBER",
              "*SURFACE INTERACTION, NAME=PRESS", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
              "5.0", "*CONTACT PAIR, INTERACTION=PRESS, TYPE=SURFACE TO SURFACE", "SRIGHT, SLEFT",
              "*INITIAL CONDITIONS, TYPE=VELOCITY", f"NLEFT, 1, {SPEED}", f"NRIGHT, 1, -{SPEED}",
              f"*STEP, NLGEOM, INC={10 * steps}", "*DYNAMIC, DIRECT, ALPHA=0.0",
              f"{STEP}, {steps * STEP}",
              "*EL PRINT, ELSET=BOTH, TOTALS=ONLY, FREQUENCY=1", "ELSE, ELKE", "*END STEP"]
    return "\n".join(lines) + "\n"


def last_total(text: str, what: str) -> float:
    """The last total [J] of an energy in CalculiX's .dat file."""
    at = text.rindex(f"total {what} energy")
    return float(text[at:].splitlines()[2].split()[-1])


def calculix(program: str, steps: int) -> tuple:
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "bars.inp").write_text(deck(steps), encoding="utf-8")
        one = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
        spent = timed([program, "bars"], folder, env=one)
        text = (Path(folder) / "bars.dat").read_text(encoding="utf-8")
        return spent, last_total(text, "kinetic"), last_total(text, "internal")


def main() -> None:
    bin_folder = Path(sys.argv[1]).resolve()
    steps = int(sys.argv[2]) if len(sys.argv) > 2 else 100
    print(f"{steps} steps of {STEP} s, processor time; energy at the end, of 3.125 J at the begin")
    for name, law in LAWS.items():
        spent, measures = abut(bin_folder, law, steps)
        kinetic, stored = (sum(measures[f"body.{body}.energy.{what}"] for body in ("left", "right"))
                           for what in ("kinetic", "stored"))
        print(f"abut, {name:<15} {spent:8.1f} s   kinetic {kinetic:.6g} J, stored {stored:.6g} J",
              flush=True)
    program = shutil.which("ccx")
    if program is None:
        print("CalculiX: not installed (Debian: calculix-ccx)")
        return
    spent, kinetic, stored = calculix(program, steps)
    print(f"CalculiX              {spent:8.1f} s   kinetic {kinetic:.6g} J, stored {stored:.6g} J")


if __name__ == "__main__":
    main()
