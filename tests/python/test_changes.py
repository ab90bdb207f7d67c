# SPDX-License-Identifier: GPL-3.0-or-later
"""What of a problem changes between its steps: a problem that was changed is as one that was made so."""
import unittest

import numpy as np

import exemplar

HANDLES = {"left": {"Select": "box 0 -1 -1 0 1 1"},
           "right": {"Select": ["box", 2, -1, -1, 2, 1, 1], "Motion": ["0.2*t", 0, "0.3*t"]}}
TWIST = {"Pose functions": [["x", "y+0.2*x*z", "z-0.2*x*y"]]}
STATIC = {"Scene": "static", "Mesh": {"Generator": "box", "Box size": [2, 1, 1], "Box cells": (4, 2, 2)},
          "Handles": HANDLES, "Examples": {**TWIST, "Importance": 0.8}, "Solver": {"Tolerance": 1e-11}}
DYNAMIC = {**STATIC, "Scene": "dynamic", "Time": {"Step": 0.05, "End": 0.5}}


def scene(base=STATIC, **sections):
    return {**base, **{name: {**base.get(name, {}), **keys} for name, keys in sections.items()}}


def without(base, section):
    return {key: value for key, value in base.items() if key != section}


def solved(of, change=None):
    problem = exemplar.Problem(of)
    problem.run()
    if change is not None:
        change(problem)
        problem.step()
    return problem


