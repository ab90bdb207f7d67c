# SPDX-License-Identifier: GPL-3.0-or-later
"""Gradients of static equilibria, against differences of equilibria."""
import itertools
import unittest

import numpy as np

import exemplar

BOX = {"Scene": "static", "Mesh": {"Generator": "box", "Box size": [3, 1, 1], "Box cells": (3, 2, 2)},
       "Handles": {"left": {"Select": "box 0 -1 -1 0 2 2"}}}
SCENE = {"Scene": "static", "Time": {"Increments": 1},
         "Handles": {"left": {"Select": "box -0.3 -1 -1 0.3 2 2"}, "right": {"Select": "box 2.7 -1 -1 3.3 2 2"}},
         "Material": {"Young's modulus": 1e5, "Poisson's ratio": 0.4, "Density": 900}, "Loads": {"Gravity": [0.5, -1, -3]},
         "Examples": {"Importance": 0.7, "Weights": "simplex"}, "Solver": {"Tolerance": 1e-12}}
random = np.random.default_rng(5)


def bar():
    """(nodes, cells, material ids) of a bar without any symmetry."""
    box = exemplar.Problem(BOX)
    nodes, cells = box.rest_positions.copy(), box.cells.copy()
    nodes += random.uniform(-0.04, 0.04, nodes.shape)
    return nodes, cells, np.where(nodes[cells].mean(axis=1)[:, 0] < 1.4, 1, 2)


MESH = bar()
NODES, CELLS, _ = MESH
X, Y, Z = NODES.T
POSES = [np.stack([X, Y + 0.1 * X * (Z - 0.5), Z - 0.1 * X * (Y - 0.5)], axis=1),
         np.stack([X, Y, Z + 0.06 * X**2], axis=1),
         np.stack([1.15 * X, 0.95 * Y, 0.95 * Z + 0.02 * X * Y], axis=1)]
HELD = (X < 0.3) | (X > 2.7)
TARGETS = NODES + HELD[:, None] * np.where(X < 1.5, 0., 1.)[:, None] * (
    [0.25, 0.05, 0.2] + 0.12 * np.stack([0 * X, Z - 0.5, 0.5 - Y], axis=1))
BY_POSITIONS = random.normal(size=NODES.shape)


def scene(**sections):
    return {**SCENE, **{name: {**SCENE.get(name, {}), **keys} for name, keys in sections.items()}}


def solved(base, change=None, targets=TARGETS, mesh=MESH, poses=POSES):
    """The equilibrium, with held nodes at their targets and a problem that was changed before."""
    problem = exemplar.Problem(base, mesh=mesh, poses=poses)
    problem.set_motion("left", lambda rest, t: targets[X < 0.3] - rest)
    problem.set_motion("right", lambda rest, t: targets[X > 2.7] - rest)
    if change is not None:
        change(problem)
    problem.run()
    return problem


def set_poses(problem, poses):
    for i, pose in enumerate(poses):
        problem.set_pose(len(problem.weights) % 4 and i or i + 1, pose)


def set_attribute(name):
    return lambda problem, value: setattr(problem, name, value)


class Case:
    """An equilibrium, a function of it, and what both depend on."""

    def __init__(self, base):
        self.base = base
        self.problem = solved(base)
        self.by_weights = random.normal(size=len(self.problem.weights))
        self.found = self.problem.vjp(BY_POSITIONS, self.by_weights)

    def value(self, **changes):
        problem = solved(self.base, **changes)
        return (BY_POSITIONS * problem.positions).sum() + self.by_weights @ problem.weights

    def parameters(self):
        """{name: (value, function of a value)}"""
        m, n = len(CELLS), len(NODES)

        def material(name):
            return lambda value: self.value(change=lambda problem: problem.set_material(**{name: value}))

        def attribute(name):
            return lambda value: self.value(change=lambda problem: setattr(problem, name, value))
        return {"young": (np.full(m, 1e5), material("young")), "poisson": (np.full(m, 0.4), material("poisson")),
                "density": (np.full(m, 900.), material("density")), "importance": (0.7, attribute("importance")),
                "nodal_forces": (np.zeros((n, 3)), attribute("nodal_forces")), "gravity": (np.array([0.5, -1, -3]), attribute("gravity")),
                "handles": (TARGETS, lambda value: self.value(targets=value)),
                "poses": (np.array(POSES), lambda value: self.value(poses=list(value))),
                "rest_positions": (NODES, lambda value: self.value(mesh=(value, *MESH[1:])))}


SCALES = {"young": 1e5, "density": 900., "nodal_forces": 1e3}


def difference(function, at, direction, step):
    """Of fourth order."""
    values = [function(at + s * step * direction) for s in (-2, -1, 1, 2)]
    return np.dot(values, [1, -8, 8, -1]) / (12 * step)


class Differences(unittest.TestCase):
    def check(self, base):
        case = Case(base)
        for name, (at, function) in case.parameters().items():
            if name not in case.found:
                continue
            direction = SCALES.get(name, 1.) * random.uniform(0.5, 1, np.shape(at)) * random.choice([-1, 1], np.shape(at))
            expected = difference(function, at, direction, 2e-4 if name in ("rest_positions", "poses") else 5e-4)
            found = np.sum(np.array(case.found[name]) * direction)
            with self.subTest(name):
                self.assertLess(abs(found - expected), 1e-6 * abs(expected), (found, expected))
        return case

    def test_all(self):
        rules = {"simplex": {"Weights": "simplex"}, "free": {"Weights": "free"},
                 "prescribed": {"Weights": "prescribed", "Prescribed weights": "0.1; 0.2; 0.3; 0.4"},
                 "per region": {"Weights": "simplex", "Weights per region": True}}
        for dilatation, (name, rule), energy in itertools.product(["cells", "patches"], rules.items(), ["scaled", "blended"]):
            with self.subTest(f"{dilatation}, {name}, {energy}"):
                self.check(scene(Model={"Dilatation": dilatation}, Examples={**rule, "Energy": energy}))


if __name__ == "__main__":
    unittest.main()
