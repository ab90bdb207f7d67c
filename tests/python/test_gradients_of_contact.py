# SPDX-License-Identifier: GPL-3.0-or-later
"""Gradients of bodies that meet obstacles, against differences of equilibria and of steps."""
import pathlib
import struct
import tempfile
import unittest

import numpy as np

import exemplar

from test_gradients import bar, difference, edges_of, poses_of, with_middles

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


class RecordedCase:
    """A function of all recorded states: sums of `by_positions` and, in dynamic scenes, `by_velocities`; `found` is its gradient. made() makes
    a problem and its trajectory with other values."""

    def value(self, **changes):
        trajectory = self.made(**changes)[1]
        return (self.by_positions * trajectory.positions).sum() + ((self.by_velocities * trajectory.velocities).sum() if self.is_dynamic else 0)

    def by_rest_positions(self, edges):
        """Of a body that begins at rest, with handles that are moved from there."""
        if "rest_positions" not in self.found:
            return None
        result = self.found["rest_positions"].copy()
        follow = self.found["handles"] + self.found.get("initial_positions", 0)
        result += follow[:len(result)]
        for middle, ends in zip(follow[len(result):], edges):
            result[ends] += 0.5 * middle
        return result


class Case(RecordedCase):
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

    def gradient(self, name):
        """By what value() depends on; None: it is not known."""
        if name in ("displacement", "radius", "friction"):
            return self.found["obstacles"]["it"].get(name)
        if name == "handles":
            return self.found["handles"].sum(axis=0)
        return self.by_rest_positions(EDGES) if name == "rest_positions" else self.found.get(name)


class AgainstDifferences:
    def check(self, case):
        self.assertGreater(np.abs(case.problem.contact_forces).max(), 0)
        for name, at in case.values.items():
            if name == "initial_positions" and name not in case.found:
                continue  # of a static scene without friction
            direction = SIZES[name] * random.uniform(0.5, 1, at.shape) * random.choice([-1, 1], at.shape)
            if name == "initial_positions" and not case.is_dynamic:
                direction = direction * (case.problem.state.positions[:, :1] > 0.4)  # others are held
            contributions = case.gradient(name) * direction
            found, errors = np.sum(contributions), []
            for step in 2e-4, 3e-5, 5e-6:  # until no other part of the body is the nearest
                expected = difference(lambda value, name=name: case.value(**{name: value}), at, direction, step)
                # along a direction in which the contributions happen to cancel, what they mostly sum to
                errors.append(abs(found - expected) / max(abs(expected), np.linalg.norm(contributions)))
                if errors[-1] < 1e-6:
                    break
            with self.subTest(name):
                self.assertLess(errors[-1], 1e-6, (found, expected, errors))


class Differences(AgainstDifferences, unittest.TestCase):
    def check_shapes(self, names, base, **of_case):
        for name in names:
            with self.subTest(name):
                self.check(Case(base, SHAPES[name], **of_case, **({"moves": False} if name in EDGED else {})))

    def test_equilibria(self):
        self.check_shapes(SHAPES, STATIC)

    def test_steps(self):
        self.check_shapes(["sphere", "box", "surface"], DYNAMIC)

    def test_friction_in_equilibria(self):
        self.check_shapes(["plane", "capsule", "surface"], scene(STATIC, Loads={"Ramp": "increments"}), friction=0.4)

    def test_friction_in_steps(self):
        self.check_shapes(SHAPES, DYNAMIC, friction=0.4)

    def test_obstacles_that_move(self):
        moving = {"it": {"Motion": "0.5*t; 0.2*t; 0.3*t", "Turn": "0.5*t; 3*t; t"}}
        self.check_shapes(["sphere", "surface"], scene(DYNAMIC, Obstacles=moving), friction=0.4)

    def test_pairs_that_begin_near_and_keep_their_widths(self):
        self.check_shapes(["plane", "capsule", "surface"], DYNAMIC, distance=0.3)
        self.check_shapes(["sphere"], DYNAMIC, distance=0.3, friction=0.4)

    def test_quadratic_elements_and_bdf2(self):
        for base in STATIC, scene(DYNAMIC, Time={"Scheme": "bdf2"}):
            with self.subTest(str(base)):
                self.check(Case(scene(base, Model={"Element": "P2"}), SHAPES["sphere"], distance=0.15, friction=0.4, moves=False))

    def test_edges_almost_parallel(self):
        along = Shape("capsule", (2.7, -0.02, LOW - 0.47), (0.4, 0, LOW - 0.48), radius=0.4)
        straight = np.round(NODES * [4 / 3, 2, 2]) / [4 / 3, 2, 2]
        self.check(Case(DYNAMIC, along, distance=0.3, rest_positions=straight + 0.1 * (NODES - straight)))


    def test_examples_beside_friction(self):
        sphere = {"Shape": SHAPES["sphere"].text(np.zeros(3), 0.8), "Friction": 0.4}
        base = scene(DYNAMIC, Obstacles={"Distance": 0.1, **RUBS, "it": sphere}, Material={"Young's modulus": 1e5},
                     Examples={"Importance": 0.7, "Weights": "simplex"})
        by_positions, by_weights = random.normal(size=NODES.shape), random.normal(size=4)

        def recorded(importance=0.7):
            problem = exemplar.Problem(base, mesh=(NODES, CELLS, IDS), poses=poses_of(NODES))
            problem.importance = importance
            with problem.record() as trajectory:
                for _ in range(5):
                    problem.step()
            return problem, trajectory

        def value(importance):
            problem, _ = recorded(importance)
            return (by_positions * problem.positions).sum() + by_weights @ problem.weights
        found = recorded()[1].vjp(4 * [None] + [by_positions], 4 * [None] + [by_weights])["importance"]
        expected = difference(value, 0.7, 1, 1e-4)
        self.assertLess(abs(found - expected), 1e-6 * abs(expected), (found, expected))


