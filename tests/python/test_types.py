# SPDX-License-Identifier: GPL-3.0-or-later
"""What the types of the module promise: the stub passes `mypy --strict`, a program that uses every public name does, and values are
of the types that the stub says."""
import ast
import importlib.util
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

import exemplar
from test_interface import BAR, STUB, named_members

PROGRAM = Path(__file__).with_name("strict_program.py")


def mypy(*arguments):
    """What mypy says of files, with the module's types beside them and those of nothing else."""
    with tempfile.TemporaryDirectory() as directory:
        return subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", directory, *map(str, arguments)],
                              cwd=directory, capture_output=True, text=True, env={**os.environ, "MYPYPATH": str(STUB.parents[1])})


@unittest.skipUnless(importlib.util.find_spec("mypy"), "needs mypy (Debian: apt-get install mypy; elsewhere: pip install mypy)")
class Strict(unittest.TestCase):
    def assertPasses(self, *arguments):
        done = mypy(*arguments)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_the_stub(self):
        self.assertPasses(STUB, STUB.with_name("_live.py"))

    def test_a_program_that_uses_every_name(self):
        self.assertPasses(PROGRAM)

    def test_wrong_programs_are_found(self):
        with tempfile.TemporaryDirectory() as directory:
            file = Path(directory, "wrong.py")
            file.write_text("import exemplar\np = exemplar.Problem('x.prm')\np.importance = 'much'\np.handles['left'].append(1)\n"
                            "p.add_term(lambda x, t: 3.0)\n")
            self.assertEqual(re.findall(r"wrong.py:(\d+): error", mypy(file).stdout), ["3", "4", "5", "5"])


class Program(unittest.TestCase):
    def test_it_uses_every_public_name(self):
        used = {node.attr for node in ast.walk(ast.parse(PROGRAM.read_text())) if isinstance(node, ast.Attribute)}
        self.assertEqual({name for name, _ in named_members() if name.split(".")[-1] not in used}, set())


def annotations():
    """The type of each property in the stub, by class and name."""
    for node in ast.parse(STUB.read_text()).body:
        for inner in node.body if isinstance(node, ast.ClassDef) else []:
            if isinstance(inner, ast.FunctionDef) and [ast.unparse(by) for by in inner.decorator_list] == ["property"]:
                yield node.name, inner.name, ast.unparse(inner.returns)


def type_of(value):
    if isinstance(value, np.ndarray):
        return f"NDArray[np.{value.dtype}]"
    if isinstance(value, list):
        return f"list[{type_of(value[0])}]" if value else "list[str]"
    if type(value) is dict:
        types = {type_of(one) for one in value.values()}
        return f"dict[str, {types.pop() if len(types) == 1 else 'Any'}]"
    return {"csr_array": "scipy.sparse.csr_array"}.get(type(value).__name__, type(value).__name__)


@unittest.skipUnless(importlib.util.find_spec("scipy"), "needs scipy")
class Values(unittest.TestCase):
    def test_values_are_of_the_types_that_the_stub_says(self):
        problem = exemplar.Problem(BAR)
        with problem.record() as trajectory:
            report = problem.step()
        on_floor = exemplar.Problem({**BAR, "Obstacles/Names": "floor", "Obstacles/floor/Shape": "plane 0 0 -9  0 0 1"})
        in_parts = exemplar.Problem({**BAR, "Examples": {"Pose functions": "x; y; z + .05*x^2 | 1.1*x; y; z", "Regions": "auto"}})
        owners = {"Problem": problem, "State": problem.state, "Report": report, "Trajectory": trajectory}
        for owner, name, said in annotations():
            with self.subTest(f"{owner}.{name}"):
                of = {"obstacles": on_floor, "weight_regions": in_parts}.get(name, owners[owner])
                self.assertEqual(said.removesuffix(" | None"), type_of(getattr(of, name)))


if __name__ == "__main__":
    unittest.main()
