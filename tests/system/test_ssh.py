"""Goal: bodies that ssh starts compute what bodies of one process do; whatever dies is found, and
nothing stays behind at either end.

The other machine is this one, behind an sshd of its own with keys and settings that are made for
the test. Oracles: the state hash of the same run in one process; exit codes and words; what is left
in /tmp and among the processes.
usage: test_ssh.py ABUT ROOT      exit code 77 (skipped) without sshd
"""

import os
import shutil
import signal
import stat
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

from support import ABUT, ROOT, SOLVER, SystemTest, free_port, is_solver, main, marked

SCENE = ROOT / "configs" / "two_bars.yaml"
LONG = ["--set", "time.end=1.2e-1", "--set", "meta.expect=[]"]  # free flight, in small steps
SSHD = shutil.which("sshd", path=os.environ.get("PATH", "") + ":/usr/sbin")


def sockets() -> set:
    """Those of runs; links of the same form are those of tests whose ssh is a script."""
    return {path.name for path in Path("/tmp").glob("abut-" + "[0-9a-f]" * 32)
            if not path.is_symlink()}


class Server:
    """sshd on a port of its own, for this user, with keys that are thrown away."""

    def __init__(self, folder: Path):
        self.folder = folder
        for name in ("host", "me"):
            subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", folder / name],
                           check=True)
        self.port = free_port()
        settings = folder / "sshd_config"
        settings.write_text(
            f"Port {self.port}\nListenAddress 127.0.0.1\nHostKey {folder}/host\n"
            f"AuthorizedKeysFile {folder}/me.pub\nPidFile none\nStrictModes no\nUsePAM no\n"
            "PasswordAuthentication no\nKbdInteractiveAuthentication no\nPermitRootLogin yes\n"
            "AcceptEnv ABUT_SYSTEM_TEST\n", encoding="utf-8")
        self.process = subprocess.Popen([SSHD, "-D", "-f", settings, "-E", folder / "log"])
        host = (folder / "host.pub").read_text(encoding="utf-8").split()[:2]
        (folder / "known").write_text(f"[127.0.0.1]:{self.port} {' '.join(host)}\n",
                                      encoding="utf-8")
        (folder / "config").write_text(
            f"Host node7\n  HostName 127.0.0.1\n  Port {self.port}\n  IdentityFile {folder}/me\n"
            f"  IdentitiesOnly yes\n  UserKnownHostsFile {folder}/known\n"
            "  SendEnv ABUT_SYSTEM_TEST\n"
            f"Host stranger\n  HostName 127.0.0.1\n  Port {self.port}\n"
            f"  UserKnownHostsFile {folder}/none\n"
            f"Host closed\n  HostName 127.0.0.1\n  Port {free_port()}\n", encoding="utf-8")
        self.ssh = folder / "ssh"
        self.ssh.write_text(f'#!/bin/sh\nexec ssh -F {folder}/config "$@"\n', encoding="utf-8")
        self.ssh.chmod(0o700)

    def answers(self) -> bool:
        until = time.monotonic() + 5.0
        while time.monotonic() < until and self.process.poll() is None:
            if subprocess.run([self.ssh, "-o", "BatchMode=yes", "node7", "true"],
                              capture_output=True, check=False).returncode == 0:
                return True
            time.sleep(0.1)
        return False

    def close(self):
        self.process.terminate()
        self.process.wait()


class SshTest(SystemTest):
    server: Server

    def setUp(self):
        super().setUp()
        self.environment["ABUT_SSH"] = str(self.server.ssh)
        self.allow(f"node7:{SOLVER}")
        self.before = sockets()

    def run_over_ssh(self, *arguments: object, bodies: str = "left", more: str = ""):
        launch = f"{{ssh: {{host: node7, program: {SOLVER}{more}}}}}"
        return self.start(ABUT, "run", SCENE, "--out", self.out, "--set",
                          f"bodies.{bodies}.launch={launch}", *arguments)

    def refused(self, keys: str, code: int, *words: str):
        result = self.abut("run", SCENE, "--out", self.out, "--set",
                           f"bodies.left.launch={{ssh: {{{keys}}}}}")
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)

    def local(self, *arguments: object) -> dict:
        folder = self.folder / "here"
        self.succeed(self.abut("run", SCENE, "--local", "--out", folder, *arguments))
        return self.summary(folder)

    def wait_for_windows(self):
        until = time.monotonic() + 30.0
        history = self.out / "history.csv"
        while not (history.exists() and history.stat().st_size > 0):
            self.assertLess(time.monotonic(), until, "no window")
            time.sleep(0.01)

    def assert_nothing_left(self, seconds: float):
        until = time.monotonic() + seconds
        while (marked(self.mark) or sockets() - self.before) and time.monotonic() < until:
            time.sleep(0.05)
        self.assertEqual(marked(self.mark), [], "processes")
        self.assertEqual(sockets() - self.before, set(), "sockets")


