"""Pages in Chromium: whether they are drawn whole, at any width, light and dark."""

import html
import json
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

SKIPPED = 77
CHROMIUM = ("chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic",
            "--no-first-run", "--disable-background-networking", "--disable-component-update",
            "--disable-sync", "--hide-scrollbars", "--allow-file-access-from-files")


def is_there() -> bool:
    return shutil.which(CHROMIUM[0]) is not None


def look_at(page: Path, width: int, dark: bool, wanted: dict) -> bool:
    """Whether Chromium draws a page whole, in a window of that width, without a complaint."""
    with tempfile.TemporaryDirectory() as profile:
        # A window has a least width; a frame inside it has none.
        frame = page.with_name("frame.html")
        frame.write_text(f'<body style="margin:0"><iframe src="{page.name}" style="border:0" '
                         f'width="{width}" height="900" onload="setInterval(() => {{ document.'
                         "body.dataset.inner = JSON.stringify(Object.assign({}, this."
                         'contentDocument.body.dataset)); }, 500)"></iframe>')
        command = [*CHROMIUM, f"--user-data-dir={profile}", "--window-size=1920,1000",
                   "--enable-logging=stderr", "--virtual-time-budget=20000", "--dump-dom"]
        if dark:
            command.append("--blink-settings=preferredColorScheme=0")
        result = subprocess.run([*command, frame.as_uri()], capture_output=True, text=True,
                                timeout=180, check=True)
    told = re.search('data-inner="([^"]*)"', result.stdout)
    found = json.loads(html.unescape(told[1])) if told else {}
    complaints = [line for line in result.stderr.splitlines() if ":CONSOLE" in line]
    if found != wanted or complaints:
        print(f"{page}, width {width}, dark {dark}: {found}, wanted {wanted}", *complaints,
              sep="\n")
        return False
    return True
