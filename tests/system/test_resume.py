"""Goal: nothing of a long run is lost: whatever ends it, it goes on from its latest checkpoint.

Oracle: the files of the run that nothing has ended, byte for byte, its measures and state hash.
usage: test_resume.py ABUT ROOT [CLASS]
"""

import os
import re
import resource
import shutil
import signal
import time
from pathlib import Path

from pressed_stack import PASSIVELY, pressed_stack
from support import ABUT, ROOT, SystemTest, is_solver, main, marked

# A scene of each kind, windows from one checkpoint to the next, and shares of its time at which it
# is killed: bars, unlike steps, plasticity, friction, many bodies that join and part, statics,
# ties, an overlap, passive windows.
SCENES = [
    ("two_bars", 7, (0.3, 0.6)),
    ("bars/steps_three_to_two", 5, (0.6,)),
    ("bars/plastic_bar_meets_a_wall", 9, (0.5,)),
    ("contact/belt_stick_slip", 101, (0.2, 0.7)),
    ("contact/bars_2d", 11, (0.5,)),
    ("contact/balls", 61, (0.4, 0.8)),
    ("contact/cattaneo_mindlin", 1, (0.4,)),
    ("joined/blocks_2x2x2", 5, (0.5,)),
    ("joined/weld_overlap", 2, (0.5,)),
    ("robust/dominoes", 41, (0.3, 0.7)),
]
BELT = ROOT / "configs" / "contact" / "belt_stick_slip.yaml"
OF_THE_PROGRAM = {"timing", "exchanges"}  # of a summary; all else is the run's


def checkpoints(windows: int) -> list:
    return ["--set", f"output.checkpoint={{windows: {windows}}}"]


def row_time(row: bytes) -> float:
    return float(row.split(b",")[0])


class Resume(SystemTest):
    def setUp(self):
        super().setUp()
        # A third of the shipped scene, which expects nothing.
        text = re.sub(r"\n  expect:\n(    - .*\n)+", "\n", BELT.read_text(encoding="utf-8"))
        text = text.replace("end: 36.775552", "end: 12.0")
        self.scene = self.folder / "belt.yaml"
        self.scene.write_text(text, encoding="utf-8")

    def run_whole(self, scene: Path, *arguments: object) -> Path:
        whole = self.folder / "whole"
        self.end(self.start(ABUT, "run", scene, "--out", whole, "--quiet", *arguments))
        return whole

    def begin(self, scene: Path, *arguments: object):
        return self.start(ABUT, "run", scene, "--out", self.out, "--quiet", *arguments)

    def resume(self, *arguments: object, **options):
        return self.start(ABUT, "resume", self.out, "--quiet", *arguments, **options)

    def come_to(self, run, until: float, kept: bool = True) -> bool:
        """Waits until the history has come to a time of the scene; false: the run has ended.

        `kept`: there is a checkpoint.
        """
        deadline = time.monotonic() + 60.0
        while run.poll() is None:
            self.assertLess(time.monotonic(), deadline)
            try:
                rows = (self.out / "history.csv").read_bytes().rsplit(b"\n", 2)
                if len(rows) == 3 and row_time(rows[1]) >= until:
                    if not kept or (self.out / "checkpoint.abut").is_file():
                        return True
            except (OSError, ValueError):  # not there yet, or the header
                pass
            time.sleep(0.003)
        return False

    def kill(self, run):
        self.leaves_sockets = True
        run.kill()
        self.end(run)
        self.assertEqual(self.marked_after(3.0), [], "solvers end with their coordinator")

    def kill_a_solver(self, run) -> bool:
        """One that is there: while bodies are started again there may be none for a while, and none
        any more when the run has ended, which is then told."""
        deadline = time.monotonic() + 60.0
        while run.poll() is None:
            self.assertLess(time.monotonic(), deadline)
            for pid in filter(is_solver, marked(self.mark)):
                try:
                    os.kill(pid, signal.SIGKILL)
                    return True
                except ProcessLookupError:  # it has ended since
                    pass
            time.sleep(0.003)
        return False

    def assert_same(self, whole: Path, out: Path):
        for path in sorted(whole.rglob("*")):
            if path.suffix in (".csv", ".jsonl", ".vtu", ".pvd"):
                name = path.relative_to(whole)
                self.assertTrue((out / name).read_bytes() == path.read_bytes(), name)
        self.assertEqual({path.name for path in (out / "fields").glob("*")},
                         {path.name for path in (whole / "fields").glob("*")})
        one, other = self.summary(whole), self.summary(out)
        for summary in (one, other):  # kernels of ties are asked for again
            summary["measures"].pop("exchanges")
        for key in one.keys() - OF_THE_PROGRAM:
            self.assertEqual(other[key], one[key], key)

    def assert_same_where_killed(self, times: tuple, whole: Path, scene: Path, *arguments: object):
        for until in times:
            run = self.begin(scene, *arguments)
            if self.come_to(run, until):
                self.kill(run)
                run = self.resume()
            self.succeed(self.end(run))
            self.assert_same(whole, self.out)
            shutil.rmtree(self.out)


