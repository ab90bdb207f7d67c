# SPDX-License-Identifier: GPL-3.0-or-later
"""Shells made of arrays: what is there, and what is refused by name."""

import sys
import unittest
from pathlib import Path

import exemplar
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scenes"))
from shell_meshes import rolled_vertices, strip  # noqa: E402

SCENE = """
set Scene = static
subsection Mesh
  set Kind = shell
end
subsection Material
  set Thickness = 0.001
end
subsection Time
  set Increments = 2
end
subsection Handles
  set Names = left
  subsection left
    set Select = box -1 -1 -1 0.1 1 1
  end
end
subsection Loads
  set Gravity = 0, 0, -1e-3
end
"""


class Shells(unittest.TestCase):
    def setUp(self):
        vertices, triangles = strip(1., .25, 12, 3)
        self.mesh = np.array(vertices), np.array(triangles)
        self.rolled = np.array(rolled_vertices(1., .25, 12, 3, 1.))

    def test_arrays(self):
        problem = exemplar.Problem(SCENE, self.mesh)
        report = problem.step()
        self.assertEqual(str(report.status), "converged")
        self.assertEqual(problem.cells.shape, self.mesh[1].shape)
        self.assertEqual(problem.positions.shape, self.mesh[0].shape)
        self.assertLess(problem.positions[:, 2].min(), -1e-6)
        self.assertAlmostEqual(problem.volumes.sum(), .25e-3)

    def test_poses(self):
        problem = exemplar.Problem(SCENE, self.mesh, [self.rolled])
        problem.step()
        self.assertAlmostEqual(sum(problem.weights), 1.)
        problem.set_pose(1, self.mesh[0] * [1., 1.1, 1.])
        problem.step()

    def test_grab_and_let_go(self):
        problem = exemplar.Problem(SCENE.replace("static", "dynamic").replace("set Increments = 2", "set Step = 0.01\n  set End = 1"), self.mesh)
        problem.step()
        right = np.flatnonzero(self.mesh[0][:, 0] > .9)
        problem.grab("right", right, lambda points, t: np.zeros(points.shape))
        problem.step()
        self.assertLess(np.abs(problem.positions - self.mesh[0])[right].max(), 1e-12)
        problem.let_go("right")
        problem.step()

    def test_obstacles(self):
        scene = SCENE.replace("static", "dynamic").replace("set Increments = 2", "set Step = 0.01\n  set End = 1").replace("-1e-3", "-9.81")
        scene += "subsection Obstacles\n  set Names = floor\n  subsection floor\n    set Shape = plane 0 0 -0.01  0 0 1\n  end\nend\n"
        problem = exemplar.Problem(scene, self.mesh)
        for _ in range(10):
            problem.step()
        self.assertEqual(problem.contact_forces.shape, self.mesh[0].shape)
        self.assertGreater(problem.obstacles["floor"]["force"][2], 0)
        np.testing.assert_allclose(problem.contact_forces.sum(0), problem.obstacles["floor"]["force"], atol=1e-12)
        self.assertGreater(problem.positions[:, 2].min(), -.01 + .0005)
        # from above, so that the sheet lies between two
        problem.add_obstacle("lid", "plane 0 0 0.01  0 0 -1", motion="0; 0; -0.1*(t-0.1)")
        for _ in range(5):
            problem.step()
        self.assertLess(problem.positions[:, 2].max(), .01 - .0005)

    def test_what_is_refused(self):
        problem = exemplar.Problem(SCENE, self.mesh)
        problem.step()
        for call in (problem.energy, problem.gradient, lambda: problem.shape_gradients, lambda: problem.strains):
            with self.assertRaisesRegex(exemplar.UserError, "shell"):
                call()
        with self.assertRaisesRegex(exemplar.UserError, "node 1000"):
            exemplar.Problem(SCENE, (self.mesh[0], self.mesh[1] + 1000 - self.mesh[1].min()))


if __name__ == "__main__":
    unittest.main()
