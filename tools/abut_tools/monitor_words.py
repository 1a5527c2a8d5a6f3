"""What a monitor tells of a run, as a page shows it: data alone, no HTML."""

import time

from abut_tools.live_run import LiveRun
from abut_tools.run_tables import clean, reasons_of, status_of
from abut_tools.tables import few, measured

QUIET = 3.0          # [s] after which a window counts as long
MOST_BODIES = 40     # that are told one by one


def duration(seconds: float | None) -> str:
    if seconds is None:
        return ""
    if seconds < 100.0:
        return f"{seconds:.0f} s" if seconds >= 9.95 else f"{seconds:.1f} s"
    minutes, hours = seconds / 60.0, seconds / 3600.0
    if minutes < 100.0:
        return f"{minutes:.0f} min"
    return f"{hours:.1f} h" if hours < 48.0 else f"{hours / 24.0:.1f} d"


def clock(moment: float) -> str:
    """Of the clock on the wall here, with the day where it is another one."""
    told = time.localtime(moment)
    day = "" if told[:3] == time.localtime()[:3] else "%Y-%m-%d "
    return time.strftime(day + "%H:%M:%S", told)


def badge(live: LiveRun) -> tuple[str, str, str]:
    """Words, kind, and a sentence beside them."""
    status = live.status
    progress = status.progress
    seen = clock(progress["written"]) if progress else ""
    if status.state == "ended":
        words, kind = status_of(live.view())
        return words, kind, "; ".join(reasons_of(live.view())) or \
            f"The run has ended. Its page: abut report {live.folder}"
    if status.state == "runs":
        if status.summary is not None:
            return "next stage", "ok", "A stage has ended, the next one is being set up."
        age = time.time() - progress["written"]
        if age > QUIET:
            return "runs", "ok", f"In this window, or what is written of it, for {duration(age)}."
        return "runs", "ok", f"Seen {duration(max(age, 0.0))} ago."
    if status.state == "killed":
        return "killed", "failed", (
            f"The program that ran it is gone and has told no end: it was killed, or the machine "
            f"ended it. Last sign of life at {seen}.{go_on(live)}")
    silence = time.monotonic() - live.changed
    if status.state == "silent":
        return "silent", "warned", (
            f"No sign of life for {duration(silence)}. The run is on another machine, or in a "
            f"container: whether it still goes on is not to be seen from here. Written last at "
            f"{seen} of its clock.")
    if status.state == "elsewhere":
        return "runs elsewhere", "ok", (
            f"On another machine, or in a container. Something new came {duration(silence)} ago.")
    if status.state == "set up":
        return "set up", "ok", "Bodies are being built: nothing is written yet."
    return "unfinished", "warned", (
        "The run has left no end and tells no progress: it was ended from outside, or by an abut "
        f"that writes none.{go_on(live)}")


def go_on(live: LiveRun) -> str:
    kept = (live.folder / "checkpoint.abut").exists()
    return f" abut resume {live.folder} goes on from its checkpoint." if kept else ""


def progress_part(live: LiveRun) -> float | None:
    """Of the scene's time, from 0 to 1."""
    told = live.status.summary if live.status.ended else live.status.progress
    span = (told or {}).get("time", {})
    begin, end, reached = (span.get(key) for key in ("begin", "end", "reached"))
    if None in (begin, end, reached) or end <= begin:
        return None
    return min(1.0, max(0.0, (reached - begin) / (end - begin)))


def rate(live: LiveRun) -> float | None:
    """Exchanges per second, of the last seconds."""
    if not live.rates:
        return None
    (wall, calls), (last, now) = live.rates[0], live.rates[-1]
    if len(live.rates) == 1:
        wall, calls = 0.0, 0
    return (now - calls) / (last - wall) if last > wall else None


def facts(live: LiveRun) -> list[list[str]]:
    """Names and values, the most important first."""
    status, units = live.status, live.units()
    told = status.summary if status.ended else status.progress
    if not told:
        return []
    span = told.get("time", {})
    rows = [["time of the scene", f"{measured(span.get('reached'), units.word('s'))} of "
             f"{measured(span.get('end'), units.word('s'))}"]]
    wall = told.get("wall_s") if not status.ended else told.get("timing", {}).get("wall_s")
    goes_on = status.state in ("runs", "elsewhere")
    if goes_on:
        left = told.get("left_s")
        if left is not None and status.state == "runs":
            left = max(0.0, left - max(0.0, time.time() - told["written"]))
        rows.append(["left", f"about {duration(left)}" if left is not None else "not known yet"])
    if wall is not None:
        rows.append(["computed for", duration(wall)])
    rows.append(["windows", str(told.get("windows", ""))])
    exchanges = str(told.get("exchanges", ""))
    speed = rate(live)
    if goes_on and speed is not None:
        rows.append(["exchanges per second", few(float(f"{speed:.3g}"))])
    rows.append(["exchanges", exchanges])
    if not status.ended:
        rows.append(["in contact, or tied", str(told["in_contact"])])
        rows.append(["iterations of the last window", str(told["iterations"])])
    elif told.get("contact_windows") is not None:
        rows.append(["windows in contact", str(told["contact_windows"])])
    return [row for row in rows if row[1]]