class Kills(Resume):
    def test_a_run_that_is_killed_again_and_again_ends_in_the_same_bits(self):
        killed = 0
        for name, every, shares in SCENES:
            scene = ROOT / "configs" / f"{name}.yaml"
            whole = self.run_whole(scene, *checkpoints(every))
            end = row_time((whole / "history.csv").read_bytes().rsplit(b"\n", 2)[1])
            run = self.begin(scene, *checkpoints(every))
            for share in shares:
                if self.come_to(run, share * end):
                    self.kill(run)
                    killed += 1
                    run = self.resume()
            self.assertIn(self.end(run).returncode, (0, 1))  # expectations are another test's
            with self.subTest(scene=name):
                self.assert_same(whole, self.out)
            shutil.rmtree(whole)
            shutil.rmtree(self.out)
        self.assertGreater(killed, len(SCENES) // 2, "runs end before they can be killed")

    def test_statics_are_the_same_between_passive_steps(self):
        self.scene.write_text(pressed_stack(", interference: {over: 0}"), encoding="utf-8")
        whole = self.run_whole(self.scene, *PASSIVELY)
        given_up = self.summary(whole)["accuracy"]["given_up"]
        self.assertGreater(given_up["passive_windows"], 2)
        self.assert_same_where_killed((0.5, 0.625, 0.75), whole, self.scene, *PASSIVELY)

    def test_a_killed_solver_costs_what_came_since_the_checkpoint(self):
        whole = self.run_whole(self.scene, *checkpoints(50))
        run = self.begin(self.scene, *checkpoints(50))
        self.assertTrue(self.come_to(run, 5.0))
        self.assertTrue(self.kill_a_solver(run))
        ended = self.end(run)
        self.assertEqual(ended.returncode, 3)
        self.assertRegex(ended.stderr, rf"abut resume {re.escape(str(self.out))} goes on from \d")
        self.succeed(self.end(self.resume()))
        self.assert_same(whole, self.out)

    def test_where_the_scene_says_so_a_lost_body_is_started_again(self):
        whole = self.run_whole(self.scene, *checkpoints(50))
        killed = 0
        for _ in range(10):  # until a run is killed: on a busy machine one may end unseen
            run = self.begin(self.scene, *checkpoints(50), "--force",
                             "--set", "network.on_lost_body=restart")
            for until in (3.0, 8.0):
                if not self.come_to(run, until) or not self.kill_a_solver(run):
                    break  # a quick machine has come to the end meanwhile
                killed += 1
                time.sleep(0.3)
            ended = self.end(run)
            self.succeed(ended)
            if killed:
                break
        self.assertGreater(killed, 0)
        self.assert_same(whole, self.out)


class Signals(Resume):
    def test_a_run_that_is_asked_to_end_is_kept_without_a_key(self):
        whole = self.run_whole(self.scene)
        for number in (signal.SIGINT, signal.SIGTERM):
            run = self.begin(self.scene)
            self.assertTrue(self.come_to(run, 4.0, kept=False))
            run.send_signal(number)
            self.assertEqual(self.end(run, 10.0).returncode, 128 + number)
            self.assertEqual(self.summary()["status"], "interrupted")
            self.succeed(self.end(self.resume()))
            self.assert_same(whole, self.out)
            shutil.rmtree(self.out)

    def test_it_goes_on_in_one_process_as_well(self):
        whole = self.run_whole(self.scene)
        run = self.begin(self.scene)
        self.assertTrue(self.come_to(run, 4.0, kept=False))
        run.send_signal(signal.SIGINT)
        self.end(run, 10.0)
        self.succeed(self.end(self.resume("--local")))
        self.assert_same(whole, self.out)


class Changes(Resume):
    def setUp(self):
        super().setUp()
        self.succeed(self.end(self.begin(self.scene, *checkpoints(100), "--set", "time.end=5.0")))

    def refused(self, *arguments: object) -> str:
        ended = self.end(self.resume(*arguments))
        self.assertEqual(ended.returncode, 2, ended.stderr)
        return ended.stderr

    def test_a_run_at_its_end_goes_on_to_a_later_one(self):
        self.assertIn("Give a later end: --end TIME", self.refused())
        before = (self.out / "history.csv").read_bytes()
        self.succeed(self.end(self.resume("--end", "6.0")))
        after = (self.out / "history.csv").read_bytes()
        self.assertTrue(after.startswith(before))
        self.assertEqual(row_time(after.rsplit(b"\n", 2)[1]), 6.0)

    def test_a_run_that_was_killed_at_its_very_end_tells_of_it(self):
        before = self.summary()
        (self.out / "summary.json").unlink()
        self.succeed(self.end(self.resume()))
        self.assertEqual(self.summary()["measures"], before["measures"])
        self.assertEqual(self.summary()["state_hash"], before["state_hash"])

    def test_an_edit_of_the_scene_beside_the_results_is_said_to_have_no_effect(self):
        resolved = self.out / "scene.resolved.yaml"
        go_on = (ABUT, "resume", self.out, "--end")
        untouched = self.end(self.start(*go_on, "5.5"))
        self.assertNotIn("is not read", self.succeed(untouched).stderr)
        text = resolved.read_text(encoding="utf-8")
        resolved.write_text(text.replace("time:", "# mine\ntime:"), encoding="utf-8")
        ended = self.succeed(self.end(self.start(*go_on, "6.0")))
        self.assertIn("has changed since the checkpoint was kept, and is not read", ended.stderr)

    def test_what_changes_the_motion_is_refused_with_both_values(self):
        words = self.refused("--end", "6.0", "--set", "bodies.block.material.youngs_modulus=1.0")
        self.assertIn("error", words)
        words = self.refused("--end", "6.0", "--set", "interfaces.sole.contact.friction=0.1")
        self.assertRegex(words, r"friction: was .+ when the checkpoint was written, and is .*0\.1")
        self.assertTrue((self.out / "checkpoint.abut").is_file())

    def test_what_is_written_may_change(self):
        self.succeed(self.end(self.resume("--end", "6.0", "--set", "output.checkpoint={wall: 10}",
                                          "--set", "output.fields=null")))

    def test_steps_may_change_where_the_command_says_so(self):
        half = ["--set", "time.window=0.00625",
                "--set", "bodies.block.integrator.generalized_alpha.step=0.00625"]
        self.succeed(self.end(self.resume("--end", "6.0", *half)))


class Damage(Resume):
    def setUp(self):
        super().setUp()
        self.whole = self.run_whole(self.scene, *checkpoints(100))
        run = self.begin(self.scene, *checkpoints(100))
        self.assertTrue(self.come_to(run, 6.0))
        self.kill(run)
        self.latest = self.out / "checkpoint.abut"

    def test_of_a_damaged_checkpoint_the_one_before_it_is_used(self):
        held = bytearray(self.latest.read_bytes())
        held[len(held) // 2] ^= 1
        self.latest.write_bytes(held)
        ended = self.end(self.start(ABUT, "resume", self.out))
        self.succeed(ended)
        self.assertIn("is damaged", ended.stderr)
        self.assert_same(self.whole, self.out)

    def test_without_a_whole_one_nothing_is_touched(self):
        for path in self.out.glob("checkpoint*"):
            path.write_bytes(path.read_bytes()[:-1])
        before = {path: path.read_bytes() for path in self.out.rglob("*") if path.is_file()}
        ended = self.end(self.resume())
        self.assertEqual(ended.returncode, 2)
        self.assertIn("is damaged", ended.stderr)
        self.assertEqual({path: path.read_bytes() for path in before}, before)

    def test_a_history_that_was_cut_is_refused(self):
        history = self.out / "history.csv"
        history.write_bytes(history.read_bytes()[:100])
        ended = self.end(self.resume())
        self.assertEqual(ended.returncode, 3)
        self.assertIn("has 100 bytes; the checkpoint was written when it had", ended.stderr)

    def test_a_full_disk_leaves_a_usable_checkpoint(self):
        most = 3 * self.latest.stat().st_size + (self.out / "history.csv").stat().st_size

        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
        ended = self.end(self.resume(preexec_fn=limit))
        self.assertEqual(ended.returncode, 3, ended.stderr)
        self.assertIn("File too large", ended.stderr)
        self.succeed(self.end(self.resume()))
        self.assert_same(self.whole, self.out)


class Swaps(Resume):
    SCENE = ROOT / "configs" / "contact" / "rigid_until_contact.yaml"

    def test_a_run_is_resumed_before_and_after_every_swap(self):
        every = ["--set", "output.checkpoint={windows: 3}"]
        whole = self.run_whole(self.SCENE, *every)
        for until in (5.0e-5, 1.5e-4, 2.8e-4, 7.0e-4):
            run = self.begin(self.SCENE, *every)
            if self.come_to(run, until):
                self.kill(run)
                run = self.resume()
            self.succeed(self.end(run))
            self.assert_same(whole, self.out)
            self.assertEqual(self.summary(whole)["swaps"], self.summary(self.out)["swaps"])
            shutil.rmtree(self.out)

    def test_a_model_that_a_stage_repeats_and_a_mesh_file_beside_the_scene(self):
        """The scene that a run keeps lies elsewhere, and says what was left to defaults: neither
        makes another stage of it."""
        shutil.copy(ROOT / "configs" / "meshes" / "plate_with_hole.msh", self.folder / "p.msh")
        same = "model: {fe: {dimension: 2, mesh: {rectangle: {lengths: [2, 2], elements: [4, 2]}}}}"
        scene = self.folder / "scene.yaml"
        scene.write_text(f"""time: {{end: 0.1, window: 1.0e-5}}
bodies:
  plate:
    {same}
    material: {{linear_elastic: {{youngs_modulus: 1.0e7, poissons_ratio: 0.3, density: 1000.0}}}}
    integrator: {{newmark: {{step: 1.0e-5}}}}
    initial: {{velocity: [0.0, 1.0]}}
stages:
  again: {{time: {{end: 0.102}}, bodies: {{plate: {{{same}}}}}}}
  other:
    time: {{end: 0.103}}
    bodies: {{plate: {{model: {{fe: {{mesh: {{gmsh: {{file: p.msh}}}}}}}}}}}}
output: {{checkpoint: {{windows: 500}}}}
""", encoding="utf-8")
        whole = self.run_whole(scene)
        self.assertEqual(len(self.summary(whole)["swaps"]), 1)
        self.assert_same_where_killed((0.05, 0.101), whole, scene)


class Stages(Resume):
    SCENE = ROOT / "configs" / "contact" / "preload_then_impact.yaml"

    def test_a_run_is_resumed_in_any_stage_and_at_its_end(self):
        every = ["--set", "output.checkpoint={windows: 3}", "--set",
                 "stages.impact.output.checkpoint={windows: 20}"]
        whole = self.run_whole(self.SCENE, *every)
        self.assert_same_where_killed((0.2, 0.999, 1.0002), whole, self.SCENE, *every)

    def test_the_end_of_a_stage_is_always_kept(self):
        self.succeed(self.end(self.begin(self.SCENE)))
        self.assertTrue((self.out / "checkpoint.abut").is_file())
        resolved = (self.out / "scene.resolved.yaml").read_text(encoding="utf-8")
        self.assertRegex(resolved, r"(?m)^stages: .*impact")
        again = self.folder / "again"
        self.succeed(self.abut("run", self.out / "scene.resolved.yaml", "--out", again, "--quiet"))
        self.assert_same(self.out, again)

    def test_history_goes_on_over_the_stages(self):
        self.succeed(self.end(self.begin(self.SCENE)))
        times = [row_time(row) for row in
                 (self.out / "history.csv").read_bytes().splitlines()[1:]]
        self.assertEqual(times, sorted(set(times)), "each time once")
        self.assertEqual((times[0], times[-1]), (0.0, 1.0007))

    def test_what_no_stage_can_change_is_refused_where_it_stands(self):
        text = self.SCENE.read_text(encoding="utf-8")
        for wrong, words in (
                ("bodies:\n      held: {material: steel}",
                 "stages.impact.bodies.held.material: cannot be another in a stage"),
                ("bodies:\n      gone: {integrator: {central_difference: {step: 1}}}",
                 "stages.impact.bodies.gone: is no body of the scene"),
                ("interfaces: {}", "stages.impact.interfaces: cannot be another in a stage")):
            scene = self.folder / "wrong.yaml"
            begin = text.index("    bodies:", text.index("stages:"))
            scene.write_text(text[:begin] + "    " + wrong + "\n", encoding="utf-8")
            said = self.abut("check", scene)
            self.assertEqual(said.returncode, 2, said.stdout)
            self.assertIn(words, said.stderr)
            self.assertRegex(said.stderr, r"wrong\.yaml:\d+: stages")
        scene.write_text(text.replace("time: {end: 1.0007, window", "time: {window"),
                         encoding="utf-8")
        self.assertIn("stages.impact: does not say when it ends", self.abut("check", scene).stderr)
        scene.write_text(text.replace("time: {end: 1.0007", "time: {end: 0.5"), encoding="utf-8")
        self.assertIn("stage impact", self.abut("check", scene).stderr)

    def test_a_velocity_that_nothing_takes_is_refused(self):
        text = self.SCENE.read_text(encoding="utf-8")
        scene = self.folder / "moving.yaml"
        scene.write_text(text.rstrip("\n") + "\n  on:\n    time: {end: 1.0009}\n    bodies: "
                         "{striker: {initial: {velocity: [-20.0, 0.0]}}}\n", encoding="utf-8")
        said = self.abut("check", scene)
        self.assertEqual(said.returncode, 2, said.stdout)
        self.assertRegex(said.stderr, r"moving\.yaml:\d+: .*striker\.initial\.velocity.*: "
                                      "has no effect")

    def test_another_end_is_refused_while_stages_follow(self):
        run = self.begin(self.SCENE, "--set", "output.checkpoint={windows: 1}")
        if self.come_to(run, 0.2):
            self.kill(run)
        else:
            self.end(run)
        for given in (("--end", "0.9"), ("--set", "time.end=0.9")):
            ended = self.end(self.resume(*given))
            self.assertEqual(ended.returncode, 2, ended.stderr)
        twice = self.end(self.resume("--end", "0.9", "--set", "time.end=0.8"))
        self.assertEqual(twice.returncode, 2)
        self.assertIn("--end and --set time.end: is given twice", twice.stderr)

    def test_a_stage_without_inertia_does_not_follow_motion(self):
        text = self.SCENE.read_text(encoding="utf-8")
        static, moving = "{quasi_static: {step: 0.1}}", "{central_difference: {step: 2.5e-6}}"
        scene = self.folder / "back.yaml"
        begin = text.index("stages:")
        head = re.sub(r"\n  expect:\n(    - .*\n)+", "\n", text[:begin])
        scene.write_text(head.replace(static, moving).replace("window: 0.1", "window: 2.5e-6")
                         .replace("end: 1.0,", "end: 1.0e-4,").replace("min(t / 0.6, 1)", "0")
                         + "stages: {rest: {time: {end: 1.0, window: 0.1}, bodies: "
                         + "{held: {integrator: " + static + "}}}}\n", encoding="utf-8")
        ended = self.end(self.begin(scene))
        self.assertEqual(ended.returncode, 3, ended.stderr)
        self.assertIn("a stage without inertia cannot go on from there", ended.stderr)


if __name__ == "__main__":
    main()
