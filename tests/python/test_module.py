# SPDX-License-Identifier: GPL-3.0-or-later
"""Drive the Python module: arrays, errors, motions, views, callbacks, threads."""
import gc
import os
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import unittest
import warnings
import weakref
from pathlib import Path

import numpy as np

import exemplar

HANDLES = {"left": {"Select": "box 0 -1 -1 0 1 1"},
           "right": {"Select": ["box", 2, -1, -1, 2, 1, 1], "Motion": ["0.2*t", 0, "0.3*t"]}}
BAR = {"Scene": "static", "Mesh": {"Generator": "box", "Box size": [2, 1, 1], "Box cells": (4, 2, 2)},
       "Handles": HANDLES, "Time": {"Increments": 3}}
DYNAMIC = {**BAR, "Scene": "dynamic", "Time": {"Step": 0.05, "End": 0.3}}


class Meshio:
    """As meshio's meshes."""
    points = cells_dict = None


def with_nan(nodes):
    return np.where(np.arange(nodes.size).reshape(nodes.shape) == 10, np.nan, nodes)


def without_mesh(scene):
    return {key: value for key, value in scene.items() if key != "Mesh"}


def box():
    problem = exemplar.Problem(BAR)
    return problem.rest_positions.copy(), problem.cells.copy()


def twisted(nodes):
    x, y, z = nodes.T
    return np.column_stack([x, y + 0.2 * x * z, z - 0.2 * x * y])


def solved(*arguments, **options):
    problem = exemplar.Problem(*arguments, **options)
    problem.run()
    return problem


def write_msh(file, nodes, cells):
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", len(nodes)]
    lines += [f"{i + 1} {x!r} {y!r} {z!r}" for i, (x, y, z) in enumerate(nodes.tolist())]
    lines += ["$EndNodes", "$Elements", len(cells)]
    lines += [f"{c + 1} 4 2 0 1 " + " ".join(str(node + 1) for node in cell) for c, cell in enumerate(cells.tolist())]
    Path(file).write_text("\n".join(map(str, [*lines, "$EndElements"])) + "\n")


