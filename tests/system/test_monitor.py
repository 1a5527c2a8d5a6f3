"""Goal: whoever looks at a run sees how it goes, and neither harms it nor lets others in. Oracles:
the run's own files; a run that nobody looks at, bit for bit; the kernel's word on its processes.

usage: test_monitor.py ABUT ROOT [CLASS]
       test_monitor.py ABUT ROOT --browser   opens the page in Chromium; 77 where there is none
"""

import http.client
import json
import math
import os
import re
import signal
import sys
import tempfile
import time
import unittest
from pathlib import Path

import browser
from support import ABUT, PACKAGE, ROOT, SystemTest, main, strict_json

sys.path.insert(0, str(PACKAGE))
from abut_tools.growing import STRETCHES, GrowingTable, Replaced  # noqa: E402
from abut_tools.monitor_server import HOST  # noqa: E402

SCENE = ROOT / "configs" / "two_bars.yaml"
# Every window is iterated: goes on until it is ended.
LONG = [ROOT / "configs" / "bars" / "tied_halves.yaml", "--set", "time.end=100.0"]


class Monitored(SystemTest):
    def monitor(self, folder: Path, *options: object):
        """A monitor, and where it is found."""
        process = self.start(ABUT, "monitor", folder, *options)
        self.addCleanup(self.end_monitor, process)
        line = process.stdout.readline()
        found = re.match(r"http://127\.0\.0\.1:(\d+)/ shows ", line)
        self.assertTrue(found, line + (process.stderr.read() if not line else ""))
        self.port = int(found[1])
        return process

    def end_monitor(self, process):
        if process.poll() is None:
            process.send_signal(signal.SIGINT)
        self.assertEqual(self.end(process).returncode, 0)

    def ask(self, path: str, method: str = "GET", host: str = ""):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=20)
        connection.request(method, path, headers={"Host": host or f"127.0.0.1:{self.port}"})
        answer = connection.getresponse()
        body = answer.read()
        connection.close()
        return answer, body

    def state(self, since: int = 0, until: object = "-inf") -> dict:
        answer, body = self.ask(f"/state?since={since}&until={until}")
        self.assertEqual(answer.status, 200, body)
        return strict_json(body.decode())

    def state_when(self, wanted, seconds: float = 10.0) -> dict:
        until = time.monotonic() + seconds
        while True:
            told = self.state()
            if wanted(told):
                return told
            self.assertLess(time.monotonic(), until, str(told)[:2000])
            time.sleep(0.2)

    def long_run(self, *options: object):
        run = self.start(ABUT, "run", *LONG, "--out", self.out, *options)
        self.addCleanup(run.kill)
        until = time.monotonic() + 10.0
        while not (self.out / "progress.json").exists():
            self.assertLess(time.monotonic(), until)
            time.sleep(0.02)
        return run


