# SPDX-License-Identifier: GPL-3.0-or-later
"""Gradients through steps, against differences of steps."""
import copy
import gc
import itertools
import pickle
import unittest
import warnings
import weakref

import numpy as np

import exemplar

from test_gradients import bar, edges_of, poses_of, with_middles
from test_gradients_of_laws import FIBRES, ORTHOTROPY

SCENE = {"Scene": "dynamic", "Time": {"Step": 0.02, "End": 0.3},
         "Handles": {"left": {"Select": "box -0.3 -1 -1 0.3 2 2"}, "right": {"Select": "box 2.7 -1 -1 3.3 2 2"}},
         "Material": {"Young's modulus": 1e5, "Poisson's ratio": 0.4, "Density": 900}, "Loads": {"Gravity": [0.5, -1, -3]},
         "Examples": {"Importance": 0.7, "Weights": "simplex"}, "Solver": {"Tolerance": 1e-12, "Method": "newton"}}
DAMPED = {"Mass damping": 0.4, "Stiffness damping": 0.01}
# as the scene says, and of other lengths
LENGTHS = [None] * 4 + [0.02, 0.012, 0.02, 0.027] + [None] * 6 + [0.015, 0.02] + [None] * 4
random = np.random.default_rng(7)

MESH = bar((3, 1, 1), random)
NODES, CELLS, _ = MESH
X, Y, Z = NODES.T
POSES = poses_of(NODES)
EDGES = edges_of(CELLS)
GOALS = np.where(X > 2.7, 1, 0)[:, None] * ([0.25, 0.05, 0.2] + 0.12 * np.stack([0 * X, Z - 0.5, 0.5 - Y], axis=1))
MATERIAL = {"young": 1e5 * random.uniform(0.7, 1.3, len(CELLS)), "poisson": random.uniform(0.35, 0.42, len(CELLS)),
            "density": 900 * random.uniform(0.7, 1.3, len(CELLS))}
ALL = with_middles(NODES, EDGES)
STARTS = ALL + 0.01 * random.normal(size=ALL.shape)
START = STARTS[:len(NODES)]
VELOCITIES = 0.2 * random.normal(size=ALL.shape)
BY_POSITIONS, BY_VELOCITIES = random.normal(size=(2, len(LENGTHS), *NODES.shape))


def scene(base=SCENE, **sections):
    return {**base, **{name: {**base.get(name, {}), **keys} for name, keys in sections.items()}}


def is_quadratic(base):
    return base.get("Model", {}).get("Element") == "P2"


def nodes_of(base, of_vertices):
    """With the middles of edges, where there are any."""
    return with_middles(of_vertices, EDGES) if is_quadratic(base) else of_vertices


def recorded(base, shift=0, moved=0, mesh=MESH, poses=POSES, goals=GOALS, material=None, start=STARTS, velocities=VELOCITIES,
             lengths=LENGTHS, **attributes):
    """(problem, trajectory) of the scene with held nodes shifted, also ever farther, and with these attributes of the problem."""
    problem = exemplar.Problem(base, mesh=mesh, poses=poses)
    constants = {**MATERIAL, **(material or {})}
    problem.set_material(**{name: constants[name] for name in constants if name == "density" or not base["Material"].get("Orthotropy")})
    places, ways = nodes_of(base, NODES), nodes_of(base, goals)
    x = places[:, 0]

    def path(t):
        return places + ways * np.sin(4 * t) + shift + moved * t
    problem.set_motion("left", lambda rest, t: path(t)[x < 0.3] - rest)
    problem.set_motion("right", lambda rest, t: path(t)[x > 2.7] - rest)
    for name, value in attributes.items():
        setattr(problem, name, value)
    if start is not None and base["Scene"] == "dynamic":
        problem.state = problem.state.replace(positions=start[:len(places)], velocities=velocities[:len(places)])
    with problem.record() as trajectory:
        for length in lengths:
            problem.step(length)
    return problem, trajectory


