"""The page of a monitor and its data, on this machine alone, for whoever sits at it."""

import json
import re
import socket
import threading
import time
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

from abut_tools.live_bodies import LiveBodies
from abut_tools.live_run import LiveRun
from abut_tools.monitor_words import told
from abut_tools.tables import ToolError

HOST = "127.0.0.1"
# Another site's name that leads here would let that site's scripts read what we say.
OWN_NAME = re.compile(r"(127\.0\.0\.1|localhost|\[::1\])(:\d{1,5})?", re.IGNORECASE)
HEADERS = {
    "Content-Security-Policy": "default-src 'none'; script-src 'unsafe-inline'; style-src "
                               "'unsafe-inline'; img-src data:; connect-src 'self'; base-uri "
                               "'none'; form-action 'none'; frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff", "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin", "Cache-Control": "no-store"}
LEAST_REST = 0.4     # [s] between two looks at the folder
NEARLY = 0.98        # of the records are read
REST = 5.0           # or so many times as long as the last look took


class Watcher:
    """One reader of the folder for all pages; looks when somebody asks, and rarely enough."""

    def __init__(self, folder: Path):
        self.live, self.bodies = LiveRun(folder), LiveBodies(folder)
        self.lock = threading.Lock()
        self.next = 0.0

    def answer(self, since: int, until: float) -> dict:
        with self.lock:
            began = time.monotonic()
            if began >= self.next:
                self.live.look()
                now = time.monotonic()
                behind = self.live.history.file.part() < NEARLY  # what is there is read at once
                self.next = now + (0.0 if behind else max(LEAST_REST, REST * (now - began)))
            self.bodies.look(self.live.time_scale(), self.live.units(), self.live.reborn)
            data = told(self.live, since, until, self.bodies.told()[0])
            data["trouble"] = f"{data['trouble']} {self.bodies.note}".strip()
            return data


def handler_of(page: bytes, watcher: Watcher) -> type:
    class Handler(BaseHTTPRequestHandler):
        server_version, sys_version = "abut-monitor", ""
        protocol_version = "HTTP/1.1"
        timeout = 30

        def do_GET(self):  # pylint: disable=invalid-name
            if not OWN_NAME.fullmatch(self.headers.get("Host", "")):
                return self.refuse(403, "This is the monitor of a run. It is found under "
                                        "127.0.0.1 or localhost alone.")
            place = urlsplit(self.path)
            if place.path == "/":
                return self.send(page, "text/html; charset=utf-8")
            if place.path == "/state":
                asked = parse_qs(place.query)
                try:
                    since = int(asked.get("since", ["0"])[0])
                    until = float(asked.get("until", ["-inf"])[0])
                except ValueError:
                    return self.refuse(400, "since and until are numbers.")
                return self.send_json(lambda: watcher.answer(since, until))
            if place.path == "/bodies":
                return self.send_json(lambda: dict(zip(("version", "data"),
                                                       watcher.bodies.told())))
            return self.refuse(404, "Nothing is there.")

        def send_json(self, make):
            try:
                data = make()
            except ToolError as error:
                data = {"fault": str(error)}
            except OSError as error:
                data = {"fault": f"{error.filename}: {error.strerror}"}
            self.send(json.dumps(finite(data), separators=(",", ":"), allow_nan=False).encode(),
                      "application/json")

        def send(self, body: bytes, kind: str, code: int = 200):
            self.send_response(code)
            for name, value in HEADERS.items():
                self.send_header(name, value)
            self.send_header("Content-Type", kind)
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        def refuse(self, code: int, words: str):
            self.close_connection = True
            self.send((words + "\n").encode(), "text/plain; charset=utf-8", code)

        def send_error(self, code, message=None, explain=None):
            """Methods that there are none of, and what is no request."""
            self.refuse(405 if code == 501 else code, "It can be read with GET, and no more."
                        if code == 501 else "That is no request.")

        def log_message(self, format, *args):  # pylint: disable=redefined-builtin
            """Every page asks once a second."""

    return Handler


def finite(data):
    """Numbers that JSON has none for become null."""
    if isinstance(data, dict):
        return {key: finite(value) for key, value in data.items()}
    if isinstance(data, (list, tuple)):
        return [finite(value) for value in data]
    return None if isinstance(data, float) and data - data != 0.0 else data


class Server(ThreadingHTTPServer):
    daemon_threads = True
    allow_reuse_address = True

    def handle_error(self, request, client_address):
        """A page that was closed meanwhile."""


def serving(folder: Path, port: int, page: str) -> Server:
    """Throws ToolError where the port cannot be had."""
    try:
        return Server((HOST, port), handler_of(page.encode(), Watcher(folder)))
    except (OSError, socket.error) as error:
        raise ToolError(f"port {port} cannot be had: {error.strerror}. Choose another one with "
                        "--port, or leave that out for one that is free.", 2) from error
