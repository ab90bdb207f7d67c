# SPDX-License-Identifier: GPL-3.0-or-later
"""The importance is a dial: every quarter of its range moves a body that its handles drag."""

import math
import unittest

from exemplar_runner import SceneTest, bend, nodes_of, read_csv, read_msh, write_msh
from hand_mesh import Hand, half_way

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

    def mesh_of_two_halves(self):
        """The bar, with material 2 beyond its middle."""
        box = {key: value for key, value in BAR.items() if not key.startswith(("Examples", "Handles/dragged"))}
        msh = read_msh(self.solve({**box, "Handles/Names": "left", "Time/Increments": "1"}, output="mesh") / "final.msh")
        elements = []
        for element in msh.elements:
            number, kind, n_tags, *rest = (int(word) for word in element)
            tags, nodes = rest[:n_tags], rest[n_tags:]
            if kind == 4 and sum(msh.nodes[node][0] for node in nodes) / 4 > 2:
                tags = [2] * n_tags
            elements.append([number, kind, n_tags, *tags, *nodes])
        write_msh(self.directory / "halves.msh", msh._replace(elements=elements))

    def test_a_fingertip_closes_the_hand(self):
        """Taken half of the way to its place in the fist, it brings the other fingers with it where the pose leads, and few of them where it
        guides."""
        hand = Hand()
        hand.write(self.directory)
        weights, ways = {}, {}
        for energy in "scaled", "mixed":
            run = self.attempt({**half_way(hand), "Examples/Energy": energy, "Examples/Importance": "0.8", "Output/Every": "0"}, output=energy)
            self.assertEqual(run.status, 0, run.stderr)
            weights[energy] = read_csv(run.output)[-1]["weight_1"]
            rest, end = (read_msh(file).nodes for file in (self.directory / "hand.msh", run.output / "final.msh"))
            tip, goal = (hand.fingertip(3, is_fist) for is_fist in (False, True))
            node = min(rest, key=lambda i: math.dist(rest[i], tip))
            way = [b - a for a, b in zip(tip, goal)]
            ways[energy] = sum((b - a) * c for a, b, c in zip(rest[node], end[node], way)) / sum(c * c for c in way)
        self.assertGreater(weights["scaled"], .8)
        self.assertLess(weights["mixed"], .65)
        self.assertGreater(ways["scaled"], .3)  # of the little finger, which nothing holds
        self.assertGreater(ways["scaled"], 1.5 * ways["mixed"])

    def test_of_a_half(self):
        """Stretched by m in the mean, with the stretch s as example: the halves have one stress, so that their strains are m and, more
        and less, half the difference of their importances times w s. The least energy over w gives the weight."""
        self.mesh_of_two_halves()
        bar = {"Scene": "static", "Mesh/File": "halves.msh", "Material/Poisson's ratio": "0",
               "Examples/Pose functions": "1.2*x; y; z", "Handles/Names": "left, right", "Handles/left/Components": "x",
               "Handles/left/Select": "box -0.1 -1 -1 0.1 1 1", "Handles/right/Select": "box 3.9 -1 -1 4.1 1 1",
               "Handles/right/Motion": "0.2*t; 0; 0", "Time/Increments": "1", "Output/Every": "0",
               "Examples/Weight penalty": "0", "Solver/Tolerance": "1e-11"}
        mean, stretch = 0.05, 0.2
        for dilatation in ("cells", "patches"):
            for energy, part in (("scaled", 0), ("blended", 1), ("mixed", 0.2)):
                for factor in (0, 0.5):
                    with self.subTest(f"{dilatation}, {energy}, factor {factor}"):
                        output = self.solve({**bar, "Model/Dilatation": dilatation, "Examples/Importance": "0.6",
                                             "Examples/Energy": energy, "Material/region 2/Importance factor": str(factor)},
                                            output=f"half {dilatation} {energy} {factor}")
                        etas = (0.6, 0.6 * factor)
                        of_weights = sum(eta**2 + part * eta * (1 - eta) for eta in etas) - (etas[0] - etas[1])**2 / 2
                        self.assertAlmostEqual(read_csv(output)[-1]["weight_1"], mean * sum(etas) / (stretch * of_weights),
                                               delta=1e-6)

    def test_of_examples_with_an_elasticity_of_their_own(self):
        """As above, but examples have twice the modulus: a half of the stiffness C' = (1 - eta) C + eta C_e wants D = eta C_e w s / C', and
        the weights' form has (1 - eta) / eta C' C D^2 / C_e more. The springs in a row take the mean strain with one stress."""
        self.mesh_of_two_halves()
        bar = {"Scene": "static", "Mesh/File": "halves.msh", "Material/Poisson's ratio": "0", "Material/Young's modulus": "1e5",
               "Examples/Pose functions": "1.2*x; y; z", "Handles/Names": "left, right", "Handles/left/Components": "x",
               "Handles/left/Select": "box -0.1 -1 -1 0.1 1 1", "Handles/right/Select": "box 3.9 -1 -1 4.1 1 1",
               "Handles/right/Motion": "0.2*t; 0; 0", "Time/Increments": "1", "Output/Every": "0",
               "Examples/Weight penalty": "0", "Solver/Tolerance": "1e-11", "Examples/Energy": "blended",
               "Examples/Importance": "0.6", "Material/region 2/Importance factor": "0.5"}
        mean, stretch = 0.05, 0.2
        for modulus in (2, 0.25):
            stiff = [1 - eta + eta * modulus for eta in (0.6, 0.3)]
            # least energy over w: d/dw of (1/2) K (mean - sum D / 2)^2 + excess, K the stiffness of both in a row per half
            drawn = [eta * modulus * stretch / c for eta, c in zip((0.6, 0.3), stiff)]
            row = 2 * stiff[0] * stiff[1] / (stiff[0] + stiff[1])
            excess = sum((1 - eta) / eta * c * d * d / modulus for eta, c, d in zip((0.6, 0.3), stiff, drawn)) / 2
            share = sum(drawn) / 2
            weight = row * mean * share / (row * share**2 + excess)
            for dilatation in ("cells", "patches"):
                for material in ({}, {"Material/Fibre stiffness": "1e-9", "Material/Fibre direction": "1; 1; 0"}):
                    with self.subTest(f"{dilatation}, modulus {modulus}, {material}"):
                        output = self.solve({**bar, **material, "Model/Dilatation": dilatation,
                                             "Examples/Example modulus": str(1e5 * modulus)},
                                            output=f"own {dilatation} {modulus} {len(material)}")
                        self.assertAlmostEqual(read_csv(output)[-1]["weight_1"], weight, delta=1e-6)

    def test_an_elasticity_of_their_own_that_is_the_bodys(self):
        """Keys that say what the material says change nothing but roundings, also where nothing is uniform."""
        bar = {**BAR, **DRAGS["all"], "Examples/Energy": "blended", "Examples/Importance": "0.4", "Material/Young's modulus": "1e5",
               "Solver/Tolerance": "1e-11"}
        own = {"Examples/Example modulus": "1e5", "Examples/Example Poisson ratio": "0.45"}
        grain = {"Material/Fibre stiffness": "1e-6", "Material/Fibre direction": "1; 0.5; z"}
        for acts_on in ("all", "shape", "volume"):
            for dilatation in ("cells", "patches"):
                for strain in ("corotational", "linear"):
                    keys = {**bar, "Model/Dilatation": dilatation, "Examples/Acts on": acts_on, "Model/Strain": strain}
                    places = [nodes_of(self.solve({**keys, **more}, output=name) / "final.msh")
                              for name, more in (("usual", {}), ("own", own))]
                    with self.subTest(f"{acts_on}, {dilatation}, {strain}"):
                        for a, b in zip(*(p.values() for p in places)):
                            for x, y in zip(a, b):
                                self.assertAlmostEqual(x, y, delta=1e-8)
        keys = {**bar, "Model/Dilatation": "cells", "Examples/Acts on": "across fibres", **grain}
        first, second = (nodes_of(self.solve({**keys, **more}, output="grain") / "final.msh") for more in ({}, own))
        for a, b in zip(first.values(), second.values()):
            for x, y in zip(a, b):
                self.assertAlmostEqual(x, y, delta=1e-7)

    def test_an_elasticity_of_their_own_is_refused_in_words(self):
        own = {**BAR, **DRAGS["all"], "Examples/Example modulus": "1e5"}
        blended = {"Examples/Energy": "blended"}
        for changes, words in (({}, "Set that, or remove Examples/Example modulus"),
                               ({**blended, "Examples/Example modulus": "-1"}, "a number greater than 0 [Pa]"),
                               ({**blended, "Examples/Example Poisson ratio": "0.5"}, "less than 0.5"),
                               ({**blended, "Material/Yield stress": "1e3"}, "with the elasticity of the material"),
                               ({**blended, "Model/Background": "neo-hookean", "Model/Dilatation": "cells"},
                                "with the elasticity of the material")):
            with self.subTest(words):
                run = self.attempt({**own, **changes})
                self.assertEqual(run.status, 1)
                self.assertIn(words, " ".join(run.stderr.split()))


if __name__ == "__main__":
    unittest.main()
