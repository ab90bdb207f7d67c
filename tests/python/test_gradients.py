# SPDX-License-Identifier: GPL-3.0-or-later
"""Gradients of static equilibria, against differences of equilibria."""
import itertools
import unittest
import warnings

import numpy as np

import exemplar

SCENE = {"Scene": "static", "Time": {"Increments": 1},
         "Handles": {"left": {"Select": "box -0.3 -1 -1 0.3 2 2"}, "right": {"Select": "box 2.7 -1 -1 3.3 2 2"}},
         "Material": {"Young's modulus": 1e5, "Poisson's ratio": 0.4, "Density": 900}, "Loads": {"Gravity": [0.5, -1, -3]},
         "Examples": {"Importance": 0.7, "Weights": "simplex"}, "Solver": {"Tolerance": 1e-12}}
random = np.random.default_rng(5)


def held_box(box_cells):
    return {"Scene": "static", "Mesh": {"Generator": "box", "Box size": [3, 1, 1], "Box cells": box_cells},
            "Handles": {"left": {"Select": "box 0 -1 -1 0 2 2"}}}


def bar(box_cells, changes):
    """(nodes, cells, material ids) of a bar that these random changes leave without any symmetry."""
    box = exemplar.Problem(held_box(box_cells))
    nodes, cells = box.rest_positions.copy(), box.cells.copy()
    nodes += changes.uniform(-0.04, 0.04, nodes.shape)
    return nodes, cells, np.where(nodes[cells].mean(axis=1)[:, 0] < 1.4, 1, 2)


def poses_of(nodes):
    """Three examples of a bar: twisted, bent, stretched."""
    x, y, z = nodes.T
    return [np.stack([x, y + 0.1 * x * (z - 0.5), z - 0.1 * x * (y - 0.5)], axis=1),
            np.stack([x, y, z + 0.06 * x**2], axis=1),
            np.stack([1.15 * x, 0.95 * y, 0.95 * z + 0.02 * x * y], axis=1)]


MESH = bar((3, 2, 2), random)
NODES, CELLS, _ = MESH
X, Y, Z = NODES.T
POSES = poses_of(NODES)


def edges_of(cells):
    return np.unique(np.sort(cells[:, list(itertools.combinations(range(4), 2))].reshape(-1, 2), axis=1), axis=0)


EDGES = edges_of(CELLS)


def with_middles(nodes, edges=EDGES):
    """As quadratic elements have them, behind the vertices."""
    return np.concatenate([nodes, nodes[edges].mean(axis=1)])


def targets_of(nodes):
    x, y, z = nodes.T
    return nodes + (x > 2.7)[:, None] * ([0.25, 0.05, 0.2] + 0.12 * np.stack([0 * x, z - 0.5, 0.5 - y], axis=1))


def held(nodes):
    return (nodes[:, 0] < 0.3) | (nodes[:, 0] > 2.7)


HELD, TARGETS = held(NODES), targets_of(NODES)
BY_POSITIONS = random.normal(size=NODES.shape)


def scene(**sections):
    return {**SCENE, **{name: {**SCENE.get(name, {}), **keys} for name, keys in sections.items()}}


# other constants in each cell, so that a patch has cells of several
MATERIAL = {"young": 1e5 * random.uniform(0.7, 1.3, len(CELLS)), "poisson": random.uniform(0.35, 0.42, len(CELLS)),
            "density": 900 * random.uniform(0.7, 1.3, len(CELLS))}


def solved(base, targets=TARGETS, mesh=MESH, poses=POSES, material=None, state=None, **attributes):
    """The equilibrium with held nodes at their targets, and with these attributes of the problem, from rest or near
    another one's state."""
    problem = exemplar.Problem(base, mesh=mesh, poses=poses)
    constants = {**MATERIAL, **(material or {})}
    if base["Material"].get("Orthotropy"):
        constants = {"density": constants["density"]}
    problem.set_material(**constants)
    places = (NODES if len(targets) == len(NODES) else with_middles(NODES))[:, 0]
    problem.set_motion("left", lambda rest, t: targets[places < 0.3] - rest)
    problem.set_motion("right", lambda rest, t: targets[places > 2.7] - rest)
    for name, value in attributes.items():
        setattr(problem, name, value)
    if state is None:
        problem.run()
    else:
        problem.state = state
        problem.step()
    return problem


