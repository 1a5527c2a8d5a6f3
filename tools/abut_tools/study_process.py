"""One run of a scene as a process: what it said, how it ended, how much memory it took."""

import os
import signal
import subprocess
import tempfile
import threading
import time
from dataclasses import dataclass
from pathlib import Path

MIB = 1024.0 * 1024.0
LOADED_MIB = 4.0


@dataclass
class Ended:
    code: int | None  # None: ended because of the time limit, or because the user wants no more
    said: str
    memory_mib: float | None  # None: ended before it could be looked at


def family(pid: int) -> list[int]:
    """A process and all below it."""
    found = [pid]
    try:
        text = Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="ascii")
    except OSError:
        return found
    for child in text.split():
        found += family(int(child))
    return found


def peak_of(pid: int) -> int:
    """Largest resident memory so far [bytes]; 0 when the process has ended."""
    try:
        for line in Path(f"/proc/{pid}/status").read_text(encoding="ascii").splitlines():
            if line.startswith("VmHWM:"):
                return 1024 * int(line.split()[1])
    except (OSError, ValueError):
        pass
    return 0


def end(process: subprocess.Popen) -> None:
    """As a user would: abut ends its solvers itself; only what does not listen is killed."""
    for kind, patience in ((signal.SIGINT, 5.0), (signal.SIGTERM, 5.0), (signal.SIGKILL, 5.0)):
        try:
            process.send_signal(kind)
            process.wait(patience)
            return
        except subprocess.TimeoutExpired:
            continue


def run(command: list[str], limit: float, stop: threading.Event) -> Ended:
    """Memory is that of coordinator and solvers together, looked at while they run: what wait4
    tells of a child includes this program's own memory before the child became another one."""
    peaks, started = {}, time.monotonic()
    with tempfile.TemporaryFile() as log:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=log, start_new_session=True)
        code = None
        while True:
            waited = time.monotonic() - started
            for pid in family(process.pid):
                peaks[pid] = max(peaks.get(pid, 0), peak_of(pid))
            found, status, usage = os.wait4(process.pid, os.WNOHANG)
            if found:
                code = process.returncode = os.waitstatus_to_exitcode(status)
                own = usage.ru_maxrss * 1024
                # Larger than ours before the start: it can only be the child's.
                if own > 1.05 * peak_of(os.getpid()):
                    peaks[process.pid] = max(peaks.get(process.pid, 0), own)
                break
            if stop.is_set() or waited > limit:
                end(process)
                break
            time.sleep(0.0002 if waited < 0.03 else 0.001 if waited < 0.1 else 0.02)
        log.seek(0)
        said = log.read().decode("utf-8", "replace").strip()
    memory = sum(peaks.values()) / MIB
    # With its libraries no program is smaller: this one was seen only as they were loaded.
    return Ended(code, said, memory if memory > LOADED_MIB else None)
