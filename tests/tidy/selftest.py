"""Goal: the checkers can fail. Each is shown a small tree with one fault, and the same without."""

import tempfile
import unittest
from pathlib import Path
from typing import Callable

import definitions
import docs
import equations
import glossary
import headers
import layers
import lengths
import overriders
import packages
import places
import tolerances
import units
import words
from findings import Finding


def findings(check: Callable[[Path], list[Finding]], **files: str) -> list[Finding]:
    """Findings of one check in a tree of files; `__` in a name stands for `/`, `_dot_` for `.`."""
    with tempfile.TemporaryDirectory() as folder:
        for key, text in files.items():
            path = Path(folder) / key.replace("__", "/").replace("_dot_", ".")
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return check(Path(folder))


def body(count: int) -> str:
    return "".join(f"  f({number});\n" for number in range(count))


class Layers(unittest.TestCase):
    def check(self, expected: int, **files: str) -> None:
        self.assertEqual(len(findings(layers.check, **files)), expected)

    def test_contract_must_not_see_files_or_eigen(self) -> None:
        text = '#include <vector>\n#include <fstream>\n#include <Eigen/Dense>\n'
        self.check(2, contract__port_dot_hpp=text)

    def test_contract_sees_assert_but_not_the_log(self) -> None:
        text = '#include "base/assert.hpp"\n#include "base/log.hpp"\n'
        self.check(1, contract__port_dot_hpp=text)

    def test_coupling_must_not_see_solver_nor_messages(self) -> None:
        text = '#include "subdomain_solver/bars/bar.hpp"\n#include "abut/v1/subdomain.pb.h"\n'
        self.check(2, coordinator__coupling__schwarz_dot_cpp=text)

    def test_only_launch_sees_messaging(self) -> None:
        text = '#include "messaging/remote_subdomain.hpp"\n'
        self.check(0, coordinator__launch_dot_cpp=text)
        self.check(1, coordinator__controller_dot_cpp=text)

    def test_only_launch_local_sees_the_solver(self) -> None:
        text = '#include "subdomain_solver/bars/bar.hpp"\n'
        self.check(0, coordinator__launch_local_dot_cpp=text)
        self.check(1, coordinator__launch_dot_cpp=text)

    def test_only_makers_see_forms_that_exist_for_comparison(self) -> None:
        text = '#include "subdomain_solver/compare/bar_pair.hpp"\n'
        self.check(0, subdomain_solver__make__pair_body_dot_cpp=text)
        self.check(1, subdomain_solver__bars__bar_dot_cpp=text)

    def test_programs_see_everything(self) -> None:
        self.check(0, coordinator__main_dot_cpp='#include <CLI/CLI.hpp>\n#include "base/log.hpp"\n')

    def test_unknown_header_and_unknown_folder_are_reported(self) -> None:
        self.check(1, base__log_dot_cpp='#include <boost/any.hpp>\n')
        self.check(1, elsewhere__x_dot_cpp='')


class Lengths(unittest.TestCase):
    def check(self, expected: list[int], **files: str) -> None:
        self.assertEqual([found.line for found in findings(lengths.check, **files)], expected)

    def test_function_of_71_lines_is_too_long_wherever_it_stands(self) -> None:
        short = "void a() {\n" + body(68) + "}\n"
        long = "void b(\n    int x) {\n" + body(68) + "}\n"
        inside = "namespace n {\nclass C : public D {\n  template <class T>\n" + long + "};\n}\n"
        self.check([], a_dot_cpp=short)
        self.check([72], a_dot_cpp=short + "\n" + long)
        self.check([3], a_dot_cpp=inside)

    def test_braces_in_comments_and_strings_do_not_count(self) -> None:
        text = 'void a() {  // {\n  f("{", \'{\', 1\'000);\n}\nvoid b() {\n' + body(68) + "}\n"
        self.check([], a_dot_cpp=text)

    def test_tables_and_classes_are_not_functions(self) -> None:
        self.check([], a_dot_cpp="const int t[] = {\n" + "  1,\n" * 90 + "};\n")
        self.check([], a_dot_cpp="struct S {\n" + "  int f() { return 1; }\n" * 90 + "};\n")

    def test_long_python_function_file_header_and_line(self) -> None:
        self.check([1], a_dot_py="def f():\n" + "    pass\n" * 70)
        self.check([501], a_dot_cpp="\n" * 501)
        self.check([201], a_dot_hpp="\n" * 201)
        self.check([1], a_dot_cpp="x" * 101)
        self.check([], a_dot_cpp="x" * 100)


