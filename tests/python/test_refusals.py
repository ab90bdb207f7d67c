# SPDX-License-Identifier: GPL-3.0-or-later
"""What would end the process or be lost without a word: objects that were never made, matrices whose indices lead out of their arrays,
complex numbers and other types of arrays."""
import contextlib
import unittest
import warnings

import numpy as np

import exemplar
from test_interface import BAR, types

try:
    import scipy.sparse
except ImportError:
    scipy = None

STATIC = {**BAR, "Scene": "static", "Time": {"Increments": 2}}
OF_PYTHON = {"__class__", "__setstate__", "__init_subclass__", "__subclasshook__", "__new__", "__init__"}


class NeverMade(unittest.TestCase):
    def test_nothing_of_an_object_without_init_ends_the_process(self):
        for name, kind in types().items():
            if issubclass(kind, (Exception, dict)):
                continue
            class Derived(kind):
                def __init__(self):
                    pass
            with self.assertRaisesRegex(TypeError, "must be called"):
                Derived()
            for unmade in kind.__new__(kind), Derived.__new__(Derived):
                for member in set(dir(kind)) - OF_PYTHON:
                    with self.subTest(f"{name}.{member}"):
                        self.ask(unmade, member)

    def ask(self, unmade, member):
        try:
            value = getattr(unmade, member)
            if callable(value):
                value()
        except (TypeError, AttributeError) as error:
            self.assertNotRegex(str(error), "Unable to cast|registered")

    def test_messages_say_how_to_get_one(self):
        for kind, attribute, words in ((exemplar.State, "positions", "problem.state"), (exemplar.Report, "status", "problem.step"),
                                       (exemplar.Trajectory, "times", r"problem.record\(\)"), (exemplar.Problem, "positions", r"exemplar.Problem\(scene\)")):
            with self.subTest(kind), self.assertRaisesRegex(TypeError, "never made.*" + words):
                getattr(kind.__new__(kind), attribute)
        problem = exemplar.Problem(BAR)
        with self.assertRaisesRegex(TypeError, "never made"):
            problem.state = exemplar.State.__new__(exemplar.State)
        with self.assertRaisesRegex(TypeError, "never made"):
            exemplar.Problem.__new__(exemplar.Problem).record()


def changed(matrix, **parts):
    for name, part in parts.items():
        setattr(matrix, name, part)
    return matrix


