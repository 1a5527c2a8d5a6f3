"""Goal: a program of somebody else, on the Python package abut, is a body like any other: its
motion is right, its keys are its own, and whatever becomes of it ends in words and leaves nothing
behind.

The oracle of the motion is the closed form: until its wave comes back, a bar is a dashpot to what
it meets. usage: test_python_body.py ABUT ROOT [CLASS...]
"""

import csv
import math
import signal
import subprocess
import sys
import time

import yaml
from support import ABUT, PACKAGE, ROOT, SystemTest, free_port, main

sys.path.insert(0, str(PACKAGE))
from abut.access import is_local  # noqa: E402

FOLDER = ROOT / "examples" / "python_body"
PROGRAM = FOLDER / "mass_on_spring.py"
SCENE = FOLDER / "bar_meets_mass.yaml"
LONG = ["--set", "time.end=10.0", "--set", "meta.expect=[]"]  # minutes; ended long before

MASS, STIFFNESS = 0.2, 8.0e5              # [kg] [N/m]
IMPEDANCE, SPEED = 1000.0 * 1000.0 * 1.0e-4, 1.0  # [kg/s] rho c A; [m/s]
TOUCH, TRANSIT = 1.0e-4, 1.0e-3           # [s] gap over speed; 2 L / c


def dashpot(t: float) -> tuple:
    """u and v of m x'' + Z x' + k x = Z V from rest."""
    decay = IMPEDANCE / (2.0 * MASS)
    omega = math.sqrt(STIFFNESS / MASS - decay**2)
    fade, c, s = math.exp(-decay * t), math.cos(omega * t), math.sin(omega * t)
    rest = IMPEDANCE * SPEED / STIFFNESS
    return (rest * (1.0 - fade * (c + decay / omega * s)),
            rest * fade * (decay**2 / omega + omega) * s)


def exact(time_of_run: float) -> tuple:
    """u and v of the mass: at rest, pushed by the bar, alone on its spring."""
    t = time_of_run - TOUCH
    if t <= 0.0:
        return 0.0, 0.0
    u, v = dashpot(min(t, TRANSIT))
    if t <= TRANSIT:
        return u, v
    omega = math.sqrt(STIFFNESS / MASS)
    c, s = math.cos(omega * (t - TRANSIT)), math.sin(omega * (t - TRANSIT))
    return c * u + s * v / omega, c * v - s * omega * u


class PythonTest(SystemTest):
    def setUp(self):
        super().setUp()
        self.environment["PYTHONPATH"] = str(PACKAGE)
        self.environment["PYTHONDONTWRITEBYTECODE"] = "1"
        self.endpoint = f"tcp://127.0.0.1:{free_port()}"

    def run_scene(self, *arguments: object, scene=SCENE) -> subprocess.Popen:
        return self.start(ABUT, "run", scene, "--out", self.out,
                          "--set", f"network.endpoint={self.endpoint}", *arguments)

    def body(self, program=PROGRAM) -> subprocess.Popen:
        return self.start(sys.executable, program, "--connect", self.endpoint, "--body", "mass")

    def scene_with(self, old: str, new: str):
        text = SCENE.read_text(encoding="utf-8")
        self.assertIn(old, text)
        scene = self.folder / "scene.yaml"
        scene.write_text(text.replace(old, new), encoding="utf-8")
        return scene

    def program(self, overriding: str):
        """A program like that of the example, whose class has these methods in place of its own."""
        path = self.folder / "program.py"
        path.write_text("import sys\n"
                        f"sys.path.insert(0, {str(FOLDER)!r})\n"
                        "from abut import InputError, NotConverged, serve\n"
                        "from mass_on_spring import Mass\n\n\n"
                        f"class Other(Mass):\n{overriding}\n\nserve(Other)\n", encoding="utf-8")
        return path

    def wait_for_windows(self):
        until = time.monotonic() + 20.0
        events = self.out / "history.csv"
        while time.monotonic() < until:
            if events.exists() and events.stat().st_size > 0:
                return
            time.sleep(0.01)
        self.fail("no window has come")

    def assert_error(self, run: subprocess.Popen, code: int, seconds: float, *words: str):
        result = self.end(run, seconds)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)