def shares(live: LiveRun) -> list[dict]:
    """Who took the time: of all of it, bodies that were waited for, and the coupling."""
    status = live.status
    if status.ended:
        timing = status.summary.get("timing", {})
        waited, wall = timing.get("waited_s", {}), timing.get("wall_s")
    else:
        progress = status.progress or {}
        waited = {name: told["waited_s"] for name, told in progress.get("of_bodies", {}).items()}
        wall = progress.get("wall_s")
    if not wall or not waited:
        return []
    parts = [{"name": name, "part": min(1.0, (seconds or 0.0) / wall)}
             for name, seconds in waited.items()]
    rest = max(0.0, 1.0 - sum(part["part"] for part in parts))
    if len(parts) > MOST_BODIES:
        parts.sort(key=lambda part: -part["part"])
        others = sum(part["part"] for part in parts[MOST_BODIES:])
        parts = [*parts[:MOST_BODIES], {"name": "others", "part": others}]
    return [*parts, {"name": "coupling", "part": rest}]


def memory_words(told: dict) -> str:
    return f"{told['memory'] / 1048576.0:.0f} MiB" if "memory" in told else ""


def health_of(live: LiveRun) -> dict[str, dict]:
    """Of every body the process that it lives in; nothing where processes are not to be seen."""
    progress = live.status.progress
    if not progress or live.status.ended or not live.status.processes_seen:
        return {}
    if progress["local"]:
        told = live.usage.of(progress["program"])
        return {name: {**told, "where": "in the run's own process"}
                for name in progress["of_bodies"]}
    found = {}
    for process in progress["processes"]:
        told = live.usage.of(process)
        for name in process.get("bodies", []):
            found[name] = {**told, "where": f"process {process['id']}"}
    return {**found, **{name: {"where": "started by somebody else", "words": "", "alive": True}
                        for name in progress["of_bodies"] if name not in found}}


def bodies(live: LiveRun) -> dict:
    """A table: what is known of each body now."""
    progress, history, units = live.status.progress, live.history, live.units()
    health = health_of(live)
    names = [body["name"] for body in live.status.facts().get("bodies", [])]
    latest = dict(zip(history.names, history.latest.cells)) if history.latest else {}
    wall = (progress or {}).get("wall_s") or 0.0
    rows = []
    for name in names[:MOST_BODIES]:
        told, of = health.get(name, {}), (progress or {}).get("of_bodies", {}).get(name, {})
        energies = [latest.get(f"{name}.{kind}") for kind in ("kinetic", "stored")]
        speed = latest.get(f"{name}.mean_velocity")
        if speed is None:
            parts = [latest.get(f"{name}.mean_velocity_{axis}") for axis in "xyz"]
            parts = [part for part in parts if part is not None]
            speed = sum(part * part for part in parts) ** 0.5 if parts else None
        cores = told.get("cores")
        rows.append([
            name, told.get("words", ""),
            f"{100.0 * cores:.0f} %" if cores is not None else "", memory_words(told),
            f"{100.0 * of['waited_s'] / wall:.0f} %" if of and wall else "",
            str(of["exchanges"]) if of else "",
            measured(speed, units.word("m/s")),
            *(measured(energy, units.word("J")) for energy in energies), told.get("where", "")])
    heads = ["body", "state", "of a core", "memory", "waited for", "exchanges",
             "mean velocity" if any(f"{n}.mean_velocity" in latest for n in names) else "speed",
             "kinetic energy", "stored energy", "where"]
    kept = [k for k in range(len(heads)) if k == 0 or any(row[k] for row in rows)]
    ill = [row[0] for row in rows if not health.get(row[0], {}).get("alive", True)]
    return {"heads": [heads[k] for k in kept], "rows": [[row[k] for k in kept] for row in rows],
            "ill": ill, "more": max(0, len(names) - len(rows))}


def program_words(live: LiveRun) -> str:
    """Of the coordinator, as a process."""
    progress = live.status.progress
    if live.status.state != "runs" or progress["local"]:
        return ""
    told = live.usage.of(progress["program"])
    cores = f", {100.0 * told['cores']:.0f} % of a core" if "cores" in told else ""
    return f"The coordinator is process {progress['program']['id']}: {told['words']}{cores}, " \
           f"{memory_words(told)}."


def events(live: LiveRun) -> list[dict]:
    """The latest first."""
    second = live.units().word("s")
    span = (live.status.progress or live.status.summary or {}).get("time", {})
    size = max((abs(span[key]) for key in ("begin", "end") if span.get(key)), default=0.0)
    return [{"number": event["number"],
             "time": measured(clean(event.get("time"), size), second),
             "kind": event.get("kind", "").replace("_", " "), "subject": event.get("subject", ""),
             "text": event.get("text", "")} for event in reversed(live.events)]


def told(live: LiveRun, since: int, until: float, moving: int) -> dict:
    words, kind, sentence = badge(live)
    part = progress_part(live)
    return {
        "version": live.version, "reborn": live.reborn, "latest": live.latest(),
        "title": live.title(), "read": live.history.file.part(),
        "badge": [words, kind, sentence], "part": part,
        "ended": live.status.ended, "facts": facts(live), "shares": shares(live),
        "bodies": bodies(live), "coordinator": program_words(live), "events": events(live),
        "event_count": live.event_count, "warnings": live.warnings, "trouble": live.trouble,
        "figures": live.told_figures(since, until), "beside": live.beside, "moving": moving,
        "windows": (live.status.progress or live.status.summary or {}).get("windows", 0)}