class Scenes(unittest.TestCase):
    def test_arrays_give_the_bytes_of_files(self):
        nodes, cells = box()
        with tempfile.TemporaryDirectory() as directory:
            mesh, pose = Path(directory, "mesh.msh"), Path(directory, "pose.msh")
            write_msh(mesh, nodes, cells)
            write_msh(pose, twisted(nodes), cells)
            files = solved({**BAR, "Mesh": {"File": mesh}, "Examples": {"Poses": [pose]}})
        arrays = solved(without_mesh(BAR), mesh=(nodes, cells), poses=[twisted(nodes)])
        self.assertEqual(files.positions.tobytes(), arrays.positions.tobytes())
        self.assertEqual(files.weights.tobytes(), arrays.weights.tobytes())
        self.assertAlmostEqual(arrays.weights.sum(), 1)

    def test_text_file_and_dictionary_are_one_scene(self):
        text = ("set Scene = static\nsubsection Mesh\nset Generator = box\nset Box size = 2, 1, 1\n"
                "set Box cells = 4, 2, 2\nend\nsubsection Handles\nset Names = left, right\nsubsection left\n"
                "set Select = box 0 -1 -1 0 1 1\nend\nsubsection right\nset Select = box 2 -1 -1 2 1 1\n"
                "set Motion = 0.2*t; 0; 0.3*t\nend\nend\nsubsection Time\nset Increments = 3\nend\n")
        with tempfile.TemporaryDirectory() as directory:
            file = Path(directory, "bar.prm")
            file.write_text(text)
            from_file, from_path = solved(str(file)), solved(file)
        for problem in solved(text), from_file, from_path:
            self.assertEqual(problem.positions.tobytes(), solved(BAR).positions.tobytes())

    def test_poses_that_formulas_give(self):
        formulas = ["x", "y+0.2*x*z", "z-0.2*x*y"]
        by_formulas = solved({**BAR, "Examples": {"Pose functions": [formulas]}})
        by_array = solved(BAR, poses=[twisted(box()[0])])
        np.testing.assert_allclose(by_formulas.weights, by_array.weights, atol=1e-9)

    def test_weights_by_region_are_lists_of_lists(self):
        nodes, cells = box()
        ids = np.where(np.arange(len(cells)) % 2 == 0, 1, 2)
        by_text, by_lists = ({**without_mesh(BAR), "Examples": {
            "Pose functions": [["x", "y+0.2*x*z", "z-0.2*x*y"]], "Include rest pose": True, "Weights": "prescribed",
            "Weights per region": True, "Prescribed weights": weights}} for weights in ("1-t; t | 1; 0", [["1-t", "t"], [1, 0]]))
        np.testing.assert_array_equal(solved(by_lists, mesh=(nodes, cells, ids)).positions,
                                      solved(by_text, mesh=(nodes, cells, ids)).positions)

    def test_materials_by_cell(self):
        nodes, cells = box()
        soft = {**without_mesh(BAR), "Material": {"region 2": {"Young's modulus": 10}}}
        ids = np.where(np.arange(len(cells)) % 2 == 0, 1, 2)
        self.assertLess(solved(soft, mesh=(nodes, cells, ids)).energies["energy_elastic"],
                        0.9 * solved(BAR).energies["energy_elastic"])

    def test_errors(self):
        nodes, cells = box()
        bare = without_mesh(BAR)
        for message, arguments in {
            "Scene is not set": ({"Mesh": BAR["Mesh"]},),
            "'Szene'. Did you mean 'Scene'": ({"Szene" if key == "Scene" else key: BAR[key] for key in BAR},),
            "Did you mean 'Mesh/Generator'": ({**BAR, "Mehs": {"Generator": "box"}},),
            "nonsense": ({**BAR, "Model": {"Strain": "nonsense"}},),
            "absent.prm": ("absent.prm",),
            "nodes must be an array of shape \\(n, 3\\), but is an array of shape \\(45, 2\\)": (bare, (nodes[:, :2], cells)),
            "real numbers": (bare, (nodes + 1j, cells)),
            "has node 45.*from 0: if these are from 1, subtract 1": (bare, (nodes, cells + 1)),
            "poses must be a list of arrays .*an array of shape \\(45, 3\\)": (bare, (nodes, cells), nodes),
            "is a function.*problem.set_motion": ({**BAR, "Handles": {"left": {"Select": "boundary 1", "Motion": len}}},),
            "no mesh is given": ("set Scene = static",),
            "has node 99": (bare, (nodes, np.array([[0, 1, 2, 99]]))),
            "has -1": (bare, (nodes, np.array([[0, 1, 2, -1]]))),
            "array of integers": (bare, (nodes, cells + 0.5)),
            "mesh must be .* has 1 parts": (bare, (nodes,)),
            "mesh must be .* is a str. A file is named by the scene": (bare, "box.msh"),
            "mesh must be .* is a Meshio. .*mesh.points, mesh.cells_dict\\[\"tetra\"\\]": (bare, Meshio()),
            "nodes must be finite numbers, but row 3, counted from 0, is \\(.*, nan, .*\\)": (bare, (with_nan(nodes), cells)),
            "poses\\[0\\] must be finite numbers, but row 3": (bare, (nodes, cells), [with_nan(nodes)]),
            "poses\\[0\\] must be an array of real numbers, but is an array of object of shape": (bare, (nodes, cells), [np.full((45, 3), None)]),
            "no cell has the nodes \\(counted from 0\\) 45. .*np.unique": (bare, (np.vstack([nodes, [[9, 9, 9]]]), cells)),
            "cells\\[96\\] has the same nodes as cells\\[7\\]": (bare, (nodes, np.vstack([cells, cells[7:8, ::-1]]))),
            "8 nodes a row.*split each": (bare, (nodes, np.hstack([cells, cells]))),
            "10 nodes a row.*cells\\[:, :4\\]": (bare, (nodes, np.hstack([cells, cells, cells[:, :2]]))),
            "boundary id 1 .* has no triangles. Select by box": ({**bare, "Handles": {"left": {"Select": "boundary 1"}}}, (nodes, cells)),
            "scene: Handles holds a dictionary in a list. .*\"Handles\": {\"left\"": ({**BAR, "Handles": [{"Select": "box"}]},),
            "Examples/Poses names files. Arrays are .*poses=": ({**BAR, "Examples": {"Poses": [nodes]}},),
            "Time/Increments is None. Leave the key out": ({**BAR, "Time": {"Increments": None}},),
            "has 3 nodes, the mesh 45": (bare, (nodes, cells), [nodes[:3]]),
            "is a dict. Of a dictionary take its entries: \\(mesh\\[\"nodes\"\\]": (bare, {"nodes": nodes, "cells": cells}),
            "nodes has the shape \\(96, 4\\) and cells \\(45, 3\\): these seem to be exchanged": (bare, (cells, nodes)),
            "cells\\[1\\] has node 3 twice": (bare, (nodes, np.array([[0, 1, 2, 3], [3, 4, 5, 3]]))),
            "poses names a file.*Examples/Poses": (bare, (nodes, cells), "bent.msh"),
            "poses\\[0\\] names a file.*arrays \\(n, 3\\)": (bare, (nodes, cells), [Path("bent.msh")]),
            "Handles is a list of names. .*\"Handles\": {\"left\": {": ({**BAR, "Handles": ["left"]},),
        }.items():
            with self.subTest(message), self.assertRaisesRegex(exemplar.UserError, message):
                exemplar.Problem(*arguments)
        with tempfile.TemporaryDirectory() as directory:
            file = Path(directory, "study.prm")
            file.write_text("set Scene = a.prm\nset Vary = Time/Increments: 1 2\n")
            with self.assertRaisesRegex(exemplar.UserError, "is a study. Run it by: exemplar study .*study.prm. In Python"):
                exemplar.Problem(file)
        with self.assertRaisesRegex(TypeError, "scene must be the path of a .prm file.* but is a list"):
            exemplar.Problem([BAR])
        with self.assertRaises(exemplar.SolverFailure) as caught:
            solved({**BAR, "Solver": {"Method": "fixed point", "Maximum iterations": 1}})
        self.assertIn("Step 1 stopped at its iteration limit", str(caught.exception))
        problem = solved(BAR)
        with self.assertWarnsRegex(UserWarning, "run\\(\\) does nothing: all 3 steps"):
            problem.run()

    def test_arguments(self):
        nodes, cells = box()
        problem = exemplar.Problem(BAR)
        for words, call in (("no argument 'threads'. A problem uses one thread", lambda: exemplar.Problem(BAR, mesh=(nodes, cells), threads=4)),
                            ("no argument 'pose'. Did you mean 'poses'", lambda: exemplar.Problem(BAR, pose=[nodes])),
                            ("got no scene", exemplar.Problem), ("got 4 arguments", lambda: exemplar.Problem(BAR, None, None, nodes)),
                            ("'scene' twice", lambda: exemplar.Problem(BAR, scene=BAR)),
                            ("run\\(\\) takes no argument.*range", lambda: problem.run(5)),
                            ("step is called as step\\(dt=None\\)", lambda: problem.step(0.1, 0.1)),
                            ("set_motion\\(name, function\\)", lambda: problem.set_motion("left")),
                            ("on_iteration\\(function\\)", problem.on_iteration)):
            with self.subTest(words), self.assertRaisesRegex(TypeError, words) as caught:
                call()
            self.assertLess(len(str(caught.exception)), 400)

    def test_displacements_for_a_pose(self):
        nodes, cells = box()
        with self.assertWarnsRegex(UserWarning, "Example 1 .*is it displacements\\? A pose is positions"):
            exemplar.Problem(without_mesh(BAR), (nodes, cells), [twisted(nodes) - nodes])

    def test_shuffled_nodes_of_a_pose(self):
        nodes, cells = box()
        with self.assertWarnsRegex(UserWarning, "inverted cells: .*nodes are in another order than the mesh's"):
            exemplar.Problem(without_mesh(BAR), (nodes, cells), [nodes[np.arange(45) * 7 % 45]])

    def test_unused_nodes_are_left_out_as_the_message_says(self):
        nodes, cells = box()
        nodes = np.vstack([[[9, 9, 9]], nodes])
        used, new = np.unique(cells + 1, return_inverse=True)
        problem = exemplar.Problem(without_mesh(BAR), mesh=(nodes[used], new.reshape(-1, 4)))
        self.assertEqual(problem.warnings, [])
        self.assertEqual(problem.rest_positions.tobytes(), box()[0].tobytes())

    def test_messages_count_cells_from_0(self):
        nodes, cells = box()
        cells[0] = cells[0][[1, 0, 2, 3]]
        with self.assertWarns(UserWarning):
            problem = exemplar.Problem(without_mesh(BAR), mesh=(nodes, cells))
        self.assertEqual(problem.warnings, ["mesh: 1 tetrahedra of negative volume were re-oriented: element 0."])

    def test_whole_numbers_may_be_floats(self):
        self.assertEqual(exemplar.Problem({**BAR, "Time": {"Increments": 2.0}}).n_steps, 2)
        with self.assertRaisesRegex(exemplar.UserError, "Time/Increments = '2.5' is not allowed"):
            exemplar.Problem({**BAR, "Time": {"Increments": 2.5}})

    def test_units_are_warned_of(self):
        scene = {**BAR, "Mesh": {**BAR["Mesh"], "Box size": [400, 100, 100]}, "Time": {"Step": 0.1}, "Handles": {"left": {"Select": "boundary 1"}}}
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            problem = exemplar.Problem(scene)
        self.assertEqual(len(problem.warnings), 2)
        self.assertRegex(problem.warnings[0], "^scene: Time/Step = 0.1 does nothing in a scene that is not dynamic")
        self.assertRegex(problem.warnings[1], "^The body is 400 m long.*Mesh/Scale = 0.001")
        self.assertEqual([str(warning.message) for warning in told], problem.warnings)
        for warning in told:
            self.assertEqual((warning.category, warning.filename), (UserWarning, __file__))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with self.assertRaisesRegex(UserWarning, "^scene: Time/Step"):
                exemplar.Problem(scene)
            solved(BAR)  # nothing to warn of

    def test_keys_that_do_nothing_in_python(self):
        nodes, cells = box()
        for words, scene, mesh in (("^Output/Directory does nothing in Python.*problem.positions", {**BAR, "Output": {"Directory": "out"}}, None),
                                   ("Mesh/File = absent.msh does nothing, as mesh= is given", {**BAR, "Mesh": {"File": "absent.msh"}}, (nodes, cells)),
                                   ("Mesh/Generator = box does nothing", BAR, (nodes, cells))):
            with self.subTest(words), self.assertWarnsRegex(UserWarning, words):
                self.assertEqual(len(exemplar.Problem(scene, mesh).warnings), 1)
        with self.assertWarnsRegex(UserWarning, "Examples/Poses = absent.msh does nothing, as poses= is given"):
            problem = exemplar.Problem({**BAR, "Examples": {"Poses": ["absent.msh"]}}, poses=[twisted(nodes)])
        self.assertEqual((len(problem.warnings), len(problem.weights)), (1, 2))

    def test_dictionaries_without_end(self):
        section, entries = {}, []
        section["Mesh"] = section
        entries.append(entries)
        deep = "value"
        for _ in range(100000):
            deep = {"Mesh": deep}
        for message, scene in {
            "Mesh/Mesh/Mesh is a dictionary. The sections of a scene are at most two deep": section,
            "Mesh/Mesh/Mesh is": deep,
            "Mesh/Box size holds lists within lists": {**BAR, "Mesh": {"Box size": entries}},
            "Mesh/Box size holds a dictionary in a list": {**BAR, "Mesh": {"Box size": [{}]}},
        }.items():
            with self.subTest(message), self.assertRaisesRegex(exemplar.UserError, message):
                exemplar.Problem(scene)
        while isinstance(deep, dict):  # one after the other: freeing it at once would recurse in C
            deep = deep.pop("Mesh")

    def test_texts_with_nul(self):
        for scene in {**BAR, "Mesh": {"File": "a\0b"}}, {**BAR, "Me\0sh": 1}, "a\0b.prm", "set Scene = static\n\0\n":
            with self.subTest(scene), self.assertRaisesRegex(exemplar.UserError, "scene.* holds a NUL character .*Remove it"):
                exemplar.Problem(scene)
        with self.assertRaisesRegex(exemplar.UserError, "NUL character"):
            exemplar.Problem(BAR).set_motion("ri\0ght", lambda rest, t: rest)

    def test_problem_that_was_never_made(self):
        class Empty(exemplar.Problem):
            def __init__(self):
                pass

        unmade = exemplar.Problem.__new__(exemplar.Problem)
        gc.collect()
        for use in (unmade.step, unmade.run, lambda: unmade.positions, lambda: unmade.energies, Empty,
                    lambda: unmade.on_iteration(None)):
            with self.assertRaisesRegex(TypeError, "Problem|__init__"):
                use()