class Case:
    """An equilibrium, a function of it, and what both depend on."""

    def __init__(self, base, poses=POSES, targets_of=targets_of, is_near=False):
        self.base, self.poses, self.is_near = base, poses, False
        self.is_quadratic = base.get("Model", {}).get("Element") == "P2"
        self.targets = targets_of(with_middles(NODES) if self.is_quadratic else NODES)
        self.problem = self.solved()
        self.is_near = is_near # equilibria are differentiated, not ways to others
        self.by_weights = random.normal(size=len(self.problem.weights))
        self.found = self.problem.vjp(BY_POSITIONS, self.by_weights)

    def solved(self, **changes):
        return solved(self.base, **{"targets": self.targets, "poses": self.poses, **changes})

    def value(self, **changes):
        problem = self.solved(**changes, state=self.problem.state if self.is_near else None)
        return (BY_POSITIONS * problem.positions).sum() + self.by_weights @ problem.weights

    def direction(self, name):
        """Of a change, at random; where little moves by weight, nothing cancels in it."""
        at, size, _ = self.parameters()[name]
        direction = size * random.uniform(0.5, 1, at.shape) * random.choice([-1, 1], at.shape)
        if not self.is_near:
            return direction
        signs = np.array([np.sign(rows[:at.shape[-2]]) for rows in self.found[name]]) if name == "poses" else np.sign(self.found[name])
        return {"handles": 0.1, "density": 10, "gravity": 10}.get(name, 1) * np.abs(direction) * signs

    def derivative(self, name, direction):
        if name == "poses" and self.is_quadratic:
            return sum(np.sum(of_pose * with_middles(change)) for of_pose, change in zip(self.found[name], direction))
        return np.sum(np.array(self.found[name]) * direction)

    def parameters(self):
        """{name: (value, size of its changes, function of a value)}"""
        def material(name):
            return MATERIAL[name], MATERIAL[name].mean(), lambda value: self.value(material={name: value})

        def attribute(name, value, size):
            return np.array(value), size, lambda changed: self.value(**{name: changed})
        return {"young": material("young"), "poisson": material("poisson"), "density": material("density"),
                "importance": attribute("importance", self.problem.importance, 1), "gravity": attribute("gravity", [0.5, -1, -3], 1),
                "nodal_forces": attribute("nodal_forces", 0 * self.targets, 1e3),
                "handles": attribute("targets", self.targets, 1),
                "poses": (np.array(self.poses), 0.2, lambda value: self.value(poses=list(value))),
                "rest_positions": (NODES, 0.2, lambda value: self.value(mesh=(value, *MESH[1:])))}


def difference(function, at, direction, step=5e-4):
    """Of fourth order."""
    values = [function(at + s * step * direction) for s in (-2, -1, 1, 2)]
    return np.dot(values, [1, -8, 8, -1]) / (12 * step)


def converged_difference(function, at, direction, steps=(1.6e-3, 4e-4, 1e-4, 2.5e-5), difference=difference):
    """Of those steps between which it changes least: large ones leave a remainder, small ones rounding."""
    found = [difference(function, at, direction, step) for step in steps]
    return min(zip(found, found[1:]), key=lambda pair: abs(pair[0] - pair[1]))[1]


class GradientTest(unittest.TestCase):
    def check(self, base, **of_case):
        case = Case(base, **of_case)
        self.assertEqual(case.found["weakly_active"], [])
        self.assertFalse(np.any(case.found["handles"][~held(with_middles(NODES)[:len(case.targets)])]))
        for name, (at, _, function) in case.parameters().items():
            if name not in case.found:
                continue
            direction = case.direction(name)
            expected = (converged_difference if case.is_near else difference)(function, at, direction)
            found = case.derivative(name, direction)
            with self.subTest(name):
                self.assertLess(abs(found - expected), 1e-6 * abs(expected), (found, expected))
        return case


