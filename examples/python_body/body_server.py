"""Speaks the protocol of proto/README.md for one body; any body in Python can use it as it is."""

import argparse
import ast
import random
import struct
import sys
import time

import xxhash
import zmq
import zmq.auth
from abut.v1 import subdomain_pb2 as pb

EMPTY = {"ping": "pong", "finish": "finished"}  # requests with nothing to say, and their answers


def header(payload):
    return struct.pack("<4sIQ", b"abt\1", len(payload), xxhash.xxh3_64_intdigest(payload))


def sealed(message):
    payload = message.SerializeToString()
    return header(payload) + payload


def execute(body, make, ask, reply):
    """Answers one request into the reply; the body, which Configure makes."""
    kind = ask.WhichOneof("body")
    if ask.restore_first:
        body.state = body.saved
    if ask.save_first:
        body.saved = body.state
    if kind == "configure":
        body = make(ask.configure)
        body.describe(reply.configured.description)
    elif kind == "advance":
        body.advance(ask.advance, reply.advanced)
    elif kind == "probe":
        body.probe(ask.probe, reply.kernel)
    elif kind == "hash":
        reply.hash.hash = xxhash.xxh3_64_intdigest(repr(body.state))
    elif kind == "checkpoint":  # numbers in their shortest exact form
        reply.checkpoint.state = repr(body.state).encode()
    elif kind == "resume":
        body.state = ast.literal_eval(ask.resume.state.decode())
        reply.resumed.SetInParent()
    elif kind in EMPTY:
        getattr(reply, EMPTY[kind]).SetInParent()
    else:
        raise ValueError(f"this body answers no {kind}")
    return body


def serve(make):
    parser = argparse.ArgumentParser()
    for name, what in (("--connect", "the coordinator's endpoint"), ("--body", "name of the body")):
        parser.add_argument(name, required=True, help=what)
    parser.add_argument("--keys", help="folder with coordinator.key and NAME.key_secret")
    options = parser.parse_args()
    socket = zmq.Context.instance().socket(zmq.DEALER)
    socket.setsockopt(zmq.LINGER, 500)
    if options.keys:  # then the key says which body this is
        load = zmq.auth.load_certificate
        socket.curve_serverkey, _ = load(f"{options.keys}/coordinator.key")
        socket.curve_publickey, socket.curve_secretkey = load(
            f"{options.keys}/{options.body}.key_secret")
    else:
        socket.setsockopt(zmq.ROUTING_ID, options.body.encode())
    lost = socket.get_monitor_socket(zmq.EVENT_DISCONNECTED)
    socket.connect(options.connect)

    session = random.SystemRandom().getrandbits(63) | 1  # tells this process from an earlier one
    hello = sealed(pb.Reply(session=session, hello=pb.Hello(
        protocol=4, build="python", body=options.body, session=session)))
    body, executed, answer = None, 0, b""
    greeted, until = False, time.monotonic() + 60.0
    while True:
        if not greeted:
            socket.send(hello)
        if not socket.poll(1000):
            if lost.poll(0) or (not greeted and time.monotonic() > until):
                sys.exit(f"body {options.body}: no coordinator (any more) at {options.connect}")
            continue
        frame = socket.recv()
        if frame[:16] != header(frame[16:]):
            continue  # damaged, which counts as lost: the coordinator repeats it
        ask = pb.Request.FromString(frame[16:])
        if ask.HasField("refuse") and ask.session in (0, session):
            sys.exit(f"body {options.body} is refused: {ask.refuse.reason}")
        if ask.session != session:  # for a process that had this name before
            continue
        greeted = True
        if ask.number == 0 or ask.number < executed:
            continue  # Welcome, or answered long ago
        if ask.number > executed:  # else: a repeat, which gets the same answer again
            reply = pb.Reply(number=ask.number, session=session)
            try:
                if ask.number > executed + 1:
                    raise ValueError("this solver has not taken part from the begin")
                body = execute(body, make, ask, reply)
            except Exception as error:  # in words to whoever started the run
                fault = reply.fault
                fault.kind = pb.FAULT_KIND_INPUT if body is None else pb.FAULT_KIND_RUN
                fault.what, fault.where = f"{type(error).__name__}: {error}", options.body
                fault.remedy = "look into the program of this body"
            executed, answer = ask.number, sealed(reply)
        socket.send(answer)
        if ask.HasField("finish"):
            return
