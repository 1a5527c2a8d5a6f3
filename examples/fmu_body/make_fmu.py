#!/usr/bin/python3
"""Compiles mass_on_spring.c and packs it as an FMU.      usage: make_fmu.py [FILE.fmu]"""

import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

NAMES = ("time", "mass", "stiffness", "force", "u", "v", "kinetic", "stored", "momentum")
CAUSALITY = ("independent", "parameter", "parameter", "input") + ("output",) * 5


def description() -> str:
    lines = ['<?xml version="1.0" encoding="UTF-8"?>',
             '<fmiModelDescription fmiVersion="3.0" modelName="mass on a spring" '
             'instantiationToken="{abut-mass-on-spring}">',
             '  <CoSimulation modelIdentifier="mass_on_spring" canGetAndSetFMUState="true" '
             'canSerializeFMUState="true" canHandleVariableCommunicationStepSize="true"/>',
             '  <ModelVariables>']
    for k, (name, causality) in enumerate(zip(NAMES, CAUSALITY)):
        start = {"parameter": ' variability="fixed" start="1.0"', "input": ' start="0.0"'}
        lines.append(f'    <Float64 name="{name}" valueReference="{k}" causality="{causality}"'
                     f'{start.get(causality, "")}/>')
    lines += ['  </ModelVariables>', '  <ModelStructure>']
    lines += [f'    <Output valueReference="{k}"/>' for k, causality in enumerate(CAUSALITY)
              if causality == "output"]
    return "\n".join([*lines, '  </ModelStructure>', '</fmiModelDescription>', ""])


def main():
    target = Path(sys.argv[1] if len(sys.argv) > 1 else "mass_on_spring.fmu")
    source = Path(__file__).resolve().with_name("mass_on_spring.c")
    with tempfile.TemporaryDirectory() as folder:
        library = Path(folder) / "mass_on_spring.so"
        subprocess.run(["cc", "-O2", "-shared", "-fPIC", source, "-o", library, "-lm"], check=True)
        with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as file:
            file.writestr("modelDescription.xml", description())
            file.write(library, "binaries/x86_64-linux/mass_on_spring.so")


if __name__ == "__main__":
    main()
