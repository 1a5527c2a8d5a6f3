#!/usr/bin/python3
"""An FMU (FMI 3.0, co-simulation) as a body of abut: points on a line, which move and are pressed.
usage: fmu_body.py --connect ENDPOINT --body NAME      (README.md beside this file)"""

import ctypes
import tempfile
import xml.etree.ElementTree as xml
import zipfile
from ctypes import POINTER, byref, c_bool, c_char_p, c_double, c_size_t, c_uint32, c_void_p
from pathlib import Path

import numpy as np

from abut import Body, Energy, InputError, NotConverged, Point, serve

WARNING = 1  # fmi3Status: 0 is OK, 1 a warning, what is above has failed
LOG = ctypes.CFUNCTYPE(None, c_void_p, ctypes.c_int, c_char_p, c_char_p)


class Fmu:
    """What of FMI 3.0 a body needs, on the library inside the file."""

    def __init__(self, path: str):
        self.where, self.said, self.log = path, [], LOG(self.hear)  # kept: the library calls it
        folder = tempfile.TemporaryDirectory(prefix="abut_fmu_")
        with folder:
            try:
                with zipfile.ZipFile(path) as file:
                    file.extractall(folder.name)
                root = xml.parse(Path(folder.name, "modelDescription.xml")).getroot()
            except (OSError, zipfile.BadZipFile, xml.ParseError) as error:
                raise InputError(f"is no FMU: {error}", path, "Name an .fmu file.") from error
            self.instantiate(root, Path(folder.name))

    def instantiate(self, root, folder: Path):
        """The folder goes away afterwards: what an FMU wants of it, it reads now."""
        path = self.where
        kind = root.find("CoSimulation")
        if not root.get("fmiVersion", "").startswith("3.") or kind is None:
            raise InputError("is not of FMI 3.0 for co-simulation", path, "Export it as such.")
        for ability in ("canGetAndSetFMUState", "canSerializeFMUState",
                        "canHandleVariableCommunicationStepSize"):
            if kind.get(ability, "false") not in ("true", "1"):
                raise InputError(f"does not say {ability}", path,
                                 "Windows come again, and not all are as long: export it so.")
        self.name = root.get("modelName", "FMU")
        self.numbers = {each.get("name"): int(each.get("valueReference"))
                        for each in root.findall("ModelVariables/Float64")}
        library = f"binaries/x86_64-linux/{kind.get('modelIdentifier')}.so"
        try:
            self.call = ctypes.CDLL(str(folder / library))
        except OSError as error:
            raise InputError(f"has no library for this machine: {error}", path,
                             "Export it for x86_64-linux.") from error
        make = self.call.fmi3InstantiateCoSimulation
        make.restype = c_void_p
        make.argtypes = [*[c_char_p] * 3, *[c_bool] * 4, c_void_p, c_size_t, c_void_p, LOG,
                         c_void_p]
        resources = f"{folder / 'resources'}/"
        self.me = c_void_p(make(b"body", root.get("instantiationToken", "").encode(),
                                resources.encode(), False, False, False, False, None, 0, None,
                                self.log, None))
        if not self.me:
            raise InputError("cannot be instantiated" + self.words(), path, "Ask who made it.")

    def hear(self, _environment, _status, _category, message):
        self.said = [*self.said[-4:], (message or b"").decode(errors="replace")]

    def words(self) -> str:
        return ": " + "; ".join(self.said) if self.said else ""

    def do(self, function: str, *arguments):
        status = getattr(self.call, function)(self.me, *arguments)
        if status > WARNING:
            raise NotConverged(f"{self.where}: {function} ends with status {status}{self.words()}")

    def number(self, name: str) -> int:
        if name not in self.numbers:
            raise InputError(f"has no variable {name} of type Float64", self.where,
                             "It has " + ", ".join(sorted(self.numbers)) + ".")
        return self.numbers[name]

    def begin(self, parameters: dict):
        self.do("fmi3EnterInitializationMode", c_bool(False), c_double(0.0), c_double(0.0),
                c_bool(False), c_double(0.0))
        for name, value in parameters.items():
            self.set([self.number(name)], [value])
        self.do("fmi3ExitInitializationMode")

    def set(self, numbers, values):
        n = len(numbers)
        self.do("fmi3SetFloat64", (c_uint32 * n)(*numbers), c_size_t(n),
                (c_double * n)(*values), c_size_t(n))

    def get(self, numbers):
        n, values = len(numbers), (c_double * len(numbers))()
        self.do("fmi3GetFloat64", (c_uint32 * n)(*numbers), c_size_t(n), values, c_size_t(n))
        return np.array(values)

    def step(self, time: float, dt: float):
        event, ends, early, last = c_bool(), c_bool(), c_bool(), c_double()
        self.do("fmi3DoStep", c_double(time), c_double(dt), c_bool(False), byref(event),
                byref(ends), byref(early), byref(last))
        if ends.value or early.value:
            raise NotConverged(f"{self.where}: ends at {last.value} s{self.words()}")

    def state(self) -> np.ndarray:
        kept, size = c_void_p(), c_size_t()
        self.do("fmi3GetFMUState", byref(kept))
        self.do("fmi3SerializedFMUStateSize", kept, byref(size))
        data = np.zeros(size.value, np.uint8)
        self.do("fmi3SerializeFMUState", kept, data.ctypes.data_as(c_void_p), size)
        self.do("fmi3FreeFMUState", byref(kept))
        return data

    def go_to(self, data: np.ndarray):
        kept, own = c_void_p(), np.ascontiguousarray(data)
        self.do("fmi3DeserializeFMUState", own.ctypes.data_as(c_void_p), c_size_t(own.size),
                byref(kept))
        self.do("fmi3SetFMUState", kept)
        self.do("fmi3FreeFMUState", byref(kept))


