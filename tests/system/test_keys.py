"""Goal: with keys, nobody but the bodies themselves gets in, whatever he says and repeats, and no
bit of a run changes; without keys, nothing is open to other machines unless the user says so.

Oracles: the state hash of the same run in one process; the exit codes and words of both ends.
usage: test_keys.py ABUT ROOT
"""

import contextlib
import random
import socket
import struct
import threading
import time

import xxhash
import zmq
import zmq.auth
from support import ABUT, CONNECTED, ROOT, SOLVER, SystemTest, free_port, main

SCENE = ROOT / "configs" / f"{CONNECTED}.yaml"
# Free flight after the impact, in so small steps that there is time to attack.
LONG = ["--set", "time.end=1.2e-1", "--set", "meta.expect=[]"]


def framed(payload: bytes) -> bytes:
    """As proto/README.md has it: whole, so that nothing but the key tells that it is forged."""
    return struct.pack("<4sIQ", b"abt\1", len(payload), xxhash.xxh3_64_intdigest(payload)) + payload


class KeyTest(SystemTest):
    def setUp(self):
        super().setUp()
        self.port = free_port()
        self.keys = self.folder / "keys"
        self.context = zmq.Context()
        self.addCleanup(self.context.destroy, linger=0)

    def endpoint(self, port: int = 0) -> str:
        return f"tcp://127.0.0.1:{port or self.port}"

    def make_keys(self, *bodies: str):
        return self.succeed(self.abut("keygen", self.keys, *bodies))

    def coordinator(self, *arguments: object):
        return self.start(ABUT, "run", SCENE, "--out", self.out,
                          "--set", f"network.endpoint={self.endpoint()}",
                          "--set", f"network.keys={self.keys}", *arguments)

    def solver(self, body: str, *arguments: object, port: int = 0):
        return self.start(SOLVER, "--connect", self.endpoint(port), "--body", body,
                          *(arguments or ("--keys", self.keys)))

    def local(self, *arguments: object) -> dict:
        folder = self.folder / "here"
        self.succeed(self.abut("run", SCENE, "--local", "--out", folder, *arguments))
        return self.summary(folder)

    def wait_for_windows(self):
        history = self.out / "history.csv"
        until = time.monotonic() + 30.0
        while not (history.exists() and history.stat().st_size > 0):
            self.assertLess(time.monotonic(), until, "no window")
            time.sleep(0.01)

    def assert_same(self, here: dict):
        for key in ("state_hash", "measures", "exchanges"):
            self.assertEqual(self.summary()[key], here[key], key)


class Runs(KeyTest):
    def test_solvers_with_keys_reach_the_same_bits(self):
        self.make_keys("left", "right")
        run = self.coordinator()
        self.assertIn(f"abut-solver --connect {self.endpoint()} --body left --keys DIR",
                      run.stderr.readline())
        solvers = [self.solver(body) for body in ("left", "right")]
        self.succeed(self.end(run))
        for solver in solvers:
            self.succeed(self.end(solver))
        self.assert_same(self.local())

    def test_a_spawned_body_beside_one_with_a_key_needs_none(self):
        self.make_keys("right")
        run = self.coordinator("--set", "bodies.left.launch=spawn")
        solver = self.solver("right")
        self.succeed(self.end(run))
        self.succeed(self.end(solver))
        self.assert_same(self.local("--set", "bodies.left.launch=spawn"))

    def test_a_process_of_several_bodies_has_one_key(self):
        self.make_keys("process-0")
        scene = ROOT / "configs" / "two_bars.yaml"
        shared = ["--set", "network.processes=1"]
        run = self.start(ABUT, "run", scene, "--out", self.out, "--await", self.endpoint(),
                         "--keys", self.keys, *shared)
        self.assertIn(f"abut-solver --connect {self.endpoint()} --process process-0 --body left "
                      "--body right --keys DIR", run.stderr.readline())
        solver = self.start(SOLVER, "--connect", self.endpoint(), "--process", "process-0",
                            "--body", "left", "--body", "right", "--keys", self.keys)
        self.succeed(self.end(run))
        self.succeed(self.end(solver))
        folder = self.folder / "here"
        self.succeed(self.abut("run", scene, "--local", "--out", folder))
        self.assert_same(self.summary(folder))

    def test_a_folder_of_keys_counts_from_the_scene(self):
        self.make_keys("left", "right")
        scene = self.folder / "scenes" / "scene.yaml"
        scene.parent.mkdir()
        scene.write_text(SCENE.read_text(encoding="utf-8"), encoding="utf-8")
        run = self.start(ABUT, "run", scene, "--out", self.out, "--set",
                         f"network={{endpoint: '{self.endpoint()}', keys: ../keys}}")
        solvers = [self.solver(body) for body in ("left", "right")]
        self.succeed(self.end(run))
        for solver in solvers:
            self.succeed(self.end(solver))


