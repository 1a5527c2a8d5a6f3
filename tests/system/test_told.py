"""Goal: people are told before a run what it will be, while it goes on how it goes, and after it
what it was. Oracles: the scene's own numbers, the run's own summary, the folder.

usage: test_told.py ABUT ROOT
"""

import os
import pty
import re
import select
import signal
import subprocess
import sys
import time

sys.dont_write_bytecode = True
from support import ABUT, ROOT, SystemTest, main, strict_json  # noqa: E402

TWO_BARS = ROOT / "configs" / "two_bars.yaml"
CLAMPED = ROOT / "configs" / "solids" / "cube_uniaxial.yaml"
TIED = ROOT / "configs" / "joined" / "row_of_eight.yaml"
LONG = ["--set", "bodies.*.integrator.*.step=2.0e-11"]  # a minute or so


def row(text: str, first: str) -> list:
    """Cells of the line that begins with a word."""
    return next(line.split() for line in text.splitlines() if line.split()[:1] == [first])


class Before(SystemTest):
    def check(self, *arguments: object):
        return self.succeed(self.abut("check", *arguments))

    def test_the_table_has_extent_mass_wave_speed_and_stable_step_over_step(self):
        said = self.check(TWO_BARS, "--probe", "0").stdout
        # 0.25 m of 1 mm^2 at 1000 kg/m^3 and 1 GPa: 1000 m/s, 200 elements: 1.25 us.
        self.assertEqual(row(said, "left"),
                         ["left", "0.25", "0.00025", "1000", "1e-07", "1.25e-06", "12.5"])

    def test_it_has_the_words_of_the_scenes_units(self):
        scene = self.folder / "scene.yaml"
        scene.write_text("""
units: mm t s
time: {end: 1.0e-4, window: 1.0e-6}
bodies:
  bar:
    model: {fe: {dimension: 1, mesh: {bar: {length: 250.0, elements: 100, area: 1.0}}}}
    material: steel
    integrator: {central_difference: {step: 2.5e-7}}
    ports: {tip: right}
""", encoding="utf-8")
        said = self.check(scene, "--probe", "0").stdout
        for word in ("extent [mm]", "mass [t]", "fastest wave [mm/s]"):
            self.assertIn(word, said)
        self.assertNotIn("warning:", said)

    def test_numbers_that_cannot_be_meant_are_told_with_key_and_remedy(self):
        for change, where, words in (
                ("bodies.left.integrator.central_difference.step=1.0e-10",
                 "bodies.left.integrator.central_difference.step: 1e-10 s is 1.25e+04 times below",
                 "Look at the units of the step"),
                ("bodies.left.material={linear_elastic: {youngs_modulus: 2.1e+5, density: 7850.0}}",
                 "bodies.left.material.linear_elastic: density 7850 and Young's modulus 2.1e+05 "
                 "have the digits of steel", "It has 7850 kg/m^3 and 210 GPa"),
                ("bodies.left.model.fe.mesh.bar.length=2.5e+5",
                 "bodies.right.model.fe.mesh: makes a body of 0.25 m", "units of both meshes")):
            with self.subTest(change):
                said = self.abut("check", TWO_BARS, "--probe", "0", "--set", change,
                                 "--set", "bodies.left.initial.velocity=1.0e-3",
                                 "--set", "bodies.right.initial.velocity=-1.0e-3",
                                 "--set", "meta.closed_form=null", "--set", "meta.expect=[]",
                                 "--set", "bodies.left.initial.position=-3.0e+5"
                                 if "length" in change else "meta.title=any")
                warnings = [line for line in said.stdout.splitlines()
                            if line.startswith("warning: ")]
                self.assertTrue(any(where in line and words in line for line in warnings),
                                said.stdout + said.stderr)
                self.assertEqual(said.returncode, 0, "a warning is no refusal")

    def test_the_probe_tells_time_memory_and_what_is_dear_and_leaves_nothing(self):
        said = self.check(TWO_BARS, "--probe", "0.5", *LONG).stdout
        self.assertRegex(said, r"(?m)^  time       about \d.*; the probe saw \S+ % of it in ")
        self.assertRegex(said, r"(?m)^  memory     about \d+ MiB in 3 processes$")
        shares = re.search(r"(?m)^  dear       (.*)$", said)[1]
        percents = [int(number) for number in re.findall(r"(\d+) %", shares)]
        self.assertEqual(len(percents), 3, shares)  # two bodies and the coupling
        self.assertAlmostEqual(sum(percents), 100, delta=2)  # each is rounded
        self.assertEqual([path.name for path in self.folder.iterdir()], ["t"])

    def test_a_run_that_ends_within_the_probe_is_known(self):
        said = self.check(TWO_BARS, "--probe", "20").stdout
        self.assertIn("the probe was all of the run", said)

    def test_without_a_probe_nothing_is_predicted(self):
        said = self.check(TWO_BARS, "--probe", "0").stdout
        self.assertNotRegex(said, r"(?m)^  (time|memory|dear) ")

    def test_bodies_that_somebody_else_starts_are_not_probed(self):
        said = self.check(ROOT / "configs" / "two_bars_processes.yaml").stdout
        self.assertIn("  time       not predicted: body 'left' is started by somebody else", said)

    def test_a_run_that_fails_in_the_probe_says_so(self):
        said = self.check(TWO_BARS, "--probe", "10", "--set", "schwarz.max_iterations=1",
                          "--set", "schwarz.tolerance=1.0e-15", "--set",
                          "schwarz.on_nonconvergence=stop").stdout
        self.assertRegex(said, r"(?m)^  time       the run fails at \S+ s: Schwarz iteration not")

    def test_wrong_times_of_the_probe_are_refused(self):
        for seconds in ("-1", "61", "soon", ""):
            with self.subTest(seconds):
                said = self.abut("check", TWO_BARS, f"--probe={seconds}")
                self.assertEqual((said.returncode, said.stdout), (2, ""))
                self.assertIn("--probe", said.stderr)