class Words(unittest.TestCase):
    def test_glossary_reads_identifiers_and_comments(self) -> None:
        text = "int masterNode;\nint slave_side;  // a micro-step\nremastered, penetrate\n"
        found = findings(glossary.check, base__a_dot_cpp=text)
        self.assertEqual([finding.line for finding in found], [1, 2, 2])

    def test_glossary_itself_may_name_them(self) -> None:
        self.assertEqual(findings(glossary.check, docs__GLOSSARY_dot_md="not master/slave"), [])

    def test_glossary_defines_a_term_once(self) -> None:
        text = "| term | meaning |\n|---|---|\n| row | of bars |\n| row of | x |\n| row | y |\n"
        found = findings(glossary.check, docs__GLOSSARY_dot_md=text)
        self.assertEqual([finding.line for finding in found], [5])

    def test_unfinished_business_and_machine_paths(self) -> None:
        bad = "// TODO later\nopen(\"/home/ann/x\")\nhttp://127.0.0.1:80/\n"
        self.assertEqual(len(findings(words.check, base__a_dot_cpp=bad)), 3)
        good = "tcp://127.0.0.1:5555\nruns/home/x\n/tmp/x\n"
        self.assertEqual(findings(words.check, base__a_dot_cpp=good), [])


class Places(unittest.TestCase):
    LAW = "struct FrictionLaw {\n  double sticks = 0.0, slides = 0.0;\n  double x() const;\n};\n"
    SCHEMES = "".join(f"struct S{number}Spec {{\n" for number in range(7))

    def check(self, expected: list[int], **files: str) -> None:
        self.assertEqual([found.line for found in findings(places.check, **files)], expected)

    def test_element_named_outside_of_the_table(self) -> None:
        table = "".join(f'{{"bar{number}", line}},\n' for number in range(11))
        lines = '// a "bar3"\nstd::string element = "bar3";\nif (name == "bar3") f();\n'
        self.check([3], subdomain_solver__fe__elements_dot_cpp=table,
                   subdomain_solver__fe__a_dot_cpp=lines)
        self.check([1], subdomain_solver__fe__elements_dot_cpp="none\n")

    def test_number_of_a_friction_law_passed_on_by_hand(self) -> None:
        lines = "a.slides = 1.0;\nslides_ = b;\n// slides\nif (c.sticks > 0.0) {}\n"
        self.check([1, 4], contract__friction_law_dot_hpp=self.LAW, coordinator__a_dot_cpp=lines)
        self.check([], contract__friction_law_dot_hpp=self.LAW,
                   messaging__codec__meeting_dot_cpp=lines)
        self.check([1], contract__friction_law_dot_hpp="struct FrictionLaw {};\n")

    def test_integrator_by_which_others_decide(self) -> None:
        lines = "if (std::holds_alternative<S3Spec>(x)) f();\nS3Speck y;\n"
        make = "subdomain_solver__make__"
        self.check([1], **{make + "integrator_spec_dot_hpp": self.SCHEMES,
                           make + "fields_dot_cpp": lines})
        self.check([], **{make + "integrator_spec_dot_hpp": self.SCHEMES,
                          make + "scheme_dot_cpp": lines})

    def test_guide_names_files_that_exist(self) -> None:
        row = "| law | `fe/x.*`, `fe/a.*` | `fe/a.cpp`, `a.cpp` |\n`fe/b.cpp`\n"
        self.check([], CONTRIBUTING_dot_md=row, subdomain_solver__fe__a_dot_cpp="")
        self.check([1, 1, 1, 1], CONTRIBUTING_dot_md=row, base__b_dot_cpp="")


