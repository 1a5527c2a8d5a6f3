#!/usr/bin/python3
"""A film of a run's bodies, the force curve beside them: MP4 where ffmpeg is installed, else GIF.

Reads the fields and the history of the run; draws without a display. Needs Debian's packages
python3-matplotlib and python3-numpy. Ends with 2 when the user can help (no fields in the folder),
with 3 when the machine must (a package is missing, the film cannot be written).
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from abut_tools.motion import motion_of
from abut_tools.picture_options import add_options, joined, require_fields, require_packages
from abut_tools.run_folder import Run
from abut_tools.tables import ToolError
from abut_tools.verb import ended
from abut_tools.version import TellVersion

ENDINGS = (".gif", ".mp4")
LONGEST_STEP = 0.25  # seconds of one state on the screen, so that a film of few is not dull


def seconds(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0.2 <= value <= 600.0:
        raise argparse.ArgumentTypeError(f"is '{text}': write a number of seconds, 0.2 to 600")
    return value


def frames_limit(text: str) -> int:
    if not text.isdigit() or not 2 <= int(text) <= 10_000:
        raise argparse.ArgumentTypeError(f"is '{text}': write a whole number, 2 to 10000")
    return int(text)


def chosen_out(options: argparse.Namespace) -> Path:
    if options.out is None:
        return options.directory / ("film.mp4" if shutil.which("ffmpeg") else "film.gif")
    if options.out.suffix.lower() not in ENDINGS:
        raise ToolError(f"--out {options.out}: films are GIF or MP4 files. Give it the ending .gif "
                        "or .mp4.", 2)
    if options.out.suffix.lower() == ".mp4" and not shutil.which("ffmpeg"):
        raise ToolError("MP4 files are made by ffmpeg, which is not installed. Install it with: "
                        "apt-get install --no-install-recommends ffmpeg, or name a .gif file.", 3)
    return options.out


def write_gif(path: Path, frames, rate: float) -> None:
    """One palette for all frames: colours must mean the same in each."""
    from PIL import Image
    images = [Image.fromarray(frame) for frame in frames]
    sample = Image.new("RGB", (images[0].width, 3 * images[0].height))
    for k, at in enumerate((0, len(images) // 2, len(images) - 1)):
        sample.paste(images[at], (0, k * images[0].height))
    palette = sample.quantize(256, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    packed = [image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images]
    packed[0].save(path, format="GIF", save_all=True, append_images=packed[1:], loop=0,
                   duration=[max(20, round(1000.0 / rate))] * (len(packed) - 1) + [1200],
                   optimize=False, disposal=1)


def write_mp4(path: Path, frames, rate: float, size: tuple[int, int]) -> None:
    command = ["ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24",
               "-s", f"{size[0]}x{size[1]}", "-r", f"{rate:.6g}", "-i", "-", "-an",
               "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2,tpad=stop_mode=clone:stop_duration=1,fps=25",
               "-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4", str(path)]
    with tempfile.TemporaryFile() as said:
        with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=said) as process:
            try:
                for frame in frames:
                    process.stdin.write(frame.tobytes())
                process.stdin.close()
            except BrokenPipeError:
                pass  # what it said tells why
        if process.returncode != 0:
            said.seek(0)
            words = said.read().decode("utf-8", "replace").strip().splitlines()
            raise ToolError(f"ffmpeg failed: {words[-1] if words else 'without a word'}. Name a "
                            ".gif file with --out, or look at that program.", 3)


def make_film(options: argparse.Namespace, out: Path) -> None:
    run = Run(options.directory)
    require_fields(options.directory)
    require_packages()
    from abut_tools.frames import Frames, Look  # after it is known that its packages are there
    motion = motion_of(options.directory, options.frames)
    look = Look(options.size, options.field, options.view, options.deformation, options.dark)
    sheet = Frames(run, motion, look)
    count = len(motion.times)
    rate = max(count / options.seconds, 1.0 / LONGEST_STEP)

    def frames():
        for state in range(count):
            if sys.stderr.isatty():
                print(f"\rframe {state + 1} of {count}", end="", file=sys.stderr, flush=True)
            yield sheet.draw(state)
        if sys.stderr.isatty():
            print("\r\033[K", end="", file=sys.stderr, flush=True)

    with tempfile.TemporaryDirectory(dir=out.parent, prefix=".film_") as folder:
        temporary = Path(folder) / out.name  # nobody ever sees half a film
        if out.suffix.lower() == ".gif":
            write_gif(temporary, frames(), rate)
        else:
            write_mp4(temporary, frames(), rate, options.size)
        os.replace(temporary, out)


def main() -> int:
    parser = argparse.ArgumentParser(prog="abut film", description="Makes a film of a run.")
    add_options(parser, "DIR/film.mp4 where ffmpeg is installed, else DIR/film.gif")
    parser.add_argument("--seconds", type=seconds, default=8.0, metavar="S",
                        help="length of the film; default 8, less where there are few states")
    parser.add_argument("--frames", type=frames_limit, default=150, metavar="N",
                        help="states that are shown at most; default 150")
    parser.add_argument("--version", action=TellVersion)
    options = parser.parse_args(joined(sys.argv[1:]))
    sys.stdout.reconfigure(errors="backslashreplace")  # names of files may be no text

    def work() -> int:
        out = chosen_out(options)
        make_film(options, out)
        print(out)
        return 0

    return ended("film", work)


if __name__ == "__main__":
    sys.exit(main())