class Case:
    """Steps, a function of them, and what both depend on."""

    def __init__(self, base, lengths=LENGTHS, **changes):
        self.base, self.changes, self.are_at_bounds = base, {"lengths": lengths, **changes}, set()
        self.is_quadratic, self.is_dynamic, n = is_quadratic(base), base["Scene"] == "dynamic", len(lengths)
        self.problem, self.trajectory = recorded(base, **self.changes)
        self.by_weights = random.normal(size=(n, len(self.problem.weights)))
        self.found = self.trajectory.vjp(list(BY_POSITIONS[:n]), self.by_weights, BY_VELOCITIES[:n] if self.is_dynamic else None)

    def value(self, **changes):
        trajectory = recorded(self.base, **{**self.changes, **changes})[1]
        n = len(trajectory)
        self.are_at_bounds.add((np.array(trajectory.weights) == 0).tobytes())
        return ((BY_POSITIONS[:n] * trajectory.positions).sum() + (self.by_weights * trajectory.weights).sum()
                + ((BY_VELOCITIES[:n] * trajectory.velocities).sum() if self.is_dynamic else 0))

    def difference(self, function, at, direction):
        """Over so small a change that the same weights are at their bounds in all steps, as elsewhere J has kinks."""
        for step in 5e-4, 2e-4, 1e-4, 3e-5, 1e-5, 3e-6:
            self.are_at_bounds = {(np.array(self.trajectory.weights) == 0).tobytes()}
            found = difference(function, at, direction, step)
            if len(self.are_at_bounds) == 1:
                return found
        raise AssertionError("there is a kink nearby")

    def parameters(self):
        """{name: (value, size of its changes, function of a value)}"""
        def material(name):
            return MATERIAL[name], MATERIAL[name].mean(), lambda value: self.value(material={name: value})

        def attribute(name, value, size):
            return np.array(value), size, lambda changed: self.value(**{name: changed})
        poses, places = np.array(self.changes.get("poses", POSES)), nodes_of(self.base, NODES)
        n = len(places)
        every = {"young": material("young"), "poisson": material("poisson"), "density": material("density"),
                 "importance": attribute("importance", self.problem.importance, 1), "gravity": attribute("gravity", [0.5, -1, -3], 1),
                 "nodal_forces": attribute("nodal_forces", 0 * places, 1e3), "handles": attribute("shift", 0 * places, 0.5),
                 "handles_of_steps": attribute("moved", 0 * places, 1),
                 "poses": (poses, 0.2, lambda value: self.value(poses=list(value))),
                 "rest_positions": (NODES, 0.2, lambda value: self.value(mesh=(value, *MESH[1:])))}
        if self.is_dynamic:
            every |= {"mass_damping": attribute("mass_damping", self.problem.mass_damping, 1),
                      "stiffness_damping": attribute("stiffness_damping", self.problem.stiffness_damping, 0.02),
                      "initial_positions": attribute("start", STARTS[:n], 0.2), "initial_velocities": attribute("velocities", VELOCITIES[:n], 1)}
        return {name: parameter for name, parameter in every.items() if name in self.found}

    def direction(self, name):
        """Of a change, at random."""
        at, size, _ = self.parameters()[name]
        signs = 1 if name.endswith("damping") else random.choice([-1, 1], at.shape)
        return size * random.uniform(0.5, 1, at.shape) * signs

    def derivative(self, name, direction):
        return np.sum(self.contributions(name, direction))

    def contributions(self, name, direction):
        """Those of single numbers to the derivative along a direction."""
        if name == "poses":
            return np.array([found * nodes_of(self.base, moved) for found, moved in zip(self.found[name], direction)])
        if name == "handles_of_steps":
            moved = direction[self.found["held_nodes"]]
            return np.array([by_handles * moved * t for by_handles, t in zip(self.found[name], self.trajectory.times)])
        return np.array(self.found[name]) * direction


def difference(function, at, direction, step=5e-4):
    """Of fourth order; of what must not be negative, to one side alone."""
    if np.all(direction >= 0) and np.all(at == 0):
        values = [function(at + s * step * direction) for s in range(5)]
        return np.dot(values, [-25, 48, -36, 16, -3]) / (12 * step)
    values = [function(at + s * step * direction) for s in (-2, -1, 1, 2)]
    return np.dot(values, [1, -8, 8, -1]) / (12 * step)


RULES = {"simplex": {"Weights": "simplex"}, "free": {"Weights": "free"},
         "prescribed": {"Weights": "prescribed", "Prescribed weights": "0.1+t; 0.2; 0.3-t; 0.4"},
         "per region": {"Weights": "simplex", "Weights per region": True}, "additive": {"Weights": "additive"}}