@unittest.skipUnless(scipy, "needs scipy")
class Matrices(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.problem = exemplar.Problem(STATIC)
        cls.n = cls.problem.positions.size

    def whole(self, kind=None):
        return (kind or scipy.sparse.csr_array)(scipy.sparse.diags([1., 2., 1.], [-1, 0, 1], shape=(self.n, self.n)))

    def refuse(self, matrix, words):
        with self.assertRaisesRegex(exemplar.UserError, words):
            self.problem.add_term(lambda x, t: (0., 0 * x, matrix))
        self.assertNotIn("energy_term_1", self.problem.energies)

    def test_indices_beyond_their_arrays(self):
        for kind in scipy.sparse.csr_array, scipy.sparse.csc_array:
            starts = self.whole(kind).indptr
            far, back, first, last = starts.copy(), starts.copy(), starts.copy(), starts.copy()
            far[-1], back[5], first[0], last[-1] = 10**8, 0, -1, starts[-1] + 1
            for given, words in ((far, "ends at 100000000"), (last, "ends at"), (back, "falls from"), (first, "begins with -1"),
                                 (starts[:-1], "numbers, but there are"), (starts + .5, "must have integers"), (starts[:, None], "damaged"),
                                 (None, "damaged")):
                self.refuse(changed(self.whole(kind), indptr=given), "term_1.*the Hessian: its array indptr.*" + words)
            for index in self.n, -1, 2**40:
                indices = self.whole(kind).indices.astype(np.int64)
                indices[3] = index
                self.refuse(changed(self.whole(kind), indices=indices), f"an entry in row or column {index}")
            self.refuse(changed(self.whole(kind), indices=self.whole(kind).indices[:9]), "indptr ends at")

    def test_other_formats(self):
        for kind in "coo", "csc", "dia", "lil", "dok", "bsr":
            problem = exemplar.Problem(STATIC)
            problem.add_term(lambda x, t: (0., 0 * x, self.whole().asformat(kind)))
        coo = self.whole(scipy.sparse.coo_array)
        self.refuse(changed(coo.copy(), row=coo.row[:-1]), "rows and .* columns of")
        self.refuse(changed(coo.copy(), col=coo.col + self.n), "an entry in row or column")
        lil = self.whole(scipy.sparse.lil_array)
        lil.rows[3] = [*lil.rows[3], *range(100, 120)]
        self.refuse(lil, "row 3 has 22|row 3 has 23")
        lil = self.whole(scipy.sparse.lil_array)
        self.refuse(changed(lil, rows=lil.rows[:9]), "9 lists of columns and 135 of entries")
        bsr = self.whole(scipy.sparse.bsr_array)
        self.refuse(changed(bsr, indptr=2 * bsr.indptr), "no sparse array that scipy can read|not symmetric|row or column")

    def test_damaged_at_random(self):
        by = np.random.default_rng(3)
        for number in range(600):
            matrix = self.damaged(("csr", "csc", "bsr", "coo", "dia", "lil")[number % 6], by)
            with self.subTest(number), contextlib.suppress(exemplar.UserError):
                self.problem.check_term(lambda x, t: (0., 0 * x, matrix))

    def damaged(self, kind, by):
        """One whose arrays have other numbers, other lengths or another order."""
        parts = {"coo": ("row", "col", "data"), "dia": ("offsets", "data"), "lil": ("rows", "data")}.get(kind, ("indptr", "indices", "data"))
        matrix = self.whole().asformat(kind)
        name = parts[by.integers(len(parts))]
        part = np.array(getattr(matrix, name))
        how = by.integers(4)
        if how == 0:
            values = [-1, 0, self.n, 2**31 - 1, -2**31, 10**6]
            part.flat[by.integers(part.size)] = values[by.integers(6)] if part.dtype != object else [1] * by.integers(50)
        elif how < 3:
            part = part[:by.integers(len(part))] if how == 1 else np.concatenate([part, part[:by.integers(len(part))]])
        else:
            part = by.permutation(part)
        return changed(matrix, **{name: part})

    def test_types_of_entries(self):
        whole = self.whole()
        for data, words in ((whole.data * 1j, "complex128"), (whole.data + 0j, "complex128"), (whole.data > 0, "bool"),
                            (whole.data.astype(object), "object"), (whole.data.astype(str), "str")):
            self.refuse(changed(self.whole(), data=data), "the Hessian: its array data must be an array of real numbers, but is an array of " + words)


class Numbers(unittest.TestCase):
    """Whatever takes numbers refuses those that it would change."""

    def test_everywhere(self):
        problem, static = exemplar.Problem(BAR), exemplar.Problem(STATIC)
        static.run()
        state, n, m = problem.state, len(problem.positions), len(problem.cells)
        nodes, cells = problem.rest_positions, problem.cells
        zero, by_cell = np.zeros((n, 3)), np.ones(m)
        with problem.record() as trajectory:
            problem.step()
        takers = {
            "mesh": (nodes, lambda x: exemplar.Problem(STATIC, mesh=(x, cells))), "poses": (nodes, lambda x: exemplar.Problem(STATIC, mesh=(nodes, cells), poses=[x])),
            "young": (by_cell, lambda x: problem.set_material(young=x)), "density": (1., lambda x: problem.set_material(density=x)),
            "gravity": (np.ones(3), lambda x: setattr(problem, "gravity", x)), "nodal_forces": (zero, lambda x: setattr(problem, "nodal_forces", x)),
            "importance": (.5, lambda x: setattr(problem, "importance", x)), "damping": (.5, lambda x: setattr(problem, "mass_damping", x)),
            "pose": (nodes, lambda x: problem.set_pose(1, x)), "energy": (nodes, problem.energy), "gradient": (nodes, problem.gradient),
            "weights": (problem.weights, lambda x: problem.energy(weights=x)), "positions of a state": (state.positions, lambda x: state.replace(positions=x)),
            "weights of a state": (state.weights, lambda x: state.replace(weights=x)), "time of a state": (1., lambda x: state.replace(time=x)),
            "dt": (.01, problem.step), "goto": (.4, problem.goto), "vjp": (zero, static.vjp), "dJ_dw": (static.weights, lambda x: static.vjp(None, x)),
            "correction": (zero, static.correction), "steps": (zero, lambda x: trajectory.vjp([x])), "dJ_dv": (zero, lambda x: trajectory.vjp([None], None, [x])),
            "check_term": (nodes, lambda x: problem.check_term(lambda x, t: (0., 0 * x, None), positions=x)),
            "time of check_term": (1., lambda x: problem.check_term(lambda x, t: (0., 0 * x, None), time=x)),
            "energy of a term": (1., lambda x: problem.check_term(lambda _, t: (x, zero, None))),
            "gradient of a term": (zero, lambda x: problem.check_term(lambda _, t: (0., x, None))),
            "motion": (zero[:9], lambda x: (problem.set_motion("right", lambda rest, t: x), problem.step())),
            "cells": (cells, lambda x: exemplar.Problem(STATIC, mesh=(nodes, x))), "ids": (np.ones(m, int), lambda x: exemplar.Problem(STATIC, mesh=(nodes, cells, x))),
            "nodes": (np.arange(3), lambda x: problem.hold("new", x))}
        makers = {"complex": lambda x: x + 0j, "text": lambda x: np.array(x).astype(str), "times": lambda x: np.array(x).astype("timedelta64[s]"),
                  "objects": lambda x: np.array(x).astype(object) + 1j, "masked": lambda x: np.ma.masked_array(x, mask=np.ones(np.shape(x)))}
        for name, (right, take) in takers.items():
            for kind, make in makers.items():
                if kind in ("masked", "times") and np.ndim(right) == 0:
                    continue
                with self.subTest(f"{name}: {kind}"), warnings.catch_warnings():
                    warnings.simplefilter("error", getattr(np, "exceptions", np).ComplexWarning)
                    with self.assertRaises((exemplar.UserError, TypeError)) as refusal:
                        take(make(right))
                    self.assertNotRegex(str(refusal.exception), "incompatible function|Unable to cast|ComplexWarning|__float__")

    def test_wrappers_and_plots(self):
        from exemplar import _equilibrium
        with self.assertRaisesRegex(exemplar.UserError, "gravity is complex"):
            _equilibrium.solve(exemplar.Problem(STATIC), {"gravity": np.ones(3) * 1j})
        from exemplar import _plot
        for values in np.ones(45) * 1j, "red", [[1], [1, 2]]:
            with self.assertRaisesRegex(exemplar.UserError, "no array of real numbers"):
                _plot.values_of_faces(exemplar.Problem(STATIC), values, None, None)


if __name__ == "__main__":
    unittest.main()
