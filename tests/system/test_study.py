"""Goal: a study runs every setting once, says what each costs and how good it is, and goes on where
it was interrupted. Oracles: an independent computation from the runs' own files, power laws with
known orders, `abut run` of the scene that a target names, the page's own count of drawn figures.

usage: test_study.py ABUT ROOT            files, resuming, targets, messages
       test_study.py ABUT ROOT --browser  opens a page in Chromium; ends with 77 where there is none
"""

import csv
import json
import math
import os
import re
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from types import SimpleNamespace

sys.dont_write_bytecode = True
import browser  # noqa: E402
from made_studies import BAR, SCENE, STUDY, StudyTest, write  # noqa: E402
from support import ABUT, PACKAGE, ROOT, SystemTest, main  # noqa: E402

sys.path.insert(0, str(PACKAGE))
from abut_tools.study_results import check_of, front, series_of  # noqa: E402
from abut_tools.expressions import Expression  # noqa: E402
from abut_tools.study_file import read_study  # noqa: E402
from abut_tools.study_runs import check_measures  # noqa: E402


def columns(path: Path) -> dict:
    with path.open(newline="", encoding="utf-8") as file:
        head, *rows = list(csv.reader(file))
    return {name.split(" [")[0]: [float(row[i]) for row in rows] for i, name in enumerate(head)}


