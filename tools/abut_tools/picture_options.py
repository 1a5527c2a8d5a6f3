"""What `abut film` and `abut picture` share: their options, and what they read of a run."""

import argparse
import importlib
import math
from pathlib import Path

from abut_tools.page import named
from abut_tools.tables import ToolError
from abut_tools.vtu import listed_states

FIELDS = ("stress", "speed", "pressure", "displacement", "plastic", "bodies")
NEEDED = {"numpy": "python3-numpy", "matplotlib": "python3-matplotlib", "PIL": "python3-pil"}


def size(text: str) -> tuple[int, int]:
    parts = text.lower().split("x")
    if len(parts) != 2 or not all(part.isdigit() for part in parts):
        raise argparse.ArgumentTypeError(f"is '{text}': write WIDTHxHEIGHT, for example 960x540")
    width, height = (int(part) for part in parts)
    if not (240 <= width <= 7680 and 180 <= height <= 4320):
        raise argparse.ArgumentTypeError(f"is {text}: take from 240x180 to 7680x4320")
    return width, height


def view(text: str) -> tuple[float, float]:
    known = {"x": (90.0, 0.0), "y": (0.0, 0.0), "z": (0.0, 90.0)}
    if text in known:
        return known[text]
    try:
        around, above = (float(part) for part in text.split(","))
    except ValueError:
        around = above = math.nan
    if not (math.isfinite(around) and abs(above) <= 90.0):
        raise argparse.ArgumentTypeError(
            f"is '{text}': write x, y, z (the axis that is looked along), or degrees about z and "
            "above the plane of x and y, for example 31,20")
    return around, above


def factor(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 <= value <= 1e9:
        raise argparse.ArgumentTypeError(f"is '{text}': write a number from 0 to 1e9")
    return value


def add_options(parser: argparse.ArgumentParser, out: str) -> None:
    parser.add_argument("directory", type=named, metavar="DIR", help="the run's folder")
    parser.add_argument("--out", type=named, metavar="FILE", help=f"default: {out}")
    parser.add_argument("--field", choices=FIELDS, default="",
                        help="what colours the bodies; default: the first that the run has")
    parser.add_argument("--size", type=size, default=(960, 540), metavar="WxH",
                        help="pixels; default 960x540")
    parser.add_argument("--view", type=view, metavar="VIEW",
                        help="x, y or z: along that axis; or degrees about z and above the plane "
                        "of x and y, for example 31,20")
    parser.add_argument("--deformation", type=factor, default=1.0, metavar="FACTOR",
                        help="makes deformation visible; default 1, as it is")
    parser.add_argument("--dark", action="store_true", help="light curves on a dark ground")


def joined(words: list[str]) -> list[str]:
    """Numbers below zero behind an option, which argparse takes for options of their own."""
    out = []
    for word in words:
        if out and out[-1] in ("--time", "--view") and word[:1] == "-" and word[1:2].isdigit():
            out[-1] += f"={word}"
        else:
            out.append(word)
    return out


def require_packages() -> None:
    missing = []
    for module, package in NEEDED.items():
        try:
            importlib.import_module(module)
        except ImportError:
            missing.append(package)
    if missing:
        raise ToolError(f"pictures need {', '.join(missing)}, which is not installed. Install it "
                        f"with: apt-get install --no-install-recommends {' '.join(missing)}", 3)


def require_fields(folder: Path) -> None:
    if not listed_states(folder):
        raise ToolError(
            f"{folder} holds no fields, so there are no bodies to draw. Run the scene again with "
            f"--set output.fields.every=10: abut run SCENE --out {folder} --force --set "
            "output.fields.every=10", 2)
