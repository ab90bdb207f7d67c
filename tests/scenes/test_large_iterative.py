# SPDX-License-Identifier: GPL-3.0-or-later
"""Solver/Linear solver = auto on meshes of some size: not their size decides, but the work of a factorisation."""

import unittest

from exemplar_runner import BAR, SceneTest, needs_trilinos, read_summary

# with cells the choice was measured (doc/measured.md); patches double the operations of a factorisation
ONE_STEP = {**BAR, "Model/Dilatation": "cells", "Loads/Gravity": "0, 0, -1e-6", "Time/Increments": "1",
            "Solver/Method": "one pass", "Output/Every": "0"}


@needs_trilinos
class Automatic(SceneTest):
    def chosen(self, keys):
        summary = read_summary(self.solve({**ONE_STEP, **keys}))
        return summary["linear_solver"], summary["dofs"] - summary["constrained_dofs"]

    def test_compact_bodies(self):
        solver, n_free = self.chosen({"Mesh/Box size": "1, 1, 1", "Mesh/Box cells": "22, 22, 22"})
        self.assertEqual(solver, "iterative")
        thin_solver, n_free_of_thin = self.chosen({"Mesh/Box size": "20, 1, 1",
                                                   "Mesh/Box cells": "180, 8, 8"})
        self.assertEqual(thin_solver, "cholesky")
        self.assertGreater(n_free_of_thin, n_free)

    def test_columns_of_examples_count(self):
        box = {"Mesh/Box size": "1, 1, 1", "Mesh/Box cells": "22, 22, 22"}
        examples = {"Examples/Pose functions": "1.1*x; y; z | x; 1.1*y; z | x; y; 1.1*z"}
        self.assertEqual(self.chosen({**box, **examples})[0], "cholesky")
        prescribed = {"Examples/Weights": "prescribed", "Examples/Prescribed weights": "0.4; 0.2; 0.2; 0.2"}
        self.assertEqual(self.chosen({**box, **examples, **prescribed})[0], "iterative")


if __name__ == "__main__":
    unittest.main()
