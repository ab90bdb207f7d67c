# SPDX-License-Identifier: GPL-3.0-or-later
"""What the module says of itself: its types, signatures and docstrings, its log, its suggestions; and its plots."""
import ast
import importlib.util
import inspect
import logging
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

import exemplar

BAR = {"Scene": "dynamic", "Mesh": {"Generator": "box", "Box size": [2, 1, 1], "Box cells": (4, 2, 2)},
       "Examples": {"Pose functions": [["x", "y+0.2*x*z", "z-0.2*x*y"]]},
       "Handles": {"left": {"Select": "box 0 -1 -1 0 1 1"},
                   "right": {"Select": "box 2 -1 -1 2 1 1", "Motion": ["0.2*t", 0, "0.3*t"]}},
       "Time": {"Step": 0.05, "End": 0.1}}
STUB = Path(exemplar.__file__).parent / "__init__.pyi"
has = importlib.util.find_spec


def public(members):
    return {name: member for name, member in members.items() if not name.startswith("_") and not inspect.ismodule(member)}


def types():
    return {name: member for name, member in public(vars(exemplar)).items() if isinstance(member, type)}


def named_members():
    """Every public name with its member: of the module, and of its types as Type.name."""
    yield from public(vars(exemplar)).items()
    for name, kind in types().items():
        yield from ((f"{name}.{inner}", member) for inner, member in public(vars(kind)).items())


def names_of_stub():
    for node in ast.parse(STUB.read_text()).body:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            yield node.name
        for inner in node.body if isinstance(node, ast.ClassDef) else []:
            if isinstance(inner, ast.FunctionDef) and not inner.name.startswith("_"):
                yield f"{node.name}.{inner.name}"


