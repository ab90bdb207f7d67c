# SPDX-License-Identifier: GPL-3.0-or-later
"""Solver/Linear solver = iterative gives what the factorisation does, the same bytes each time; without Trilinos it is
refused."""

import unittest

from exemplar_runner import (BAR, SceneTest, greatest_distance, has_trilinos, needs_trilinos, read_csv, read_msh,
                             read_summary, results)

# held at one end, on rollers at the other: nodes of which one component is held
BENT = {**BAR, "Mesh/Box size": "4, 1, 1", "Mesh/Box cells": "12, 3, 3", "Time/Increments": "2",
        "Handles/Names": "left, right", "Handles/right/Select": "boundary 2",
        "Handles/right/Motion": "0; 0; 0.5*t", "Handles/right/Components": "z"}
EXAMPLE_POSES = {"Examples/Pose functions": "1.2*x; y; z | x; y; z+0.05*x^2"}
EXAMPLES = {**BENT, **EXAMPLE_POSES}
DYNAMIC = {**BENT, "Scene": "dynamic", "Time/Increments": None, "Time/Step": "0.02", "Time/End": "0.24"}
ITERATIVE = {"Solver/Linear solver": "iterative"}


@needs_trilinos
class Iterative(SceneTest):
    def check_agreement(self, scene):
        cholesky, iterative = (self.solve({**scene, "Solver/Linear solver": solver}, output=solver)
                               for solver in ("cholesky", "iterative"))
        for output, name, part in ((cholesky, "cholesky", "Cholesky factor"),
                                   (iterative, "iterative", "algebraic multigrid")):
            summary = read_summary(output)
            self.assertEqual((summary["linear_solver"], part in summary["used"]), (name, True))
        ends = [read_msh(output / "final.msh").nodes for output in (cholesky, iterative)]
        moved = greatest_distance(ends[0], read_msh(self.rest(scene)).nodes)
        self.assertGreater(moved, 0.1)
        self.assertLess(greatest_distance(*ends), 1e-6 * moved)
        return [read_csv(output)[-1] for output in (cholesky, iterative)]

    def rest(self, scene):
        self.write_box(scene, "rest.msh")
        return self.directory / "rest.msh"

    def test_static_scene(self):
        self.check_agreement(BENT)

    def test_static_scene_with_examples(self):
        last = self.check_agreement(EXAMPLES)
        self.assertGreater(max(last[0]["weight_1"], last[0]["weight_2"]), 0.1)
        for i in range(3):
            self.assertAlmostEqual(last[0][f"weight_{i}"], last[1][f"weight_{i}"], delta=1e-6)

    def test_one_pass_leaves_nothing_to_the_next(self):
        self.check_agreement({**DYNAMIC, "Solver/Method": "one pass"})

    def test_quasi_newton_keeps_a_hierarchy(self):
        quasi_newton = {**DYNAMIC, "Solver/Method": "quasi newton", "Solver/Step tolerance": "1e-9"}
        self.check_agreement(quasi_newton)
        last = self.check_agreement({**quasi_newton, **EXAMPLE_POSES, "Examples/Importance": "0.5"})
        self.assertGreater(last[0]["weight_2"], 0.01)
        # and no more of its work than with a factor is left to the iterations
        scene = {**DYNAMIC, "Solver/Method": "quasi newton", "Mesh/Box cells": "24, 6, 6"}
        steps = [read_summary(self.solve({**scene, "Solver/Linear solver": solver}, output=solver))["iterations"]
                 for solver in ("cholesky", "iterative")]
        self.assertLess(steps[1], 1.5 * steps[0])

    def test_two_runs_give_the_same_bytes(self):
        for scene in (EXAMPLES, DYNAMIC):
            first, second = (results(self.solve({**scene, **ITERATIVE}, output=output))
                             for output in ("first", "second"))
            self.assertEqual(first["statistics.csv"], second["statistics.csv"])
            self.assertEqual(first, second)

    def test_a_step_that_no_solver_finds_ends_with_status_2(self):
        # the same end as with a factor, and nothing but our own words
        scene = {**BENT, "Time/Increments": "1", "Handles/right/Motion": "0; 0; 1e200*t"}
        runs = [self.attempt({**scene, "Solver/Linear solver": solver}, output=solver)
                for solver in ("cholesky", "iterative")]
        for run in runs:
            self.assertEqual(run.status, 2)
            self.assertRegex(run.stderr, r"^Warning: Handles move by .*\nexemplar: Step 1 .*\n$")


class LinearSolvers(SceneTest):
    def test_auto_takes_cholesky_for_small_scenes(self):
        output = self.solve(BAR)
        self.assertEqual(read_summary(output)["linear_solver"], "cholesky")
        self.assertIn("algebraic multigrid", read_summary(output)["left_out"])

    def test_memory_of_a_cell(self):
        summary = read_summary(self.solve(BAR))
        self.assertAlmostEqual(summary["bytes_per_cell"] * summary["cells"],
                               summary["peak_memory_mib"] * 2 ** 20, delta=summary["cells"])

    @unittest.skipIf(has_trilinos(), "built with Trilinos")
    def test_without_trilinos_it_is_refused(self):
        for arguments in ([], ["--validate"]):
            run = self.attempt({**BENT, **ITERATIVE}, *arguments)
            self.assertEqual((run.status, run.stdout), (1, ""))
            self.assertRegex(run.stderr, r"^exemplar: Solver/Linear solver = iterative: this exemplar was built without "
                                         r"Trilinos \(Epetra and ML\)\. Set .*cholesky.*\n$")
            self.assertFalse(run.output.exists())


if __name__ == "__main__":
    unittest.main()
