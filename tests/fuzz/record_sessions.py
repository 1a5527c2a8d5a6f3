#!/usr/bin/env python3
"""Records what coordinator and bodies say to each other: what hostile messages are made from.

Runs the scenes beside this file with a relay between abut and its solvers, and writes the payloads
of each body's frames to corpus/requests and corpus/replies, in the form that hostile_input.hpp
takes apart: for requests the Configured and all requests, for replies the Configured and pairs of
request and reply.

usage: record_sessions.py BIN
"""

import struct
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

import zmq

HERE = Path(__file__).resolve().parent
HEADER = 16       # of a frame
MOST = 24         # exchanges of a body that are kept: each kind has come by then
LONGEST = 60_000  # of a payload, whose length has two bytes


def part(payload: bytes) -> bytes:
    return struct.pack("<H", len(payload)) + payload


class Relay(threading.Thread):
    """Between the coordinator and one body: keeps request and reply by turns."""

    def __init__(self, context: zmq.Context, body: str, coordinator: str):
        super().__init__(daemon=True)
        self.far = context.socket(zmq.DEALER)
        self.far.setsockopt(zmq.ROUTING_ID, body.encode())
        self.far.connect(coordinator)
        self.near = context.socket(zmq.DEALER)
        self.endpoint = f"tcp://127.0.0.1:{self.near.bind_to_random_port('tcp://127.0.0.1')}"
        self.said: list[tuple[bool, bytes]] = []  # whether by the body, and what

    def run(self):
        poller = zmq.Poller()
        for end in (self.near, self.far):
            poller.register(end, zmq.POLLIN)
        while True:
            for end, _ in poller.poll():
                frame = end.recv()
                by_body = end is self.near
                self.said.append((by_body, frame[HEADER:]))
                (self.far if by_body else self.near).send(frame)

    def exchanges(self) -> list[tuple[bytes, bytes]]:
        """Requests and replies, without the greeting; what is repeated comes once."""
        pairs, request = [], b""
        for by_body, payload in self.said:
            if not by_body:
                request = payload
            elif request and (not pairs or pairs[-1][0] != request):
                pairs.append((request, payload))
        return pairs


def record(programs: Path, scene: Path, bodies: list[str], port: int):
    context = zmq.Context()
    coordinator = f"tcp://127.0.0.1:{port}"
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.Popen([programs / "abut", "run", scene, "--out", f"{folder}/out",
                                "--quiet", "--set", f"network.endpoint={coordinator}"])
        relays = {body: Relay(context, body, coordinator) for body in bodies}
        solvers = []
        for body, relay in relays.items():
            relay.start()
            solvers.append(subprocess.Popen([programs / "abut-solver", "--connect", relay.endpoint,
                                             "--body", body]))
        if any(process.wait(60) != 0 for process in (run, *solvers)):
            sys.exit(f"{scene} does not end as it should")
    for body, relay in relays.items():
        pairs = [pair for pair in relay.exchanges() if max(map(len, pair)) < LONGEST]
        # Configure and Welcome cross: the Configured is the first reply with a description.
        start = next(k for k, (request, _) in enumerate(pairs) if scene.name.encode() in request)
        configured, pairs = part(pairs[start][1]), pairs[start + 1:]
        kept = pairs[:MOST] + pairs[-6:]
        (HERE / "corpus" / "requests" / body).write_bytes(
            configured + b"".join(part(request) for request, _ in kept))
        (HERE / "corpus" / "replies" / body).write_bytes(
            configured + b"".join(part(request) + part(reply) for request, reply in kept))
        print(body, len(kept))


def main():
    for kind in ("requests", "replies"):
        (HERE / "corpus" / kind).mkdir(parents=True, exist_ok=True)
    record(Path(sys.argv[1]), HERE / "session_bars.yaml", ["left", "right"], 5651)
    record(Path(sys.argv[1]), HERE / "session_blocks.yaml", ["upper", "lower"], 5652)


if __name__ == "__main__":
    main()