class Definitions(unittest.TestCase):
    def check(self, expected: list[str], **files: str) -> None:
        found = findings(definitions.check, **files)
        self.assertEqual([f"{finding.path}:{finding.line}" for finding in found], expected)

    def test_one_name_in_one_namespace_is_defined_once(self) -> None:
        one = "namespace abut {\nstruct P {\n  int x;\n};\n}\n"
        for other in ("class P final : public B {};", "enum class P : char { a };",
                      "template <class T>\nstruct P {};", "struct alignas(64) P {};"):
            text = "namespace abut {\nstruct Q;\n" + other + "\n}\n"
            line = 3 + other.count("\n")
            self.check([f"b.hpp:{line}"], a_dot_hpp=one, b_dot_hpp=text)
        nested = "namespace abut::n {\nstruct P {};\n}\n"
        also = "namespace abut {\nnamespace n {\nstruct P {};\n}\n}\n"
        self.check(["c.cpp:3"], a_dot_hpp=one, b_dot_hpp=nested, c_dot_cpp=also)

    def test_files_own_types_and_members_and_declarations_may_share_a_name(self) -> None:
        one = "namespace abut {\nstruct P {\n  int x;\n};\n}\n"
        for other in ("namespace {\nstruct P {};\n}", "struct Q { struct P {}; };", "struct P;",
                      "void f() { struct P {}; }", "// struct P {}", "struct P f() { return {}; }"):
            self.check([], a_dot_hpp=one, b_dot_cpp="namespace abut {\n" + other + "\n}\n")
        self.check([], a_dot_hpp=one, tests__b_dot_cpp=one)


class Overriders(unittest.TestCase):
    BASE = ("namespace abut {\nclass B {\n public:\n  virtual ~B() = default;\n"
            "  [[nodiscard]] virtual std::map<int, X> f(int a, X b = {1, 2}) const = 0;\n"
            "  virtual void f(int) {}\n  int g() { return h(1); }\n};\n}\n")
    BOTH = ("  std::map<int, X> f(int, X) const override { return {}; }\n"
            "  void f(int) override;\n")

    def check(self, expected: list[str], listed: str = "B b.hpp\n", **files: str) -> None:
        files.setdefault("b_dot_hpp", self.BASE)
        found = findings(overriders.check, tests__tidy__interfaces_dot_txt=listed, **files)
        self.assertEqual([f"{finding.path}:{finding.line}" for finding in found], expected)

    def derived(self, name: str, base: str, functions: str) -> str:
        return (f"namespace abut {{\nclass {name} final : {base} {{\n public:\n"
                f"{functions}}};\n}}\n")

    def test_two_overriders_are_needed_of_every_function(self) -> None:
        one, two = (self.derived(name, "public B", self.BOTH) for name in ("C", "D"))
        self.check([], c_dot_hpp=one, d_dot_cpp=two)
        self.check(["b.hpp:5", "b.hpp:6"], c_dot_hpp=one)
        self.check(["b.hpp:5", "b.hpp:6"])
        for left in self.BOTH.splitlines(keepends=True):
            line = 6 if "map" in left else 5
            self.check([f"b.hpp:{line}"], c_dot_hpp=one,
                       d_dot_cpp=self.derived("D", "public B", left))

    def test_below_counts_and_beside_does_not(self) -> None:
        one = self.derived("C", "public A, private abut::B", self.BOTH)
        below = self.derived("D", "public C", self.BOTH)
        nested = "struct O {\n" + self.BASE + "};\n"
        self.check([], c_dot_hpp=one, d_dot_cpp=below)
        for other in (self.derived("D", "public E", self.BOTH), nested,
                      self.derived("D", "public B", self.BOTH.replace("override", "")),
                      "// class D : public B {" + self.BOTH.replace("\n", "") + "}\n",
                      self.derived("D", "public B", "  void g() { c.f(1); }\n")):
            self.check(["b.hpp:5", "b.hpp:6"], c_dot_hpp=one, d_dot_cpp=other)
        self.check(["b.hpp:5", "b.hpp:6"], c_dot_hpp=one,
                   tests__d_dot_cpp=self.derived("D", "public B", self.BOTH))

    def test_list_must_name_interfaces(self) -> None:
        one, two = (self.derived(name, "public B", self.BOTH) for name in ("C", "D"))
        self.check(["tests/tidy/interfaces.txt:2", "tests/tidy/interfaces.txt:3"],
                   "# why\nB c.hpp\nC c.hpp\n", c_dot_hpp=one, d_dot_cpp=two)


