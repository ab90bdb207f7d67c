# SPDX-License-Identifier: GPL-3.0-or-later
"""The state in and out, steps of any length, and back to the beginning."""
import copy
import os
import pickle
import subprocess
import sys
import tempfile
import threading
import unittest
import warnings
from pathlib import Path

import numpy as np

import exemplar

HANDLES = {"left": {"Select": "box 0 -1 -1 0 1 1"},
           "right": {"Select": ["box", 2, -1, -1, 2, 1, 1], "Motion": ["0.2*t", 0, "0.3*t"]}}
STATIC = {"Scene": "static", "Mesh": {"Generator": "box", "Box size": [2, 1, 1], "Box cells": (4, 2, 2)},
          "Handles": HANDLES, "Time": {"Increments": 4}, "Examples": {"Pose functions": [["x", "y+0.2*x*z", "z-0.2*x*y"]]}}
DYNAMIC = {**STATIC, "Scene": "dynamic", "Time": {"Step": 0.05, "End": 0.5}, "Loads": {"Gravity": [0, 0, -2]}}


def scene(base=DYNAMIC, **sections):
    return {**base, **{name: {**base.get(name, {}), **keys} for name, keys in sections.items()}}


KINDS = {
    "quasi newton": DYNAMIC,
    "damped": scene(Time={"Stiffness damping": 0.01}),
    "bdf2": scene(Time={"Scheme": "bdf2"}),
    "newton": scene(Solver={"Method": "newton"}),
    "one pass": scene(Solver={"Method": "one pass"}),
    "predicted": scene(Solver={"Method": "one pass", "Rotations": "predicted"}, Model={"Gradient": "frozen"}),
    "iterative": scene(Solver={"Linear solver": "iterative"}),
    "patches": scene(Model={"Dilatation": "patches"}, Material={"Poisson's ratio": 0.49}),
    "P2": scene(Model={"Element": "P2"}),
    "plastic": scene(Material={"Yield stress": 1e3}, Examples={"Energy": "blended", "Importance": 0.5}),
    "weights that yield": scene(Examples={"Yield": 1e-3, "Creep viscosity": 1}),
    "keys that add up": scene(Examples={"Weights": "additive"}),
    "keys that yield": scene(Examples={"Weights": "additive", "Yield": 1e-3, "Creep viscosity": 1}),
    "a handle that lets go": scene(Handles={"right": {**HANDLES["right"], "Until": 0.2}}),
    "a handle that lets go there": scene(Handles={"right": {**HANDLES["right"], "Until": 0.1}}),
    "static": STATIC,
}


def bytes_of(problem):
    return problem.positions.tobytes() + problem.weights.tobytes() + repr(sorted(problem.statistics.items())).encode()


def steps(problem, n):
    return [(problem.step(), bytes_of(problem))[1] for _ in range(n)]


