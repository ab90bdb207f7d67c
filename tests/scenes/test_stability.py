# SPDX-License-Identifier: GPL-3.0-or-later
"""The stability studies under prm/studies: no crash, no NaN, no energy from nowhere, every failure with a remedy.

The studies run all elements. The test runs the quick ones with all, the others, in a class of their own, with linear elements, and
where this is quick with patches of them; with STABILITY_ELEMENTS=all in the environment all studies with all elements, which takes half an hour.
"""

import csv
import math
import os
import re
import unittest

from exemplar_runner import REPOSITORY, SceneTest

STUDIES = sorted((REPOSITORY / "prm/studies").glob("stability_*.prm"))
N_CASES = 688
ELEMENTS = "P1 + cells", "P1 + patches", "P2 + cells", "P2 + patches"
# studies of a few seconds, of all elements
QUICK = {"stability_cells", "stability_contrast", "stability_density", "stability_memory", "stability_node", "stability_plastic",
         "stability_poses", "stability_size"}
# others of which the linear elements are quick with patches as well
QUICK_IF_LINEAR = {"stability_contact", "stability_fibres", "stability_fibrous_plastic", "stability_importance", "stability_pull", "stability_start", "stability_stiffness"}
AXIS = re.compile(r"(Model/Element \+ Model/Dilatation(?: \+ Time/End)?: )(.*)")
# By what the study varies: cases that may end with status 2. All others must be done.
MAY_FAIL = {
    # they weigh more than their stiffness E carries, rho g L > E, and fall in steps of a second: which of them ends is
    # decided by rounding
    "stability_fall": {("1e2", "1e3", "1", "40"), ("1e2", "1e5", "1", "40"), ("1e6", "1e5", "1", "40")},
    # fibres ten thousand times as stiff as the body, in quadratic elements
    "stability_fibres": {("1e9",)},
}
# Their handles rest, so that implicit Euler obeys the bound on the energy in every step.
AT_REST = {"stability_cells", "stability_contact", "stability_contrast", "stability_fall", "stability_node", "stability_spin", "stability_start"}
# of what was there at first and was done as work; Newton's tolerance leaves less, and steps to a
# thousandth of the displacement that much of the energy in them
MOST_ENERGY_FROM_NOWHERE = 1e-3
MOST_ABOVE_BOUND = 1e-6  # of the same scale; 2e-7 measured, of quadratic elements at 1e12 Pa
KEY = re.compile(r"\b[A-Z]\w+/[A-Z]\w+(?: [a-z]+)*")


class StabilityTest(SceneTest):
    def keys(self):
        """"Section/Key" of every parameter."""
        keys, path = set(), []
        for line in map(str.strip, self.call("--print-parameters").stdout.splitlines()):
            if line.startswith("subsection "):
                path.append(line[len("subsection "):])
            elif line == "end":
                path.pop()
            elif line.startswith("set "):
                keys.add("/".join([*path, line[len("set "):].split(" =", 1)[0].strip()]))
        return keys

    def check_remedy(self, message):
        """It names keys to change, and all that it names exist."""
        words = KEY.findall(message)
        self.assertNotEqual(words, [], message)
        for word in words:  # the words behind a key may be others
            self.assertTrue(any(word == key or word.startswith(key + " ") for key in self.keys()), message)

    def with_some_elements(self, study):
        """The text of the study with the elements that are tested."""
        text = study.read_text()
        axis = AXIS.search(text)
        values = [value.strip() for value in axis[2].split(",")]
        self.assertEqual([" + ".join(value.split(" + ")[:2]) for value in values], list(ELEMENTS))
        if study.stem in QUICK or os.environ.get("STABILITY_ELEMENTS") == "all":
            return text
        chosen = values[:2 if study.stem in QUICK_IF_LINEAR else 1]
        return text.replace(axis[0], axis[1] + ", ".join(chosen) + ",")

    def rows(self, study):
        text = self.with_some_elements(study)
        text = re.sub(r"set Scene = ", f"set Scene = {study.parent}/", text)
        run = self.call("study", self.write(study.name, text), "--output", "out", "--quiet")
        self.assertEqual(run.status, 0, run.stderr)
        with open(self.directory / "out/study.csv", newline="") as file:
            return list(csv.DictReader(file))

    def check_files(self, row):
        files = [file for file in (self.directory / "out/runs" / row["run"]).iterdir()
                 if file.suffix in (".csv", ".msh", ".json")]
        self.assertIn("statistics.csv", [file.name for file in files])
        for file in files:
            self.assertNotRegex(file.read_text(), r"(?i)\b(nan|-?inf)\b", file.name)

    def check_energy(self, row, study):
        self.assertLess(float(row["energy_growth"]), MOST_ENERGY_FROM_NOWHERE)
        if study in AT_REST and row.get("Time/Scheme") != "bdf2" and int(row["steps"]) > 0:
            self.assertLess(float(row["bound_excess"]), MOST_ABOVE_BOUND)
        else:
            self.assertEqual(row["bound_excess"], "", "a study whose handles rest is to be named in AT_REST")

    def check_row(self, row, study, is_dynamic):
        self.check_files(row)
        if is_dynamic:  # work over the increments of a static path is known by its trapezoids only
            self.check_energy(row, study)
        if row["exit_status"] == "0":
            self.assertTrue(math.isfinite(float(row["max_displacement"])))
            return
        # a failure that the program has reported
        self.assertEqual(row["exit_status"], "2", row["status"])
        self.assertIn(choice(row), MAY_FAIL.get(study, ()), row["message"])
        self.check_remedy(row["message"])

    def check_study(self, study):
        scene = study.parent / re.search(r"set Scene = (.*)", study.read_text()).group(1)
        is_dynamic = "set Scene = dynamic" in scene.read_text()
        rows = self.rows(study)
        self.assertLessEqual(MAY_FAIL.get(study.stem, set()), {choice(row) for row in rows})
        for row in rows:
            with self.subTest(study.stem, **{key: value[:60] for key, value in row.items() if "/" in key}):
                self.check_row(row, study.stem, is_dynamic)


class Stability(StabilityTest):
    """A test of each quick study, and how many cases there are."""

    def test_number_of_cases(self):
        cases = sum(int(re.search(r"(\d+) combinations?", self.call("--validate", study).stdout).group(1))
                    for study in STUDIES)
        self.assertEqual(cases, N_CASES)

    def test_a_remedy_helps(self):
        def run(*settings):
            words = [word for setting in ("Initial/Pose function=1e-3*x; 1e-3*y; 1e-3*z", "Solver/Method=newton",
                                          "Output/Every=0", *settings) for word in ("--set", setting)]
            return self.call(REPOSITORY / "prm/studies/scenes/free.prm", "--quiet", "--output", "out", *words)

        stopped = run("Solver/Maximum iterations=1")
        self.assertEqual(stopped.status, 2)
        self.assertRegex(stopped.stderr, "stopped at its iteration limit.* change .*Solver/Maximum iterations")
        self.assertEqual(run("Solver/Maximum iterations=5000").status, 0)


def choice(row):
    """The values that a row has on the axes of its study, but for the element."""
    return tuple(value for key, value in row.items() if "/" in key and key not in ("Model/Element", "Model/Dilatation"))


class OtherStability(StabilityTest):
    """A test of each other study."""


for _study in STUDIES:
    setattr(Stability if _study.stem in QUICK else OtherStability, "test_" + _study.stem, lambda self, study=_study: self.check_study(study))


if __name__ == "__main__":
    unittest.main()