class Runs(SshTest):
    def test_one_body_two_and_two_in_one_process(self):
        here = self.local()
        for bodies, more, solvers in (("left", "", 1), ("*", "", 2), ("*", ", group: both", 1)):
            with self.subTest(bodies=bodies, more=more):
                self.succeed(self.end(self.run_over_ssh("--force", bodies=bodies, more=more)))
                for key in ("state_hash", "measures", "exchanges"):
                    self.assertEqual(self.summary()[key], here[key], key)
                self.assert_nothing_left(3.0)

    def test_many_bodies_of_one_host(self):
        scene = self.folder / "bars.yaml"
        text = SCENE.read_text(encoding="utf-8")
        more = "".join(f"  far_{k}: {{like: left, initial: {{position: {-1.0 - k}}}}}\n"
                       for k in range(18))
        scene.write_text(text.replace("interfaces:", more + "interfaces:"), encoding="utf-8")
        launch = f"bodies.*.launch={{ssh: {{host: node7, program: {SOLVER}}}}}"
        plain = ["--set", "meta={title: many}"]
        self.succeed(self.abut("run", scene, "--out", self.out, "--set", launch, *plain))
        self.succeed(self.abut("run", scene, "--local", "--out", self.folder / "here", *plain))
        self.assertEqual(self.summary()["state_hash"],
                         self.summary(self.folder / "here")["state_hash"])
        self.assert_nothing_left(5.0)

    def test_only_this_user_reaches_the_socket_there(self):
        run = self.run_over_ssh(*LONG)
        self.wait_for_windows()
        (name,) = sockets() - self.before
        about = (Path("/tmp") / name).stat()
        self.assertTrue(stat.S_ISSOCK(about.st_mode))
        self.assertEqual(stat.S_IMODE(about.st_mode), 0o600)
        self.assertEqual(about.st_uid, os.geteuid())
        run.terminate()
        self.end(run)
        self.assert_nothing_left(5.0)

    def test_a_resumed_run_goes_on_over_ssh(self):
        here = self.local(*LONG)
        run = self.run_over_ssh(*LONG)
        self.wait_for_windows()
        run.terminate()
        self.assertEqual(self.end(run).returncode, 128 + signal.SIGTERM)
        self.succeed(self.abut("resume", self.out))
        self.assertEqual(self.summary()["state_hash"], here["state_hash"])

    def test_lost_bodies_start_again_over_ssh(self):
        more = [*LONG, "--set", "output.checkpoint={windows: 500}", "--set",
                "network.on_lost_body=restart"]
        here = self.local(*LONG)
        run = self.run_over_ssh(*more)
        self.wait_for_windows()
        until = time.monotonic() + 30.0
        while not list(self.out.glob("checkpoint*")) and time.monotonic() < until:
            time.sleep(0.01)
        os.kill(next(pid for pid in marked(self.mark) if is_far(pid)), signal.SIGKILL)
        ended = self.succeed(self.end(run))
        self.assertIn("was killed by signal 9 (Killed) at node7", ended.stderr)
        self.assertEqual(self.summary()["state_hash"], here["state_hash"])


def is_far(pid: int) -> bool:
    """A solver that ssh has started, not the shell beside it."""
    words = Path(f"/proc/{pid}/cmdline").read_bytes().split(b"\0")
    return is_solver(pid) and words[0] == str(SOLVER).encode() and any(
        word.startswith(b"ipc:///tmp/abut-") and len(word) == len("ipc:///tmp/abut-") + 32
        for word in words)