class Equations(unittest.TestCase):
    METHOD = "    a = b,                    [M.1]\n| law | a = b | [M.2] |\n    c = d   [M.3]\n"

    def check(self, expected: list[str], method: str, **files: str) -> None:
        found = findings(equations.check, docs__METHOD_dot_md=method, **files)
        self.assertEqual([f"{finding.path}:{finding.line}" for finding in found], expected)

    def test_what_is_cited_is_defined(self) -> None:
        self.check([], self.METHOD, a_dot_hpp="// [M.1] and [M.2, M.3], [M.1 to M.3].\n")
        for wrong in ("[M.4]", "[M.1, M.4]", "[M.2 to M.4]", "[M.1-3]"):
            for name in ("a_dot_hpp", "a_dot_yaml", "a_dot_md", "a_dot_py"):
                self.check([name.replace("_dot_", ".") + ":2"], self.METHOD,
                           **{name: f"\nas {wrong} says\n"})

    def test_number_is_given_once(self) -> None:
        self.check(["docs/METHOD.md:4"], self.METHOD + "    e = f     [M.2]\n")

    def test_formula_or_row_that_ends_with_a_citation_defines_nothing(self) -> None:
        self.check([], self.METHOD + "    e = f under [M.1]\n| f | as [M.2] |\n")
        self.check(["docs/METHOD.md:4"], self.METHOD + "    e = f under [M.4]\n")


class Units(unittest.TestCase):
    def check(self, expected: list[str], **files: str) -> None:
        target = "add_library(x STATIC a.cpp b.cpp)\n"
        found = findings(units.check, CMakeLists_dot_txt=target, **files)
        self.assertEqual([f"{finding.path}:{finding.line}" for finding in found], expected)

    def test_files_of_one_target_have_functions_of_their_own(self) -> None:
        one = "namespace abut {\nnamespace {\nint f(int x) {\n  return x;\n}\n}\n}\n"
        overload = "namespace abut {\nnamespace {\nint f(double x) {\n  return 1;\n}\n}\n}\n"
        self.check(["b.cpp:3"], a_dot_cpp=one, b_dot_cpp=overload)
        self.check([], a_dot_cpp=one, b_dot_cpp=overload.replace("abut", "abut::tests"))
        self.check([], a_dot_cpp=one, b_dot_cpp=overload.replace("f(double", "g(double"))
        self.check([], a_dot_cpp=one, c_dot_cpp=overload)

    def test_what_is_no_function_of_a_file(self) -> None:
        for same in ("int K::f() {\n  return 1;\n}", "TEST(A, B) {\n}",
                     "struct S {\n  int f() {\n    return 1;\n  }\n};"):
            text = "namespace abut {\nnamespace {\n" + same + "\n}\n}\n"
            self.check([], a_dot_cpp=text, b_dot_cpp=text)