class WhileItGoesOn(Monitored):
    def test_it_tells_how_far_the_run_is_and_how_its_processes_are(self):
        run = self.long_run()
        self.monitor(self.out)
        first = self.state_when(lambda told: told["part"] and len(told["facts"]) > 6)
        self.assertEqual(first["badge"][0], "runs")
        later = self.state_when(lambda told: told["part"] > first["part"] and
                                "of a core" in told["bodies"]["heads"])
        names = dict(later["facts"])
        self.assertGreater(float(names["exchanges per second"]), 1.0)
        self.assertRegex(names["left"], "about|not known")
        heads, rows = later["bodies"]["heads"], later["bodies"]["rows"]
        solvers = {f"process {pid}" for pid in self.solvers(3)}
        self.assertEqual({row[heads.index("where")] for row in rows}, solvers)
        self.assertAlmostEqual(sum(share["part"] for share in later["shares"]), 1.0, delta=1e-6)
        run.send_signal(signal.SIGINT)
        self.assertEqual(self.end(run).returncode, 130)
        ended = self.state_when(lambda told: told["ended"])
        self.assertEqual(ended["badge"][:2], ["interrupted", "failed"])
        self.assertFalse((self.out / "progress.json").exists())

    def test_a_page_is_told_what_has_come_since_its_last_look(self):
        run = self.long_run("--local")
        self.monitor(self.out)
        first = self.state_when(lambda told: told["figures"] and told["read"] > 0.9)
        self.assertTrue(all(figure["whole"] for figure in first["figures"]))
        told, parts = first, 0
        for _ in range(12):  # whole ones become rarer, as the table is thinned at every doubling
            time.sleep(0.7)
            later = self.state(told["version"], told["latest"])
            self.assertGreaterEqual(later["latest"], told["latest"])
            for figure in later["figures"]:
                if figure["whole"]:
                    continue
                parts += 1
                for curve in figure["curves"]:
                    self.assertGreater(min(curve["x"], default=math.inf), told["latest"])
            told = later
            if parts > 20:
                break
        self.assertGreater(parts, 20)
        self.assertGreater(told["latest"], first["latest"])
        run.send_signal(signal.SIGINT)
        self.end(run)

    def test_a_killed_run_is_told_as_killed_and_since_when(self):
        self.leaves_sockets = True
        run = self.long_run()
        self.monitor(self.out)
        self.state_when(lambda told: told["badge"][0] == "runs")
        run.kill()
        run.communicate()
        told = self.state_when(lambda told: told["badge"][0] == "killed")
        self.assertFalse(told["ended"])
        self.assertNotIn("left", dict(told["facts"]))
        self.assertRegex(told["badge"][2], r"Last sign of life at \d\d:\d\d:\d\d\.")
        self.assertEqual(len(told["bodies"]["ill"]), 3)
        again = self.start(ABUT, "run", SCENE, "--out", self.out, "--force", "--quiet")
        self.assertEqual(self.end(again).returncode, 0)
        self.assertEqual(self.state_when(lambda told: told["ended"])["badge"][0], "completed")

    def test_a_run_elsewhere_is_not_told_as_killed(self):
        """Process ids of another machine say nothing here."""
        self.succeed(self.abut("run", SCENE, "--out", self.out, "--local", "--quiet"))
        run = self.start(ABUT, "run", *LONG, "--out", self.folder / "other")
        other = self.folder / "other" / "progress.json"
        while not other.exists():
            time.sleep(0.02)
        told = strict_json(other.read_text(encoding="utf-8"))
        run.send_signal(signal.SIGINT)
        self.end(run)
        told["machine"]["boot"] = "another"
        (self.out / "progress.json").write_text(json.dumps(told), encoding="utf-8")
        (self.out / "summary.json").unlink()
        self.monitor(self.out)
        said = self.state()
        self.assertEqual(said["badge"][0], "runs elsewhere")
        self.assertIn("not" if "no sign" in said["badge"][2] else "another machine",
                      said["badge"][2])
        self.assertNotIn("of a core", said["bodies"]["heads"])

    def test_a_run_that_is_watched_has_the_bits_of_one_that_is_not(self):
        fields = ["--set", "output.fields.every=20", "--set", "time.window=1.0e-6"]
        alone, watched = self.folder / "alone", self.folder / "watched"
        self.abut("run", SCENE, "--out", alone, *fields)
        run = self.start(ABUT, "run", SCENE, "--out", watched, "--trace", *fields)
        while not (watched / "progress.json").exists() and run.poll() is None:
            time.sleep(0.01)
        self.monitor(watched)
        while run.poll() is None:
            self.state()
        run.communicate()
        self.assertEqual(self.summary(alone)["state_hash"], self.summary(watched)["state_hash"])
        for name in ("history.csv", "events.jsonl", "fields.pvd"):
            self.assertEqual((alone / name).read_bytes(), (watched / name).read_bytes(), name)


