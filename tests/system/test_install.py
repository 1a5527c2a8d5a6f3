"""Goal: what is installed is whole: it runs from any folder, under any prefix and after a move; its
man pages and completions say what the programs say; others find and link it; uninstalling leaves
nothing. Oracles: the programs' own --help and `abut reference`, the example's expectations, a look
at the folders before and after.

usage: test_install.py ABUT ROOT CMAKE       the build folder of ABUT is installed
"""

import gzip
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

sys.dont_write_bytecode = True
from support import ABUT, PACKAGE, ROOT, SystemTest, main  # noqa: E402

CMAKE = sys.argv[3]
BUILD = ABUT.parents[1]
sys.path[:0] = [str(PACKAGE), str(ROOT / "packaging"), str(ROOT / "tests/tidy")]
from abut_tools.complete import completed, kinds_in  # noqa: E402
from completions import bash_options, zsh_case  # noqa: E402
from docs import LINK, check_link, prose  # noqa: E402
from help_text import help_of, parsed, verbs_of  # noqa: E402

# What is not beside the programs is not found: no abut of this machine may help.
BARE = {"PATH": "/usr/bin:/bin", "LC_ALL": "C.UTF-8"}
LIST = "share/abut/installed.txt"


def files_below(folder: Path) -> set:
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*")}


def names_path(held: bytes, path: Path) -> bool:
    """As a path and not as letters: a checkout in /repo is not named by `runs/two/report.html`."""
    return bool(re.search(rb"(?<![\w./-])" + re.escape(bytes(path)) + rb"(?=[/\0\"\s])", held))


class Install(SystemTest):
    def setUp(self):
        super().setUp()
        self.prefix = self.folder / "prefix"

    def call(self, *words: object, cwd=None, code: int = 0, **more: str) -> str:
        """What a command prints, which must end with `code`; of one that must fail, its errors."""
        result = subprocess.run([*map(str, words)], cwd=cwd or self.folder, text=True, check=False,
                                env=BARE | more, capture_output=True, timeout=120)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result.stderr if code else result.stdout

    def install(self, prefix: Path, **more: str):
        self.call(CMAKE, "--install", BUILD, "--prefix", prefix, **more)

    def uninstall(self, prefix: Path, code: int = 0, **more: str) -> str:
        return self.call(CMAKE, f"-Dprefix={prefix}", "-P", ROOT / "packaging/uninstall.cmake",
                         code=code, **more)


class Programs(Install):
    def test_all_run_from_another_folder_and_after_a_move(self):
        self.install(self.prefix)
        for prefix in (self.prefix, self.folder / "moved to here"):
            if prefix != self.prefix:
                self.prefix.rename(prefix)
            elsewhere = self.folder / f"of {prefix.name}"
            elsewhere.mkdir()
            scenes, abut = prefix / "share/abut/configs", prefix / "bin/abut"
            self.call(abut, "run", scenes / "two_bars.yaml", "--quiet", cwd=elsewhere)
            self.call(abut, "check", scenes / "solids/gmsh_part.yaml", cwd=elsewhere)  # a mesh
            self.call(abut, "report", "runs/two_bars", cwd=elsewhere)
            self.assertIn("<canvas", (elsewhere / "runs/two_bars/report.html").read_text("utf-8"))
            study = prefix / "share/abut/studies/two_bars_window.yaml"
            self.call(prefix / "bin/abut-study", study, "--quick", "--quiet", cwd=elsewhere)
            self.assertTrue((elsewhere / "runs/two_bars_window/index.html").is_file())

    def test_a_link_to_a_program_finds_the_rest(self):
        self.install(self.prefix)
        links = self.folder / "links"
        links.mkdir()
        for name in ("abut", "abut-report"):
            (links / name).symlink_to(self.prefix / "bin" / name)
        self.call(links / "abut", "run", self.prefix / "share/abut/configs/two_bars.yaml",
                  "--quiet", "--out", "run")
        self.call(links / "abut-report", "run")

    def test_a_launcher_without_its_package_says_what_is_missing(self):
        self.install(self.prefix)
        shutil.rmtree(self.prefix / "share/abut/python")
        said = self.call(self.prefix / "bin/abut", "report", "run", code=3)
        self.assertRegex(said, r"^abut report: .*/report\.py is not there\. Install abut again")

    def test_versions_tell_commit_and_options(self):
        said = [self.call(BUILD / "bin/abut", *words, "--version").split("\n")
                for words in ([], ["report"], ["study"])]
        said.append(self.call(BUILD / "bin/abut-solver", "--version").split("\n"))
        for lines, name in zip(said, ("abut", "abut report", "abut study", "abut-solver")):
            self.assertRegex(lines[0], rf"^{name} \d+\.\d+\.\d+(, protocol \d+)?$")
            # Of the same commit are those alone that were built at once.
            self.assertRegex(lines[1], r"^commit   ([0-9a-f]{12}( \+ changes)?|unknown)$")
            self.assertRegex(lines[2], r"^build    .*optional libraries: ")
            self.assertEqual(lines[2], said[0][2])

    def test_the_citation_is_of_this_version(self):
        said = self.call(BUILD / "bin/abut", "--version").split()[1]
        citation = (ROOT / "CITATION.cff").read_text("utf-8")
        self.assertIn(f"\nversion: {said}\n", citation)
        for key in ("cff-version", "message", "title", "authors"):  # that CFF 1.2 wants
            self.assertRegex(citation, rf"(?m)^{key}:")

    def test_help_lists_every_verb(self):
        self.install(self.prefix)
        beside = {path.name.removeprefix("abut-") for path in (self.prefix / "bin").iterdir()}
        verbs = verbs_of(self.prefix / "bin")
        self.assertEqual(beside - {"abut", "solver"} - set(verbs), set())
        for verb in verbs:
            self.assertTrue(help_of(self.prefix / "bin/abut", verb).items("options"), verb)


