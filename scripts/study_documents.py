#!/usr/bin/python3
"""Runs a shipped study and makes a document of its results: docs/RESULTS.md, docs/EXTREMES.md.

usage: study_documents.py DIRECTORY_OF_PROGRAMS results|joined|extremes

`joined` measures the section of docs/RESULTS.md on joined bodies anew, and leaves the others.

What an earlier run of the study left in runs/ is used again, as the study itself does.
"""

import datetime
import json
import pathlib
import re
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent
# Of joined bodies: study, and what of its results the section holds beside the claims.
JOINED = ("joined_cantilever", "joined_controls", "overlapping_cantilever",
          "overlapping_motions", "overlapping_statics", "joined_iterations", "joined_fidelity")
STUDIES = {"results": "two_bars_methods", "extremes": "extremes"}
OPTIONS = {"results": ["--serial"], "extremes": []}
RESULTS_HEAD = """\
# Results: contact methods side by side

Two commands reproduce every figure of this page and of [EXTREMES.md](EXTREMES.md); the pages they
write hold the curves over time:

    abut study studies/two_bars_methods.yaml --serial
    abut study studies/extremes.yaml

`make results` and `make extremes` do so and write both documents. What the methods are and why they
differ is told in [METHOD.md](METHOD.md).
"""
JOINED_HEAD = """\
Bodies that are one, of several solvers. What is published of coupling by overlapping Schwarz, where
each body's motion is prescribed at its side from the inside of the other one, and what was measured
here of it and of the forms that abut has instead (METHOD, section 15):

| claim for overlapping Schwarz | verdict |
|---|---|
"""
VERDICTS = [
    ("plug and play: couples unlike meshes, element types, solvers, integrators",
     "so do joined faces, and overlaps that share their material, any with any other: "
     "tables below"),
    ("no nonphysical artifacts",
     "in statics. In time only between bodies that are the same where both are: others, of "
     "unlike meshes, steps or schemes, gain energy without end (published: +22 to +7765 %; "
     "table below: 2e2 to 2e9 times in two milliseconds). That is refused therefore; with "
     "half of the material in each body energy is an identity, and a pulse of two cells "
     "leaves 5e-4 of its energy behind"),
    ("theoretical convergence properties",
     "of the iteration, faster with wider overlaps: holds, 297 to 47 sweeps in a stretched "
     "bar, 8810 to 431 in a bent one (table below), 2 where both bodies are answered at "
     "once. Of the motion in time: see above. Forces of a joint have one solution, since the "
     "energy that they leave in bodies at rest is positive"),
    ("easy to implement in existing codes",
     "true, and of joined faces too: advance under forces that are constant in steps, tell"
     " where ports are, return to a saved state"),
    ("scalable, fast, robust: 2 h 42 min where the fine mesh alone takes 3 h 34 min "
     "(0.76), at 3.22 iterations",
     "0.57 of the time of the fine mesh at equal stress, 1.00 calls of all bodies in a "
     "window: `configs/joined/torsion_multi_scale.yaml`, as its head says"),
]
ITERATIONS = """\
Equal bars but for one ratio, right over left; implicit, windows of ten steps, in contact from the
first moment. *Kinematic* is the side whose contact problem is solved, the other one takes its
force. *Aitken* begins with the factor 0.5, *by probe* with the one that the port kernels give;
Anderson keeps the secants of five windows.
"""


def sections(path: pathlib.Path) -> dict[str, str]:
    """Title and text of every `##` section; what stands before is the section without title."""
    parts = re.split(r"^## (.+)$", path.read_text(encoding="utf-8"), flags=re.MULTILINE)
    return {"": parts[0], **dict(zip(parts[1::2], parts[2::2]))}


def measured_with(found: dict[str, str], facts: dict) -> str:
    text = re.sub(r"Linux [^;]*; ", "", found["Measured with"]).strip()
    day = datetime.date.today().isoformat()
    taken = f" in {facts['seconds']:.0f} s" if facts["runs_made"] >= facts["runs"] else ""
    return (f"{text}\n\n{facts['runs']} runs: " + ", ".join(
        f"{count} {word}" for word, count in facts["status"].items())
            + f". Made on {day}{taken}.\n")


