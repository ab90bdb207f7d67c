# SPDX-License-Identifier: GPL-3.0-or-later
"""Regions that are found by the examples' strains: two limbs, each with weights of its own."""

import unittest

from exemplar_runner import REPOSITORY, SceneTest, greatest_distance, nodes_of, read_csv, read_summary, read_vtu, results


def bent_ends(left, right):
    """A bar whose ends, left of x = 3 and right of x = 5, are bent up by so much."""
    return f"x; y; z + {left}*max(0, 3-x)^2 + {right}*max(0, x-5)^2"


def place_of(x, y, z, left, right):
    return x, y, z + left * max(0., 3. - x)**2 + right * max(0., x - 5.)**2


# held in the middle; three poses that bend the left end, the right one, and both the other way
BAR = {
    "Scene": "static",
    "Mesh/Generator": "box",
    "Mesh/Box size": "8, 1, 1",
    "Mesh/Box cells": "24, 3, 3",
    "Examples/Pose functions": " | ".join((bent_ends(.1, 0), bent_ends(0, .1), bent_ends(-.1, -.05))),
    "Examples/Importance": "1",
    "Handles/Names": "middle, left, right",
    "Handles/middle/Select": "box 3.4 -1 -1 4.6 1 1",
    "Handles/left/Select": "boundary 1",
    "Handles/right/Select": "boundary 2",
    "Time/Increments": "4",
    "Solver/Tolerance": "1e-8",
}
LEFT_UP = {"Handles/left/Motion": "0; 0; 0.9*t"}
RIGHT_UP = {"Handles/right/Motion": "0; 0; 0.9*t"}
BOTH_UP = {**LEFT_UP, **RIGHT_UP}
AUTO = {"Examples/Regions": "auto"}
# bars with one pose, which is one region
ONE = {**BAR, "Examples/Pose functions": "1.2*x; y; z", "Handles/Names": "left, right", "Handles/middle/Select": None,
       "Handles/right/Motion": "t; 0; 0"}
DYNAMIC = {**BAR, **BOTH_UP, "Scene": "dynamic", "Time/Increments": None, "Time/Step": "0.02", "Time/End": "0.2",
           "Material/Young's modulus": "1e5", "Solver/Tolerance": "1e-5"}


def without(scene, *ends):
    """The bar with these ends free."""
    kept = {key: value for key, value in scene.items() if not any(key.startswith(f"Handles/{end}/") for end in ends)}
    return {**kept, "Handles/Names": ", ".join(name for name in ("middle", "left", "right") if name not in ends)}


