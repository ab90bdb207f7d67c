# SPDX-License-Identifier: GPL-3.0-or-later
"""Pieces that are drawn touching each other or slightly within each other, and pieces far from others: exact crossings, closed forms,
the same body in one piece, and what is an error."""

import re
import unittest
from math import cos, pi, sin

import numpy as np
from exact_crossings import crossings
from exemplar_runner import read_csv
from piece_boxes import Box
from test_body_contact import FREE, G, BodyContactTest

SIDE = 0.2
DISTANCE = 5e-3 * SIDE * 3**0.5
STACK = {**FREE, "Loads/Gravity": f"0, 0, {-G}", "Handles/Names": "base", "Handles/base/Select": "box -1 -1 -1  1 1 0.001",
         "Time/End": "0.4", "Output/Every": "10"}


def cube(level, gap=0.0, shift=0.0, n=2):
    low = level * (SIDE + gap)
    return Box((shift, shift, low), (SIDE + shift, SIDE + shift, low + SIDE), (n, n, n))


class Touching(BodyContactTest):
    def top(self, output):
        return self.last(output)[:, 2].max()

    def settled_top(self, levels, young):
        """By the weight above, of a column that is free to widen."""
        height = levels * SIDE
        return height - 1000 * G * height**2 / 2 / young

    def assert_stands(self, output, levels, young):
        self.assert_apart(output)
        rows = read_csv(output)
        self.assertGreater(min(row["least_body_gap"] for row in rows), 0)
        self.assertLess(max(row["iterations"] for row in rows), 150)
        x, owners = self.last(output), np.array(self.owners)
        for level in range(levels - 1):
            gap = x[owners == level + 1][:, 2].min() - x[owners == level][:, 2].max()
            self.assertLess(gap, DISTANCE)
        self.assertAlmostEqual(self.top(output), self.settled_top(levels, young), delta=0.02 * levels * SIDE)

    def test_cubes_that_touch_or_almost_do_stand(self):
        for gap, young, shift, method in ((0, "1e6", 0, "auto"), (1e-12, "1e7", 0.03, "newton"), (1e-9, "1e8", 0.013, "auto"),
                                          (1e-6, "1e6", 0, "auto"), (1e-4, "1e7", 0.03, "auto")):
            with self.subTest(gap=gap, young=young, method=method):
                self.write_pieces(*(cube(k, gap, shift * (k % 2)) for k in range(3)))
                output = self.solve({**STACK, "Material/Young's modulus": young, "Solver/Method": method})
                self.assert_stands(output, 3, float(young))

    def test_nothing_is_pushed_at_the_start(self):
        self.write_pieces(cube(0), cube(1, n=3), Box((SIDE, 0, 0), (2 * SIDE, SIDE, SIDE), (1, 1, 1)))
        rows = read_csv(self.solve({**FREE, "Material/Young's modulus": "1e8", "Time/Step": "0.001", "Time/End": "0.02"}))
        self.assertEqual(max(row["energy_kinetic"] for row in rows), 0)

    def test_an_overlap_below_the_distance_is_moved_apart_and_a_deeper_one_is_an_error(self):
        self.write_pieces(cube(0), cube(1, -0.8 * DISTANCE, 0.01))
        output = self.solve({**STACK, "Material/Young's modulus": "1e7"})
        self.assert_stands(output, 2, 1e7)
        depth = 0.03
        for low, way in (((0.02, 0.01, SIDE - depth), 2), ((SIDE - depth, 0.01, 0.02), 0)):
            self.write_pieces(cube(0), Box(low, tuple(c + 0.15 for c in low), (2, 2, 2)))
            run = self.attempt(STACK, output="deep")
            self.assertEqual(run.status, 1)
            found = re.search(r"overlap near \(.*\) m where.*by \(([-0-9.e]+), ([-0-9.e]+), ([-0-9.e]+)\) m of the piece with its centre", run.stderr)
            self.assertTrue(found, run.stderr)
            np.testing.assert_allclose([float(c) for c in found.groups()], np.eye(3)[way] * depth, atol=1e-3 * depth)
            self.assertFalse(run.output.exists())
        self.write_pieces(cube(0), Box((0.05, 0.05, 0.05), (0.1, 0.1, 0.1)))
        self.assertIn("overlap near", self.attempt(STACK).stderr)

    def test_a_row_between_two_that_are_held_bears(self):
        # nothing can be moved: the blocks bear each other by points below their surfaces
        self.write_pieces(*(Box((k * SIDE, 0, 0), ((k + 1) * SIDE, SIDE, SIDE), (2, 2, 2)) for k in range(3)))
        for method in ("newton", "quasi newton"):
            rows = read_csv(self.solve({**FREE, "Material/Young's modulus": "1e6", "Handles/Names": "left, right",
                                        "Handles/left/Select": "box -1 -1 -1  0.001 1 1", "Handles/right/Select": "box 0.599 -1 -1  1 1 1",
                                        "Handles/right/Motion": "-0.02*min(5*t, 1); 0; 0", "Solver/Method": method,
                                        "Solver/Tolerance": "1e-10", "Solver/Step tolerance": "1e-10"}))
            # a strain of a thirtieth
            self.assertAlmostEqual(rows[-1]["reaction_left_x"] / (1e6 / 30 * SIDE**2), 1, delta=0.1)
            self.assertAlmostEqual(rows[-1]["reaction_left_x"] / rows[-1]["reaction_right_x"], -1, delta=1e-2)
            self.assertGreater(min(row["least_body_gap"] for row in rows), 0)

    def test_friction_between_pieces_has_no_moment(self):
        self.write_pieces(cube(0), cube(1, shift=0.02, n=3))
        output = self.solve({**STACK, "Material/Young's modulus": "1e6", "Contact/Friction": "0.6", "Output/Every": "1", "Time/End": "0.1",
                             "Initial/Velocity": "(z > 0.2001 ? 1 : 0); (z > 0.2001 ? 0.4 : 0); 0"})
        for x, arrays in list(self.frames(output))[2:]:
            force = np.array(arrays["PointData", "body_contact_force"]).reshape(-1, 3)
            upper = np.array(self.owners) == 1
            moment = np.cross(x, force)
            self.assertGreater(np.linalg.norm(force[upper].sum(0)[:2]), 1)
            self.assertLess(np.abs(moment.sum(0)).max(), 2e-6 * np.abs(moment[upper].sum(0)).max())  # frames have six digits

    def test_an_arch_stands(self):
        n, inner, outer, first, last = 7, 0.5, 0.7, 0.1, pi - 0.1

        def block(k):
            def place(x, y, z):
                angle = first + (k + x) * (last - first) / n
                radius = inner + (outer - inner) * z
                return -radius * cos(angle), y, radius * sin(angle)
            return Box((0, 0, 0), (1, 0.2, 1), (2, 1, 2), place)

        self.write_pieces(*map(block, range(n)))
        before = self.rest[:, 2].max()
        output = self.solve({**STACK, "Material/Young's modulus": "1e7", "Contact/Friction": "0.6", "Time/End": "1",
                             "Handles/base/Select": "box -1 -1 -1  1 1 0.15", "Output/Every": "20"})
        self.assert_apart(output)
        self.assertAlmostEqual(self.top(output), before, delta=0.02 * before)

    def test_a_wall_whose_lowest_bricks_are_held_stands(self):
        """The held bricks cannot be moved apart; those above them are."""
        def brick(low, high, level):
            return Box((low, 0, 0.1 * level), (high, 0.1, 0.1 * (level + 1)), (round((high - low) / 0.1), 1, 1))

        self.write_pieces(*(brick(0.2 * k, 0.2 * (k + 1), 0) for k in range(2)), brick(0, 0.1, 1), brick(0.1, 0.3, 1), brick(0.3, 0.4, 1))
        output = self.solve({**STACK, "Material/Young's modulus": "1e7", "Contact/Friction": "0.6"})
        for x, arrays in self.frames(output):
            piece = {node: self.owners[cell[0]] for cell in np.array(arrays["Cells", "connectivity"]).reshape(len(self.cells), -1)
                     for node in cell}
            pairs = {frozenset((piece[edge[0]], piece[triangle[0]])) for edge, triangle in crossings(x, self.triangles)}
            self.assertLessEqual({pair for pair in pairs if len(pair) == 2}, {frozenset((0, 1))})
        self.assertAlmostEqual(self.top(output), 0.2 - 1000 * G * 0.2**2 / 2 / 1e7, delta=0.02 * 0.2)


