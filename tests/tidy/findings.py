"""What the tidy checks share: which files to read, and how a finding is reported."""

import subprocess
import sys
from pathlib import Path
from typing import Callable, NamedTuple

CPP = (".hpp", ".cpp")
CODE = CPP + (".py", ".proto", ".sh", ".cmake")


class Finding(NamedTuple):
    path: str
    line: int
    what: str
    remedy: str

    def __str__(self) -> str:
        return f"{self.path}:{self.line}: {self.what}: {self.remedy}"


def project_files(root: Path) -> list[str]:
    """Paths of the project's files, relative to root: tracked and new ones, not the ignored."""
    command = ["git", "-C", str(root), "ls-files", "-co", "--exclude-standard"]
    try:
        listing = subprocess.run(command, capture_output=True, text=True, check=True).stdout
        names = listing.splitlines()
    except (OSError, subprocess.CalledProcessError):  # a tree without git: an archive, an image
        names = [str(path.relative_to(root)) for path in root.rglob("*") if path.is_file()]
    ignored = ("build/", "runs/", ".git/")
    kept = (name for name in names if not name.startswith(ignored) and "__pycache__" not in name)
    return sorted(name for name in kept if (root / name).is_file())


def read_lines(root: Path, name: str) -> list[str]:
    return (root / name).read_text(encoding="utf-8").splitlines()


def run(check: Callable[[Path], list[Finding]]) -> None:
    """Checks the tree named on the command line; exit code 1 when there is something to say."""
    root = Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    found = check(root)
    for finding in found:
        print(finding)
    sys.exit(1 if found else 0)
