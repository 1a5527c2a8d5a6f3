"""Goal: what a run's wall time went into can be read in Perfetto, and is true. Oracles: spans that
nest and follow each other; the shares that the run itself tells; the run without a trace, bit for
bit.

usage: test_trace.py ABUT ROOT [CLASS]
"""

import bisect
import collections
import os
import re
import signal
import time

from support import ABUT, ROOT, SystemTest, main, strict_json

SCENES = ROOT / "configs"
WINDOWS = ("window", "flight", "passive window")
MICRO = 1e-6
# [us] Times in the file have three digits of microseconds: exact nanoseconds of the clock.
ROUNDING = 1e-3


class Trace(SystemTest):
    def read(self) -> list:
        return strict_json((self.out / "trace.json").read_text(encoding="utf-8"))

    def traced(self, scene: str, *options: object, code: int = 0) -> list:
        result = self.abut("run", SCENES / scene, "--out", self.out, "--trace", *options)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertIn(f"trace  {self.out}/trace.json", result.stdout)
        return self.read()

    def tracks(self, events: list) -> dict:
        """Spans by track, in the order in which they begin."""
        names = {event["tid"]: event["args"]["name"] for event in events
                 if event["name"] == "thread_name"}
        spans = collections.defaultdict(list)
        for event in events:
            if event["ph"] == "X":
                self.assertGreaterEqual(event["dur"], 0.0)
                spans[names[event["tid"]]].append(event)
        for each in spans.values():
            each.sort(key=lambda event: (event["ts"], -event["dur"]))
        return spans

    def assert_nests(self, spans: list) -> list:
        """Every span lies in another one or beside it; pairs of a span and the one around it."""
        pairs, around = [], []
        for span in spans:
            end = span["ts"] + span["dur"]
            while around and around[-1]["ts"] + around[-1]["dur"] <= span["ts"] + ROUNDING:
                around.pop()
            if around:
                self.assertLessEqual(end, around[-1]["ts"] + around[-1]["dur"] + ROUNDING,
                                     f"{span} leaves {around[-1]}")
            pairs.append((span, around[-1] if around else None))
            around.append(span)
        return pairs

    def assert_sums(self, tracks: dict):
        timing = self.summary()["timing"]
        for body, seconds in timing["compute_s"].items():
            told = [span["dur"] for span in tracks[body] if span["name"] == "computes"]
            # The same numbers, each rounded to a nanosecond.
            self.assertAlmostEqual(MICRO * sum(told), seconds, delta=1e-9 * (1 + len(told)))
        self.assert_waits(tracks, timing["waited_s"])

    def assert_waits(self, tracks: dict, wanted: dict):
        """While several bodies compute they share the time by what each takes."""
        waits = [span for span in tracks["coordinator"] if span["name"] == "waits"]
        begins = [wait["ts"] for wait in waits]
        took = [collections.Counter() for _ in waits]
        for body in wanted:
            for span in tracks[body]:
                if span["name"] in ("computes", "probe"):
                    took[bisect.bisect_right(begins, span["ts"] + ROUNDING) - 1][body] += \
                        span["dur"]
        waited = collections.Counter()
        for wait, each in zip(waits, took):
            whole = sum(each.values())
            for body, share in each.items():
                waited[body] += share * min(1.0, wait["dur"] / whole)
        for body, seconds in wanted.items():
            # Meter and trace read the clock one after the other: some microseconds a call, of a
            # busy machine that takes the core away in between a millisecond.
            calls = sum(span["name"] in ("advance", "probe") for span in tracks[body])
            self.assertAlmostEqual(MICRO * waited[body], seconds, delta=5e-6 * calls + 4e-3,
                                   msg=body)