class Numbers(unittest.TestCase):
    def assert_same(self, changed, other, tolerance=1e-8):
        np.testing.assert_allclose(changed.positions, other.positions, atol=tolerance)
        np.testing.assert_allclose(changed.weights, other.weights, atol=1e3 * tolerance)
        np.testing.assert_allclose(changed.energies["energy_elastic"], other.energies["energy_elastic"], rtol=1e3 * tolerance)

    def test_material(self):
        stiff = {"Young's modulus": 4e5, "Poisson's ratio": 0.4}
        for dilatation in "cells", "patches":
            with self.subTest(dilatation):
                model = scene(Model={"Dilatation": dilatation})
                self.assert_same(solved(model, lambda problem: problem.set_material(young=4e5, poisson=0.4)), solved(scene(model, Material=stiff)))

    def test_material_by_cell_is_in_the_order_of_the_cells(self):
        box = exemplar.Problem(STATIC)
        nodes, cells = box.rest_positions.copy(), box.cells.copy()
        ids = np.where(nodes[cells].mean(axis=1)[:, 0] < 0.7, 1, 2)
        bare = {**without(STATIC, "Mesh"), "Model": {"Dilatation": "cells"}}  # patches do not leave a region
        made = exemplar.Problem({**bare, "Material": {"Young's modulus": 1e5, "region 2": {"Young's modulus": 1e6}}}, mesh=(nodes, cells, ids))
        made.run()
        changed = exemplar.Problem({**bare, "Material": {"Young's modulus": 1e5}}, mesh=(nodes, cells))
        changed.set_material(young=np.where(ids == 2, 1e6, 1e5))
        changed.run()
        self.assert_same(changed, made)
        self.assertGreater(np.abs(made.positions - solved(STATIC).positions).max(), 1e-3)

    def test_density_and_gravity(self):
        loaded = scene(Loads={"Gravity": [0, 0, -20]}, Material={"Density": 3000})

        def change(problem):
            problem.set_material(density=3000)
            problem.gravity = [0, 0, -20]
        changed = solved(STATIC, change)
        self.assert_same(changed, solved(loaded))
        np.testing.assert_array_equal(changed.gravity, [0, 0, -20])
        self.assertIn("work_gravity", changed.statistics)

    def test_importance(self):
        changed = solved(STATIC, lambda problem: setattr(problem, "importance", 0.3))
        self.assertEqual(changed.importance, 0.3)
        self.assert_same(changed, solved(scene(Examples={"Importance": 0.3})))

    def test_damping_in_a_step_that_follows(self):
        problem, other = exemplar.Problem(DYNAMIC), exemplar.Problem(scene(DYNAMIC, Time={"Stiffness damping": 0.02, "Mass damping": 0.5}))
        problem.step()
        problem.mass_damping, problem.stiffness_damping = 0.5, 0.02
        self.assertEqual((problem.mass_damping, problem.stiffness_damping), (0.5, 0.02))
        other.state = problem.state
        for one in problem, other:
            one.run()
        self.assert_same(problem, other, 1e-5)

    def test_nodal_forces(self):
        problem = exemplar.Problem(STATIC)
        tip = np.flatnonzero(problem.rest_positions[:, 0] == 1)
        forces = np.zeros((45, 3))
        self.assertEqual(problem.nodal_forces.tobytes(), forces.tobytes())
        forces[tip] = [0, 3e4 / len(tip), 0]
        changed = solved(STATIC, lambda problem: setattr(problem, "nodal_forces", forces))
        np.testing.assert_array_equal(changed.nodal_forces, forces)
        moved = changed.positions - solved(STATIC).positions
        self.assertGreater(moved[tip, 1].min(), 0.005)
        work = changed.statistics["work_loads"]
        self.assertAlmostEqual(work, (forces * moved).sum(), delta=1e-6 * work)
        # as a load of the same forces: equal ones on the nodes of a box are none, so one node alone
        at = [0, 0, 0]
        one = np.zeros((45, 3))
        node = np.flatnonzero((problem.rest_positions == [2, 0.5, 0.5]).all(axis=1))
        free = scene(Handles={"right": {"Select": "box 0 0 0 0.5 1 1"}})
        one[node] = [0, 1e4, 0]
        named = solved({**free, "Loads": {"pull": {"Select": ["box", 2, 0.5, 0.5, 2, 0.5, 0.5], "Force": [0, 1e4, 0]}}})
        self.assert_same(solved(free, lambda problem: setattr(problem, "nodal_forces", one)), named)
        changed.nodal_forces = None
        changed.step()
        self.assert_same(changed, solved(STATIC))

    def test_forces_in_dynamics_push_a_free_body(self):
        free = {"Scene": "dynamic", "Mesh": STATIC["Mesh"], "Time": {"Step": 0.1, "End": 1}}
        for element in "P1", "P2":
            problem = exemplar.Problem({**free, "Model": {"Element": element}})
            forces = np.zeros(problem.nodal_forces.shape)
            forces[:, 0] = 5. / len(forces)
            problem.nodal_forces = forces
            problem.run()
            self.assertAlmostEqual(problem.statistics["momentum_x"], 5, places=4)

    def test_poses(self):
        nodes = exemplar.Problem(STATIC).rest_positions
        x, y, z = nodes.T
        other = np.column_stack([x, y + 0.3 * x * x, z])
        changed = solved(STATIC, lambda problem: problem.set_pose(1, other))
        self.assert_same(changed, solved(scene(Examples={"Pose functions": [["x", "y+0.3*x*x", "z"]]})))
        with self.assertWarnsRegex(UserWarning, "^Example 1 "):
            changed.set_pose(1, nodes * [1, 1, -1])
        back = solved(STATIC)
        for words, i, positions in (("counted from 0.*there are 2, of which 0 is the rest pose", 0, nodes), ("there are 2", 2, nodes),
                                    ("have 3 nodes, the mesh 45", 1, nodes[:3]), ("counted from 0", -1, nodes), ("finite", 1, nodes + np.nan)):
            with self.subTest(words), self.assertRaisesRegex(exemplar.UserError, words):
                back.set_pose(i, positions)
        back.step()
        self.assert_same(back, solved(STATIC))

    def test_handles_with_a_time_hold_as_it_says(self):
        timed = exemplar.Problem(scene(DYNAMIC, Handles={"right": {**HANDLES["right"], "Until": 0.2}}))
        with self.assertRaisesRegex(exemplar.UserError, "From and Until"):
            timed.let_go("right")
        timed.run()
        called = exemplar.Problem(DYNAMIC)
        called.goto(0.2)
        called.let_go("right")
        called.run()
        self.assertEqual(timed.positions.tobytes(), called.positions.tobytes())
        with self.assertRaisesRegex(exemplar.UserError, "with handles that let go or catch"):
            with exemplar.Problem(scene(DYNAMIC, Handles={"right": {**HANDLES["right"], "From": 0.2}})).record():
                pass

    def test_what_is_refused_changes_nothing(self):
        problem = exemplar.Problem(STATIC)
        before = problem.energies
        for words, change in (("young must be a number or an array of shape \\(96,\\), but is an array of shape \\(3,\\)", lambda: problem.set_material(young=[1, 2, 3])),
                              ("Young's modulus", lambda: problem.set_material(young=-1)), ("Poisson's ratio", lambda: problem.set_material(poisson=0.5)),
                              ("finite, but number 0.*nan", lambda: problem.set_material(density=np.nan)), ("must be a number", lambda: problem.set_material(young="soft")),
                              ("above 0", lambda: setattr(problem, "importance", 0)), ("shape \\(3,\\)", lambda: setattr(problem, "gravity", -9.81)),
                              ("shape \\(45, 3\\)", lambda: setattr(problem, "nodal_forces", np.zeros(3))), ("Scene = dynamic", lambda: setattr(problem, "mass_damping", 1)),
                              ("negative", lambda: setattr(exemplar.Problem(DYNAMIC), "stiffness_damping", -1)),
                              ("interpolation has no loads", lambda: setattr(exemplar.Problem({"Scene": "interpolation", "Mesh": STATIC["Mesh"], "Examples": TWIST}), "gravity", [0, 0, 1]))):
            with self.subTest(words), self.assertRaisesRegex(exemplar.UserError, words):
                change()
        with self.assertRaisesRegex(TypeError, "with the names"):
            problem.set_material(1e5)
        self.assertEqual(problem.energies, before)
        problem.on_iteration(lambda report: problem.set_material(young=1e6))
        with self.assertRaisesRegex(RuntimeError, "set_material\\(\\).*may only look"):
            problem.step()
        problem.on_iteration(None)
        problem.run()
        self.assertEqual(problem.positions.tobytes(), solved(STATIC).positions.tobytes())


