# SPDX-License-Identifier: GPL-3.0-or-later
"""exemplar.with_torch and exemplar.with_jax: gradients against differences, where the packages are there."""
import importlib.util
import unittest

import numpy as np

import exemplar
from exemplar import _equilibrium

BOX = {"Scene": "static", "Mesh": {"Generator": "box", "Box size": [3, 1, 1], "Box cells": [3, 1, 1]}, "Time": {"Increments": 1},
       "Material": {"Poisson's ratio": 0.4}, "Examples": {"Pose functions": [["x", "y", "z + 0.1*x^2"]], "Importance": 0.7},
       "Solver": {"Tolerance": 1e-12}, "Handles": {"left": {"Select": "boundary 1"}}}
random = np.random.default_rng(2)


def make():
    return exemplar.Problem(BOX)


N, M = len(make().positions), len(make().cells)
X, Y, Z = make().rest_positions.T
PARAMETERS = {"young": random.uniform(1e5, 1.5e5, M), "poisson": np.array(0.41), "density": np.array(900.),
              "importance": np.array(0.6), "gravity": np.array([0.5, -1, -3]), "nodal_forces": 50 * random.normal(size=(N, 3)),
              "poses": np.stack([X, Y + 0.1 * X * Z, Z - 0.03 * X**2], axis=1)[None]}
BY_POSITIONS, BY_WEIGHTS = random.normal(size=(N, 3)), random.normal(size=2)


class Wrapper:
    """Both have this test, and tell value(parameters) and gradients(parameters)."""

    def test_differences(self):
        found = self.gradients(PARAMETERS)
        for name, value in PARAMETERS.items():
            size = 1e-4 * max(np.abs(value).max(), 1e-3)
            change = size * random.choice([-1, 1], value.shape) * random.uniform(0.5, 1, value.shape)
            values = [self.value({**PARAMETERS, name: value + s * change}) for s in (-2, -1, 1, 2)]
            expected = np.dot(values, [1, -8, 8, -1]) / 12
            with self.subTest(name):
                self.assertEqual(np.shape(found[name]), value.shape)
                self.assertAlmostEqual(np.sum(found[name] * change) / expected, 1, delta=1e-6)


class Shared(unittest.TestCase):
    """What both do, which needs neither."""

    def test_refused(self):
        poses = PARAMETERS["poses"]
        for message, parameters in {"no parameter 'yuong'": {"yuong": 1.}, r"poses must .*shape \(\d+, 3\)": {"poses": poses[0]},
                                    "poses must": {"poses": np.concatenate(3 * [poses])}}.items():
            with self.subTest(message), self.assertRaisesRegex(exemplar.UserError, message):
                _equilibrium.solve(make(), parameters)
        dynamic = exemplar.Problem({**BOX, "Scene": "dynamic", "Time": {"Step": 0.1, "End": 1}})
        with self.assertRaisesRegex(exemplar.UserError, "dynamic"):
            _equilibrium.solve(dynamic, {"young": 1e5})
        self.assertEqual(dynamic.time, 0)

    def test_other_parameters_since(self):
        problem = make()
        solved = _equilibrium.solve(problem, {"young": 1e5})
        _equilibrium.solve(problem, {"gravity": [0, 0, -1]})
        with self.assertRaisesRegex(exemplar.UserError, "since this solve, by young, .*: gravity"):
            _equilibrium.pull_back(problem, solved, BY_POSITIONS, None)

    def test_shapes(self):
        problem = make()
        values = {"importance": [0.6], "gravity": PARAMETERS["gravity"], "poses": PARAMETERS["poses"]}
        found = _equilibrium.pull_back(problem, _equilibrium.solve(problem, values), BY_POSITIONS, BY_WEIGHTS)
        self.assertEqual({name: by.shape for name, by in found.items()}, {"importance": (1,), "gravity": (3,), "poses": (1, N, 3)})


@unittest.skipUnless(importlib.util.find_spec("torch"), "needs torch")
class Torch(Wrapper, unittest.TestCase):
    def equilibrium(self, parameters, problem=None):
        import torch
        from exemplar.with_torch import equilibrium
        tensors = {name: torch.tensor(value, requires_grad=True) for name, value in parameters.items()}
        return tensors, equilibrium(problem or make(), **tensors)

    def value(self, parameters):
        positions, weights = (tensor.detach().numpy() for tensor in self.equilibrium(parameters)[1])
        return (BY_POSITIONS * positions).sum() + BY_WEIGHTS @ weights

    def gradients(self, parameters):
        import torch
        tensors, (positions, weights) = self.equilibrium(parameters)
        ((torch.tensor(BY_POSITIONS) * positions).sum() + torch.tensor(BY_WEIGHTS) @ weights).backward()
        return {name: tensor.grad.numpy() for name, tensor in tensors.items()}

    def test_two_solves_of_one_problem(self):
        """Each goes back to its own equilibrium."""
        problem, losses, tensors = make(), [], []
        for factor in 1, 2:
            given, (positions, _) = self.equilibrium({"young": factor * PARAMETERS["young"], "gravity": PARAMETERS["gravity"]}, problem)
            tensors.append(given)
            losses.append((positions**2).sum())
        sum(losses).backward()
        for factor, given in zip((1, 2), tensors):
            alone, (positions, _) = self.equilibrium({"young": factor * PARAMETERS["young"], "gravity": PARAMETERS["gravity"]})
            (positions**2).sum().backward()
            np.testing.assert_allclose(given["young"].grad, alone["young"].grad, rtol=1e-7, atol=1e-16)

    def test_single_precision_and_names(self):
        import torch
        from exemplar.with_torch import equilibrium
        young = torch.full((), 1e5, dtype=torch.float32, requires_grad=True)
        equilibrium(make(), young=young, gravity=torch.tensor([0., 0, -3]))[0].sum().backward()
        self.assertEqual((young.grad.dtype, young.grad.shape), (torch.float32, ()))
        with self.assertRaisesRegex(exemplar.UserError, "no parameter 'yuong'"):
            equilibrium(make(), yuong=young)


@unittest.skipUnless(importlib.util.find_spec("jax"), "needs jax")
class Jax(Wrapper, unittest.TestCase):
    def loss(self, parameters):
        from exemplar.with_jax import equilibrium
        positions, weights = equilibrium(make(), **parameters)
        return (BY_POSITIONS * positions).sum() + BY_WEIGHTS @ weights

    def setUp(self):
        import jax
        jax.config.update("jax_enable_x64", True)

    def value(self, parameters):
        return float(self.loss(parameters))

    def gradients(self, parameters):
        import jax
        return jax.grad(self.loss)(parameters)


if __name__ == "__main__":
    unittest.main()
