# SPDX-License-Identifier: GPL-3.0-or-later
"""Keys that add up: additive weights, against what they must be, and beside the other rules."""
import itertools
import unittest
import warnings

import numpy as np

import exemplar

# A bar along x from 0 to 4, of which all nodes but one within its left half are held where a test wants them.
BAR = {"Scene": "static", "Mesh": {"Generator": "box", "Box size": [4, 1, 1], "Box cells": [8, 2, 2]},
       "Material": {"Young's modulus": 1e5, "Poisson's ratio": 0.3}, "Time": {"Increments": 1},
       "Model": {"Dilatation": "cells"}, "Handles": {"left": {"Select": "box 0 -1 -1 0 1 1"}}}
LEFT, RIGHT = [["x<2 ? 1.2*x : x+0.4", "y", "z"], ["x<2 ? x : 2+1.3*(x-2)", "y", "z"]]  # longer by 20 and 30 %


def stretched(nodes, left, right):
    x = nodes[:, 0]
    places = nodes.copy()
    places[:, 0] += left * np.minimum(x, 2) + right * np.maximum(x - 2, 0)
    return places


def drag_all(problem, motion):
    nodes = problem.rest_positions
    problem.grab("all", np.flatnonzero((nodes[:, 0] > 0) & ((nodes - [1, 0, 0])**2).sum(axis=1).astype(bool)), motion)


def held_at(scene, *stretches):
    """The problem with the nodes where parts of the two stretches put them."""
    problem = exemplar.Problem(scene)
    drag_all(problem, lambda rest, t: t * (stretched(rest, *stretches) - rest))
    problem.run()
    return problem


def keys(**examples):
    return {**BAR, "Examples": {"Pose functions": [LEFT, RIGHT], "Weights": "additive", "Importance": 1, "Energy": "scaled", **examples}}


class ClosedForms(unittest.TestCase):
    def test_parts_of_both_keys(self):
        """Strains on different cells: each weight is the part of its key, between 0 and 1."""
        for energy, (left, right) in itertools.product(["scaled", "blended", "mixed"], [(1, 1), (0.25, 0.75), (1.5, -0.5), (0, 1)]):
            with self.subTest(energy=energy, left=left, right=right):
                found = held_at(keys(Energy=energy), 0.2 * left, 0.3 * right).weights
                np.testing.assert_allclose(found, np.clip([left, right], 0, 1), atol=1e-7)

    def test_importance(self):
        """The scaled energy holds the products of importance and weights, the blended one their parts, the mixed one what lies
        between."""
        eta, part = 0.8, 0.5
        for energy, weight in (("scaled", part / eta), ("blended", part), ("mixed", part / (eta + 0.2 * (1 - eta)))):
            found = held_at(keys(Energy=energy, Importance=eta), 0.2 * part, 0.3 * part).weights
            np.testing.assert_allclose(found, [weight, weight], atol=1e-7, err_msg=energy)

    def test_elasticity_of_the_keys_own(self):
        found = held_at(keys(Energy="blended", Importance=0.5, **{"Example modulus": 3e5, "Example Poisson ratio": 0.1}), 0.1, 0.3)
        np.testing.assert_allclose(found.weights, [0.5, 1], atol=1e-7)

    def test_regions(self):
        """In each half of the bar the key of the other half has no strain, and its weight stays 0."""
        problem = exemplar.Problem(BAR)
        nodes, cells = problem.rest_positions.copy(), problem.cells.copy()
        halves = np.where(nodes[cells].mean(axis=1)[:, 0] < 2, 1, 2)
        poses = [stretched(nodes, 0.2, 0.3), stretched(nodes, 0.2, 0)]
        scene = keys(**{"Weights per region": True})
        del scene["Mesh"], scene["Examples"]["Pose functions"]
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            problem = exemplar.Problem(scene, mesh=(nodes, cells, halves), poses=poses)
        # the second key is two thirds of the first where it acts; that it does nothing in region 2 is no mistake
        self.assertEqual([str(one.message).split(" (")[0] for one in said], ["Examples 1"])
        self.assertIn("a combination of their strains", str(said[0].message))
        drag_all(problem, lambda rest, t: t * (stretched(rest, 0.06, 0.27) - rest))
        problem.run()
        w = problem.weights.reshape(2, 2)
        self.assertAlmostEqual(w[0].sum(), 0.3, places=6)
        np.testing.assert_allclose(w[1], [0.9, 0], atol=1e-6)
        self.assertEqual([name for name in problem.statistics if name.startswith("weight")], ["weight_1_1", "weight_1_2", "weight_2_1", "weight_2_2"])

    def test_yield(self):
        """A weight follows until the force on it is the yield's: by the distance Y/H; and stays when it is let go."""
        part, density = 0.5, 50.
        free = held_at(keys(), 0.2 * part, 0.3 * part)
        held = held_at(keys(Yield=density), 0.2 * part, 0.3 * part)
        lag = density * 4 / np.diag(free.weight_hessian()) # the volume is 4 m^3
        np.testing.assert_allclose(held.weights, free.weights - lag, atol=1e-9)
        problem = exemplar.Problem({**keys(Yield=density), "Time": {"Increments": 4}})
        drag_all(problem, lambda rest, t: min(1, 2 - 2 * t) * (stretched(rest, 0.2, 0.3) - rest))
        problem.goto(0.5)
        np.testing.assert_allclose(problem.weights, 1 - lag, atol=1e-9)
        problem.goto(1.)
        np.testing.assert_allclose(problem.weights, lag, atol=1e-9)


