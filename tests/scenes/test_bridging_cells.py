# SPDX-License-Identifier: GPL-3.0-or-later
"""Cells that a pose stretches many times, as those between closed lips: a bar with a thin layer, which the pose opens."""

import unittest

from exemplar_runner import SceneTest, nodes_of

BOX = {"Mesh/Generator": "box", "Mesh/Box size": "4, 1, 1", "Mesh/Box cells": "30, 1, 1"}
LAYER, OPENED = .01, .2


def closed(x, y, z):
    """Nodes in planes of constant x, of which those 15 and 16 bound the layer."""
    i = round(x * 30 / 4)
    return (x if i <= 15 else 2 + LAYER + (i - 16) * (2 - LAYER) / 14), y, z


def opened(x, y, z):
    x, y, z = closed(x, y, z)
    return (x + OPENED - LAYER if x > 2 + LAYER / 2 else x), y, z


SCENE = {
    "Scene": "static", "Mesh/File": "bar.msh", "Material/Young's modulus": "1e6", "Material/Poisson's ratio": "0",
    "Model/Dilatation": "cells", "Examples/Poses": "open.msh", "Examples/Importance": "1e-6", "Handles/Names": "left, right",
    "Handles/left/Select": "box -1 -1 -1 1e-6 1 1", "Handles/right/Select": "box 3.999 -1 -1 5 1 1", "Handles/right/Motion": "0.1*t; 0; 0",
    "Time/Increments": "1", "Output/Every": "0", "Solver/Tolerance": "1e-11",
}


class BridgingCells(SceneTest):
    def gap(self, output):
        planes = sorted({round(x, 9) for x, _, _ in nodes_of(output / "final.msh").values()})
        return planes[16] - planes[15]

    def test_a_layer_that_a_pose_opens_is_soft(self):
        """Springs in a row: the layer has the stretch 20, so that Young's modulus is divided there by 2^8."""
        self.write_box(BOX, "bar.msh", closed)
        self.write_box(BOX, "open.msh", opened)
        run = self.attempt(SCENE)
        self.assertEqual(run.status, 0, run.stderr)
        self.assertIn("Examples/Poses stretch 6 cells up to 20 times, most in ", run.stderr)
        self.assertIn("exemplar mesh --poses", run.stderr)
        soft = 256 * LAYER
        self.assertAlmostEqual(self.gap(run.output) - LAYER, .1 * soft / (soft + 4 - LAYER), delta=1e-5)

    def test_others_are_left_alone(self):
        """A pose that opens less, and one in which all cells are long."""
        self.write_box(BOX, "bar.msh", closed)
        self.write_box(BOX, "open.msh", lambda x, y, z: (closed(x, y, z)[0] + (.08 if x > 2.1 else 0), y, z))
        self.assertAlmostEqual(self.gap(self.solve(SCENE)) - LAYER, .1 * LAYER / 4, delta=1e-8)
        self.write_box(BOX, "open.msh", lambda x, y, z: (12 * closed(x, y, z)[0], y, z))
        run = self.attempt(SCENE, output="long")
        self.assertNotIn("Examples/Poses stretch", run.stderr)
        self.assertAlmostEqual(self.gap(run.output) - LAYER, .1 * LAYER / 4, delta=1e-8)


if __name__ == "__main__":
    unittest.main()
