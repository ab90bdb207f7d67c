# SPDX-License-Identifier: GPL-3.0-or-later
"""Run the examples of doc/python and look at what they print."""
import importlib.util
import re
import subprocess
import sys
import unittest
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parents[2] / "doc/python"


def rows_of(*command):
    """The lines that are numbers alone, as lists of these."""
    done = subprocess.run([sys.executable, EXAMPLES / command[0], *command[1:]], capture_output=True, text=True)
    if done.returncode != 0 or done.stderr:
        raise AssertionError(done.stdout + done.stderr)
    return [[float(word) for word in line.split()] for line in done.stdout.splitlines()
            if re.fullmatch(r"[-\d. nae]+", line)]


class Examples(unittest.TestCase):
    def test_bar_by_hand(self):
        rows = rows_of("bar_by_hand.py")
        self.assertEqual(len(rows), 5)
        for _, rest, bent, _ in rows:
            self.assertAlmostEqual(rest + bent, 1, delta=2e-3)
        self.assertGreater(rows[-1][2], rows[0][2] + 0.1)

    def test_cat_by_function(self):
        rows = rows_of("cat_by_function.py", "3")
        self.assertEqual(len(rows), 3)
        self.assertGreater(rows[-1][2], 0.7)  # the end pulls the paws back by 22 cm: it arches its back
        self.assertGreater(rows[-1][4], rows[0][4])

    def test_sweep(self):
        rows = rows_of("sweep.py")
        self.assertEqual(len(rows), 5)
        forces = [force for _, _, force, _ in rows]
        for before, after in zip(forces, forces[1:]):  # more importance, less force
            self.assertGreater(before, 1.05 * after)

    @unittest.skipUnless(importlib.util.find_spec("scipy"), "needs scipy")
    def test_fit_stiffness(self):
        (seen, mean, _, greatest), = rows_of("fit_stiffness.py", "2")
        self.assertGreater(seen, 0.8)
        self.assertLess(mean, 0.005)
        self.assertLess(greatest, 0.02)

    @unittest.skipUnless(importlib.util.find_spec("scipy"), "needs scipy")
    def test_find_drag(self):
        (distance, work, *drags), = rows_of("find_drag.py", "4")
        self.assertLess(distance, 30)  # mm, of 150 at first; 9 iterations bring it to 0
        self.assertGreater(work, 1)
        self.assertEqual(len(drags), 6)

    def test_reach_by_muscles(self):
        rows = rows_of("reach_by_muscles.py")
        self.assertGreater(rows[0][-1], 30)  # mm
        self.assertLess(rows[-1][-1], 0.01)
        self.assertEqual(rows[-1][2:4], [52, 12])  # cm
        self.assertGreater(rows[-1][0], rows[-1][1])

    def test_follow_markers(self):
        rows = rows_of("follow_markers.py", "2")
        self.assertEqual(len(rows), 2)
        for _, *weights in rows:
            for played, found in zip(weights[::2], weights[1::2]):
                self.assertAlmostEqual(played, found, delta=0.03)

    @unittest.skipUnless(importlib.util.find_spec("scipy"), "needs scipy")
    def test_stand_tall(self):
        rows = rows_of("stand_tall.py")
        self.assertGreater(rows[0][2], 5)  # mm
        self.assertLess(abs(rows[-1][2]), 1e-3)
        self.assertLess(len(rows), 7)


if __name__ == "__main__":
    unittest.main()