class Motion(PythonTest):
    def test_the_mass_moves_as_the_closed_form_says(self):
        run, body = self.run_scene(), self.body()
        self.succeed(self.end(run))
        ended = self.end(body)
        self.assertEqual((ended.returncode, ended.stdout, ended.stderr), (0, "", ""))
        self.assert_whole(self.out)
        with (self.out / "history.csv").open(encoding="utf-8", newline="") as file:
            rows = [tuple(float(row[name]) for name in
                          ("time [s]", "mass.face.u [m]", "mass.face.v [m/s]"))
                    for row in csv.DictReader(file)]
        self.assertGreater(len(rows), 400)
        for column, what in ((1, "displacement"), (2, "velocity")):
            pairs = [(row[column], exact(row[0])[column - 1]) for row in rows]
            scale = max(abs(right) for _, right in pairs)
            error = max(abs(got - right) for got, right in pairs) / scale
            # measured 3.5e-4, first order in the length of an element; the goal is 1e-3
            self.assertLess(error, 1.0e-3, what)

    def test_it_comes_with_a_key_and_nothing_else_changes(self):
        body = self.body()
        self.succeed(self.end(self.run_scene()))
        self.end(body)
        open_run, self.out = self.out, self.folder / "keyed"
        keys = self.folder / "keys"
        self.succeed(self.abut("keygen", keys, "mass"))
        run = self.run_scene("--set", f"network.keys={keys}")
        body = self.start(sys.executable, PROGRAM, "--connect", self.endpoint, "--body", "mass",
                          "--keys", keys)
        self.succeed(self.end(run))
        self.succeed(self.end(body))
        self.assertEqual(self.summary()["state_hash"], self.summary(open_run)["state_hash"])

    def test_a_key_that_does_not_fit_is_said_at_once(self):
        keys, other = self.folder / "keys", self.folder / "other"
        self.succeed(self.abut("keygen", keys, "mass"))
        self.succeed(self.abut("keygen", other, "mass"))
        (other / "coordinator.key").write_bytes((keys / "coordinator.key").read_bytes())
        program = [sys.executable, PROGRAM, "--connect", self.endpoint, "--body", "mass"]
        run = self.run_scene("--set", f"network.keys={keys}")
        for more, words in (([], r"lets nobody in without a key\. Give --keys DIR|"
                             r"asks for keys: --keys DIR"),
                            (["--keys", other], "does not let this key in|asks for other keys")):
            refused = self.end(self.start(*program, *more), 20.0)
            self.assertIn(refused.returncode, (1, 2))
            self.assertRegex(refused.stderr, words)
        run.terminate()
        self.end(run)
        run = self.run_scene("--force")
        refused = self.end(self.start(*program, "--keys", keys), 20.0)
        self.assertRegex(refused.stderr, r"has no keys\. Give its run network\.keys|asks for other")
        run.terminate()
        self.end(run)

    def test_other_machines_need_keys_or_the_users_word(self):
        network = ["--connect", "tcp://machine.example:5555", "--body", "mass"]
        refused = self.start(sys.executable, PROGRAM, *network)
        self.assert_error(refused, 2, 20.0, "body mass: --connect: tcp://machine.example:5555 is "
                          "on a network", "--keys DIR", "--insecure on a network that you trust.")
        for far in ("tcp://127.example.org:1", "tcp://127.0.0.1.example.org:1",
                    "tcp://0127.0.0.1:1", "tcp://10.1.2.3:5555"):
            self.assertFalse(is_local(far), far)
        for near in ("tcp://127.3.2.1:5555", "tcp://localhost:5555", "ipc:///nowhere/here"):
            self.assertTrue(is_local(near), near)
        insisting = self.start(sys.executable, PROGRAM, *network, "--insecure")
        self.addCleanup(insisting.communicate)
        self.addCleanup(insisting.kill)
        self.assertIn("warning: --insecure: whoever is at tcp://machine.example:5555 can read",
                      insisting.stderr.readline())

    def test_keys_that_are_missing_open_or_none_are_refused_in_words(self):
        keys = self.folder / "keys"
        program = [sys.executable, PROGRAM, "--connect", self.endpoint, "--keys", keys, "--body"]
        self.assert_error(self.start(*program, "mass"), 2, 20.0, f"body mass: {keys}: cannot be "
                          f"read: No such file or directory. Make keys: abut keygen {keys} BODY")
        self.succeed(self.abut("keygen", keys, "mass"))
        self.assert_error(self.start(*program, "other"), 2, 20.0,
                          f"{keys}/other.key_secret: cannot be read", f"abut keygen {keys} BODY")
        self.assert_error(self.start(*program, "../mass"), 2, 20.0, "can be no body with a key")
        secret, public = keys / "mass.key_secret", keys / "coordinator.key"
        for path, mode, words in ((secret, 0o644, "chmod go-rwx"), (public, 0o666, "chmod go-w"),
                                  (keys, 0o770, "chmod go-w")):
            before = path.stat().st_mode
            path.chmod(mode)
            self.assert_error(self.start(*program, "mass"), 2, 20.0,
                              f"{path}: may be ", f"permissions are {mode:03o}. Close it: "
                              f"{words} {path}.")
            path.chmod(before)
        text = secret.read_text("utf-8")
        secret.write_text(text.replace("secret-key", "sacred-key"), "utf-8")
        self.assert_error(self.start(*program, "mass"), 2, 20.0, f"{secret}: has no secret-key")
        self.succeed(self.abut("keygen", keys, "twin"))
        other = (keys / "twin.key").read_text("utf-8").split("curve")[1]
        secret.write_text(other + text[text.index("    secret-key"):], "utf-8")
        self.assert_error(self.start(*program, "mass"), 2, 20.0,
                          "holds a public key that does not belong to its secret one")

    def test_the_order_of_starting_changes_nothing(self):
        body = self.body()
        time.sleep(0.5)
        self.succeed(self.end(self.run_scene()))
        self.assertEqual(self.end(body).returncode, 0)

    def test_a_run_with_it_goes_on_from_its_checkpoint(self):
        body = self.body()
        self.succeed(self.end(self.run_scene("--set", "output.checkpoint={windows: 100}")))
        self.end(body)
        whole, self.out = self.out, self.folder / "again"
        body = self.body()
        self.end(self.run_scene("--set", "output.checkpoint={windows: 100}",
                                "--set", "time.end=1.0e-3", "--set", "meta.expect=[]"))
        self.end(body)
        # The last window of that run ends on a window of the whole one, which goes on as it did.
        resume = self.start(ABUT, "resume", self.out, "--scene", SCENE,
                            "--set", f"network.endpoint={self.endpoint}")
        body = self.body()
        self.succeed(self.end(resume))
        self.end(body)
        self.assertEqual((self.out / "history.csv").read_bytes(),
                         (whole / "history.csv").read_bytes())
        self.assertEqual(self.summary()["state_hash"], self.summary(whole)["state_hash"])

    def test_a_group_lives_beside_it(self):
        alone = self.body()
        self.succeed(self.end(self.run_scene()))
        self.end(alone)
        hashes = self.summary(self.out)["body_hashes"]
        copy = ("  copy: {like: bar, launch: {group: g}, "
                "initial: {position: [-2.0], velocity: [0.0]}}\n  mass:\n")
        scene = self.scene_with("  mass:\n", copy)
        run, body = self.run_scene("--force", "--set", "bodies.bar.launch.group=g",
                                   scene=scene), self.body()
        self.succeed(self.end(run))
        self.assertEqual(self.end(body).returncode, 0)
        together = self.summary(self.out)["body_hashes"]
        self.assertEqual({name: together[name] for name in hashes}, hashes)

    def test_the_program_can_be_spawned_and_finds_the_package(self):
        del self.environment["PYTHONPATH"]
        program = self.folder / "program"
        program.write_text(f'#!/bin/sh\nexec {sys.executable} {PROGRAM} "$@"\n', encoding="utf-8")
        program.chmod(0o755)
        self.allow(program)
        scene = self.scene_with("connect: {}", f"spawn: {{program: {program}}}")
        text = scene.read_text(encoding="utf-8").splitlines()
        scene.write_text("\n".join(line for line in text if not line.startswith("network")),
                         encoding="utf-8")
        self.succeed(self.abut("run", scene, "--out", self.out))


