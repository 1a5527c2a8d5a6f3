"""Goal: what docs/ADDING.md says of files and lines is so, and its examples compile and prove
themselves.

The page is read: a diff is applied to copies of the files that it names, and every source that it
touches is compiled; a program is compiled against that and what is built, and must end with 0;
lines that stand below a file's name must stand in that file; commands must succeed.
usage: test_adding.py ABUT ROOT
"""

import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

from support import ABUT, ROOT, main

PAGE = ROOT / "docs" / "ADDING.md"
BUILD = ABUT.parents[1]
FLAGS = ["g++", "-std=c++20", "-O0", "-Wall", "-Wextra", "-Werror", "-Wno-psabi", "-isystem",
         "/usr/include/eigen3"]
LIBRARIES = ["coordinator/libabut_coupling.a", "subdomain_solver/materials/libabut_materials.a",
             "contract/libabut_contract.a", "base/libabut_dense.a", "base/libabut_base.a"]


def blocks(text: str) -> list:
    """(language, text, the line above) of every fenced block, in order."""
    found = []
    for match in re.finditer(r"^([^\n]*)\n```(\w+)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        found.append((match[2], match[3], match[1].strip()))
    return found


def sections() -> dict:
    parts = re.split(r"^## (.*)\n", PAGE.read_text(encoding="utf-8"), flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2]))


def apply(diff: str, folder: Path) -> list:
    """Writes the files of a diff, changed, below a folder; their paths. ValueError: none fits."""
    changed = []
    for old, name, body in re.findall(r"^--- (\S+)\n\+\+\+ b/(\S+)\n(.*?)(?=^--- |\Z)", diff,
                                      re.MULTILINE | re.DOTALL):
        text = "" if old == "/dev/null" else (ROOT / name).read_text(encoding="utf-8")
        for hunk in re.split(r"^@@\n", body, flags=re.MULTILINE)[1:]:
            lines = hunk.splitlines(keepends=True)
            before = "".join(line[1:] for line in lines if line[0] in " -")
            after = "".join(line[1:] for line in lines if line[0] in " +")
            if before and text.count(before) != 1:
                raise ValueError(f"{name} has {text.count(before)} places for\n{before}")
            text = text.replace(before, after) if before else after
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
        changed.append(name)
    return changed


def run(*command: object) -> subprocess.CompletedProcess:
    return subprocess.run([*map(str, command)], capture_output=True, text=True, check=False)


class Adding(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)

    def compile(self, *words: object):
        said = run(*FLAGS, "-I", self.folder, "-I", ROOT, "-I", BUILD, *words)
        self.assertEqual(said.returncode, 0, said.stderr)

    def unit(self, name: str, files: list) -> Path:
        """One file that includes others: what they include in turn is read once."""
        file = self.folder / f"{name}.cpp"
        file.write_text("".join(f'#include "{each}"\n' for each in files), encoding="utf-8")
        return file

    def example(self, section: str):
        parts = {language: text for language, text, _ in blocks(sections()[section])}
        changed = apply(parts["diff"], self.folder)
        self.assertGreater(len(changed), 2)
        for name in changed:  # headers alone, as tests include them
            if name.endswith(".hpp"):
                self.compile("-fsyntax-only", "-x", "c++", "-include", self.folder / name,
                             "/dev/null")
        sources = [self.folder / name for name in changed if name.endswith(".cpp")]
        used = [path for path in sources
                if re.search(r"subdomain_solver/materials/|coordinator/coupling/", str(path))]
        self.compile("-fsyntax-only",
                     self.unit("changed", [path for path in sources if path not in used]))
        proof = self.folder / "proof.cpp"
        proof.write_text(parts["cpp"], encoding="utf-8")
        self.compile("-o", self.folder / "proof", self.unit("proven", [*used, proof]),
                     *(BUILD / library for library in LIBRARIES), "-lfmt", "-lspdlog", "-lxxhash")
        said = run(self.folder / "proof")
        self.assertEqual(said.returncode, 0, said.stdout)

    def test_the_material(self):
        self.example("A material")

    def test_the_material_passes_the_tests_of_laws(self):
        parts = {language: text for language, text, _ in blocks(sections()["A material"])}
        apply(parts["diff"], self.folder)
        laws = [ROOT / "tests/unit" / f"material_{what}.cpp"
                for what in ("laws", "plane", "uniaxial")]
        laws.append(self.folder / "subdomain_solver/materials/bonet_wood.cpp")
        self.compile("-o", self.folder / "laws", self.unit("all_laws", laws),
                     *(BUILD / library for library in LIBRARIES), "-lgtest_main", "-lgtest",
                     "-lfmt", "-lspdlog", "-lxxhash")
        said = run(self.folder / "laws", "--gtest_brief=1")
        self.assertEqual(said.returncode, 0, said.stdout)
        names = run(self.folder / "laws", "--gtest_list_tests").stdout
        self.assertIn("bonet_wood", names, "it is among the laws under test")

    def test_the_integrator(self):
        self.example("An integrator")

    def test_the_accelerator(self):
        self.example("An accelerator")

    def test_lines_that_are_told_stand_in_their_files(self):
        told = 0
        for section in ("An element", "A joint"):
            for language, text, above in blocks(sections()[section]):
                if language != "cpp":
                    continue
                told += 1
                name = re.fullmatch(r"`(\S+)`", above)
                self.assertIsNotNone(name, f"a file stands above\n{text}")
                lines = (ROOT / name[1]).read_text(encoding="utf-8")
                at = 0
                for part in text.split("...\n"):
                    found = lines.find(part, at)
                    self.assertGreaterEqual(found, 0, f"{name[1]} does not have here\n{part}")
                    at = found + len(part)
        self.assertGreater(told, 5)

    def test_commands_succeed(self):
        commands = [line for text in sections().values() for language, block, _ in blocks(text)
                    if language == "sh" for line in block.splitlines()]
        self.assertGreater(len(commands), 1)
        for command in commands:
            words = command.split("  #")[0].split()
            self.assertEqual(words[0], "abut", command)
            words[2] = str(ROOT / words[2])
            more = ["--out", self.folder / "run", "--force"] if words[1] == "run" else []
            said = run(ABUT, *words[1:], *more)
            self.assertEqual(said.returncode, 0, command + "\n" + said.stdout + said.stderr)

    def test_files_that_are_named_exist(self):
        text = PAGE.read_text(encoding="utf-8")
        folders = {path.name for path in ROOT.iterdir() if path.is_dir()}
        named = {name for name in re.findall(r"`([\w./]+)`", text)
                 if "/" in name and name.split("/")[0] in folders}
        made = {name for name in named if name.endswith("/x.cpp")}
        self.assertGreater(len(named), 10)
        for name in named - made:
            self.assertTrue((ROOT / name).exists(), f"{name} does not exist")


if __name__ == "__main__":
    if shutil.which("g++") is None:
        raise SystemExit("there is no g++, which built the program")
    main()
