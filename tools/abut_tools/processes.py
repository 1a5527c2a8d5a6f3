"""Whether processes of this machine are alive, and what they use, as /proc tells."""

import os
import time
from pathlib import Path

PROC = Path("/proc")
WORDS = {"R": "computes", "S": "waits", "D": "waits for a disk", "T": "is stopped",
         "t": "is stopped", "Z": "has ended", "X": "has ended"}


def same_machine(machine: dict) -> bool:
    """Whether process ids of the run are ours: the machine has not started anew since, and they are
    counted as here (containers count their own)."""
    try:
        boot = (PROC / "sys/kernel/random/boot_id").read_text(encoding="ascii").strip()
        return machine.get("boot") == boot and \
            machine.get("process_ids") == os.readlink(PROC / "self/ns/pid")
    except OSError:
        return False


def stat_of(process: dict) -> list[str] | None:
    """Fields of /proc/ID/stat from the state on; None: it is gone, or another one has its id."""
    try:
        text = (PROC / str(process["id"]) / "stat").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return None
    fields = text[text.rfind(")") + 2:].split()
    return fields if len(fields) > 21 and fields[19] == process["began"] else None


def alive(process: dict) -> bool:
    fields = stat_of(process)
    return fields is not None and fields[0] not in "ZX"


class Usage:
    """What processes use, from look to look."""

    def __init__(self):
        self.before = {}  # id -> (clock, seconds of processor time)

    def of(self, process: dict) -> dict:
        """Words for people, share of a core since the last look, bytes of memory."""
        fields = stat_of(process)
        if fields is None or fields[0] in "ZX":
            return {"alive": False, "words": "has ended"}
        ticks = os.sysconf("SC_CLK_TCK")
        now, seconds = time.monotonic(), (int(fields[11]) + int(fields[12])) / ticks
        told = {"alive": True, "words": WORDS.get(fields[0], "runs"),
                "memory": int(fields[21]) * os.sysconf("SC_PAGE_SIZE")}
        before = self.before.get(process["id"])
        if before and now - before[0] < 0.5:
            return {**told, **before[2]}
        share = {}
        if before:
            share = {"cores": (seconds - before[1]) / (now - before[0])}
            # A look sees an instant; what it did since the last one says more.
            if fields[0] in "RS":
                share["words"] = "computes" if share["cores"] > 0.5 else \
                    "waits" if share["cores"] < 0.05 else "computes in part"
        self.before[process["id"]] = (now, seconds, share)
        return {**told, **share}
