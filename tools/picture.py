#!/usr/bin/python3
"""A picture of a run's bodies at one time, the force curve beside them, as a PNG file.

Reads the fields and the history of the run; draws without a display. Needs Debian's packages
python3-matplotlib and python3-numpy. Ends with 2 when the user can help (no fields in the folder),
with 3 when the machine must (a package is missing, the picture cannot be written).
"""

import argparse
import math
import os
import sys
from pathlib import Path

from abut_tools.motion import motion_of
from abut_tools.picture_options import add_options, joined, require_fields, require_packages
from abut_tools.run_folder import Run
from abut_tools.tables import ToolError
from abut_tools.verb import ended
from abut_tools.version import TellVersion
from abut_tools.vtu import listed_states


def moment(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"is '{text}': write a time of the run, as 2.5e-4")
    return value


def time_of(folder: Path, wanted: float | None, unit: str) -> float:
    """The state nearest to the wanted time; where none is named, the last."""
    times = [entry.time for entry in listed_states(folder)]
    if wanted is None:
        return max(times)
    slack = 1e-6 * (max(times) - min(times))
    if not min(times) - slack <= wanted <= max(times) + slack:
        raise ToolError(f"--time {wanted:.6g} is outside of the run's states, which go from "
                        f"{min(times):.6g} to {max(times):.6g} {unit}. Name a time between them.",
                        2)
    return min(times, key=lambda time: abs(time - wanted))


def make_picture(options: argparse.Namespace, out: Path) -> None:
    run = Run(options.directory)
    require_fields(options.directory)
    require_packages()
    from abut_tools.frames import Frames, Look  # after it is known that its packages are there
    from PIL import Image
    time = time_of(options.directory, options.time, run.units.word("s"))
    # Colours that mean the same at all times: the scale is that of a part of the run's states.
    motion = motion_of(options.directory, 20, also=time)
    if motion.dimension == 1:  # a diagram of space and time needs more, and bars are small
        motion = motion_of(options.directory, 150, also=time)
    look = Look(options.size, options.field, options.view, options.deformation, options.dark)
    image = Frames(run, motion, look).draw(motion.times.index(time))
    temporary = out.with_name(out.name + ".tmp")
    temporary.unlink(missing_ok=True)
    with temporary.open("xb") as file:  # never through a symbolic link
        Image.fromarray(image).save(file, format="PNG", optimize=True)
    os.replace(temporary, out)


def main() -> int:
    parser = argparse.ArgumentParser(prog="abut picture",
                                     description="Draws a run's bodies at one time.")
    add_options(parser, "DIR/picture.png")
    parser.add_argument("--time", type=moment, metavar="T",
                        help="in the scene's unit of time: the state nearest to it is drawn; "
                        "default: the last")
    parser.add_argument("--version", action=TellVersion)
    options = parser.parse_args(joined(sys.argv[1:]))
    sys.stdout.reconfigure(errors="backslashreplace")  # names of files may be no text
    out = options.out or options.directory / "picture.png"

    def work() -> int:
        if out.suffix.lower() != ".png":
            raise ToolError(f"--out {out}: pictures are PNG files. Give it the ending .png.", 2)
        make_picture(options, out)
        print(out)
        return 0

    return ended("picture", work)


if __name__ == "__main__":
    sys.exit(main())
