"""Whether a request to advance is one that this body takes, and whole: before anything is done."""

import numpy as np

from abut.errors import Unsound
from abut.v1 import subdomain_pb2 as pb

SUPPORTS = (pb.FORCE_SUPPORT_NODAL, pb.FORCE_SUPPORT_STEP, pb.FORCE_SUPPORT_LINEAR)


def require_sound(ask, served):
    begin, end = ask.window.begin, ask.window.end
    if not (np.isfinite(begin) and np.isfinite(end) and begin <= end):
        raise Unsound(f"advance.window ends before its begin: {begin} to {end}")
    if len(ask.boundary) != len(served.ports):
        raise Unsound(f"advance.boundary has {len(ask.boundary)} entries, "
                      f"not one for each of {len(served.ports)} ports")
    for port, boundary in enumerate(ask.boundary):
        where = f"advance.boundary[{port}]"
        _require_forces_alone(boundary, where)
        for k, wave in enumerate(boundary.forces):
            _require_whole(wave, served.ports[port][1], f"{where}.forces[{k}]")


def _require_forces_alone(boundary, where: str):
    """An entry without times is absent."""
    given = {"motion": bool(boundary.motion.time), "impedance": boundary.HasField("impedance"),
             "obstacles": any(each.motion.time for each in boundary.obstacles),
             "impulse": bool(boundary.impulse), "balanced": bool(boundary.balanced.time)}
    for name, there in given.items():
        if there:
            raise Unsound(f"{where}.{name} is there, but this body takes forces alone")


def _require_whole(wave, surface, where: str):
    times = len(wave.time)
    if times == 0:
        return
    points = len(wave.points) or surface.count
    if wave.width != points * surface.dim or len(wave.f) != times * wave.width:
        raise Unsound(f"{where} has {len(wave.f)} values of width {wave.width}, not {times} times "
                      f"{points} points of {surface.dim}")
    if any(not 0 <= point < surface.count for point in wave.points):
        raise Unsound(f"{where}.points are not all on the port")
    if wave.support not in SUPPORTS:
        raise Unsound(f"{where}.support is {wave.support}, which is none")
    if not (np.all(np.isfinite(wave.f)) and np.all(np.diff(wave.time) > 0.0)):
        raise Unsound(f"{where} has a value that is no number, or times that do not ascend")