class Differences(GradientTest):
    def test_all_rules_of_weights(self):
        rules = {"simplex": {"Weights": "simplex"}, "free": {"Weights": "free"},
                 "prescribed": {"Weights": "prescribed", "Prescribed weights": "0.1; 0.2; 0.3; 0.4"},
                 "per region": {"Weights": "simplex", "Weights per region": True}, "additive": {"Weights": "additive"}}
        n_at_bounds = n_at_upper = 0
        for dilatation, (name, rule), energy in itertools.product(["cells", "patches"], rules.items(), ["scaled", "blended"]):
            with self.subTest(f"{dilatation}, {name}, {energy}"):
                case = self.check(scene(Model={"Dilatation": dilatation}, Examples={**rule, "Energy": energy}))
                n_at_bounds += np.count_nonzero(case.problem.weights == 0)
                n_at_upper += np.count_nonzero(case.problem.weights == 1)
        self.assertGreater(n_at_bounds, 5)
        self.assertGreater(n_at_upper, 0)

    def test_defaults_and_regions_that_blend(self):
        case = self.check(scene(Examples={"Weights per region": True, "Region blend length": 0.5}))
        self.assertNotIn("rest_positions", case.found)
        self.assertIn("rest_positions", self.check(scene()).found)

    def test_regions_that_are_found(self):
        """They stay where they were found while a pose changes."""
        ends = [["x", "y", f"z-0.05*max(0,{way})^2"] for way in ("3-x", "x-5")]
        problem = exemplar.Problem({"Scene": "static", "Mesh": {"Generator": "box", "Box size": [8, 1, 1], "Box cells": [12, 2, 2]},
                                    "Handles": {"middle": {"Select": "box 3 -1 -1 5 1 1"}}, "Loads": {"Gravity": [0, 0, -2]},
                                    "Examples": {"Pose functions": ends, "Regions": "auto", "Importance": 0.7}, "Time": {"Increments": 1},
                                    "Solver": {"Tolerance": 1e-12}})
        problem.run()
        self.assertEqual(len(problem.weights), 6)
        rest, state = problem.rest_positions, problem.state
        by_positions, by_weights = random.normal(size=rest.shape), random.normal(size=6)
        found = problem.vjp(by_positions, by_weights)
        self.assertEqual(found["weakly_active"], [])
        self.assertNotIn("rest_positions", found)

        def value(change):
            change()
            problem.state = state
            problem.step()
            return (by_positions * problem.positions).sum() + by_weights @ problem.weights

        def check(name, change, expected):
            with self.subTest(name):
                slope = (value(lambda: change(1e-6)) - value(lambda: change(-1e-6))) / 2e-6
                change(0)
                self.assertLess(abs(slope - expected), 1e-5 * abs(expected))
        pose = np.stack([rest[:, 0], rest[:, 1], rest[:, 2] - 0.05 * np.maximum(0, 3 - rest[:, 0])**2], axis=1)
        way, young = random.normal(size=pose.shape), problem.young * random.uniform(0, 1, len(problem.young))
        base = problem.young.copy()
        check("poses", lambda t: problem.set_pose(1, pose + t * way), (found["poses"][0] * way).sum())
        check("young", lambda t: problem.set_material(young=base + t * young), (found["young"] * young).sum())
        check("importance", lambda t: setattr(problem, "importance", 0.7 + t), found["importance"])

    def test_no_rest_pose_and_no_examples(self):
        self.assertEqual(len(self.check(scene(Examples={"Include rest pose": False})).found["poses"]), 3)
        problem = exemplar.Problem({**held_box((3, 2, 2)), "Loads": {"Gravity": [0, 0, -1]}, "Solver": {"Tolerance": 1e-12}})
        problem.run()
        found = problem.vjp(np.ones((problem.positions.shape)))
        self.assertNotIn("importance", found)
        self.assertEqual(found["poses"], [])

    def test_ramp(self):
        """Half the way, nodal forces have half their value."""
        base = scene(Time={"Increments": 4}, Loads={"Ramp": "increments"})
        forces = random.normal(size=NODES.shape)

        def half_way(factor):
            problem = solved(base, nodal_forces=factor * forces)
            problem.reset()
            problem.goto(0.5)
            return problem
        found = (half_way(0.).vjp(BY_POSITIONS)["nodal_forces"] * forces).sum()
        expected = difference(lambda factor: (BY_POSITIONS * half_way(factor).positions).sum(), 0., 1e3) / 1e3
        self.assertLess(abs(found - expected), 1e-6 * abs(expected))

    def test_linear_solvers(self):
        expected = solved(SCENE).vjp(BY_POSITIONS)
        for linear_solver in "cholesky", "cholmod", "iterative":
            with self.subTest(linear_solver):
                found = solved(scene(Solver={"Linear solver": linear_solver})).vjp(BY_POSITIONS)
                for name in "young", "rest_positions", "handles":
                    error = np.abs(found[name] - expected[name]).max()
                    self.assertLess(error, 1e-7 * np.abs(expected[name]).max(), name)