class Places(Install):
    def test_uninstalling_leaves_nothing(self):
        self.install(self.prefix)
        self.assertGreater(len(files_below(self.prefix)), 300)
        self.uninstall(self.prefix)
        self.assertFalse(self.prefix.exists())

    def test_uninstalling_leaves_what_is_not_ours(self):
        kept = ["bin/other", "share/abut/mine.yaml", "share/man/man1/other.1", "lib/pkgconfig"]
        for name in kept[:3]:
            (self.prefix / name).parent.mkdir(parents=True, exist_ok=True)
            (self.prefix / name).touch()
        (self.prefix / kept[3]).mkdir(parents=True)  # empty, and not made by us
        before = files_below(self.prefix)
        for _ in range(2):  # what the second finds, the first has made
            self.install(self.prefix)
        self.uninstall(self.prefix)
        self.assertEqual(files_below(self.prefix), before)

    def test_installing_again_takes_away_what_the_version_before_had_alone(self):
        self.install(self.prefix)
        old = self.prefix / "share/abut/python/abut_tools/old.py"
        old.touch()
        whole = files_below(self.prefix)
        name = old.relative_to(self.prefix).as_posix()
        with (self.prefix / LIST).open("a", encoding="utf-8") as file:
            file.write(name + "\n")
        self.install(self.prefix)
        self.assertEqual(whole - files_below(self.prefix), {name})

    def test_destdir_stands_before_the_prefix_and_nowhere_else(self):
        stage = self.folder / "stage"
        self.install(Path("/opt/abut"), DESTDIR=str(stage))
        self.install(self.prefix)
        self.assertEqual(files_below(stage / "opt/abut"), files_below(self.prefix))
        for path in (stage / "opt/abut").rglob("*"):
            if path.is_file() and path.suffix not in (".a", ".gz") and path.name != "CHANGELOG.md":
                for place in (stage, BUILD, ROOT):  # programs too: they have no path to libraries
                    self.assertFalse(names_path(path.read_bytes(), place), f"{path}: {place}")
        self.uninstall(Path("/opt/abut"), DESTDIR=str(stage))
        self.assertEqual(files_below(stage), {"opt"})

    def test_what_is_not_installed_is_not_uninstalled(self):
        said = self.uninstall(self.prefix, code=1)
        self.assertIn("make uninstall PREFIX=", said)


class Documents(Install):
    """Those of tests/tidy/docs.py, where they are installed."""

    def test_what_they_link_to_is_there(self):
        self.install(self.prefix)
        self.install(self.prefix)  # links are as well where they have been changed before
        folder, links, dead = self.prefix / "share/doc/abut", 0, []
        for path in folder.rglob("*.md"):
            name = path.relative_to(folder).as_posix()
            for _, line in prose(path.read_text("utf-8").splitlines()):
                for target in LINK.findall(line):
                    if re.match(r"[a-z]+:", target):
                        continue
                    links += 1
                    if wrong := check_link(folder, name, target):
                        dead.append(f"{name}: {wrong}")
        self.assertEqual(dead, [])
        self.assertGreater(links, 300)


