"""Requests to one body, and its replies."""

from abut.errors import InputError, Unsound
from abut.keys import Keys
from abut.passive import answer_step
from abut.pictures import Picture
from abut.probing import answer_probe
from abut.served import Served
from abut.soundness import require_sound
from abut.v1 import subdomain_pb2 as pb
from abut.window import Failure, Window

EMPTY = {"ping": "pong", "finish": "finished"}  # requests with nothing to say, and their answers


class Answers:
    """make(keys) gives the body, when Configure comes. alive() is called on the way through long
    windows."""

    def __init__(self, make, alive):
        self.make, self.alive, self.served, self.picture = make, alive, None, None

    def answer(self, ask, reply):
        kind = ask.WhichOneof("body")
        if kind == "configure":
            self.configure(ask.configure, reply.configured.description)
            return
        if self.served is None:
            raise InputError(f"{kind} came before configure", "request", "Send Configure first.")
        if ask.restore_first:
            if self.served.saved is None:
                raise Unsound("restore_first comes before any save_first")
            self.served.return_to(self.served.saved)
        if ask.save_first:
            self.served.saved = self.served.snapshot()
        if kind in EMPTY:
            getattr(reply, EMPTY[kind]).SetInParent()
            return
        to_answer = getattr(self, f"answer_{kind}", None)
        if to_answer is None:
            raise InputError(f"this body answers no {kind}", "request",
                             "It takes forces, and is probed; what else a scene may ask of a body "
                             "is in proto/README.md.")
        to_answer(getattr(ask, kind), reply)

    def configure(self, ask, to):
        keys = Keys(ask.document, ask.text, ask.path, ask.overrides)
        body = self.make(keys)
        keys.require_all_read()
        self.served = Served(body)
        self.picture = Picture(self.served)
        to.model, to.dim = body.model or type(body).__name__, body.dim
        to.mass, to.step, to.stable_step = body.mass, body.substep, body.stable_step
        to.conserves, to.linear, to.quasi_static = body.conserves, body.linear, body.quasi_static
        to.can.force = to.can.kernel = True
        to.can.passive = not body.quasi_static
        for name, surface in self.served.ports:
            port = to.ports.add(name=name)
            port.surface.dim = surface.dim
            port.surface.points.extend(surface.points.ravel().tolist())
            port.surface.normals.extend(surface.normals.ravel().tolist())
            port.surface.spacing, port.surface.transit = surface.spacing, surface.transit
            to.dofs += surface.points.size
            if surface.facets:
                port.surface.offsets.append(0)
            for facet in surface.facets:
                port.surface.facets.extend(facet)
                port.surface.offsets.append(len(port.surface.facets))
        self.picture.describe(to)

    def answer_advance(self, ask, reply):
        require_sound(ask, self.served)
        try:
            Window(self.served, ask, self.alive).advance(reply.advanced)
        except Failure as failure:
            reply.failed.cause, reply.failed.time = failure.cause, failure.time
            reply.failed.detail = failure.detail

    def answer_probe(self, ask, reply):
        answer_probe(self.served, ask, reply.kernel)

    def answer_passive_step(self, ask, reply):
        self.require_passive()
        answer_step(self.served, ask, reply, self.alive)

    def answer_passive_enter(self, _, reply):
        self.require_passive()
        reply.passive_entered.lost = 0.0

    def answer_passive_leave(self, _, reply):
        self.require_passive()
        reply.passive_left.lost = 0.0

    def answer_passive_damp(self, _, reply):
        self.require_passive()
        reply.passive_damped.taken = 0.0  # what of its velocities deforms it is not known

    def require_passive(self):
        if self.served.body.quasi_static:
            raise Unsound("a body without inertia has no passive form")

    def answer_hash(self, _, reply):
        reply.hash.hash = self.served.hash()

    def answer_checkpoint(self, _, reply):
        reply.checkpoint.state = self.served.to_bytes()

    def answer_resume(self, ask, reply):
        self.served.from_bytes(ask.state)
        reply.resumed.SetInParent()

    def answer_grid(self, _, reply):
        self.picture.fill_grid(reply.grid)

    def answer_fields(self, _, reply):
        self.picture.fill_fields(reply.fields)


def told_fault(error: Exception, fault, body: str, configured: bool):
    """An exception in words, to whoever started the run."""
    fault.kind = pb.FAULT_KIND_RUN if configured else pb.FAULT_KIND_INPUT
    fault.what, fault.where = f"{type(error).__name__}: {error}", body
    fault.remedy = "Look into the program of this body"
    if isinstance(error, Unsound):
        fault.kind, fault.what = pb.FAULT_KIND_RUN, f"unsound request: {error}"
        fault.remedy = "This is a fault of the coordinator, not of the scene"
    if isinstance(error, InputError):
        fault.kind = pb.FAULT_KIND_INPUT
        in_scene = f"bodies.{body}." in error.where
        fault.what, fault.remedy = error.what, error.remedy
        fault.where = error.where if in_scene else f"body '{body}', {error.where}"
