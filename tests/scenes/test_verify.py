# SPDX-License-Identifier: GPL-3.0-or-later
"""The reference cases as a user runs them: names, lines, exit status."""

import unittest

from exemplar_runner import SceneTest


N_CASES = 78  # none may be lost


class Verify(SceneTest):
    def test_a_line_for_each_number(self):
        run = self.call("verify", "uniform-scale", "free-fall")
        self.assertEqual((run.status, run.stderr), (0, ""))
        head, *lines, last = run.stdout.splitlines()
        self.assertEqual(head.split(), ["case", "(what)", "expected", "got", "tolerance"])
        self.assertEqual([line[:20] for line in lines],
                         ["PASS  uniform-scale ", "PASS  free-fall (y_n", "PASS  free-fall (gre"])
        self.assertEqual(lines[0].split()[-4:], ["1350", "1350", "1e-12", "relative"])
        self.assertEqual(last, "2 of 2 cases pass")

    def test_the_same_bytes_each_time(self):
        self.assertEqual(self.call("verify", "patch", "energy-bound"),
                         self.call("verify", "patch", "energy-bound"))

    def test_nothing_is_left_behind(self):
        self.call("verify", "patch")
        self.assertEqual(list(self.directory.iterdir()), [])

    def test_an_unknown_name_is_refused_before_anything_is_run(self):
        run = self.call("verify", "uniform-scale", "uniform-scal")
        self.assertEqual((run.status, run.stdout), (1, ""))
        self.assertIn("'uniform-scal'", run.stderr)
        self.assertIn("Did you mean 'uniform-scale'?", run.stderr)

    def test_list_names_every_case_once(self):
        run = self.call("verify", "--list")
        self.assertEqual((run.status, run.stderr), (0, ""))
        names = [line.split()[0] for line in run.stdout.splitlines()]
        self.assertEqual(len(names), N_CASES)
        self.assertEqual(len(names), len(set(names)))
        for line in run.stdout.splitlines():
            self.assertGreater(len(line.split()), 1, line)

    def test_it_goes_with_no_scene(self):
        for arguments in (["scene.prm", "verify"], ["--quiet", "verify"]):
            run = self.call(*arguments)
            self.assertEqual((run.status, run.stdout), (1, ""))
            self.assertIn("The command stands first", run.stderr)


if __name__ == "__main__":
    unittest.main()