class OfRuns(Trace):
    def test_spans_nest_and_their_sums_are_the_shares_of_the_run(self):
        for placement in ([], ["--local"], ["--set", "network.processes=1"]):
            with self.subTest(placement=placement):
                tracks = self.tracks(self.traced("two_bars.yaml", "--force", *placement))
                self.assertEqual(set(tracks), {"coordinator", "left", "right"})
                pairs = {name: self.assert_nests(spans) for name, spans in tracks.items()}
                self.assert_sums(tracks)
                for name in ("left", "right"):
                    for span, around in pairs[name]:
                        self.assertEqual(span["name"] == "computes", around is not None)
                inside = {"iteration": "island", "island": "window"}
                for span, around in pairs["coordinator"]:
                    if span["name"] in inside:
                        self.assertEqual(around["name"], inside[span["name"]])

    def test_windows_and_iterations_are_those_of_the_run(self):
        tracks = self.tracks(self.traced("two_bars.yaml"))
        spans = tracks["coordinator"]
        measures = self.summary()["measures"]
        iterations = [span for span in spans if span["name"] == "iteration"]
        self.assertEqual(max(span["args"]["number"] for span in iterations),
                         measures["schwarz.iterations_max"])
        self.assertEqual({span["args"]["of"] for span in spans if span["name"] == "island"},
                         {"left, right"})
        calls = sum(span["name"] in ("advance", "probe") for body in ("left", "right")
                    for span in tracks[body])
        self.assertEqual(calls, self.summary()["exchanges"])
        # One after the other they cover the time of the scene.
        times = [(span["args"]["from_s"], span["args"]["to_s"]) for span in spans
                 if span["name"] in WINDOWS]
        self.assertAlmostEqual(times[0][0], -2.0e-4, delta=1e-12)
        self.assertAlmostEqual(times[-1][1], 8.0e-4, delta=1e-12)

    def test_passive_windows_checkpoints_and_fields_are_told(self):
        events = self.traced("robust/one_cell_each.yaml", "--set",
                             "output.checkpoint={windows: 5}", "--set", "output.fields.every=5")
        tracks = self.tracks(events)
        for spans in tracks.values():
            self.assert_nests(spans)
        names = collections.Counter(span["name"] for spans in tracks.values() for span in spans)
        passive = self.summary()["accuracy"]["given_up"]["passive_windows"]
        self.assertGreater(passive, 0)
        self.assertEqual(names["passive window"], passive)
        for name in ("checkpoint", "state", "fields", "passive step", "records", "start", "end"):
            self.assertGreater(names[name], 0, name)
        asked = sum(span["name"] in ("advance", "probe") or span["name"].startswith("passive ")
                    for name, spans in tracks.items() if name != "coordinator" for span in spans)
        self.assertEqual(asked, self.summary()["exchanges"])

    def test_a_trace_changes_nothing(self):
        plain = self.folder / "plain"
        for scene in ("two_bars.yaml", "robust/one_cell_each.yaml"):
            self.traced(scene, "--force")
            self.abut("run", SCENES / scene, "--out", plain, "--force")
            self.assertEqual(self.summary()["state_hash"], self.summary(plain)["state_hash"])
            self.assertEqual((self.out / "history.csv").read_bytes(),
                             (plain / "history.csv").read_bytes())
            self.assertFalse((plain / "trace.json").exists())


class OfEnds(Trace):
    LONG = [SCENES / "bars" / "tied_halves.yaml", "--set", "time.end=100.0"]

    def started(self):
        run = self.start(ABUT, "run", *self.LONG, "--out", self.out, "--trace")
        self.addCleanup(run.kill)
        until = time.monotonic() + 10.0
        while not (self.out / "progress.json").exists():
            self.assertLess(time.monotonic(), until)
            time.sleep(0.02)
        time.sleep(1.2)
        return run

    def test_an_interrupted_run_has_a_whole_one_and_a_resumed_run_a_new_one(self):
        run = self.started()
        run.send_signal(signal.SIGINT)
        self.assertEqual(self.end(run).returncode, 130)
        tracks = self.tracks(self.read())
        for spans in tracks.values():
            self.assert_nests(spans)
        self.assert_sums(tracks)
        self.assertIn("end", [span["name"] for span in tracks["coordinator"]])
        reached = self.summary()["time"]["reached"]
        self.succeed(self.abut("resume", self.out, "--end", str(reached + 0.01), "--trace"))
        windows = [span for span in self.tracks(self.read())["coordinator"]
                   if span["name"] in WINDOWS]
        self.assertAlmostEqual(windows[0]["args"]["from_s"], reached, delta=1e-9)

    def test_a_killed_run_leaves_whole_json(self):
        self.leaves_sockets = True
        run = self.started()
        run.kill()
        run.communicate()
        for spans in self.tracks(self.read()).values():
            self.assert_nests(spans)

    def test_a_lost_body_is_a_request_without_an_answer(self):
        run = self.started()
        solver = self.solvers(3)[1]
        os.kill(solver, signal.SIGKILL)
        self.assertEqual(self.end(run).returncode, 3)
        events = self.read()
        for spans in self.tracks(events).values():
            self.assert_nests(spans)
        names = [event["name"] for event in events]
        self.assertIn("no answer", names)
        self.assertTrue(any(name.startswith("failure") for name in names))

    def test_a_link_of_that_name_is_not_followed(self):
        self.succeed(self.abut("run", SCENES / "two_bars.yaml", "--out", self.out, "--quiet"))
        other = self.folder / "other"
        other.write_text("mine", encoding="utf-8")
        (self.out / "trace.json").symlink_to(other)
        result = self.abut("run", SCENES / "two_bars.yaml", "--out", self.out, "--force", "--trace")
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(other.read_text(encoding="utf-8"), "mine")


class Reported(Trace):
    def test_a_page_says_who_took_the_time(self):
        self.succeed(self.abut("run", SCENES / "two_bars.yaml", "--out", self.out, "--quiet"))
        self.succeed(self.abut("report", self.out))
        page = (self.out / "report.html").read_text(encoding="utf-8")
        told = re.search(r'aria-label="Shares of the time: ([^"]*)"', page)[1]
        shares = dict(part.rsplit(" ", 2)[:2] for part in told.split(", "))
        timing = self.summary()["timing"]
        for body, seconds in timing["waited_s"].items():
            # Shown are whole per cent, below ten with one more digit.
            self.assertAlmostEqual(float(shares[body]), 100.0 * seconds / timing["wall_s"],
                                   delta=0.5)
        self.assertAlmostEqual(sum(map(float, shares.values())), 100.0, delta=0.5 * len(shares))


if __name__ == "__main__":
    main()
