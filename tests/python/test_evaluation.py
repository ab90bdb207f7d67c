# SPDX-License-Identifier: GPL-3.0-or-later
"""Energies, forces and matrices anywhere: each against central differences of the one before, and against what the solver found."""
import re
import subprocess
import sys
import unittest
import warnings

import numpy as np

import exemplar

try:
    import scipy.sparse
    import scipy.sparse.linalg
except ImportError:
    scipy = None

HANDLES = {"left": {"Select": "box 0 -1 -1 0 1 1"},
           "right": {"Select": ["box", 2, -1, -1, 2, 1, 1], "Motion": ["0.2*t", 0, "0.3*t"]}}
POSES = {"Pose functions": [["x", "y+0.2*x*z", "z-0.2*x*y"], ["1.2*x", "y", "z+0.1*x*x"]], "Importance": 0.8}
STATIC = {"Scene": "static", "Mesh": {"Generator": "box", "Box size": [2, 1, 1], "Box cells": (3, 2, 2)}, "Handles": HANDLES,
          "Examples": POSES, "Loads": {"Gravity": [0, 0, -3]}, "Solver": {"Tolerance": 1e-11}, "Time": {"Increments": 4}}
DYNAMIC = {**STATIC, "Scene": "dynamic", "Time": {"Step": 0.05, "End": 0.5, "Stiffness damping": 0.02, "Mass damping": 0.3},
           "Solver": {"Method": "newton", "Tolerance": 1e-11}}


def scene(base=STATIC, **sections):
    return {**base, **{name: {**base.get(name, {}), **keys} for name, keys in sections.items()}}


SCENES = {
    "cells": scene(Model={"Dilatation": "cells"}),
    "patches": scene(Model={"Dilatation": "patches"}),
    "quadratic": scene(Model={"Element": "P2"}),
    "blended": scene(Examples={"Energy": "blended"}),
    "scaled": scene(Examples={"Energy": "scaled"}),
    "free": scene(Examples={"Weights": "free"}),
    "linear": scene(Model={"Strain": "linear"}),
    "dynamic": scene(DYNAMIC, Model={"Dilatation": "cells"}),
    "dynamic patches": scene(DYNAMIC, Model={"Dilatation": "patches"}),
    "dynamic quadratic": scene(DYNAMIC, Model={"Element": "P2"}),
    "of two steps": scene(DYNAMIC, Time={"Scheme": "bdf2"}),
    "that creeps": scene(DYNAMIC, Examples={"Creep viscosity": 500}),
    "of Green's strain": scene(Model={"Strain": "green"}),
    "neo-Hookean": scene(DYNAMIC, Model={"Background": "neo-hookean"}, Examples={"Energy": "blended"}),
    "with fibres": scene(Material={"Fibre stiffness": 1e6, "Fibre direction": "1; 1; 0"}),
    "that yields": scene(DYNAMIC, Material={"Yield stress": 2e4, "Kinematic hardening": 1e5}, Examples={"Energy": "blended"}),
    "by kept factors": scene(DYNAMIC, Solver={"Method": "quasi newton", "Tolerance": 1e-8}),
    "without examples": {name: section for name, section in DYNAMIC.items() if name != "Examples"},
}


def some_steps(of, n=2):
    problem = exemplar.Problem(of)
    for _ in range(n):
        problem.step()
    return problem


def near(problem, size=5e-3, seed=1):
    """Positions and weights that are no minimum."""
    random = np.random.default_rng(seed)
    x = problem.state.positions
    n = problem.cell_nodes.max() + 1
    if len(x) != n:
        raise AssertionError("the state has other nodes")
    w = problem.weights
    return x + size * random.standard_normal(x.shape), w + 0.02 * random.standard_normal(w.shape)


def relative(a, b):
    return np.abs(a - b).max() / np.abs(b).max()


