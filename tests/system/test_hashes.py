"""Goal: a change that should keep every bit keeps every bit. Oracle: tests/data/hashes.txt, the
hashes of the bodies at the end of every shipped scene, in one process and in processes.

Bits belong to a compiler, a C library and the vector units of a machine: elsewhere the list says
nothing, and the test is skipped. Who changes bits on purpose records them anew, and says why.
usage: test_hashes.py ABUT ROOT RUNS Local       the shared runs against the list
       test_hashes.py ABUT ROOT RUNS Processes   the same scenes in processes
       test_hashes.py ABUT ROOT RUNS record      writes the list; two minutes
"""

import platform
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.dont_write_bytecode = True
from support import ABUT, ROOT, shared_run, strict_json  # noqa: E402

LIST = ROOT / "tests" / "data" / "hashes.txt"
SKIPPED = 77
HEAD = """# Hashes of the bodies at the end of every shipped scene: in one process, in processes.
# Recorded by: python3 tests/system/test_hashes.py BIN/abut . BUILD/tests/system/runs record
"""


def machine() -> str:
    """What bits depend on beside the program's text."""
    flags = set()
    for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("flags"):
            flags = set(line.split(":", 1)[1].split())
            break
    units = [name for name in ("avx512f", "avx2", "fma") if name in flags]
    versions = strict_json((shared_run("two_bars") / "summary.json").read_text())["versions"]
    return " ".join([platform.machine(), f"gcc-{versions['compiler']}",
                     "-".join(platform.libc_ver()), *units])


def scenes() -> list:
    found = sorted(path.relative_to(ROOT / "configs").with_suffix("").as_posix()
                   for path in (ROOT / "configs").rglob("*.yaml"))
    return [name for name in found
            if not name.startswith(("invalid/", "optional/")) and name != "two_bars_processes"]


def bodies(folder: Path) -> str:
    """One word for the hashes of all bodies."""
    summary = strict_json((folder / "summary.json").read_text(encoding="utf-8"))
    return "-".join(summary["body_hashes"][name] for name in sorted(summary["body_hashes"]))


def in_processes(scene: str) -> str:
    with tempfile.TemporaryDirectory(dir="/tmp") as folder:
        subprocess.run([ABUT, "run", ROOT / "configs" / f"{scene}.yaml", "--out", f"{folder}/o",
                        "--quiet"], capture_output=True, check=True)
        return bodies(Path(folder) / "o")


def everywhere(which: str) -> dict:
    if which == "Local":
        return {scene: bodies(shared_run(scene)) for scene in scenes()}
    with ThreadPoolExecutor(2) as pool:
        return dict(zip(scenes(), pool.map(in_processes, scenes())))


def record() -> int:
    here, there = everywhere("Local"), everywhere("Processes")
    lines = [f"{scene} {here[scene]} {there[scene]}\n" for scene in scenes()]
    LIST.write_text(f"{HEAD}machine {machine()}\n{''.join(lines)}", encoding="utf-8")
    return 0


def compare(which: str) -> int:
    lines = [line for line in LIST.read_text(encoding="utf-8").splitlines() if line[0] != "#"]
    recorded_on = lines[0].partition(" ")[2]
    if recorded_on != machine():
        print(f"skipped: recorded on {recorded_on}, this is {machine()}")
        return SKIPPED
    column = 1 if which == "Local" else 2
    expected = {words[0]: words[column] for words in map(str.split, lines[1:])}
    found = everywhere(which)
    wrong = [scene for scene in sorted(expected.keys() | found.keys())
             if expected.get(scene) != found.get(scene)]
    for scene in wrong:
        what = "changed" if scene in expected and scene in found else "new or gone"
        print(f"{scene}: {what}")
    if wrong:
        print(f"{len(wrong)} of {len(found)} scenes end with other bits than {LIST.name} says: "
              "mend the change, or record them anew and say why in the commit")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(record() if sys.argv[4] == "record" else compare(sys.argv[4]))
