"""How ports give way to forces, found by trying: the difference of two ways from one state, with
and without the force. Of a linear body that is its kernel, whatever else acts on it."""

import numpy as np


def answer_probe(served, ask, reply):
    width = served.width(ask.port)
    patterns = np.asarray(ask.patterns).reshape(-1, width)
    seen = list(ask.seen) or [ask.port]
    reply.step, reply.support = ask.step, served.support()
    reply.patterns, reply.width = len(patterns), sum(served.width(p) for p in seen)
    told = None
    if seen == [ask.port]:
        name, surface = served.ports[ask.port]
        told = served.body.kernel(name, patterns.reshape(-1, *surface.points.shape), ask.step,
                                  ask.count)
    if told is None:
        told = found_by_trying(served, ask, patterns, seen)
    told = np.ravel(told)
    reply.displacement.extend(told.tolist())
    if served.body.quasi_static:  # it follows the force of the instant, and remembers none
        reply.begin.extend([0.0] * len(told))


def found_by_trying(served, ask, patterns, seen):
    """[m] (count, patterns, values of the ports that are seen)."""
    present = served.snapshot()
    begin = present if served.body.quasi_static else served.initial
    count = 1 if served.body.quasi_static else ask.count

    def ways(force):
        served.return_to(begin)
        if not served.body.quasi_static:
            served.body.rest()
        all_forces = [np.zeros(served.width(p)) for p in range(len(served.ports))]
        told = []
        for k in range(count):
            all_forces[ask.port] = force if k == 0 else np.zeros_like(force)
            served.step(ask.step, all_forces)
            told.append(np.concatenate([served.displacement()[p] for p in seen]))
        return np.array(told)

    try:
        free = ways(np.zeros(patterns.shape[1]))
        moved = [ways(pattern) - free for pattern in patterns]
    finally:
        served.return_to(present)
    out = np.zeros((ask.count, len(patterns), free.shape[1]))
    out[:count] = np.stack(moved, axis=1)
    return out
