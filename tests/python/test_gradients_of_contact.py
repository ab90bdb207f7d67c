# SPDX-License-Identifier: GPL-3.0-or-later
"""Gradients of bodies that meet obstacles, against differences of equilibria and of steps."""
import pathlib
import tempfile
import unittest

import numpy as np

import exemplar

from test_gradients import bar, difference, edges_of, with_middles

random = np.random.default_rng(23)
NODES, CELLS, IDS = bar((4, 2, 2), random)
EDGES = edges_of(CELLS)
MATERIAL = {"young": 1e5 * random.uniform(0.7, 1.3, len(CELLS)), "poisson": random.uniform(0.3, 0.4, len(CELLS)),
            "density": 900 * random.uniform(0.7, 1.3, len(CELLS))}
LOW = NODES[:, 2].min()
STATIC = {"Scene": "static", "Time": {"Increments": 4}, "Handles": {"left": {"Select": "box -0.3 -1 -1 0.3 2 2"}},
          "Solver": {"Tolerance": 1e-13, "Method": "newton", "Maximum iterations": 200}}
DYNAMIC = {**STATIC, "Scene": "dynamic", "Time": {"Step": 0.02, "End": 0.1}, "Handles": {}, "Initial": {"Velocity": "0.6; 0.1; -1.5"}}
RUBS = {"Lag tolerance": 1e-10, "Slip speed": 0.05}
SIZES = {"young": 1e5, "poisson": 0.35, "density": 900, "rest_positions": 0.2, "displacement": 0.1, "radius": 0.1, "friction": 0.4,
         "gravity": 1, "handles": 0.1, "initial_positions": 0.1, "initial_velocities": 1}


def numbers(*rows):
    return " ".join(repr(float(x)) for x in np.concatenate([np.atleast_1d(row) for row in rows]))


class Shape:
    """An obstacle that a displacement and a radius change: a text of numbers, points first."""

    def __init__(self, kind, *points, more=(), radius=None):
        self.kind, self.points, self.more, self.radius = kind, points, more, radius

    def text(self, displacement, radius):
        return f"{self.kind} " + numbers(*(np.add(point, displacement) for point in self.points), self.more, [] if self.radius is None else radius)


class Surface:
    """A cap of triangles below the bar, in a file."""
    radius = None

    def text(self, displacement, _radius):
        top, rim = np.array([1.9, 0.04, LOW - 0.07]), np.array([[-0.7, -0.9, -0.5], [0.9, -0.8, -0.5], [0.8, 0.9, -0.6], [-0.8, 0.8, -0.5]])
        vertices = np.concatenate([[top], top + rim]) + displacement
        lines = [f"v {numbers(v)}\n" for v in vertices] + [f"f 1 {k + 2} {(k + 1) % 4 + 2}\n" for k in range(4)]
        path = pathlib.Path(directory.name) / "cap.obj"
        path.write_text("".join(lines))
        return f"surface {path}"


directory = tempfile.TemporaryDirectory()
SPHERE = Shape("sphere", (2.1, 0.04, LOW - 0.87), radius=0.8)
SHAPES = {"plane": Shape("plane", (1.5, 0, LOW - 0.2), more=(-0.05, 0.1, 1)), "sphere": SPHERE,
          "capsule": Shape("capsule", (2.4, -0.3, LOW - 0.47), (1.3, 0.4, LOW - 0.44), radius=0.4),
          "box": Shape("box", (1.2, -0.3, LOW - 0.9), (2.5, 1, LOW - 0.06)),
          "inside box": Shape("inside box", (-1, -1, LOW - 0.07), (5, 2, 2)), "surface": Surface()}


EDGED = "box", "surface" # beside them static steps that move handles may fail


def scene(base, **sections):
    return {**base, **{name: {**base.get(name, {}), **keys} for name, keys in sections.items()}}


