"""Runs of a study: each in a folder of its own, kept when it is done, several at once."""

import concurrent.futures
import functools
import hashlib
import json
import re
import shutil
import statistics
import subprocess
import sys
import threading
import time
from pathlib import Path

from abut_tools import study_process
from abut_tools.page import write_whole
from abut_tools.study_file import COSTS, Point, Study
from abut_tools.study_take import figures_for, take
from abut_tools.tables import ToolError
from abut_tools.yaml_text import flow_text

TABLES = ("history.csv", "closed_form.csv")
KEPT_BYTES = 10_000_000  # larger tables are deleted once their numbers are taken
SUMMARY_KEYS = ("measures", "closed_form", "timing", "status", "versions", "exchanges", "windows",
                "bodies", "notes", "state_hash", "units")


def digest(*parts: object) -> str:
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()[:16]


@functools.cache  # what a study begins with holds for all its runs
def digest_of_file(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else ""


NAMED_FILE = re.compile(r"""\bfile: *("[^"]*"|'[^']*'|[^\s,{}\[\]"'#]+)""")


def files_of(point: Point) -> list[Path]:
    """Meshes and tables that its scene and its settings name, relative to the scene."""
    texts = [point.scene.read_text(encoding="utf-8")]
    texts += [f"{key.rsplit('.', 1)[-1]}: {flow_text(value)}"
              for key, value in point.settings.items()]
    names = {name.strip("\"'") for text in texts for name in NAMED_FILE.findall(text)}
    return [point.scene.parent / name for name in sorted(names)]


class Progress:
    """A bar with the remaining time on a terminal, a line per run elsewhere."""

    def __init__(self, total: int, quiet: bool = False):
        self.total, self.done, self.quiet = total, 0, quiet
        self.started, self.timed, self.lock = time.monotonic(), 0, threading.Lock()
        self.live = sys.stderr.isatty()
        if self.live and not quiet:
            self.draw("")  # the first run may take a while

    def step(self, label: str, status: str, fresh: bool) -> None:
        with self.lock:
            self.done += 1
            self.timed += fresh
            if self.quiet:
                return
            if not self.live:
                how = status if fresh else f"{status}, from before"
                print(f"{self.done}/{self.total}  {label}: {how}", file=sys.stderr, flush=True)
                return
            left = ""
            if self.timed:
                seconds = (time.monotonic() - self.started) / self.timed * (self.total - self.done)
                left = f"  {int(seconds) // 60}:{int(seconds) % 60:02d} left"
            self.draw(f"{left}  {label}")

    def draw(self, words: str) -> None:
        part = 30 * self.done // self.total
        bar = "#" * part + "-" * (30 - part)
        columns = shutil.get_terminal_size().columns
        line = f"[{bar}] {self.done}/{self.total}{words}"
        print(f"\r\033[K{line[:columns - 1]}", end="", file=sys.stderr, flush=True)

    def close(self) -> None:
        if self.live and not self.quiet:
            print("\r\033[K", end="", file=sys.stderr, flush=True)


class Runner:
    def __init__(self, study: Study, abut: Path, out: Path, timed: bool, force: bool):
        self.study, self.abut, self.out, self.timed, self.force = study, abut, out, timed, force
        self.programs = [digest_of_file(abut), digest_of_file(abut.with_name("abut-solver"))]
        self.stop = threading.Event()
        self.reference_folder = None

    def identity(self, point: Point) -> str:
        return digest(point.scene.read_text(encoding="utf-8"), list(point.settings.items()),
                      self.study.placement, self.programs,
                      [digest_of_file(path) for path in files_of(point)])

    def definition(self, point: Point) -> str:
        """Of what is taken from tables that may be gone afterwards."""
        errors = [(e.name, e.history, e.norm, e.relative_to, e.against) for e in self.study.errors
                  if e.history]
        return digest(errors, figures_for(self.study, point.label),
                      self.reference_folder.name if self.reference_folder else "")

    def folder(self, point: Point) -> Path:
        words = f"{point.sweep} {point.label}" if point.sweep else point.label
        name = re.sub(r"[^a-z0-9.]+", "_", words.lower()).strip("_")[:60]
        return self.out / "runs" / f"{name}-{self.identity(point)}"

    def command(self, point: Point, folder: Path) -> list[str]:
        words = [str(self.abut), "run", str(point.scene), "--quiet", "--force", "--out",
                 str(folder)]
        words += ["--local"] if self.study.placement == "local" else []
        for key, value in point.settings.items():
            words += ["--set", f"{key}={flow_text(value)}"]
        return words

    def found(self, point: Point, folder: Path) -> dict | None:
        """What an earlier study left, when it is this run, complete and timed if it must be."""
        try:
            record = json.loads((folder / "run.json").read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return None
        if self.force or record["id"] != self.identity(point) or record["status"] == "lost":
            return None
        if self.timed and record["status"] != "refused":
            if not record["timed"] or len(record["walls"]) < point.repeats:
                return None
        if record["taken"] == self.definition(point):
            return record
        if record["status"] == "completed" and not all((folder / t).is_file() for t in TABLES[:1]):
            return None
        return self.finish(point, folder, record) if record["status"] == "completed" else record

    def finish(self, point: Point, folder: Path, record: dict) -> dict:
        """Takes what is needed from the tables and writes the record, which makes the run done."""
        taken = take(self.study, point.label, folder, self.reference_folder)
        record["history_errors"], record["taken"] = taken["errors"], self.definition(point)
        write_whole(folder / "curves.json", json.dumps(taken["curves"]))
        if point.kind == "run":
            for name in TABLES:
                table = folder / name
                if table.is_file() and table.stat().st_size > KEPT_BYTES:
                    table.unlink()
        write_whole(folder / "run.json", json.dumps(record, indent=1))
        return record

    def one(self, point: Point, progress: Progress) -> dict:
        folder = self.folder(point)
        record = self.found(point, folder)
        fresh = record is None
        if fresh:
            record = self.execute(point, folder)
        progress.step(point.label, record["status"], fresh)
        return {**record, "folder": str(folder.relative_to(self.out))}

    def execute(self, point: Point, folder: Path) -> dict:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "run.json").unlink(missing_ok=True)
        command = self.command(point, folder)
        record = {"id": self.identity(point), "command": command, "timed": self.timed,
                  "walls": [], "memory_mib": None, "message": "", "taken": "", "summary": {}}
        computes, repeats = [], point.repeats if self.timed else 1
        while len(record["walls"]) < repeats:
            ended = study_process.run(command, self.study.time_limit, self.stop)
            if self.stop.is_set():
                raise KeyboardInterrupt
            record["status"], record["message"] = self.judged(ended, folder)
            seen = [each for each in (ended.memory_mib, record["memory_mib"]) if each is not None]
            record["memory_mib"] = max(seen, default=None)
            if record["status"] != "completed":
                break
            summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
            record["walls"].append(summary["timing"]["wall_s"])
            computes.append(sum(summary["timing"]["compute_s"].values()))
        if record["status"] in ("completed", "failed") and (folder / "summary.json").is_file():
            summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
            record["summary"] = {key: summary[key] for key in SUMMARY_KEYS if key in summary}
        record["compute_s"] = statistics.median(computes) if computes else None
        if record["status"] == "completed":
            return self.finish(point, folder, record)
        record["history_errors"], record["taken"] = {}, self.definition(point)
        write_whole(folder / "run.json", json.dumps(record, indent=1))
        return record

    def judged(self, ended: study_process.Ended, folder: Path) -> tuple[str, str]:
        """Status and message. Expectations of the base scene say nothing about other settings."""
        lines = [line for line in ended.said.splitlines() if "error:" in line]
        message = "\n".join(line.split("error:", 1)[1].strip() for line in lines) or ended.said
        if ended.code is None:
            return "failed", (f"not ended after {self.study.time_limit:g} s; give the study a "
                              "larger time_limit")
        if ended.code == 2:
            return "refused", message
        if ended.code in (0, 1):
            try:
                summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
            except (OSError, ValueError):
                return "failed", message or "no summary was written"
            if summary["status"] == "completed":
                return "completed", ""
            return summary["status"], message or "; ".join(summary.get("notes", []))
        return "lost", message or f"ended with code {ended.code}"

    def all(self, jobs: int, progress: Progress) -> tuple[list[dict], dict | None]:
        """Records in the order of the points, and that of the reference run."""
        reference = None
        if self.study.reference is not None:
            self.reference_folder = None
            reference = self.one(self.study.reference, progress)
            if reference["status"] != "completed":
                raise ToolError(f"the reference run is {reference['status']}: "
                                f"{reference['message']}", 2)
            self.reference_folder = self.folder(self.study.reference)
        with concurrent.futures.ThreadPoolExecutor(max_workers=jobs) as pool:
            futures = [pool.submit(self.one, point, progress) for point in self.study.points]
            try:
                records = [future.result() for future in futures]
            except BaseException:
                self.stop.set()
                for future in futures:
                    future.cancel()
                raise
        return records, reference


# ---- before the first run ------------------------------------------------------------


def accepts(abut: Path, point: Point, names: list[str]) -> tuple[bool, str]:
    """The program knows which measures a scene has; an expectation makes it say so."""
    expects = [{"measure": name, "at_most": 0, "because": "asked by the study"} for name in names]
    command = [str(abut), "check", str(point.scene), "--probe", "0"]  # names take no step
    for key, value in {**point.settings, "meta.expect": expects}.items():
        command += ["--set", f"{key}={flow_text(value)}"]
    try:
        ended = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    except subprocess.TimeoutExpired:  # large bodies on a busy machine: the run itself will tell
        return True, ""
    return ended.returncode == 0, ended.stderr.strip().split("there is no measure", 1)[-1]


def check_measures(study: Study, abut: Path) -> None:
    """A misspelt measure is found before an hour of runs; one scene that has it is enough."""
    own = {error.name for error in study.errors} | set(COSTS) | set(study.knobs)
    asked = [error.measure for error in study.errors if error.measure]
    asked += [check["value"] for claim in study.claims for check in claim["checks"]]
    asked += [column for figure in study.figures for column in figure.get("table", {}).values()]
    names = {name: expression.where for expression in reversed(asked) for name in expression.names
             if name not in own and not name.startswith("closed_form.")}
    scenes = {(point.scene, point.variant): point for point in reversed(study.points)}
    able = None
    for point in reversed(scenes.values()):
        if names and accepts(abut, point, list(names))[0]:
            return
        if not accepts(abut, point, [])[0]:
            continue
        able = point
        names = {name: where for name, where in names.items()
                 if not accepts(abut, point, [name])[0]}
        if not names:
            return
    for name, where in names.items() if able else ():
        said = accepts(abut, able, [name])[1].removeprefix(f" '{name}'.")
        raise ToolError(f"{where}: there is no measure '{name}'.{said}", 2)
