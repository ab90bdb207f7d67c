# SPDX-License-Identifier: GPL-3.0-or-later
"""What a scene does not need is not built: by its summary, its files and its columns."""

import unittest

from exemplar_runner import BAR, SceneTest, needs_trilinos, read_csv, read_summary, results

EXAMPLE = {**BAR, "Examples/Pose functions": "1.1*x; y; z"}
DYNAMIC = {**BAR, "Scene": "dynamic", "Time/Increments": None, "Time/Step": "0.01", "Time/End": "0.02"}
# the paper's method, as far as a linear solver is concerned
PAPER = {"Solver/Method": "fixed point", "Examples/Weights": "free",
         "Solver/Maximum iterations": "500"}
COLUMNS_OF_ALL = ["step", "time", "status", "iterations", "residual", "factorizations", "newton_decrement", "energy_elastic"]
SECONDS = ["seconds_step", "seconds_evaluate", "seconds_assemble", "seconds_factorize",
           "seconds_solve", "seconds_output"]
WEIGHTS = ["weight_0", "weight_1"]
MOMENTA = ["momentum_x", "momentum_y", "momentum_z",
           "angular_momentum_x", "angular_momentum_y", "angular_momentum_z"]
REACTION = ["reaction_left_x", "reaction_left_y", "reaction_left_z"]