class Differences(unittest.TestCase):
    def check(self, base, **of_case):
        case = Case(base, **of_case)
        x = nodes_of(base, NODES)[:, 0]
        self.assertEqual(case.found["weakly_active"], [])
        self.assertFalse(np.any(case.found["handles"][(x >= 0.3) & (x <= 2.7)]))
        for name, (at, _, function) in case.parameters().items():
            direction = case.direction(name)
            expected, found = case.difference(function, at, direction), case.derivative(name, direction)
            # along a direction in which the contributions happen to cancel, what they mostly sum to
            size = max(abs(expected), np.linalg.norm(case.contributions(name, direction)))
            with self.subTest(name):
                self.assertLess(abs(found - expected), 1e-6 * size, (found, expected, size))
        return case

    def check_rules(self, damping):
        """A quarter of all combinations; doc/scripts/measure_gradients.py has the others, too."""
        n_at_bounds = 0
        every = itertools.product(["implicit euler", "bdf2"], ["cells", "patches"], RULES.items(), ["scaled", "blended"])
        places = itertools.product(*map(range, (2, 2, len(RULES), 2)))
        for scheme, dilatation, (name, rule), energy in (one for one, place in zip(every, places) if sum(place) % 4 == 2 * bool(damping)):
            with self.subTest(f"{scheme}, {dilatation}, {name}, {energy}"):
                case = self.check(scene(Time={"Scheme": scheme, **damping}, Model={"Dilatation": dilatation},
                                        Examples={**rule, "Energy": energy}))
                n_at_bounds += np.count_nonzero(np.array(case.trajectory.weights) == 0)
        self.assertGreater(n_at_bounds, 10)

    def test_undamped(self):
        self.check_rules({})

    def test_damped(self):
        self.check_rules(DAMPED)

    def test_lumped_mass_mixed_energy_and_other_solvers(self):
        self.check(scene(Material={"Mass matrix": "lumped"}, Examples={"Energy": "mixed"}, Time=DAMPED))
        self.check(scene(Solver={"Method": "quasi newton", "Step tolerance": 1e-12}, Time=DAMPED))

    def test_the_last_step_of_the_scene_is_shorter(self):
        base = scene(Time={"Scheme": "bdf2", "End": 0.07})
        by_end = [None, None, None, BY_POSITIONS[0]]
        found = recorded(base, lengths=4 * [None])[1].vjp(by_end)["young"]
        direction = MATERIAL["young"] * random.uniform(-1, 1, len(CELLS))

        def value(young):
            problem, trajectory = recorded(base, lengths=4 * [None], material={"young": young})
            self.assertAlmostEqual(problem.time, 0.07)
            return (BY_POSITIONS[0] * trajectory.positions[-1]).sum()
        expected = difference(value, MATERIAL["young"], direction)
        self.assertLess(abs(found @ direction - expected), 1e-6 * abs(expected))

    def test_increments_of_a_static_scene(self):
        base = scene({**SCENE, "Scene": "static", "Time": {"Increments": 3}}, Loads={"Ramp": "increments"}, Solver={"Method": "auto"})
        by_weights = random.normal(size=(3, 4))
        problem, trajectory = recorded(base, start=None, lengths=3 * [None])
        found = trajectory.vjp(list(BY_POSITIONS[:3]), list(by_weights))
        self.assertFalse({"mass_damping", "stiffness_damping", "initial_positions", "initial_velocities"} & set(found))
        np.testing.assert_allclose(trajectory.vjp([None, None, BY_POSITIONS[2]])["young"], problem.vjp(BY_POSITIONS[2])["young"],
                                   rtol=1e-9, atol=1e-14)

        def value(**changes):
            trajectory = recorded(base, start=None, lengths=3 * [None], **changes)[1]
            return (BY_POSITIONS[:3] * trajectory.positions).sum() + (by_weights * trajectory.weights).sum()
        for name, at, size, function in [("young", MATERIAL["young"], 1e5, lambda young: value(material={"young": young})),
                                         ("nodal_forces", 0 * NODES, 1e3, lambda forces: value(nodal_forces=forces))]:
            direction = size * random.uniform(-1, 1, at.shape)
            expected = difference(function, at, direction)
            with self.subTest(name):
                self.assertLess(abs((found[name] * direction).sum() - expected), 1e-6 * abs(expected))