class Keys(PythonTest):
    def test_check_says_that_the_body_is_not_known_yet(self):
        said = self.succeed(self.abut("check", SCENE)).stdout
        self.assertIn("mass: external, not known before it connects", said)

    def test_the_keys_are_never_read_as_ours_and_are_written_as_they_stand(self):
        keys = ('{mass: 0.2, stiffness: 8.0e+5, position: 0.0, step: 5.0e-6, '
                'words: [a b, "1", {deep: null}], fe: "a, b", text: "tab\\tand \\"quotes\\""}')
        scene = self.scene_with(
            "{mass: 0.2, stiffness: 8.0e+5, position: 0.0, step: 5.0e-6}", keys)
        program = self.program("    def __init__(self, keys):\n"
                               "        super().__init__(keys)\n"
                               "        assert keys['words'] == ['a b', '1', {'deep': None}]\n"
                               "        assert keys['fe'] == 'a, b'\n"
                               "        assert keys['text'] == 'tab\\tand \"quotes\"'\n")
        run, body = self.run_scene(scene=scene), self.body(program)
        self.succeed(self.end(run))
        self.end(body)
        resolved = self.out / "scene.resolved.yaml"
        written = yaml.safe_load(resolved.read_text(encoding="utf-8"))
        self.assertEqual(written["bodies"]["mass"]["model"]["external"], yaml.safe_load(keys))
        self.succeed(self.abut("check", resolved))

    def test_a_key_that_its_program_misses_is_the_users_error(self):
        scene = self.scene_with("stiffness: 8.0e+5, ", "")
        run, body = self.run_scene(scene=scene), self.body()
        self.assert_error(run, 2, 20.0, f"error: {scene}: bodies.mass.model.external.stiffness: "
                          "is missing. Give it a value.")
        self.assertFalse(self.out.exists())
        self.assertEqual(self.end(body).returncode, 1)

    def test_keys_that_are_wrong_are_told_with_file_and_line(self):
        line = 1 + SCENE.read_text("utf-8").split("{external")[0].count("\n")
        for old, new, words in (
                ("mass: 0.2", "mass: heavy", "mass: must be a number, but is 'heavy'"),
                ("mass: 0.2", "mass: -0.2", "mass: must be positive, but is -0.2"),
                ("mass: 0.2", "mass: 5 mm", "mass: must be a number, but is '5 mm'. "
                 "Give one, as 0.5 or 0.5 kg."),
                ("mass: 0.2", "mass: 0.2, colour: red",
                 "colour: is a key that this body does not read")):
            with self.subTest(words):
                scene = self.scene_with(old, new)
                run, body = self.run_scene(scene=scene), self.body()
                self.assert_error(run, 2, 20.0,
                                  f"{scene}:{line}: bodies.mass.model.external.{words}")
                self.end(body)

    def test_numbers_have_units(self):
        """200 g and 0.8 kN/mm are the same numbers as 0.2 and 8e5: the run is the same."""
        hashes = set()
        for mass, stiffness in (("0.2", "8.0e+5"), ("200 g", "0.8 kN/mm"), ("0.2kg", "800 N/mm")):
            scene = self.scene_with("mass: 0.2, stiffness: 8.0e+5",
                                    f"mass: {mass}, stiffness: {stiffness}")
            run, body = self.run_scene("--force", scene=scene), self.body()
            self.succeed(self.end(run))
            self.end(body)
            hashes.add(self.summary()["state_hash"])
        self.assertEqual(len(hashes), 1)

    def test_set_reaches_its_keys(self):
        for change, code, words in (("mass=0.4", 0, ""), ("mass=-1", 2, "must be positive"),
                                    ("deep.mass=1", 2, "is deeper than --set reaches")):
            with self.subTest(change):
                run = self.run_scene("--force", "--set", f"bodies.mass.model.external.{change}",
                                     "--set", "meta.expect=[]")
                body = self.body()
                self.assert_error(run, code, 20.0, words)
                self.end(body)

    def test_what_the_body_tells_is_held_against_the_scene(self):
        cases = {"mass.face]": ("mass.tail]", "is mass.tail, but mass has no port tail. Choose "
                                 "one of its ports: face."),
                 "step: 5.0e-6": ("step: 3.0e-6", "time.window: must hold a whole number of steps "
                                  "of body mass"),
                 "momentum.mass.end": ("momentum.mas.end", "meta.expect[1].measure"),
                 "position: 0.0": ("position: -1.0", "interfaces.impact.sides: overlap by")}
        for old, (new, words) in cases.items():
            with self.subTest(new=new):
                scene = self.scene_with(old, new)
                run, body = self.run_scene(scene=scene), self.body()
                self.assert_error(run, 2, 20.0, str(scene), words)
                self.assertFalse(self.out.exists(), "a run that never begins leaves nothing")
                self.end(body)

    def test_it_cannot_live_in_this_process(self):
        result = self.abut("run", SCENE, "--local", "--out", self.out)
        self.assertEqual(result.returncode, 2)
        self.assertIn("bodies.mass.model: is of another program, which cannot live in this "
                      "process. Run without --local.", result.stderr)
        self.assertFalse(self.out.exists())

    def test_abut_solver_is_no_such_body(self):
        run = self.run_scene()
        solver = self.start(ABUT.with_name("abut-solver"), "--connect", self.endpoint,
                            "--body", "mass")
        self.assert_error(run, 2, 20.0, "bodies.mass.model", "external")
        self.end(solver)


