"""Goal: a scene of somebody else starts no program that its user has not listed.

Oracles: exit codes and words; a file that the program would write.
usage: test_programs.py ABUT ROOT
"""

from pathlib import Path

from support import ROOT, SOLVER, SystemTest, main

SCENE = ROOT / "configs" / "two_bars.yaml"


class Programs(SystemTest):
    def setUp(self):
        super().setUp()
        self.trace = self.folder / "trace"
        self.program = self.folder / "solver"
        self.program.write_text(f'#!/bin/sh\n: > {self.trace}\nexec {SOLVER} "$@"\n',
                                encoding="utf-8")
        self.program.chmod(0o755)

    def run_with(self, launch: str, verb: str = "run"):
        more = ["--out", self.out] if verb == "run" else []
        return self.abut(verb, SCENE, "--set", f"bodies.left.launch={{{launch}}}", *more)

    def assert_refused(self, result, *words: str):
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)
        self.assertFalse(self.trace.exists(), "nothing was started")
        self.assertFalse(self.out.exists())

    def test_what_is_not_listed_is_refused_with_key_and_remedy(self):
        spawn = f"spawn: {{program: {self.program}}}"
        for verb in ("run", "check"):
            self.assert_refused(
                self.run_with(spawn, verb), "bodies.left.launch.spawn.program: would start "
                f"{self.program}, which is not on your list of programs. If you trust it, add the "
                f"line {self.program} to {self.programs}.")
        group = f"group: {{name: g, program: {self.program}}}"
        self.assert_refused(self.run_with(group), "bodies.left.launch.group.program: would start")
        self.assert_refused(self.run_with("spawn: {program: env}"), "would start env")

    def test_what_is_listed_runs(self):
        self.programs.write_text("# solvers of mine\n\n", encoding="utf-8")
        self.allow(self.program)
        self.succeed(self.run_with(f"spawn: {{program: {self.program}}}"))
        self.assertTrue(self.trace.exists())

    def test_what_is_shipped_needs_no_list(self):
        self.succeed(self.run_with(f"spawn: {{program: {SOLVER}}}"))

    def test_a_link_is_what_it_points_to(self):
        link = self.folder / "abut-solver"
        link.symlink_to(self.program)
        spawn = f"spawn: {{program: {link}}}"
        self.assert_refused(self.run_with(spawn), f"add the line {self.program} to")
        self.allow(self.program)
        self.succeed(self.run_with(spawn))

    def test_the_list_is_the_users_own(self):
        self.allow(self.program)
        self.programs.chmod(0o666)
        spawn = f"spawn: {{program: {self.program}}}"
        self.assert_refused(self.run_with(spawn), f"{self.programs}: may be written by other users")
        self.programs.chmod(0o600)
        self.programs.write_text("solver\n", encoding="utf-8")
        self.assert_refused(self.run_with(spawn), f"{self.programs}:1: is no whole path: solver")

    def test_without_the_variable_it_lies_among_the_users_configurations(self):
        del self.environment["ABUT_PROGRAMS"]
        self.environment["XDG_CONFIG_HOME"] = str(self.folder / "config")
        spawn = f"spawn: {{program: {self.program}}}"
        self.programs = self.folder / "config" / "abut" / "programs"
        self.assert_refused(self.run_with(spawn), f"to {self.programs}.")
        self.programs.parent.mkdir(parents=True)
        self.allow(Path(self.program))
        self.succeed(self.run_with(spawn))


if __name__ == "__main__":
    main()
