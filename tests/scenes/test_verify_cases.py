# SPDX-License-Identifier: GPL-3.0-or-later
"""The reference cases themselves. Those of long beams take most of the time and are in a class of their own."""

import unittest

from exemplar_runner import SceneTest

BEAMS = ("pure-bending", "cantilever-")
OF_SEVERAL_PROCESSES = "shared-"  # test_mpi.py


class VerifyTest(SceneTest):
    def verify(self, is_wanted):
        names = [line.split()[0] for line in self.call("verify", "--list").stdout.splitlines()]
        chosen = [name for name in names if is_wanted(name) and not name.startswith(OF_SEVERAL_PROCESSES)]
        run = self.call("verify", *chosen)
        self.assertEqual((run.status, run.stderr), (0, ""), run.stdout)
        self.assertEqual(run.stdout.splitlines()[-1], f"{len(chosen)} of {len(chosen)} cases pass")
        return chosen


class Cases(VerifyTest):
    def test_all_but_beams(self):
        self.assertGreater(len(self.verify(lambda name: not name.startswith(BEAMS))), 50)


class Beams(VerifyTest):
    def test_beams(self):
        self.assertGreater(len(self.verify(lambda name: name.startswith(BEAMS))), 8)


if __name__ == "__main__":
    unittest.main()