class Derivatives(unittest.TestCase):
    def each(self):
        for name, of in SCENES.items():
            with self.subTest(name):
                problem = some_steps(of)
                x, w = near(problem)
                yield problem, x, w, np.random.default_rng(2).standard_normal(x.shape)

    def test_gradient(self):
        for problem, x, w, d in self.each():
            h = 1e-5
            change = (problem.energy(x + h * d, w) - problem.energy(x - h * d, w)) / (2 * h)
            size = np.linalg.norm(problem.gradient(x, w)) * np.linalg.norm(d)
            self.assertLess(abs(change - (problem.gradient(x, w) * d).sum()) / size, 1e-7)

    def test_weight_gradient(self):
        for problem, x, w, _ in self.each():
            for i in range(len(w)):
                e = 1e-4 * np.eye(len(w))[i]
                change = (problem.energy(x, w + e) - problem.energy(x, w - e)) / 2e-4
                gradient = problem.weight_gradient(x, w)
                self.assertLess(abs(change - gradient[i]) / np.abs(gradient).max(), 1e-6)

    @unittest.skipIf(scipy is None, "no scipy")
    def test_hessian(self):
        for problem, x, w, d in self.each():
            h = 1e-6
            change = (problem.gradient(x + h * d, w) - problem.gradient(x - h * d, w)) / (2 * h)
            hessian = problem.hessian(x, w)
            self.assertIsInstance(hessian, scipy.sparse.csr_array)
            self.assertEqual(hessian.shape, (x.size, x.size))
            self.assertLess(relative(hessian @ d.ravel(), change.ravel()), 1e-6)
            self.assertEqual(abs(hessian - hessian.T).max(), 0)
            convex = problem.hessian(x, w, "convex").toarray()
            eigenvalues = np.linalg.eigvalsh(convex)
            self.assertGreater(eigenvalues[0], -1e-9 * eigenvalues[-1])

    def test_coupling_and_weight_hessian(self):
        for problem, x, w, d in self.each():
            if len(w) == 0:
                with self.assertRaisesRegex(exemplar.UserError, "no examples"):
                    problem.coupling()
                continue
            G, H = problem.coupling(x, w), problem.weight_hessian()
            self.assertEqual(G.shape, (x.size, len(w)))
            np.testing.assert_allclose(H, H.T, rtol=1e-14)
            scale_H = np.abs(H).max()
            for i in range(len(w)):
                e = 1e-4 * np.eye(len(w))[i]
                change = (problem.gradient(x, w + e) - problem.gradient(x, w - e)).ravel() / 2e-4
                self.assertLess(np.abs(G[:, i] + change).max() / np.abs(G).max(), 1e-6)
                change = (problem.weight_gradient(x, w + e) - problem.weight_gradient(x, w - e)) / 2e-4
                self.assertLess(np.abs(H[:, i] - change).max() / scale_H, 1e-6)

    @unittest.skipIf(scipy is None, "no scipy")
    def test_reduced_hessian_is_that_of_the_minimum_over_the_weights(self):
        for name in "blended", "free":
            with self.subTest(name):
                problem = some_steps(SCENES[name], 4)
                x, w = problem.positions, problem.weights
                H, d = problem.weight_hessian(), np.random.default_rng(3).standard_normal(x.shape)
                active = np.flatnonzero(w > 0) if name == "blended" else np.arange(len(w))
                k = len(active)
                self.assertGreater(k, 1)
                bordered = np.block([[H[np.ix_(active, active)], np.ones((k, 1))], [np.ones((1, k)), np.zeros((1, 1))]])

                def best(y):
                    v = w.copy()
                    g = problem.weight_gradient(y, v)[active]
                    v[active] -= np.linalg.solve(bordered, np.append(g, 0))[:k]
                    return v
                h = 1e-6
                change = (problem.gradient(x + h * d, best(x + h * d)) - problem.gradient(x - h * d, best(x - h * d))) / (2 * h)
                operator = problem.reduced_hessian()
                self.assertIsInstance(operator, scipy.sparse.linalg.LinearOperator)
                self.assertLess(relative(operator @ d.ravel(), change.ravel()), 1e-6)


