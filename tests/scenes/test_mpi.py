# SPDX-License-Identifier: GPL-3.0-or-later
"""The same scene by several processes under mpirun: its results are those of one process."""

import os
import re
import shutil
import unittest
import xml.etree.ElementTree

from math import cos, sin

from exemplar_runner import (REPOSITORY, SceneTest, bend, greatest_distance, has_trilinos, nodes_of, read_csv, read_msh, read_pvd,
                             read_summary, read_vtu, results, timeless_statistics, twist, write_msh, write_scene)
from mpirun import launch

# runs several scenes in one start: tests/mpi/run_scenes.cc
RUN_SCENES = os.path.abspath(os.environ.get("RUN_SCENES", REPOSITORY / "build/release/tests/run_scenes"))

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
DYNAMIC = {**BODY, "Scene": "dynamic", "Time/Increments": None, "Time/Step": "0.02", "Time/End": "0.1", "Solver/Method": "newton",
           "Solver/Tolerance": "1e-11", "Handles/left/Motion": "0; 0; 0.3*sin(4*t)"}
# in one process with a factor, in several with a multigrid hierarchy
QUASI_NEWTON = {**DYNAMIC, "Solver/Method": "quasi newton", "Solver/Step tolerance": "1e-11"}
FIBRES = {"Material/Fibre stiffness": "1e6", "Material/Fibre direction": "1; 0.3*y; 0.2"}
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
    "static, neo-Hookean patches": {**STATIC, "Model/Background": "neo-hookean", "Examples/Pose functions": bend("pi/2"),
                                    "Examples/Importance": "0.4", "Examples/Energy": "blended", "Examples/Weights": "free"},
    "static, Green": {**STATIC, "Model/Strain": "green"},
    "static, linear": {**STATIC, "Model/Strain": "linear"},
    "static, examples": {**STATIC, **BENT, "Examples/Weights": "free"},
    "static, bounded weights": {**STATIC, **BENT, "Examples/Weights": "simplex"},
    "static, regions that are found": {**STATIC, "Mesh/Box size": "8, 1, 1", "Mesh/Box cells": "16, 2, 2", "Examples/Regions": "auto",
                                       "Loads/Gravity": "0, 0, -1",
                                       "Examples/Pose functions": "x; y; z-0.1*max(0,3-x)^2 | x; y; z-0.1*max(0,x-5)^2"},
    "static, additive weights": {**STATIC, **BENT, "Examples/Weights": "additive", "Examples/Yield": "10",
                                 "Examples/Pose functions": bend("-pi/2") + " | 1.2*x; y; z"},
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
    "static, weights that remember": {**STATIC, **BENT, "Examples/Yield": "300"},
    "newton, examples": {**DYNAMIC, **BENT, "Examples/Weights": "simplex"},
    "newton, weights that remember": {**DYNAMIC, **BENT, "Examples/Yield": "300", "Examples/Creep viscosity": "100",
                                      "Time/Scheme": "bdf2"},
    "quasi newton": QUASI_NEWTON,
    "quasi newton, examples": {**QUASI_NEWTON, **BENT, "Examples/Weights": "free"},
    "newton, free body": {**DYNAMIC, "Handles/Names": "", "Handles/left/Select": None, "Handles/left/Motion": None,
                          "Initial/Velocity": "-y; x; 0.1*x"},
    "static, yields": {**STATIC, "Material/Yield stress": "2e4", "Material/Kinematic hardening": "2e5"},
    "newton, yields": {**DYNAMIC, "Material/Yield stress": "2e4", "Material/Isotropic hardening": "2e5"},
    "static, yields between fibres": {**STATIC, **FIBRES, "Material/Yield stress": "2e4", "Material/Kinematic hardening": "2e5"},
    "newton, yields between fibres": {**DYNAMIC, **BENT, **FIBRES, "Examples/Energy": "blended", "Material/Yield stress": "2e4",
                                      "Material/Isotropic hardening": "2e5"},
    "one pass": {**DYNAMIC, "Solver/Method": "one pass", "Solver/Tolerance": None, **BENT,
                 "Model/Gradient": "frozen", "Examples/Weights": "free"},
    "fixed point": {**DYNAMIC, "Solver/Method": "fixed point", "Model/Gradient": "frozen", "Solver/Rotations": "predicted",
                    "Solver/Tolerance": "1e-10", "Solver/Maximum iterations": "200"},
    "interpolation": TWISTED,
}


