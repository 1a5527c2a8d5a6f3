"""A wire between a solver and its coordinator that can be spoiled, for TCP.

It copies bytes in both directions and knows enough of ZMTP 3 (the protocol of ZeroMQ) to tell whole
frames from each other: 64 bytes of greeting, then per frame one byte of flags (1: more parts
follow, 2: the size takes eight bytes, 4: a command such as a heartbeat), the size, the content.
"""

import socket
import threading

GREETING, LONG, COMMAND = 64, 2, 4


class Wire:
    """`spoil(number, head, content)` returns the bytes that travel instead of the solver's frame of
    that number, counted from 1 over all connections; None cuts the connection there."""

    def __init__(self, spoil, port: int):
        self.spoil = spoil
        self.port = port  # of the coordinator
        self.frames = 0
        self.ends = []  # of all connections
        self.silent = False  # nothing passes any more, and nothing is closed
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.endpoint = f"tcp://127.0.0.1:{self.listener.getsockname()[1]}"
        threading.Thread(target=self.accept, daemon=True).start()

    def close(self):
        """As when the machine of the wire is switched off: who connects is refused."""
        self.listener.shutdown(socket.SHUT_RDWR)
        self.listener.close()
        for end in self.ends:
            end.close()

    def accept(self):
        while True:
            try:
                solver, _ = self.listener.accept()
            except OSError:
                return
            try:
                coordinator = socket.create_connection(("127.0.0.1", self.port))
            except OSError:  # it does not listen yet: the solver tries again
                solver.close()
                continue
            self.ends += [solver, coordinator]
            for copy in (self.copy_frames, self.copy_bytes):
                threading.Thread(target=self.carry, args=(copy, solver, coordinator),
                                 daemon=True).start()

    def carry(self, copy, solver: socket.socket, coordinator: socket.socket):
        try:
            copy(solver, coordinator)
        except (OSError, EOFError):
            pass
        for end in (solver, coordinator):
            try:
                end.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass

    def copy_bytes(self, solver: socket.socket, coordinator: socket.socket):
        while data := coordinator.recv(1 << 16):
            if not self.silent:
                solver.sendall(data)

    def copy_frames(self, solver: socket.socket, coordinator: socket.socket):
        with solver.makefile("rb") as stream:
            for _ in range(GREETING):  # one waits for the first bytes of the other
                coordinator.sendall(read(stream, 1))
            while True:
                head = read(stream, 1)
                head += read(stream, 8 if head[0] & LONG else 1)
                content = read(stream, int.from_bytes(head[1:], "big"))
                data = head + content
                if not head[0] & COMMAND:
                    self.frames += 1
                    data = self.spoil(self.frames, head, content)
                if data is None:
                    return
                if not self.silent:
                    coordinator.sendall(data)


def read(stream, count: int) -> bytes:
    data = stream.read(count)
    if len(data) < count:
        raise EOFError
    return data