class Studies(StudyTest):
    def stamps(self) -> dict:
        return {path.parent.name: path.stat().st_mtime_ns
                for path in self.out.glob("runs/*/run.json")}

    def test_every_setting_is_a_run_with_its_cost_and_errors(self):
        self.succeed(self.study())
        rows = self.rows()
        self.assertEqual([row["knobs"] for row in rows],
                         [{"step": s, "elements": n} for s in (5e-6, 2.5e-6, 1e-6)
                          for n in (5, 10, 20)])
        for row in rows:
            self.assertEqual(row["status"], "completed")
            self.assertEqual(set(row["cost"]), {
                "wall_s_median", "wall_s_min", "wall_s_max", "compute_s", "exchanges",
                "iterations_mean", "memory_mib"})
            self.assertIsNone(row["cost"]["wall_s_median"], "several at once are not timed")
            self.assertGreater(row["cost"]["compute_s"], 0.0)
            self.assertEqual(row["settings"],
                             {"bodies.*.integrator.*.step": row["knobs"]["step"],
                              "bodies.*.model.*.mesh.bar.elements": row["knobs"]["elements"]})
            used = (self.out / row["folder"] / "scene.resolved.yaml").read_text(encoding="utf-8")
            self.assertEqual(used.count(f"elements: {row['knobs']['elements']}\n"), 2)
        # A process with a YAML reader and a socket library is not smaller, nor ten elements larger;
        # a run of a few milliseconds may end before anybody looks.
        seen = [row["cost"]["memory_mib"] for row in rows if row["cost"]["memory_mib"] is not None]
        self.assertTrue(seen and all(4.0 < memory < 200.0 for memory in seen), seen)
        with (self.out / "results.csv").open(newline="", encoding="utf-8") as file:
            table = list(csv.DictReader(file))
        self.assertEqual([float(row["release"]) for row in table],
                         [row["errors"]["release"] for row in rows])
        self.assertIn("| step 5e-06, elements 5 | completed |",
                      (self.out / "results.md").read_text(encoding="utf-8"))
        facts = json.loads((self.out / "study.json").read_text(encoding="utf-8"))
        self.assertEqual(facts["status"], {"completed": 9})
        self.assertTrue(facts["machine"]["cpu"] and facts["machine"]["cores"])
        self.assertIn("abut", facts["versions"])

    def test_errors_are_those_of_the_runs_files(self):
        self.succeed(self.study())
        for row in self.rows():
            folder = self.out / row["folder"]
            measures = self.summary(folder)["measures"]
            self.assertEqual(row["errors"]["release"],
                             abs(measures["contact.impact.release_error"]))
            got, exact = (columns(folder / name)["left.kinetic"]
                          for name in ("history.csv", "closed_form.csv"))
            rms = math.sqrt(statistics.fmean((g - e) ** 2 for g, e in zip(got, exact))) / 1.25
            # Two orders of summation of a hundred rows.
            self.assertAlmostEqual(row["errors"]["kinetic"], rms, delta=1e-12 * rms)

    def test_serial_runs_are_timed_with_their_spread(self):
        self.succeed(self.study())
        self.succeed(self.study("--serial"))
        for row in self.rows():
            cost = row["cost"]
            self.assertTrue(0.0 < cost["wall_s_min"] <= cost["wall_s_median"]
                            <= cost["wall_s_max"])

    def test_what_is_done_is_not_done_again(self):
        self.succeed(self.study())
        before, rows = self.stamps(), self.rows()
        self.assertEqual(len(before), 9)
        again = self.succeed(self.study())
        self.assertEqual(self.stamps(), before)
        self.assertEqual(self.rows(), rows)
        self.assertEqual(again.stderr.count("from before"), 9)
        self.succeed(self.study("--force"))
        self.assertFalse(set(self.stamps().items()) & set(before.items()))

    def test_another_scene_is_another_run(self):
        self.succeed(self.study("--quick"))
        before = self.stamps()
        path = write(self.folder / "s", scene=SCENE.replace("1000.0}}", "1100.0}}"))
        self.succeed(self.abut("study", path, "--out", self.out, "--quick"))
        self.assertEqual(len(before), 4)  # the first two values of both knobs
        self.assertEqual(len(self.stamps()), 8)

    def test_another_file_that_the_scene_names_is_another_run(self):
        scene = SCENE.replace("  left:\n", "  left:\n    copies: {table: {file: 'places a.csv'}}\n")
        scene = scene.replace("left.tip", "left_1.tip")
        study = ("title: A table\nbase: scene.yaml\n"
                 "knobs: {bodies.left.copies.table.file: ['places a.csv', places_b.csv]}\n"
                 "errors: {mass: windows}\n")
        path = write(self.folder / "s", study, scene)
        first, second = path.with_name("places a.csv"), path.with_name("places_b.csv")
        runs = [(0.0, 0.0, 2, "both are new"), (0.0, 0.0, 2, "nothing has changed"),
                (0.0, -1.0, 3, "what a setting names"), (-1.0, -1.0, 5, "what the scene names")]
        for one, other, count, what in runs:
            for table, x in ((first, one), (second, other)):
                table.write_text(f"x\n{x}\n", encoding="utf-8")
            self.succeed(self.abut("study", path, "--out", self.out))
            self.assertEqual(len(self.stamps()), count, what)

    def test_interrupted_study_goes_on_where_it_was(self):
        slow = STUDY.replace("5.0e-6, 2.5e-6, 1e-6", "5.0e-8, 2.0e-8, 1.0e-8")
        path = write(self.folder / "s", slow)
        command = [ABUT, "study", path, "--out", self.out, "--jobs", 1]
        running = self.start(*command)
        until = time.monotonic() + 30.0
        while len(self.stamps()) < 2 and time.monotonic() < until:
            time.sleep(0.002)
        running.send_signal(signal.SIGINT)
        ended = self.end(running)
        self.assertEqual(ended.returncode, 130, ended.stderr)
        self.assertIn("goes on from here", ended.stderr)
        before = self.stamps()
        self.assertTrue(2 <= len(before) < 9, "it was interrupted in between")
        self.succeed(self.abut(*command[1:]))
        after = self.stamps()
        self.assertEqual({name: after[name] for name in before}, before)
        whole = self.rows()
        self.succeed(self.abut("study", path, "--out", self.folder / "other"))
        other = json.loads((self.folder / "other" / "results.json").read_text(encoding="utf-8"))
        self.assertEqual([row["errors"] for row in whole], [row["errors"] for row in other])

    def test_tables_hold_the_runs_values(self):
        self.succeed(self.study())
        rows = self.rows()
        spread, by_run = json.loads(
            (self.out / "study.json").read_text(encoding="utf-8"))["tables"]
        self.assertEqual(spread["headings"], ["elements", "5", "10", "20"])
        self.assertEqual([row[0] for row in spread["rows"]],
                         ["step 5e-06", "step 2.5e-06", "step 1e-06"])
        for k, row in enumerate(rows):
            most = self.summary(self.out / row["folder"])["measures"]["schwarz.iterations_max"]
            self.assertEqual(spread["rows"][k // 3][1 + k % 3],
                             f"{100 * row['errors']['release']:.3g} / {most:.3g}")
        self.assertEqual(by_run["headings"], ["run", "release"], "nothing was timed")
        self.assertEqual(by_run["rows"], [[row["label"], f"{row['errors']['release']:.3g}"]
                                          for row in rows[1::3]])
        text = (self.out / "results.md").read_text(encoding="utf-8")
        self.assertIn("## Spread\n\n| elements | 5 | 10 | 20 |", text)

    def test_short_form_is_that_of_the_study(self):
        text = STUDY + 'quick: {runs: ["*elements 5"], set: {time.end: 1.0e-4}}\n'
        self.succeed(self.study("--quick", text=text))
        self.assertEqual([(row["label"], row["settings"]["time.end"]) for row in self.rows()],
                         [("step 5e-06, elements 5", 1e-4), ("step 2.5e-06, elements 5", 1e-4)])
        ended = self.study("--quick", text=text.replace("elements 5", "elements 6"))
        self.assertEqual((ended.returncode, "quick.runs: no run" in ended.stderr), (2, True))

    def test_target_writes_the_scene_that_meets_it(self):
        ended = self.succeed(self.study("--target", "release=0.05", "--target", "kinetic=0.03"))
        able = [row for row in self.rows() if row["errors"]["release"] <= 0.05
                and row["errors"]["kinetic"] <= 0.03]
        best = min(able, key=lambda row: row["cost"]["compute_s"])
        self.assertIn(best["label"], ended.stdout)
        scene = re.search(r"^scene\s+(.+)$", ended.stdout, re.MULTILINE)[1]
        run = self.succeed(self.abut("run", scene, "--local", "--out", self.folder / "again"))
        self.assertIn("contact.impact.release_error", run.stdout)
        again = self.summary(self.folder / "again")
        self.assertEqual([each["pass"] for each in again["expectations"]], [True])
        self.assertEqual(abs(again["measures"]["contact.impact.release_error"]),
                         best["errors"]["release"])

    def test_target_that_no_run_meets_names_the_nearest(self):
        ended = self.study("--target", "release=1e-12")
        self.assertEqual(ended.returncode, 1)
        best = min(self.rows(), key=lambda row: row["errors"]["release"])
        self.assertIn(f"nearest: {best['label']}", ended.stderr)

    def test_run_that_is_refused_or_too_long_is_a_result(self):
        # Minutes of free flight against seconds: no load of the machine turns one into the other.
        text = STUDY.replace("5.0e-6, 2.5e-6, 1e-6", "1.0e-4, 5.0e-6, 1.0e-9").replace(
            "set: [bodies.*.integrator.*.step]",
            "set: {bodies.*.integrator.*.step: null, time.end: [8.0e-4, 8.0e-4, 0.9998]}")
        expected = 'time_limit: 3.0\nexpected: {refused: "step 0.0001*", failed: ["step 1e-09*"]}\n'
        self.succeed(self.study(text=text + expected))
        status = [row["status"] for row in self.rows()]
        self.assertEqual(status, 3 * ["refused"] + 3 * ["completed"] + 3 * ["failed"])
        self.assertIn("step", self.rows()[0]["message"])
        self.assertIn("time_limit", self.rows()[-1]["message"])
        self.assertEqual(self.rows()[0]["errors"], {"release": None, "kinetic": None})
        facts = json.loads((self.out / "study.json").read_text(encoding="utf-8"))
        self.assertEqual((facts["status"], facts["unexpected"]), (
            {"refused as expected": 3, "completed": 3, "failed as expected": 3}, []))

    def test_reference_run_is_made_and_stated(self):
        text = STUDY + "reference: {set: {bodies.*.integrator.*.step: 1.0e-6}}\n"
        text = text.replace("errors:\n", """\
errors:
  off: {history: left.tip.u, norm: max, against: reference}
  later: {measure: contact.impact.end, against: reference}
""")
        self.succeed(self.study(text=text))
        # The base has ten elements: with the reference's step it is the reference itself.
        rows = self.rows()
        same = next(row for row in rows if row["knobs"] == {"step": 1e-6, "elements": 10})
        self.assertEqual((same["errors"]["off"], same["errors"]["later"]), (0.0, 0.0))
        others = [row["errors"]["off"] for row in rows if row is not same]
        self.assertTrue(all(0.0 < error < 0.1 for error in others), others)
        self.assertIn("Reference run: scene.yaml with bodies.*.integrator.*.step",
                      (self.out / "index.html").read_text(encoding="utf-8"))

    def test_variants_and_sweeps_multiply(self):
        text = """\
title: Variants
variants:
  - {label: plain, scene: scene.yaml}
  - {label: corrected, scene: scene.yaml, set: {bodies.*.integrator.*.dispersion_terms: 3}}
sweeps:
  - {title: base}
  - {title: steps, variants: [corr*], knobs: {time.window: [1.0e-5, 2.0e-5]}}
errors: {release: abs(contact.impact.release_error) * 100}
claims: [{text: better, checks: [{runs: corrected, value: release, below: plain}]}]
"""
        self.succeed(self.study(text=text))
        self.assertEqual([(row["sweep"], row["label"]) for row in self.rows()], [
            ("base", "plain"), ("base", "corrected"), ("steps", "corrected, time.window 1e-05"),
            ("steps", "corrected, time.window 2e-05")])
        facts = json.loads((self.out / "study.json").read_text(encoding="utf-8"))
        plain, corrected = (row["errors"]["release"] for row in self.rows()[:2])
        self.assertEqual(facts["claims"][0]["verdict"],
                         "holds" if corrected < plain else "does not hold")

    def test_copies_are_set_all_at_once_in_number_and_one_by_one(self):
        scene = SCENE[SCENE.index("time:"):SCENE.index("bodies:")] + "bodies:\n" + BAR.format(
            name="bar", x=0.0, v=1.0, side="right") + """\
    copies: {grid: {count: [3], spacing: [1.0]}}
meta: {title: Three bars}
"""
        text = """\
title: Copies
variants:
  - {label: three, scene: scene.yaml}
  - {label: fast, scene: scene.yaml, set: {bodies.*.initial.velocity: [5.0]}}
  - {label: one, scene: scene.yaml, set: {bodies.bar.copies.grid.count: [1]}}
  - {label: first, scene: scene.yaml, set: {bodies.bar_1.initial.velocity: [7.0]}}
errors: {speed: {measure: mean_velocity.bar_1.end}}
"""
        self.succeed(self.abut("study", write(self.folder / "s", text, scene), "--out", self.out))
        found = {row["label"]: row for row in self.rows()}
        for label, speed in (("three", 1.0), ("fast", 5.0), ("one", 1.0), ("first", 7.0)):
            self.assertAlmostEqual(found[label]["errors"]["speed"], speed, delta=1e-12, msg=label)
        self.assertEqual(3 * found["one"]["cost"]["exchanges"],
                         found["three"]["cost"]["exchanges"])

    def test_every_mistake_is_named_with_its_place(self):
        knob = "set: [bodies.*.integrator.*.step]"
        for old, new, words in [
                ("title:", "titel:", ["titel: is not a known key", "Did you mean title?"]),
                ("repeats: 3", "repeats: 0", ["repeats: must be a number of at least 1"]),
                ("base: scene", "base: seen", ["base: there is no scene seen.yaml"]),
                (knob, "set: [bodies.left.integrator.central_difference.stepp]",
                 ["knobs.step", "stepp' is not a key", "central_difference.step"]),
                (knob, "set: [bodies.lft.integrator.central_difference.step]",
                 ["no body 'lft'", "left, right"]),
                (knob, "set: [bodies.*.integratr.*.step]",
                 ["knobs.step", "is not a key", "bodies.*.integrator"]),
                (knob, "set: [bodies.*.integrator.newmark.step]",
                 ["knobs.step", "matches no key of the scene", "has no newmark",
                  "Keys there are central_difference"]),
                ("values: [5", "vales: [5", ["knobs.step.vales", "Did you mean values?"]),
                ("scale: log", "scale: lag", ["'lag' is none of linear, log"]),
                ("impact.release_error, abs", "impact.relase_error, abs",
                 ["errors.release.measure", "contact.impact.release_error"]),
                ("norm: rms", "norm: sum", ["'sum' is none of rms, max, end"]),
                ("[position,", "[positon,", ["positon", "position"]),
                ("knob: elements", "knob: element", ["figures[1].knob"]),
                ("release: 100 * release", "release: 100 * relase",
                 ["figures[2].table.release", "release"]),
                ("table: {release: release, wall: wall_s_median}", "table: {}",
                 ["figures[3].table: needs at least one column"]),
                ("at_most: 0.1, percent: true", "percent: true", ["claims[0].checks[0]: needs"]),
                ("value: release,", "value: __import__('os'),", ["is something else"]),
                ("value: release,", "runs: nobody, value: release,", ["no run is labelled"]),
                ("repeats: 3", "repeats: 3\nrepeats: 4", ["study.yaml:", "stands twice"]),
                ("knobs:", "knobs: [", ["study.yaml:"]),
                # What would take all memory, or never end, is counted first.
                ("points: 3", "points: 1000000000",
                 ["knobs.elements.range.points: is 1e+09. Give a whole number from 2 to 10000"]),
                ("to: 20, points: 3, scale: log", "to: 90000, points: 9000",
                 ["knobs: make 27000 runs", "at most 20000"]),
                ("from: 5", "from: 1.0e+999", ["knobs.elements.range.from: must be a number"]),
                ("repeats: 3", "repeats: 3\nexpected: {refuse: x}",
                 ["expected.refuse: is not a known key", "Did you mean refused?"]),
                ("repeats: 3", "repeats: 3\nexpected: {failed: step 7}",
                 ["expected.failed: no run is labelled 'step 7'"]),
                ("repeats: 3", "repeats: 3\nexpected: {failed: 'step 5*', refused: '*'}",
                 ["expected.refused: run 'step 5e-06, elements 5' is expected to be failed"]),
                ("repeats: 3", "repeats: 1.0e+9", ["repeats: is 1e+09", "from 1 to 1000"]),
                ("release: 100 * release", "release: 9**9**9**9 * release",
                 ["figures[2].table.release: '9 ** 9 ** 9 ** 9' has no value"]),
                ("value: release,", f"value: {'-' * 1500}1,", ["is nested too deep"]),
                ("repeats: 3", "repeats: 3\nx0: &x0 [1, 1]\n" + "".join(
                    f"x{k}: &x{k} [{', '.join(9 * [f'*x{k - 1}'])}]\n" for k in range(1, 12)),
                 ["study.yaml:", "holds more than 1000000 values"]),
                ("repeats: 3", "repeats: 3\nx: &x [*x]", ["study.yaml:", "holds itself"])]:
            with self.subTest(new=new):
                self.assertIn(old, STUDY)
                ended = self.study(text=STUDY.replace(old, new, 1))
                self.assertEqual(ended.returncode, 2, ended.stderr)
                for word in [*words, "study.yaml"]:
                    self.assertIn(word, ended.stderr)
                self.assertFalse(self.stamps(), "nothing has run")
        pipe = self.folder / "pipe.yaml"
        os.mkfifo(pipe)
        ended = self.abut("study", pipe, "--out", self.out)
        self.assertEqual((ended.returncode, "is no regular file" in ended.stderr), (2, True))
        ended = self.study("--target", "relese=1")
        self.assertEqual((ended.returncode, "Did you mean release?" in ended.stderr), (2, True))

    def test_shipped_studies_are_valid(self):
        shipped = sorted((ROOT / "studies").glob("*.yaml"))
        self.assertGreater(len(shipped), 2, "the studies are found")
        for path in shipped:
            with self.subTest(study=path.name):
                check_measures(read_study(path, ABUT, False), ABUT)

    def test_documents_are_those_of_the_shipped_studies(self):
        """Names only: numbers are measured again by make results and make extremes."""
        for study, document in (("two_bars_methods", "RESULTS"), ("extremes", "EXTREMES")):
            found = read_study(ROOT / "studies" / f"{study}.yaml", ABUT, False)
            text = (ROOT / "docs" / f"{document}.md").read_text(encoding="utf-8")
            wanted = [claim["text"] for claim in found.claims]
            wanted += [figure["title"] for figure in found.figures if "table" in figure]
            wanted += [f"\n| {point.variant}" for point in found.points]
            for name in dict.fromkeys(wanted):
                with self.subTest(document=document):
                    self.assertIn(name, text, f"run make {document.lower()}")

    def test_page_is_whole_and_small(self):
        self.succeed(self.study())
        page = (self.out / "index.html").read_text(encoding="utf-8")
        self.assertLess(len(page.encode()), 1_500_000)
        self.assertIn("<title>Small &lt;bars&gt;</title>", page)
        self.assertEqual(set(re.findall(r'(?:src|href)="([^"]*)"', page)), {"data:,"})
        self.assertEqual(len(re.findall("<canvas", page)), 2 + 1 + 6)


class Arithmetic(SystemTest):
    """The parts whose answers are known on paper."""

    def made(self, x: float, y: float, cost: float = 1.0) -> SimpleNamespace:
        point = SimpleNamespace(knobs={"n": x}, sweep="", variant="")
        return SimpleNamespace(point=point, errors={"e": y}, cost={"c": cost}, label=f"n {x}",
                               status="completed", number={"e": y}.get)

    def test_power_laws_have_their_orders(self):
        figure = {"convergence": "e", "knob": "n"}
        counts = [self.made(n, 3.0 * n ** -2.0) for n in (10, 20, 50)]
        steps = [self.made(h, 7.0 * h ** 1.5) for h in (0.1, 0.2, 0.5)]
        for runs, order in ((counts, 2.0), (steps, 1.5)):
            series, = series_of(runs, figure)
            for got in [series["order"], *series["steps"]]:
                self.assertAlmostEqual(got, order, delta=1e-12)  # round-off of logarithms

    def test_front_holds_what_nothing_beats(self):
        runs = [self.made(k, (7 * k) % 11 + 1.0, (5 * k) % 13 + 1.0) for k in range(1, 30)]
        kept = front(runs, "e", "c")
        beaten = [r for r in runs if any(
            o.errors["e"] <= r.errors["e"] and o.cost["c"] <= r.cost["c"]
            and (o.errors["e"], o.cost["c"]) != (r.errors["e"], r.cost["c"]) for o in runs)]
        pairs = {(r.errors["e"], r.cost["c"]) for r in runs}
        pairs -= {(r.errors["e"], r.cost["c"]) for r in beaten}
        self.assertEqual({(r.errors["e"], r.cost["c"]) for r in kept}, pairs)

    def test_checks_compare_with_bounds_and_with_other_runs(self):
        runs = [self.made(k, float(k)) for k in (1, 2, 3)]
        value = Expression("e", "here")
        most = check_of({"value": value, "at_most": 2.0}, runs)["measured"]
        self.assertEqual([each["holds"] for each in most], [True, True, False])
        below = check_of({"value": value, "runs": "n 2", "below": ["n 3"]}, runs)["measured"]
        self.assertEqual([each["holds"] for each in below], [True])
        above = check_of({"value": value, "runs": "n 2", "above": "n *"}, runs)["measured"]
        self.assertEqual([each["holds"] for each in above], [False])


def browse() -> int:
    """Every figure is drawn, at desktop and phone width, and nothing is complained of."""
    if not browser.is_there():
        print("skipped: chromium is not installed")
        return browser.SKIPPED
    with tempfile.TemporaryDirectory() as name:
        # With runs that are refused, and names and values that have little room.
        text = STUDY.replace("values: [5.0e-6,", "values: [1.0e-4, 5.0e-6,").replace(
            "  elements:", "  number_of_elements_of_both_bars_alike:").replace(
            "knob: elements", "knob: number_of_elements_of_both_bars_alike").replace(
            '"*elements ', '"step [!0]*, *alike ')
        ended = subprocess.run([ABUT, "study", write(Path(name) / "s", text), "--out",
                                f"{name}/out", "--quiet"], check=False, timeout=120)
        if ended.returncode != 1:
            return 1
        page = Path(name, "out", "index.html")
        wanted = {"figures": "9", "drawn": "9", "failures": ""}
        views = ((390, False), (390, True), (1440, False))
        fine = [browser.look_at(page, width, dark, wanted) for width, dark in views]
    return 0 if all(fine) else 1


if __name__ == "__main__":
    if sys.argv[3:] == ["--browser"]:
        sys.exit(browse())
    main()
