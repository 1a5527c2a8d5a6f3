"""Frames of films and pictures: bodies, a scale of colours, and the force curve beside them."""

import math
from typing import NamedTuple

import matplotlib
import numpy

from abut_tools.motion import Motion, Shade
from abut_tools.raster import Picture, ramp, stops_of
from abut_tools.run_figures import figures_of, force_figure
from abut_tools.run_folder import Run
from abut_tools.tables import COLOURS, Figure, ToolError, few, measured, ramp_of, scaled_unit

matplotlib.use("Agg")  # before pyplot would look for a display, which nothing here needs
from matplotlib.backends.backend_agg import FigureCanvasAgg  # noqa: E402
from matplotlib.figure import Figure as Sheet  # noqa: E402

FINER = 2            # pixels of the bodies' picture per pixel of the frame, along each axis
FRONT, PLANE = (31.0, 20.0), (0.0, 90.0)  # degrees
LIGHT = {"ground": "#ffffff", "panel": "#f3f5f8", "ink": "#1c2430", "soft": "#4a5563",
         "line": "#dfe4ea"}
DARK = {"ground": "#12161c", "panel": "#1a2028", "ink": "#e6eaf0", "soft": "#aab4c1",
        "line": "#2b333e"}


class Look(NamedTuple):
    """What a reader may choose."""

    size: tuple[int, int]        # pixels
    field: str                   # key of a shade, or bodies
    view: tuple[float, float] | None  # degrees about z and above the plane
    deformation: float
    dark: bool


def axes_of(view: tuple[float, float]) -> numpy.ndarray:
    """(3, 3) directions of the screen: right, up, towards the viewer."""
    a, e = (math.radians(angle) for angle in view)
    return numpy.array([
        [math.cos(a), math.sin(a), 0.0],
        [-math.sin(a) * math.sin(e), math.cos(a) * math.sin(e), math.cos(e)],
        [math.sin(a) * math.cos(e), -math.cos(a) * math.cos(e), math.sin(e)]])


def chosen_shade(motion: Motion, wanted: str) -> Shade | None:
    """The one that is wanted, or the first; None: bodies have colours of their own."""
    names = [shade.key for shade in motion.shades]
    if wanted == "bodies" or not names:
        return None
    if wanted and wanted not in names:
        raise ToolError(f"the fields of this run hold no {wanted}, or it is zero throughout. "
                        f"Name one of {', '.join(names)}, bodies.", 2)
    return motion.shades[names.index(wanted) if wanted else 0]


class Scene:
    """The bodies as arrays, and how they come onto the screen."""

    def __init__(self, motion: Motion, shade: Shade | None, look: Look):
        self.motion, self.shade, self.look = motion, shade, look
        self.axes = axes_of(look.view or (FRONT if motion.dimension == 3 else PLANE))
        self.rest = [numpy.array(body.rest) for body in motion.bodies]
        self.triangles = [numpy.array(body.surface.triangles, int).reshape(-1, 3)
                          for body in motion.bodies]
        self.edges = [numpy.array(body.surface.edges, int).reshape(-1, 2)
                      for body in motion.bodies]
        corners = numpy.array([[x, y, z] for x in (motion.low[0], motion.high[0])
                               for y in (motion.low[1], motion.high[1])
                               for z in (motion.low[2], motion.high[2])])
        self.centre = corners.mean(0)
        seen = (corners - self.centre) @ self.axes.T
        self.extent = 2.0 * numpy.abs(seen).max(0)[:2]

    def aspect(self) -> float:
        return float(min(8.0, max(0.6, self.extent[0] / (self.extent[1] or self.extent[0]))))

    def colours(self, k: int, state: int) -> numpy.ndarray:
        body, count = self.motion.bodies[k], len(self.rest[k])
        row = body.values[self.shade.key][state] if self.shade else None
        if row is None:
            plain = COLOURS[k % len(COLOURS)] if not self.shade else "#9aa4b2"
            return numpy.repeat(stops_of((plain,)), count, 0)
        scale = self.motion.scales[self.shade.key]
        stops = ramp_of(scale.low, self.look.dark)
        return ramp(stops, (numpy.frombuffer(row) - scale.low) / (scale.high - scale.low))

    def picture(self, state: int, width: int, height: int, ground: str) -> numpy.ndarray:
        width, height = FINER * width, FINER * height
        picture = Picture(width, height, tuple(int(ground[k: k + 2], 16) for k in (1, 3, 5)))
        scale = 0.94 * min(width / (self.extent[0] or 1.0),
                           height / (self.extent[1] or self.extent[0] or 1.0))
        shaded = self.motion.dimension == 3
        for k, body in enumerate(self.motion.bodies):
            moved = numpy.frombuffer(body.displacements[state]).reshape(-1, 3)
            mean = moved.mean(0)
            places = self.rest[k] + mean + self.look.deformation * (moved - mean) - self.centre
            points = scale * places @ self.axes.T * [1.0, -1.0, 1.0]
            points += [width / 2.0, height / 2.0, 0.0]
            picture.triangles(points, self.triangles[k], self.colours(k, state), shaded)
            picture.edges(points, self.edges[k], bool(body.surface.side),
                          not len(self.triangles[k]))
        return picture.image(FINER)


