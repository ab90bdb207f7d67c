# SPDX-License-Identifier: GPL-3.0-or-later
"""Gradients of shells, against central differences."""

import itertools
import sys
import unittest
from pathlib import Path

import exemplar
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scenes"))
from shell_meshes import rolled_vertices, strip  # noqa: E402

random = np.random.default_rng(5)
vertices, triangles = strip(1., .4, 5, 2)
NODES = np.array(vertices) + .01 * random.normal(size=(len(vertices), 3))
CELLS = np.array(triangles)
POSES = [np.array(rolled_vertices(1., .4, 5, 2, 1.)) + .01 * random.normal(size=NODES.shape), NODES * [1, 1.1, 1] + .2 * NODES[:, :1] ** 2 * [0, 0, 1]]
EDGES = np.array(sorted({tuple(sorted(pair)) for cell in CELLS for pair in itertools.combinations(cell, 2)}))
# thickness in one region of a mesh of arrays is a key of its own in a .prm; here it is that of all triangles
STATIC = {"Scene": "static", "Time": {"Increments": 1}, "Mesh": {"Kind": "shell"},
          "Material": {"Thickness": .03, "Young's modulus": 1e5, "Poisson's ratio": .3, "Density": 300},
          "Handles": {"left": {"Select": "box -1 -1 -1 0.1 2 1"}, "right": {"Select": "box 0.9 -1 -1 2 2 1", "Slopes": "free"}},
          "Loads": {"Gravity": [.2, -.3, -2]}, "Examples": {"Importance": .8, "Weights": "additive", "Weight penalty": 0.5, "Bending importance": .9},
          "Solver": {"Tolerance": 1e-12, "Maximum iterations": 200}}
DYNAMIC = {**STATIC, "Scene": "dynamic", "Examples": {**STATIC["Examples"], "Weights": "free"}, "Time": {"Step": .02, "End": .3, "Mass damping": .3, "Stiffness damping": .01},
           "Solver": {"Tolerance": 1e-12, "Method": "newton"}}
STEPS = 5
BY_POSITIONS = random.normal(size=(STEPS, *NODES.shape))
BY_WEIGHTS = random.normal(size=(STEPS, 3))


def with_tips(pose):
    """Behind its vertices, tips that are no wrong ones for a sheet that is nearly a graph of its rest shape."""
    normals = np.zeros(pose.shape)
    for a, b, c in CELLS:
        normals[[a, b, c]] += np.cross(pose[b] - pose[a], pose[c] - pose[a])
    ends = pose[EDGES]
    normal = normals[EDGES].sum(1)
    along = ends[:, 1] - ends[:, 0]
    length = np.linalg.norm(along, axis=1, keepdims=True)
    normal -= along * (normal * along).sum(1, keepdims=True) / length**2
    return np.vstack([pose, ends.mean(1) + length * normal / np.linalg.norm(normal, axis=1, keepdims=True)])