class AtTheDefaultSlipSpeed(unittest.TestCase):
    """Cubes of 0.08 m that begin on a floor, and one that two boxes grip and lift: gradients by friction and by the modulus of each cell."""
    KEYS = {"Scene": "dynamic", "Mesh": {"Generator": "box", "Box size": [0.08] * 3, "Box cells": [2] * 3},
            "Material": {"Young's modulus": 2e5, "Poisson's ratio": 0.3}, "Loads": {"Gravity": [0, 0, -9.81]},
            "Solver": {"Tolerance": 1e-12, "Step tolerance": 1e-11}}

    def states(self, base, friction=0.4, young=0.):
        boxes = {name: {**of, "Friction": friction} for name, of in base["Obstacles"].items()}
        problem = exemplar.Problem(scene(base, Obstacles={"Names": ", ".join(boxes), "Lag tolerance": 1e-10, **boxes}))
        problem.set_material(young=problem.young + young)
        settled = []
        with problem.record() as trajectory:
            for _ in range(self.n_steps):
                problem.step()
                settled.append(problem.friction_settled)
        self.assertTrue(all(settled), settled)
        return trajectory

    def check(self, base, by_positions):
        trajectory = self.states(base)
        found = trajectory.vjp([None] * (self.n_steps - 1) + [by_positions])
        value = lambda **changes: (by_positions * self.states(base, **changes).positions[-1]).sum()
        along = np.random.default_rng(5).uniform(-2e4, 2e4, len(found["young"]))
        of_friction = np.array([0.4 * found["obstacles"][one]["friction"] for one in base["Obstacles"]])
        for name, parts, at, direction in (("friction", of_friction, 0.4, 0.4), ("young", found["young"] * along, 0 * along, along)):
            errors = []
            for step in 2e-3, 5e-2, 1e-2, 3e-4, 4e-5:
                expected = difference(lambda x, name=name: value(**{name: x}), at, direction, step)
                errors.append(abs(parts.sum() - expected) / max(abs(expected), np.linalg.norm(parts)))
                if errors[-1] < 1e-6:
                    break
            with self.subTest(by=name):
                self.assertLess(min(errors), 1e-6, (parts.sum(), expected, errors))

    def test_what_begins_on_the_floor(self):
        """The mean place of a cube that slides depends on forces that are far smaller than those of barriers, which friction feels."""
        self.n_steps = 8
        for method, speed, slope in (("newton", 1.2, 0), ("quasi newton", 0, 5), ("newton", 0, 1)):
            with self.subTest(method, speed=speed, slope=slope):
                base = scene(self.KEYS, Initial={"Velocity": f"{speed}; 0; 0"}, Loads={"Gravity": [slope, 0, -9.81]}, Solver={"Method": method},
                             Time={"Step": 0.004, "End": 1}, Obstacles={"floor": {"Shape": "plane 0 0 -0.04 0 0 1"}})
                self.check(base, np.tile([1 / 27, 0, 0], (27, 1)))

    def test_what_is_gripped_and_lifted(self):
        self.n_steps = 20
        way, lift = "0.005*min(t/0.06,1)", "0.15*max(t-0.06,0)"
        boxes = {"left": {"Shape": "box -0.2 -0.1 -0.1  -0.0004 0.1 0.2", "Motion": f"{way}; 0; {lift}"},
                 "right": {"Shape": "box 0.0804 -0.1 -0.1  0.3 0.1 0.2", "Motion": f"-{way}; 0; {lift}"}}
        base = scene(self.KEYS, Time={"Step": 0.01, "End": 1}, Obstacles=boxes)
        self.check(base, np.random.default_rng(6).normal(size=(27, 3)))


