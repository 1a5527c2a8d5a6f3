"""Goal: a run's folder becomes one page that holds and draws everything. Oracle: a run made by
hand, whose tables and curves are known; the page's own count of drawn figures in a browser.

Usage: test_report.py PROGRAM            structure of pages and error messages
       test_report.py PROGRAM --browser  opens a page in Chromium; ends with 77 where there is none
"""

import csv
import html
import html.parser
import json
import math
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import browser
import made_fields

PROGRAM = ""
HEADER = ["time [s]", "impact.gap [m]", "impact.closed", "impact.iterations"]
BODY = ["{0}.tip.u [m]", "{0}.tip.v [m/s]", "{0}.tip.force [N]", "{0}.kinetic [J]",
        "{0}.stored [J]", "{0}.total [J]", "{0}.momentum [kg m/s]", "{0}.mean_velocity [m/s]"]


def bar_row(side: int, t: float) -> list[float]:
    """Two equal bars: contact from 0 to 5e-4 s, 100 N, 1.25 J each."""
    sign = 1.0 if side == 0 else -1.0
    part = min(1.0, max(0.0, t / 5e-4))
    closed = 0.0 <= t < 5e-4
    u = 0.02 + 100.0 * min(t, 0.0) - 100.0 * max(t - 5e-4, 0.0)
    v = 100.0 if t < 0.0 else 0.0 if closed else -100.0
    kinetic = 1.25 * abs(1.0 - 2.0 * part)
    mean = 100.0 * (1.0 - 2.0 * part)
    return [sign * u, sign * v, -sign * 100.0 * closed, kinetic, 1.25 - kinetic, 1.25,
            sign * 2.5e-4 * mean, sign * mean]


def make_run(folder: Path, rows: int = 100, title: str = "Two bars <collide>") -> None:
    folder.mkdir(parents=True, exist_ok=True)
    names = HEADER[:1] + [n.format(b) for b in ("left", "right") for n in BODY] + HEADER[1:]
    names += [f"{b}.external_work [J]" for b in ("left", "right")]
    with (folder / "history.csv").open("w", newline="") as history, \
            (folder / "closed_form.csv").open("w", newline="") as exact:
        writers = csv.writer(history), csv.writer(exact)
        writers[0].writerow(names)
        writers[1].writerow(names[:-3])
        for k in range(1, rows + 1):
            t = -2e-4 + 1e-3 * k / rows
            closed = 0.0 <= t < 5e-4
            gap = 200.0 * max(-t, t - 5e-4, 0.0)
            row = [t] + bar_row(0, t) + bar_row(1, t) + [gap, int(closed), 2 * closed, 0.0, 0.0]
            writers[1].writerow(row[:-3])
            ripple = 1.0 + 0.002 * math.sin(40.0 * k)
            row[3], row[11] = row[3] * ripple, row[11] * ripple
            row[6] += 1e-5 * closed
            writers[0].writerow(row)
    (folder / "events.jsonl").write_text(
        json.dumps({"time": 0.0, "kind": "contact_closed", "subject": "impact",
                    "text": "touched at 200 m/s", "values": {}}) + "\n")
    (folder / "summary.json").write_text(json.dumps(summary_of(title)))


def summary_of(title: str) -> dict:
    bodies = {name: {"wall": False, "mean_velocity_end": v, "total_begin": 1.25, "total_end": 1.25}
              for name, v in (("left", -100.0), ("right", 100.0))}
    return {
        "status": "completed", "title": title,
        "measures": {"contact.impact.begin": 0.0, "contact.impact.end": 5.0001e-4,
                     "contact.impact.duration": 5.0001e-4, "contact.impact.force_mean": 99.9,
                     "mean_velocity.left.end": -99.8, "momentum.total": None},
        "expectations": [
            {"measure": "contact.impact.duration", "expected": "0.0005 +- 0.05 %",
             "got": 5.0001e-4, "pass": True, "because": "one wave transit & back"},
            {"measure": "momentum.total", "expected": "at most 1e-12", "got": None, "pass": False,
             "because": "impulses are equal and opposite"}],
        "closed_form": {"name": "bar_impact", "interface": "impact", "begin": 0.0, "end": 5e-4,
                        "duration": 5e-4, "force": 100.0, "closing_speed": 200.0,
                        "bodies": bodies},
        "energy_scales": {"total": 2.5, "bodies": {"left": 1.25, "right": 1.25}},
        "ports": {"left.tip": {"position": -0.02, "normal": 1.0},
                  "right.tip": {"position": 0.02, "normal": -1.0}},
        "interfaces": {"impact": {"sides": ["left.tip", "right.tip"]}},
        "state_hash": "0123456789abcdef", "windows": 100, "contact_windows": 50, "exchanges": 210,
        "timing": {"wall_s": 0.05, "compute_s": {"left": 0.01, "right": 0.012},
                   "overhead_per_exchange_us_median": 31.5},
        "bodies": [{"name": "left", "model": "fe bar, 200 elements"}],
        "versions": {"abut": "0.1.0"}, "notes": ["momentum.total: made by hand"]}


