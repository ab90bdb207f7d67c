# SPDX-License-Identifier: GPL-3.0-or-later
"""Install the module that is built by pip, offline, into an environment that sees Debian's packages, and use it there.

Usage: python3 tests/packaging/test_pip.py BUILD
"""
import importlib.util
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
PROGRAM = """
import exemplar, importlib.metadata, pathlib, sys
assert exemplar.__file__.startswith(sys.prefix), exemplar.__file__
assert importlib.metadata.version("exemplar") == exemplar.__version__
folder = pathlib.Path(exemplar.__file__).parent
assert {"py.typed", "__init__.pyi", "_plot.py", "_live.py", "_equilibrium.py", "with_torch.py", "with_jax.py"} <= {file.name for file in folder.iterdir()}
problem = exemplar.Problem("prm/tutorial/step1_bar.prm")
print(problem.step().iterations, problem.positions.shape)
"""


def called(*command, **variables):
    environment = {**os.environ, "PIP_DISABLE_PIP_VERSION_CHECK": "1", "PIP_NO_INDEX": "1", **variables}
    environment.pop("PYTHONPATH", None)
    done = subprocess.run(command, cwd=TOP, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return done.returncode, done.stdout


class Pip(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        status, text = called("/usr/bin/python3", "-m", "venv", "--system-site-packages", directory.name)
        self.assertEqual(status, 0, text)
        self.python = Path(directory.name, "bin/python3")

    def install(self, build):
        return called(self.python, "-m", "pip", "install", "--no-build-isolation", ".", EXEMPLAR_BUILD=build)

    def test_a_build_is_installed_and_used(self):
        status, text = self.install(BUILD)
        self.assertEqual(status, 0, text)
        status, text = called(self.python, "-c", PROGRAM)
        self.assertEqual(status, 0, text)
        self.assertRegex(text, r"\d+ \(\d+, 3\)")
        status, text = called(self.python, "-m", "pip", "uninstall", "-y", "exemplar")
        self.assertEqual(status, 0, text)
        self.assertNotEqual(called(self.python, "-c", "import exemplar")[0], 0)

    def test_a_directory_without_the_module_is_refused(self):
        status, text = self.install("doc")
        self.assertNotEqual(status, 0)
        self.assertIn("EXEMPLAR_BUILD=doc holds no python/exemplar/__init__", text)


if __name__ == "__main__":
    missing = [name for name in ("pip", "venv", "ensurepip", "wheel") if not importlib.util.find_spec(name)]
    if missing:
        print("Not tested without Debian's python3-pip, python3-venv and python3-wheel:", *missing)
        sys.exit(77)
    BUILD = sys.argv.pop()
    unittest.main()
