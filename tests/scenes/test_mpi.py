# SPDX-License-Identifier: GPL-3.0-or-later
"""The same scene by several processes under mpirun: its results are those of one process."""

import os
import re
import shutil
import subprocess
import unittest
import xml.etree.ElementTree

from exemplar_runner import (EXEMPLAR, SceneTest, bend, greatest_distance, has_trilinos, nodes_of, read_csv, read_msh,
                             read_pvd, read_summary, read_vtu, timeless_statistics, twist, write_scene)

MPI_ENVIRONMENT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                   "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_hwloc_base_binding_policy": "none",
                   "HWLOC_HIDE_ERRORS": "2"}

# A bar of two regions, held and lifted, with an example of unknown weight.
BODY = {
    "Mesh/Generator": "box",
    "Mesh/Box size": "4, 1, 1",
    "Mesh/Box cells": "8, 2, 2",
    "Material/Young's modulus": "1e6",
    "Material/Poisson's ratio": "0.4",
    "Material/Density": "1000",
    "Handles/Names": "left",
    "Handles/left/Select": "boundary 1",
    "Loads/Gravity": "0, 0, -9.81",
    "Output/Every": "0",
}
STATIC = {**BODY, "Scene": "static", "Time/Increments": "2", "Solver/Tolerance": "1e-11"}
DYNAMIC = {**BODY, "Scene": "dynamic", "Time/Step": "0.02", "Time/End": "0.1", "Solver/Method": "newton",
           "Solver/Tolerance": "1e-11", "Handles/left/Motion": "0; 0; 0.3*sin(4*t)"}
# in one process with a factor, in several with a multigrid hierarchy
QUASI_NEWTON = {**DYNAMIC, "Solver/Method": "quasi newton", "Solver/Step tolerance": "1e-11"}
BENT = {"Examples/Pose functions": bend("pi/2"), "Examples/Importance": "0.8"}
TWISTED = {"Scene": "interpolation", "Mesh/Generator": "box", "Mesh/Box size": "4, 1, 1", "Mesh/Box cells": "8, 2, 2",
           "Examples/Pose functions": twist("pi/2"), "Examples/Include rest pose": "true",
           "Examples/Prescribed weights": "1-t; t", "Time/Increments": "3", "Output/Every": "0"}

SCENES = {
    "static": STATIC,
    "static, cells": {**STATIC, "Model/Dilatation": "cells"},
    "static, quadratic": {**STATIC, "Model/Element": "P2", "Mesh/Box cells": "4, 2, 1"},
    "static, quadratic patches of points": {**STATIC, "Model/Element": "P2", "Mesh/Box cells": "4, 1, 1",
                                            "Model/Dilatation": "patches", "Output/Final pose": "quadratic"},
    "static, Green": {**STATIC, "Model/Strain": "green"},
    "static, linear": {**STATIC, "Model/Strain": "linear"},
    "static, examples": {**STATIC, **BENT, "Examples/Weights": "free"},
    "static, bounded weights": {**STATIC, **BENT, "Examples/Weights": "simplex"},
    "static, prescribed weights": {**STATIC, **BENT, "Examples/Weights": "prescribed",
                                   "Examples/Prescribed weights": "1-t; t"},
    "static, loads": {**STATIC, "Loads/Gravity": None, "Loads/Names": "pull, press", "Loads/pull/Select": "boundary 2",
                      "Loads/pull/Force": "1000*t; 0; 20000", "Loads/press/Select": "box 1 -1 -1 2 1 1",
                      "Loads/press/Force": "0; -5000; 0"},
    "static, turned handle": {**STATIC, "Handles/Names": "left, right", "Handles/right/Select": "boundary 2",
                              "Handles/right/Components": "x, z", "Handles/right/Motion": "-0.1*t; 0; 0.5*t"},
    "newton": DYNAMIC,
    "newton, BDF2, damping": {**DYNAMIC, "Time/Scheme": "bdf2", "Time/Mass damping": "1", "Time/Stiffness damping": "0.01"},
    "newton, lumped, quadratic": {**DYNAMIC, "Material/Mass matrix": "lumped", "Model/Element": "P2",
                                  "Mesh/Box cells": "4, 1, 1"},
    "newton, examples": {**DYNAMIC, **BENT, "Examples/Weights": "simplex"},
    "quasi newton": QUASI_NEWTON,
    "quasi newton, examples": {**QUASI_NEWTON, **BENT, "Examples/Weights": "free"},
    "newton, free body": {**DYNAMIC, "Handles/Names": "", "Handles/left/Select": None, "Handles/left/Motion": None,
                          "Initial/Velocity": "-y; x; 0.1*x"},
    "one pass": {**DYNAMIC, "Solver/Method": "one pass", "Solver/Tolerance": None, **BENT,
                 "Model/Gradient": "frozen", "Examples/Weights": "free"},
    "fixed point": {**DYNAMIC, "Solver/Method": "fixed point", "Model/Gradient": "frozen", "Solver/Rotations": "predicted",
                    "Solver/Tolerance": "1e-10", "Solver/Maximum iterations": "200"},
    "interpolation": TWISTED,
}