class States(unittest.TestCase):
    def test_steps_from_a_state_are_the_same_bytes_each_time(self):
        for kind, of_kind in KINDS.items():
            with self.subTest(kind):
                problem = exemplar.Problem(of_kind)
                n = 2 if kind == "static" else 5
                first = steps(problem, 2)
                saved = problem.state
                second = steps(problem, n)
                problem.state = saved
                self.assertEqual(problem.state, saved)
                self.assertEqual((problem.step_number, problem.residual), (2, 0))
                self.assertEqual(steps(problem, n), second)
                problem.reset()
                self.assertEqual((problem.step_number, problem.time), (0, 0))
                self.assertEqual(steps(problem, 2 + n), first + second)

    def test_what_it_shows(self):
        problem = exemplar.Problem(DYNAMIC)
        problem.step()
        state = problem.state
        for name in "positions", "velocities", "weights":
            np.testing.assert_array_equal(getattr(state, name), getattr(problem, name))
            with self.assertRaises(ValueError):
                getattr(state, name)[0] = 1
        self.assertEqual((state.step, state.time, state.history.shape), (1, 0.05, (0,)))
        self.assertEqual(repr(state), "<exemplar.State: step 1, time 0.05, 45 nodes>")
        kept = state.positions
        before = kept.copy()
        problem.step()
        problem.reset()
        del state, problem
        np.testing.assert_array_equal(kept, before)

    def test_of_laws_that_remember_and_of_quadratic_elements(self):
        self.assertGreater(exemplar.Problem(KINDS["plastic"]).state.history.size, 0)
        problem = exemplar.Problem(KINDS["P2"])
        self.assertGreater(len(problem.state.positions), len(problem.positions))
        self.assertIsNone(exemplar.Problem(STATIC).state.velocities)

    def test_copies_and_equality(self):
        problem = exemplar.Problem(DYNAMIC)
        state = problem.state
        for other in copy.copy(state), copy.deepcopy(state), pickle.loads(pickle.dumps(state)):
            self.assertEqual(other, state)
            self.assertIsNot(other, state)
        problem.step()
        self.assertNotEqual(problem.state, state)
        self.assertNotEqual(state, 1)
        with self.assertRaisesRegex(TypeError, "problem.state"):
            exemplar.State()
        with self.assertRaises(TypeError):
            hash(state)

    def test_a_pickle_goes_on_in_another_process(self):
        problem = exemplar.Problem(KINDS["damped"])
        steps(problem, 3)
        with tempfile.TemporaryDirectory() as directory:
            file = Path(directory, "state")
            file.write_bytes(pickle.dumps((KINDS["damped"], problem.state)))
            program = ("import exemplar, pickle, sys\nscene, state = pickle.load(open(sys.argv[1], 'rb'))\n"
                       "problem = exemplar.Problem(scene)\nproblem.state = state\nfor _ in range(4): problem.step()\n"
                       "sys.stdout.write(problem.positions.tobytes().hex())")
            there = subprocess.run([sys.executable, "-c", program, file], stdout=subprocess.PIPE, check=True, env=os.environ)
        steps(problem, 4)
        self.assertEqual(there.stdout.decode(), problem.positions.tobytes().hex())

    def test_replaced_arrays(self):
        problem = exemplar.Problem(scene(Solver={"Method": "newton"}))
        steps(problem, 3)
        state = problem.state
        self.assertEqual(state.replace(), state)
        problem.state = state.replace(velocities=0 * state.velocities + [1, 0, 0], time=0, step=0)
        np.testing.assert_array_equal(problem.velocities, np.tile([1., 0, 0], (45, 1)))
        np.testing.assert_array_equal(problem.positions, state.positions)
        self.assertEqual((problem.time, problem.step_number), (0, 0))
        problem.run()
        for words, values in (("shape \\(45, 3\\)", {"positions": np.zeros((3, 3))}), ("finite", {"velocities": np.full((45, 3), np.nan)}),
                              ("shape \\(2,\\)", {"weights": [1]}), ("whole number", {"step": 0.5})):
            with self.subTest(words), self.assertRaisesRegex(exemplar.UserError, words):
                state.replace(**values)
        with self.assertRaisesRegex(exemplar.UserError, "velocities cannot be replaced"):
            exemplar.Problem(STATIC).state.replace(velocities=np.zeros((45, 3)))

    def test_of_another_body(self):
        problem = exemplar.Problem(DYNAMIC)
        problem.step()
        before = bytes_of(problem)
        other = scene(STATIC, Mesh={"Box cells": (2, 2, 2)})
        without = {key: DYNAMIC[key] for key in DYNAMIC if key != "Examples"}
        state = problem.state
        for words, wrong in (("another body: it has 27 nodes, this problem 45", exemplar.Problem(other).state),
                             ("has no velocities", exemplar.Problem(STATIC).state),
                             ("0 weights, this problem 2", exemplar.Problem(without).state),
                             ("other laws: they remember [1-9][0-9]* numbers, those of this problem 0", exemplar.Problem(KINDS["plastic"]).state),
                             ("sum to 2", state.replace(weights=[1, 1])), ("below 0", state.replace(weights=[2, -1])),
                             ("not finite", state.replace(time=np.inf)),
                             ("beside which a step of 0.05 s is nothing", state.replace(time=-1e150)),  # run() would never end
                             ("beside which a step", state.replace(time=1e17))):
            with self.subTest(words), self.assertRaisesRegex(exemplar.UserError, words):
                problem.state = wrong
            self.assertEqual(bytes_of(problem), before)
        with self.assertRaisesRegex(exemplar.UserError, "has velocities"):
            exemplar.Problem(STATIC).state = problem.state
        with self.assertRaisesRegex(TypeError, "must be an exemplar.State, but is an array of shape \\(45, 3\\)"):
            problem.state = problem.positions
        with self.assertRaisesRegex(TypeError, "with the names"):
            state.replace(position=problem.positions)
        with self.assertRaisesRegex(AttributeError, "state.replace"):
            problem.positions = 1

    def test_callbacks_may_not_set_it(self):
        problem = exemplar.Problem(DYNAMIC)
        state = problem.state
        for call in (lambda: problem.state, lambda: setattr(problem, "state", state), problem.reset):
            problem.on_iteration(lambda report: call())
            with self.assertRaisesRegex(RuntimeError, "may only look"):
                problem.step()
            self.assertEqual(problem.step_number, 0)

    def test_a_state_from_before_a_change_leaves_out_what_the_solver_remembers(self):
        problem, same = exemplar.Problem(DYNAMIC), exemplar.Problem(DYNAMIC)
        for one in problem, same:
            steps(one, 3)
        saved = problem.state
        problem.let_go("right")
        problem.state = saved  # whose memory is of fewer unknowns
        problem.run()
        same.let_go("right")
        same.run()
        np.testing.assert_allclose(problem.positions, same.positions, atol=1e-5)
        problem.hold("right")  # as at first
        problem.reset()
        same = exemplar.Problem(DYNAMIC)
        self.assertEqual(steps(problem, 5), steps(same, 5))