class Attacks(KeyTest):
    """Every attack comes while both bodies are at work, and again and again."""

    def setUp(self):
        super().setUp()
        self.make_keys("left", "right", "spare")

    def attacked(self, attack, port: int = 0):
        """The run goes on and ends as one that nobody has disturbed."""
        run = self.coordinator(*LONG)
        solvers = [self.solver("left", port=port), self.solver("right")]
        self.wait_for_windows()
        rounds = 0
        while run.poll() is None:
            attack()
            rounds += 1
            time.sleep(0.05)
        self.assertGreater(rounds, 3, "it was attacked while it ran")
        ended = self.succeed(self.end(run))
        for solver in solvers:
            self.succeed(self.end(solver))
        self.assert_same(self.local(*LONG))
        return ended

    def stranger(self, name: str, key: str = "") -> zmq.Socket:
        made = self.context.socket(zmq.DEALER)
        made.setsockopt(zmq.ROUTING_ID, name.encode())
        if key:
            load = zmq.auth.load_certificate
            made.curve_serverkey, _ = load(str(self.keys / "coordinator.key"))
            made.curve_publickey, made.curve_secretkey = load(
                str(self.keys / f"{key}.key_secret"))
        made.connect(self.endpoint())
        return made

    def forge(self, name: str, key: str):
        """As the body, with many numbers and a session of its own making; then reads what comes."""
        stranger = self.stranger(name, key)
        with contextlib.suppress(zmq.Again):  # nobody is at the other end
            for number in range(1, 40):
                session = random.getrandbits(63) | 1
                payload = bytes([1 << 3, number, 2 << 3]) + varint(session)  # of a Reply
                stranger.send(framed(payload), zmq.DONTWAIT)
            stranger.send(bytes(100), zmq.DONTWAIT)
        self.assertFalse(stranger.poll(30), "nothing is sent to a stranger")
        stranger.close(linger=0)

    def test_a_stranger_without_a_key(self):
        self.attacked(lambda: self.forge("left", ""))

    def test_a_stranger_with_a_key_that_is_not_of_this_run(self):
        ended = self.attacked(lambda: self.forge("left", "spare"))
        self.assertIn("was turned away: its key is that of no body", ended.stderr)

    def test_another_body_that_takes_the_name_and_forges_sessions(self):
        self.attacked(lambda: self.forge("left", "right"))

    def test_a_replay_of_all_that_a_body_has_sent(self):
        tape = Tape(self.port)
        self.addCleanup(tape.close)

        def replay():
            # The run may end, and its port close, at any moment.
            with contextlib.suppress(OSError), \
                    socket.create_connection(("127.0.0.1", self.port), timeout=5.0) as again:
                again.settimeout(0.03)
                again.sendall(bytes(tape.sent))
                while again.recv(65536):
                    pass
        self.attacked(replay, port=tape.port)
        self.assertGreater(len(tape.sent), 10_000, "there was something to repeat")
        for word in (b"left", b"abt\1"):
            self.assertNotIn(word, tape.sent, "what passes is encrypted")


def varint(value: int) -> bytes:
    out = bytearray()
    while value > 127:
        out.append(value & 127 | 128)
        value >>= 7
    return bytes([*out, value])


class Tape:
    """Passes the bytes of one connection on, and keeps what the solver has sent."""

    def __init__(self, port: int):
        self.sent = bytearray()
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        self.ends = []
        threading.Thread(target=self.serve, args=(port,), daemon=True).start()

    def serve(self, port: int):
        try:
            while True:
                near, _ = self.listener.accept()
                try:
                    far = socket.create_connection(("127.0.0.1", port))
                except OSError:  # nobody listens yet: the solver tries again
                    near.close()
                    continue
                self.ends += [near, far]
                for one, other, kept in ((near, far, self.sent), (far, near, None)):
                    threading.Thread(target=self.copy, args=(one, other, kept),
                                     daemon=True).start()
        except OSError:
            return

    @staticmethod
    def copy(one: socket.socket, other: socket.socket, kept):
        try:
            while data := one.recv(65536):
                if kept is not None:
                    kept += data
                other.sendall(data)
        except OSError:
            pass
        for end in (one, other):
            end.close()

    def close(self):
        for end in (self.listener, *self.ends):
            end.close()


