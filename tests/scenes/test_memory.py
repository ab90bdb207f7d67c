# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights that remember, each region's for itself."""

import unittest
from math import pi

from exemplar_runner import SceneTest, bend, nodes_of, read_csv, write_msh

# A leg of two halves, held at one end and bent by a force at the other that comes and goes.
LEG = {
    "Scene": "static",
    "Mesh/File": "leg.msh",
    "Material/Young's modulus": "1e6",
    "Material/Poisson's ratio": "0.3",
    "Examples/Pose functions": bend(f"{pi / 2}"),
    "Examples/Energy": "blended",
    "Examples/Importance": "0.8",
    "Examples/Weights per region": "true",
    "Handles/Names": "hip",
    "Handles/hip/Select": "boundary 1",
    "Loads/Names": "pull",
    "Loads/pull/Select": "boundary 2",
    "Time/Increments": "10",
    "Output/Every": "0",
}
BOX = {"Mesh/Generator": "box", "Mesh/Box size": "4, 1, 1", "Mesh/Box cells": "8, 2, 2"}


class Memory(SceneTest):
    def setUp(self):
        super().setUp()
        box = self.write_box(BOX, "box.msh")

        def half(element):
            return 1 if sum(box.nodes[node][0] for node in element[-4:]) / 4 < 2 else 2
        self.rest = box.nodes
        self.leg = box._replace(elements=[element if element[1] != 4 else (*element[:3], half(element), *element[4:])
                                          for element in box.elements])
        write_msh(self.directory / "leg.msh", self.leg)

    def weights(self, **changes):
        """Of the example in the two halves at full force and after it, and how far the end is lifted then."""
        output = self.solve({**LEG, "Loads/pull/Force": "0; 0; 17000*(1-abs(2*t-1))", **changes})
        rows, nodes = read_csv(output), nodes_of(output / "final.msh")
        end = [number for number, place in self.rest.items() if place[0] == 4]
        lifted = sum(nodes[number][2] - self.rest[number][2] for number in end) / len(end)
        return [[row["weight_1_1"], row["weight_2_1"]] for row in (rows[5], rows[-1])], lifted

    def test_a_knee_stays_bent_and_an_elbow_does_not(self):
        """The moment of a force at the end is greatest where the leg is held: only that half passes its yield force."""
        pulled, kept = self.weights(**{"Examples/Yield": "1000"})[0]
        self.assertGreater(pulled[0], 0.1)
        self.assertGreater(kept[0], 0.5 * pulled[0])
        self.assertLess(kept[1], 0.01)

    def test_without_yield_both_spring_back(self):
        (pulled, kept), lifted = self.weights()
        self.assertGreater(min(pulled), 0.01)
        self.assertLess(max(kept), 1e-6)
        self.assertLess(abs(lifted), 1e-6)


if __name__ == "__main__":
    unittest.main()
