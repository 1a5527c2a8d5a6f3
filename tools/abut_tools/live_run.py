"""A run that may still go on: how far it is, and what it has told since a reader's last look."""

import json
import math
import time
from pathlib import Path

from abut_tools.growing import GrowingFile, GrowingTable, Replaced
from abut_tools.processes import Usage, alive, same_machine
from abut_tools.run_figures import figures_of, force_figure
from abut_tools.run_files import (EVENT, FLAG, NUMBER, SUMMARY, TEXT, VALUE, is_there, parsed,
                                  read_json)
from abut_tools.run_folder import RunView
from abut_tools.tables import Table, ToolError, scaled_unit, thinned
from abut_tools.units import Units

PROCESS = {"!id": NUMBER, "!began": TEXT, "bodies": [TEXT]}
PROGRESS = {
    **{key: SUMMARY[key] for key in ("title", "units", "bodies", "ports", "interfaces")},
    "!written": NUMBER, "!opened": NUMBER, "!wall_s": NUMBER, "left_s": VALUE,
    "!time": {"!begin": NUMBER, "!end": NUMBER, "!reached": NUMBER}, "!windows": NUMBER,
    "!exchanges": NUMBER, "!in_contact": NUMBER, "!iterations": NUMBER, "!local": FLAG,
    "!of_bodies": {"*": {"!exchanges": NUMBER, "!waited_s": NUMBER}},
    "!machine": {"boot": TEXT, "process_ids": TEXT}, "!program": PROCESS, "!processes": [PROCESS]}
SCENE, SUMMARY_FILE, PROGRESS_FILE = "scene.resolved.yaml", "summary.json", "progress.json"
POINTS = 1200        # of a curve that is told whole
EVENTS = 40          # that a page shows
RATE_OVER = 5.0      # [s] that exchanges are counted over
READING = 0.6        # [s] that one look reads records for: a page is not kept waiting
SILENT = 60.0        # [s] after which a run elsewhere counts as silent
FACTS = ("title", "units", "bodies", "ports", "interfaces", "status", "reason", "expectations",
         "notes", "measures", "never_closed", "overlaps", "accuracy")


def whole_json(path: Path, kind: object) -> dict | None:
    """None: it is not there, or went away meanwhile."""
    try:
        return read_json(path, kind) if is_there(path) else None
    except ToolError:
        if not path.exists():
            return None
        raise


def being_set_up(folder: Path) -> bool:
    """Whether a run holds the folder that has written nothing yet."""
    try:
        inode = f":{folder.stat().st_ino} "
        return any("FLOCK" in line and inode in line for line in
                   Path("/proc/locks").read_text(encoding="ascii").splitlines())
    except OSError:
        return False


def holds_run(folder: Path) -> bool:
    return any(is_there(folder / name) for name in (SCENE, SUMMARY_FILE, PROGRESS_FILE,
                                                    "history.csv"))


class Status:
    """What is known of the run as a whole at a look."""

    def __init__(self, folder: Path, silent: float):
        self.progress = whole_json(folder / PROGRESS_FILE, PROGRESS)
        self.summary = whole_json(folder / SUMMARY_FILE, SUMMARY)
        here = bool(self.progress) and same_machine(self.progress["machine"])
        lives = here and alive(self.progress["program"])
        self.ended = self.summary is not None and not lives
        self.processes_seen = here
        if self.ended:
            self.state = "ended"
        elif self.progress is None:
            self.state = "set up" if being_set_up(folder) else "unknown"
        elif here:
            self.state = "runs" if lives else "killed"
        else:
            self.state = "elsewhere" if silent < SILENT else "silent"

    def began(self) -> float | None:
        return self.progress["opened"] if self.progress else None

    def facts(self) -> dict:
        told = self.summary if self.ended else self.progress or self.summary or {}
        return {key: told[key] for key in FACTS if key in told}