class Doors(unittest.TestCase):
    def test_without_a_weight_of_the_rest_pose(self):
        problem = held_at(keys(), 0.2, 0.3)
        self.assertEqual(len(problem.weights), len(problem.example_names))
        self.assertEqual([name for name in problem.statistics if "weight" in name or "multiplier" in name], ["weight_1", "weight_2"])
        self.assertIn("kkt_residual", problem.statistics)
        self.assertEqual([warning for warning in problem.warnings if "rest pose" in warning], [])
        with self.assertWarnsRegex(UserWarning, "Include rest pose = false does nothing with additive weights"):
            exemplar.Problem(keys(**{"Include rest pose": False}))

    def test_states(self):
        problem = held_at(keys(), 0.2, 0.3)
        problem.state = problem.state.replace(weights=[0.75, 1])
        np.testing.assert_array_equal(problem.weights, [0.75, 1])
        for wrong in ([-0.1, 0.5], [0.5, 1.1]):
            with self.assertRaisesRegex(exemplar.UserError, "additive all are between 0 and 1"):
                problem.state = problem.state.replace(weights=wrong)

    def test_evaluations(self):
        problem = held_at(keys(), 0.1, 0.3)
        gradient = problem.weight_gradient()
        difference = [(problem.energy(weights=problem.weights + step) - problem.energy(weights=problem.weights - step)) / 2e-4
                      for step in 1e-4 * np.eye(2)]
        np.testing.assert_allclose(gradient, difference, atol=1e-4)
        self.assertLess(abs(gradient[0]), 1e-6)

    def test_poses_are_set(self):
        problem = held_at(keys(), 0.2, 0.3)
        problem.set_pose(0, stretched(problem.rest_positions, 0.4, 0))
        problem.step()
        np.testing.assert_allclose(problem.weights, [0.5, 1], atol=1e-6)

    def test_refused(self):
        for changes, words in (({"Scene": "interpolation"}, "interpolation follows prescribed weights"),
                               ({"Solver": {"Linear solver": "umfpack", "Method": "fixed point"}}, "without bounds"),
                               ({"Examples": {"Prescribed weights": "t; t"}}, "Prescribed weights is given")):
            scene = keys(**changes.pop("Examples", {}))
            with self.subTest(words), self.assertRaisesRegex(exemplar.UserError, words):
                exemplar.Problem({**scene, **changes})


def slopes_fit(problem):
    """Whether the slopes by the weights, over the greatest second derivative, are those of a least energy within the bounds."""
    slopes = problem.weight_gradient() / np.abs(np.diag(problem.weight_hessian())).max()
    w = problem.weights
    return (all(0 <= w) and all(w <= 1) and all(slopes[w == 0] > -1e-5) and all(slopes[w == 1] < 1e-5)
            and all(abs(slopes[(w > 0) & (w < 1)]) < 1e-5))