class Steps(unittest.TestCase):
    def test_many_small_steps_and_the_scenes(self):
        whole, parts = exemplar.Problem(KINDS["bdf2"]), exemplar.Problem(KINDS["bdf2"])
        whole.goto(0.2)
        while parts.time < 0.2 - 1e-9:
            parts.step(0.0125)
        self.assertAlmostEqual(parts.time, 0.2)
        self.assertEqual(parts.step_number, 16)
        np.testing.assert_allclose(parts.positions, whole.positions, atol=0.02)
        self.assertEqual(exemplar.Problem(DYNAMIC).step(0.05).iterations, exemplar.Problem(DYNAMIC).step().iterations)

    def test_changing_steps_converge_by_the_order_of_the_scheme(self):
        # a free body falls; its middle is where a parabola has it, to the order of the scheme
        free = {"Scene": "dynamic", "Mesh": DYNAMIC["Mesh"], "Loads": {"Gravity": [0, 0, -2]}, "Solver": {"Method": "newton"}}
        errors = {}
        for scheme in "implicit euler", "bdf2":
            for n in 10, 20:
                problem = exemplar.Problem({**free, "Time": {"Step": 1, "End": 1, "Scheme": scheme}})
                for i in range(n):
                    problem.step((4 / 3 if i % 2 else 2 / 3) / n)
                self.assertAlmostEqual(problem.time, 1)
                errors[scheme, n] = abs((problem.positions - problem.rest_positions).mean(axis=0)[2] + 1)
            self.assertGreater(errors[scheme, 10] / errors[scheme, 20], 1.8 if scheme == "implicit euler" else 3)

    def test_beyond_the_end(self):
        problem = exemplar.Problem(DYNAMIC)
        problem.run()
        self.assertEqual((problem.step_number, problem.n_steps, problem.time), (10, 10, 0.5))
        with self.assertWarnsRegex(UserWarning, "run\\(\\) does nothing: all 10 steps"):
            problem.run()
        long = exemplar.Problem(scene(Time={"End": 0.6}))
        long.run()
        steps(problem, 2)
        self.assertAlmostEqual(problem.time, 0.6)
        np.testing.assert_allclose(problem.positions, long.positions, atol=1e-12)

    def test_run_goes_to_the_end_after_other_steps(self):
        problem = exemplar.Problem(DYNAMIC)
        problem.step(0.02)
        problem.run()
        self.assertEqual((problem.time, problem.step_number), (0.5, 11))
        static = exemplar.Problem(STATIC)
        static.step(0.3)
        static.run()
        self.assertEqual((static.time, static.step_number), (1, 4))

    def test_goto(self):
        problem, other = exemplar.Problem(DYNAMIC), exemplar.Problem(DYNAMIC)
        problem.goto(0.2)
        steps(other, 4)
        self.assertEqual(bytes_of(problem), bytes_of(other))
        problem.goto(0.27)
        self.assertEqual((problem.time, problem.step_number), (0.27, 6))
        problem.goto(0.27)
        self.assertEqual(problem.step_number, 6)
        for words, time in (("goes forward alone", 0.1), ("goes forward alone", np.nan)):
            with self.assertRaisesRegex(exemplar.UserError, words):
                problem.goto(time)
        static = exemplar.Problem(STATIC)
        static.goto(0.6)
        self.assertEqual((static.time, static.step_number), (0.6, 3))
        with self.assertRaisesRegex(exemplar.UserError, "ends at 1"):
            static.goto(2)

    def test_static_scenes_are_solved_once_more(self):
        problem = exemplar.Problem(STATIC)
        problem.run()
        before = problem.positions.copy()
        self.assertLessEqual(problem.step().iterations, 1)
        np.testing.assert_allclose(problem.positions, before, atol=1e-9)
        self.assertEqual(problem.time, 1)

    def test_lengths_that_are_none(self):
        problem = exemplar.Problem(DYNAMIC)
        for length in 0, -1, np.nan, np.inf, 1e-320:
            with self.subTest(length), self.assertRaisesRegex(exemplar.UserError, "step of"):
                problem.step(0.05)
                problem.step(length)
        with self.assertRaisesRegex(TypeError, "dt must be a number, but is a str"):
            problem.step("long")
        with self.assertRaisesRegex(TypeError, "step is called as step\\(dt=None\\)"):
            problem.step(1, 2)
        with self.assertRaisesRegex(exemplar.UserError, "beyond t = 1"):
            exemplar.Problem(STATIC).step(1.5)

    def test_prescribed_weights_are_checked_at_other_times(self):
        problem = exemplar.Problem(scene(Examples={"Include rest pose": True, "Weights": "prescribed", "Prescribed weights": ["1-t", "t + 0.1*sin(20*pi*t)^2"]}))
        problem.step()
        before = problem.state
        with self.assertRaisesRegex(exemplar.UserError, "sum to 1.1.* at t = 0.075"):
            problem.step(0.025)
        self.assertEqual(problem.state, before)

    def test_a_failed_step_leaves_the_state(self):
        problem = exemplar.Problem(scene(STATIC, Solver={"Maximum iterations": 1, "Method": "fixed point"}))
        state = problem.state
        with self.assertRaises(exemplar.SolverFailure):
            problem.step(0.9)
        self.assertEqual(problem.state, state)

    def test_warnings_at_the_end_are_told_once(self):
        crushed = scene(STATIC, Handles={"right": {"Select": "boundary 2", "Motion": ["-2.6*t", 0, 0]}}, Time={"Increments": 10})
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            problem = exemplar.Problem(crushed)
            problem.run()
            told = list(problem.warnings)
            problem.step()
        self.assertEqual(problem.warnings, told)

    def test_another_thread_is_refused_meanwhile(self):
        problem = exemplar.Problem(DYNAMIC)
        told = []

        def look():
            try:
                problem.reset()
            except RuntimeError as error:
                told.append(str(error))

        def within(report):
            thread = threading.Thread(target=look)
            thread.start()
            thread.join()
        problem.on_iteration(within)
        problem.step()
        self.assertRegex(told[0], "reset\\(\\) must wait")


if __name__ == "__main__":
    unittest.main()
