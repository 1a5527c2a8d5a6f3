"""Ranks of MPI that do the same at the same time: rank 0 says what, the others follow."""

import pickle
import time
import traceback

import numpy as np

SPINNING, NAP = 2.0e-3, 2.0e-4  # [s] a rank that waits longer than the first sleeps by the second
FIRST, LENGTH = 4096, 8         # bytes of a message's first part, and of its length before it
END, MAKE = "end", "make"


class Team:
    """make(comm, ...) gives each rank its part of an engine. Rank 0 calls `ask`, which calls the
    same method of all parts with the same arguments and returns what its own part gives; `later`
    goes before the next `ask`, in the same message."""

    def __init__(self, comm, make):
        self.comm, self.make, self.engine = comm, make, None
        self.waiting = []
        self.out_of_step = False  # rank 0 left a method in which others may wait for it

    def start(self, *given):
        self.ask(MAKE, *given)

    def later(self, name: str, *given):
        self.waiting.append((name, given))

    def ask(self, name: str, *given):
        calls, self.waiting = [*self.waiting, (name, given)], []
        if self.comm.size > 1:
            self._tell(pickle.dumps(calls, pickle.HIGHEST_PROTOCOL))
        try:
            return self._called(calls)
        except BaseException:
            self.out_of_step = self.comm.size > 1
            raise

    def end(self):
        """Ends all ranks; those who wait for rank 0 in the midst of a method cannot be told."""
        if self.out_of_step:
            self.comm.Abort(1)
        if self.comm.size > 1:
            self._tell(pickle.dumps([(END, ())]))

    def follow(self):
        """What all ranks but 0 do, until rank 0 ends."""
        try:
            while True:
                calls = pickle.loads(self._heard())
                if calls[-1][0] == END:
                    return
                self._called(calls)
        except BaseException:
            traceback.print_exc()
            self.comm.Abort(1)  # rank 0 may wait for this rank

    def _called(self, calls):
        given_back = None
        for name, given in calls:
            if name == MAKE:
                self.engine = self.make(self.comm, *given)
            else:
                given_back = getattr(self.engine, name)(*given)
        return given_back

    def _tell(self, message: bytes):
        """Short ones with their length in one part, what is longer in a second one."""
        first = np.zeros(FIRST, np.uint8)
        first[:LENGTH] = np.frombuffer(len(message).to_bytes(LENGTH, "little"), np.uint8)
        begin = np.frombuffer(message[:FIRST - LENGTH], np.uint8)
        first[LENGTH:LENGTH + len(begin)] = begin
        self.comm.Ibcast(first).Wait()
        if len(message) > len(begin):
            self.comm.Bcast(np.frombuffer(message[len(begin):], np.uint8))

    def _heard(self) -> bytes:
        """MPI itself waits with a whole core, which others could use."""
        first = np.zeros(FIRST, np.uint8)
        begun, come = time.monotonic(), self.comm.Ibcast(first)
        while not come.Test():
            time.sleep(0.0 if time.monotonic() - begun < SPINNING else NAP)
        size = int.from_bytes(first[:LENGTH].tobytes(), "little")
        message = first[LENGTH:LENGTH + size].tobytes()
        if size > len(message):
            rest = np.empty(size - len(message), np.uint8)
            self.comm.Bcast(rest)
            message += rest.tobytes()
        return message
