# SPDX-License-Identifier: GPL-3.0-or-later
"""Every public name has an example in its docstring, and all of them run."""
import contextlib
import doctest
import importlib.util
import inspect
import os
import tempfile
import unittest

import numpy as np

import exemplar
from test_interface import BAR, named_members

SCENE = {**BAR, "Time": {"Step": 0.05, "End": 0.5}, "Material": {"Young's modulus": 1e5, "Poisson's ratio": 0.3}}
if np.lib.NumpyVersion(np.__version__) >= "2.0.0":
    np.set_printoptions(legacy="1.25")  # numbers as doctests have them, without their types
HOW = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE | doctest.IGNORE_EXCEPTION_DETAIL
NEEDS = {name: package for package, names in {
    "scipy": ("Problem.hessian", "Problem.reduced_hessian", "Problem.mass", "Problem.add_term"),
    "matplotlib": ("Problem.plot", "Problem.animate")}.items() for name in names}


def names():
    """What examples may refer to: source/python/examples.cc."""
    problem, static = exemplar.Problem(SCENE), exemplar.Problem({**SCENE, "Scene": "static", "Time": {}, "Solver": {"Tolerance": 1e-9}})
    problem.step()
    with problem.record() as trajectory:
        problem.step()
    static.run()
    return {"problem": problem, "static": static, "trajectory": trajectory, "np": np, "exemplar": exemplar}


def public_members():
    """Every public name with its member, those of files beside the module, too, whose packages are here."""
    yield from named_members()
    for package in "torch", "jax":
        if importlib.util.find_spec(package):
            yield f"with_{package}", importlib.import_module(f"exemplar.with_{package}").equilibrium


class Examples(unittest.TestCase):
    def setUp(self):
        directory = self.enterContext(tempfile.TemporaryDirectory())
        self.enterContext(contextlib.chdir(directory))

    def test_every_public_name_has_one_that_runs(self):
        for name, member in public_members():
            if name in NEEDS and not importlib.util.find_spec(NEEDS[name]):
                continue
            with self.subTest(name):
                known = {**getattr(member, "__globals__", {}), **names()}
                test = doctest.DocTestParser().get_doctest(inspect.getdoc(member) or "", known, name, None, 0)
                self.assertTrue(test.examples, "has no example")
                found = []
                doctest.DocTestRunner(optionflags=HOW).run(test, out=found.append)
                self.assertEqual("".join(found), "")


if __name__ == "__main__":
    os.environ["MPLBACKEND"] = "Agg"
    unittest.main()
