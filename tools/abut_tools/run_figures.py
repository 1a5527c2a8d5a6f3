"""The curves of a run: what its history tells, against the exact solution where there is one."""

import math

from abut_tools.run_folder import Run
from abut_tools.tables import (COLOURS, Figure, colour_of, less, plus, since_begin, sum_of,
                               with_jumps)
from abut_tools.units import measure_unit

MOST_CURVES = 8      # that the eye tells apart
MOST_BODIES = 6      # with a figure of energies each
NOTHING = 1e-9       # of the largest component: round-off


# ---- bars --------------------------------------------------------------


def exact_force_label(run: Run, port: str) -> str:
    """The exact force is the same on both sides of an interface: one curve, of its first side."""
    interfaces = run.interfaces()
    described = [name for name in interfaces if f"{name}.gap" in run.exact]
    for name in described:
        if interfaces[name].get("sides", [])[:1] == [port]:
            return "exact" if len(described) == 1 else f"{name}, exact"
    return ""


def port_figures(run: Run) -> list[Figure]:
    located = all("position" in run.port(name) for name in run.ports())
    place = "Position" if located else "Displacement"
    position = Figure("position", f"{place} of the contact points", place.lower(), "m")
    velocity = Figure("velocity", "Velocity of the contact points", "velocity", "m/s")
    force = Figure("force", "Contact force", "force, compression positive", "N")
    form = run.summary.get("closed_form", {})
    jumps = [form[key] for key in ("begin", "end") if form.get(key) is not None]
    for table, word in ((run.history, ""), (run.exact, ", exact")):
        if table is None:
            continue
        times, exact = table["time"], bool(word)
        for name in run.ports():
            if f"{name}.u" not in table:
                continue
            colour = colour_of(run.bodies(), run.port(name).get("body", name.split(".")[0]))
            offset = run.port(name).get("position", 0.0) if located else 0.0
            sign = -run.port(name).get("normal", 1.0)
            position.add(name + word, colour, times, plus(table[f"{name}.u"], offset), exact)
            steps = [(velocity, name + word, table[f"{name}.v"])]
            label = exact_force_label(run, name) if exact else name
            if label:
                steps.append((force, label, plus(table[f"{name}.force"], 0.0, sign)))
            for figure, label, values in steps:
                t, v = with_jumps(times, values, jumps) if exact else (times, values)
                figure.add(label, colour, t, v, exact)
    return [force, position, velocity]


# ---- plane and space ------------------------------------------------------


def size_of(columns: list[list]) -> list:
    """Magnitude of a vector by its components over time."""
    return [None if None in row else math.hypot(*row) for row in zip(*columns)]


def largest(values: list) -> float:
    return max((abs(v) for v in values if v is not None), default=0.0)


