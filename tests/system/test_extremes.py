"""Goal: at numerical extremes a run keeps its stated accuracy, or says what was exceeded and what
to change. Oracle: the claims of studies/extremes.yaml in its short form; every run is part of one.

usage: test_extremes.py ABUT ROOT
"""

import json
import re
import sys

sys.dont_write_bytecode = True
from support import ROOT, SystemTest, main  # noqa: E402

NOT_COMPLETED = {
    "CFL 1.001": "refused", "negative density": "refused",
    "modulus at the end of numbers": "refused", "iterations capped at 1": "failed",
    "faster than waves, 10000 m/s": "refused"}
# What was exceeded, then what to do about it.
REMEDY = re.compile(
    r"(above the stable limit|must be positive|gives a node the mass|not converged after|"
    r"compressed to nothing|beyond the range).*([Gg]ive (a|the|density|all) |raise )", re.DOTALL)


class Extremes(SystemTest):
    done = None

    def study(self) -> tuple[list, dict]:
        """Rows and facts of the short form, run once for all tests."""
        if Extremes.done is None:
            self.succeed(self.abut("study", ROOT / "studies" / "extremes.yaml", "--quick",
                                   "--out", self.out))
            Extremes.done = [json.loads((self.out / name).read_text(encoding="utf-8"))
                             for name in ("results.json", "study.json")]
        return Extremes.done

    def test_every_run_that_completes_keeps_what_is_stated(self):
        rows, facts = self.study()
        completed = {row["label"] for row in rows if row["status"] == "completed"}
        self.assertGreater(len(completed), 50, "the short form has nearly all runs")
        kept = set()
        for claim in facts["claims"]:
            for check in claim["checks"]:
                for each in check["measured"]:
                    # A gap that never closed has no release: no value is no false one.
                    with self.subTest(run=each["run"], value=check["value"]):
                        self.assertIsNot(each["holds"], False,
                                         f"{each['shown']}, {check['expected']}")
                    kept |= {each["run"]} if each["holds"] else set()
        self.assertEqual(completed - kept, set(), "runs of which nothing is stated")

    def test_every_other_run_says_what_to_change(self):
        rows, _ = self.study()
        self.assertEqual({row["label"]: row["status"] for row in rows
                          if row["status"] != "completed"}, NOT_COMPLETED)
        for row in rows:
            if row["status"] != "completed":
                with self.subTest(run=row["label"]):
                    self.assertRegex(row["message"], REMEDY)

    def test_no_number_is_none(self):
        rows, facts = self.study()
        text = json.dumps([rows, facts])
        self.assertIsNone(re.search(r"\bNaN\b|\bInfinity\b", text))


if __name__ == "__main__":
    main()