class Case:
    """A bar and an obstacle, a function of all states, and what they depend on."""

    def __init__(self, base, shape, distance=0.08, friction=0., moves=True, **values):
        self.base, self.shape, self.distance = base, shape, distance
        self.is_dynamic = base["Scene"] == "dynamic"
        self.n_steps = 5 if self.is_dynamic else 4
        n = len(NODES) + len(EDGES) * (base.get("Model", {}).get("Element") == "P2")
        self.values = {**MATERIAL, "rest_positions": NODES, "displacement": np.zeros(3), "gravity": np.array([0.2, 0.1, -0.5]),
                       "initial_positions": np.zeros((n, 3)), **values}
        if shape.radius is not None:
            self.values["radius"] = np.array(shape.radius)
        if friction > 0:
            self.values["friction"] = np.array(friction)
        if self.is_dynamic:
            self.values["initial_velocities"] = np.zeros((n, 3))
        elif moves:
            self.values["handles"] = np.zeros(3)
        self.problem, self.trajectory = self.made()
        k = len(self.trajectory)
        self.by_positions, self.by_velocities = random.normal(size=(2, k, *NODES.shape))
        self.found = self.trajectory.vjp(list(self.by_positions), None, list(self.by_velocities) if self.is_dynamic else None)

    def made(self, **changes):
        v = {**self.values, **changes}
        obstacle = {**self.base.get("Obstacles", {}).get("it", {}), "Shape": self.shape.text(v["displacement"], v.get("radius"))}
        if "friction" in v:
            obstacle["Friction"] = float(v["friction"])
        base = scene(self.base, Obstacles={"Distance": self.distance, **(RUBS if "friction" in v else {}), "it": obstacle})
        problem = exemplar.Problem(base, mesh=(v["rest_positions"], CELLS, IDS))
        problem.set_material(**{name: v[name] for name in MATERIAL})
        problem.gravity = v["gravity"]
        problem.state = problem.state.replace(positions=problem.state.positions + v["initial_positions"])
        if self.is_dynamic:
            problem.state = problem.state.replace(velocities=problem.state.velocities + v["initial_velocities"])
        elif "handles" in v:
            problem.set_motion("left", lambda rest, t: rest * 0 + v["handles"] + [0, 0, -0.06 * t])
        with problem.record() as trajectory:
            for _ in range(self.n_steps):
                problem.step()
        return problem, trajectory

    def value(self, **changes):
        trajectory = self.made(**changes)[1]
        return (self.by_positions * trajectory.positions).sum() + ((self.by_velocities * trajectory.velocities).sum() if self.is_dynamic else 0)

    def gradient(self, name):
        """By what value() depends on; None: it is not known."""
        if name in ("displacement", "radius", "friction"):
            return self.found["obstacles"]["it"].get(name)
        if name == "handles":
            return self.found["handles"].sum(axis=0)
        if name == "rest_positions" and name in self.found:
            # a body that begins at rest, with handles that are moved from there
            follow = self.found["handles"] + self.found.get("initial_positions", 0)
            result = self.found[name] + follow[:len(NODES)]
            for middle, ends in zip(follow[len(NODES):], EDGES):
                result[ends] += 0.5 * middle
            return result
        return self.found.get(name)


class Differences(unittest.TestCase):
    def check(self, case, missing=(), allowed=1e-6):
        self.assertGreater(np.abs(case.problem.contact_forces).max(), 0)
        for name, at in case.values.items():
            with self.subTest(name):
                gradient = case.gradient(name)
                self.assertEqual(gradient is None, name in missing or (name == "initial_positions" and name not in case.found))
                if gradient is None:
                    continue
                direction = SIZES[name] * random.uniform(0.5, 1, at.shape) * random.choice([-1, 1], at.shape)
                if name == "initial_positions" and not case.is_dynamic: # held nodes would move
                    direction = direction * (case.problem.state.positions[:, :1] > 0.4)
                found = np.sum(gradient * direction)
                for step in 2e-4, 3e-5, 5e-6: # the first that meets no other pair or feature
                    expected = difference(lambda value, name=name: case.value(**{name: value}), at, direction, step)
                    if abs(found - expected) <= allowed * abs(expected):
                        break
                print(name, found, abs(found/expected-1))
                self.assertLessEqual(abs(found - expected), allowed * abs(expected), (found, expected))

    def test_equilibria(self):
        for name, shape in SHAPES.items():
            with self.subTest(name):
                print(name)
                self.check(Case(STATIC, shape, moves=name not in EDGED))

    def test_steps(self):
        for name, shape in SHAPES.items():
            with self.subTest(name):
                print(name)
                self.check(Case(DYNAMIC, shape))

    def test_friction_in_equilibria(self):
        for name, shape in SHAPES.items():
            with self.subTest(name):
                print(name)
                base = scene(STATIC, Loads={"Ramp": "increments"})
                self.check(Case(base, shape, friction=0.4, moves=name not in EDGED))

    def test_friction_in_steps(self):
        for name, shape in SHAPES.items():
            with self.subTest(name):
                print(name)
                self.check(Case(DYNAMIC, shape, friction=0.4))

    def test_obstacles_that_move(self):
        moving = {"it": {"Motion": "0.5*t; 0.2*t; 0.3*t", "Turn": "0.5*t; 3*t; t"}}
        for name in "sphere", "capsule", "box", "surface":
            with self.subTest(name):
                print("moving", name)
                self.check(Case(scene(DYNAMIC, Obstacles=moving), SHAPES[name], friction=0.4))

    def test_widths_of_starts(self):
        for name, shape in SHAPES.items():
            with self.subTest(name):
                print("width", name)
                self.check(Case(DYNAMIC, shape, distance=0.3))
        print("width friction", name)
        self.check(Case(DYNAMIC, SPHERE, distance=0.3, friction=0.4))

    def test_quadratic_elements_and_bdf2(self):
        for base in STATIC, DYNAMIC, scene(DYNAMIC, Time={"Scheme": "bdf2"}):
            with self.subTest(str(base)):
                print("P2")
                self.check(Case(scene(base, Model={"Element": "P2"}), SPHERE, distance=0.15, friction=0.4, moves=False))

    def test_edges_almost_parallel(self):
        along = Shape("capsule", (2.7, -0.02, LOW - 0.47), (0.4, 0., LOW - 0.48), radius=0.4)
        straight = exemplar.Problem({"Scene": "static", "Mesh": {"Generator": "box", "Box size": [3, 1, 1], "Box cells": (4, 2, 2)}, "Handles": STATIC["Handles"]}).rest_positions
        print("parallel")
        self.check(Case(DYNAMIC, along, distance=0.3, rest_positions=straight + 0.1 * (NODES - straight)))


if __name__ == "__main__":
    unittest.main()