class Neighbours(unittest.TestCase):
    def test_laws_elements_and_terms(self):
        """Whatever the cells are and whatever else acts, weights are the best between their bounds."""
        handles = {"left": {"Select": "box 0 -1 -1 0 1 1"}, "right": {"Select": "box 4 -1 -1 4 1 1", "Motion": "0.8*t; 0; 0.1*t"}}
        grain = {"Fibre direction": "1; 0.2; 0"}
        kinds = {"fibres": {"Material": {**grain, "Fibre stiffness": 1e5}},
                 "orthotropy": {"Material": {**grain, "Cross direction": "0; 1; 0", "Orthotropy": "1e5, 5e4, 5e4, .2, .2, .2, 3e4, 3e4, 3e4"}},
                 "yields": {"Material": {"Yield stress": 2e3}, "Examples": {"Energy": "blended"}},
                 "relaxes": {"Material": {"Relaxation time": 1, "Relaxing share": 0.5}, "Examples": {"Energy": "blended"}},
                 "neo-Hookean": {"Model": {"Background": "neo-hookean"}, "Examples": {"Energy": "blended"}},
                 "Green": {"Model": {"Strain": "green"}}, "linear": {"Model": {"Strain": "linear"}}, "P2": {"Model": {"Element": "P2"}},
                 "patches": {"Model": {"Dilatation": "patches"}}, "shape": {"Examples": {"Acts on": "shape"}},
                 "iterative": {"Solver": {"Linear solver": "iterative"}}, "cholmod": {"Solver": {"Linear solver": "cholmod"}},
                 "obstacle": {"Obstacles": {"Names": "floor", "floor": {"Shape": "plane 0 0 -0.55 0 0 1"}}},
                 "balanced": {"Loads": {"Gravity": [0, 0, -1], "Balanced": True}}}
        seen = set()
        for name, changes in kinds.items():
            for kind in "static", "dynamic":
                if (name, kind) == ("relaxes", "static"):
                    continue
                thick = ["x", "1.2*y", "z"]
                scene = {**keys(Importance=0.7, Energy="mixed", **{"Pose functions": [LEFT, RIGHT, thick]}), "Scene": kind, "Handles": handles,
                         "Time": {"Increments": 3} if kind == "static" else {"Step": 0.1, "End": 1, "Mass damping": 1}}
                for section, more in changes.items():
                    scene[section] = {**scene.get(section, {}), **more}
                with self.subTest(name, kind=kind):
                    problem = exemplar.Problem(scene)
                    problem.run()
                    self.assertTrue(slopes_fit(problem), (problem.weights, problem.weight_gradient()))
                    seen.update(np.sign(problem.weights) + (problem.weights == 1))
        self.assertEqual(seen, {0, 1, 2})


class Methods(unittest.TestCase):
    def test_all_end_in_the_same_place(self):
        """By Newton's method and by passes; by quasi-Newton's method a body that has come to rest."""
        handles = {"left": {"Select": "box 0 -1 -1 0 1 1"}, "right": {"Select": "box 4 -1 -1 4 1 1", "Motion": "0.6*min(1,t); 0; 0"}}
        scene = {**keys(Importance=0.8, Energy="blended"), "Handles": handles}
        newton = exemplar.Problem({**scene, "Solver": {"Tolerance": 1e-10}})
        newton.run()
        self.assertGreater(newton.weights.max(), 0.1)
        passes = exemplar.Problem({**scene, "Model": {"Gradient": "frozen"}, "Solver": {"Method": "fixed point", "Tolerance": 1e-8}})
        passes.run()
        np.testing.assert_allclose(passes.weights, newton.weights, atol=1e-2)  # frozen forces balance elsewhere
        dynamic = {**scene, "Scene": "dynamic", "Time": {"Step": 0.1, "End": 20, "Mass damping": 2}, "Solver": {"Tolerance": 1e-10}}
        moving = exemplar.Problem(dynamic)
        moving.run()
        np.testing.assert_allclose(moving.weights, newton.weights, atol=1e-4)
        iterative = exemplar.Problem({**scene, "Solver": {"Tolerance": 1e-10, "Linear solver": "cholmod"}})
        iterative.run()
        np.testing.assert_allclose(iterative.weights, newton.weights, atol=1e-7)


