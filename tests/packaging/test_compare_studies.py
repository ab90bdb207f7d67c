# SPDX-License-Identifier: GPL-3.0-or-later
"""doc/scripts/compare_studies.py: which rows of a study differ from those kept, without running it.

Usage: python3 tests/packaging/test_compare_studies.py
"""
import contextlib
import io
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "doc/scripts"))
import compare_studies
import study_tables

NAME = "step5_jerk"


class CompareStudies(unittest.TestCase):
    def setUp(self):
        self.rows = study_tables.read(NAME)
        self.files = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.path = self.files / f"{NAME}.csv"
        self.kept = (study_tables.FILES / f"{NAME}.csv").read_text()
        self.path.write_text(self.kept)

    def compare(self, *words):
        """Exit status and what is printed, if the study gives self.rows."""
        said = io.StringIO()
        with mock.patch.object(compare_studies, "results", return_value=self.rows), \
             mock.patch.object(compare_studies, "FILES", self.files), mock.patch.object(study_tables, "FILES", self.files), \
             mock.patch.object(sys, "argv", ["", *words, NAME]), contextlib.redirect_stdout(said):
            try:
                compare_studies.main()
            except SystemExit as end:
                return 1, said.getvalue() + str(end)
        return 0, said.getvalue()

    def test_the_same_rows_and_other_seconds_do_not_differ(self):
        self.rows[0].update(seconds_median="1000", run="other", peak_memory_mib="1")
        self.assertEqual(self.compare()[0], 0)

    def test_counts_errors_and_endings_differ(self):
        self.rows[0]["iterations"] = str(int(self.rows[0]["iterations"]) + 1)
        self.rows[1]["error_position_l2"] = str(1.1 * float(self.rows[1]["error_position_l2"]))
        self.rows[2]["status"] = "stalled"
        self.rows[3]["error_energy"] = str(1.001 * float(self.rows[3]["error_energy"]))
        status, said = self.compare()
        self.assertEqual((status, said.count("->")), (1, 3))
        self.assertIn("3 of 10 rows differ", said)
        self.assertEqual(self.path.read_text(), self.kept)

    def test_missing_and_new_rows_differ(self):
        self.rows[0]["Time/Step"] = "123"
        status, said = self.compare()
        self.assertEqual(status, 1)
        self.assertIn("is new", said)
        self.assertIn("is no longer there", said)

    def test_keep_replaces_the_rows_that_differ(self):
        self.rows[0].update(iterations="1000", seconds_median="1000")
        self.rows[1].update(seconds_median="1000")
        self.compare("--keep")
        before, after = self.kept.splitlines(), self.path.read_text().splitlines()
        self.assertEqual([i for i, (old, new) in enumerate(zip(before, after)) if old != new], [1])
        self.assertEqual(len(before), len(after))
        self.assertEqual(self.compare()[0], 0)

    def test_unknown_studies_are_refused(self):
        self.assertIn("no study: step9", self.compare("step9")[1])


unittest.main()
