"""Forces on a port over a window, by partner, as impulses over the steps of a body: whatever steps
the partner has, impulses of neighbouring steps add up, and momentum is exact."""

import numpy as np

from abut.v1 import subdomain_pb2 as pb


def impulses(waves, times, width: int):
    """[N s] (steps, width) over the intervals between the times."""
    total = np.zeros((len(times) - 1, width))
    for wave in waves:
        if not wave.time:
            continue
        at = np.diff(_impulse_until(wave, np.asarray(times)), axis=0)
        total[:, _columns(wave, width)] += at
    return total


def values(waves, times, width: int):
    """[N] (steps, width) at the ends of the intervals: what a body without inertia balances."""
    total = np.zeros((len(times) - 1, width))
    for wave in waves:
        if wave.time:
            total[:, _columns(wave, width)] += _value_at(wave, np.asarray(times)[1:])
    return total


def _value_at(wave, times):
    time = np.asarray(wave.time)
    f = np.asarray(wave.f).reshape(len(time), wave.width)
    if wave.support == pb.FORCE_SUPPORT_STEP:
        return f[np.clip(np.searchsorted(time, times, side="left"), 1, len(time) - 1)]
    return np.stack([np.interp(times, time, column) for column in f.T], axis=1)


def _columns(wave, width: int):
    """Places of the wave's values among all of the port: it may be of some points alone."""
    if not wave.points:
        return np.arange(width)
    dim = wave.width // len(wave.points)
    return (np.asarray(wave.points)[:, None] * dim + np.arange(dim)).ravel()


def _impulse_until(wave, times):
    """[N s] (times, values) from the wave's begin."""
    time = np.asarray(wave.time)
    f = np.asarray(wave.f).reshape(len(time), wave.width)
    times = np.clip(times, time[0], time[-1])
    if wave.support == pb.FORCE_SUPPORT_LINEAR:
        return _of_lines(time, f, times)
    if wave.support == pb.FORCE_SUPPORT_STEP:
        return _of_constants(time, f[1:], times)
    middles = (time[1:] + time[:-1]) / 2.0  # NODAL: dual cells
    return _of_constants(np.concatenate([time[:1], middles, time[-1:]]), f, times)


def _of_constants(edges, f, times):
    whole = np.concatenate([np.zeros((1, f.shape[1])),
                            np.cumsum(f * np.diff(edges)[:, None], axis=0)])
    piece = np.clip(np.searchsorted(edges, times, side="right") - 1, 0, len(f) - 1)
    return whole[piece] + f[piece] * (times - edges[piece])[:, None]


def _of_lines(time, f, times):
    lengths = np.diff(time)[:, None]
    whole = np.concatenate([np.zeros((1, f.shape[1])),
                            np.cumsum((f[1:] + f[:-1]) / 2.0 * lengths, axis=0)])
    piece = np.clip(np.searchsorted(time, times, side="right") - 1, 0, len(time) - 2)
    past = (times - time[piece])[:, None]
    slope = (f[piece + 1] - f[piece]) / lengths[piece]
    return whole[piece] + past * (f[piece] + slope * past / 2.0)