class Tolerances(unittest.TestCase):
    def check(self, expected: list[int], text: str) -> None:
        self.assertEqual(tolerances.bare(text.splitlines()), expected)

    def test_power_of_ten_without_a_reason(self) -> None:
        for bad in ("EXPECT_NEAR(a, b, 1e-9);", "EXPECT_LT(f(a, {1, 2}),\n  1.0e-9 * size);",
                    "ASSERT_LE(a, 0.01) << \"// no reason\";", "constexpr double exact = 1e-9;"):
            self.check([2], "// Goal.\n".replace("//", "x;") + bad)
            for good in (f"// Rounding of 1e6.\n{bad}", f"{bad}  // rounding of 1e6"):
                self.check([], good)

    def test_derived_and_other_numbers_speak_for_themselves(self) -> None:
        for good in ("EXPECT_NEAR(a, b, roundoff(4, 1e-3));", "EXPECT_NEAR(1e-9, b, c);",
                     "EXPECT_LT(a, iteration(1e-6));", "EXPECT_LE(a, 2.5e-3);",
                     "EXPECT_GT(a, 1e-3);", "constexpr double speed = 1e-3;"):
            self.check([], good)

    def test_reason_reaches_the_next_line_with_the_same_tolerance(self) -> None:
        first = "EXPECT_NEAR(a, b, 1e-9);  // why\n"
        self.check([], first + "EXPECT_NEAR(c, d, 1e-9);")
        self.check([2], first + "EXPECT_NEAR(c, d, 1e-8);")

    def test_listed_counts_may_only_fall(self) -> None:
        text = "EXPECT_LT(a, 1e-9);\n"
        for listed, count in (("1", 0), ("0", 1), ("2", 1)):
            found = findings(tolerances.check, tests__a_dot_cpp=text,
                             tests__tidy__tolerances_dot_txt=f"# left\n{listed} tests/a.cpp\n")
            self.assertEqual(len(found), count)


class HeadersPackagesAndDocs(unittest.TestCase):
    def test_header_without_pragma_once_or_with_using_namespace(self) -> None:
        self.assertEqual(len(findings(headers.check, base__a_dot_hpp="int x;\n")), 1)
        self.assertEqual(findings(headers.check, base__a_dot_hpp="// Why.\n#pragma once\n"), [])
        text = "#pragma once\nusing namespace std;\n"
        self.assertEqual(len(findings(headers.check, base__a_dot_hpp=text)), 1)

    def test_source_includes_its_own_header_first(self) -> None:
        header = "#pragma once\n"
        text = '#include <vector>\n#include "base/a.hpp"\n'
        found = findings(headers.check, base__a_dot_hpp=header, base__a_dot_cpp=text)
        self.assertEqual([finding.line for finding in found], [1])

    def test_header_that_needs_another_does_not_compile_alone(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            (root / "bad.hpp").write_text("#pragma once\ninline std::size_t n = 0;\n")
            (root / "good.hpp").write_text("#pragma once\ninline int n = 0;\n")
            found = headers.compile_alone(root, ["bad.hpp", "good.hpp"], "c++")
        self.assertEqual([finding.path for finding in found], ["bad.hpp"])

    def test_module_of_a_package_that_is_not_listed(self) -> None:
        text = "import json\nimport a\nimport yaml.nodes\n"
        without = findings(packages.check, a_dot_py=text, scripts__packages_dot_txt="build make\n")
        self.assertEqual([finding.line for finding in without], [3])
        listed = "build python3-yaml  scenes\n"
        with_it = findings(packages.check, a_dot_py=text, scripts__packages_dot_txt=listed)
        self.assertEqual(with_it, [])

    def test_dead_links_and_headings(self) -> None:
        text = "# A b\n[x](gone.md) [y](#a-b) [z](#c) [w](https://example.org)\n`[v](gone.md)`\n"
        found = findings(docs.check, README_dot_md=text)
        self.assertEqual([finding.line for finding in found], [2, 2])


if __name__ == "__main__":
    unittest.main()