class State(unittest.TestCase):
    def test_positions_are_not_set(self):
        problem = exemplar.Problem(BAR)
        with self.assertRaisesRegex(AttributeError, "positions cannot be set. .*state.replace"):
            problem.positions = box()[0]

    def test_what_is_no_way_to_change_a_problem(self):
        problem = exemplar.Problem(BAR, poses=[twisted(box()[0])])
        with self.assertRaisesRegex(AttributeError, "on_iteration is called, not set: problem.on_iteration"):
            problem.on_iteration = print
        for name, words in ("weights", "replace.weights"), ("velocities", "replace"), ("time", "replace"), ("handles", "let_go"), ("tolerance", "no attribute 'tolerance'"):
            with self.assertRaisesRegex(AttributeError, words):
                setattr(problem, name, 1)
        with self.assertRaisesRegex(ValueError, "read-only"):
            problem.weights[0] = 1

        class Subclass(exemplar.Problem):
            pass

        subclass = Subclass(BAR)
        subclass.mine = 1
        self.assertEqual(subclass.mine, 1)
        del subclass.mine

    def test_names_of_measures(self):
        problem = exemplar.Problem(BAR)
        with self.assertRaisesRegex(KeyError, "no 'elastic' .there: energy_elastic"):
            problem.energies["elastic"]
        with self.assertRaisesRegex(KeyError, "Did you mean 'energy_elastic'"):
            problem.statistics["energy_elastc"]
        self.assertIsNone(problem.energies.get("elastic"))
        self.assertEqual(pickle.loads(pickle.dumps(problem.energies)), problem.energies)

    def test_measures(self):
        problem = exemplar.Problem(DYNAMIC, poses=[twisted(box()[0])])
        self.assertEqual((problem.step_number, problem.n_steps, problem.time), (0, 6, 0))
        report = problem.step()
        self.assertEqual(report.status, "converged")
        self.assertEqual(len(report.residual_history), report.iterations + 1)
        self.assertLess(report.residual, 1e-3)
        self.assertEqual(problem.residual, report.residual)
        self.assertEqual(set(problem.energies) & {"energy_elastic", "energy_example", "energy_kinetic"},
                         {"energy_elastic", "energy_example", "energy_kinetic"})
        self.assertEqual(problem.statistics["step"], 1)
        self.assertIn("reaction_right_x", problem.statistics)
        self.assertEqual(problem.velocities.shape, (45, 3))
        self.assertIsNone(exemplar.Problem(BAR).velocities)

    def test_views_outlive_steps_and_problem(self):
        problem = exemplar.Problem(BAR)
        nodes, first, again = problem.rest_positions, problem.positions, problem.positions
        self.assertEqual(first.ctypes.data, again.ctypes.data)  # no copy
        with self.assertRaises(ValueError):
            first[0] = 0
        before = first.copy()
        problem.step()
        second = problem.positions
        np.testing.assert_array_equal(first, before)
        self.assertGreater(abs(second - first).max(), 0.05)
        after, address = second.copy(), first.ctypes.data
        self.assertEqual(again.ctypes.data, address)
        del problem
        gc.collect()
        np.testing.assert_array_equal(second, after)
        np.testing.assert_array_equal(first, nodes)

    def test_views_do_not_change_what_is_computed(self):
        watched = exemplar.Problem(DYNAMIC)
        kept = []
        while watched.step_number < watched.n_steps:
            kept.append((watched.positions, watched.velocities))
            watched.step()
        self.assertEqual(watched.positions.tobytes(), solved(DYNAMIC).positions.tobytes())
        self.assertEqual(len({positions.tobytes() for positions, _ in kept}), 6)


