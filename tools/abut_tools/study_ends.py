"""How the runs of a study ended, against what the study says of it; and how to repeat one."""

import re
import shlex
import shutil
from collections import Counter
from pathlib import Path

from abut_tools.study_file import Study
from abut_tools.study_results import Result
from abut_tools.yaml_text import flow_text

MOST_TOLD = 10  # kinds of ends that a terminal lists
NUMBERS = re.compile(r"[-+]?\d[\d.]*(e[-+]?\d+)?")  # reasons that differ by these alone are one


def surprises(results: list[Result]) -> list[Result]:
    """Runs that ended otherwise than the study says."""
    return [result for result in results if result.status != result.point.expected]


def exit_code(results: list[Result]) -> int:
    """As of `abut run`: 3 where something outside ended a run, 1 where numbers or settings did."""
    off = surprises(results)
    return 3 if any(result.status == "lost" for result in off) else 1 if off else 0


def why(result: Result) -> str:
    return result.reason or ("was to fail" if result.point.expected == "failed" else
                             "was to be refused")


def told(results: list[Result]) -> list[str]:
    """Lines for a terminal: runs of one reason are told once."""
    kinds = {}
    for result in results:
        kinds.setdefault((result.status, result.key, NUMBERS.sub("", why(result))),
                         []).append(result)
    lines = []
    for (status, *_), own in list(kinds.items())[:MOST_TOLD]:
        more = f" and {len(own) - 1} more" if len(own) > 1 else ""
        lines += [f"  {status:<10}{own[0].label}{more}", f"            {why(own[0])}"]
    left = sum(len(own) for own in list(kinds.values())[MOST_TOLD:])
    return lines + ([f"  and {left} more, in results.csv"] if left else [])


def end_words(result: Result) -> str:
    """refused; refused as expected; completed, not refused"""
    status, expected = result.status, result.point.expected
    if status == expected:
        return status + ("" if status == "completed" else " as expected")
    return status if expected == "completed" else f"{status}, not {expected}"


def counts_of(results: list[Result]) -> dict[str, int]:
    return dict(Counter(end_words(result) for result in results))


def program_word(abut: Path) -> str:
    """What a shell finds by its name needs no path."""
    found = shutil.which("abut")
    return "abut" if found and Path(found).resolve() == abut else str(abut)


def command_of(study: Study, result: Result, abut: Path, out: Path) -> str:
    """For a shell, from any folder: the run once more, beside the study's own."""
    words = [program_word(abut), "run", str(result.point.scene)]
    words += ["--local"] if study.placement == "local" else []
    for key, value in result.point.settings.items():
        words += ["--set", f"{key}={flow_text(value)}"]
    return shlex.join([*words, "--out", str(out / "again" / Path(result.record["folder"]).name)])