class Regions(SceneTest):
    def numbers(self, output):
        """The numbers of the regions of the left end and of the right end."""
        regions = read_summary(output)["weight_regions"]
        self.assertEqual([region["region"] for region in regions], [1, 2])
        return sorted((1, 2), key=lambda number: regions[number - 1]["centre"][0])

    def weights(self, output):
        """The last weights: those of the left end, those of the right end."""
        row = read_csv(output)[-1]
        return [[row[f"weight_{region}_{i}"] for i in range(4)] for region in self.numbers(output)]

    def error(self, output, left, right, chosen=lambda x: True):
        """How far the nodes are from where formulas have them, at most."""
        rest = nodes_of(self.rest)
        found = nodes_of(output / "final.msh")
        return greatest_distance({number: place_of(*p, left, right) for number, p in rest.items() if chosen(p[0])},
                                 {number: found[number] for number, p in rest.items() if chosen(p[0])})

    def setUp(self):
        super().setUp()
        self.write_box(BAR, "rest.msh")
        self.rest = self.directory / "rest.msh"

    def test_two_limbs_take_two_poses(self):
        scene = {**BAR, **BOTH_UP}
        one = self.solve(scene, output="one")
        for energy in ("scaled", "blended", "mixed"):
            with self.subTest(energy):
                own = self.solve({**scene, **AUTO, "Examples/Energy": energy}, output=energy)
                left, right = self.weights(own)
                self.assertGreater(left[1], 0.95)
                self.assertGreater(right[2], 0.95)
                self.assertLess(self.error(own, .1, .1), 0.5 * self.error(one, .1, .1))

    def test_the_other_limb_stays_with_rest(self):
        own = self.solve(without({**BAR, **LEFT_UP, **AUTO}, "right"))
        left, right = self.weights(own)
        self.assertGreater(left[1], 0.95)
        self.assertGreater(right[0], 0.95)
        self.assertLess(self.error(own, 0, 0, lambda x: x > 5.), 0.02)

    def test_what_is_told(self):
        output = self.solve({**BAR, **BOTH_UP, **AUTO, "Output/Every": "4"})
        regions = read_summary(output)["weight_regions"]
        self.assertAlmostEqual(sum(region["volume"] for region in regions), 1., 12)
        numbers = read_vtu(output / "frame_0004.vtu")[0]["CellData", "weight_region"]
        self.assertEqual([numbers.count(number) for number in (1, 2)], [region["cells"] for region in regions])
        self.assertEqual(sum(region["cells"] for region in regions), len(numbers))
        log = (output / "log.txt").read_text()
        self.assertIn("Examples/Regions = auto found 2 regions", log)
        for region in regions:
            self.assertIn(f"region {region['region']}: {region['cells']} cells", log)
        self.assertIn("weights per region", read_summary(output)["used"])

    def test_one_region_is_the_same_as_none(self):
        one, none = self.solve({**ONE, **AUTO}, output="one"), self.solve(ONE, output="none")
        self.assertEqual(results(one)["final.msh"], results(none)["final.msh"])
        self.assertEqual(results(one)["statistics.csv"], results(none)["statistics.csv"])
        self.assertIn("Examples/Regions = auto does nothing: the examples strain the body as one region", (one / "log.txt").read_text())
        self.assertEqual(len(read_summary(one)["weight_regions"]), 1)
        self.assertNotIn("weight_regions", read_summary(none))

    def test_threads_give_the_same_bytes(self):
        for scene in ({**BAR, **BOTH_UP, **AUTO}, {**DYNAMIC, **AUTO}):
            with self.subTest(scene["Scene"]):
                found = [results(self.solve(scene, "--threads", n, output=f"{scene['Scene']}_{n}")) for n in "12"]
                self.assertEqual(found[0], found[1])

    def test_other_rules_and_laws(self):
        for keys in ({"Examples/Weights": "additive"}, {"Examples/Weights": "free"}, {"Examples/Yield": "10"}, {"Model/Element": "P2"},
                     {"Model/Background": "neo-hookean", "Examples/Energy": "blended"}, {"Model/Dilatation": "cells"},
                     {"Solver/Starts": "examples"}, {"Examples/Example modulus": "2e6", "Examples/Energy": "blended"},
                     {"Examples/Region blend length": "0.5"}, {"Mesh/Scale": "1"}):
            with self.subTest(keys):
                output = self.solve({**BAR, **BOTH_UP, **AUTO, **keys, "Examples/Importance": "0.8", "Mesh/Box cells": "12, 2, 2"}, output="other")
                rows = read_csv(output)
                left, right = self.numbers(output)
                self.assertGreater(rows[-1][f"weight_{left}_1"], rows[-1][f"weight_{right}_1"])
                self.assertGreater(rows[-1][f"weight_{right}_2"], rows[-1][f"weight_{left}_2"])

    def test_prescribed_weights_in_the_order_of_the_regions(self):
        """Those of a first run are given to a second one, which ends in the same place."""
        scene = {**BAR, **BOTH_UP, **AUTO}
        row = read_csv(self.solve(scene, output="found"))[-1]
        lists = " | ".join("; ".join(repr(row[f"weight_{region}_{i}"]) for i in range(3))
                           + "; 1" + "".join(f"-({row[f'weight_{region}_{i}']!r})" for i in range(3)) for region in (1, 2))
        given = self.solve({**scene, "Examples/Weights": "prescribed", "Examples/Prescribed weights": lists}, output="given")
        self.assertLess(greatest_distance(nodes_of(given / "final.msh"), nodes_of(self.directory / "found/final.msh")), 1e-6)

    def test_refused(self):
        (self.directory / "map.csv").write_text("vertex,paint\n1,1\n")
        for keys, words in (
                ({"Examples/Weights per region": "true"}, "Examples/Weights per region = true says it, too. Remove one of them."),
                ({"Examples/Weight maps": "map.csv"}, "Examples/Weight maps says it, too. Remove one of them."),
                ({"Examples/Regions": "automatic"}, "none, auto"),
                ({"Examples/Regions": "none", "Examples/Region blend length": "1"}, "Examples/Regions is none"),
                ({"Examples/Weights": "prescribed", "Examples/Prescribed weights": "1; 0; 0; 0 | 1; 0; 0; 0 | 1; 0; 0; 0"},
                 "has 3 lists separated by |, but there are 2 regions")):
            with self.subTest(keys):
                run = self.attempt({**BAR, **BOTH_UP, **AUTO, **keys})
                self.assertEqual(run.status, 1)
                self.assertIn(words, run.stderr)
                self.assertFalse(run.output.exists())

    def test_shells_are_refused(self):
        run = self.attempt({"Scene": "static", "Mesh/Kind": "shell", "Mesh/File": REPOSITORY / "meshes/surfaces/leaf.obj",
                            "Material/Thickness": "0.001", "Examples/Pose functions": "x; y; z+x^2", **AUTO})
        self.assertEqual(run.status, 1)
        self.assertIn("Examples/Regions = auto is not for shells yet. Set it to none", run.stderr)


if __name__ == "__main__":
    unittest.main()
