#!/usr/bin/python3
"""Measures speed against accuracy: runs a scene with many settings, compares cost with error.

docs/STUDIES.md tells how to write a study file. Needs Python's standard library, Debian's PyYAML
and, for the page, its Chart.js. Ends with 0 when every run ended as the study expects, 1 when one
was refused or failed that was not to, or when no run meets the target, 2 when the user can help, 3
when the machine must, 130 when interrupted: the same command goes on from there.
"""

import argparse
import os
import signal
import sys
import time
from pathlib import Path

try:
    import yaml  # noqa: F401  the modules below need it; here its absence becomes a sentence
except ImportError:
    print("abut study: PyYAML is not there. Install Debian's package python3-yaml.",
          file=sys.stderr)
    sys.exit(3)

from abut_tools.page import CHART_LIBRARY, fitting_page, named, write_whole
from abut_tools.scene_keys import nearest
from abut_tools.study_ends import command_of, exit_code, surprises, told
from abut_tools.study_file import Study, read_study
from abut_tools.study_output import facts_of, target_scene, write_results
from abut_tools.study_page import Shown, page_of
from abut_tools.study_results import Result, cheapest, cost_key, nearest_miss, results_of
from abut_tools.study_runs import Progress, Runner, check_measures
from abut_tools.study_units import units_of
from abut_tools.tables import ToolError, shown
from abut_tools.verb import ended
from abut_tools.version import TellVersion

HERE = Path(__file__).resolve()
CURVE_POINTS = 800


def options_of() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="abut study", description="Runs a scene with many settings; cost against error.",
        epilog="Ends with 0 when every run ended as the study expects, 1 when one did not or none "
        "meets the target, 2 when the study is refused, 3 when the machine failed.")
    parser.add_argument("study", type=Path, metavar="FILE", help="study file (docs/STUDIES.md)")
    parser.add_argument("--out", type=named, metavar="DIR", help="default: runs/<study name>")
    parser.add_argument("--serial", action="store_true",
                        help="one run after another, timed, with the study's repeats")
    parser.add_argument("--target", action="append", default=[], metavar="NAME=VALUE",
                        help="print the cheapest setting whose error NAME is at most VALUE, and "
                             "write its scene; repeatable, all must be met")
    parser.add_argument("--force", action="store_true", help="run again what is done already")
    parser.add_argument("--jobs", type=int, metavar="N",
                        help="runs at once (default: as many as cores allow)")
    parser.add_argument("--quick", action="store_true",
                        help="a short form: the first values of every knob, one repeat")
    parser.add_argument("--quiet", action="store_true", help="print errors and targets only")
    beside = Path(sys.argv[0]).resolve().with_name("abut")
    parser.add_argument("--abut", type=Path, default=beside, metavar="PROGRAM",
                        help="default: abut beside this program")
    parser.add_argument("--chart-library", type=Path, metavar="FILE", default=CHART_LIBRARY,
                        help="Chart.js 3 (default: that of Debian's package libjs-chart.js)")
    parser.add_argument("--version", action=TellVersion)
    options = parser.parse_args()
    if options.serial and options.jobs not in (None, 1):
        parser.error("--serial runs one after another: leave --jobs out")
    if options.jobs is not None and options.jobs < 1:
        parser.error("--jobs must be at least 1")
    return options


def targets_of(words: list[str], study: Study) -> dict[str, float]:
    names, targets = [error.name for error in study.errors], {}
    for word in words:
        name, equals, text = word.partition("=")
        if name not in names:
            raise ToolError(f"--target {word}: the study has no error '{name}'."
                            f"{nearest(name, names)} It has {', '.join(names)}.", 2)
        try:
            targets[name] = float(text)
        except ValueError:
            targets[name] = 0.0
        if not equals or not targets[name] > 0.0:
            raise ToolError(f"--target {word}: say {name}=VALUE with a number above 0, for "
                            f"example {name}=1e-3.", 2)
    return targets


def jobs_of(options: argparse.Namespace, study: Study) -> int:
    """A process for every body and one for the coordinator want a core each."""
    if options.serial:
        return 1
    if options.jobs is not None:
        return options.jobs
    cores = len(os.sched_getaffinity(0))
    return max(1, cores if study.placement == "local" else cores // 3)


def tell_target(out: Path, study: Study, results: list[Result], targets: dict) -> int:
    asked = " and ".join(f"{name} at most {value:g}" for name, value in targets.items())
    cost, found = cost_key(results), cheapest(results, targets)
    if found is None:
        print(f"no run has {asked}", file=sys.stderr)
        near = nearest_miss(results, targets)
        if near is not None:
            values = ", ".join(f"{name} {shown(near.errors[name])}" for name in targets)
            print(f"nearest: {near.label} with {values}", file=sys.stderr)
        return 1
    path = target_scene(out, study, found, targets)
    print(f"{asked}: {found.label}, {cost} {shown(found.cost[cost])}")
    for name in targets:
        print(f"  {name} {shown(found.errors[name])}")
    for key, value in found.point.settings.items():
        print(f"  {key} = {shown(value)}")
    print(f"scene  {path}\nrun    abut run {path}"
          f"{' --local' if study.placement == 'local' else ''}")
    return 0


def run_study(options: argparse.Namespace) -> int:
    started = time.monotonic()
    abut = options.abut.resolve()
    study = read_study(options.study, abut, options.quick)
    targets = targets_of(options.target, study)
    check_measures(study, abut)
    out = (options.out or Path("runs") / options.study.stem).resolve()
    out.mkdir(parents=True, exist_ok=True)
    runner = Runner(study, abut, out, options.serial, options.force)
    progress = Progress(len(study.points) + (study.reference is not None), options.quiet)
    try:
        records, reference = runner.all(jobs_of(options, study), progress)
    finally:
        progress.close()
    results = results_of(study, records, reference, options.serial)
    for result in results:
        result.command = command_of(study, result, abut, out)
    units = units_of(study, [record["summary"] for record in records])
    facts = facts_of(study, results, reference, time.monotonic() - started, progress.timed,
                     options.serial, units)
    write_results(out, study, results, facts, units)
    template = HERE.with_name(f"{HERE.stem}.html")
    content = Shown(study, results, facts, units)
    page = fitting_page(
        lambda library, limit: page_of(content, out, template, library, limit),
        options.chart_library, CURVE_POINTS)
    write_whole(out / "index.html", page)
    if not options.quiet:
        tell(out, study, facts)
    off = surprises(results)
    if off:
        print(f"{len(off)} of {len(results)} runs did not end as the study expects "
              "(docs/STUDIES.md, key expected):", *told(off), sep="\n", file=sys.stderr)
    code = tell_target(out, study, results, targets) if targets else 0
    return exit_code(results) or code


def tell(out: Path, study: Study, facts: dict) -> None:
    counts = ", ".join(f"{count} {word}" for word, count in facts["status"].items())
    print(f"{study.title}\n{counts}; {facts['seconds']:g} s")
    for claim in facts["claims"]:
        print(f"  {claim['verdict']:<14}{claim['text']}")
    print(f"files  {out}\npage   {out / 'index.html'}", flush=True)


def interrupted(number, frame):
    raise KeyboardInterrupt


def main() -> int:
    options = options_of()
    signal.signal(signal.SIGTERM, interrupted)
    try:
        return ended("study", lambda: run_study(options))
    except KeyboardInterrupt:
        print("abut study: interrupted; the same command goes on from here", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