class Answers(unittest.TestCase):
    def test_what_is_recorded(self):
        problem, trajectory = recorded(SCENE)
        self.assertEqual(len(trajectory), len(LENGTHS))
        self.assertEqual(trajectory.times[-1], problem.time)
        np.testing.assert_array_equal(trajectory.positions[-1], problem.positions)
        np.testing.assert_array_equal(trajectory.velocities[-1], problem.velocities)
        np.testing.assert_array_equal(trajectory.weights[-1], problem.weights)
        last = trajectory.positions[-1]
        problem.step()
        self.assertEqual(len(trajectory), len(LENGTHS))
        del trajectory
        gc.collect()
        self.assertEqual(last.shape, NODES.shape)  # it keeps its memory
        self.assertFalse(last.flags.writeable)

    def test_problem_stays(self):
        """Steps after vjp() are the same bytes as without it, and the same question gets the same answer."""
        for kind in (scene(Solver={"Method": "quasi newton", "Tolerance": 1e-8}, Time=DAMPED), scene(Time={"Scheme": "bdf2"}),
                     scene({**SCENE, "Scene": "static", "Time": {"Increments": 30}}), scene(Model={"Dilatation": "patches"})):
            is_static = kind["Scene"] == "static"
            (asked, trajectory), (other, _) = (recorded(kind, start=None if is_static else START, lengths=5 * [None]) for _ in range(2))
            shown = asked.positions
            numbers = asked.statistics
            by_positions = list(BY_POSITIONS[:5])
            first, second = trajectory.vjp(by_positions), trajectory.vjp(by_positions, 5 * [None])
            np.testing.assert_array_equal(first["young"], second["young"])
            self.assertEqual(asked.statistics, numbers)
            np.testing.assert_array_equal(shown, other.positions)
            for _ in range(5):
                asked.step()
                other.step()
                self.assertEqual(asked.positions.tobytes(), other.positions.tobytes())
                self.assertEqual(asked.statistics, other.statistics)

    def test_functions_of_weights_alone(self):
        """Their gradients and those of positions add up to those of both."""
        problem, trajectory = recorded(SCENE)
        by_weights = [np.linspace(-1, 1, len(problem.weights))] * len(trajectory)
        both, of_positions, of_weights = (trajectory.vjp(*by) for by in (
            (list(BY_POSITIONS), by_weights), (list(BY_POSITIONS),), ([None] * len(trajectory), by_weights)))
        for key in "young", "initial_positions", "handles":
            self.assertGreater(np.abs(of_weights[key]).max(), 0)
            np.testing.assert_allclose(of_positions[key] + of_weights[key], both[key], atol=1e-7 * np.abs(both[key]).max())

    def test_steps_on_which_nothing_depends(self):
        _, trajectory = recorded(SCENE, lengths=3 * [None])
        zero = trajectory.vjp(3 * [None])
        self.assertFalse(np.any(zero["young"]) or np.any(zero["initial_positions"]))
        early = trajectory.vjp([BY_POSITIONS[0], None, None])
        _, short = recorded(SCENE, lengths=[None])
        np.testing.assert_array_equal(early["young"], short.vjp([BY_POSITIONS[0]])["young"])

    def test_steps_that_are_solved_roughly(self):
        """A gradient is as good as the steps."""
        def young(tolerance):
            base = scene(Solver={"Method": "quasi newton", "Tolerance": 1e-8, "Step tolerance": tolerance})
            return recorded(base)[1].vjp(list(BY_POSITIONS))["young"]
        exact = young(1e-8)
        self.assertLess(np.linalg.norm(young(1e-3) - exact), 0.02 * np.linalg.norm(exact))

    def test_memory_is_freed(self):
        problem, trajectory = recorded(SCENE, lengths=[None])
        references = [weakref.ref(problem), weakref.ref(trajectory)] if hasattr(trajectory, "__weakref__") else [weakref.ref(problem)]
        trajectory.vjp([BY_POSITIONS[0]])
        del problem
        self.assertEqual(trajectory.positions[0].shape, NODES.shape)
        del trajectory
        gc.collect()
        self.assertEqual([reference() for reference in references], [None] * len(references))

    def test_a_trajectory_that_is_dropped_records_no_more(self):
        problem, _ = recorded(SCENE, lengths=[None])
        trajectory = problem.record()
        trajectory.__enter__()
        with self.assertRaisesRegex(exemplar.UserError, "is being recorded"):
            with problem.record():
                pass
        del trajectory
        problem.step()
        with problem.record() as other:
            problem.step()
        self.assertEqual(len(other), 1)


