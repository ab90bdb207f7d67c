# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of several pieces: each has its own motion, and statics say which one is not held."""

import unittest

import numpy as np
from exemplar_runner import SceneTest, nodes_of, read_csv
from mpirun import launch
from piece_boxes import Box, write_boxes

G = 9.81
SMALL = Box((0, 0, 0), (1, 0.2, 0.2), (4, 1, 1))
OTHER = Box((0, 0, 1), (1, 0.3, 1.2), (3, 1, 1))
SCENE = {"Scene": "dynamic", "Mesh/File": "two.msh", "Material/Young's modulus": "1e6", "Material/Density": "1000",
         "Handles/Names": "left", "Handles/left/Select": "box -0.01 -1 -1  0.01 1 0.5", "Loads/Gravity": f"0, 0, {-G}",
         "Time/Step": "0.01", "Time/End": "0.2", "Output/Every": "0", "Solver/Tolerance": "1e-10"}
STATIC = {**{key: value for key, value in SCENE.items() if key not in ("Time/Step", "Time/End")}, "Scene": "static",
          "Time/Increments": "2"}


class Pieces(SceneTest):
    def setUp(self):
        super().setUp()
        self.places, _, self.owners = write_boxes(self.directory / "two.msh", SMALL, OTHER)

    def displacements(self, output, piece):
        last = nodes_of(output / "final.msh")
        return np.array([np.subtract(last[i + 1], self.places[i]) for i in range(len(last)) if self.owners[i] == piece])

    def test_a_piece_that_nothing_holds_falls_while_the_other_is_held(self):
        for more in ({}, {"Solver/Method": "newton"}, {"Solver/Method": "one pass", "Solver/Tolerance": None},
                     {"Model/Element": "P2", "Solver/Method": "newton"}):
            with self.subTest(**more):
                scene = {key: value for key, value in {**SCENE, **more}.items() if value is not None}
                output = self.solve({**scene, "Solver/Step tolerance": "1e-9"} if not more else scene)
                # implicit Euler: g h^2 n (n + 1) / 2
                fall = G * 0.01 ** 2 * 20 * 21 / 2
                np.testing.assert_allclose(self.displacements(output, 1), np.tile([0, 0, -fall], (16, 1)), atol=1e-7)
                held = self.displacements(output, 0)
                self.assertLess(abs(held[:4]).max() if not held[:4].any() else abs(held).min(), 1e-12)
                self.assertGreater(abs(held).max(), 1e-3)

    def test_the_same_as_each_piece_alone(self):
        output = self.solve({**SCENE, "Solver/Method": "newton", "Solver/Tolerance": "1e-12"})
        alone, _, _ = write_boxes(self.directory / "one.msh", SMALL)
        single = self.solve({**SCENE, "Mesh/File": "one.msh", "Solver/Method": "newton", "Solver/Tolerance": "1e-12"}, output="single")
        last = nodes_of(single / "final.msh")
        np.testing.assert_allclose(self.displacements(output, 0), [np.subtract(last[i + 1], x) for i, x in enumerate(alone)], atol=1e-9)

    def test_statics_name_the_piece_that_is_not_held(self):
        run = self.attempt(STATIC)
        self.assertEqual(run.status, 1)
        self.assertIn("leave 6 of 6 rigid motions of the piece with element 25 free", run.stderr)
        held = {**STATIC, "Handles/Names": "left, other", "Handles/other/Select": "box -0.01 -1 0.5  0.01 1 2"}
        output = self.solve(held)
        self.assertGreater(abs(self.displacements(output, 1)).max(), 1e-3)
        self.assertIn("leave 3 of 6 rigid motions of the piece with element 25",
                      self.attempt({**held, "Handles/other/Select": "box -0.01 -0.01 0.99  0.01 0.01 1.01"}).stderr)

    def test_several_processes_count_the_same_pieces(self):
        for scene, status in ((STATIC, 1), ({**SCENE, "Time/End": "0.05"}, 0)):
            run = self.attempt(scene)
            self.assertEqual(run.status, status)
            shared = launch(2, self.directory / "scene.prm", "--output", self.directory / "shared", "--quiet")
            self.assertEqual(shared[0], status, shared[1])
            if status == 1:
                self.assertIn("of the piece with element 25", "".join(shared[1]))
            else:
                np.testing.assert_allclose([list(x) for x in nodes_of(run.output / "final.msh").values()],
                                           [list(x) for x in nodes_of(self.directory / "shared/final.msh").values()], atol=1e-6)

    def test_an_interpolation_is_of_one_piece(self):
        run = self.attempt({"Scene": "interpolation", "Mesh/File": "two.msh", "Examples/Pose functions": "2*x; y; z"})
        self.assertEqual(run.status, 1)
        self.assertIn("has 2 pieces that no common face connects, beginning with element 1, 25, but Scene = interpolation", run.stderr)


if __name__ == "__main__":
    unittest.main()
