"""What a run's wall time went into: who computed, who waited, and for whom the run waited."""

import html

from abut_tools.page import Html, table_of
from abut_tools.run_folder import RunView
from abut_tools.tables import COLOURS, measured

MOST_BODIES = 24     # that are told one by one
COUPLING = "coupling"


def per_cent(part: float) -> str:
    return f"{100.0 * part:.0f} %" if part >= 0.0995 or part == 0.0 else f"{100.0 * part:.1f} %"


def shares_bar(parts: list[tuple[str, float]]) -> str:
    """One bar, with its words for those who do not see it; the last part is the coupling's."""
    words = html.escape(", ".join(f"{name} {per_cent(part)}" for name, part in parts))
    spans = ""
    for k, (name, part) in enumerate(parts):
        colour = "var(--line)" if k == len(parts) - 1 else COLOURS[k % len(COLOURS)]
        spans += (f'<span style="width:{100.0 * part:.2f}%;background:{colour}" '
                  f'title="{html.escape(name)} {per_cent(part)}"></span>')
    return f'<div class="shares" role="img" aria-label="Shares of the time: {words}">{spans}</div>'


def times_of(run: RunView) -> str:
    """Empty: the run told no shares (of an earlier abut, or ended from outside)."""
    timing = run.summary.get("timing", {})
    wall, waited, computed = (timing.get(key) for key in ("wall_s", "waited_s", "compute_s"))
    if not wall or not waited or not computed:
        return ""
    names = [name for name in waited if waited[name] is not None and
             computed.get(name) is not None]
    if len(names) > MOST_BODIES:
        names.sort(key=lambda name: -waited[name])
    shown = names[:MOST_BODIES]
    parts = [(name, min(1.0, waited[name] / wall)) for name in shown]
    others = sum(waited[name] for name in names[MOST_BODIES:]) / wall
    if others:
        parts.append((f"{len(names) - len(shown)} others", others))
    rest = max(0.0, 1.0 - sum(part for _, part in parts))
    parts.append((COUPLING, rest))
    rows = []
    for k, name in enumerate(shown):
        busy = min(1.0, computed[name] / wall)
        mark = f'<span class="mark" style="--c:{COLOURS[k % len(COLOURS)]}"></span>'
        rows.append([Html(mark + html.escape(name)), per_cent(parts[k][1]),
                     measured(computed[name], "s"), per_cent(busy), per_cent(1.0 - busy)])
    rows.append([COUPLING, per_cent(rest), measured(rest * wall, "s"), "", ""])
    note = ('<p class="note">While several bodies compute they share the time by what each takes; '
            "all other time is the coupling's: iterations, searches, messages, files, steps of the "
            "passive form. Which window and iteration took it: abut run --trace.</p>")
    table = table_of(["", "the run waited for it", "computed", "of the run", "did not compute"],
                     rows)
    return shares_bar(parts) + f'<div class="happened">{table}</div>' + note
