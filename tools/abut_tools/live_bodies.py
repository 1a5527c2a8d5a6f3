"""The bodies of a run that goes on, made anew now and then, beside what waits for an answer."""

import threading
import time
from pathlib import Path

from abut_tools.bodies_page import alternative, fitting_motion, turning_words, words_of
from abut_tools.tables import ToolError
from abut_tools.units import Units
from abut_tools.vtu import listed_states

LIMIT = 1_000_000    # bytes that a page takes again and again
STATES = 60
REST = 4.0           # after making them, for so many times as long nothing is made
LEAST_REST = 2.0     # [s]


class LiveBodies:
    def __init__(self, folder: Path):
        self.folder = folder
        self.lock = threading.Lock()
        self.version, self.data, self.note = 0, None, ""
        self.states, self.run = -1, 0   # that were listed when they were made; of which run
        self.busy, self.next = False, 0.0

    def look(self, scale: tuple[float, str], units: Units, run: int) -> None:
        """Has them made where there is something new, at once or later; waits for nothing. `run`:
        changes where another run has taken the folder."""
        with self.lock:
            if run != self.run:
                self.run, self.states = run, -1
            if self.busy or time.monotonic() < self.next:
                return
            self.busy = True
        threading.Thread(target=self.make, args=(scale, units), daemon=True).start()

    def make(self, scale: tuple[float, str], units: Units) -> None:
        began = time.monotonic()
        made, note, states = None, "", self.states
        try:
            states = len(listed_states(self.folder))
            if states != self.states:
                made = fitting_motion(self.folder, scale, units, LIMIT, STATES)
        except (ToolError, OSError, ValueError) as error:  # as they are being replaced
            note = str(error)
        except Exception as error:  # pylint: disable=broad-except  a thread that dies tells nobody
            note = f"the bodies cannot be shown: {error!r}"
        with self.lock:
            self.note = note
            if not note and states != self.states:
                self.states, self.version = states, self.version + 1
                self.data = None
                if made:
                    self.data = {**made[1], "start": len(made[0].times) - 1,
                                 "alternative": alternative(made[0]),
                                 "words": words_of(made[0]) +
                                 turning_words(made[0].dimension)}
            now = time.monotonic()
            self.next = now + max(LEAST_REST, REST * (now - began))
            self.busy = False

    def told(self) -> tuple[int, dict | None]:
        with self.lock:
            return self.version, self.data
