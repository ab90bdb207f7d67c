# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes as ParaView, CalculiX, Abaqus, gmsh, TetGen and Medit write them: the same nodes, cells, regions and boundaries."""
import tempfile
import unittest
import warnings
from pathlib import Path

import exemplar
import foreign_meshes as foreign
import numpy as np

# a group, and the x of its nodes
REGIONS = {1: (0, 1), 2: (1, 2)}
BOUNDARIES = {11: (0,), 12: (2,), 13: (1,)}
FURTHER = {"region 7": (0, 1, 2), "boundary 21": (0,)}  # of files with two groups each
IN_FILE = {1: "one", 2: "two", 11: "left", 12: "right side", 13: "between"}


class ForeignMeshesTest(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.directory = Path(directory.name)

    def problem(self, file, select=None, **more):
        handles = {"held": {"Select": select}} if select else {}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return exemplar.Problem({"Scene": "dynamic", "Mesh": {"File": str(file)}, "Time": {"End": 1}, "Handles": handles, **more})

    def check_selected(self, file, select, at):
        if set(at) == {x[0] for x in foreign.NODES}:
            with self.assertRaisesRegex(exemplar.UserError, "hold every node"):
                self.problem(file, select)
            return
        nodes = self.problem(file, select).handles["held"]
        self.assertEqual(list(nodes), [i for i, x in enumerate(foreign.NODES) if x[0] in at], select)

    def groups(self, extension, name):
        """Selections of the file's groups, by numbers and names, and the x of their nodes."""
        found = {}
        for tag, at in {**REGIONS, **BOUNDARIES}.items():
            kind = "region" if tag in REGIONS else "boundary"
            if extension == ".inp":
                found[f"{kind} {'R' if tag in REGIONS else 'B'}{tag}"] = at
            elif kind == "region" or name != "without faces":
                found[f"{kind} {tag}"] = at
                if extension == ".msh":
                    found[f"{kind} {IN_FILE[tag]}"] = at
        if extension == ".inp":
            found["set HELD"] = (0,)
        if "NALL" in name or name.startswith("CalculiX"):
            found["set NALL"] = (0, 1, 2)
        if name == "nodes of elements":
            found.update({"set FAR": (2,), "set BOTH": (0, 2)})
        return {**found, **(FURTHER if "two groups" in name else {})}

    def test_all_files(self):
        for extension, files in foreign.FORMATS.items():
            for name in files:
                with self.subTest(name, format=extension):
                    directory = self.directory / f"{extension}{list(files).index(name)}"
                    directory.mkdir()
                    file = foreign.write(directory, extension, name)
                    problem = self.problem(file)
                    np.testing.assert_allclose(problem.rest_positions, foreign.NODES, atol=1e-7)
                    self.assertEqual(problem.cells.tolist(), [nodes for _, nodes in foreign.CELLS])
                    for select, at in self.groups(extension, name).items():
                        self.check_selected(file, select, at)

    def test_groups_survive_final_poses(self):
        """A file with two groups each, written and read again."""
        file = foreign.write(self.directory, ".msh", "gmsh 4.1, two groups each")
        again = self.directory / "again.msh"
        self.assertEqual(self.convert(file, again), 0)
        for select, at in {**FURTHER, "region 1": (0, 1), "boundary 13": (1,)}.items():
            self.check_selected(again, select, at)
        rest = self.problem(file).rest_positions
        pose = self.problem(file, None, Initial={"Pose": str(again)})
        np.testing.assert_array_equal(pose.positions, rest)

    def convert(self, source, target):
        import os
        import subprocess
        program = os.environ.get("EXEMPLAR")
        if program is None:
            self.skipTest("EXEMPLAR does not name the program")
        return subprocess.run([program, "convert", source, target], capture_output=True, timeout=60).returncode

    def test_a_force_on_an_interface(self):
        """Shared by area it strains the first cube alone and evenly, to F L / (E A)."""
        file = foreign.write(self.directory, ".msh", "gmsh 4.1, binary")
        problem = exemplar.Problem({
            "Scene": "static", "Mesh": {"File": str(file)}, "Material": {"Young's modulus": 1e6, "Poisson's ratio": 0},
            "Handles": {"left": {"Select": "boundary left"}}, "Loads": {"push": {"Select": "boundary between", "Force": [7, 0, 0]}}})
        problem.run()
        x = problem.rest_positions[:, 0]
        np.testing.assert_allclose((problem.positions - problem.rest_positions)[:, 0], 7e-6 * np.minimum(x, 1), atol=1e-9)


if __name__ == "__main__":
    unittest.main()