@unittest.skipUnless(shutil.which("mpirun") and has_trilinos(), "without mpirun, or built without Trilinos")
class SeveralProcesses(SceneTest):
    def run_on(self, n, scene, *arguments, output=None):
        file = write_scene(self.directory / "scene.prm", scene)
        output = self.directory / (output or f"on_{n}")
        status, own, done = launch(n, file, "--quiet", "--output", output, *arguments)
        self.assertEqual((status, own), (0, []), done.stderr)
        return output

    def run_all_on(self, n, names):
        """All these scenes in one start of n processes; where each has written."""
        outputs = {name: self.directory / f"on_{n}_{name}" for name in names}
        words = [word for name, output in outputs.items()
                 for word in (write_scene(self.directory / f"scene_{name}.prm", SCENES[name]), output)]
        status, own, done = launch(n, *words, program=RUN_SCENES)
        self.assertEqual((status, own), (0, []), done.stderr)
        return outputs

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
        for n, names in ((2, SCENES), (4, ("newton, examples",)), (3, ("static", "newton, examples", "static, quadratic", "interpolation"))):
            several = self.run_all_on(n, names)
            for name in names:
                with self.subTest(scene=name, processes=n):
                    one = self.solve(SCENES[name], "--quiet", output=f"one_{name}")
                    self.compare(one, several[name], self.displacement(one, SCENES[name]), 1e-8)

    def test_cells_that_keys_squeeze(self):
        """Are named by their numbers in the body, the worst one with its keys, wherever it is."""
        poses = " | ".join(f"x>2 ? 2 + 0.6*(x-2) : x; y; z + {shear}*y" for shear in (0, 0.01, 0.02))
        scene = {**STATIC, "Examples/Pose functions": poses, "Examples/Weights": "additive"}
        one = self.attempt(scene, "--quiet", output="one").stderr.splitlines()
        self.assertRegex(one[0], r"may want a stretch of 0 or less.* keys 1 \(.*, 2 \(.*, 3 \(.* want a strain of -1.2")
        for n in 2, 3:
            _, own, _ = launch(n, self.directory / "scene.prm", "--quiet", "--output", self.directory / f"on_{n}")
            self.assertEqual(own[0], one[0])

    def test_a_bar_that_was_bent_stays_bent(self):
        """Weights that have moved and are remembered when the force is gone."""
        scene = {**STATIC, **BENT, "Examples/Energy": "blended", "Examples/Yield": "1000", "Time/Increments": "4", "Loads/Gravity": None,
                 "Loads/Names": "pull", "Loads/pull/Select": "boundary 2", "Loads/pull/Force": "0; 0; 20000*(1-abs(2*t-1))"}
        one, two = self.solve(scene, "--quiet", output="one"), self.run_on(2, scene)
        self.assertGreater(read_csv(two)[-1]["weight_1"], 0.1)
        self.compare(one, two, self.displacement(one, scene), 1e-8)

    def test_verify(self):
        """Cases of one process by the root alone, and bodies that all share."""
        status, own, done = launch(2, "verify", "uniform-scale", "shared-stretch", "shared-static", "shared-dynamics")
        self.assertEqual((status, own), (0, []), done.stdout + done.stderr)
        head, *lines, last = done.stdout.splitlines()
        self.assertEqual([line.split()[:2] for line in lines],
                         [["PASS", "uniform-scale"], *[["PASS", "shared-stretch"]] * 2,
                          *[["PASS", "shared-static"]] * 2, *[["PASS", "shared-dynamics"]] * 2])
        self.assertEqual(last, "4 of 4 cases pass")
        self.assertEqual(self.call("verify", "shared-static").status, 1)  # nobody to share it with

    def test_a_log_without_escapes(self):
        scene = write_scene(self.directory / "scene.prm", STATIC)
        status, own, done = launch(2, scene, "--output", self.directory / "out")
        self.assertEqual((status, own), (0, []), done.stderr)
        for letter in ("\r", "\x1b"):
            self.assertNotIn(letter, done.stdout)
        self.assertIn("with fewer than 50000 cells one process is faster: start without mpirun", done.stdout)
        log = (self.directory / "out/log.txt").read_text()
        self.assertEqual(log.count("Where the time went"), 1)
        self.assertIn("2 processes of 1 thread", log)

    def test_what_surfaces_files_and_regions_say(self):
        two = {**STATIC, "Mesh/Generator": None, "Mesh/Box size": None, "Mesh/Box cells": None, "Mesh/File": "two.msh",
               "Material/region 2/Young's modulus": "3e6", **BENT, "Examples/Weights": "free",
               "Examples/Weights per region": "true", "Handles/Names": "left, listed, led",
               "Handles/left/Select": "region 3", "Handles/listed/Select": "nodes listed.txt",
               "Handles/led/Select": "boundary 2", "Handles/led/Follow pose": "led.msh", "Handles/led/Progress": "0.3*t",
               "Initial/Pose": "led.msh"}
        box = self.write_box(STATIC, "box.msh")

        def region(element):
            middle = sum(box.nodes[node][0] for node in element[-4:]) / 4.
            return 3 if middle < 0.5 else 1 if middle < 2.5 else 2
        marked = [element if element[1] != 4 else (*element[:3], region(element), *element[4:]) for element in box.elements]
        write_msh(self.directory / "two.msh", box._replace(elements=marked))
        write_msh(self.directory / "led.msh", box._replace(elements=marked),
                  lambda x, y, z: (x * cos(0.5) - y * sin(0.5), x * sin(0.5) + y * cos(0.5), z))
        some = [str(number) for number, (x, y, z) in box.nodes.items() if abs(x - 2.) < 1e-9 and z > 0.4]
        (self.directory / "listed.txt").write_text(" ".join(some))
        one = self.solve(two, "--quiet", output="one")
        for n in (2, 3):
            with self.subTest(processes=n):
                self.compare(one, self.run_on(n, two), 1., 1e-8)

    def test_what_the_surface_says(self):
        """A painted body, held where a map says and pulled around a vertex; of a mesh that is given, and one that is made."""
        vertices = [(x, y, z) for x in (0., 2., 4.) for y in (-.5, .5) for z in (-.5, .5)]
        faces = [(1, 2, 4, 3), (9, 11, 12, 10)]
        for k in (0, 4):
            faces += [(1 + k, 5 + k, 6 + k, 2 + k), (3 + k, 4 + k, 8 + k, 7 + k), (1 + k, 3 + k, 7 + k, 5 + k), (2 + k, 6 + k, 8 + k, 4 + k)]
        self.write("box.obj", "\n".join(["v {} {} {}".format(*v) for v in vertices]
                                        + [f"f {a} {b} {c}\nf {a} {c} {d}" for a, b, c, d in faces]) + "\n")
        self.write("along.csv", "\n".join(str(v[0] / 4.) for v in vertices) + "\n")
        scene = {**STATIC, "Mesh/Surface": "box.obj", "Material/Young's modulus map": "along.csv from 1 to 3", "Loads/Gravity": None,
                 "Handles/left/Select": "map along.csv below 0.05", "Loads/Names": "pull",
                 "Loads/pull/Select": "vertex 8 within 0.8", "Loads/pull/Force": "0; 3000; 5000"}
        made = {**scene, "Mesh/Surface": None, "Mesh/Generator": None, "Mesh/Box size": None, "Mesh/Box cells": None,
                "Mesh/File": "box.obj", "Mesh/Cells": "300"}
        for name, which in (("given", scene), ("made", made)):
            one = self.solve(which, "--quiet", output=f"one_{name}")
            for n in (2, 3):
                with self.subTest(mesh=name, processes=n):
                    several = self.run_on(n, which, output=f"on_{n}_{name}")
                    self.compare(one, several, 0.1, 1e-8)
                    if name == "made":
                        self.assertEqual((one / "rest.msh").read_bytes(), (several / "rest.msh").read_bytes())

    def test_bytes_repeat(self):
        scene = {**SCENES["newton, examples"], "Output/Every": "5"}
        first, second = (self.run_on(2, scene, output=name) for name in ("first", "second"))
        self.assertEqual(timeless_statistics(first), timeless_statistics(second))
        names = sorted(file.name for file in first.iterdir() if re.match(r"frame_|final|animation", file.name))
        self.assertIn("frame_0005_process_0001.vtu", names)
        for name in names:
            self.assertEqual((first / name).read_bytes(), (second / name).read_bytes(), name)

    def test_one_process_is_that_without_mpirun(self):
        scene = {**SCENES["newton, examples"], "Output/Every": "5"}
        self.assertEqual(results(self.solve(scene, "--quiet", output="alone")), results(self.run_on(1, scene)))

    def test_pieces_make_the_frame(self):
        scene = {**DYNAMIC, "Output/Every": "5"}
        one = self.solve(scene, "--quiet", output="one")
        three = self.run_on(3, scene)
        self.assertEqual([file for _, file in read_pvd(three)], ["frame_0000.pvtu", "frame_0005.pvtu"])
        joint = xml.etree.ElementTree.parse(three / "frame_0005.pvtu").getroot()
        pieces = [piece.get("Source") for piece in joint.iter("Piece")]
        self.assertEqual(pieces, [f"frame_0005_process_000{i}.vtu" for i in range(3)])

        def cells(files):
            """Of each cell its corners' displacements, rounded, and its values."""
            found = []
            for arrays, _, n_cells in map(read_vtu, files):
                place, nodes = arrays["Points", "Points"], arrays["Cells", "connectivity"]
                declared = {array.get("Name") for array in joint.iter("PDataArray")}
                self.assertEqual({name for section, name in arrays if section != "Cells"}, declared)
                for cell in range(n_cells):
                    corners = sorted(tuple(round(x, 6) + 0. for x in place[3 * node:3 * node + 3])
                                     for node in nodes[4 * cell:4 * cell + 4])
                    found.append((corners, round(arrays["CellData", "det_F"][cell], 6)))
            return sorted(found)
        self.assertEqual(cells([one / "frame_0005.vtu"]), cells([three / piece for piece in pieces]))

    def test_a_run_goes_on_with_another_number_of_processes(self):
        scene = {**SCENES["newton, BDF2, damping"], **BENT, "Examples/Weights": "simplex", "Output/Every": "1"}
        whole = self.solve(scene, "--quiet", output="whole")
        half = {**scene, "Time/End": "0.06"}
        for before, after in ((3, 2), (2, 1), (1, 3)):
            with self.subTest(before=before, after=after):
                output = f"{before}_{after}"
                self.run_on(before, half, output=output)
                resumed = self.run_on(after, scene, "--resume", output=output)
                self.compare(whole, resumed, 1., 1e-8)
                self.assertEqual(len(read_pvd(resumed)), 6)

    def test_what_has_yielded_goes_on_with_another_number_of_processes(self):
        states = {"Output/Every": "1", "Output/Keep states": "true"}
        scenes = {"static": {**SCENES["static, yields"], "Time/Increments": "4", **states},
                  "dynamic": {**QUASI_NEWTON, "Material/Yield stress": "2e4", "Material/Isotropic hardening": "2e5", **states}}
        for (name, scene), (before, after) in zip(scenes.items(), ((2, 1), (1, 2))):
            with self.subTest(scene=name):
                whole = self.solve(scene, "--quiet", output=f"whole_{name}")
                self.assertGreater(read_csv(whole)[-1]["energy_dissipated"], 0)
                self.run_on(before, scene, output=name)
                self.compare(whole, self.run_on(after, scene, "--resume-from", "2", output=name), 1., 1e-8)

    def test_a_quasi_newton_step_of_the_cat_is_that_of_one_process(self):
        cat = REPOSITORY / "tests/benchmark/scenes/cat_mid60_examples.prm"
        step = 1. / 60.

        def go_on(n, to, output):
            words = ["--quiet", "--output", output, "--resume", "--set", "Output/Every=0", "--set", f"Time/End={to}"]
            if n == 1:
                self.assertEqual(self.call(cat, *words).status, 0)
            else:
                self.assertEqual(launch(n, cat, *words)[:2], (0, []))
            return nodes_of(output / "final.msh")
        start = self.run_file(cat, "start", f"Time/End={10 * step}")
        before = nodes_of(start / "final.msh")
        ends = {}
        for n in (1, 2, 3):
            output = self.directory / f"from_{n}"
            shutil.copytree(start, output)
            ends[n] = go_on(n, 11 * step, output)
        moved = greatest_distance(before, ends[1])
        self.assertGreater(moved, 0.01)
        for n in (2, 3):
            with self.subTest(processes=n):
                self.assertLess(greatest_distance(ends[1], ends[n]), 1e-3 * moved)
        # on 2 from a checkpoint of 3
        third = self.directory / "from_3"
        twelfth, other = go_on(2, 12 * step, third), go_on(1, 12 * step, self.directory / "from_1")
        self.assertLess(greatest_distance(twelfth, other), 3e-3 * greatest_distance(ends[1], other))

    def test_the_summary_tells_of_all_processes(self):
        one, two = (read_summary(self.solve(STATIC, "--quiet", output="one")), read_summary(self.run_on(2, STATIC)))
        for key in ("cells", "nodes", "dofs", "constrained_dofs", "steps"):
            self.assertEqual(one[key], two[key], key)
        for n, summary in ((1, one), (2, two)):
            self.assertEqual((summary["processes"], len(summary["peak_memory_mib_of_processes"])), (n, n))


if __name__ == "__main__":
    unittest.main()
