#!/usr/bin/python3
"""A run in a browser, while it goes on and after it: how far it is, who takes the time, forces and
energies, events, the bodies moving.

Reads the run's folder and nothing else, and writes nothing. The page is monitor.html beside this
file, served on 127.0.0.1. Needs Python's standard library and Debian's packaged Chart.js. Ends with
0 on Ctrl-C, with 2 when the user can help (no run in the folder, port in use), with 3 when the
machine must.
"""

import argparse
import html
import signal
import sys
from pathlib import Path

from abut_tools.bodies_page import SPACE_TIME, stage_elements
from abut_tools.live_run import being_set_up, holds_run
from abut_tools.monitor_server import HOST, serving
from abut_tools.page import CHART_LIBRARY, filled, fitting_page, named
from abut_tools.tables import ToolError
from abut_tools.verb import ended
from abut_tools.version import TellVersion

TEMPLATE = Path(__file__).resolve().with_suffix(".html")
STAGE = stage_elements("The bodies moving", 1, "", '<div id="beside"></div>') + SPACE_TIME
SCRIPTS = ("page.js", "bodies.js", "stage.js", "monitor.js")


def port_number(text: str) -> int:
    if not text.isdigit() or int(text) > 65535:
        raise argparse.ArgumentTypeError(f"is {text}: a port is a number from 1 to 65535, or 0 for "
                                         "any that is free")
    return int(text)


def check(folder: Path) -> None:
    if not folder.exists() and ":/" in str(folder):
        endpoint = str(folder).replace(":/", "://", 1)  # paths have no two slashes
        raise ToolError(
            f"{endpoint} is an endpoint, and a monitor reads the run's folder. Of a run on another "
            "machine, start it there and look from here: "
            "ssh -L 8700:127.0.0.1:8700 HOST abut monitor DIR --port 8700", 2)
    if not folder.is_dir():
        what = "is no folder" if folder.exists() else "is not there"
        raise ToolError(f"{folder} {what}. Name the folder of a run, as abut run names it with "
                        "--out.", 2)
    try:
        next(folder.iterdir(), None)
    except OSError as error:
        raise ToolError(f"{folder} cannot be read: {error.strerror}. Make it readable, or name "
                        "another folder.", 2) from error
    if not holds_run(folder) and not being_set_up(folder):
        raise ToolError(f"{folder} holds no run. Make one with: abut run SCENE --out {folder}", 2)


def page_of(folder: Path, library_path: Path) -> str:
    name = html.escape(folder.resolve().name.encode("utf-8", "replace").decode())
    return fitting_page(lambda library, _: filled(
        TEMPLATE, library, SCRIPTS, title=name, stage=STAGE),
                        library_path, 1)


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="abut monitor",
        description="Shows a run in a browser while it goes on, and after it. Reads only.")
    parser.add_argument("directory", type=named, metavar="DIR", help="the run's folder")
    parser.add_argument("--port", type=port_number, metavar="NUMBER", default=0,
                        help="of this machine; default: any that is free")
    parser.add_argument("--chart-library", type=Path, metavar="FILE", default=CHART_LIBRARY,
                        help="Chart.js 3 (default: that of Debian's package libjs-chart.js)")
    parser.add_argument("--version", action=TellVersion)
    options = parser.parse_args()
    sys.stdout.reconfigure(errors="backslashreplace")  # names of files may be no text

    def work() -> int:
        check(options.directory)
        server = serving(options.directory, options.port,
                         page_of(options.directory, options.chart_library))
        try:  # whoever reads the line may end it at once
            signal.signal(signal.SIGTERM, signal.default_int_handler)
            print(f"http://{HOST}:{server.server_address[1]}/ shows {options.directory} until "
                  "Ctrl-C", flush=True)
            server.serve_forever()
        except KeyboardInterrupt:
            print()
        return 0

    return ended("monitor", work)


if __name__ == "__main__":
    sys.exit(main())