class Endings(SshTest):
    def lost(self, victim) -> subprocess.CompletedProcess:
        run = self.run_over_ssh(*LONG)
        self.wait_for_windows()
        os.kill(next(pid for pid in marked(self.mark) if victim(pid)), signal.SIGKILL)
        return self.end(run, 20.0)

    def test_a_solver_that_dies_there_is_named(self):
        ended = self.lost(is_far)
        self.assertEqual(ended.returncode, 3)
        self.assertIn("body 'left' was killed by signal 9 (Killed) at node7", ended.stderr)
        self.assert_nothing_left(3.0)

    def test_an_ssh_that_dies_is_a_lost_body(self):
        ended = self.lost(lambda pid: b"BatchMode=yes" in
                          Path(f"/proc/{pid}/cmdline").read_bytes())
        self.assertEqual(ended.returncode, 3)
        self.assertIn("body 'left' lost its ssh to node7", ended.stderr)
        self.assert_nothing_left(12.0)  # the heartbeat's limit is 10 s

    def test_a_way_that_goes_silent_is_a_lost_body_within_the_heartbeats_limit(self):
        run = self.run_over_ssh("--set", "time.end=2.0", "--set", "meta.expect=[]")
        self.wait_for_windows()
        (ssh,) = [pid for pid in marked(self.mark)
                  if Path(f"/proc/{pid}/comm").read_text(encoding="utf-8") == "ssh\n"]
        os.kill(ssh, signal.SIGSTOP)
        ended = self.end(run, 20.0)  # 10 s of the heartbeat, 1 s of grace, looks on the way
        self.assertEqual(ended.returncode, 3)
        self.assertIn("body 'left' closed its connection and did not come back", ended.stderr)
        self.assert_nothing_left(5.0)

    def test_a_killed_coordinator_leaves_no_orphan(self):
        run = self.run_over_ssh(*LONG)
        self.wait_for_windows()
        run.kill()
        self.end(run)
        self.leaves_sockets = True
        self.assert_nothing_left(12.0)


class Refusals(SshTest):
    def test_what_is_not_listed_is_not_started(self):
        self.refused("host: other", 2, "bodies.left.launch.ssh: would start other:abut-solver over "
                     "ssh, which is not on your list of programs", "add the line "
                     f"other:abut-solver to {self.programs}.")
        self.refused(f"host: node7, user: root, program: {SOLVER}", 2, f"root@node7:{SOLVER}")
        self.refused("host: -oProxyCommand=id", 2, "launch.ssh.host: can be no machine's name")
        self.assertFalse(self.out.exists())

    def test_what_ssh_cannot_do_is_said(self):
        for line in ("nowhere.invalid:abut-solver", "stranger:abut-solver", "closed:abut-solver",
                     "node7:/nowhere/abut-solver", "node7:/bin/true",
                     "nobody-here@node7:abut-solver"):
            self.allow(line)
        self.refused("host: nowhere.invalid", 3, "lost its ssh to nowhere.invalid (code 255)",
                     "`ssh -o BatchMode=yes nowhere.invalid true` must work")
        self.refused("host: stranger", 3, "lost its ssh to stranger",
                     "Host key verification failed")
        self.refused("host: closed", 3, "lost its ssh to closed", "Connection refused")
        self.refused("host: node7, user: nobody-here", 3, "lost its ssh to nobody-here@node7",
                     "Permission denied")
        self.refused("host: node7, program: /nowhere/abut-solver", 3,
                     "exited with code 127 at node7",
                     "`ssh node7 /nowhere/abut-solver --version` must work")
        self.refused("host: node7, program: /bin/true", 3, "exited with code 0 at node7 before")
        self.assert_nothing_left(3.0)


def skip(why: str):
    print(f"skipped: {why}")
    sys.exit(77)


if __name__ == "__main__":
    if SSHD is None or shutil.which("ssh") is None:
        skip("there is no sshd (Debian: openssh-server, openssh-client)")
    if os.geteuid() == 0 and not Path("/run/sshd").is_dir():
        try:
            Path("/run/sshd").mkdir(mode=0o755)  # where sshd of root looks for it
        except OSError:
            skip("sshd has no /run/sshd")
    with tempfile.TemporaryDirectory() as place:
        SshTest.server = Server(Path(place))
        try:
            if not SshTest.server.answers():
                skip("sshd lets nobody in here")
            program = unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2, exit=False)
        finally:
            SshTest.server.close()
    sys.exit(0 if program.result.wasSuccessful() else 1)