class LiveRun:
    """What is on the disk, and with which number of a look each part of it has come."""

    def __init__(self, folder: Path):
        self.folder = folder
        self.usage = Usage()
        self.began, self.changed = None, time.monotonic()  # of the progress that was read last
        self.version = 0
        self.read_anew()

    def read_anew(self) -> None:
        self.history = GrowingTable(self.folder / "history.csv")
        self.event_file = GrowingFile(self.folder / "events.jsonl")
        self.events, self.event_count, self.warnings = [], 0, 0
        self.rates, self.written = [], None
        self.figures, self.shape, self.beside = {}, {}, ""
        self.version += 1
        self.reborn = self.version      # with this look all that a page has is void
        self.turned, self.trouble, self.table = 0, "", None

    def look(self) -> None:
        """Reads what is new."""
        self.status = Status(self.folder, time.monotonic() - self.changed)
        began = self.status.began()
        if began is not None and began != self.began:
            if self.began is not None:
                self.read_anew()
            self.began = began
        try:
            fresh = self.history.look(READING) > 0
            self.read_events()
            self.trouble = ""
        except Replaced:
            self.read_anew()
            return
        except ToolError as error:
            self.trouble = str(error)
            fresh = False
        self.see_progress()
        if fresh or not self.figures:
            self.version += 1
            self.table = None
            self.make_figures()

    def read_events(self) -> None:
        for line in self.event_file.lines():
            event = parsed_event(line)
            self.event_count += 1
            self.warnings += event.get("kind") == "warning"
            self.events = [*self.events, {**event, "number": self.event_count}][-EVENTS:]

    def see_progress(self) -> None:
        progress = self.status.progress
        if not progress or progress["written"] == self.written:
            return
        self.written, self.changed = progress["written"], time.monotonic()
        self.rates.append((progress["wall_s"], progress["exchanges"]))
        while len(self.rates) > 2 and self.rates[-1][0] - self.rates[1][0] >= RATE_OVER:
            self.rates.pop(0)

    # ---- curves ----------------------------------------------------------

    def view(self) -> RunView:
        if self.table is None:
            self.table = self.history.table()
        facts = self.status.facts()
        return RunView({"status": "unfinished", "title": self.title(), **facts}, self.table, None,
                       self.events)

    def title(self) -> str:
        return self.status.facts().get("title") or \
            self.folder.resolve().name.encode("utf-8", "replace").decode()

    def time_scale(self) -> tuple[float, str]:
        """That of the whole run: axes do not change on the way."""
        known = self.status.progress or self.status.summary or {}
        ends = [abs(t) for t in (known.get("time", {}).get("begin"),
                                 known.get("time", {}).get("end")) if t]
        if not ends and self.history.latest:
            ends = [abs(self.history.latest.cells[0])]
        return scaled_unit(max(ends, default=0.0), self.units().word("s"))

    def units(self) -> Units:
        return Units(self.status.facts().get("units"))

    def make_figures(self) -> None:
        """Which curves there are, how they look, and since which look they do."""
        scale = self.time_scale()
        whole = self.turned != self.history.turned
        self.turned = self.history.turned
        figures, drawn = {}, figures_of(self.view())
        force = force_figure(drawn)
        self.beside = force.name if force else ""
        for figure in drawn:
            told = figure.data(10 ** 9, scale)
            shape = json.dumps([told["label"], told["unit"], figure.title, told["time"],
                                [(c["label"], c["colour"], c["dash"]) for c in told["curves"]]])
            if whole or self.shape.get(figure.name, ("",))[0] != shape:
                self.shape[figure.name] = (shape, self.version)
            figures[figure.name] = {**told, "title": figure.title}
        self.figures = figures

    def told_figures(self, since: int, until: float) -> list[dict]:
        """Of a page that has the look `since`, up to the time `until`: whole ones, or what has come
        since. Rows between were written since then, as times ascend."""
        out = []
        for name, figure in self.figures.items():
            whole = since < max(self.shape[name][1], self.reborn)
            curves = []
            for curve in figure["curves"]:
                first = 0
                if not whole:
                    first = next((k for k in range(len(curve["x"]), 0, -1)
                                  if curve["x"][k - 1] <= until), 0)
                x, y = thinned(curve["x"][first:], curve["y"][first:], POINTS)
                curves.append({**curve, "x": x, "y": y})
            out.append({**figure, "whole": whole, "curves": curves})
        return out

    def latest(self) -> float:
        """Time of the latest record, in units of the axes; as curves round it."""
        if not self.history.latest:
            return -math.inf
        return float(f"{self.history.latest.cells[0] * self.time_scale()[0]:.8g}")


def parsed_event(line: str) -> dict:
    try:
        return parsed(line, EVENT)
    except ValueError as error:
        raise ToolError(f"events.jsonl: {error}", 2) from error