class LeftOut(SceneTest):
    def check_parts(self, output, used, left_out):
        summary = read_summary(output)
        self.assertEqual(set(summary["used"]) & set(summary["left_out"]), set())
        for part in used:
            self.assertIn(part, summary["used"])
        for part in left_out:
            self.assertIn(part, summary["left_out"])

    def check_columns(self, output, *groups):
        self.assertEqual(list(read_csv(output)[0]), sum(groups, []))

    def test_static_scene_without_examples(self):
        output = self.solve(BAR)
        self.check_parts(output, ["handles", "gravity", "Cholesky factor", "frame writer"],
                         ["mass matrix", "own support of interpolation", "loads", "example poses",
                          "weight block", "Schur complement", "algebraic multigrid",
                          "UMFPACK"])
        self.check_columns(output, COLUMNS_OF_ALL, ["min_det_F", "inverted_cells", "work_handles",
                                                    "work_gravity"], REACTION, SECONDS)
        self.assertEqual(read_summary(output)["examples"], 0)

    def test_dynamic_scene_without_gravity(self):
        output = self.solve({**DYNAMIC, "Loads/Gravity": None, "Loads/Names": "tip",
                             "Loads/tip/Select": "boundary 2", "Loads/tip/Force": "0; 0; 1"})
        self.check_parts(output, ["mass matrix", "loads"],
                         ["gravity", "example poses", "second-order time scheme", "mass damping",
                          "stiffness damping"])
        self.check_columns(output, COLUMNS_OF_ALL, ["energy_kinetic", "energy_inertia",
                                                    "min_det_F", "inverted_cells"],
                           MOMENTA, ["work_handles", "work_loads"], REACTION, SECONDS)

    def check_memory(self, scene, *parts):
        """That these parts of the scene, and no others, hold memory."""
        memory = read_summary(self.solve(scene))["memory_mib"]
        self.assertEqual({part for part, mib in memory.items() if mib > 0},
                         {"mesh", "cells", "gravity", "linear solver", *parts})

    def test_what_is_not_there_takes_no_memory(self):
        prescribed = {"Examples/Weights": "prescribed", "Examples/Prescribed weights": "0.5; 0.5"}
        dynamic_example = {**EXAMPLE, **DYNAMIC}
        newton = {"Solver/Method": "newton"}
        self.check_memory(BAR)
        umfpack = self.solve({**EXAMPLE, **PAPER, "Solver/Linear solver": "umfpack"})
        self.assertNotIn("linear solver", read_summary(umfpack)["memory_mib"])
        self.check_memory({**EXAMPLE, **prescribed}, "example poses")
        self.check_memory(EXAMPLE, "example poses", "weight block")
        self.check_memory({**DYNAMIC, **newton}, "mass matrix")
        self.check_memory(DYNAMIC, "mass matrix", "quasi-Newton method")
        self.check_memory(dynamic_example, "mass matrix", "quasi-Newton method", "example poses",
                          "weight block")

    def test_the_energy_bound_is_there_where_it_holds(self):
        example = {**EXAMPLE, **DYNAMIC}
        prescribed = {"Examples/Weights": "prescribed", "Examples/Prescribed weights": "1-t; t"}
        frozen = {"Model/Gradient": "frozen", "Solver/Method": "one pass"}
        for scene, holds in ((DYNAMIC, True), (example, True), ({**DYNAMIC, **frozen}, True),
                             ({**example, **prescribed}, False), ({**example, **frozen}, False),
                             ({**DYNAMIC, "Time/Scheme": "bdf2"}, False),
                             ({**DYNAMIC, "Time/Mass damping": "1"}, False)):
            self.assertEqual("energy_inertia" in read_csv(self.solve(scene))[0], holds)

    def test_free_weights_need_the_weight_block(self):
        output = self.solve(EXAMPLE)
        self.check_parts(output, ["example poses", "weight block", "Schur complement"],
                         ["mass matrix", "weights per region", "memory of weights"])
        self.check_columns(output, COLUMNS_OF_ALL, ["energy_example"], WEIGHTS,
                           ["multiplier", "kkt_residual", "min_det_F", "inverted_cells", "guarded_cells",
                            "work_handles", "work_gravity"], REACTION, SECONDS)

    def test_weights_that_remember_dissipate(self):
        output = self.solve({**EXAMPLE, "Examples/Yield": "1"})
        self.check_parts(output, ["memory of weights"], [])
        self.check_columns(output, COLUMNS_OF_ALL, ["energy_example", "energy_dissipated"], WEIGHTS,
                           ["multiplier", "kkt_residual", "min_det_F", "inverted_cells", "guarded_cells",
                            "work_handles", "work_gravity"], REACTION, SECONDS)

    def test_second_order_and_damping_are_there_when_asked_for(self):
        output = self.solve({**DYNAMIC, "Time/Scheme": "bdf2", "Time/Mass damping": "1",
                             "Time/Stiffness damping": "0.01"})
        self.check_parts(output, ["second-order time scheme", "mass damping", "stiffness damping"],
                         ["example poses"])

    def test_weights_per_region_have_columns_of_their_own(self):
        output = self.solve({**EXAMPLE, "Examples/Weights per region": "true"})
        self.check_parts(output, ["weights per region", "weight block"], [])
        self.check_columns(output, COLUMNS_OF_ALL, ["energy_example"], ["weight_1_0", "weight_1_1"],
                           ["multiplier_1", "kkt_residual", "min_det_F", "inverted_cells",
                            "guarded_cells", "work_handles", "work_gravity"], REACTION, SECONDS)

    def test_prescribed_weights_need_none(self):
        output = self.solve({**EXAMPLE, "Examples/Weights": "prescribed",
                             "Examples/Prescribed weights": "1-t; t"})
        self.check_parts(output, ["example poses"], ["weight block", "Schur complement"])
        self.check_columns(output, COLUMNS_OF_ALL, ["energy_example"], WEIGHTS,
                           ["min_det_F", "inverted_cells", "guarded_cells", "work_handles",
                            "work_gravity"], REACTION, SECONDS)
        self.assertEqual([(row["weight_0"], row["weight_1"]) for row in read_csv(output)],
                         [(1., 0.), (0.5, 0.5), (0., 1.)])

    def test_interpolation(self):
        output = self.solve({**EXAMPLE, "Scene": "interpolation", "Handles/Names": None,
                             "Handles/left/Select": None, "Loads/Gravity": None,
                             "Examples/Prescribed weights": "1-t; t"})
        self.check_parts(output, ["own support of interpolation", "example poses"],
                         ["mass matrix", "handles", "gravity", "loads", "weight block",
                          "Schur complement"])
        self.check_columns(output, COLUMNS_OF_ALL, ["energy_example"], WEIGHTS,
                           ["min_det_F", "inverted_cells", "guarded_cells"], SECONDS)
        self.assertEqual(len(read_summary(output)["support_nodes"]), 3)

    def test_umfpack_leaves_out_cholmod(self):
        self.check_parts(self.solve({**EXAMPLE, **PAPER, "Solver/Linear solver": "umfpack"}),
                         ["UMFPACK", "weight block"], ["CHOLMOD", "Cholesky factor", "Schur complement"])

    @needs_trilinos
    def test_iterative_leaves_out_both(self):
        self.check_memory({**BAR, "Solver/Linear solver": "iterative"})
        self.check_parts(self.solve({**EXAMPLE, "Solver/Linear solver": "iterative"}),
                         ["algebraic multigrid", "weight block", "Schur complement"],
                         ["CHOLMOD", "Cholesky factor", "UMFPACK"])

    def test_importance_0_opens_no_pose(self):
        for scene in (BAR, DYNAMIC):
            with self.subTest(scene["Scene"]):
                self.check_importance_0(scene)

    def check_importance_0(self, scene):
        plain = results(self.solve(scene, output="plain"))
        (self.directory / "directory.msh").mkdir(exist_ok=True)  # whoever opened it would fail
        for pose in ("absent.msh", "directory.msh"):
            output = self.solve({**scene, "Examples/Poses": pose, "Examples/Importance": "0"},
                                output="importance 0")
            self.check_parts(output, [], ["example poses", "weight block", "Schur complement"])
            self.assertEqual(results(output), plain)

    def test_every_0_writes_no_frames(self):
        output = self.solve({**BAR, "Output/Every": "0"})
        self.check_parts(output, [], ["frame writer"])
        self.assertEqual({file.name for file in output.iterdir()},
                         {"checkpoint.bin", "final.msh", "original.prm", "parameters.prm",
                          "log.txt", "statistics.csv", "summary.json"})


if __name__ == "__main__":
    unittest.main()