class Words(Install):
    """Man pages and completions."""

    def test_every_verb_has_a_page_with_all_its_options(self):
        self.install(self.prefix)
        pages = self.prefix / "share/man/man1"
        programs = self.prefix / "bin"
        verbs = verbs_of(programs)
        helps = {f"abut-{verb}": help_of(programs / "abut", verb) for verb in verbs}
        helps |= {name: help_of(programs / name) for name in ("abut", "abut-solver")}
        self.assertEqual({path.name for path in pages.iterdir()},
                         {f"{name}.1.gz" for name in helps})
        for name, said in helps.items():
            text = gzip.open(pages / f"{name}.1.gz", "rt").read().replace("\\-", "-")
            self.assertRegex(text, rf"NAME\n{name} - \w")
            for part in ("arguments", "options", "commands"):
                for item in said.items(part):
                    self.assertIn(item.meaning, text)
                    for option in item.names():
                        self.assertIn(option, text)
            if shutil.which("groff", path=BARE["PATH"]):  # what `man` sets pages with
                page = gzip.decompress((pages / f"{name}.1.gz").read_bytes())
                said = subprocess.run(["groff", "-man", "-ww", "-Tutf8", "-P-cbou"], input=page,
                                      env=BARE, capture_output=True, check=True)
                self.assertIn(b"SEE ALSO", said.stdout)
                self.assertEqual(said.stderr, b"")

    def test_pages_have_the_same_bytes_whenever_they_are_made(self):
        made = [self.folder / name for name in ("one", "two")]
        for folder in made:
            self.call(sys.executable, "-B", ROOT / "packaging/man_pages.py", BUILD / "bin", folder)
        for page in made[0].iterdir():
            self.assertEqual(page.read_bytes(), (made[1] / page.name).read_bytes())
            self.assertEqual(gzip.open(page).read()[:4], b".TH ")

    def completions(self, *lines: str) -> list:
        script = ('source "$1"; shift; compopt() { :; }\n'
                  'for line; do COMP_LINE=$line COMP_POINT=${#line}; COMPREPLY=(); _abut;'
                  ' echo "${COMPREPLY[*]}"; done')
        here = self.prefix / "share/bash-completion/completions/abut"
        said = self.call("bash", "-c", script, "bash", here, *lines,
                         PATH=f"{self.prefix}/bin:/usr/bin:/bin")
        return [set(line.split()) for line in said.split("\n")[:-1]]

    def test_bash_completes_verbs_options_files_keys_and_values(self):
        self.install(self.prefix)
        shutil.copy(self.prefix / "share/abut/configs/two_bars.yaml", self.folder / "scene.yaml")
        (self.folder / "notes.txt").touch()
        verbs, options, scenes, keys, values, other = self.completions(
            "abut ", "abut run --", "abut run ", "abut run scene.yaml --set bodies.right.mat",
            "abut run --set time.end=1 scene.yaml --set bodies.left.launch=c", "abut-solver --p")
        self.assertEqual(verbs, {*verbs_of(BUILD / "bin"), "--help", "--version"})
        self.assertEqual(options, {"--help", "--set", "--out", "--local", "--quiet", "--force",
                                   "--grace", "--insecure", "--trace", "--await", "--keys",
                                   "--patience"})
        self.assertLessEqual({"scene.yaml", "prefix"}, scenes)
        self.assertNotIn("notes.txt", scenes)
        self.assertEqual(keys, {"bodies.right.material.", "bodies.right.material="})
        self.assertEqual(values, {"connect"})  # readline has a word begin behind "="
        self.assertEqual(other, {"--process", "--patience"})

    def test_bash_completes_kinds_meshes_paths_of_keys_and_materials(self):
        self.install(self.prefix)
        shutil.copy(self.prefix / "share/abut/configs/two_bars.yaml", self.folder / "scene.yaml")
        for name in ("part.msh", "part.inp", "part.txt"):
            (self.folder / name).touch()
        kinds, some, meshes, none, keys, deep, material = self.completions(
            "abut init x --from ", "abut init x --from m", "abut init x --from mesh p",
            "abut init x --from bars p", "abut reference ti", "abut reference bodies.*.mater",
            "abut run scene.yaml --set bodies.left.material=s")
        self.assertLessEqual({"bars", "study", "mesh", "gmsh"}, kinds)
        self.assertEqual(some, {"mesh"})
        self.assertEqual(meshes, {"part.msh", "part.inp", "prefix"})
        self.assertEqual(none, set())
        self.assertEqual(keys, {"time."})
        self.assertEqual(deep, {"bodies.*.material", "bodies.*.material."})
        self.assertEqual(material, {"saint_venant_kirchhoff", "steel"})
        zsh = (self.prefix / "share/zsh/site-functions/_abut").read_text("utf-8")
        for words in ("[what it is of; default bars]:word:(bars contact friction ",
                      "'*:mesh:_files -g \"*.(msh|inp)(-.)\"'", "'1:key_path:_abut_key_paths'"):
            self.assertIn(words, zsh)

    def test_both_forms_of_help_are_read(self):
        first = parsed("title\nUsage: p [OPTIONS] scene\n\nPositionals:\n"
                       "  scene SCENE REQUIRED   it\n\nOptions:\n  -h,--help    help\n"
                       "  --keys Excludes: key --all\n                   paths alone\n"
                       "  --n N ...      repeatable\n\nfoot\n")
        self.assertEqual(first.texts, ["title", "foot"])
        self.assertEqual([(item.names(), item.operand(), item.meaning, item.beside)
                          for item in first.items("options")],
                         [(["-h", "--help"], "", "help", ""),
                          (["--keys"], "", "paths alone", "not with key --all"),
                          (["--n"], "N", "repeatable", "")])
        self.assertEqual(bash_options(first), ["-h", "--help", "--keys", "--n=OTHER"])
        second = parsed("usage: p q [-h] [--out FILE]\n           [--field {a,b}] DIR\n\nDoes it.\n"
                        "\npositional arguments:\n  DIR   folder\n\noptions:\n"
                        "  -h, --help   help\n  --field {a,b}\n               colour\n"
                        "  --out FILE   name\n")
        self.assertEqual(second.usage, "p q [-h] [--out FILE] [--field {a,b}] DIR")
        self.assertEqual(bash_options(second), ["-h", "--help", "--field={a,b}", "--out=FILE"])
        self.assertIn("'--out[name]:FILE:_files'", zsh_case("p-q", second))
        self.assertIn("'--field[colour]:word:(a b)'", zsh_case("p-q", second))

    def test_both_shells_can_read_their_completions(self):
        self.install(self.prefix)
        self.call("bash", "-n", self.prefix / "share/bash-completion/completions/abut")
        if shutil.which("zsh", path=BARE["PATH"]):
            self.call("zsh", "-n", self.prefix / "share/zsh/site-functions/_abut")
        text = (self.prefix / "share/zsh/site-functions/_abut").read_text("utf-8")
        for option in ("--chart-library", "--patience", "--bodies", "--verbose"):
            self.assertIn(f"'{option}[", text.replace("'*", "'"))

    def test_every_key_is_reached_by_completing_and_no_other(self):
        kinds = kinds_in(self.call(ABUT, "reference"))
        reached, begun = set(), [""]
        while begun:
            for word in completed(kinds, {}, begun.pop()):
                if word.endswith("."):
                    begun.append(word)
                else:
                    reached.add(word.removesuffix("="))
        # In a scene without anything a name is `*`, and a list has its first entry.
        known = {key.replace("<name>", "*").replace("[i]", "[0]") for key, kind in kinds.items()
                 if not kind.startswith(("map", "list of maps"))}
        self.assertEqual(known - reached, set())
        self.assertEqual(reached - known, set())

    def test_a_row_of_several_keys_is_each_of_them(self):
        text = ("| key | type | unit |\n|---|---|---|\n| `a` | choice of x, y, z | m |\n"
                "| `a.{x,y}.n` | number | m |\n| `a.*.w` | one of p, q | |\n")
        kinds = kinds_in(text)
        self.assertEqual(set(kinds), {"a", "a.x.n", "a.y.n", "a.x.w", "a.y.w", "a.z.w"})
        self.assertEqual(completed(kinds, {}, "a.z."), ["a.z.w="])
        self.assertEqual(completed(kinds, {}, "a.z.w="), ["a.z.w=p", "a.z.w=q"])

    def test_names_are_those_of_the_scene(self):
        kinds = kinds_in(self.call(ABUT, "reference"))
        scene = {"bodies": {"ball": {"material": {"neo_hookean": {}}, "ports": {"skin": {}}},
                            "wall": {"like": "ball"}}, "meta": {"expect": [{}, {}]}}
        for word, expected in (
                ("bodies.", {"bodies.ball.", "bodies.wall.", "bodies.*."}),
                ("bodies.wall.material.", {"bodies.wall.material.neo_hookean."}),
                ("bodies.*.ports.", {"bodies.*.ports.skin.", "bodies.*.ports.*."}),
                ("meta.expect[", {"meta.expect[0].", "meta.expect[1]."}),
                ("output.nothing", set()), ("time.end=", set())):
            self.assertEqual(set(completed(kinds, scene, word)), expected)