class GradientsOfShells(unittest.TestCase):
    def recorded(self, base, young=None, poisson=None, density=None, thickness=None, poses=(), shift=0., **attributes):
        base = {**base, "Material": {**base["Material"], **({} if thickness is None else {"Thickness": thickness})}}
        problem = exemplar.Problem(base, mesh=(NODES, CELLS), poses=POSES)
        constants = {"young": young, "poisson": poisson, "density": density}
        problem.set_material(**{name: value for name, value in constants.items() if value is not None})
        for i, pose in enumerate(poses):
            problem.set_pose(i + len(problem.weights) - len(poses), pose)
        for name, way in ("left", 0.), ("right", np.array([-.1, .02, .05])):
            problem.set_motion(name, lambda rest, t, way=way: way * np.sin(3 * t) + shift + 0 * rest)
        for name, value in attributes.items():
            setattr(problem, name, value)
        with problem.record() as trajectory:
            for _ in range(STEPS if base["Scene"] == "dynamic" else 1):
                problem.step()
        return problem, trajectory

    def hold_to_differences(self, base, keys):
        start = {"young": 1e5 * random.uniform(.8, 1.2, len(CELLS)), "poisson": random.uniform(.2, .4, len(CELLS)),
                 "density": 300 * random.uniform(.8, 1.2, len(CELLS)), "gravity": np.array([.2, -.3, -2.]), "shift": np.zeros(3),
                 "importance": np.array(.8), "thickness": np.array(.03)}
        is_plate = base.get("Model", {}).get("Shell") != "hinges"
        start["poses"] = np.array([with_tips(pose) if is_plate else pose for pose in POSES])
        if base["Scene"] == "dynamic":
            start |= {"mass_damping": np.array(.3), "stiffness_damping": np.array(.01)}
        problem, trajectory = self.recorded(base, **start)
        n = len(trajectory)
        found = trajectory.vjp(list(BY_POSITIONS[:n]), list(BY_WEIGHTS[:n, :len(problem.weights)]))
        self.assertNotIn("rest_positions", found)
        if base["Scene"] == "static":
            single = problem.vjp(BY_POSITIONS[0], BY_WEIGHTS[0, :len(problem.weights)])
            np.testing.assert_allclose(single["thickness"], found["thickness"], rtol=1e-9)
        self.assertFalse(found["weakly_active"])
        self.assertGreater(np.abs(problem.weights).min(), 1e-3)  # so that none is at its bound
        found |= {"shift": found["handles"].sum(0), "thickness": found["thickness"].sum(), "poses": np.array(found["poses"])}

        def value(**changed):
            steps = self.recorded(base, **{**start, **changed})[1]
            return (BY_POSITIONS[:n] * steps.positions).sum() + (BY_WEIGHTS[:n, :len(problem.weights)] * steps.weights).sum()
        for key in keys:
            at = np.array(start[key])
            size = .2 * np.abs(at).mean() or .01
            direction = size * random.normal(size=at.shape)

            def quotient(h):
                return (value(**{key: at + h * direction}) - value(**{key: at - h * direction})) / (2 * h)
            h = 1e-3
            expected = (4 * quotient(h / 2) - quotient(h)) / 3
            with self.subTest(key):
                self.assertLess(abs((found[key] * direction).sum() / expected - 1), 1e-6, (key, (found[key] * direction).sum(), expected))

    keys = ("young", "poisson", "density", "thickness", "poses", "importance", "gravity", "shift")

    def test_statics(self):
        self.hold_to_differences(STATIC, self.keys)

    def test_blended(self):
        self.hold_to_differences({**STATIC, "Examples": {**STATIC["Examples"], "Energy": "blended"}}, self.keys)

    def test_hinges(self):
        base = {**STATIC, "Model": {"Shell": "hinges"}, "Examples": {"Importance": .8, "Weights": "additive", "Weight penalty": 0.5}}
        self.hold_to_differences(base, ("young", "thickness", "poses", "gravity", "shift"))

    def test_steps(self):
        self.hold_to_differences(DYNAMIC, (*self.keys, "mass_damping", "stiffness_damping"))

    def test_correction(self):
        loose = {**STATIC, "Solver": {**STATIC["Solver"], "Tolerance": 1e-2}}
        found = [self.recorded(base)[0] for base in (STATIC, loose)]
        exact, value = ((BY_POSITIONS[0] * problem.positions).sum() for problem in found)
        self.assertGreater(abs(value - exact), 1e-9)
        self.assertLess(abs(value + found[1].correction(BY_POSITIONS[0]) - exact), .1 * abs(value - exact))

    def test_poses_whose_slopes_follow_the_material(self):
        """Poses without tips have slopes of least bending energy; a new scene and set_material() have the same ones."""
        base = {**STATIC, "Examples": {**STATIC["Examples"], "Weights": "prescribed", "Prescribed weights": "0.3; 0.5; 0.2"}}

        def value(by_setter, **constants):
            material = {"Young's modulus": constants.get("young", 1e5), "Poisson's ratio": constants.get("poisson", .3), "Thickness": constants.get("thickness", .03)}
            scene = base if by_setter else {**base, "Material": {**base["Material"], **material}}
            problem = exemplar.Problem(scene, mesh=(NODES, CELLS), poses=POSES)
            if by_setter:
                problem.set_material(**constants)
            problem.step()
            return (BY_POSITIONS[0] * problem.positions).sum(), problem
        gradients = value(False)[1].vjp(BY_POSITIONS[0], np.zeros(3))
        for key, at, setters in (("poisson", .3, (True, False)), ("thickness", .03, (False,))):
            for by_setter in setters:
                h = 1e-4 * at
                quotient = (value(by_setter, **{key: at + h})[0] - value(by_setter, **{key: at - h})[0]) / (2 * h)
                with self.subTest(key, by_setter=by_setter):
                    self.assertLess(abs(gradients[key].sum() / quotient - 1), 1e-6, (gradients[key].sum(), quotient))
        pattern = np.random.default_rng(7).uniform(-1., 1., len(CELLS))
        for key, at in ("young", 1e5), ("poisson", .3):
            h = 1e-4 * at
            quotient = (value(True, **{key: at + h * pattern})[0] - value(True, **{key: at - h * pattern})[0]) / (2 * h)
            with self.subTest(key + " of triangles"):
                self.assertLess(abs((gradients[key] * pattern).sum() / quotient - 1), 1e-6, ((gradients[key] * pattern).sum(), quotient))

    def test_motions_of_planes_of_symmetry(self):
        """In a plane across y, and along a border of which y and z are held, tips follow their edges in the other components."""
        nodes = np.array(vertices) + .05 * np.array(vertices)[:, :1] ** 2 * [0, 0, 1]
        for components in "y", "y, z":
            base = {**DYNAMIC, "Handles": {"left": STATIC["Handles"]["left"], "plane": {"Select": "box 0.1 -1 -1 2 -0.199 1", "Components": components, "Slopes": "held"}}}
            base.pop("Examples")
            shape = []

            def record(change):
                problem = exemplar.Problem(base, mesh=(nodes, CELLS))

                def motion(rest, t):
                    shape[:] = rest.shape
                    return np.sin(3 * t) * np.array([.1, .05, -.1]) + .3 * t * np.cross([1., 0., 0.], rest) + (0. if change is None else change)
                problem.set_motion("plane", motion)
                with problem.record() as trajectory:
                    for _ in range(STEPS):
                        problem.step()
                return trajectory
            trajectory = record(None)
            found = trajectory.vjp(list(BY_POSITIONS))["handles"]
            n, on_plane = len(nodes), np.flatnonzero((nodes[:, 1] < -.199) & (nodes[:, 0] > .1))
            edges = [n + k for k, (a, b) in enumerate(EDGES) if a in on_plane and b in on_plane]
            rows = np.array([*on_plane, *edges])
            self.assertEqual(len(rows), shape[0])
            direction = np.random.default_rng(6).normal(size=(len(rows), 3))
            h = 1e-5
            quotient = sum((np.array(BY_POSITIONS) * (np.array(record(h * direction).positions) - np.array(record(-h * direction).positions))).ravel()) / (2 * h)
            with self.subTest(components):
                self.assertLess(abs((found[rows] * direction).sum() / quotient - 1), 5e-5, ((found[rows] * direction).sum(), quotient))

    def test_what_is_refused(self):
        ball = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, -1, -1]], float), np.array([[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]])
        base = {**STATIC, "Material": {**STATIC["Material"], "Volume stiffness": 1e3},
                "Handles": {"left": {"Select": "box -0.5 -0.5 -0.5 2 2 2"}}}
        base.pop("Examples")
        problem = exemplar.Problem(base, mesh=ball)
        with self.assertRaisesRegex(exemplar.UserError, "Volume stiffness"):
            with problem.record():
                problem.step()


if __name__ == "__main__":
    unittest.main()
