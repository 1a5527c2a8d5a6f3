#!/usr/bin/env python3
"""Goal: a study file, whatever it holds, is read or refused in words. Oracle: no other exception
than the one that the tool tells its user.

Changes shipped studies at random: lines that are gone or come twice, values of other kinds, files
that end early, characters from anywhere.

usage: study_files.py ABUT ROOT [COUNT [SEED]]
"""

import functools
import random
import re
import sys
import tempfile
from pathlib import Path

ABUT, ROOT = (Path(argument).resolve() for argument in sys.argv[1:3])
COUNT, SEED = (int(word) for word in (sys.argv[3:] + ["300", "1"][len(sys.argv) - 3:]))
sys.dont_write_bytecode = True
sys.path.insert(0, str(ABUT.parents[1] / "share" / "abut" / "python"))
from abut_tools import study_file  # noqa: E402
from abut_tools.tables import ToolError  # noqa: E402

VALUES = ("[]", "{}", "null", "-1", "0", "1e999", "-.5", "~", "''", "'*'", "true", "[1, [2]]",
          "{a: 1}", "&a [*a]", "!!python/name:os.system", "../../../etc/passwd", "1_0", "0x1F",
          "{", "]", "|", "2001-01-01", "1:30", "é\u2028", "9" * 400, "a.b[3].c",
          "{from: 1, to: 0, count: -1}", "[[[[[[[[]]]]]]]]", "? x", "<<: {}", "nan", "(" * 2000,
          "1/0", "a**9**9**9")


def changed(text: str, rng: random.Random) -> str:
    lines = text.split("\n")
    for _ in range(rng.randrange(1, 4)):
        k = rng.randrange(len(lines))
        way = rng.randrange(6)
        if way == 0:
            lines.insert(rng.randrange(len(lines)), lines[k])
        elif way == 1 and len(lines) > 1:
            del lines[k]
        elif way == 2:  # the value of a key, in a map over lines or in one line
            found = list(re.finditer(r"(?<=[:\[,] )[^,:\]}]+", lines[k]))
            if found:
                one = rng.choice(found)
                lines[k] = lines[k][:one.start()] + rng.choice(VALUES) + lines[k][one.end():]
        elif way == 3:
            lines[k] = " " * rng.randrange(6) + lines[k].lstrip()
        elif way == 4:
            at = rng.randrange(len(lines[k]) + 1)
            lines[k] = lines[k][:at] + chr(rng.choice((0, 9, 34, 58, 91, 123, 42, 0x1F600))) + \
                lines[k][at + rng.randrange(2):]
        else:
            lines = lines[:max(k, 1)]
    return "\n".join(lines)


def main():
    # The program is asked once, and not what a `*` means: that is its own answer.
    study_file.KeyList = functools.cache(study_file.KeyList)
    study_file.KeyList(ABUT).refuse_idle_stars = lambda *_: None
    texts = [path.read_text(encoding="utf-8") for path in sorted((ROOT / "studies").glob("*.yaml"))]
    rng = random.Random(SEED)
    read = 0
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "configs").symlink_to(ROOT / "configs")  # where studies look for scenes
        path = Path(folder) / "studies" / "study.yaml"
        path.parent.mkdir()
        for number in range(COUNT):
            path.write_text(changed(rng.choice(texts), rng), encoding="utf-8")
            try:
                study_file.read_study(path, ABUT, number % 2 == 0)
                read += 1
            except ToolError:
                pass
            except BaseException:
                kept = Path("study_file_that_ended_it.yaml")
                kept.write_bytes(path.read_bytes())
                print(f"number {number} of seed {SEED}, kept in {kept.resolve()}", file=sys.stderr)
                raise
    print(f"{COUNT} files, {read} read, {COUNT - read} refused in words")
    sys.exit(0 if 0 < read < COUNT else 1)


if __name__ == "__main__":
    main()
