"""Moving bodies in a page: what the script bodies.js draws, small enough to open at once."""

import array
import base64
import html
import math
import sys
import zlib
from pathlib import Path

from abut_tools.motion import Motion, MovingBody, motion_of
from abut_tools.tables import COLOURS, RAMPS, few, rounded, scaled_unit
from abut_tools.units import Units
from abut_tools.vtu import listed_states

LIMIT = 3_000_000    # bytes of a page that bodies may take
STATES = 120         # more than a slider of a phone can tell apart by much
READ = 1_500_000     # nodes times states that are read at most
LEAST_STATES = 30


def unsigned(values: list[float], low: float, span: float) -> array.array:
    """Whole numbers from 0 to 65535 for values from low to low + span."""
    factor = 65535.0 / span if span else 0.0
    return array.array("H", [int((v - low) * factor + 0.5) for v in values])


def changes(rows: list[array.array]) -> array.array:
    """The first row and what every other one adds to that before it: packs better."""
    told, before = array.array("H"), None
    for row in rows:
        told.extend(row if before is None else
                    [(new - old) & 0xFFFF for new, old in zip(row, before)])
        before = row
    return told


class Packer:
    """Numbers of all bodies in one block; whoever reads it knows their order and counts."""

    def __init__(self):
        self.data = bytearray()

    def add(self, numbers: array.array) -> None:
        if sys.byteorder == "big":  # browsers read numbers as nearly all machines hold them
            numbers.byteswap()
        data = numbers.tobytes()
        self.data += data + bytes(-len(data) % 4)

    def text(self) -> str:
        return base64.b64encode(zlib.compress(bytes(self.data), 9)).decode("ascii")


def packed_body(motion: Motion, body: MovingBody, pack: Packer) -> dict:
    """A body's numbers go into the block: places at rest, triangles, edges, by state displacements
    about the body's mean, by quantity and state values."""
    axes = 3 if motion.dimension == 3 else 2
    low = [min(p[i] for p in body.rest) for i in range(3)]
    high = [max(p[i] for p in body.rest) for i in range(3)]
    for i in range(axes):
        pack.add(unsigned([p[i] for p in body.rest], low[i], high[i] - low[i]))
    for lists in (body.surface.triangles, body.surface.edges):
        pack.add(array.array("I", [k for each in lists for k in each]))
    count = len(body.rest)
    means = [[sum(moved[i::3]) / count for i in range(axes)] for moved in body.displacements]
    reach = max((abs(u - mean[i]) for moved, mean in zip(body.displacements, means)
                 for i in range(axes) for u in moved[i::3]), default=0.0)
    for i in range(axes):
        pack.add(changes([unsigned([u - mean[i] for u in moved[i::3]], -reach, 2.0 * reach)
                          for moved, mean in zip(body.displacements, means)]))
    keys = []
    for shade in motion.shades:
        rows = body.values[shade.key]
        if any(row is None for row in rows):
            continue
        scale = motion.scales[shade.key]
        keys.append(shade.key)
        pack.add(changes([unsigned(row, scale.least, scale.most - scale.least) for row in rows]))
    return {"name": body.name, "low": [rounded(v, 9) for v in low[:axes]],
            "high": [rounded(v, 9) for v in high[:axes]], "reach": reach, "keys": keys,
            "nodes": count, "triangles": len(body.surface.triangles),
            "edges": len(body.surface.edges), "strip": bool(body.surface.side),
            "means": [[rounded(v, 9) for v in mean] for mean in means]}


def shade_data(motion: Motion) -> list[dict]:
    shades = []
    for shade in motion.shades:
        scale = motion.scales[shade.key]
        factor, unit = scaled_unit(max(abs(scale.low), abs(scale.high)), shade.unit)
        shades.append({"key": shade.key, "label": shade.label, "unit": unit, "factor": factor,
                       **scale._asdict()})
    return shades


def magnifications(motion: Motion, reaches: list[float]) -> list[int]:
    """Powers of ten by which deformation becomes visible; none where it is so anyway."""
    largest, size = max(reaches, default=0.0), motion.size()
    if not largest or largest > 0.02 * size:
        return [1]
    most = int(math.floor(math.log10(0.1 * size / largest)))
    return [10 ** k for k in range(0, min(most, 6) + 1)]


def aspect(motion: Motion) -> float:
    """Width over height of the picture."""
    if motion.dimension == 3:
        return 1.5
    width, height = (motion.high[i] - motion.low[i] for i in range(2))
    return rounded(min(8.0, max(1.2, width / height if height else 8.0)), 3)


def packed(motion: Motion, time_scale: tuple[float, str]) -> dict:
    pack = Packer()
    bodies = [packed_body(motion, body, pack) for body in motion.bodies]
    for k, body in enumerate(bodies):
        body["colour"] = COLOURS[k % len(COLOURS)]
    factor, unit = scaled_unit(max(map(abs, motion.low + motion.high)), motion.length)
    return {"dimension": motion.dimension, "length": {"factor": factor, "unit": unit},
            "ramps": RAMPS, "aspect": aspect(motion), "start": motion.state_of_most(),
            "times": [rounded(t * time_scale[0], 8) for t in motion.times], "time": time_scale[1],
            "low": motion.low, "high": motion.high, "shades": shade_data(motion),
            "magnify": magnifications(motion, [body["reach"] for body in bodies]),
            "bodies": bodies, "block": pack.text()}