class Others(Install):
    """A project that knows nothing but what is installed."""

    def test_a_solver_in_python_finds_its_package_and_runs(self):
        self.install(self.prefix)
        example = self.folder / "copy"
        shutil.copytree(self.prefix / "share/doc/abut/examples/python_body", example)
        for program in ("my_body.py", "mass_on_spring.py"):
            self.allow(example / program)
        abut, there = self.prefix / "bin/abut", {"PYTHONDONTWRITEBYTECODE": "1",
                                                 "ABUT_PROGRAMS": str(self.programs)}
        self.call(abut, "run", "plates.yaml", "--quiet", cwd=example, **there)
        self.call(abut, "run", "bar_meets_mass.yaml", "--quiet", "--set", "network.endpoint=null",
                  "--set", "bodies.mass.launch={spawn: {program: ./mass_on_spring.py}}",
                  cwd=example, **there)

    def test_pkg_config_tells_what_to_compile_and_link(self):
        if "sanitizers" in self.call(ABUT, "--version"):
            self.skipTest("its program would have to be built with the same sanitizers")
        self.install(self.prefix)
        there = {"PKG_CONFIG_PATH": str(self.prefix / "lib/pkgconfig")}
        (self.folder / "main.cpp").write_text(
            '#include <cstdio>\n'
            '#include "contract/substeps.hpp"\n'
            '#include "messaging/protocol.hpp"\n'
            'int main() { std::printf("%s %d", abut::build_version(),\n'
            '  abut::Substeps::divide(0.0, 1.0, 0.25).count); }\n', encoding="utf-8")
        flags = self.call("pkg-config", "--cflags", "--libs", "abut", **there).split()
        self.call("g++", "-std=c++20", "main.cpp", "-o", "main", *flags)
        version = self.call("pkg-config", "--modversion", "abut", **there).strip()
        self.assertEqual(self.call("./main"), f"{version} 4")
        protocol = self.call("pkg-config", "--variable=protodir", "abut", **there).strip()
        self.assertTrue((Path(protocol) / "abut/v1/subdomain.proto").is_file())


