# SPDX-License-Identifier: GPL-3.0-or-later
"""Soft balls that a lid presses flat, and the equilibrium of a contact step that Newton's method completes."""

import unittest

import numpy as np
from exemplar_runner import REPOSITORY, greatest_distance, nodes_of, read_csv
from piece_boxes import Box
from test_body_contact import G, BodyContactTest

DIAMETER = 0.1


def ball(centre, n):
    def place(x, y, z):
        point = np.array((x, y, z))
        length = np.linalg.norm(point)
        return tuple(centre + point * DIAMETER / 2 * (np.abs(point).max() / length if length > 0 else 1))
    return Box((-1, -1, -1), (1, 1, 1), (n, n, n), place)


class Squeezed(BodyContactTest):
    def test_two_balls_are_pressed_to_an_eighth_of_their_height(self):
        self.write_pieces(ball((0, 0, 0.052), 3), ball((0.1015, 0, 0.052), 3))
        run = self.attempt({  # warns of inverted cells
            "Scene": "dynamic", "Mesh/File": "pieces.msh", "Material/Young's modulus": "1e5", "Material/Poisson's ratio": "0.4",
            "Loads/Gravity": f"0, 0, {-G}", "Contact/Bodies": "true", "Contact/Friction": "0.3",
            "Obstacles/Names": "floor, lid", "Obstacles/floor/Shape": "plane 0 0 0  0 0 1", "Obstacles/floor/Friction": "0.3",
            "Obstacles/lid/Shape": "plane 0 0 0.106  0 0 -1", "Obstacles/lid/Motion": "0; 0; -0.094*t", "Obstacles/lid/Friction": "0.3",
            "Time/Step": "0.02", "Time/End": "1", "Output/Every": "10"})
        self.assertEqual(run.status, 0, run.stderr)
        rows = read_csv(run.output)[1:]
        self.assertLess(np.mean([row["iterations"] for row in rows]), 15)
        self.assertLess(max(row["iterations"] for row in rows), 60)
        self.assertGreater(min(row["least_body_gap"] for row in rows), 0)
        # inner nodes of inverted cells may be anywhere
        heights = self.last(run.output)[np.unique(self.triangles), 2]
        self.assertGreater(heights.min(), 0)
        self.assertLess(heights.max(), 0.012)
        # four factors per step: a factor is kept over several iterations
        self.assertLess(sum(row["factorizations"] for row in rows), 200)


class Equilibria(BodyContactTest):
    def test_newton_goes_on_from_where_the_step_has_come_to(self):
        # in this step the default method hands over to Newton's, and there are other equilibria, 27 mm away
        ends = []
        for method in ("auto", "newton"):
            output = self.run_file(REPOSITORY / "prm/contact/two_cats.prm", method, "Time/End=0.1", f"Solver/Method={method}")
            ends.append(nodes_of(output / "final.msh"))
            last = read_csv(output)[-1]
            self.assertGreater(last["factorizations"], 3)
        self.assertLess(greatest_distance(*ends), 1e-4)


if __name__ == "__main__":
    unittest.main()
