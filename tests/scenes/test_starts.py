# SPDX-License-Identifier: GPL-3.0-or-later
"""Solver/Starts = examples finds the equilibrium of least energy, and without it a warning says where one was missed."""
import unittest

from exemplar_runner import BAR, SceneTest, bend, prm, read_csv, read_summary

# The end may go up and down, and is pushed up a little; it begins bent downwards.
UP, DOWN = bend("pi/3"), bend("-pi/3")
SCENE = {**BAR, "Mesh/Box size": "4, 1, 1", "Mesh/Box cells": "4, 2, 2", "Time/Increments": "1", "Loads/Gravity": "0, 0, 0.2",
         "Handles/Names": "left, right", "Handles/left/Select": "boundary 1", "Handles/right/Select": "box 3.9 -1 -0.1 4.1 1 0.1",
         "Handles/right/Motion": "-0.7*t; 0; 0", "Handles/right/Components": "x",
         "Examples/Pose functions": f"{UP} | {DOWN}", "Examples/Importance": "1", "Initial/Pose function": DOWN}


class Starts(SceneTest):
    def solved(self, **keys):
        self.write("scene.prm", prm({**SCENE, **{key.replace("_", "/"): value for key, value in keys.items()}}))
        run = self.call("scene.prm", "--output", "output")
        self.assertEqual(run.status, 0, run.stderr)
        return run, read_csv(self.directory / "output")[-1], read_summary(self.directory / "output")

    def test_the_least_energy_is_kept_and_all_are_told(self):
        _, missed, summary = self.solved()
        self.assertGreater(missed["weight_2"], 0.9)
        self.assertEqual(len([w for w in summary["warnings"] if "Set Solver/Starts = examples" in str(w)]), 1)
        run, found, summary = self.solved(Solver_Starts="examples")
        self.assertGreater(found["weight_1"], 0.9)
        self.assertFalse([w for w in summary["warnings"] if "Solver/Starts" in str(w)])
        starts = summary["starts"]
        self.assertEqual(len(starts), 4)  # the steps, the rest pose and two examples
        kept = [start for start in starts if start["kept"]]
        self.assertEqual(len(kept), 1)
        self.assertEqual(kept[0]["energy"], min(start["energy"] for start in starts))
        self.assertLess(kept[0]["energy"], starts[0]["energy"])
        self.assertEqual(run.stdout.count("From "), 4)

    def test_the_pose_that_was_meant_is_not_warned_of(self):
        _, found, summary = self.solved(**{"Initial_Pose function": UP})
        self.assertGreater(found["weight_1"], 0.9)
        self.assertFalse([w for w in summary["warnings"] if "Solver/Starts" in str(w)])

    def test_refused(self):
        for keys, words in (({"Scene": "dynamic", "Time/Increments": None}, "static scenes with examples"),
                            ({"Examples/Importance": "0"}, "static scenes with examples"),
                            ({"Examples/Yield": "10"}, "depends on the whole way")):
            with self.subTest(words):
                scene = {**SCENE, "Solver/Starts": "examples", **keys}
                self.write("scene.prm", prm({key: value for key, value in scene.items() if value is not None}))
                run = self.call("scene.prm", "--output", "refused")
                self.assertEqual(run.status, 1)
                self.assertIn(words, run.stderr)


if __name__ == "__main__":
    unittest.main()
