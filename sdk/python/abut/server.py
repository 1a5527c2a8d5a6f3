"""The protocol of proto/README.md for one body: frames, greeting, numbers, sessions."""

import argparse
import random
import struct
import sys
import time
import traceback

import xxhash
import zmq
from zmq.utils.monitor import recv_monitor_message

from abut.access import read_body_keys, require_closed_endpoint
from abut.answers import Answers, told_fault
from abut.errors import InputError, Unsound
from abut.v1 import subdomain_pb2 as pb

PROTOCOL = 4
HEADER = 16                # bytes before the payload of a frame
BETWEEN_SIGNS = 0.25       # [s] of progress
PATIENCE = 60.0            # [s] for a coordinator to answer


def header(payload: bytes) -> bytes:
    return struct.pack("<4sIQ", b"abt\1", len(payload), xxhash.xxh3_64_intdigest(payload))


def sealed(message) -> bytes:
    payload = message.SerializeToString()
    return header(payload) + payload


class Server:
    def __init__(self, make, endpoint: str, name: str, keys: str | None = None,
                 insecure: bool = False):
        require_closed_endpoint(endpoint, keys, insecure)
        self.endpoint, self.name = endpoint, name
        self.session = random.SystemRandom().getrandbits(63) | 1  # tells this process from others
        self.answers = Answers(make, self.alive)
        self.executed, self.answer = 0, b""
        self.begun = self.signed = 0.0
        self.socket = zmq.Context.instance().socket(zmq.DEALER)
        self.socket.setsockopt(zmq.LINGER, 500)
        self.identify(keys)
        self.keyed = bool(keys)
        self.lost = self.socket.get_monitor_socket(
            zmq.EVENT_DISCONNECTED | zmq.EVENT_HANDSHAKE_FAILED_AUTH |
            zmq.EVENT_HANDSHAKE_FAILED_PROTOCOL)
        try:
            self.socket.connect(endpoint)
        except zmq.ZMQError as error:
            raise InputError(f"cannot connect body '{name}' to '{endpoint}': {error}", "--connect",
                             "Give the coordinator's endpoint, for example tcp://127.0.0.1:5555."
                             ) from error

    def identify(self, keys: str | None):
        """With keys the key says which body this is, else its name does."""
        if not keys:
            self.socket.setsockopt(zmq.ROUTING_ID, self.name.encode())
            return
        own = read_body_keys(keys, self.name)
        self.socket.curve_serverkey = own.coordinator
        self.socket.curve_publickey, self.socket.curve_secretkey = own.public, own.secret

    def run(self):
        """Until Finish. Leaves where there is no coordinator, or none any more."""
        hello = sealed(pb.Reply(session=self.session, hello=pb.Hello(
            protocol=PROTOCOL, build="python", body=self.name, session=self.session)))
        greeted, until = False, time.monotonic() + PATIENCE
        while True:
            if not greeted:
                self.socket.send(hello)
            if not self.socket.poll(1000):
                if self.left() or (not greeted and time.monotonic() > until):
                    other = "other keys" if self.keyed else "keys: --keys DIR"
                    sys.exit(f"body {self.name}: no coordinator (any more) at {self.endpoint}" +
                             ("" if greeted else f", or one that asks for {other}"))
                continue
            ask = self.opened(self.socket.recv())
            if ask is None:
                continue
            greeted = True
            if ask.number == 0 or ask.number < self.executed:
                continue  # Welcome, or answered long ago
            if ask.number > self.executed:  # else: a repeat, which gets the same answer again
                self.execute(ask)
            self.socket.send(self.answer)
            if ask.HasField("finish"):
                return

    def left(self) -> bool:
        """Whether the connection has ended; leaves with the reason where keys do not fit."""
        while self.lost.poll(0):
            event = recv_monitor_message(self.lost)
            if event["event"] == zmq.EVENT_DISCONNECTED:
                return True
            if event["event"] == zmq.EVENT_HANDSHAKE_FAILED_AUTH:
                self.leave(f"the coordinator at {self.endpoint} does not let this key in. Give the "
                           "key of a body that the run waits for, as the coordinator's "
                           "network.keys has it.")
            if event["value"] == zmq.PROTOCOL_ERROR_ZMTP_MECHANISM_MISMATCH:
                self.leave(f"the coordinator at {self.endpoint} " +
                           ("has no keys. Give its run network.keys, or leave --keys out."
                            if self.keyed else "lets nobody in without a key. Give --keys DIR, "
                            "with the body's key and the coordinator's public one."))
        return False

    def leave(self, reason: str):
        print(f"body {self.name}: --keys: {reason}", file=sys.stderr)
        sys.exit(2)

    def opened(self, frame: bytes):
        """The request of a sound frame for this process; None of any other."""
        if frame[:HEADER] != header(frame[HEADER:]):
            return None  # damaged, which counts as lost: the coordinator repeats it
        ask = pb.Request.FromString(frame[HEADER:])
        if ask.HasField("refuse") and ask.session in (0, self.session):
            sys.exit(f"body {self.name} is refused: {ask.refuse.reason}")
        return ask if ask.session == self.session else None

    def execute(self, ask):
        reply = pb.Reply(number=ask.number, session=self.session)
        self.begun = self.signed = time.monotonic()
        try:
            if ask.number > self.executed + 1:
                raise Unsound("this solver has not taken part from the begin")
            self.number = ask.number
            self.answers.answer(ask, reply)
        except Exception as error:  # in words to whoever started the run
            if not isinstance(error, (InputError, Unsound)):
                traceback.print_exc()
            told_fault(error, reply.fault, self.name, self.answers.served is not None)
        self.executed, self.answer = ask.number, sealed(reply)

    def alive(self):
        """A sign of progress, now and then, on the way through a long window."""
        now = time.monotonic()
        if now - self.signed < BETWEEN_SIGNS:
            return
        self.signed = now
        self.socket.send(sealed(pb.Reply(number=self.number, session=self.session,
                                         progress=pb.Progress())))


def serve(make):
    """Runs this program as a body of a scene: `--connect ENDPOINT --body NAME`, as abut starts it.
    make(keys) gives the Body; a class that takes its keys does."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--connect", required=True, help="endpoint of the coordinator")
    parser.add_argument("--body", required=True, help="name of the body in the scene")
    parser.add_argument("--keys", help="folder with coordinator.key and NAME.key_secret")
    parser.add_argument("--insecure", action="store_true", help="connect to another machine "
                        "without keys, on a network that you trust")
    options = parser.parse_args()
    try:
        server = Server(make, options.connect, options.body, options.keys, options.insecure)
    except InputError as error:
        print(f"body {options.body}: {error}", file=sys.stderr)
        sys.exit(2)
    server.run()