def add_sizes(figure: Figure, run: Run, vectors: dict[str, str], colours: dict[str, str]) -> None:
    """Magnitudes, of the largest where there are many."""
    sizes = {label: size_of([column for _, column in run.vector(name)])
             for label, name in vectors.items()}
    shown = [label for label in sizes if largest(sizes[label]) > 0.0]
    if len(shown) > MOST_CURVES:
        figure.title += f", {MOST_CURVES} largest of {len(shown)}"
        ranked = sorted(shown, key=lambda label: -largest(sizes[label]))[:MOST_CURVES]
        shown = [label for label in shown if label in ranked]
    for k, label in enumerate(shown):
        crowd = len(shown) > len(set(colours.get(each, "") for each in shown))
        colour = COLOURS[k % len(COLOURS)] if crowd else colours.get(label, COLOURS[0])
        figure.add(label, colour, run.history["time"], sizes[label],
                   dash=k // len(COLOURS) if crowd else 0)


def add_components(figure: Figure, run: Run, vectors: dict[str, str],
                   colours: dict[str, str], scale: float = 0.0) -> bool:
    """Components that are there; whether they are few enough to be told apart."""
    told = {label: run.vector(name) for label, name in vectors.items()}
    bound = NOTHING * max((largest(column) for each in told.values() for _, column in each),
                          default=0.0)
    bound = max(bound, NOTHING * scale)
    curves = [(label, axis, column) for label, each in told.items() for axis, column in each
              if largest(column) > bound]
    if len(curves) > MOST_CURVES:
        return False
    axes = sorted({axis for _, axis, _ in curves})
    for label, axis, column in curves:
        name = f"{label} {axis}".strip()
        figure.add(name, colours.get(label, COLOURS[0]), run.history["time"], column,
                   dash="xyz".index(axis) if len(axes) > 1 else 0)
    return True


def vector_figure(run: Run, figure: Figure, vectors: dict[str, str],
                  colours: dict[str, str], scale: float = 0.0) -> Figure:
    if not add_components(figure, run, vectors, colours, scale):
        figure.title += ", magnitude"
        add_sizes(figure, run, vectors, colours)
    return figure


def joint_figures(run: Run) -> list[Figure]:
    """Forces of contacts and ties: of the side that meets nobody else, or else of ports."""
    ports, colours = set(run.vector_ports()), {}
    contacts, ties, shared = {}, {}, set()
    for k, name in enumerate(run.interfaces()):
        sides = [side for side in run.interfaces()[name].get("sides", []) if side in ports]
        side = run.side_alone(name)
        colours[name] = COLOURS[k % len(COLOURS)]
        if side in ports:
            (ties if run.is_tie(name) else contacts)[name] = f"{side}.force"
        else:
            shared.update(sides or (ports if not run.interfaces()[name].get("sides") else ()))
    if not run.interfaces():
        shared = ports
    figures = []
    for kind, vectors, title in (("force", contacts, "Contact force"), ("tie_force", ties,
                                                                         "Force of ties")):
        figure = Figure(kind, title, "force", "N")
        add_sizes(figure, run, vectors, colours)
        figures.append(figure)
        if len(vectors) > 3:
            continue
        for name, column in vectors.items():
            side = column.removesuffix(".force")
            parts = Figure(f"{kind}_{name}", f"Force of {name} on {side}", "force", "N")
            each = {"": column}
            if add_components(parts, run, each, {"": colours[name]}) and len(parts.curves) > 1:
                for k, curve in enumerate(parts.curves):
                    curve.update(colour=COLOURS[k], dash=0)
                figures.append(parts)
    figure = Figure("port_force", "Force at ports", "force", "N")
    named = {name: f"{name}.force" for name in run.vector_ports() if name in shared}
    add_sizes(figure, run, named, body_colours(run, named))
    return [*figures, figure]


def body_colours(run: Run, names: dict[str, str]) -> dict[str, str]:
    """Those of the bodies, as long as no body has two of the names."""
    bodies = [name.split(".")[0] for name in names]
    if len(set(bodies)) < len(bodies):
        return {name: COLOURS[k % len(COLOURS)] for k, name in enumerate(names)}
    return {name: colour_of(run.bodies(), body) for name, body in zip(names, bodies)}


def vector_figures(run: Run) -> list[Figure]:
    """Motions of ports and points, and reactions."""
    ports = run.vector_ports()
    figures = []
    for key, title, quantity, unit in (("u", "Displacement of ports", "displacement", "m"),
                                       ("v", "Velocity of ports", "velocity", "m/s")):
        vectors = {name: f"{name}.{key}" for name in ports}
        figures.append(vector_figure(run, Figure(f"port_{quantity}", title, quantity, unit),
                                     vectors, body_colours(run, vectors)))
    found = [match[1] for match in run.history.matching(r"(.+\..+)\.reaction_x")]
    vectors = {name: f"{name}.reaction" for name in found}
    colours = {name: COLOURS[k % len(COLOURS)] for k, name in enumerate(found)}
    figures.append(vector_figure(run, Figure("reaction", "Reactions of constraints", "force", "N"),
                                 vectors, colours))
    return figures


def reaction_figure(run: Run) -> Figure:
    """Of bars: one number per support."""
    figure = Figure("reaction_bars", "Reactions of supports", "force", "N")
    for k, match in enumerate(run.history.matching(r"(.+\..+)\.reaction")):
        figure.add(match[1], COLOURS[k % len(COLOURS)], run.history["time"],
                   run.history[match[0]])
    return figure


# ---- bodies ------------------------------------------------------------


def mean_velocity_figure(run: Run) -> Figure:
    mean = Figure("mean_velocity", "Mean velocity of the bodies", "mean velocity", "m/s")
    for body in run.bodies():
        for table, word in ((run.history, ""), (run.exact, ", exact")):
            if table is not None and f"{body}.mean_velocity" in table:
                mean.add(body + word, colour_of(run.bodies(), body), table["time"],
                         table[f"{body}.mean_velocity"], bool(word))
    vectors = {body: f"{body}.mean_velocity" for body in run.bodies()
               if f"{body}.mean_velocity_x" in run.history}
    scale = run.speed_scale()
    return vector_figure(run, mean, vectors, body_colours(run, vectors), scale) if vectors else mean


def energy_figures(run: Run) -> list[Figure]:
    energies = []
    for body in run.bodies() if len(run.bodies()) <= MOST_BODIES else []:
        energy = Figure(f"energy_{body}", f"Energy of {body}", "energy", "J")
        for table, word in ((run.history, ""), (run.exact, ", exact")):
            if table is None or f"{body}.kinetic" not in table:
                continue
            for colour, kind in zip(COLOURS, ("kinetic", "stored", "total")):
                energy.add(kind + word, colour, table["time"], table[f"{body}.{kind}"], bool(word))
        if any(y for curve in energy.curves for y in curve["y"]):  # a wall holds none
            energies.append(energy)
    return energies + whole_energy(run)


def alone(run: Run) -> list[str]:
    """Bodies that are no part of another one, whose energies would count twice."""
    members = {member["name"] for body in run.summary.get("bodies", [])
               for member in body.get("members", [])}
    return [body for body in run.bodies() if body not in members]


def whole_energy(run: Run) -> list[Figure]:
    bodies, figure = alone(run), Figure("energy", "Energy of all bodies", "energy", "J")
    if len(bodies) < 2:
        return []
    sums = {kind: sum_of([run.history[f"{body}.{kind}"] for body in bodies
                          if f"{body}.{kind}" in run.history])
            for kind in ("kinetic", "stored", "total", "dissipated", "external_work")}
    bound = NOTHING * largest(sums["total"])
    for colour, (kind, values) in zip(COLOURS, sums.items()):
        if largest(values) > bound:
            figure.add(kind.replace("_", " "), colour, run.history["time"], values)
    return [figure]


def own_energy(run: Run, body: str) -> list:
    """Kinetic, stored and what became heat, less what loads have put in."""
    held = [run.history[f"{body}.total"]]
    if f"{body}.dissipated" in run.history:
        held.append(run.history[f"{body}.dissipated"])
    return less(sum_of(held), run.history[f"{body}.external_work"])


def energy_error_figure(run: Run) -> Figure:
    """What the measures energy.*.relative_* are the largest and last values of, in per cent: only
    where there is something to compare with, relative to the run's own scales."""
    figure = Figure("energy_error", "Change of the energies, with friction of passive windows"
                    if run.summary.get("accuracy", {}).get("given_up", {}).get("passive_windows")
                    else "Energy error", "error", "%")
    scales = run.summary.get("energy_scales", {})
    times = run.history["time"]
    errors = []
    for body, scale in scales.get("bodies", {}).items():
        exact = run.exact is not None and f"{body}.total" in run.exact
        error = (less(run.history[f"{body}.total"], run.exact[f"{body}.total"]) if exact
                 else since_begin(own_energy(run, body)))
        if scale and any(error):
            errors.append((body, plus(error, 0.0, 100.0 / scale)))
    if len(errors) >= MOST_CURVES:
        figure.title += f", {MOST_CURVES - 1} largest of {len(errors)}"
        errors.sort(key=lambda error: -largest(error[1]))
    for body, error in errors[:MOST_CURVES - 1]:
        figure.add(body, colour_of(run.bodies(), body), times, error)
    held = [own_energy(run, body) for body in alone(run)]
    held += [run.history[match[0]] for match in run.history.matching(r"(.+)\.whole")]
    if scales.get("total") and held:
        drift = since_begin(sum_of(held))
        figure.add("all bodies", COLOURS[2], times, plus(drift, 0.0, 100.0 / scales["total"]))
    return figure


# ---- measures over time ------------------------------------------------


def measure_figures(run: Run) -> list[Figure]:
    """What the scene asks for by output.measures: a figure for every unit."""
    figures = {}
    for name in run.measured.columns if run.measured else ():
        if name == "time":
            continue
        unit = measure_unit(name)
        # The unit stands beside every title, in words of the scene's own system.
        figure = figures.setdefault(
            unit, Figure(f"measures_{len(figures)}", "Measures", "measure", unit))
        figure.add(name.removeprefix("body."), COLOURS[len(figure.curves) % len(COLOURS)],
                   run.measured["time"], run.measured[name])
    return list(figures.values())


# ---- interfaces ------------------------------------------------------------


def interface_figures(run: Run) -> list[Figure]:
    gap = Figure("gap", "Gap", "gap", "m")
    iterations = Figure("iterations", "Schwarz iterations per window", "iterations", "", True)
    names = [match[1] for match in run.history.matching(r"(.+)\.iterations")]
    for name in names:
        colour = colour_of(names, name)
        for table, word in ((run.history, ""), (run.exact, ", exact")):
            if table is not None and f"{name}.gap" in table:
                gap.add(name + word, colour, table["time"], table[f"{name}.gap"], bool(word))
        if len(names) <= MOST_CURVES:
            iterations.add(name, colour, run.history["time"], run.history[f"{name}.iterations"])
    if len(names) > MOST_CURVES:
        most = [max((v for v in row if v is not None), default=None) for row in
                zip(*(run.history[f"{name}.iterations"] for name in names))]
        iterations.add("largest of all interfaces", COLOURS[0], run.history["time"], most)
    return [gap, iterations]


def figures_of(run: Run) -> list[Figure]:
    figures = (port_figures(run) + joint_figures(run) + [reaction_figure(run)] +
               vector_figures(run) + [mean_velocity_figure(run)] + energy_figures(run) +
               [energy_error_figure(run)] + measure_figures(run) + interface_figures(run))
    for figure in figures:
        figure.unit = run.units.word(figure.unit)
    return [figure for figure in figures if figure.curves]


def force_figure(figures: list[Figure]) -> Figure | None:
    """The one to stand beside the bodies: forces, or else what comes first."""
    wanted = ("force", "tie_force", "port_force", "reaction", "reaction_bars", "energy")
    named = {figure.name: figure for figure in figures}
    return next((named[name] for name in wanted if name in named),
                next((figure for figure in figures if figure.name.startswith("energy")),
                     figures[0] if figures else None))