class FarPieces(BodyContactTest):
    def test_what_is_far_away_does_not_change_where_a_block_rests(self):
        block = Box((0, 0, 0.002), (0.1, 0.1, 0.102), (2, 2, 2))
        scene = {**FREE, "Loads/Gravity": f"0, 0, {-G}", "Material/Young's modulus": "1e6", "Obstacles/Names": "floor",
                 "Obstacles/floor/Shape": "plane 0 0 0  0 0 1", "Obstacles/floor/Friction": "0.3", "Time/Step": "0.02", "Time/End": "1",
                 "Output/Every": "0"}
        heights = []
        for others in ((), (Box((3, 0, 0.01), (3.5, 0.5, 0.51)),), (Box((90, 0, 0.01), (90.02, 0.02, 0.03)), Box((0, 7, 0.01), (2, 9, 2.01)))):
            self.write_pieces(block, *others)
            run = self.attempt({**scene, "Contact/Bodies": "true" if others else "false"}) # warns of its length
            self.assertEqual(run.status, 0, run.stderr)
            heights.append(self.last(run.output)[np.array(self.owners) == 0][:, 2].min())
        np.testing.assert_allclose(heights, heights[0], atol=1e-3 * 0.1)

    def test_the_smaller_one_of_two_pieces_decides_between_them(self):
        small, base = Box((0.4, 0.4, 0.51), (0.5, 0.5, 0.61), (2, 2, 2)), Box((0, 0, 0), (1, 1, 0.5), (5, 5, 2))
        gaps = []
        for others in ((), (Box((20, 0, 0), (25, 5, 5)),)):
            self.write_pieces(base, small, *others)
            run = self.attempt({**STACK, "Material/Young's modulus": "1e7", "Handles/base/Select": "box -1 -1 -1  99 99 0.001",
                                "Time/End": "1"}) # warns of its length
            self.assertEqual(run.status, 0, run.stderr)
            x, owners = self.last(run.output), np.array(self.owners)
            gaps.append(x[owners == 1][:, 2].min() - 0.5)
        self.assertLess(gaps[0], 5e-3 * 0.1 * 3**0.5)
        self.assertAlmostEqual(gaps[0], gaps[1], delta=1e-4 * 0.1)


if __name__ == "__main__":
    unittest.main()