def launch(n, *arguments, environment=None, timeout=240):
    """mpirun -n N exemplar ...; what it said on stderr of our own words."""
    done = subprocess.run(["mpirun", "-n", str(n), EXEMPLAR, *map(str, arguments)], text=True, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=timeout,
                          env={**os.environ, **MPI_ENVIRONMENT, **(environment or {})})
    own = [line for line in done.stderr.splitlines() if line.startswith(("exemplar: ", "Warning: "))]
    return done.returncode, own, done


@unittest.skipUnless(shutil.which("mpirun") and has_trilinos(), "without mpirun, or built without Trilinos")
class SeveralProcesses(SceneTest):
    def run_on(self, n, scene, *arguments, output=None):
        file = write_scene(self.directory / "scene.prm", scene)
        output = self.directory / (output or f"on_{n}")
        status, own, done = launch(n, file, "--quiet", "--output", output, *arguments)
        self.assertEqual((status, own), (0, []), done.stderr)
        return output

    def displacement(self, output, scene):
        """Greatest of a node, from the box at rest."""
        rest = self.write_box(scene, "rest.msh").nodes
        moved = nodes_of(output / "final.msh")
        return greatest_distance({number: moved[number] for number in rest}, rest)

    def compare(self, one, several, scale, tolerance):
        a, b = read_msh(one / "final.msh"), read_msh(several / "final.msh")
        self.assertEqual(a.elements, b.elements)
        self.assertEqual(list(a.nodes), list(b.nodes))
        self.assertLess(greatest_distance(a.nodes, b.nodes), tolerance * scale)
        ours, theirs = read_csv(one), read_csv(several)
        self.assertEqual(ours[0].keys(), theirs[0].keys())
        for mine, other in zip(ours, theirs):
            for name, value in mine.items():
                if name.startswith(("energy_", "weight_", "work_", "momentum", "reaction")) and value is not None:
                    size = max(abs(row[column] or 0.) for row in ours for column in row if column[:6] == name[:6])
                    self.assertLess(abs(value - other[name]), 1e-6 * size + 1e-12, (name, mine["step"]))

    def test_results_are_those_of_one_process(self):
        for n, names in ((2, SCENES), (3, ("static", "newton, examples", "static, quadratic", "interpolation"))):
            for name in names:
                with self.subTest(scene=name, processes=n):
                    scene = SCENES[name]
                    one = self.solve(scene, "--quiet", output=f"one_{name}")
                    self.compare(one, self.run_on(n, scene, output=f"on_{n}_{name}"),
                                 self.displacement(one, scene), 1e-8)


if __name__ == "__main__":
    unittest.main()