class Handles(unittest.TestCase):
    def test_what_is_held_stays_where_it_is(self):
        for base, n_still in (DYNAMIC, 9 + 9), (scene(DYNAMIC, Model={"Element": "P2"}), 25 + 25):  # with the left end
            problem = exemplar.Problem(base)
            for _ in range(3):
                problem.step()
            nodes = np.flatnonzero(problem.rest_positions[:, 0] == 1)
            here = problem.state.positions.copy()
            problem.hold("middle", nodes[::-1])
            problem.run()
            np.testing.assert_allclose(problem.positions[nodes], here[nodes], atol=1e-14)
            self.assertEqual((np.abs(problem.state.positions - here).max(axis=1) < 1e-14).sum(), n_still)
            self.assertIn("reaction_middle_x", problem.statistics)

    def test_handles_by_nodes_are_as_those_of_the_scene(self):
        bare = scene(DYNAMIC)
        bare["Handles"] = {"left": HANDLES["left"]}
        problem, other = exemplar.Problem(bare), exemplar.Problem(DYNAMIC)
        problem.grab("right", np.flatnonzero(problem.rest_positions[:, 0] == 2), lambda rest, t: 0 * rest + [0.2 * t, 0, 0.3 * t])
        for one in problem, other:
            one.run()
        np.testing.assert_allclose(problem.positions, other.positions, atol=1e-9)
        problem.set_motion("right", lambda rest, t: 0 * rest + [0.1, 0, 0.15])
        problem.step()
        right = problem.rest_positions[:, 0] == 2
        np.testing.assert_allclose((problem.positions - problem.rest_positions)[right], np.tile([0.1, 0, 0.15], (right.sum(), 1)))

    def test_let_go_and_grabbed_again(self):
        problem = exemplar.Problem(DYNAMIC)
        problem.step()
        problem.let_go("right")
        problem.step()
        self.assertEqual(problem.statistics["reaction_right_x"], 0)
        for nodes in [0], [9, 3]:
            problem.let_go("right")
            problem.grab("right", nodes, lambda rest, t: np.zeros((len(nodes), 3)))
            problem.step()
            np.testing.assert_array_equal(problem.positions[nodes], problem.rest_positions[nodes])
        problem.let_go("right")
        problem.hold("right")
        problem.step()
        np.testing.assert_array_equal(problem.positions[[3, 9]], problem.rest_positions[[3, 9]])

    def test_a_handle_that_is_not_there(self):
        for base, remedy in (STATIC, "has: left, right"), (without(DYNAMIC, "Handles"), "Add it to Handles/Names"):
            with self.subTest(remedy), self.assertRaisesRegex(exemplar.UserError, f"There is no handle 'up'.*{remedy}"):
                exemplar.Problem(base).let_go("up")

    def test_what_is_refused_changes_nothing(self):
        problem = exemplar.Problem(STATIC)
        for words, change in (("There is no handle 'up'", lambda: problem.let_go("up")), ("There is a handle 'left' already", lambda: problem.hold("left", [1])),
                              ("rigid motions", lambda: (problem.let_go("right"), problem.let_go("left"))), ("hold every node", lambda: problem.hold("all", np.arange(45))),
                              ("has 45, but there are 45 nodes", lambda: problem.hold("x", [45])), ("has -1", lambda: problem.hold("x", [-1])),
                              ("is a mask.*flatnonzero", lambda: problem.hold("x", np.ones(45, bool))), ("of no integers", lambda: problem.hold("x", [1.5]))):
            with self.subTest(words), self.assertRaisesRegex(exemplar.UserError, words):
                change()
        with self.assertRaisesRegex(TypeError, "hold\\(name, nodes\\)"):
            problem.grab("x", [1], None)
        problem.hold("right")
        problem.run()
        self.assertEqual(problem.positions.tobytes(), solved(STATIC).positions.tobytes())


if __name__ == "__main__":
    unittest.main()