def space_time(scene: Scene, width: int, height: int, ground: str) -> numpy.ndarray:
    """Places of bars over time: between two states their cells are parallelograms."""
    motion = scene.motion
    width, height = FINER * width, FINER * height
    picture = Picture(width, height, tuple(int(ground[k: k + 2], 16) for k in (1, 3, 5)))
    times = numpy.array(motion.times)
    across = (times - times[0]) / ((times[-1] - times[0]) or 1.0) * width
    span = (motion.high[0] - motion.low[0]) or 1.0
    for k, body in enumerate(motion.bodies):
        n = len(body.rest) // 2  # the other half is the other edge of the strip
        if body.surface.dimension != 1 or n < 2:
            continue
        places = numpy.array([scene.rest[k][:n, 0] + numpy.frombuffer(moved)[: 3 * n: 3]
                              for moved in body.displacements])
        points = numpy.zeros((len(times) * n, 3))
        points[:, 0] = numpy.repeat(across, n)
        points[:, 1] = (motion.high[0] - places.ravel()) / span * height
        colours = numpy.concatenate([scene.colours(k, s)[:n] for s in range(len(times))])
        first = (numpy.arange(len(times) - 1)[:, None] * n + numpy.arange(n - 1)).ravel()
        corners = numpy.concatenate([numpy.stack([first, first + 1, first + n], 1),
                                     numpy.stack([first + 1, first + n + 1, first + n], 1)])
        picture.triangles(points, corners, colours, False)
    return picture.image(FINER)


class Curve(NamedTuple):
    """The force over time, in the units of its axes."""

    figure: Figure
    factor: float
    label: str


def curve_of(run: Run) -> Curve | None:
    figure = force_figure(figures_of(run))
    if figure is None:
        return None
    largest = max((abs(y) for curve in figure.curves for y in curve["y"]), default=0.0)
    factor, unit = scaled_unit(largest, figure.unit)
    quantity = figure.quantity.split(",")[0]  # axes of films are short
    return Curve(figure, factor, f"{quantity} [{unit}]" if unit else quantity)