class AtTheState(unittest.TestCase):
    def test_a_minimum_has_no_gradient_but_where_handles_hold(self):
        problem = some_steps(SCENES["cells"])
        force = problem.gradient()
        held = np.isin(problem.rest_positions[:, 0], [0, 2])
        self.assertLess(np.abs(force[~held]).max(), 1e-8 * np.abs(force).max())
        np.testing.assert_allclose(force[problem.rest_positions[:, 0] == 2].sum(axis=0)[2], problem.statistics["reaction_right_z"], rtol=1e-8)

    def test_energy_of_a_static_state(self):
        problem = some_steps(SCENES["cells"])
        energies = problem.energies
        fall = problem.statistics["work_gravity"]
        self.assertAlmostEqual(problem.energy() / (energies["energy_elastic"] + energies["energy_example"] - fall), 1, places=6)

    def test_the_next_step_minimises_the_energy(self):
        for name in "dynamic patches", "of two steps", "that creeps":
            with self.subTest(name):
                problem = some_steps(SCENES[name])
                before = problem.state
                problem.step()
                x, w = problem.state.positions, problem.weights
                problem.state = before
                force = problem.gradient(x, w)
                free = ~np.isin(problem.rest_positions[:, 0], [0, 2])
                self.assertLess(np.abs(force[free]).max(), 1e-7 * np.abs(problem.gradient()).max())

    def test_nothing_that_is_asked_changes_the_run(self):
        for name in "patches", "dynamic", "dynamic patches", "of two steps", "that creeps", "quadratic", "by kept factors":
            for frozen in (False, True):
                of = SCENES[name]
                if frozen:
                    of = scene(of, Model={"Gradient": "frozen"}, Solver={"Method": "fixed point", "Tolerance": 1e-6})
                with self.subTest(name, frozen=frozen):
                    plain, asked = exemplar.Problem(of), exemplar.Problem(of)
                    for _ in range(4):
                        x, w = near(asked)
                        for ask in asked.energy, asked.gradient, asked.weight_gradient, asked.coupling:
                            ask(x, w)
                        if scipy is not None:
                            asked.hessian(x, w), asked.hessian(x, w, "convex"), asked.reduced_hessian()
                        asked.stresses, asked.det_F
                        self.assertEqual(plain.step().residual, asked.step().residual)
                        self.assertEqual(plain.positions.tobytes(), asked.positions.tobytes())
                        self.assertEqual(plain.weights.tobytes(), asked.weights.tobytes())

    def test_changes_are_followed(self):
        problem = some_steps(SCENES["patches"])
        x, w = near(problem)
        problem.energy(x, w)
        problem.set_material(young=3e5)
        problem.importance = 0.5
        problem.gravity = [1, 0, 0]
        fresh = exemplar.Problem(scene(SCENES["patches"], Material={"Young's modulus": 3e5}, Examples={"Importance": 0.5}, Loads={"Gravity": [1, 0, 0]}))
        self.assertAlmostEqual(problem.energy(x, w) / fresh.energy(x, w), 1, places=9)
        self.assertLess(relative(problem.gradient(x, w), fresh.gradient(x, w)), 1e-9)

    @unittest.skipIf(scipy is None, "no scipy")
    def test_mass(self):
        for of in SCENES["cells"], SCENES["dynamic"], SCENES["dynamic quadratic"]:
            mass = exemplar.Problem(of).mass
            ones = np.tile([1.0, 0, 0], mass.shape[0] // 3)
            self.assertAlmostEqual(ones @ (mass @ ones), 2000)
            self.assertEqual(abs(mass - mass.T).max(), 0)


class Cells(unittest.TestCase):
    def test_stretched_bar(self):
        bare = {name: section for name, section in STATIC.items() if name not in ("Examples", "Loads")}
        problem = exemplar.Problem(scene(bare, Model={"Dilatation": "cells"}, Material={"Young's modulus": 1e6, "Poisson's ratio": 0},
                                         Handles={"right": {"Select": "box 2 -1 -1 2 1 1", "Motion": "0.2*t; 0; 0"}}))
        problem.run()
        m = len(problem.cells)
        stretch = np.zeros((m, 3, 3))
        stretch[:, 0, 0] = 0.1
        np.testing.assert_allclose(problem.strains, stretch, atol=1e-9)
        np.testing.assert_allclose(problem.stresses, 1e6 * stretch, atol=1e-3)
        np.testing.assert_allclose(problem.det_F, np.full(m, 1.1), atol=1e-9)
        F = np.einsum("mai,maj->mij", problem.positions[problem.cell_nodes], problem.shape_gradients)
        np.testing.assert_allclose(F, np.eye(3) + stretch, atol=1e-9)

    def test_example_strains(self):
        problem = exemplar.Problem(scene(SCENES["cells"], Examples={"Pose functions": [["1.2*x", "y", "z"]], "Importance": 0.5}))
        strains = problem.example_strains
        self.assertEqual(strains.shape, (2, len(problem.cells), 3, 3))
        self.assertEqual(np.abs(strains[0]).max(), 0)
        np.testing.assert_allclose(strains[1, :, 0, 0], 0.1, atol=1e-12)

    def test_forces_are_those_of_the_stresses(self):
        """sum V P g with P = R T R^T R = stress R is the gradient where there is no guard, no load and no example."""
        problem = some_steps({name: section for name, section in SCENES["cells"].items() if name not in ("Examples", "Loads")})
        x, g = problem.positions, problem.shape_gradients
        F = np.einsum("mai,maj->mij", x[problem.cells], g)
        U, _, V = np.linalg.svd(F)
        R = U @ V
        volumes = np.abs(np.linalg.det(np.diff(problem.rest_positions[problem.cells], axis=1))) / 6
        forces = np.zeros_like(x)
        np.add.at(forces, problem.cell_nodes, np.einsum("m,mij,mjk,mak->mai", volumes, problem.stresses, R, g))
        S = np.swapaxes(R, 1, 2) @ F
        np.testing.assert_allclose(problem.strains, S - np.eye(3), atol=1e-10)
        self.assertLess(relative(forces, problem.gradient()), 1e-9)


class Errors(unittest.TestCase):
    def test_wrong_shapes(self):
        problem = exemplar.Problem(STATIC)
        for wrong in (dict(positions=np.zeros((3, 3))), dict(weights=[1, 0]), dict(weights=1.0), dict(positions="x")):
            with self.subTest(str(wrong)[:30]), self.assertRaises(exemplar.UserError) as caught:
                problem.energy(**wrong)
            self.assertIn("energy", str(caught.exception))
        with self.assertRaisesRegex(TypeError, "positions=None"):
            problem.energy(x=1)

    @unittest.skipIf(scipy is None, "no scipy")
    def test_wrong_kind(self):
        with self.assertRaisesRegex(exemplar.UserError, "'exact' or 'convex'"):
            exemplar.Problem(STATIC).hessian(kind="newton")

    def test_prescribed_weights(self):
        problem = exemplar.Problem(scene(Examples={"Weights": "prescribed", "Prescribed weights": "1-t; t; 0"}))
        self.assertEqual(problem.gradient().shape, problem.positions.shape)
        for ask in problem.weight_gradient, problem.coupling, problem.weight_hessian:
            with self.assertRaisesRegex(exemplar.UserError, "prescribed"):
                ask()

    def test_within_a_step(self):
        problem = exemplar.Problem(STATIC)
        problem.on_iteration(lambda report: problem.energy())
        with self.assertRaisesRegex(RuntimeError, "energy"):
            problem.step()

    def test_without_scipy(self):
        program = ("import sys; sys.modules['scipy'] = None; sys.modules['scipy.sparse'] = None\n"
                   "import exemplar\n"
                   "problem = exemplar.Problem({'Scene': 'static', 'Mesh': {'Generator': 'box'},"
                   " 'Handles': {'a': {'Select': 'box -1 -1 -1 0 9 9'}}})\n"
                   "problem.energy(); problem.gradient()\n"
                   "try: problem.hessian()\n"
                   "except ImportError as error: print(error)\n")
        done = subprocess.run([sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.assertIn("need scipy", done.stdout, done.stderr)


class Balance(unittest.TestCase):
    @unittest.skipUnless(scipy, "needs scipy")
    def test_a_balanced_body_stands_beside_its_examples_from_the_stiffness_that_the_warning_names(self):
        """Below it the energy falls along the example: with its matrices, H_ii - G_i^T K^-1 G_i changes its sign there."""
        base = {"Scene": "static", "Mesh": {"Generator": "box", "Box size": [8, 1, 1], "Box cells": (8, 1, 1)},
                "Handles": {"foot": {"Select": "boundary 1"}}, "Loads": {"Gravity": [-9.81, 0, 0], "Balanced": True},
                "Material": {"Density": 1000, "Poisson's ratio": 0, "Young's modulus": 1e6}, "Time": {"Increments": 1},
                "Examples": {"Pose functions": [["x-0.01*(z-0.5)*x", "y", "z+0.005*x*x"]], "Importance": 0.8, "Energy": "blended"}}
        with self.assertWarnsRegex(UserWarning, "with its examples") as warned:
            exemplar.Problem(base)
        named = float(re.search(r"modulus = ([-+.e0-9]+[0-9])", str(warned.warning))[1])
        for factor in 0.98, 1.02:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                problem = exemplar.Problem(scene(base, Material={"Young's modulus": factor * named}))
            free = np.repeat(problem.rest_positions[:, 0] > 1e-9, 3)
            tangent, G = problem.hessian()[free][:, free], problem.coupling()[free, 1]
            schur = problem.weight_hessian()[1, 1] - G @ scipy.sparse.linalg.spsolve(tangent.tocsc(), G)
            self.assertGreater(np.linalg.eigvalsh(tangent.toarray())[0], 0)
            self.assertEqual(schur > 0, factor > 1, (named, schur))


if __name__ == "__main__":
    unittest.main()