class During(SystemTest):
    def test_a_terminal_shows_one_line_that_says_what_is_left(self):
        ours, theirs = pty.openpty()
        self.addCleanup(os.close, ours)
        run = subprocess.Popen([ABUT, "run", TWO_BARS, *LONG, "--out", self.out], cwd=self.folder,
                               env=self.environment, stdout=subprocess.DEVNULL, stderr=theirs)
        os.close(theirs)
        text, until = "", time.monotonic() + 20.0
        while " left  " not in text and time.monotonic() < until:
            if select.select([ours], [], [], 0.1)[0]:
                text += os.read(ours, 65536).decode()
        run.send_signal(signal.SIGINT)
        run.wait(20.0)
        lines = [line for line in re.split("\r\x1b\\[K", text)[1:] if line]
        self.assertTrue(lines, text)
        self.assertLessEqual(max(map(len, (line.splitlines()[0] for line in lines))), 99)
        self.assertRegex(text, r" \d+\.\d %  time \S+ s  .* left  (free|1 contact)  "
                               r"(left|right) \d+ %, (left|right) \d+ %, coupling \d+ %")


class After(SystemTest):
    def run_of(self, *arguments: object):
        return self.succeed(self.abut("run", *arguments, "--out", self.out))

    def test_contacts_and_energies_stand_in_a_table(self):
        said = self.run_of(TWO_BARS).stdout
        measures = self.summary()["measures"]
        told = row(said, "impact")
        for cell, name in zip(told[1:], ("begin", "end", "closings", "impulse", "force_peak")):
            self.assertAlmostEqual(float(cell), measures[f"contact.impact.{name}"],
                                   delta=5e-5 * abs(measures[f"contact.impact.{name}"]) + 1e-12)
        self.assertIn("energy [J]", said)
        self.assertLessEqual(max(map(len, said.splitlines())), 100, "it fits a terminal")

    def test_reactions_of_what_is_held_stand_in_a_table(self):
        said = self.run_of(CLAMPED, "--local").stdout
        self.assertIn("reaction ", said)

    def test_shares_of_time_are_told_and_agree_with_the_summary(self):
        said = self.run_of(TWO_BARS).stdout
        timing = strict_json((self.out / "summary.json").read_text(encoding="utf-8"))["timing"]
        told = sum(timing["waited_s"].values()) + timing["coupling_s"]
        self.assertAlmostEqual(told, timing["wall_s"], delta=1e-6 * timing["wall_s"])
        self.assertRegex(said, r"(?m)^time   .*coupling \d+ %$")
        self.assertRegex(said, r"(?m)^waited (left|right) \d+ %, (left|right) \d+ % of it$")

    def test_nobody_waits_in_one_process(self):
        self.assertNotIn("\nwaited ", self.run_of(TWO_BARS, "--local").stdout)

    def test_ties_have_a_table_of_their_own(self):
        self.assertIn("largest force [N]", self.run_of(TIED, "--local").stdout)

    def test_losses_that_nobody_asked_for_are_told(self):
        # 3 mm of rubber, in steps in which waves cross it several times: the blow is over in two.
        scene = self.folder / "scene.yaml"
        scene.write_text("""
time: {end: 3.0e-3, window: 3.0e-4}
bodies:
  upper:
    model: {fe: {dimension: 2, mesh: {rectangle: {lengths: [3.0e-3, 3.0e-3],
                                                  elements: [5, 7], element: tri3}}}}
    material: {neo_hookean: {youngs_modulus: 7.0e+7, poissons_ratio: 0.2, density: 1800.0}}
    integrator: {newmark: {step: 1.0e-4}}
    initial: {position: [0.0, 3.2e-3], velocity: [0.0, -1.0]}
    ports: {skin: boundary}
  lower:
    model: {fe: {dimension: 2, mesh: {rectangle: {lengths: [4.0e-3, 3.0e-3],
                                                  elements: [2, 4], element: tri3}}}}
    material: {neo_hookean: {youngs_modulus: 5.0e+7, poissons_ratio: 0.3, density: 1800.0}}
    integrator: {newmark: {step: 3.0e-5}}
    initial: {velocity: [0.0, 1.0]}
    ports: {skin: boundary}
    contact_layer: {massless: {required: true}}  # of two cells, which leave few moments of inertia
interfaces:
  blow: {sides: [upper.skin, lower.skin], contact: {}}
""", encoding="utf-8")
        # Such a window goes passively and loses little, unless the scene wants none that does.
        ran = self.succeed(self.abut("run", scene, "--local", "--out", self.out))
        self.assertNotIn("beside friction", ran.stderr)
        self.assertLess(abs(float(row(ran.stdout, "end")[-2])), 0.5)
        ran = self.succeed(self.abut("run", scene, "--local", "--force", "--out", self.out, "--set",
                                     "schwarz.on_nonconvergence=stop"))
        told = re.search(r"contact took \S+ J, (\S+) % of the most there was in motion, beside "
                         r"friction: .* those of 'upper' are the longest", ran.stderr)
        self.assertIsNotNone(told, ran.stderr)
        # all that is lost, as the table has it, relative to what there was at first: the most
        error = float(row(ran.stdout, "end")[-2])
        self.assertAlmostEqual(float(told[1]), -error, delta=0.02 * abs(error) + 0.5)

    def test_damping_by_steps_of_a_body_is_told(self):
        # a bar that swings free, by a scheme that takes away what it does not resolve
        scene = self.folder / "scene.yaml"
        scene.write_text("""
time: {end: 5.0e-3, window: 1.0e-4}
bodies:
  bar:
    model: {fe: {dimension: 1, mesh: {bar: {length: 0.1, elements: 20, area: 1.0e-4}}}}
    material: {linear_elastic: {youngs_modulus: 1.0e+9, density: 1000.0}}
    integrator: {generalized_alpha: {step: 1.0e-4, spectral_radius: 0.0}}
    initial: {velocity_field: "(x > 0.05) * 2 - 1"}
    ports: {tip: right}
""", encoding="utf-8")
        ran = self.succeed(self.abut("run", scene, "--local", "--out", self.out))
        told = re.search(r"steps of body 'bar' took (\S+) J, \S+ % of the most", ran.stderr)
        self.assertIsNotNone(told, ran.stderr)
        measures = self.summary()["measures"]
        lost = -measures["energy.total.relative_drift_end"] * measures["energy.total.begin"]
        self.assertAlmostEqual(float(told[1]), lost, delta=5.1e-3 * lost)  # three digits

    def test_tools_damp_nothing(self):
        # What drives a tool is not what its steps take.
        scene = self.folder / "scene.yaml"
        scene.write_text("""
time: {end: 5.0e-3, window: 1.0e-4}
bodies:
  block:
    model: {fe: {dimension: 2, mesh: {rectangle: {lengths: [0.2, 0.1], elements: [8, 4],
                                                  element: quad4}}}}
    material: {linear_elastic: {youngs_modulus: 1.0e+7, poissons_ratio: 0.3, density: 1000.0}}
    integrator: {central_difference: {step: 5.0e-5}}
    ports: {face: left}
  ram:
    model: {rigid_tool: {dimension: 2, way: ["5 * t", "0"], mesh: {rectangle: {
      lengths: [0.1, 0.3], elements: [1, 1], element: quad4}}}}
    initial: {position: [-0.101, -0.1]}
    ports: {face: right}
interfaces:
  blow: {sides: [block.face, ram.face], contact: {friction: 0.2}}
""", encoding="utf-8")
        ran = self.succeed(self.abut("run", scene, "--local", "--out", self.out))
        self.assertNotIn("took", ran.stderr)
        self.assertGreater(float(row(ran.stdout, "end")[3]), 100.0)  # [J] of work by the ram

    def test_quiet_runs_say_nothing(self):
        said = self.run_of(TWO_BARS, "--quiet")
        self.assertEqual((said.stdout, said.stderr), ("", ""))


if __name__ == "__main__":
    main()