class Answers(unittest.TestCase):
    def test_one_equilibrium(self):
        """problem.vjp() and the trajectory's are the same."""
        case = Case(STATIC, SHAPES["sphere"])
        by_positions = case.by_positions[-1]
        of_steps, alone = case.trajectory.vjp([None] * 3 + [by_positions]), case.problem.vjp(by_positions)
        for name in "young", "rest_positions", "handles":
            np.testing.assert_allclose(of_steps[name], alone[name], rtol=1e-9, atol=1e-9 * np.abs(alone[name]).max())
        self.assertEqual(set(alone["obstacles"]["it"]), {"displacement", "radius"})
        self.assertLess(abs(case.problem.correction(by_positions)), 1e-9)

    def test_what_is_set_back_has_no_derivative_by_its_place(self):
        case = Case(scene(DYNAMIC, Solver={"Tolerance": 1e-11}), Shape("plane", (0, 0, LOW), more=(0, 0, 1)), friction=0.4)
        self.assertEqual(set(case.found["obstacles"]["it"]), {"friction"})
        self.assertNotIn("rest_positions", case.found)
        self.assertIn("young", case.found)

    def test_problem_stays(self):
        """Steps after vjp() are the same bytes as without it, and so are forces."""
        for base in DYNAMIC, scene(STATIC, Time={"Increments": 20}), scene(DYNAMIC, Solver={"Method": "quasi newton", "Tolerance": 1e-9}):
            case = Case(base, SHAPES["capsule"], friction=0.4)
            asked, other = case.problem, case.made()[0]
            for _ in range(5):
                self.assertEqual(asked.contact_forces.tobytes(), other.contact_forces.tobytes())
                self.assertEqual(asked.positions.tobytes(), other.positions.tobytes())
                self.assertEqual(asked.statistics, other.statistics)
                asked.step()
                other.step()


class Refusals(unittest.TestCase):
    def refuse(self, message, base=DYNAMIC, **obstacle):
        of_all = {key: obstacle.pop(key) for key in ("Lag tolerance",) if key in obstacle}
        it = {"Shape": SHAPES["plane"].text(np.zeros(3), None), **obstacle}
        problem = exemplar.Problem(scene(base, Obstacles={"Distance": 0.08, **of_all, "it": it}), mesh=(NODES, CELLS, IDS))
        with self.assertRaisesRegex(exemplar.UserError, message):
            problem.record()
        return problem

    def test_by_name(self):
        self.refuse("beside obstacles that come or go, as Obstacles/it does yet. Leave out its From and Until", Until=0.05)
        self.refuse("of friction whose normal forces are not those of the step's end yet. Set Obstacles/Lag tolerance", Friction=0.3)

    def test_friction_on_a_surface_that_a_cache_bends(self):
        surface, cache = SHAPES["surface"].text(np.zeros(3), None), pathlib.Path(directory.name) / "cap.pc2"
        rest = np.loadtxt(surface.split()[1], usecols=(1, 2, 3), max_rows=5)
        samples = np.array([rest, rest + [[0, 0, 0.01]] + 0.01 * np.eye(5, 3)], "<f4")
        cache.write_bytes(struct.pack("<12siiffi", b"POINTCACHE2", 1, 5, 0, 1, 2) + samples.tobytes())
        self.refuse("of friction on a surface whose vertices move by themselves, as those of Obstacles/it yet. Set its Friction to 0, "
                    "or leave out its Follow cache", **{"Shape": surface, "Follow cache": str(cache), "Friction": 0.3, "Lag tolerance": 1e-10})

    def test_friction_of_one_equilibrium(self):
        case = Case(STATIC, SHAPES["plane"], friction=0.2)
        for ask in case.problem.vjp, case.problem.correction:
            with self.assertRaisesRegex(exemplar.UserError, "of single equilibria with friction, .* Record the steps"):
                ask(NODES)

    def test_friction_that_has_not_settled(self):
        """To rounding it does not settle; the tolerance that the message names is one with which it does."""
        def steps(tolerance):
            keys = AtTheDefaultSlipSpeed.KEYS
            problem = exemplar.Problem(scene(keys, Time={"Step": 0.004, "End": 1}, Initial={"Velocity": "1.2; 0; 0"}, Obstacles={
                "Lag tolerance": tolerance, "Names": "floor", "floor": {"Shape": "plane 0 0 -0.04 0 0 1", "Friction": 0.4}}))
            with problem.record() as trajectory:
                settled = [(problem.step(), problem.friction_settled)[1] for _ in range(6)]
            return settled, lambda: trajectory.vjp([None] * 5 + [problem.positions])
        settled, vjp = steps(1e-14)
        self.assertIn(False, settled)
        with self.assertRaisesRegex(exemplar.UserError, f"friction had not settled in {settled.count(False)} of 6 steps, first in step "
                                    f"{settled.index(False)}, counted from 0, .* Set Obstacles/Lag tolerance to 1e-10 or more"):
            vjp()
        settled, vjp = steps(1e-10)
        self.assertTrue(all(settled))
        vjp()


if __name__ == "__main__":
    unittest.main()