def horned_head():
    """Nodes and tetrahedra of a head, 4 x 2 x 2 m, with two ears, 1 x 1 x 3 m, upon its ends."""
    size, index, cells = 0.5, {}, []
    for cube in itertools.product(range(8), range(4), range(10)):
        is_of_ear = (cube[0] < 2 or cube[0] > 5) and 1 <= cube[1] <= 2
        for order in itertools.permutations(range(3)) if cube[2] < 4 or is_of_ear else ():
            corners = [cube]
            for axis in order:
                corners.append(tuple(c + (a == axis) for a, c in enumerate(corners[-1])))
            cells.append([index.setdefault(corner, len(index)) for corner in corners])
    nodes, cells = size * np.array(list(index), dtype=float), np.array(cells)
    edges = nodes[cells[:, 1:]] - nodes[cells[:, :1]]
    cells[np.linalg.det(edges) < 0, 2:] = cells[np.linalg.det(edges) < 0, :1:-1]
    return nodes, cells


NODES, CELLS = horned_head()


def with_bent_ear(is_left, angle=0.5):
    """The head with an ear bent to an arc along y, whose middle keeps its length."""
    places = NODES.copy()
    ear = (NODES[:, 2] > 2) & ((NODES[:, 0] < 2) == is_left)
    s, curvature = NODES[ear, 2] - 2, angle / 3
    radius = 1 / curvature - (NODES[ear, 1] - 1)
    places[ear, 1] = 1 + 1 / curvature - radius * np.cos(curvature * s)
    places[ear, 2] = 2 + radius * np.sin(curvature * s)
    return places


EARS = [with_bent_ear(True), with_bent_ear(False)]
BOTH = EARS[0] + EARS[1] - NODES


def dragged(rule, **examples):
    """(weights, error) of the head whose ears are dragged by a line across their ends to where both keys put it; the error is the greatest
    distance of a vertex to its place in both keys over the diagonal of the head."""
    scene = {"Scene": "static", "Material": {"Young's modulus": 1e5, "Poisson's ratio": 0.3},
             "Examples": {"Weights": rule, "Importance": 0.95, **examples},
             "Handles": {"neck": {"Select": "box 0 0 0 4 2 0"}}}
    problem = exemplar.Problem(scene, mesh=(NODES, CELLS), poses=EARS)
    for name, is_left in ("left", True), ("right", False):
        end = np.flatnonzero((NODES[:, 2] == 5) & (NODES[:, 1] == 1) & ((NODES[:, 0] < 2) == is_left))
        way = (BOTH - NODES)[end].mean(axis=0)
        problem.grab(name, end, lambda rest, t, way=way: t * way + 0 * rest)
    problem.run()
    error = np.linalg.norm(problem.positions - BOTH, axis=1).max() / np.linalg.norm(np.ptp(NODES, axis=0))
    return problem.weights, error


class Ears(unittest.TestCase):
    def test_both_ears_at_once(self):
        """What the simplex shares, additive keys have both of."""
        weights, error = dragged("additive")
        self.assertGreater(weights.min(), 0.97)
        self.assertLess(error, 0.012)
        shared, missed = dragged("simplex")
        self.assertAlmostEqual(shared[1:].sum(), 1, places=6)
        self.assertGreater(missed, 1.3 * error)

    def test_solver_starts(self):
        problem = exemplar.Problem({"Scene": "static", "Material": {"Young's modulus": 1e5}, "Handles": {"neck": {"Select": "box 0 0 0 4 2 0"}},
                                    "Examples": {"Weights": "additive"}, "Solver": {"Starts": "examples"}},
                                   mesh=(NODES, CELLS), poses=EARS)
        problem.run()
        np.testing.assert_allclose(problem.weights, [0, 0], atol=1e-6)


if __name__ == "__main__":
    unittest.main()
