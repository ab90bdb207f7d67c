# SPDX-License-Identifier: GPL-3.0-or-later
"""A sample of the rows of doc/studies, from which the tables of the pages are made, is what the program gives now.

One cheap row of each study is computed again; which one is drawn from the study's name, so that it stays the same until the study
changes. All rows: python3 doc/scripts/compare_studies.py.

Environment: EXEMPLAR, the program.
"""
import random
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path.append(str(TOP / "doc/scripts"))
sys.path.append(str(TOP / "tests/scenes"))
import compare_studies  # noqa: E402
from exemplar_runner import EXEMPLAR  # noqa: E402
from study_tables import STUDIES, axes, read, rows_of  # noqa: E402

CHEAP = 1.  # seconds of a row
BUDGET = 30.  # of all
# Iterations follow rounding, which is another one on other processors: some more or less of them are no other method.
COUNTS = ("iterations", "factorizations")


def differs(column, kept, now):
    if column.startswith(("error_", "condition_")) or column in compare_studies.OF_THE_MACHINE:
        return False
    if column in COUNTS:
        return abs(float(now) - float(kept)) > max(3., .3 * float(kept))
    return compare_studies.differs(column, kept, now)


def text_for(study, row):
    """The study of this row alone, without a reference."""
    text = re.sub(r"\\\n", " ", study.read_text())
    text = re.sub(r"^\s*set (Reference|Repeats|Vary)\b.*\n", "", text, flags=re.MULTILINE)
    text = re.sub(r"^(\s*set Scene\s*=\s*)(\S.*)$", lambda found: found[1] + str((study.parent / found[2]).resolve()), text, flags=re.MULTILINE)
    vary = " | ".join(f'{key}: "{row[key]}"' for key in axes([row]))
    return f"{text}\nset Vary = {vary}\nset Repeats = 1\n"


def sample():
    """(study, row) of one cheap row of each study, as many as the budget has room for."""
    chosen, seconds = [], 0.
    for name, file in STUDIES.items():
        shown = re.findall(r"[\w']+", " ".join(re.findall(r"^\s*set Columns\s*=(.*)$", file.read_text(), re.MULTILINE)))
        rows = [row for row in read(name) if row.get("status") == "converged" and float(row["seconds_median"] or "inf") < CHEAP
                and all(row[column] for column in shown)  # without examples there are no weights, say
                and not row.get("Mesh/File", "").endswith(".geo")]  # each gmsh makes another mesh of it
        if rows:
            row = random.Random(name).choice(rows)
            seconds += float(row["seconds_median"])
            if seconds > BUDGET:
                break
            chosen.append((file, row))
    return chosen


class StudySample(unittest.TestCase):
    def test_rows_are_those_of_this_program(self):
        rows = sample()
        self.assertGreater(len(rows), 20)
        with tempfile.TemporaryDirectory() as directory:
            for study, row in rows:
                with self.subTest(study.stem):
                    here = Path(directory) / study.stem
                    here.mkdir()
                    (here / "sample.prm").write_text(text_for(study, row))
                    done = subprocess.run([EXEMPLAR, "study", "sample.prm", "--quiet", "--output", "out"], cwd=here, capture_output=True, text=True, timeout=300)
                    self.assertEqual(done.returncode, 0, done.stderr)
                    now = rows_of(here / "out/study.csv")[0]
                    self.assertEqual([(column, value, now[column]) for column, value in row.items() if differs(column, value, now[column])], [])


if __name__ == "__main__":
    unittest.main()
