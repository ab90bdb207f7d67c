# SPDX-License-Identifier: GPL-3.0-or-later
"""What a problem is made of can be read back, printed, written and shown; and files that it was made of are not read again unseen."""
import contextlib
import importlib.util
import os
import re
import tempfile
import threading
import unittest
from pathlib import Path

import numpy as np

import exemplar
from test_interface import BAR
from test_live import arrays

FRAME = b'<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0"'
MSH = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
{}
$EndNodes
$Elements
{}
$EndElements
"""


def write_msh(file, nodes, cells):
    rows = [f"{i + 1} {x} {y} {z}" for i, (x, y, z) in enumerate(nodes)]
    elements = [f"{i + 1} 4 2 1 1 " + " ".join(str(node + 1) for node in cell) for i, cell in enumerate(cells)]
    file.write_text(MSH.format("\n".join([str(len(rows)), *rows]), "\n".join([str(len(elements)), *elements])))


class ReadBack(unittest.TestCase):
    def test_material(self):
        problem = exemplar.Problem({**BAR, "Material": {"Young's modulus": 3e5, "Poisson's ratio": .3, "Density": 800}})
        m = len(problem.cells)
        for name, value, other in ("young", 3e5, np.linspace(1e5, 2e5, m)), ("poisson", .3, np.linspace(.1, .4, m)), ("density", 800, np.linspace(1, 2, m)):
            np.testing.assert_allclose(getattr(problem, name), np.full(m, value), rtol=1e-14)
            problem.set_material(**{name: other})
            np.testing.assert_allclose(getattr(problem, name), other, rtol=1e-14)
            with self.assertRaises(ValueError):
                getattr(problem, name)[0] = 1
            with self.assertRaisesRegex(AttributeError, rf"problem.set_material\({name}=...\)"):
                setattr(problem, name, 1)

    def test_material_of_other_laws(self):
        nine = exemplar.Problem({**BAR, "Examples": {}, "Material": {"Fibre direction": "1; 0; 0", "Cross direction": "0; 1; 0",
                                                                                "Orthotropy": "2e5, 1e5, 0.7e5, 0.3, 0.25, 0.2, 0.3e5, 0.4e5, 0.5e5"}})
        self.assertTrue(np.isnan(nine.young).all() and np.isnan(nine.poisson).all() and (nine.density > 0).all())

    def test_volumes_and_surface(self):
        nodes, cells, _ = arrays()
        problem = exemplar.Problem({"Scene": "static", "Handles": {"left": {"Select": ["box", 0, 0, 0, 0, 1, 1]}}}, mesh=(nodes, cells))
        x = nodes[problem.cells]
        np.testing.assert_allclose(problem.volumes, np.linalg.det(x[:, 1:] - x[:, :1]) / 6, rtol=1e-12)
        corners = nodes[problem.surface_triangles]
        self.assertAlmostEqual(np.einsum("ti,ti", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6, problem.volumes.sum())

    def test_handles(self):
        problem = exemplar.Problem(BAR)
        self.assertEqual(list(problem.handles), ["left", "right"])
        np.testing.assert_array_equal(problem.handles["left"], np.flatnonzero(problem.rest_positions[:, 0] == 0))
        problem.let_go("left")
        problem.hold("nose", [17, 3])
        self.assertEqual({name: nodes.tolist() for name, nodes in problem.handles.items() if name != "right"}, {"left": [], "nose": [3, 17]})
        problem.hold("left")
        self.assertEqual(len(problem.handles["left"]), 9)
        quadratic = exemplar.Problem({**BAR, "Model": {"Element": "P2"}})
        np.testing.assert_array_equal(quadratic.handles["left"], np.flatnonzero(quadratic.state.positions[:, 0] < 1e-9))

    def test_examples(self):
        self.assertEqual(exemplar.Problem({**BAR, "Examples": {}}).example_names, [])
        nodes, cells, pose = arrays()
        scene = {"Scene": "static", "Handles": {"left": {"Select": ["box", 0, 0, 0, 0, 1, 1]}}}
        names = exemplar.Problem(scene, mesh=(nodes, cells), poses=[pose, pose + .01 * nodes[:, :1]]).example_names
        self.assertEqual([Path(name).name for name in names], ["rest pose", "pose_0", "pose_1"])

    def test_weight_regions(self):
        """A long bar whose halves bend in one example each has a region for each."""
        bar = {"Scene": "static", "Mesh": {"Generator": "box", "Box size": [10, 1, 1], "Box cells": [20, 2, 2]},
               "Handles": {"middle": {"Select": ["box", 4.9, 0, 0, 5.1, 1, 1]}}}
        poses = ["x; y; z + (x < 4 ? .1 * (4 - x)^2 : 0)", "x; y; z + (x > 6 ? .1 * (x - 6)^2 : 0)"]
        found = exemplar.Problem({**bar, "Examples": {"Pose functions": " | ".join(poses), "Regions": "auto"}})
        self.assertEqual([region["region"] for region in found.weight_regions], list(range(1, len(found.weight_regions) + 1)))
        self.assertGreater(len(found.weight_regions), 1)
        self.assertEqual(sum(region["cells"] for region in found.weight_regions), len(found.cells))
        self.assertAlmostEqual(sum(region["volume"] for region in found.weight_regions), 1)
        self.assertEqual(exemplar.Problem(bar).weight_regions, [])

    def test_repr(self):
        problem = exemplar.Problem(BAR)
        problem.step()
        self.assertEqual(repr(problem), "<exemplar.Problem: scene (dynamic), 45 nodes, 96 cells, step 1 of 2, time 0.05>")
        told = []
        problem.on_iteration(lambda report: threading.Thread(target=lambda: told.append(repr(problem))).start() if not told else None)
        problem.step()
        self.assertIn("another thread makes a step", (told or [repr(problem) + "another thread makes a step"])[0])


class Directory(unittest.TestCase):
    def setUp(self):
        self.here = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.enterContext(contextlib.chdir(self.here))


class Write(Directory):
    def test_a_frame_as_runs_write_it(self):
        problem = exemplar.Problem(BAR)
        problem.step()
        problem.write("body.vtu")
        first = Path("body.vtu").read_bytes()
        self.assertTrue(first.startswith(FRAME))
        for name in "displacement", "velocity", "strain_energy_density", "det_F", "von_mises_stress", "region":
            self.assertIn(f'Name="{name}"'.encode(), first)
        problem.step()
        problem.write(Path("body.vtu"))
        self.assertNotEqual(Path("body.vtu").read_bytes(), first)
        self.assertEqual(os.listdir(), ["body.vtu"])

    def test_what_is_not_ours_stays(self):
        problem = exemplar.Problem(BAR)
        Path("mine.vtu").write_text("mine")
        Path("half.vtu").write_bytes(FRAME + b">\n half of another program's")
        Path("directory.vtu").mkdir()
        Path("link.vtu").symlink_to("nowhere.vtu")
        Path("temporary.vtu.tmp").write_text("mine")
        before = sorted(os.listdir())
        for name, words in (("mine.vtu", "was not written by exemplar"), ("half.vtu", "was not written by exemplar"), ("directory.vtu", "is a directory"),
                            ("link.vtu", "is a link"), ("temporary.vtu", "temporary.vtu.tmp: is to be written, but"), ("body.vtk", "ends in .vtu"),
                            ("absent/body.vtu", "there is no directory .*absent"), ("", "ends in .vtu"), ("a\0.vtu", "NUL")):
            with self.subTest(name), self.assertRaisesRegex(exemplar.UserError, words):
                problem.write(name)
        self.assertEqual((sorted(os.listdir()), Path("mine.vtu").read_text()), (before, "mine"))
        with self.assertRaisesRegex(TypeError, "file must be a path, but is a int"):
            problem.write(3)

    def test_within_a_step_it_is_refused(self):
        problem = exemplar.Problem(BAR)
        problem.on_iteration(lambda report: problem.write("body.vtu"))
        with self.assertRaisesRegex(RuntimeError, r"write\(\)"):
            problem.step()


class Files(Directory):
    def make(self, **more):
        nodes, cells, _ = arrays()
        write_msh(Path("body.msh"), nodes, cells)
        return exemplar.Problem({**BAR, "Mesh": {"File": "body.msh"}, "Examples": {}, "Model": {"Dilatation": "cells"},
                                 "Handles": {"left": {"Select": ["box", 0, 0, 0, 0, 1, 1]}}, "Loads": {"Gravity": [0, 0, -1]}, **more})

    def steps(self, problem):
        return [(problem.step(), problem.positions.tobytes())[1] for _ in range(2)]

    def test_reset_reads_no_file(self):
        problem = self.make()
        first = self.steps(problem)
        for spoil in (lambda: Path("body.msh").write_text("half a"), lambda: Path("body.msh").unlink(), lambda: os.chdir("/")):
            spoil()
            problem.reset()
            self.assertEqual(self.steps(problem), first)

    def test_live_reads_what_was_read(self):
        problem = self.make()
        Path("body.msh").write_text(Path("body.msh").read_text() + "\n")
        with self.assertRaisesRegex(exemplar.UserError, r"live\(\): .*body.msh has changed since this problem was made of it.* anew"):
            problem.live()
        Path("body.msh").unlink()
        with self.assertRaisesRegex(exemplar.UserError, "body.msh has changed"):
            problem.live()

    def test_an_input_is_not_written_over(self):
        problem = self.make()
        os.link("body.msh", "same.vtu")
        with self.assertRaisesRegex(exemplar.UserError, "is the input"):
            problem.write("same.vtu")


@unittest.skipUnless(importlib.util.find_spec("matplotlib"), "needs matplotlib")
class Animation(Directory):
    def tearDown(self):
        import matplotlib.pyplot as plt
        plt.close("all")

    def test_of_the_steps_that_are_left(self):
        problem = exemplar.Problem(BAR)
        player = problem.animate()
        self.assertEqual(problem.step_number, 2)
        page = player._repr_html_()
        self.assertEqual(len(re.findall(r"frames\[\d+\] = ", page)), 3)

    def test_of_positions_that_are_given(self):
        problem = exemplar.Problem(BAR)
        with problem.record() as trajectory:
            problem.run()
        player = problem.animate(trajectory.positions, interval=20)
        drawn = player._fig.axes[0].collections[0]
        player._draw_frame(1)
        moved = drawn._vec[:3].T.reshape(-1, 3, 3)
        np.testing.assert_allclose(moved, trajectory.positions[1][problem.surface_triangles], atol=1e-6)

    def test_what_is_refused(self):
        import matplotlib.pyplot as plt
        problem = exemplar.Problem(BAR)
        at_end = exemplar.Problem(BAR)
        at_end.run()
        x = problem.positions
        for words, call in (("there are 1 positions", lambda: problem.animate([x])), (r"positions\[1\] has shape \(3,\)", lambda: problem.animate([x, x[0]])),
                            (r"positions\[0\] is no array of real", lambda: problem.animate([1j * x, x])), ("not of space", lambda: problem.animate([x, x], axes=plt.figure().gca())),
                            (r"reset\(\) it before", lambda: at_end.animate())):
            with self.subTest(words), self.assertRaisesRegex(exemplar.UserError, words):
                call()
        with self.assertRaisesRegex(TypeError, "animate is called as"):
            problem.animate(1, 2, 3, 4)


if __name__ == "__main__":
    os.environ["MPLBACKEND"] = "Agg"
    unittest.main()
