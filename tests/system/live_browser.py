"""A page in Chromium that goes on by itself: opened, asked, photographed, over a pair of pipes."""

import base64
import json
import os
import select
import subprocess
import tempfile
import time

import browser


class LivePage:
    """One page at a time, of any width, light or dark."""

    def __enter__(self):
        self.profile = tempfile.TemporaryDirectory()
        ours, theirs = os.pipe(), os.pipe()  # what Chromium reads as 3, and writes as 4
        self.write, self.read = ours[1], theirs[0]
        command = [*browser.CHROMIUM, f"--user-data-dir={self.profile.name}",
                   "--remote-debugging-pipe", "about:blank"]
        script = f'exec "$@" 3<&{ours[0]} 4>&{theirs[1]}'
        self.process = subprocess.Popen(["/bin/bash", "-c", script, "-", *command],
                                        pass_fds=(ours[0], theirs[1]), stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        os.close(ours[0])
        os.close(theirs[1])
        self.number, self.buffer, self.said, self.session = 0, b"", [], None
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self.ask(f"{domain}.enable")
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        os.close(self.write)
        os.close(self.read)
        for _ in range(20):  # children of Chromium end a moment later
            try:
                return self.profile.cleanup()
            except OSError:
                time.sleep(0.1)

    def message(self, until: float) -> dict:
        while b"\0" not in self.buffer:
            if not select.select([self.read], [], [], max(0.0, until - time.monotonic()))[0]:
                raise TimeoutError("Chromium does not answer")
            piece = os.read(self.read, 1 << 20)
            if not piece:
                raise OSError("Chromium has ended")
            self.buffer += piece
        text, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(text)

    def ask(self, method: str, seconds: float = 20.0, **parameters) -> dict:
        self.number += 1
        asked = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            asked["sessionId"] = self.session
        os.write(self.write, json.dumps(asked).encode() + b"\0")
        until = time.monotonic() + seconds
        while True:
            told = self.message(until)
            if told.get("id") == self.number:
                if "error" in told:
                    raise ValueError(f"{method}: {told['error']}")
                return told["result"]
            params = told.get("params", {})
            if told.get("method") == "Runtime.exceptionThrown" or \
                    params.get("entry", {}).get("level") == "error":
                self.said.append(json.dumps(params)[:600])

    def open(self, address: str, width: int, height: int = 900, dark: bool = False) -> None:
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=height,
                 deviceScaleFactor=1, mobile=False)
        self.ask("Emulation.setEmulatedMedia", features=[
            {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        self.ask("Page.navigate", url=address)

    def value(self, script: str):
        """What a script comes to in the page, which may wait for it."""
        told = self.ask("Runtime.evaluate", expression=script, returnByValue=True,
                        awaitPromise=True)
        if "exceptionDetails" in told:
            raise ValueError(f"{script}: {told['exceptionDetails'].get('text')}")
        return told["result"].get("value")

    def wait(self, script: str, seconds: float = 40.0) -> None:
        """Until the script comes to something that is true."""
        until = time.monotonic() + seconds
        while not self.value(f"Boolean({script})"):
            if time.monotonic() > until:
                raise TimeoutError(f"{script} does not become true; {self.said}")
            time.sleep(0.1)

    def picture(self, path: str) -> None:
        height = self.value("document.documentElement.scrollHeight")
        width = self.value("document.documentElement.clientWidth")
        told = self.ask("Page.captureScreenshot", format="png", captureBeyondViewport=True,
                        clip={"x": 0, "y": 0, "width": width, "height": min(height, 6000),
                              "scale": 1})
        with open(path, "wb") as file:
            file.write(base64.b64decode(told["data"]))