def results(found: dict[str, str], facts: dict) -> str:
    about = found[""].split("\n", 1)[1].strip()
    parts = [RESULTS_HEAD, "## Measured with\n\n" + measured_with(found, facts),
             f"{about}\n\n## Claims{found['Claims'].rstrip()}\n"]
    tables = [table["title"] for table in facts["tables"]]
    first = next(title for title in tables if title.startswith("Iterations"))
    for title in tables:
        lead = f"\n\n{ITERATIONS.rstrip()}" if title == first else ""
        parts.append(f"## {title}{lead}{found[title].rstrip()}\n")
    parts.append(f"## Orders of convergence{found['Orders'].rstrip()}\n")
    errors = "\n".join(
        f"| {each['name']} | `{each['of']}` | {each['how']} | {each['relative_to']} |"
        for each in facts["errors"])
    parts.append("## Errors\n\nMeasures and columns are those of [OUTPUT.md](OUTPUT.md).\n\n"
                 f"| error | of | how | relative to |\n|---|---|---|---|\n{errors}\n")
    return "\n".join(parts)


def run_study(abut: pathlib.Path, name: str, *options: str) -> tuple[dict[str, str], dict]:
    """Runs it and returns the sections of its results and its facts."""
    out = TOP / "runs" / name
    subprocess.run([abut, "study", TOP / "studies" / f"{name}.yaml", "--out", out, *options],
                   check=True)
    facts = json.loads((out / "study.json").read_text(encoding="utf-8"))
    return sections(out / "results.md"), facts


def joined(abut: pathlib.Path) -> str:
    """The section on joined bodies, of several studies."""
    parts = [JOINED_HEAD + "\n".join(f"| {claim} | {verdict} |" for claim, verdict in VERDICTS)]
    for name in JOINED:
        found, facts = run_study(abut, name)
        title, about = found[""].strip().split("\n", 1)
        parts.append(f"### {title.lstrip('# ')}\n\n    abut study studies/{name}.yaml\n\n"
                     f"{about.strip()}\n\n{found['Claims'].strip()}")
        parts += [f"*{table['title']}*\n\n{found[table['title']].strip()}"
                  for table in facts["tables"]]
    return "## Joined bodies\n\n" + "\n\n".join(parts) + "\n"


def replace_joined(document: str, section: str) -> str:
    """In place of what the document has, or before its orders of convergence."""
    old = re.search(r"^## Joined bodies\n.*?(?=^## )", document, flags=re.MULTILINE | re.DOTALL)
    at = old.span() if old else (document.index("## Orders of convergence"),) * 2
    return document[:at[0]] + section + "\n" + document[at[1]:]


def extremes(found: dict[str, str], facts: dict) -> str:
    return (f"{found[''].rstrip()}\n\n## Claims{found['Claims']}## Runs{found['Runs']}"
            f"## Measured with\n\n{measured_with(found, facts)}")


def main() -> None:
    if len(sys.argv) != 3 or sys.argv[2] not in {*STUDIES, "joined"}:
        sys.exit(__doc__)
    kind = sys.argv[2]
    abut = pathlib.Path(sys.argv[1]).resolve() / "abut"
    if kind == "joined":
        page = TOP / "docs" / "RESULTS.md"
        text = replace_joined(page.read_text(encoding="utf-8"), joined(abut).replace(f"{TOP}/", ""))
        page.write_text(text, encoding="utf-8")
        return
    found, facts = run_study(abut, STUDIES[kind], *OPTIONS[kind])
    text = {"results": results, "extremes": extremes}[kind](found, facts)
    if kind == "results":
        text = replace_joined(text, joined(abut))
    text = text.replace(f"{TOP}/", "")
    head = f"<!-- Generated by `make {kind}`. Do not edit. -->\n\n"
    (TOP / "docs" / f"{kind.upper()}.md").write_text(head + text, encoding="utf-8")


if __name__ == "__main__":
    main()
