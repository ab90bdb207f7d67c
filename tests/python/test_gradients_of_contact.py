# SPDX-License-Identifier: GPL-3.0-or-later
"""Gradients of bodies that meet obstacles, against differences of equilibria and of steps."""
import pathlib
import tempfile
import unittest

import numpy as np

import exemplar

from test_gradients import bar, edges_of, with_middles

random = np.random.default_rng(23)
NODES, CELLS, IDS = bar((4, 2, 2), random)
ALL = with_middles(NODES, edges_of(CELLS))
MATERIAL = {"young": 1e5 * random.uniform(0.7, 1.3, len(CELLS)), "poisson": random.uniform(0.3, 0.4, len(CELLS)),
            "density": 900 * random.uniform(0.7, 1.3, len(CELLS))}
LOWEST = NODES[:, 2].min()
STATIC = {"Scene": "static", "Time": {"Increments": 2}, "Material": {"Young's modulus": 1e5},
          "Handles": {"left": {"Select": "box -0.3 -1 -1 0.3 2 2", "Motion": "0; 0; -0.1*t"}},
          "Solver": {"Tolerance": 1e-13, "Method": "newton", "Maximum iterations": 200}}
DYNAMIC = {**STATIC, "Scene": "dynamic", "Time": {"Step": 0.02, "End": 0.1}, "Handles": {}, "Initial": {"Velocity": "0.6; 0.1; -1.5"}}
FRICTION = {"Friction": 0.4}
# below the bar, with a way that it goes: {name of a shape: numbers to keys}
SHAPES = {"plane": lambda p, r: f"plane {p} -0.05 0.1 1", "sphere": lambda p, r: f"sphere {p} {r}",
          "capsule": lambda p, r: f"capsule {p} {ends(p, (-1.1, 0.7, 0.03))} {r}"}
PLACES = {"plane": (1.5, 0., LOWEST - 0.2), "sphere": (2.1, 0.04, LOWEST - 0.87), "capsule": (2.4, -0.3, LOWEST - 0.47)}
RADII = {"sphere": 0.8, "capsule": 0.4}


def ends(place, way):
    return numbers(np.array(place.split(), float) + way)


def numbers(row):
    return " ".join(repr(float(x)) for x in row)


def scene(base, **sections):
    return {**base, **{name: {**base.get(name, {}), **keys} for name, keys in sections.items()}}