class Callbacks(unittest.TestCase):
    def test_motion_equals_formula(self):
        problem = exemplar.Problem({**BAR, "Handles": {**HANDLES, "right": {"Select": "box 2 -1 -1 2 1 1"}}})
        problem.set_motion("right", lambda rest, t: np.tile([0.2 * t, 0, 0.3 * t], (len(rest), 1)))
        problem.run()
        np.testing.assert_allclose(problem.positions, solved(BAR).positions, atol=1e-10)

    def test_motions_that_are_none(self):
        problem = exemplar.Problem(BAR)
        with self.assertRaisesRegex(exemplar.UserError, "Handles/Names has: left, right"):
            problem.set_motion("top", lambda rest, t: rest)
        for error, function in {ZeroDivisionError: lambda rest, t: 1 / 0,
                                exemplar.UserError: lambda rest, t: rest[1:],
                                TypeError: lambda rest, t: rest + None}.items():
            problem.set_motion("right", function)
            with self.assertRaises(error):
                problem.step()
            self.assertEqual(problem.step_number, 0)
        problem.set_motion("right", lambda rest, t: np.tile([0.2 * t, 0, 0.3 * t], (len(rest), 1)))
        problem.run()
        np.testing.assert_allclose(problem.positions, solved(BAR).positions, atol=1e-10)

    def test_motions_of_other_shapes(self):
        problem = exemplar.Problem(BAR)
        for given, function in {"is an array of shape (8, 3)": lambda rest, t: rest[1:],
                                "is an array of shape (9, 2)": lambda rest, t: rest[:, :2],
                                "is a NoneType": lambda rest, t: None, "real numbers": lambda rest, t: 1j * rest,
                                "finite numbers, but row 0, counted from 0, is (nan": lambda rest, t: np.nan * rest}.items():
            problem.set_motion("right", function)
            with self.subTest(given), self.assertRaises(exemplar.UserError) as caught:
                problem.step()
            self.assertIn("Handles/right", str(caught.exception))
            self.assertIn(given, str(caught.exception))
            self.assertTrue("shape (9, 3)" in str(caught.exception) or "numbers" in given)

    def test_functions_with_other_arguments(self):
        problem = exemplar.Problem(BAR)
        problem.set_motion("right", lambda t: t)
        with self.assertRaisesRegex(TypeError, "takes 1 positional argument but 2 were given. set_motion calls function\\(rest, t\\)"):
            problem.step()
        problem.set_motion("right", lambda rest, t: rest + None)
        with self.assertRaisesRegex(TypeError, "unsupported operand[^.]*$"):
            problem.step()
        problem.set_motion("right", lambda rest, t: 0 * rest)
        problem.on_iteration(lambda report, more: None)
        with self.assertRaisesRegex(TypeError, "missing 1 required .*'more'. on_iteration calls function\\(report\\)"):
            problem.step()
        with self.assertRaisesRegex(TypeError, "function is called as function\\(rest, t\\), but is an array of shape \\(9, 3\\)"):
            problem.set_motion("right", np.zeros((9, 3)))
        with self.assertRaisesRegex(TypeError, "the name of a handle must be a str, but is a function"):
            problem.set_motion(lambda rest, t: rest, "right")

    def test_motions_that_give_places_are_warned_of(self):
        problem = exemplar.Problem(BAR)
        problem.set_motion("right", lambda rest, t: rest + [0, 0, 0.1 * t])
        with self.assertWarnsRegex(UserWarning, "^Handles/right: at t = 0 its motion moves every node by the node's own place.*in Python rest"):
            problem.step()

    def test_motions_that_go_far_are_warned_of(self):
        problem = exemplar.Problem(BAR)
        problem.set_motion("right", lambda rest, t: 0 * rest + [0, 0, 30 * t])
        with self.assertWarnsRegex(UserWarning, "^Handles move by up to 10 m in a step, 4.08 times the size of the body"):
            problem.step()
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            problem.step()
            self.assertEqual(told, [])  # it has been told of this function
            problem.step()  # the last
        self.assertRegex(str(told[0].message), "cells are (inverted|stretched) .*at the end: element")
        self.assertEqual(problem.warnings[1:], [str(warning.message) for warning in told])

    def test_cycles_are_freed(self):
        class Subclass(exemplar.Problem):
            pass

        for kind in exemplar.Problem, Subclass:
            problem = kind(BAR)
            problem.set_motion("right", lambda rest, t, held=problem: 0 * rest)
            problem.set_motion("left", lambda rest, t, held=problem.positions: 0 * rest)
            problem.on_iteration(lambda report, held=(problem, problem.rest_positions): None)
            problem.step()
            rest, dead = problem.rest_positions, weakref.ref(problem)
            functions = [weakref.ref(function) for function in gc.get_referents(problem) if callable(function)
                         and not isinstance(function, type)]
            self.assertEqual(len(functions), 3)
            del problem
            gc.collect()
            self.assertIsNone(dead())
            self.assertEqual([function() for function in functions], [None, None, None])
            self.assertEqual(rest.max(), 2)

    def test_callback_sees_iterations_and_may_stop(self):
        problem = exemplar.Problem(BAR)
        residuals = []
        problem.on_iteration(lambda report: residuals.append((report.residual, problem.positions[0, 0])))
        report = problem.step()
        self.assertEqual([residual for residual, _ in residuals], report.residual_history)
        problem.on_iteration(lambda report: False)
        with self.assertRaises(exemplar.Interrupted):
            problem.step()
        self.assertEqual(problem.step_number, 1)
        problem.on_iteration(None)
        problem.run()
        np.testing.assert_allclose(problem.positions, solved(BAR).positions, atol=1e-8)

    def test_callback_may_not_step(self):
        problem = exemplar.Problem(BAR)
        problem.on_iteration(lambda report: problem.step())
        with self.assertRaisesRegex(RuntimeError, "is being made, and has called a function that calls step.*returns False"):
            problem.step()

    def test_control_c(self):
        problem = exemplar.Problem(BAR)
        problem.on_iteration(lambda report: os.kill(os.getpid(), signal.SIGINT))
        with self.assertRaises(KeyboardInterrupt):
            problem.run()


class Processes(unittest.TestCase):
    def test_two_problems_in_two_threads(self):
        exemplar.use_one_blas_thread()
        scenes = [BAR, DYNAMIC]
        expected = [solved(scene).positions.tobytes() for scene in scenes]
        got = [None, None]

        def solve(i):
            for _ in range(5):
                got[i] = solved(scenes[i]).positions.tobytes()

        threads = [threading.Thread(target=solve, args=(i,)) for i in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(got, expected)

    def test_import_without_numpy(self):
        code = "import sys\nsys.modules['numpy'] = None\nimport exemplar"
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("ImportError: exemplar needs numpy", done.stderr)
        self.assertIn("python3-numpy", done.stderr)

    def test_multigrid_ends_with_the_interpreter(self):
        code = ("import exemplar, sys\n"
                f"scene = {BAR!r}\n"
                "try:\n"
                "    problem = exemplar.Problem({**scene, 'Solver': {'Linear solver': 'iterative', 'Method': 'newton'}})\n"
                "except exemplar.UserError as error:\n"
                "    sys.exit(0 if 'without Trilinos' in str(error) else str(error))\n"
                "problem.run()\n")
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main()