def fitting_motion(folder: Path, time_scale: tuple[float, str], units: Units = Units(),
                   limit: int = 0, most_states: int = 0) -> tuple[Motion, dict] | None:
    """The run's bodies and their data, thinned until these take at most `limit` bytes
    (0: what a page may have)."""
    limit, most_states = limit or LIMIT, most_states or STATES
    if not listed_states(folder):
        return None
    first = motion_of(folder, 2)
    nodes = sum(len(body.surface.nodes) for body in first.bodies)
    states = min(most_states, max(LEAST_STATES, READ // max(nodes, 1)))
    most = READ // states
    while True:
        motion = motion_of(folder, states, most).in_words_of(units)
        data = packed(motion, time_scale)
        if len(data["block"]) <= limit or most < 100:
            return motion, data
        held = sum(len(body.surface.nodes) for body in motion.bodies)
        share = 0.9 * limit / len(data["block"])
        if states > LEAST_STATES:
            states = max(LEAST_STATES, int(states * share))
        else:
            most = int(held * share)


def words_of(motion: Motion) -> str:
    """What the picture leaves out."""
    told = []
    if len(motion.times) < motion.states_there:
        told.append(f"{len(motion.times)} of the {motion.states_there} states that were written")
    if motion.thinned:
        told.append("surfaces with fewer nodes than the bodies have, for a page that opens at once")
    return f"Shown: {' and '.join(told)}. " if told else ""


def how_to_get(windows: int) -> str:
    """Of a run that wrote no fields."""
    every = max(1, round(windows / 100))
    return ('<p class="note">This run wrote no fields, so its bodies cannot be shown. '
            "Run the scene again with <code>--set output.fields.every="
            f"{every}</code>, or with the key <code>output: {{fields: {{every: {every}}}}}</code>: "
            "their shape, motion and stress are then here.</p>")


def alternative(motion: Motion) -> str:
    """What the picture shows, in words."""
    names = [body.name for body in motion.bodies]
    shown = ", ".join(names[:6]) + (f" and {len(names) - 6} more" if len(names) > 6 else "")
    quantities = []
    for shade in motion.shades:
        scale = motion.scales[shade.key]
        factor, unit = scaled_unit(max(abs(scale.least), abs(scale.most)), shade.unit)
        quantities.append(f"{shade.label} from {few(scale.least * factor)} to "
                          f"{few(scale.most * factor)} {unit}".rstrip())
    return f"The bodies {shown} moving; colours: {'; '.join(quantities) or 'bodies'}"


def turning_words(dimension: int) -> str:
    turn = ("Drag to turn, wheel or pinch with Ctrl to zoom, double-click to come back. "
            if dimension == 3 else "Wheel with Ctrl to zoom, drag to move. ")
    strips = ("Bars are drawn as strips: they have an area and no shape. "
              if dimension == 1 else "")
    return f"{strips}{turn}Click on a body for its values over time."


def stage(motion: Motion, beside: str) -> str:
    """The elements that bodies.js fills; `beside` is the figure that stands beside the bodies."""
    return stage_elements(alternative(motion), len(motion.times),
                          words_of(motion) + turning_words(motion.dimension), beside)


def stage_elements(alternative_text: str, states: int, words: str, beside: str) -> str:
    text = html.escape(alternative_text)
    return f'''<div class="stage"><div>
<div class="tools"><label>colour <select id="shade"></select></label>
<label id="magnify_label" hidden>deformation <select id="magnify"></select></label>
<span class="chips" id="bodies_shown"></span></div>
<canvas id="bodies" tabindex="0" role="img" aria-label="{text}"></canvas>
<div class="scale" id="scale" hidden><canvas id="ramp" aria-hidden="true"></canvas>
<div class="ends"><span></span><b></b><span></span></div></div>
<div class="player"><button id="play" type="button" aria-label="play">&#9654;</button>
<input type="range" id="moment" min="0" max="{states - 1}" value="0" step="1"
 aria-label="time"><output id="now"></output></div>
<p class="note">{words}</p>
</div><div>{beside}
<figure id="gauge_figure" hidden><figcaption id="gauge_title"></figcaption>
<div class="plot low"><canvas id="gauge" role="img" aria-label="values at a point"></canvas></div>
</figure></div></div>'''


SPACE_TIME = (
    '<figure class="wide" id="space_time_figure"><figcaption>Space and time</figcaption>'
    '<div class="plot"><canvas id="space_time" role="img" aria-label="Places of the bars over '
    'time, coloured by the chosen quantity: waves are slanted bands"></canvas></div></figure>')


def space_time(motion: Motion) -> str:
    return SPACE_TIME if motion.dimension == 1 and len(motion.times) > 2 else ""
