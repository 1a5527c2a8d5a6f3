"""Goal: a study says of every run how it ended and why, in what units its numbers are, and how to
repeat it. Oracles: the messages of the runs, exit codes, the command itself, run by a shell.
usage: test_study_ends.py ABUT ROOT
"""

import csv
import html
import json
import subprocess
import sys
from pathlib import Path

sys.dont_write_bytecode = True
from made_studies import SCENE, STUDY, StudyTest, write  # noqa: E402
from support import main  # noqa: E402


class Ends(StudyTest):
    def test_run_that_ends_otherwise_is_told_everywhere_with_its_reason(self):
        text = STUDY.replace("5.0e-6, 2.5e-6, 1e-6", "1.0e-4, 5.0e-6")
        key, reason = "bodies.left.integrator.central_difference.step", "0.0001 s is above the"
        ended = self.study("--quiet", text=text)
        self.assertEqual((ended.returncode, ended.stdout), (1, ""))
        self.assertIn("3 of 6 runs did not end as the study expects", ended.stderr)
        self.assertIn("  refused   step 0.0001, elements 5 and 2 more\n", ended.stderr)
        self.assertIn(f"{key}: {reason}", ended.stderr)
        page = (self.out / "index.html").read_text(encoding="utf-8")
        self.assertIn("<h2>Ended unexpectedly: 3 of 6 runs</h2>", page)
        self.assertIn(f"<td>refused</td><td><code>{key}</code></td>", page)
        self.assertIn(f"{key}: {reason}", page)
        with (self.out / "results.csv").open(newline="", encoding="utf-8") as file:
            table = list(csv.DictReader(file))
        for row in table[:3]:
            self.assertEqual((row["status"], row["expected"], row["key"]),
                             ("refused", "completed", key))
            self.assertNotIn("\n", row["reason"])
            self.assertIn(reason, row["reason"])
            self.assertIn("bodies.right", row["message"], "the message has all complaints")
        self.assertEqual([row["reason"] for row in table[3:]], ["", "", ""])
        # Again from what is there, and with a target that a run meets: still not as expected.
        self.assertEqual(self.study("--target", "release=0.5", text=text).returncode, 1)
        # Said to be so, it is a success; said of runs that complete, it is none.
        said = text + 'expected: {refused: "step 0.0001*"}\n'
        ended = self.succeed(self.study(text=said))
        self.assertIn("3 refused as expected, 3 completed;", ended.stdout)
        self.assertIn("Did not complete, as expected",
                      (self.out / "index.html").read_text(encoding="utf-8"))
        ended = self.study(text=said.replace('"step 0.0001*"', '"*"'))
        self.assertEqual(ended.returncode, 1)
        self.assertIn("3 completed, not refused;", ended.stdout)
        self.assertRegex(ended.stderr, "  completed step 5e-06, elements 5 and 2 more\n +was to be")

    def test_command_of_a_run_repeats_it(self):
        text = STUDY.replace("values: [5.0e-6, 2.5e-6, 1e-6]", "values: [5.0e-6]").replace(
            "repeats: 3\n", 'repeats: 3\nset: {meta.title: "It\'s a \\"$HOME\\" & more"}\n')
        self.succeed(self.study(text=text))
        page = html.unescape((self.out / "index.html").read_text(encoding="utf-8"))
        for row in self.rows():
            self.assertIn(f"<code>{row['command']}</code>", page)
            ended = subprocess.run(row["command"], shell=True, cwd="/", check=False, text=True,
                                   capture_output=True, timeout=120)
            self.assertEqual(ended.returncode, 1, "the scene's own expectation fails")
            first = self.summary(self.out / row["folder"])
            again = self.summary(self.out / "again" / Path(row["folder"]).name)
            for what in ("measures", "state_hash", "title"):
                self.assertEqual(again[what], first[what])
            self.assertEqual(first["title"], 'It\'s a "$HOME" & more')

    def test_units_are_those_of_keys_and_measures_in_the_scenes_words(self):
        study = STUDY.replace("errors:\n", """\
errors:
  peak: contact.impact.force_peak
  late: abs(contact.impact.end - 1.0e-3)
  per_mille: 1000 * contact.impact.end
  micro: {measure: 1e6 * contact.impact.end, unit: us}
  ratio: contact.impact.end / contact.impact.duration
  speed: 2 * mean_velocity.left.end / 2
  energy: energy.total.begin - 0.5
""").replace("values: [5.0e-6, 2.5e-6, 1e-6]", "values: [5.0e-6, 2.5e-6]").replace(
            "to: 20, points: 3", "to: 6, points: 2").replace('"*elements 20"', '"*elements 6"')
        study = study.replace("*elements 10", "*elements 6")
        millimetres = SCENE
        for number, word in (("0.25,", "250.0,"), ("-0.27", "-270.0"), ("[0.02]", "[20.0]"),
                             ("100.0]", "1.0e+5]"), ("1.0e-6}}", "1.0}}"),
                             ("youngs_modulus: 1.0e9", "youngs_modulus: 1000.0"),
                             ("density: 1000.0", "density: 1.0e-9")):
            self.assertIn(number, millimetres)
            millimetres = millimetres.replace(number, word)
        for scene, energy in ((SCENE, "J"), (f"units: mm t s\n{millimetres}", "mJ")):
            path = write(self.folder / "s", study, scene)
            self.succeed(self.abut("study", path, "--out", self.out))
            facts = json.loads((self.out / "study.json").read_text(encoding="utf-8"))
            self.assertEqual(facts["units"]["knobs"], {"step": "s", "elements": ""})
            self.assertEqual(facts["units"]["errors"], {
                "peak": "N", "late": "s", "per_mille": "", "micro": "us", "ratio": "", "speed": "",
                "energy": energy, "release": "", "kinetic": ""})
            page = (self.out / "index.html").read_text(encoding="utf-8")
            for heading in ("peak [N]", f"energy [{energy}]", "micro [us]"):
                self.assertIn(f"<th>{heading}</th>", page)
            self.assertIn(f'"label":"velocity [{"m/s" if energy == "J" else "mm/s"}]"', page)

    def test_scenes_of_several_systems_have_no_unit_in_common(self):
        text = ("title: Two\nvariants:\n  - {label: metres, scene: scene.yaml}\n"
                "  - {label: millimetres, scene: scene.yaml, set: {units: mm t s}}\n"
                "knobs: {time.window: [1.0e-5, 2.0e-5]}\n"
                "errors: {late: contact.impact.end, told: {measure: windows, unit: pieces}}\n")
        self.succeed(self.study(text=text))
        facts = json.loads((self.out / "study.json").read_text(encoding="utf-8"))
        self.assertEqual(facts["units"], {"knobs": {"time.window": ""},
                                          "errors": {"late": "", "told": "pieces"}})


if __name__ == "__main__":
    main()
