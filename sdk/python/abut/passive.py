"""The passive form of a body: its own steps, under forces that are constant over a passive step, so
that work is impulse times way over the step's length, as of the midpoint rule. How points give way
is found by trying. All of its mass is on nodes already: to enter and to leave change nothing."""

import math

import numpy as np

from abut.errors import NotConverged, Unsound
from abut.v1 import subdomain_pb2 as pb

ROUNDING = 1.0e-6    # of a step: less than this is no step of its own
SMALL_PULSE = 1.0e-6  # [m/s] of all of a body that does not answer linearly


def answer_step(served, ask, reply, alive):
    """One passive step, into reply.passive_stepped or reply.failed."""
    impulses = _impulses(served, ask)
    try:
        compliance = _compliance(served, ask, impulses, alive)
        from_here = served.displacement()
        if ask.end > ask.begin:
            _walk(served, ask.end - ask.begin, impulses, alive)
        else:
            from_here = [np.zeros_like(each) for each in from_here]
    except NotConverged as error:
        reply.failed.cause = pb.FAILURE_CAUSE_NO_CONVERGENCE
        reply.failed.time, reply.failed.detail = ask.begin, str(error)
        return
    told = reply.passive_stepped
    told.compliance.extend(compliance.ravel().tolist())
    for begin, end, velocity in zip(from_here, served.displacement(), served.velocity()):
        told.ports.add(displacement=(end - begin).tolist(), velocity=velocity.tolist())
    served.tell_record(told.record, ask.end)


def _impulses(served, ask):
    """[N s] of every port."""
    if len(ask.ports) != len(served.ports):
        raise Unsound(f"passive_step.ports has {len(ask.ports)} entries, not one for each of "
                      f"{len(served.ports)} ports")
    if not (math.isfinite(ask.begin) and math.isfinite(ask.end) and ask.begin <= ask.end):
        raise Unsound(f"passive_step ends before its begin: {ask.begin} to {ask.end}")
    whole = []
    for p, given in enumerate(ask.ports):
        values = np.array(given.impulse, float) if given.impulse else np.zeros(served.width(p))
        if values.size != served.width(p) or not np.all(np.isfinite(values)):
            raise Unsound(f"passive_step.ports[{p}].impulse is not of {served.width(p)} numbers")
        if any(not 0 <= point < served.ports[p][1].count for point in given.pressed):
            raise Unsound(f"passive_step.ports[{p}].pressed are not all on the port")
        whole.append(values)
    return whole


def _walk(served, length: float, impulses, alive):
    """In steps of the body's own, under a force that is constant over all of them."""
    nominal = served.body.substep
    steps = max(1, math.ceil(length / nominal - ROUNDING)) if nominal > 0.0 else 1
    for _ in range(steps):
        served.step(length / steps, [impulse / length for impulse in impulses])
        alive()
    if not all(np.all(np.isfinite(each)) for each in served.displacement()):
        raise NotConverged("a displacement is no number")


def _compliance(served, ask, impulses, alive):
    """[1/kg] (pressed values, pressed values): differences of ways with and without an impulse,
    over the length squared; made symmetric, which it is to rounding where steps are linear."""
    body, length = served.body, ask.end - ask.begin
    rows = [(p, point * surface.dim + i) for p, (_, surface) in enumerate(served.ports)
            for point in ask.ports[p].pressed for i in range(surface.dim)]
    found = np.zeros((len(rows), len(rows)))
    if not rows or length == 0.0 or math.isinf(body.mass):
        return found
    asked = (length, tuple(tuple(port.pressed) for port in ask.ports))
    if body.linear and served.known_compliance[0] == asked:  # whatever its state
        return served.known_compliance[1]
    present = served.snapshot()
    begin = served.initial if body.linear else present
    under = [np.zeros_like(each) for each in impulses] if body.linear else impulses
    pulse = body.mass * (1.0 if body.linear else SMALL_PULSE)

    def way(given):
        served.return_to(begin)
        _walk(served, length, given, alive)
        return np.array([served.displacement()[p][k] for p, k in rows])

    try:
        free = way(under)
        for j, (port, k) in enumerate(rows):
            pushed = [each.copy() for each in under]
            pushed[port][k] += pulse
            found[:, j] = (way(pushed) - free) / (pulse * length)
    finally:
        served.return_to(present)
    found = (found + found.T) / 2.0
    served.known_compliance = asked, found
    return found