class PageReader(html.parser.HTMLParser):
    """Collects canvases, outside addresses and the rows of tables."""

    def __init__(self, text: str):
        super().__init__()
        self.canvases, self.addresses, self.rows, self.open_cell = [], [], [], False
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        if tag == "canvas":
            self.canvases.append(attributes["id"])
        for name in ("src", "href"):
            if name in attributes:
                self.addresses.append(attributes[name])
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")
            self.open_cell = True

    def handle_endtag(self, tag):
        if tag in ("td", "th"):
            self.open_cell = False

    def handle_data(self, data):
        if self.open_cell:
            self.rows[-1][-1] += data


def figures_of(page: str) -> dict[str, dict]:
    data = re.search(r"<script>const figures = (.*?);</script>", page, re.DOTALL)
    return {figure["name"]: figure for figure in json.loads(data[1])}


def curves_of(page: str) -> dict[str, list[dict]]:
    return {name: figure["curves"] for name, figure in figures_of(page).items()}


def report(*arguments) -> subprocess.CompletedProcess:
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          timeout=60, check=False)


class Report(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp()) / "run"
        self.addCleanup(shutil.rmtree, self.folder.parent)

    def page(self, **options) -> str:
        make_run(self.folder, **options)
        result = report(self.folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        return (self.folder / "report.html").read_text(encoding="utf-8")

    def test_page_has_a_figure_for_every_quantity_and_needs_no_other_file(self):
        reader = PageReader(self.page())
        self.assertEqual(reader.canvases, [
            "force", "position", "velocity", "mean_velocity", "energy_left", "energy_right",
            "energy", "energy_error", "gap", "iterations"])
        self.assertEqual(reader.addresses, ["data:,"])

    def test_tables_hold_expectations_and_errors_against_the_closed_form(self):
        rows = PageReader(self.page()).rows
        self.assertIn(["contact.impact.duration", "0.0005 ± 0.05 %", "0.00050001 s", "ok",
                       "one wave transit & back"], rows)
        self.assertIn(["momentum.total", "at most 1e-12", "no value", "failed",
                       "impulses are equal and opposite"], rows)
        self.assertIn(["mean contact force [N]", "100", "99.9", "-0.1 %"], rows)
        self.assertIn(["mean velocity of left at the end [m/s]", "-100", "-99.8", "0.1 %"], rows)
        self.assertIn(["momentum.total", "no value", ""], rows)

    def test_page_speaks_in_the_words_of_a_scene_that_declares_its_system(self):
        make_run(self.folder)
        path = self.folder / "summary.json"
        summary = json.loads(path.read_text(encoding="utf-8"))
        summary["units"] = {"m": "mm", "s": "s", "kg": "t", "m/s": "mm/s", "N": "N", "J": "mJ",
                            "N*s": "t*mm/s", "Pa": "MPa"}
        summary["measures"]["contact.impact.impulse"] = 0.05
        summary["measures"]["contact.impact.force_peak"] = 150.0
        path.write_text(json.dumps(summary), encoding="utf-8")
        self.assertEqual(report(self.folder).returncode, 0)
        page = (self.folder / "report.html").read_text(encoding="utf-8")
        labels = {name: figure["label"] for name, figure in figures_of(page).items()}
        for name, unit in (("position", "mm"), ("velocity", "mm/s"), ("force", "N"), ("gap", "mm"),
                           ("energy_left", "mJ"), ("energy_error", "%")):
            self.assertTrue(labels[name].endswith(f"[{unit}]"), labels[name])
        rows = PageReader(page).rows
        # Forces are the same in both systems, and have prefixes; millimetres have none.
        self.assertIn(["impact", "left.tip and right.tip", "0 s", "500 µs", "500 µs", "150 N",
                       "0.05 t mm/s"], rows)
        self.assertIn(["left", "100 mm/s", "-100 mm/s", "1.25 mJ", "1.25 mJ", "1.25 mJ"], rows)
        self.assertIn(["mean velocity of left at the end [mm/s]", "-100", "-99.8", "0.1 %"], rows)
        self.assertIn(["mean_velocity.left.end", "-99.8", "mm/s"], rows)

    def test_title_and_status_are_text_not_markup(self):
        page = self.page()
        self.assertIn("<title>Two bars &lt;collide&gt;</title>", page)
        self.assertIn("completed, 1 expectation failed", page)

    def test_curves_are_those_of_the_run_in_readable_units(self):
        curves = curves_of(self.page())
        left = next(c for c in curves["position"] if c["label"] == "left.tip")
        self.assertAlmostEqual(left["x"][0], -190.0, places=6)       # microseconds
        self.assertAlmostEqual(left["y"][0], -0.019 * 1e3, places=4)  # mm: starts at -20 mm
        right = next(c for c in curves["force"] if c["label"] == "right.tip")
        self.assertAlmostEqual(max(right["y"]), 100.2, delta=0.01)  # compression is positive
        error = next(c for c in curves["energy_error"] if c["label"] == "left")
        self.assertAlmostEqual(max(error["y"]), 100.0 * 1e-5 / 1.25, places=9)  # %

    def test_energy_that_loads_put_in_is_no_error(self):
        make_run(self.folder)
        (self.folder / "closed_form.csv").unlink()
        path = self.folder / "history.csv"
        header, *lines = path.read_text().splitlines()
        rows = [line.split(",") for line in lines]
        for k, row in enumerate(rows):  # pulled from rest: all that it holds is work, and an error
            row[6], row[19], row[20] = str(0.01 * k + 1e-4 * (k == 70)), "0", str(0.01 * k)
            row[14] = "0"
        path.write_text("\n".join([header, *(",".join(row) for row in rows)]) + "\n")
        summary = summary_of("Loaded")
        summary["energy_scales"] = {"total": 0.99, "bodies": {"left": 0.99}}
        (self.folder / "summary.json").write_text(json.dumps(summary))
        self.assertEqual(report(self.folder).returncode, 0)
        page = (self.folder / "report.html").read_text(encoding="utf-8")
        curves = {curve["label"]: curve["y"] for curve in curves_of(page)["energy_error"]}
        self.assertEqual(set(curves), {"left", "all bodies"}, "right has nothing to compare with")
        for label, values in curves.items():
            self.assertAlmostEqual(max(map(abs, values)), 100.0 * 1e-4 / 0.99, places=7, msg=label)

    def test_page_of_a_failed_run_opens_with_the_reason(self):
        make_run(self.folder)
        summary = summary_of("Broken")
        summary.update(status="failed", expectations=[])
        (self.folder / "summary.json").write_text(json.dumps(summary))
        with (self.folder / "events.jsonl").open("a") as events:
            events.write(json.dumps({"time": 4e-4, "kind": "failure", "subject": "left",
                                     "text": "body 'left': cell 7 is inverted & lost",
                                     "values": {}}) + "\n")
        self.assertEqual(report(self.folder).returncode, 0)
        page = (self.folder / "report.html").read_text(encoding="utf-8")
        main = page[page.index("<main>") + len("<main>"):].lstrip()
        self.assertTrue(main.startswith("<section><h2>Why this is no success</h2>"), main[:80])
        self.assertIn("0.0004 s: body &#x27;left&#x27;: cell 7 is inverted &amp; lost", main[:300])

    def test_page_of_a_run_that_missed_an_expectation_opens_with_it(self):
        main = self.page().split("<main>")[1].lstrip()
        self.assertTrue(main.startswith("<section><h2>Why this is no success</h2>"), main[:80])
        self.assertIn("momentum.total is no value, expected at most 1e-12", main[:300])

    def test_what_was_given_up_is_told_with_shares_and_the_body(self):
        summary = summary_of("Passive")
        summary["overlaps"] = [{"bodies": ["left", "right"], "depth": 0.25, "place": [1.0, 2.0],
                                "time": 0.5}]
        summary["accuracy"] = {"given_up": {
            "passive_windows": 25, "halved_windows": 5, "rigid_windows": 0, "unanswered": 1,
            "joules": 0.5, "largest_energy": 2.5, "normal": 0.375, "friction": 0.25,
            "damped": 0.125, "changes_of_form": 0.0, "push_out": 0.0, "deepest": 1e-3,
            "lost_by_body": {"right": 0.375}, "taken_from_body": {"left": 0.125},
            "refused_by_body": {}, "words": "25 % of the windows <were> passive"}}
        make_run(self.folder)
        (self.folder / "summary.json").write_text(json.dumps(summary))
        self.assertEqual(report(self.folder).returncode, 0)
        page = (self.folder / "report.html").read_text(encoding="utf-8")
        rows = PageReader(page).rows
        for row in (["windows by the accurate method", "75", "75 %"],
                    ["windows passively", "25", "25 %"],
                    ["of these in shorter steps", "5", "5 %"],
                    ["given up [J]", "0.5", "20 %"], ["in normal contact [J]", "0.375", "15 %"],
                    ["lost in contact of right [J]", "0.375", ""],
                    ["left and right", "0.25", "1, 2", "0.5"]):
            self.assertIn(row, rows)
        self.assertIn("25 % of the windows &lt;were&gt; passive.", page)
        self.assertNotIn("Accuracy given up", self.page())

    def test_round_off_below_zero_opens_no_space_below_the_axis(self):
        make_run(self.folder)
        path = self.folder / "history.csv"
        lines = path.read_text().splitlines()
        cells = lines[50].split(",")
        cells[17] = "-1e-12"  # gap
        lines[50] = ",".join(cells)
        path.write_text("\n".join(lines) + "\n")
        self.assertEqual(report(self.folder).returncode, 0)
        figures = figures_of((self.folder / "report.html").read_text(encoding="utf-8"))
        self.assertEqual(figures["gap"]["floor"], 0)
        self.assertIsNone(figures["velocity"]["floor"])

    def test_exact_force_jumps_at_the_exact_times(self):
        exact = next(c for c in curves_of(self.page())["force"] if c["exact"])
        at_end = [y for x, y in zip(exact["x"], exact["y"]) if abs(x - 500.0) < 1e-6]
        self.assertIn(100.0, at_end)
        self.assertIn(0.0, at_end)

    def test_long_run_stays_small_and_keeps_its_extremes(self):
        make_run(self.folder, rows=100_000)
        lines = (self.folder / "history.csv").read_text().splitlines()
        cells = lines[54_321].split(",")
        cells[3] = "-977"  # one spike of 977 N in a hundred thousand rows
        lines[54_321] = ",".join(cells)
        (self.folder / "history.csv").write_text("\n".join(lines) + "\n")
        self.assertEqual(report(self.folder).returncode, 0)
        page = (self.folder / "report.html").read_text(encoding="utf-8")
        self.assertLessEqual(len(page.encode()), 1_500_000)
        left = next(c for c in curves_of(page)["force"] if c["label"] == "left.tip")
        self.assertEqual(max(left["y"]), 977.0)
        self.assertLessEqual(len(left["y"]), 2000)

    def test_run_without_closed_form_or_summary_still_has_a_page(self):
        make_run(self.folder)
        (self.folder / "closed_form.csv").unlink()
        (self.folder / "summary.json").unlink()
        self.assertEqual(report(self.folder).returncode, 0)
        page = (self.folder / "report.html").read_text(encoding="utf-8")
        self.assertIn("unfinished", page)
        self.assertFalse([c for curves in curves_of(page).values() for c in curves if c["exact"]])

    def test_row_that_a_killed_run_cut_short_is_left_out(self):
        make_run(self.folder)
        text = (self.folder / "history.csv").read_text()
        (self.folder / "history.csv").write_text(text + "0.0009,1,2")
        self.assertEqual(report(self.folder).returncode, 0)

    def test_row_that_is_broken_inside_is_named(self):
        make_run(self.folder)
        lines = (self.folder / "history.csv").read_text().splitlines()
        lines[7] = lines[7].replace(",", ",x", 1)
        (self.folder / "history.csv").write_text("\n".join(lines) + "\n")
        result = report(self.folder)
        self.assertEqual(result.returncode, 2)
        self.assertIn("history.csv:8:", result.stderr)

    def test_folder_without_a_run_is_the_users_error(self):
        self.folder.mkdir()
        result = report(self.folder)
        self.assertEqual(result.returncode, 2)
        self.assertIn("holds no run", result.stderr)
        self.assertIn("abut run SCENE --out", result.stderr)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_missing_chart_library_names_the_package(self):
        make_run(self.folder)
        result = report(self.folder, "--chart-library", self.folder / "none.js")
        self.assertEqual(result.returncode, 3)
        self.assertIn("libjs-chart.js", result.stderr)

    def test_page_goes_where_it_is_asked_to_go(self):
        make_run(self.folder)
        out = self.folder.parent / "elsewhere.html"
        result = report(self.folder, "--out", out)
        self.assertEqual((result.returncode, result.stdout.strip()), (0, str(out)))
        self.assertTrue(out.is_file())
        self.assertFalse((self.folder / "report.html").exists())


# What a reader may do with the bodies, done by a script at the end of a page, which tells in the
# attribute data-tried of the body what failed.
# Time that Chromium only pretends to pass has no frames: they are drawn at once.
AT_ONCE = "<script>window.requestAnimationFrame = (action) => setTimeout(action, 1);</script>"
READER = """
<script>
const wait = (ms) => new Promise((go) => setTimeout(go, ms));
const drawn = () => wait(100);
const yellow = () => {
  const canvas = document.getElementById("bodies");
  const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
  let count = 0, all = 0;
  for (let k = 0; k < pixels.length; k += 4) {
    all += pixels[k + 3] > 0;
    count += pixels[k] > pixels[k + 2] + 60;
  }
  return [count, all];
};
const change = (id, value, kind) => {
  document.getElementById(id).value = value;
  document.getElementById(id).dispatchEvent(new Event(kind));
};
async function read() {
  const failed = [], say = (fact, words) => { if (!fact) failed.push(words); };
  say(document.documentElement.scrollWidth <= innerWidth, "the page is wider than its window");
  change("moment", 0, "input");
  await drawn();
  say(yellow()[0] === 0 && yellow()[1] > 1000, "at the begin no stress: " + yellow());
  change("moment", 3, "input");
  await drawn();
  const [stressed, all] = yellow();
  say(stressed > 100, "at the end no stress is seen");
  say(document.getElementById("now").textContent === "t = 3 ms", "the time is not told");
  const canvas = document.getElementById("bodies"), box = canvas.getBoundingClientRect();
  const put = {bubbles: true, pointerId: 1, clientX: box.x + box.width * 0.55,
    clientY: box.y + box.height * 0.5};
  canvas.setPointerCapture = () => {};
  canvas.dispatchEvent(new PointerEvent("pointerdown", put));
  canvas.dispatchEvent(new PointerEvent("pointermove", Object.assign({}, put,
    {clientX: put.clientX + 60})));
  canvas.dispatchEvent(new PointerEvent("pointerup", put));
  await drawn();
  say(yellow()[1] !== all, "what is dragged does not move");
  canvas.dispatchEvent(new Event("dblclick"));
  await drawn();
  say(yellow()[1] === all, "a double-click does not bring it back");
  const right = Array.from(document.querySelectorAll(".stage .chip")).find(
    (chip) => chip.textContent === "right");
  right.click();
  await drawn();
  say(yellow()[0] === 0 && yellow()[1] < all, "a body that is hidden is seen");
  right.click();
  await drawn();
  change("shade", "displacement", "change");
  await drawn();
  say(document.querySelector(".ends b").textContent === "displacement [mm]", "no other quantity");
  for (let k = 0; k < 400 && document.getElementById("gauge_figure").hidden; k++) {
    const spot = Object.assign({}, put, {clientX: box.x + box.width * (k % 20) / 20,
      clientY: box.y + box.height * Math.floor(k / 20) / 20});
    canvas.dispatchEvent(new PointerEvent("pointerdown", spot));
    canvas.dispatchEvent(new PointerEvent("pointerup", spot));
  }
  say(!document.getElementById("gauge_figure").hidden, "a click on a body tells nothing");
  document.getElementById("play").click();
  for (let k = 0; k < 40; k++) await wait(50);
  say(document.getElementById("now").textContent === "t = 3 ms", "it does not play to its end");
  document.body.dataset.tried = failed.join("; ") || "all";
}
addEventListener("load", () => wait(500).then(read).catch((error) => {
  document.body.dataset.tried = String(error);
}));
</script>
"""


def browse() -> int:
    """Pages of bars, of a plane and of space are drawn at every width, light and dark, and do what
    a reader asks."""
    if not browser.is_there():
        print("skipped: chromium is not installed")
        return browser.SKIPPED
    fine = True
    with tempfile.TemporaryDirectory() as name:
        for kind, dimension, figures in (("bars", 1, 10), ("plane", 2, 7), ("space", 3, 7)):
            folder = Path(name) / kind
            if dimension == 1:
                make_run(folder)
            else:
                made_fields.make_run(folder, dimension)
            assert report(folder).returncode == 0
            page = folder / "report.html"
            wanted = {"figures": str(figures), "drawn": str(figures), "failures": ""}
            if dimension > 1:
                text = page.read_text(encoding="utf-8")
                text = text.replace("<head>", "<head>" + AT_ONCE)
                page.write_text(text.replace("</body>", READER + "</body>"), encoding="utf-8")
                wanted["tried"] = "all"
            for width, dark in ((390, False), (800, True), (1920, False)):
                fine = browser.look_at(page, width, dark, wanted) and fine
    return 0 if fine else 1


if __name__ == "__main__":
    PROGRAM = sys.argv[1]
    if sys.argv[2:] == ["--browser"]:
        sys.exit(browse())
    unittest.main(argv=sys.argv[:1])
