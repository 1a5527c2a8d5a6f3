"""Goal: what is built depends on the command alone: an optional library is used when it is named,
and never because it is there. Oracle: a small tree with the project's own script, presets and
module, and libraries that are there or not.
usage: test_build_options.py ROOT
"""

import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(sys.argv[1]).resolve()
OURS = ("scripts/build.sh", "scripts/install_dependencies.sh", "scripts/packages.txt",
        "cmake/optional_libraries.cmake", "CMakePresets.json")
# No system folder is searched: what is there is what a test puts into the prefix.
PROJECT = """\
cmake_minimum_required(VERSION 3.25)
project(small LANGUAGES NONE)
set(CMAKE_FIND_USE_CMAKE_SYSTEM_PATH OFF)
set(CMAKE_FIND_USE_SYSTEM_ENVIRONMENT_PATH OFF)
include(cmake/optional_libraries.cmake)
set(used "")
foreach(name IN ITEMS cholmod exodus)
  if(TARGET abut_with_${name})
    list(APPEND used ${name})
  endif()
endforeach()
list(JOIN used "," used)
add_custom_target(programs COMMAND ${CMAKE_COMMAND} -E echo "used: [${used}]")
"""
FILES = {"cholmod": ("lib/libcholmod.so", "include/suitesparse/cholmod.h"),
         "exodus": ("lib/libnetcdf.so", "include/netcdf.h")}


class BuildOptions(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.tree = Path(holder.name)
        self.prefix = self.tree / "prefix"
        for name in OURS:
            (self.tree / name).parent.mkdir(exist_ok=True)
            shutil.copy(ROOT / name, self.tree / name)
        (self.tree / "CMakeLists.txt").write_text(PROJECT, encoding="utf-8")

    def put(self, *libraries: str):
        for library in libraries:
            for name in FILES[library]:
                (self.prefix / name).parent.mkdir(parents=True, exist_ok=True)
                (self.prefix / name).touch()

    def build(self, wanted: str = None) -> subprocess.CompletedProcess:
        environment = {key: value for key, value in os.environ.items() if key != "WITH"}
        environment |= {"CMAKE_PREFIX_PATH": str(self.prefix)}
        if wanted is not None:
            environment["WITH"] = wanted
        return subprocess.run(["sh", "scripts/build.sh", "programs"], cwd=self.tree, text=True,
                              env=environment, capture_output=True, timeout=60, check=False)

    def assert_uses(self, used: str, wanted: str = None):
        result = self.build(wanted)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(f"used: [{used}]", result.stdout)

    def assert_refused(self, words: list, wanted: str):
        result = self.build(wanted)
        self.assertNotEqual(result.returncode, 0, result.stdout)
        said = " ".join((result.stderr + result.stdout).split())
        for word in words:
            self.assertIn(word, said)

    def test_a_library_that_is_there_is_not_used_unless_it_is_named(self):
        self.put("cholmod", "exodus")
        self.assert_uses("")
        self.assert_uses("", "")

    def test_the_named_are_used_and_a_change_of_mind_holds_at_once(self):
        self.put("cholmod", "exodus")
        for wanted, used in (("cholmod", "cholmod"), ("exodus cholmod", "cholmod,exodus"),
                             (None, ""), ("exodus", "exodus"), ("exodus", "exodus"), ("", "")):
            with self.subTest(wanted=wanted):
                self.assert_uses(used, wanted)

    def test_a_named_library_that_is_missing_is_an_error_every_time(self):
        self.put("exodus")
        words = ["'cholmod' was asked for", "libsuitesparse-dev"]
        self.assert_refused(words, "cholmod")
        self.assert_uses("exodus", "exodus")
        # Twice: what was built before must not be taken for it.
        self.assert_refused(words, "exodus cholmod")
        self.assert_refused(words, "exodus cholmod")
        self.assert_uses("")

    def test_an_unknown_name_is_an_error_with_the_known_ones(self):
        self.assert_refused(["'mumps'", "cholmod, exodus, petsc"], "mumps")

    def test_every_option_has_packages_to_install(self):
        listed = (ROOT / "scripts" / "packages.txt").read_text(encoding="utf-8").splitlines()
        groups = {line.split()[0]: line.split()[1] for line in listed if not line.startswith("#")}
        module = (ROOT / "cmake" / "optional_libraries.cmake").read_text(encoding="utf-8")
        for option in FILES:
            self.assertIn(groups[option], module, "CMake names the package that make installs")


class CompilerCache(unittest.TestCase):
    """Headers that change and change back, precompiled by way of ccache as the build does."""

    def sizes(self, folder: str, launcher: list) -> list:
        tree, compiler = Path(folder), ["ccache", "g++", "-std=c++20"]
        environment = {**os.environ, "CCACHE_DIR": f"{folder}/cache",
                       "CCACHE_SLOPPINESS": "pch_defines,time_macros,include_file_mtime,"
                                            "include_file_ctime"}
        (tree / "h.hxx.cxx").write_text("/* */\n", encoding="utf-8")
        (tree / "use.cpp").write_text("int main() { return sizeof(S); }\n", encoding="utf-8")
        include = ["-include", f"{folder}/h.hxx"]

        def run(*command: str) -> int:
            return subprocess.run(command, cwd=folder, env=environment, check=False).returncode

        found = []
        for size in (1, 5, 1, 7):
            if found == [1, 5]:  # a build elsewhere, which finds in the cache what the first made
                (tree / "h.hxx.gch").unlink()
            (tree / "h.hxx").write_text(f"struct S {{ char a[{size}]; }};\n", encoding="utf-8")
            self.assertEqual(0, run(*launcher, *compiler, "-x", "c++-header", *include, "-o",
                                    "h.hxx.gch", "-c", f"{folder}/h.hxx.cxx"))
            self.assertEqual(0, run(*compiler, *include, "-o", "use.o", "-c", f"{folder}/use.cpp"))
            self.assertEqual(0, run("g++", "-o", "use", "use.o"))
            found.append(run(f"{folder}/use"))
        return found

    @unittest.skipUnless(shutil.which("ccache") and shutil.which("g++"), "no ccache")
    def test_precompiled_headers_are_those_of_now(self):
        with tempfile.TemporaryDirectory() as folder:
            launcher = ["sh", str(ROOT / "cmake" / "without_old_output.sh")]
            self.assertEqual(self.sizes(folder, launcher), [1, 5, 1, 7])  # without: 5 at last


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