class AfterIt(Monitored):
    def setUp(self):
        super().setUp()
        self.succeed(self.abut("run", SCENE, "--out", self.out, "--local", "--quiet",
                               "--set", "output.fields.every=10"))

    def test_the_run_and_its_bodies_are_there(self):
        self.monitor(self.out)
        told = self.state_when(lambda told: told["moving"] > 0)
        self.assertEqual((told["part"], told["ended"], told["badge"][0]), (1.0, True, "completed"))
        self.assertEqual([event["kind"] for event in told["events"]],
                         ["contact opened", "contact closed"])
        bodies = json.loads(self.ask("/bodies")[1])["data"]
        self.assertEqual([body["name"] for body in bodies["bodies"]], ["left", "right"])
        names = [figure["name"] for figure in told["figures"]]
        self.assertLessEqual({"force", "energy", "gap", "iterations"}, set(names))
        peak = max(max(curve["y"]) for figure in told["figures"] if figure["name"] == "force"
                   for curve in figure["curves"])
        rows = (self.out / "history.csv").read_text(encoding="utf-8").splitlines()
        at = [name.split(" ")[0] for name in rows[0].split(",")].index("left.tip.force")
        # Cells are exact; pages round to seven digits.
        self.assertAlmostEqual(peak, max(-float(row.split(",")[at]) for row in rows[1:]),
                               delta=1e-6 * peak)

    def test_nothing_else_is_told_and_nobody_else_is_told_it(self):
        (self.out / "secret.txt").write_text("secret", encoding="utf-8")
        before = {path: path.stat().st_mtime_ns for path in self.out.rglob("*")}
        self.monitor(self.out)
        for path in ("/secret.txt", "/history.csv", "/summary.json", "/../../etc/passwd",
                     "/%2e%2e/secret.txt", "/state/", "/index.html"):
            answer, body = self.ask(path)
            self.assertEqual(answer.status, 404, path)
            self.assertNotIn(b"secret", body)
        for method in ("POST", "PUT", "DELETE", "OPTIONS", "HEAD", "BREW"):
            self.assertEqual(self.ask("/", method)[0].status, 405, method)
        for host in ("evil.example", "127.0.0.1.evil.example", f"evil.example:{self.port}",
                     "localhost.evil.example", "127.0.0.1@evil.example"):
            for path in ("/", "/state", "/bodies"):
                self.assertEqual(self.ask(path, host=host)[0].status, 403, host)
        # Another port of this machine, as ssh -L makes one, is this machine.
        for host in ("localhost:9000", "127.0.0.1", "[::1]:9000", "LOCALHOST"):
            self.assertEqual(self.ask("/", host=host)[0].status, 200, host)
        for query in ("since=x", "until=y", "since=1e3"):
            self.assertEqual(self.ask(f"/state?{query}")[0].status, 400, query)
        policy = self.ask("/")[0].getheader("Content-Security-Policy")
        self.assertIn("default-src 'none'", policy)
        self.assertNotIn("http", policy)
        self.assertEqual({path: path.stat().st_mtime_ns for path in self.out.rglob("*")}, before)

    def test_it_listens_on_this_machine_alone(self):
        self.monitor(self.out)
        port = f":{self.port:04X}"
        lines = Path("/proc/net/tcp").read_text(encoding="ascii").splitlines()
        places = {line.split()[1].removesuffix(port) for line in lines
                  if line.split()[1].endswith(port) and line.split()[3] == "0A"}
        self.assertEqual(places, {"0100007F"})

    def test_damaged_files_are_told_and_the_monitor_stays(self):
        with (self.out / "history.csv").open("a", encoding="utf-8") as file:
            file.write("not,a,row\n")
        self.monitor(self.out)
        self.assertIn("history.csv", self.state()["trouble"])
        (self.out / "summary.json").write_text("{", encoding="utf-8")
        told = self.state_when(lambda told: "fault" in told)
        self.assertIn("summary.json", told["fault"])
        self.assertEqual(self.ask("/")[0].status, 200)


class Refused(Monitored):
    def refusal(self, *words: object, code: int = 2) -> str:
        result = self.abut("monitor", *words)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        return result.stderr

    def test_what_is_no_run(self):
        self.assertIn("is not there", self.refusal(self.folder / "nothing"))
        (self.folder / "file").write_text("x", encoding="utf-8")
        self.assertIn("is no folder", self.refusal(self.folder / "file"))
        (self.folder / "empty").mkdir()
        self.assertIn("holds no run", self.refusal(self.folder / "empty"))
        self.assertIn("ssh -L", self.refusal("tcp://there:5555"))

    def test_a_port_that_is_none_or_taken(self):
        self.succeed(self.abut("run", SCENE, "--out", self.out, "--local", "--quiet"))
        for port in ("x", "-1", "70000"):
            self.assertEqual(self.abut("monitor", self.out, "--port", port).returncode, 2)
        self.monitor(self.out)
        self.assertIn(f"port {self.port} cannot be had",
                      self.refusal(self.out, "--port", self.port))

    @unittest.skipIf(os.geteuid() == 0, "root may read everything")
    def test_a_folder_that_may_not_be_read(self):
        self.succeed(self.abut("run", SCENE, "--out", self.out, "--local", "--quiet"))
        self.out.chmod(0)
        self.addCleanup(self.out.chmod, 0o700)
        self.assertIn("cannot be read", self.refusal(self.out))