class Refusals(KeyTest):
    def assert_ends(self, process, code: int, *words: str):
        ended = self.end(process, 30.0)
        self.assertEqual(ended.returncode, code, ended.stdout + ended.stderr)
        for word in words:
            self.assertIn(word, ended.stderr)

    def test_keygen_says_what_it_has_made_and_overwrites_nothing(self):
        said = self.make_keys("left").stdout
        for name in ("coordinator.key_secret", "coordinator.key", "left.key_secret", "left.key"):
            self.assertIn(f"written: {self.keys / name}\n", said)
        again = self.abut("keygen", self.keys, "left")
        self.assertEqual(again.returncode, 2)
        self.assertIn("left.key_secret: is there already", again.stderr)
        self.assertEqual(self.abut("keygen", self.keys, "../left").returncode, 2)

    def test_missing_and_open_keys_are_refused_before_anything_is_written(self):
        self.assert_ends(self.coordinator(), 2, f"abut keygen {self.keys}")
        self.make_keys("left")
        self.assert_ends(self.coordinator(), 2, "right.key: cannot be read")
        secret = self.keys / "coordinator.key_secret"
        secret.chmod(0o644)
        self.assert_ends(self.coordinator(), 2, f"chmod go-rwx {secret}")
        self.assertFalse(self.out.exists())

    def test_a_solver_is_told_what_is_wrong(self):
        self.make_keys("left", "right", "spare")
        run = self.coordinator()
        self.assert_ends(self.solver("spare"), 2, "does not let this key in")
        # libzmq may hang up before it has said why.
        without = self.end(self.solver("left", "--patience", "2"), 30.0)
        self.assertIn(without.returncode, (2, 3))
        self.assertRegex(without.stderr, "lets nobody in without a key|no coordinator has answered")
        (self.keys / "left.key_secret").chmod(0o604)
        self.assert_ends(self.solver("left"), 2, "chmod go-rwx")
        self.assert_ends(self.solver("middle"), 2, "middle.key_secret: cannot be read")
        run.terminate()
        self.end(run)

    def test_processes_that_are_awaited_need_keys_or_the_users_word_as_well(self):
        scene = ROOT / "configs" / "two_bars.yaml"
        everywhere = f"tcp://0.0.0.0:{self.port}"
        run = [ABUT, "run", scene, "--out", self.out, "--await", everywhere, "--patience", "0.5"]
        self.assert_ends(self.start(*run), 2, f"--await: is {everywhere}, where whoever reaches it",
                         "--keys keys")
        self.assert_ends(self.start(*run, "--keys", self.keys), 2, f"abut keygen {self.keys}")
        self.assertFalse(self.out.exists())
        self.assert_ends(self.start(*run, "--insecure"), 3, "warning: --insecure: whoever reaches",
                         "body 'left' did not connect")
        self.assert_ends(self.start(*run, "--local"), 2, "--local")
        for option in (["--keys", self.keys], ["--patience", "5"]):
            self.assert_ends(self.start(ABUT, "run", scene, "--out", self.out, *option), 2,
                             "--await")

    def test_other_machines_need_keys_or_the_users_word(self):
        scene = self.folder / "scene.yaml"
        text = SCENE.read_text(encoding="utf-8")
        scene.write_text(text.replace("connect: {}", "connect: {patience: 1.0}"), encoding="utf-8")
        everywhere = ["--set", f"network.endpoint=tcp://0.0.0.0:{self.port}"]
        refused = self.abut("run", scene, "--out", self.out, *everywhere)
        self.assertEqual(refused.returncode, 2)
        for word in ("network.endpoint: is tcp://0.0.0.0:", "abut keygen keys", "--insecure"):
            self.assertIn(word, refused.stderr)
        self.assertFalse(self.out.exists())
        for quiet in ([], ["--quiet"]):
            run = self.abut("run", scene, "--out", self.out, "--insecure", *everywhere, *quiet)
            self.assertEqual(run.returncode, 3, "nobody has come")
            self.assertIn("warning: --insecure: whoever reaches tcp://0.0.0.0:", run.stderr)
        solver = ["--connect", "tcp://machine.example:5555", "--body", "left", "--patience", "0.5"]
        self.assert_ends(self.start(SOLVER, *solver), 2, "--keys DIR", "--insecure")
        self.assert_ends(self.start(SOLVER, *solver, "--insecure"), 3,
                         "warning: --insecure: whoever is at tcp://machine.example:5555")


if __name__ == "__main__":
    main()
