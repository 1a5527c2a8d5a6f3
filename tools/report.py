#!/usr/bin/python3
"""A run's folder as one self-contained page: what happened, the bodies moving, curves and tables.

Reads summary.json, history.csv, closed_form.csv, events.jsonl and the fields; needs Python's
standard library and Debian's packaged Chart.js, which goes into the page. The page itself is
report.html beside this file. Ends with 2 when the user can help (no run in the folder), with 3 when
the machine must (no chart library, page cannot be written).
"""

import argparse
import html
import sys
from pathlib import Path

from abut_tools.bodies_page import fitting_motion, how_to_get, space_time, stage
from abut_tools.page import (CHART_LIBRARY, canvas_of, filled, fitting_page, named, script_json,
                             section, write_whole)
from abut_tools.run_figures import figures_of, force_figure
from abut_tools.run_folder import Run
from abut_tools.run_tables import (closed_form_table, details, expectations_table, given_up_table,
                                   overlaps_table, reason_of, status_of, warnings_list,
                                   what_happened)
from abut_tools.run_times import times_of
from abut_tools.tables import Figure
from abut_tools.verb import ended
from abut_tools.version import TellVersion

TEMPLATE = Path(__file__).resolve().with_suffix(".html")
CURVE_POINTS = 2000     # more than a screen has columns


def bodies_section(run: Run, moving: tuple | None, beside: list[Figure]) -> str:
    """The bodies, curves beside them; or how to get them."""
    if moving is None:
        return section("The bodies", how_to_get(run.summary.get("windows", 0)))
    curves = "".join(canvas_of(figure) for figure in beside)
    return section("The bodies", stage(moving[0], curves) + space_time(moving[0]))


def beside_bodies(figures: list[Figure], moving: tuple | None) -> list[Figure]:
    """Forces, and energies where there is room: strips of bars are low."""
    if not moving:
        return []
    force = force_figure(figures)
    energy = next((figure for figure in figures if figure.name == "energy"),
                  next((figure for figure in figures if figure.name.startswith("energy_")), None))
    wanted = [force] + ([energy] if moving[0].dimension > 1 and energy is not force else [])
    return [figure for figure in wanted if figure]


def figures_section(figures: list[Figure]) -> str:
    if not figures:
        return ""
    exact = any(curve["exact"] for figure in figures for curve in figure.curves)
    words = "Solid: computed. Dashed: closed form. " if exact else ""
    note = f'<p class="note">{words}Touch a curve for values; touch a name to hide its curve.</p>'
    plots = "".join(canvas_of(figure) for figure in figures)
    return section("Figures", note + f'<div class="figures">{plots}</div>')


def page_of(run: Run, moving: tuple | None, library: str, limit: int) -> str:
    figures = figures_of(run)
    beside = beside_bodies(figures, moving)
    status, kind = status_of(run)
    scale, told = run.time_scale(), what_happened(run)
    data = [figure.data(limit, scale) for figure in figures]
    for figure in data:
        figure["moment"] = figure["name"] in [each.name for each in beside]
    scripts = ("page.js", "bodies.js", "stage.js") if moving else ("page.js",)
    return filled(
        TEMPLATE, library, scripts,
        title=html.escape(run.title()), status=html.escape(status), kind=kind,
        summary=section("Why this is no success", reason_of(run)) +
        section("What happened", f'<div class="happened">{told}</div>' if told else "") +
        section("Warnings", warnings_list(run)) +
        section("Bodies that are in each other", overlaps_table(run)),
        bodies=bodies_section(run, moving, beside),
        figures=figures_section([figure for figure in figures if figure not in beside]),
        accuracy=section("Accuracy given up", given_up_table(run)) +
        section("Expectations", expectations_table(run)) +
        section("Against the closed form", closed_form_table(run)) +
        section("Who took the time", times_of(run)),
        details=details(run), data=script_json(data),
        moving=script_json(moving[1] if moving else None))


def make_page(folder: Path, library_path: Path) -> str:
    run = Run(folder)
    moving = fitting_motion(folder, run.time_scale(), run.units)
    size = len(moving[1]["block"]) if moving else 0
    return fitting_page(lambda library, limit: page_of(run, moving, library, limit), library_path,
                        CURVE_POINTS, size)


def main() -> int:
    parser = argparse.ArgumentParser(prog="abut report", description="Makes a page of a run.")
    parser.add_argument("directory", type=named, metavar="DIR", help="the run's folder")
    parser.add_argument("--out", type=named, metavar="FILE", help="default: DIR/report.html")
    parser.add_argument("--chart-library", type=Path, metavar="FILE", default=CHART_LIBRARY,
                        help="Chart.js 3 (default: that of Debian's package libjs-chart.js)")
    parser.add_argument("--version", action=TellVersion)
    options = parser.parse_args()
    sys.stdout.reconfigure(errors="backslashreplace")  # names of files may be no text
    out = options.out or options.directory / "report.html"

    def work() -> int:
        write_whole(out, make_page(options.directory, options.chart_library))
        print(out)
        return 0

    return ended("report", work)


if __name__ == "__main__":
    sys.exit(main())
