# SPDX-License-Identifier: GPL-3.0-or-later
"""The importance is a dial: every quarter of its range moves a body that its handles drag."""

import unittest

from exemplar_runner import SceneTest, bend, nodes_of

BAR = {
    "Scene": "static",
    "Mesh/Generator": "box",
    "Mesh/Box size": "4, 1, 1",
    "Mesh/Box cells": "8, 2, 2",
    "Material/Poisson's ratio": "0.45",
    "Examples/Pose functions": bend("pi/2"),
    "Handles/Names": "left, dragged",
    "Handles/left/Select": "boundary 1",
    "Handles/dragged/Components": "z",
    "Time/Increments": "2",
    "Output/Every": "0",
}
# of which a part of the example helps, and of which nothing less than all of it is asked
DRAGS = {
    "a part": {"Handles/dragged/Select": "boundary 2", "Handles/dragged/Motion": "0; 0; t"},
    "all": {"Handles/dragged/Select": "box 0.9 -1 -1  1.1 1 1", "Handles/dragged/Motion": "0; 0; 0.3*t"},
}
LEAST = 0.05


class Importance(SceneTest):
    def places(self, importance, **keys):
        """All coordinates of the bar at the end."""
        output = self.solve({**BAR, **keys, "Examples/Importance": str(importance)}, output=f"importance {importance}")
        return [x for place in nodes_of(output / "final.msh").values() for x in place]

    def quarters(self, drag, **keys):
        """What each quarter of the importance adds to the way from the plain bar to that at importance 1, of which it is a share."""
        plain, *others = (self.places(importance, **DRAGS[drag], **keys) for importance in (0, 0.25, 0.5, 0.75, 1))
        way = [b - a for a, b in zip(plain, others[-1])]
        gone = [sum((x - a) * w for x, a, w in zip(places, plain, way)) / sum(w * w for w in way) for places in others]
        return [b - a for a, b in zip([0, *gone], gone)]

    def test_each_quarter_of_its_range_acts(self):
        for drag in DRAGS:
            with self.subTest(drag):
                self.assertGreater(min(self.quarters(drag)), LEAST)

    def test_which_energies_do_not_act_over_all_of_it(self):
        """Otherwise the drags would prove nothing."""
        self.assertLess(min(self.quarters("a part", **{"Examples/Energy": "scaled"})), LEAST)
        self.assertLess(min(self.quarters("all", **{"Examples/Energy": "blended"})), LEAST)


if __name__ == "__main__":
    unittest.main()