class LongTables(unittest.TestCase):
    """Of many rows few are kept, each as it was written, the largest among them."""

    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.path = Path(holder.name) / "history.csv"
        self.path.write_text("time [s],a.p.force [N],a.kinetic [J],a.stored [J],i.iterations\n",
                             encoding="utf-8")

    def write(self, first: int, count: int):
        with self.path.open("a", encoding="utf-8") as file:
            for k in range(first, first + count):
                force = 1000.0 if k == 12_345 else k % 7
                file.write(f"{k},{force},{k % 11},{k % 13},{9 if k == 54_321 else 1}\n")

    def test_peaks_stay_and_rows_are_true(self):
        table, rows = GrowingTable(self.path), 100_000
        for first in range(0, rows, 20_000):
            self.write(first, 20_000)
            table.look(60.0)
        kept = table.table()
        self.assertEqual(table.rows, rows)
        self.assertLess(len(kept["time"]), 8 * 2 * STRETCHES)  # of each what is watched, at most
        self.assertEqual((kept["time"][0], kept["time"][-1]), (0.0, rows - 1.0))
        self.assertIn(12_345.0, kept["time"])
        self.assertIn(54_321.0, kept["time"])
        for time_, force in zip(kept["time"], kept["a.p.force"]):
            self.assertEqual(force, 1000.0 if time_ == 12_345 else time_ % 7)

    def test_a_row_that_is_being_written_waits(self):
        table = GrowingTable(self.path)
        with self.path.open("a", encoding="utf-8") as file:
            file.write("0,1,1,1,1\n1,2,")
        self.assertEqual(table.look(1.0), 1)
        with self.path.open("a", encoding="utf-8") as file:
            file.write("2,2,2\n")
        self.assertEqual(table.look(1.0), 1)
        self.assertEqual(table.latest.cells, [1.0, 2.0, 2.0, 2.0, 2.0])

    def test_a_table_that_was_cut_or_replaced_is_read_anew(self):
        table = GrowingTable(self.path)
        self.write(0, 100)
        table.look(1.0)
        text = self.path.read_text(encoding="utf-8")
        self.path.write_text(text[: len(text) // 2], encoding="utf-8")
        self.assertRaises(Replaced, table.look, 1.0)
        other = self.path.with_name("other")
        other.write_text(text * 2, encoding="utf-8")
        other.rename(self.path)
        self.assertRaises(Replaced, table.look, 1.0)


class Page(Monitored):
    """In a browser: what is drawn of a run as it goes on, and what becomes of it when it ends."""

    def test_it_is_drawn_and_goes_on(self):
        from live_browser import LivePage  # pylint: disable=import-outside-toplevel
        run = self.long_run("--set", "output.fields.every=1000")
        self.monitor(self.out)
        address = f"http://{HOST}:{self.port}/"
        with LivePage() as page:
            for width, dark in ((1920, False), (390, True)):
                page.open(address, width, dark=dark)
                page.wait("document.body && document.body.dataset.looks > 2 && "
                          "document.querySelectorAll('#figures canvas').length > 5 && seen.stage")
                page.value("tell()")
                told = json.loads(page.value("JSON.stringify(document.body.dataset)"))
                self.assertEqual(told["failures"], "", (width, dark))
                self.assertEqual(told["drawn"], told["figures"], (width, dark))
                before = page.value("Object.values(seen.figures)[0].figure.curves[0].x.length")
                far = page.value("document.getElementById('far').value")
                page.wait(f"document.getElementById('far').value > {far}")
                page.wait("Object.values(seen.figures)[0].figure.curves[0].x.length != "
                          f"{before}")
            moved = page.value("seen.moving")
            page.wait(f"seen.moving > {moved} && seen.stage.data.times.length > 4")
            self.assertTrue(page.value("seen.stage.state === seen.stage.data.times.length - 1"))
            page.value("seen.stage.show(1)")
            time_ = page.value("seen.stage.data.times[seen.stage.state]")
            run.send_signal(signal.SIGINT)
            self.end(run)
            page.wait("document.getElementById('badge').textContent === 'interrupted'")
            self.assertGreaterEqual(page.value("seen.stage.data.times[seen.stage.state]"), time_)
            self.assertLess(page.value("seen.stage.state"),
                            page.value("seen.stage.data.times.length") - 1)
            self.assertEqual(page.said, [])


if __name__ == "__main__":
    if sys.argv[3:4] == ["--browser"]:
        if not browser.is_there():
            print("skipped: chromium is not installed")
            sys.exit(browser.SKIPPED)
        sys.argv[3:4] = ["Page"]
    elif len(sys.argv) == 3:  # all but the browser
        sys.argv += ["WhileItGoesOn", "AfterIt", "Refused", "LongTables"]
    main()