class Answers(unittest.TestCase):
    def test_weakly_active(self):
        """Where a weight is about to leave its bound."""
        base = scene(Examples={"Energy": "blended"})

        def at(part):
            return solved(base, targets=NODES + part * (TARGETS - NODES))
        part, other = 1., 0.3
        weight = int(np.flatnonzero((at(part).weights > 0) != (at(other).weights > 0))[0])
        is_active = at(part).weights[weight] == 0
        for _ in range(45):
            middle = 0.5 * (part + other)
            if (at(middle).weights[weight] == 0) == is_active:
                part = middle
            else:
                other = middle
        self.assertEqual(at(part).vjp(BY_POSITIONS)["weakly_active"], [weight])

    def test_weakly_active_at_1(self):
        """The bent pose is wished more and more, until its weight is 1."""
        base = scene(Examples={"Weights": "additive"})

        def at(part):
            return solved(base, targets=NODES + part * (POSES[1] - NODES) * held(NODES)[:, None])
        free, bound = 0.2, 2.
        self.assertLess(at(free).weights[1], 1)
        self.assertEqual(at(bound).weights[1], 1)
        for _ in range(45):
            middle = 0.5 * (free + bound)
            if at(middle).weights[1] == 1:
                bound = middle
            else:
                free = middle
        for part in free, bound:
            self.assertIn(1, at(part).vjp(BY_POSITIONS)["weakly_active"])

    def test_functions_of_positions_and_weights_alone(self):
        """Their gradients add up to that of the sum."""
        problem, by_weights = solved(SCENE), np.array([0.3, -1, 0.5, 0.8])
        both, *parts = (problem.vjp(*by) for by in ((BY_POSITIONS, by_weights), (BY_POSITIONS, None), (None, by_weights)))
        for key in "young", "nodal_forces", "handles", "rest_positions":
            self.assertGreater(np.abs(parts[1][key]).max(), 1e-6 * np.abs(both[key]).max())
            np.testing.assert_allclose(parts[0][key] + parts[1][key], both[key], atol=1e-7 * np.abs(both[key]).max())

    def test_problem_stays(self):
        asked, other = solved({**SCENE, "Time": {"Increments": 3}}), solved({**SCENE, "Time": {"Increments": 3}})
        positions = asked.positions.copy()
        first = asked.vjp(BY_POSITIONS)
        second = asked.vjp(BY_POSITIONS, np.zeros(4))
        np.testing.assert_array_equal(first["young"], second["young"])
        np.testing.assert_array_equal(asked.positions, positions)
        for problem in asked, other:
            problem.gravity = [0, 1, 2]
            problem.step()
        np.testing.assert_array_equal(asked.positions, other.positions)

    def refuse(self, message, base, change=None, ask=lambda problem: problem.vjp(BY_POSITIONS)):
        problem = solved(base)
        if change is not None:
            change(problem)
        with self.assertRaisesRegex(exemplar.UserError, message):
            ask(problem)

    def test_refused(self):
        self.refuse("not static", {**SCENE, "Scene": "dynamic", "Time": {"Step": 0.1, "End": 0.1}})
        self.refuse("cells that are frozen", scene(Model={"Gradient": "frozen"}, Solver={"Method": "fixed point", "Tolerance": 1e-4}))
        self.refuse("cells that are plastic.*whole way", scene(Material={"Yield stress": 1e5}, Examples={"Energy": "blended"}))
        self.refuse("weights that remember.*whole way", scene(Time={"Increments": 2}, Examples={"Yield": 10}))
        self.refuse("elasticity of their own in an orthotropic body",
                    scene(Examples={"Example modulus": 1e4, "Energy": "blended"},
                          Material={"Orthotropy": "1e5, 1e5, 1e5, 0.3, 0.3, 0.3, 1e5, 1e5, 1e5", "Fibre direction": "1; 0; 0",
                                    "Cross direction": "0; 1; 0"}))
        self.refuse("equilibrium", SCENE, lambda problem: setattr(problem, "gravity", [0, 0, 9]))
        self.refuse(r"dJ_dx.*\(79, 3\)|dJ_dx.*\(.*3\)", SCENE, ask=lambda problem: problem.vjp(np.zeros(3)))
        self.refuse(r"dJ_dw must", SCENE, ask=lambda problem: problem.vjp(BY_POSITIONS, np.zeros(7)))
        with self.assertRaisesRegex(exemplar.UserError, "equilibrium"):
            exemplar.Problem(SCENE, mesh=MESH, poses=POSES).vjp(BY_POSITIONS)
        with self.assertRaisesRegex(TypeError, "vjp is called"):
            solved(SCENE).vjp()


class WeaklyDetermined(GradientTest):
    """Two poses with nearly the same strains, between which a penalty shares a weight."""

    def test_dependent_poses(self):
        other = POSES[1] + 2e-4 * np.stack([X * Y, Y * Z, X * Z], axis=1)
        for rule, energy in (("simplex", "mixed"), ("additive", "scaled")):
            with self.subTest(rule), warnings.catch_warnings():
                warnings.simplefilter("ignore")
                base = scene(Examples={"Weights": rule, "Energy": energy})
                poses = [POSES[0], POSES[1], other]
                problem = exemplar.Problem(base, mesh=MESH, poses=poses)
                self.assertTrue([warning for warning in problem.warnings if "prefers equal weights" in warning])
                case = self.check(base, poses=poses, targets_of=lambda nodes: nodes + 0.3 * (targets_of(nodes) - nodes))
                same = case.problem.weights[-2:]
                self.assertTrue(np.all((same > 0) & (same < 1)), same)


if __name__ == "__main__":
    unittest.main()