class Frames:
    """One sheet, drawn again for every state."""

    def __init__(self, run: Run, motion: Motion, look: Look):
        self.run, self.motion, self.look = run, motion.in_words_of(run.units), look
        self.theme = DARK if look.dark else LIGHT
        self.shade = chosen_shade(motion, look.field)
        self.scene = Scene(motion, self.shade, look)
        # Letters grow with the frame: 100 dots per inch at 960 x 540.
        self.finer = min(6.0, max(0.6, min(look.size[0] / 800.0, look.size[1] / 540.0)))
        dots = 100.0 * self.finer
        self.sheet = Sheet(figsize=(look.size[0] / dots, look.size[1] / dots), dpi=dots,
                           facecolor=self.theme["ground"])
        self.canvas = FigureCanvasAgg(self.sheet)
        self.curve = curve_of(run)
        times = [abs(t) for t in motion.times] + [abs(t) for t in run.history["time"] if t]
        self.time_factor, self.time_unit = scaled_unit(max(times, default=0.0), motion.time)
        self.lay_out()

    def lay_out(self) -> None:
        """Bodies to the left of the curve, or above it where they or the frame are wide or tall."""
        width, height = (pixels / self.finer for pixels in self.look.size)
        small, theme = 9, self.theme
        title = self.run.title()
        letters = int(width / 8.5)
        self.sheet.text(0.02, 1.0 - 14.0 / height, title if len(title) <= letters else
                        title[: letters - 1] + "…", fontsize=12, color=theme["ink"], va="center")
        top, foot = 30.0 / height, 62.0 / height
        aside = self.curve is not None and width > 1.25 * height and self.scene.aspect() < 3.0
        if aside:
            bodies, curve = (0.02, foot, 0.57, 1.0 - top - foot), (0.675, 0.16, 0.305, 0.70)
        elif self.curve is not None:
            share = 0.55 if self.scene.aspect() < 3.0 else 0.3
            if self.motion.dimension == 1:  # strips, above space and time
                share = 0.14
            bodies = (0.02, 1.0 - top - share, 0.96, share)
            room = 1.0 - top - share - foot
            curve = (70.0 / width, 50.0 / height, 1.0 - 90.0 / width,
                     max(room - 60.0 / height, 0.1))
        else:
            bodies, curve = (0.02, foot, 0.96, 1.0 - top - foot), None
        across, down = self.look.size
        self.corner = (round(bodies[0] * across), round((1.0 - bodies[1] - bodies[3]) * down))
        self.pixels = (max(8, round(bodies[2] * across)), max(8, round(bodies[3] * down)))
        self.scale_bar(bodies, small)
        self.clock = self.sheet.text(bodies[0], bodies[1] - 14.0 / height, "", fontsize=10,
                                     color=theme["ink"], va="center", animated=True)
        self.marks, self.ground = [], None
        if self.motion.dimension == 1 and len(self.motion.times) > 2:
            left, low, across, high = curve or (70.0 / width, 50.0 / height, 1.0 - 90.0 / width,
                                                0.45)
            gap = (52.0 if curve else 0.0) / height
            share = 0.55 * (high - gap) if curve else high
            self.draw_space_time((left, low + high - share, across, share), small)
            curve = (left, low, across, high - gap - share) if curve else None
        if curve:
            self.draw_curve(self.sheet.add_axes(curve, facecolor=theme["ground"]), small)

    def scale_bar(self, bodies: tuple, small: int) -> None:
        if not self.shade:
            return
        scale, theme = self.motion.scales[self.shade.key], self.theme
        width, height = (pixels / self.finer for pixels in self.look.size)
        factor, unit = scaled_unit(max(abs(scale.low), abs(scale.high)), self.shade.unit)
        stops = ramp_of(scale.low, self.look.dark)
        strip = ramp(stops, numpy.linspace(0.0, 1.0, 256))[None] / 255.0
        left = bodies[0] + 130.0 / width
        bar = self.sheet.add_axes((left, bodies[1] - 20.0 / height, bodies[0] + bodies[2] - left,
                                   10.0 / height))
        bar.imshow(strip, aspect="auto", extent=(0.0, 1.0, 0.0, 1.0))
        bar.set_yticks([])
        low = "≤ " if scale.least < scale.low - 1e-9 * abs(scale.low) else ""
        high = "≥ " if scale.most > scale.high * (1.0 + 1e-9) else ""
        middle = f"{self.shade.label}" + (f" [{unit}]" if unit else "")
        bar.set_xticks([0.0, 0.5, 1.0], [low + few(scale.low * factor), middle,
                                         high + few(scale.high * factor)])
        bar.tick_params(labelsize=small, length=0, colors=theme["soft"], pad=2)
        for label, side in zip(bar.get_xticklabels(), ("left", "center", "right")):
            label.set_horizontalalignment(side)
        for spine in bar.spines.values():
            spine.set_visible(False)

    def tone(self, colour: str) -> str:
        """Colours are chosen for white; on a dark ground they are lighter."""
        if not self.look.dark:
            return colour
        return "#" + "".join(f"{round(v + 0.38 * (255 - v)):02x}" for v in stops_of((colour,))[0])

    def draw_space_time(self, place: tuple, small: int) -> None:
        theme = self.theme
        plot = self.sheet.add_axes(place, facecolor=theme["ground"])
        image = space_time(self.scene, max(8, round(place[2] * self.look.size[0])),
                           max(8, round(place[3] * self.look.size[1])), theme["ground"])
        times, (low, high) = self.motion.times, (self.motion.low[0], self.motion.high[0])
        factor, unit = scaled_unit(max(abs(low), abs(high)), self.motion.length)
        plot.imshow(image, aspect="auto", extent=(times[0] * self.time_factor,
                                                  times[-1] * self.time_factor,
                                                  low * factor, high * factor))
        plot.set_title("Space and time", fontsize=10, color=theme["ink"], loc="left")
        plot.set_ylabel(f"place [{unit}]", fontsize=small, color=theme["soft"])
        self.finish(plot, small)

    def finish(self, plot, small: int) -> None:
        """What all axes over time have."""
        theme = self.theme
        plot.tick_params(labelsize=small, colors=theme["soft"])
        for spine in plot.spines.values():
            spine.set_color(theme["line"])
        if self.motion.dimension == 1:  # two of them, one above the other
            plot.set_xlim(self.motion.times[0] * self.time_factor,
                          self.motion.times[-1] * self.time_factor)
        mark = plot.axvline(self.motion.times[0] * self.time_factor, color=theme["ink"],
                            linewidth=1.2, animated=True)
        self.marks.append((plot, mark))

    def draw_curve(self, plot, small: int) -> None:
        theme, figure = self.theme, self.curve.figure
        for curve in figure.curves:
            exact = curve["exact"]
            plot.plot([t * self.time_factor for t in curve["x"]],
                      [v * self.curve.factor for v in curve["y"]], label=curve["label"] or None,
                      color=theme["ink"] if exact else self.tone(curve["colour"]),
                      linewidth=0.8 if exact else 1.6,
                      linestyle="--" if exact else ("-", "--", ":")[curve["dash"]],
                      zorder=3 if exact else 2)
        plot.set_xlabel(f"time [{self.time_unit}]", fontsize=small, color=theme["soft"])
        plot.set_ylabel(self.curve.label, fontsize=small, color=theme["soft"])
        plot.set_title(figure.title, fontsize=10, color=theme["ink"], loc="left")
        plot.grid(color=theme["line"], linewidth=0.6)
        if len(figure.curves) > 1:
            plot.legend(fontsize=small - 1, frameon=False, labelcolor=theme["soft"],
                        loc="upper right")
        self.finish(plot, small)

    def draw(self, state: int) -> numpy.ndarray:
        """(height, width, 3) bytes of the frame. What stays is drawn once."""
        if self.ground is None:
            self.canvas.draw()
            self.ground = self.canvas.copy_from_bbox(self.sheet.bbox)
        self.canvas.restore_region(self.ground)
        time = self.motion.times[state]
        now = measured(round_off(time, self.motion.times), self.motion.time)
        self.clock.set_text(f"t = {now}")
        self.sheet.draw_artist(self.clock)
        for plot, mark in self.marks:
            mark.set_xdata([time * self.time_factor] * 2)
            plot.draw_artist(mark)
        frame = numpy.asarray(self.canvas.buffer_rgba())[:, :, :3].copy()
        (x, y), (width, height) = self.corner, self.pixels
        image = self.scene.picture(state, width, height, self.theme["panel"])
        room = frame[y: y + height, x: x + width]
        room[:] = image[: room.shape[0], : room.shape[1]]
        return frame


def round_off(time: float, times: list[float]) -> float:
    return 0.0 if abs(time) < 1e-9 * max(map(abs, times)) else time