class Faults(PythonTest):
    def test_a_body_that_never_connects_is_named_with_what_to_type(self):
        scene = self.scene_with("connect: {}", "connect: {patience: 0.5}")
        self.assert_error(
            self.run_scene(scene=scene), 3, 10.0,
            f"body 'mass' did not connect to {self.endpoint} within 0.5 s. Start `ITS_PROGRAM "
            f"--connect {self.endpoint} --body mass`.")
        self.assertFalse(self.out.exists())

    def test_an_endpoint_that_cannot_be_had_is_the_users_error(self):
        self.endpoint = "tcp://192.0.2.1:5555"  # reserved for documentation: no machine's own
        self.assert_error(self.run_scene("--insecure"), 2, 10.0,
                          "cannot listen at tcp://192.0.2.1:5555")

    def test_a_body_that_dies_in_the_run_is_named(self):
        run, body = self.run_scene(*LONG), self.body()
        self.wait_for_windows()
        body.send_signal(signal.SIGKILL)
        self.end(body)
        # On a busy machine the request under way may still be the probe before the first impact.
        self.assert_error(run, 3, 20.0, "body 'mass' closed its connection and did not come back "
                          "within 10 s while at ", "tart the run again",
                          f"The run up to there is in {self.out}")

    def test_a_second_body_of_that_name_is_named(self):
        run, first = self.run_scene(*LONG), self.body()
        self.wait_for_windows()
        second = self.body()
        self.assert_error(run, 3, 20.0,
                          "a second solver with the name of body 'mass' has connected")
        for body in (first, second):
            self.assertEqual(self.end(body).returncode, 1)

    def test_an_error_in_its_program_is_told(self):
        program = self.program("    def step(self, dt, force):\n        1 / 0\n")
        run, body = self.run_scene(), self.body(program)
        result = self.end(run, 20.0)
        self.assertEqual(result.returncode, 3, result.stdout + result.stderr)
        self.assertIn("ZeroDivisionError", result.stderr)
        self.assertIn("in step", self.end(body).stderr, "its own terminal has the place")

    def test_a_fault_of_its_input_during_a_run_leaves_a_whole_run(self):
        program = self.program(
            "    def step(self, dt, force):\n"
            "        if self.u > 1.0e-4:\n"
            "            raise InputError('is not for such ways', 'stiffness', 'Give more.')\n"
            "        super().step(dt, force)\n")
        run, body = self.run_scene(), self.body(program)
        self.assert_error(run, 2, 20.0, "stiffness: is not for such ways",
                          f"The run up to there is in {self.out}")
        self.end(body)
        self.assert_whole(self.out)
        self.assertEqual(self.summary()["status"], "failed")
        self.assertIn("is not for such ways", self.summary()["reason"])
        self.assertIn("is not for such ways", self.events()[-1]["text"])

    def test_a_step_that_cannot_be_made_is_the_scenes_to_decide(self):
        program = self.program(
            "    def step(self, dt, force):\n"
            "        if self.u > 1.0e-4:\n"
            "            raise NotConverged('after 20 iterations')\n"
            "        super().step(dt, force)\n")
        run = self.run_scene("--set", "schwarz.on_nonconvergence=stop")
        body = self.body(program)
        self.assert_error(run, 1, 20.0, "after 20 iterations")
        self.end(body)
        self.assertEqual(self.summary()["status"], "failed")

    def test_it_leaves_when_its_coordinator_is_killed(self):
        run, body = self.run_scene(*LONG), self.body()
        self.wait_for_windows()
        run.kill()
        self.end(run)
        ended = self.end(body, 10.0)
        self.assertEqual(ended.returncode, 1)
        self.assertIn("body mass: no coordinator (any more)", ended.stderr)
        self.leaves_sockets = True  # of the spawned bar

    def test_it_is_told_of_an_interrupted_run(self):
        run, body = self.run_scene(*LONG), self.body()
        self.wait_for_windows()
        run.terminate()
        self.assertEqual(self.end(run, 10.0).returncode, 128 + signal.SIGTERM)
        self.assertIn("body mass is refused: the run has ended early", self.end(body, 10.0).stderr)


if __name__ == "__main__":
    main()