class FmuBody(Body):
    """Its state is what the FMU writes of its own, and the time."""

    def __init__(self, keys):
        beside = Path(__file__).resolve().parent
        place = (beside / str(keys["fmu"])).resolve()
        if beside not in place.parents:
            raise InputError("is not in the folder of this program", keys.where("fmu"),
                             "An FMU runs as you do: copy fmu_body.py beside those you trust.")
        self.fmu, self.time = Fmu(str(place)), 0.0
        self.model = f"FMU {self.fmu.name}, FMI 3.0"
        self.mass, self.substep = keys.positive("mass"), keys.positive("step")
        self.conserves, self.linear = bool(keys.get("conserves", False)), bool(keys["linear"])
        self.points = keys["points"]
        want = {"position", "normal", "force", "displacement", "velocity"}
        for name, each in self.points.items() if isinstance(self.points, dict) else [("", None)]:
            if not isinstance(each, dict) or set(each) != want:
                raise InputError(f"point {name} must have {', '.join(sorted(want))}",
                                 keys.where("points"), "Give each point by its name, and these.")
        parameters = keys.get("parameters", {})
        if not (isinstance(parameters, dict)
                and all(isinstance(each, (int, float)) for each in parameters.values())):
            raise InputError("must be numbers by name", keys.where("parameters"), "Give numbers.")
        self.pushed, self.moved, self.fast = ([self.fmu.number(each[what])
                                               for each in self.points.values()]
                                              for what in ("force", "displacement", "velocity"))
        self.energies = [self.fmu.number(name) for name in keys.get("energy", [])]
        self.momenta = [self.fmu.number(name) for name in keys.get("momentum", [])]
        self.fmu.begin(parameters)

    def surface(self):
        return {name: Point(each["position"], each["normal"])
                for name, each in self.points.items()}

    def step(self, dt, force):
        self.fmu.set(self.pushed, list(force.values()))
        self.fmu.step(self.time, dt)
        self.time += dt

    def displacement(self):
        return dict(zip(self.points, self.fmu.get(self.moved)))

    def velocity(self):
        return dict(zip(self.points, self.fmu.get(self.fast)))

    def energy(self):
        return Energy(*self.fmu.get(self.energies)) if self.energies else super().energy()

    def momentum(self):
        return np.sum(self.fmu.get(self.momenta)) if self.momenta else super().momentum()

    def save(self):
        return {"fmu": self.fmu.state(), "time": np.array(self.time)}

    def restore(self, saved):
        self.fmu.go_to(saved["fmu"])
        self.time = float(saved["time"])


if __name__ == "__main__":
    serve(FmuBody)
