# SPDX-License-Identifier: GPL-3.0-or-later
"""Run the programs that the pages show: the first one of doc/python.md, and the notebooks of the tutorial."""
import contextlib
import importlib.util
import io
import json
import os
import re
import tempfile
import unittest
import warnings
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]


def run(programs):
    """Run them one after the other as one session, in a directory of its own; (what they print, {file: bytes})."""
    os.environ["MPLBACKEND"] = "Agg"
    import matplotlib.pyplot as plt
    printed, session, before = io.StringIO(), {"__name__": "__main__"}, os.getcwd()
    with tempfile.TemporaryDirectory() as directory, contextlib.redirect_stdout(printed), warnings.catch_warnings():
        warnings.simplefilter("error", UserWarning)
        os.chdir(directory)
        try:
            for number, program in enumerate(programs):
                exec(compile(program, f"program {number}", "exec"), session)
        finally:
            plt.close("all")
            os.chdir(before)
        return printed.getvalue(), {file.name: file.read_bytes() for file in Path(directory).iterdir()}


@unittest.skipUnless(importlib.util.find_spec("matplotlib"), "needs matplotlib")
class Pages(unittest.TestCase):
    def test_the_first_program_plots_arrays_in_15_lines(self):
        program = re.search(r"```python\n(.*?)```", (TOP / "doc/python.md").read_text(), re.DOTALL)[1]
        self.assertIn("mesh=(nodes", program)
        self.assertLessEqual(len([line for line in program.splitlines() if line.strip()]), 15)
        _, files = run([program])
        self.assertGreater(len(files["bar.png"]), 20000)

    def test_notebooks_run(self):
        notebooks = sorted((TOP / "doc").rglob("*.ipynb"))
        self.assertTrue(notebooks)
        for file in notebooks:
            with self.subTest(file.name):
                cells = [cell for cell in json.loads(file.read_text())["cells"] if cell["cell_type"] == "code"]
                self.assertTrue(all(not cell["outputs"] and cell["execution_count"] is None for cell in cells), "keeps outputs")
                printed, _ = run("".join(cell["source"]) for cell in cells)
                self.assertRegex(printed, r"Did you mean 'Examples/Importance'[\s\S]*importance 0.9: ")


if __name__ == "__main__":
    unittest.main()