class Case:
    """A bar and an obstacle, a function of all states, and what they depend on."""

    def __init__(self, base, shape, n_steps=5, distance=0.08, keys=None, **values):
        self.base, self.shape, self.n_steps, self.distance, self.keys = base, shape, n_steps, distance, keys or {}
        self.is_dynamic = base["Scene"] == "dynamic"
        n = len(ALL) if base.get("Model", {}).get("Element") == "P2" else len(NODES)
        self.values = {**MATERIAL, "rest_positions": NODES, "displacement": np.zeros(3), "radius": np.array(RADII.get(shape, 0.)),
                       "friction": np.array(self.keys.get("Friction", 0.)), "gravity": np.array([0.2, 0.1, -0.5]),
                       "handles": np.zeros(3), "initial_positions": np.zeros((n, 3)), "initial_velocities": np.zeros((n, 3)), **values}
        self.problem, self.trajectory = self.made()
        k = len(self.trajectory)
        self.by_positions, self.by_velocities = random.normal(size=(2, k, *NODES.shape))
        self.found = self.trajectory.vjp(list(self.by_positions), None, list(self.by_velocities) if self.is_dynamic else None)

    def made(self, **changes):
        v = {**self.values, **changes}
        place = np.array(PLACES.get(self.shape, (0, 0, 0))) + v["displacement"]
        shape = SHAPES[self.shape](numbers(place), repr(float(v["radius"]))) if self.shape in SHAPES else self.shape
        of_obstacle = {"Shape": shape, **self.keys}
        if v["friction"] > 0:
            of_obstacle["Friction"] = float(v["friction"])
        rubs = {"Lag tolerance": 1e-10, "Slip speed": 0.05} if v["friction"] > 0 else {}
        base = scene(self.base, Obstacles={"Distance": self.distance, "it": of_obstacle, **rubs})
        problem = exemplar.Problem(base, mesh=(v["rest_positions"], CELLS, IDS))
        problem.set_material(**{name: v[name] for name in MATERIAL})
        problem.gravity = v["gravity"]
        if self.is_dynamic:
            problem.state = problem.state.replace(positions=problem.state.positions + v["initial_positions"],
                                                  velocities=problem.state.velocities + v["initial_velocities"])
        else:
            problem.set_motion("left", lambda rest, t: rest * 0 + v["handles"] + [0, 0, -0.1 * t])
        with problem.record() as trajectory:
            for _ in range(self.n_steps):
                problem.step()
        return problem, trajectory

    def value(self, **changes):
        trajectory = self.made(**changes)[1]
        return (self.by_positions * trajectory.positions).sum() + ((self.by_velocities * trajectory.velocities).sum() if self.is_dynamic else 0)

    def gradient(self, name):
        """By what value() depends on."""
        of_obstacle = self.found["obstacles"]["it"]
        if name in ("displacement", "radius", "friction"):
            return of_obstacle.get(name)
        if name == "handles":
            return self.found["handles"].sum(axis=0)
        if name == "rest_positions" and name in self.found:
            # a body that begins at rest, with handles that are moved from there
            follow = self.found["handles"] + self.found.get("initial_positions", 0)
            result = self.found[name] + follow[:len(NODES)]
            for middle, ends_of in zip(follow[len(NODES):], edges_of(CELLS)):
                result[ends_of] += 0.5 * middle
            return result
        return self.found.get(name)


SIZES = {"young": 1e5, "poisson": 0.35, "density": 900, "rest_positions": 0.2, "displacement": 0.1, "radius": 0.1, "friction": 0.4,
         "gravity": 1, "handles": 0.1, "initial_positions": 0.1, "initial_velocities": 1}


def difference(function, at, direction, step):
    """Of fourth order."""
    values = [function(at + s * step * direction) for s in (-2, -1, 1, 2)]
    return np.dot(values, [1, -8, 8, -1]) / (12 * step)


class Differences(unittest.TestCase):
    def check(self, case, missing=(), names=None):
        self.assertGreater(np.abs(case.problem.contact_forces).max(), 0)
        for name, at in case.values.items():
            gradient = case.gradient(name)
            if gradient is None:
                continue
            if names and name not in names:
                continue
            self.assertNotIn(name, missing)
            direction = SIZES[name] * random.uniform(0.5, 1, at.shape) * random.choice([-1, 1], at.shape)
            found = np.sum(gradient * direction)
            errors = []
            for step in (2e-4, 5e-5, 1e-5):
                expected = difference(lambda value: case.value(**{name: value}), at, direction, step)
                errors.append(abs(found - expected) / abs(expected))
                if errors[-1] < 1e-6:
                    break
            print(name, found, errors)
            with self.subTest(name):
                self.assertLess(min(errors), 1e-6)

    def test_statics(self):
        for shape in SHAPES:
            with self.subTest(shape):
                self.check(Case(STATIC, shape, n_steps=2))

    def test_steps(self):
        for shape in SHAPES:
            with self.subTest(shape):
                print(shape)
                self.check(Case(DYNAMIC, shape))

    def test_statics_with_friction(self):
        for shape in SHAPES:
            with self.subTest(shape):
                print(shape, "friction")
                self.check(Case(STATIC, shape, n_steps=2, keys=FRICTION))

    def test_steps_with_friction(self):
        for shape in SHAPES:
            with self.subTest(shape):
                print(shape, "friction")
                self.check(Case(DYNAMIC, shape, keys=FRICTION))


if __name__ == "__main__":
    unittest.main()