class Commits(Install):
    """packaging/tell_build.cmake, in a checkout of its own."""

    def tell(self, commit: str = "") -> str:
        self.call(CMAKE, f"-Dsource={self.folder / 'tree'}", "-Dversion=1.2.3", "-Doptions=some",
                  "-Dcompiler=any", f"-Dcommit={commit}", f"-Dcpp={self.folder / 'info.cpp'}",
                  f"-Dpython={self.folder / 'info.py'}",
                  "-P", ROOT / "packaging/tell_build.cmake")
        python, cpp = ((self.folder / f"info.{kind}").read_text("utf-8") for kind in ("py", "cpp"))
        found = re.search(r'COMMIT = "(.*)"', python)[1]
        self.assertIn(f'"1.2.3", "{found}", "some"', cpp)
        return found

    def test_the_file_changes_with_the_commit_and_with_nothing_else(self):
        tree = self.folder / "tree"
        tree.mkdir()
        self.assertEqual(self.tell(), "unknown")  # no checkout
        self.assertEqual(self.tell("abc"), "abc")
        if not shutil.which("git", path=BARE["PATH"]):
            self.skipTest("there is no git")
        git = ["git", "-C", tree, "-c", "user.name=a", "-c", "user.email=a@localhost"]
        self.call("git", "init", "-q", tree)
        (tree / "file").touch()
        self.call(*git, "add", "file")
        self.call(*git, "commit", "-qm", "one")
        head = self.call(*git, "rev-parse", "HEAD").strip()
        self.assertEqual(self.tell(), head[:12])
        os.utime(self.folder / "info.cpp", (1, 1))
        (tree / "untracked").touch()
        self.assertEqual(self.tell(), head[:12])
        self.assertEqual((self.folder / "info.cpp").stat().st_mtime, 1, "compiled for nothing")
        (tree / "file").write_text("else", encoding="utf-8")
        self.assertEqual(self.tell(), head[:12] + " + changes")


if __name__ == "__main__":
    main(3)