class Types(unittest.TestCase):
    def test_the_stub_has_every_public_name_and_no_other(self):
        self.assertEqual(set(names_of_stub()), {name for name, _ in named_members()})
        self.assertTrue((STUB.parent / "py.typed").exists())

    def test_inspect_reads_signatures(self):
        self.assertEqual(str(inspect.signature(exemplar.Problem)), "(scene, mesh=None, poses=None)")
        self.assertEqual(str(inspect.signature(exemplar.Problem.set_motion)), "(self, name, function)")
        self.assertEqual(str(inspect.signature(exemplar.Problem(BAR).plot)), "(values=None, axes=None, label=None)")
        for name, member in named_members():
            if callable(member) and not isinstance(member, type):
                with self.subTest(name):
                    self.assertIsInstance(inspect.signature(member), inspect.Signature)

    @unittest.skipUnless(has("mypy"), "needs mypy")
    def test_mypy_finds_the_stub_as_the_module_is(self):
        with tempfile.TemporaryDirectory() as directory:
            Path(directory, "mypy.ini").write_text("[mypy]\nignore_missing_imports = True\n")
            # types made by pybind11 have a metaclass and dunders of their own
            # and the class of with_torch is torch's, of which mypy knows nothing
            Path(directory, "allowed").write_text(r"exemplar\.\w+(\.__\w+__)?|exemplar\.with_torch\._Equilibrium.*" + "\n")
            done = subprocess.run([sys.executable, "-m", "mypy.stubtest", "exemplar", "--mypy-config-file", "mypy.ini",
                                   "--allowlist", "allowed", "--ignore-unused-allowlist"],
                                  cwd=directory, capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    @unittest.skipUnless(has("mypy"), "needs mypy")
    def test_mypy_checks_programs(self):
        with tempfile.TemporaryDirectory() as directory:
            Path(directory, "mine.py").write_text("import exemplar\nproblem = exemplar.Problem({'Scene': 'static'})\n"
                                                  "reveal_type(problem.step().iterations)\nproblem.set_motion(3, lambda rest, t: rest)\n")
            done = subprocess.run([sys.executable, "-m", "mypy", "mine.py"], cwd=directory, capture_output=True, text=True,
                                  env={**os.environ, "MYPYPATH": str(STUB.parents[1])})
            self.assertIn('mine.py:3: note: Revealed type is "builtins.int"', done.stdout)
            self.assertRegex(done.stdout, 'mine.py:4: error: Argument 1 to "set_motion" of "Problem"')


class Docstrings(unittest.TestCase):
    def test_every_public_name_is_explained(self):
        for name, member in named_members():
            with self.subTest(name):
                self.assertRegex(inspect.getdoc(member) or "", r"\w.*\.")

    def test_functions_say_what_they_raise(self):
        for name, member in named_members():
            if callable(member) and not isinstance(member, type):
                with self.subTest(name):
                    doc = inspect.getdoc(member)
                    self.assertRegex(doc, r"\b([Rr]aises|[Ww]arns|errors as)\b", "says nothing of errors")
                    self.assertRegex(doc, rf"^{member.__name__}\(", "begins with no call")

    def test_files_beside_the_module_are_explained(self):
        for name in "with_torch", "with_jax":
            text = (Path(exemplar.__file__).parent / f"{name}.py").read_text()
            functions = [node for node in ast.parse(text).body if isinstance(node, ast.FunctionDef) and node.name[0] != "_"]
            self.assertEqual([function.name for function in functions], ["equilibrium"])
            for word in "Raises", "(n, 3) [m]", "young", "poses", ">>> ":  # run by test_docstrings.py where the packages are
                self.assertIn(word, ast.get_docstring(functions[0]))

    def test_arrays_say_their_shapes_and_units(self):
        problem = exemplar.Problem(BAR)
        problem.run()
        for name in public(vars(exemplar.Problem)):
            value = getattr(problem, name)
            doc = inspect.getdoc(getattr(exemplar.Problem, name))
            with self.subTest(name):
                if isinstance(value, np.ndarray) and value.ndim == 2:
                    self.assertRegex(doc, rf"\(\w, {value.shape[1]}\)")
                    self.assertTrue(value.dtype.kind == "u" or re.search(r"\[[^]]+\]", doc), "says no unit")
                elif isinstance(value, float):
                    self.assertRegex(doc, r"\[[^]]+\]|[Rr]elative|from 0 to 1|at most 1|no unit", "says no unit")


class Log(unittest.TestCase):
    def test_a_step_is_told_at_level_info(self):
        with self.assertLogs("exemplar", "INFO") as log:
            exemplar.Problem(BAR).run()
        self.assertEqual(len(log.output), 2)
        self.assertRegex(log.output[0], r"^INFO:exemplar:step 1 of 2, t = 0.05: converged, \d+ iterations, residual \d")

    def test_nothing_is_told_otherwise(self):
        with self.assertNoLogs("exemplar", "INFO"):
            logging.getLogger("exemplar").setLevel(logging.WARNING)
            try:
                exemplar.Problem(BAR).step()
            finally:
                logging.getLogger("exemplar").setLevel(logging.NOTSET)

    def test_importing_exemplar_imports_neither_logging_nor_matplotlib(self):
        program = "import numpy, sys; before = set(sys.modules); import exemplar; print(*sorted(set(sys.modules) - before))"
        found = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout.split()
        self.assertFalse({"logging", "matplotlib", "exemplar._plot"} & set(found), found)


class Suggestions(unittest.TestCase):
    def test_unknown_names_of_dictionaries_get_the_nearest(self):
        nearest = {"Mesh/Box size": {"Mesh": {**BAR["Mesh"], "Box sise": 1}}, "Time/End": {"Time": {"Ent": 1}},
                   "Handles": {"Handels": {"left": {"Select": "boundary 1"}}}, "Handles/NAME/Motion": {"Handles": {"left": {"Select": "boundary 1", "Moton": "t"}}}}
        for name, wrong in nearest.items():
            with self.subTest(name), self.assertRaisesRegex(exemplar.UserError, "Did you mean '" + name.replace("NAME", r"\w+")):
                exemplar.Problem({**BAR, **wrong})

    def test_empty_sections(self):
        """Nothing is in them that would be refused."""
        for wrong, message in (({"Exmaples": {}}, "no section 'Exmaples'. Did you mean 'Examples'"),
                               ({"Handels": {"left": {}}}, "no section 'Handels'. Did you mean 'Handles'"),
                               ({"Nothing like it": {}}, "no section 'Nothing like it'. The sections are .*Mesh, "),
                               ({"Mesh": {**BAR["Mesh"], "Poses": {}}}, "section Mesh has no section 'Poses'")):
            with self.subTest(wrong), self.assertRaisesRegex(exemplar.UserError, message):
                exemplar.Problem({**BAR, **wrong})
        exemplar.Problem({**BAR, "Examples": {}, "Loads": {}})


@unittest.skipUnless(has("matplotlib"), "needs matplotlib")
class Plot(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.problem = exemplar.Problem(BAR)
        cls.problem.run()

    def tearDown(self):
        import matplotlib.pyplot as plt
        plt.close("all")

    def test_the_surface_stands_where_the_body_does(self):
        axes = self.problem.plot()
        triangles = axes.collections[0]._vec[:3].T.reshape(-1, 3, 3)
        self.assertEqual(len(triangles), 2 * 2 * (4 * 2 + 4 * 2 + 2 * 2))  # two a square
        volume = np.einsum("ti,ti", triangles[:, 0], np.cross(triangles[:, 1], triangles[:, 2])) / 6
        x = self.problem.positions[self.problem.cells]
        self.assertAlmostEqual(volume, np.linalg.det(x[:, 1:] - x[:, :1]).sum() / 6, places=6)  # outside is outside

    def test_colours_are_by_displacement_node_or_cell(self):
        import matplotlib.pyplot as plt
        axes = plt.figure().add_subplot(projection="3d")
        n, m = len(self.problem.positions), len(self.problem.cells)
        self.assertIs(self.problem.plot(np.arange(n), axes=axes), axes)
        self.assertIn("displacement [m]", [other.get_ylabel() for other in self.problem.plot().figure.axes])
        bounds = self.problem.plot(np.full(m, 3.0)).figure.axes[1].get_ylim()
        self.assertTrue(bounds[0] <= 3 <= bounds[1])

    def test_wrong_values_and_axes_are_refused(self):
        import matplotlib.pyplot as plt
        n = len(self.problem.positions)
        wrong = {r"shape \(7,\). Allowed: one number a node \(45,\) or a cell \(96,\)": lambda: self.problem.plot(np.zeros(7)),
                 r"shape \(45, 3\).*norm": lambda: self.problem.plot(self.problem.positions),
                 "no array of real numbers": lambda: self.problem.plot("red"),
                 r"values\[4\] is not finite": lambda: self.problem.plot(np.where(np.arange(n) == 4, np.nan, 0)),
                 "not of space": lambda: self.problem.plot(axes=plt.figure().add_subplot())}
        for message, call in wrong.items():
            with self.subTest(message), self.assertRaisesRegex(exemplar.UserError, message):
                call()

    def test_without_matplotlib_the_message_says_what_to_install(self):
        with mock.patch.dict(sys.modules, {"matplotlib": None, "matplotlib.pyplot": None}):
            with self.assertRaisesRegex(ImportError, "needs matplotlib.*python3-matplotlib"):
                self.problem.plot()


if __name__ == "__main__":
    os.environ["MPLBACKEND"] = "Agg"
    unittest.main()
