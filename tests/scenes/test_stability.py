# SPDX-License-Identifier: GPL-3.0-or-later
"""The stability studies under prm/studies: no crash, no NaN, no energy from nowhere, every failure with a remedy."""

import csv
import math
import re
import unittest

from exemplar_runner import REPOSITORY, SceneTest

STUDIES = sorted((REPOSITORY / "prm/studies").glob("stability_*.prm"))
LEAST_CASES = 145
MORE_FAILURES = 3  # than in doc/studies: next to the limit of iterations rounding decides
# of what was there at first and was done as work; Newton's tolerance leaves less, and steps to a
# thousandth of the displacement that much of the energy in them
MOST_ENERGY_FROM_NOWHERE = 1e-3
MOST_ABOVE_BOUND = 1e-6  # of the same scale; 6e-10 measured
REMEDY = re.compile(r"\b([Ss]et|[Tt]ake|[Uu]se|[Rr]emove|[Gg]ive|[Cc]heck|[Tt]ry|smaller|coarser|[Hh]old|improve|raise)\b")


class Stability(SceneTest):
    """A test of each study; how many cases there are is checked at the end."""

    def rows(self, study):
        run = self.call("study", study, "--output", "out", "--quiet")
        self.assertEqual(run.status, 0, run.stderr)
        with open(self.directory / "out/study.csv", newline="") as file:
            return list(csv.DictReader(file))

    def check_files(self, row):
        for file in (self.directory / "out/runs" / row["run"]).iterdir():
            if file.suffix in (".csv", ".msh", ".json"):
                self.assertNotRegex(file.read_text(), r"(?i)\b(nan|-?inf)\b", file.name)

    def check_row(self, row, is_dynamic):
        self.check_files(row)
        if is_dynamic:  # work over the increments of a static path is known by its trapezoids only
            self.assertLess(float(row["energy_growth"] or 0), MOST_ENERGY_FROM_NOWHERE)
            self.assertLess(float(row["bound_excess"] or 0), MOST_ABOVE_BOUND)
        if row["exit_status"] == "0":
            self.assertTrue(math.isfinite(float(row["max_displacement"])))
            return
        # a failure that the program has reported
        self.assertEqual(row["exit_status"], "2", row["status"])
        self.assertRegex(row["message"], REMEDY)

    def check_study(self, study):
        scene = study.parent / re.search(r"set Scene = (.*)", study.read_text()).group(1)
        is_dynamic = "set Scene = dynamic" in scene.read_text()
        rows = self.rows(study)
        with open(REPOSITORY / f"doc/studies/{study.stem}.csv", newline="") as file:
            known = sum(row["exit_status"] != "0" for row in csv.DictReader(file))
        self.assertLessEqual(sum(row["exit_status"] != "0" for row in rows), known + MORE_FAILURES)
        for row in rows:
            with self.subTest(study.stem, **{key: value[:60] for key, value in row.items() if "/" in key}):
                self.check_row(row, is_dynamic)

    def test_number_of_cases(self):
        cases = sum(int(re.search(r"(\d+) combinations", self.call("--validate", study).stdout).group(1))
                    for study in STUDIES)
        self.assertGreaterEqual(cases, LEAST_CASES)


for _study in STUDIES:
    setattr(Stability, "test_" + _study.stem, lambda self, study=_study: self.check_study(study))


if __name__ == "__main__":
    unittest.main()