class Refusals(unittest.TestCase):
    def refuse(self, message, base=SCENE, within=None, after=None, ask=None, lengths=(None, None)):
        problem, _ = recorded(base, lengths=[None], start=None)
        trajectory = problem.record()
        with self.assertRaisesRegex(exemplar.UserError, message):
            with trajectory:
                for length in lengths:
                    problem.step(length)
                    if within is not None:
                        within(problem)
            if after is not None:
                after(problem)
            (ask or (lambda steps: steps.vjp(len(steps) * [None])))(trajectory)

    def test_changes(self):
        changes = {r"set_material\(\)": lambda problem: problem.set_material(young=2e5),
                   "importance": lambda problem: setattr(problem, "importance", 0.3),
                   "gravity": lambda problem: setattr(problem, "gravity", [0, 0, 1]),
                   "nodal_forces": lambda problem: setattr(problem, "nodal_forces", 0 * NODES),
                   r"set_pose\(\)": lambda problem: problem.set_pose(1, POSES[1]),
                   "mass_damping": lambda problem: setattr(problem, "mass_damping", 0.1),
                   "let_go": lambda problem: problem.let_go("left")}
        for name, change in changes.items():
            with self.subTest(name):
                self.refuse("^(mass_damping|" + name + ".*): the problem is being recorded", within=change)
                self.refuse("since it was recorded the problem was changed by .*" + name, after=change)
        self.refuse(r"^reset\(\): the problem is being recorded", within=lambda problem: problem.reset())

    def test_scenes(self):
        scenes = {"through steps of one pass": scene(Solver={"Method": "one pass"}),
                  "cells that are frozen": scene(Model={"Gradient": "frozen"}, Solver={"Method": "fixed point", "Tolerance": 1e-4}),
                  "plastic": scene(Material={"Yield stress": 1e4}, Examples={"Energy": "blended"}),
                  "weights that remember": scene(Examples={"Yield": 1e-3})}
        for message, base in scenes.items():
            with self.subTest(message), self.assertRaisesRegex(exemplar.UserError, message):
                exemplar.Problem(base, mesh=MESH, poses=POSES).record()
        with self.assertRaisesRegex(exemplar.UserError, "interpolations"):
            exemplar.Problem({"Scene": "interpolation", "Examples": {"Prescribed weights": "1-t; t; 0; 0"}}, mesh=MESH, poses=POSES).record()

    def test_terms_of_ones_own(self):
        problem = exemplar.Problem(SCENE, mesh=MESH, poses=POSES)
        problem.add_term(lambda x, t: (0., 0 * x, None))
        with self.assertRaisesRegex(exemplar.UserError, "terms that were added"):
            problem.record()

    def test_no_steps(self):
        self.refuse("no step was recorded", lengths=(), ask=lambda steps: steps.vjp([]))

    def test_one_recording_each(self):
        problem, _ = recorded(SCENE, lengths=[None])
        trajectory = problem.record()
        with trajectory:
            problem.step()
            with self.assertRaisesRegex(exemplar.UserError, "being recorded"):
                problem.record().__enter__()
            problem.record().__exit__(None, None, None)  # of one that never began
            problem.step()
        self.assertEqual(len(trajectory), 2)
        with self.assertRaisesRegex(exemplar.UserError, "has its steps"):
            trajectory.__enter__()

    def test_lost_history(self):
        def same_positions(problem):
            problem.state = problem.state.replace(positions=problem.positions)
        self.refuse("^state: the problem is being recorded", scene(Time={"Step": 0.02, "End": 0.3, "Scheme": "bdf2"}), within=same_positions, lengths=4 * [None])

    def test_derivatives_beyond_numbers(self):
        _, trajectory = recorded(SCENE, lengths=[None])
        with self.assertRaisesRegex(exemplar.SolverFailure, "Scale J"):
            trajectory.vjp([1e308 * np.sign(BY_POSITIONS[0])])

    def test_arguments(self):
        self.refuse(r"dJ_dx has 3 entries, but 2 steps", ask=lambda steps: steps.vjp(3 * [None]))
        self.refuse(r"dJ_dx\[1\]", ask=lambda steps: steps.vjp([None, np.zeros(3)]))
        self.refuse(r"dJ_dw\[0\] must", ask=lambda steps: steps.vjp([None, None], [np.zeros(7), None]))
        self.refuse(r"dJ_dv must be a list", ask=lambda steps: steps.vjp([None, None], None, 3))
        self.refuse(r"dJ_dv must be None", base={**SCENE, "Scene": "static", "Time": {"Increments": 3}},
                    ask=lambda steps: steps.vjp(2 * [None], None, 2 * [None]))
        problem, trajectory = recorded(SCENE, lengths=[None])
        with self.assertRaisesRegex(exemplar.UserError, "Nothing is recorded"):
            problem.record().vjp([])
        with self.assertRaisesRegex(TypeError, "vjp is called"):
            trajectory.vjp()
        for copied in pickle.dumps, copy.copy:
            with self.assertRaisesRegex(TypeError, "Trajectory"):
                copied(trajectory)


if __name__ == "__main__":
    warnings.filterwarnings("ignore", "Handles/")  # shifted ones jump in the first step
    unittest.main()
