# SPDX-License-Identifier: GPL-3.0-or-later
"""Mesh/Files: several meshes in one scene are one mesh of several pieces, each with a scale, a place and groups of its own."""

import json
import unittest
from pathlib import Path

import numpy as np
from exemplar_runner import Msh, SceneTest, nodes_of, read_msh, timeless_statistics, write_msh
from mpirun import launch
from piece_boxes import Box, write_boxes

SMALL = Box((0, 0, 0), (1, 0.2, 0.2), (4, 1, 1))
OTHER = Box((0, 0, 0), (1000, 300, 200), (3, 1, 1))  # in millimetres
MOVED = Box((0, 0, 1), (1, 0.3, 1.2), (3, 1, 1))     # where OTHER stands
SCENE = {"Scene": "dynamic", "Mesh/Files": "bone.msh, skin.msh", "Mesh/skin/Scale": "1e-3", "Mesh/skin/Displacement": "0, 0, 1",
         "Material/Young's modulus": "1e6", "Material/region skin/Young's modulus": "1e5", "Material/Density": "1000",
         "Handles/Names": "left", "Handles/left/Select": "box -0.01 -1 -1  0.01 1 2", "Loads/Gravity": "0, 0, -9.81",
         "Time/Step": "0.01", "Time/End": "0.1", "Output/Every": "0", "Solver/Tolerance": "1e-10"}


def with_groups(file, volumes, names, triangles=()):
    """Give the cells of a file these tags, and boundaries (tag, nodes)."""
    msh = read_msh(file)
    elements = [(*e[:3], v, *e[4:]) for e, v in zip(msh.elements, volumes)]
    elements += [(len(elements) + 1 + i, 2, 2, tag, tag, *nodes) for i, (tag, nodes) in enumerate(triangles)]
    write_msh(file, Msh(msh.nodes, elements, []))
    lines = "".join(f'{dimension} {tag} "{name}"\n' for dimension, tag, name in names)
    text = file.read_text()
    file.write_text(text.replace("$Nodes", f"$PhysicalNames\n{len(names)}\n{lines}$EndPhysicalNames\n$Nodes", 1))


class MeshFiles(SceneTest):
    def setUp(self):
        super().setUp()
        write_boxes(self.directory / "bone.msh", SMALL)
        write_boxes(self.directory / "skin.msh", OTHER)

    def joined(self):
        """The same scene on one file of two pieces, by hand."""
        write_boxes(self.directory / "two.msh", SMALL, MOVED)
        with_groups(self.directory / "two.msh", 24 * [1] + 18 * [2], [])
        return {**{k: v for k, v in SCENE.items() if k.partition("/")[0] != "Mesh" and "region" not in k},
                "Mesh/File": "two.msh", "Material/region 2/Young's modulus": "1e5"}

    def test_as_one_file_of_two_pieces(self):
        both, one = self.solve(SCENE), self.solve(self.joined(), output="one", file="one.prm")
        np.testing.assert_allclose(list(nodes_of(both / "final.msh").values()), list(nodes_of(one / "final.msh").values()), atol=1e-13)

    def test_numbers_and_names(self):
        last = read_msh(self.solve(SCENE) / "final.msh")
        self.assertEqual([*last.nodes], [*range(1, 21), *range(101, 117)])  # 20 and 16 nodes: from 100 on
        self.assertEqual([e[0] for e in last.elements], [*range(1, 25), *range(101, 119)])
        text = (self.directory / "out/final.msh").read_text()
        self.assertIn('3 0 "bone"\n3 10 "skin"\n', text)
        self.assertEqual({e[3] for e in last.elements}, {0, 10})

    def test_groups_have_the_name_of_their_file(self):
        for name in ("bone", "skin"):
            file = self.directory / f"{name}.msh"
            n = len(read_msh(file).elements)
            ends = [e for e in read_msh(file).nodes.items() if e[1][0] == 0][:3]
            with_groups(file, [1] * 6 + [2] * (n - 6), [(3, 2, "far")], [(7, [number for number, _ in ends])])
        scene = {**{k: v for k, v in SCENE.items() if "region" not in k}, "Material/region skin far/Young's modulus": "1e5",
                 "Handles/Names": "left, right", "Handles/left/Select": "region bone 1", "Handles/right/Select": "boundary skin 7"}
        if self.attempt(scene).status:  # the three nodes may be of no face
            self.assertIn("that are no face of a tetrahedron", self.attempt(scene).stderr)
        wrong = self.attempt({**scene, "Handles/left/Select": "region skin fra"})
        self.assertEqual(wrong.status, 1)

    def test_a_file_again(self):
        again = {**SCENE, "Mesh/Files": "bone.msh, bone.msh", "Mesh/skin/Scale": None, "Mesh/skin/Displacement": None,
                 "Material/region skin/Young's modulus": None, "Mesh/bone 2/Displacement": "0, 0, 1"}
        output = self.solve({k: v for k, v in again.items() if v is not None})
        last = list(nodes_of(output / "final.msh").values())
        np.testing.assert_allclose(last[20:], np.add(last[:20], [0, 0, 1]), atol=1e-9)
        warned = self.attempt({**{k: v for k, v in again.items() if v is not None}, "Mesh/skin/Scale": "2"})
        self.assertIn("subsection Mesh/skin is not in Mesh/Files (there: bone, bone 2), so it is not used", warned.stderr)

    def test_a_pose_of_one_file(self):
        msh = read_msh(self.directory / "skin.msh")
        write_msh(self.directory / "bent.msh", msh, lambda x, y, z: (x, y, z + 1e-3 * x * x))
        scene = {**SCENE, "Scene": "static", "Time/Step": None, "Time/End": None, "Loads/Gravity": None, "Examples/Poses": "bent.msh",
                 "Handles/left/Select": "region bone", "Handles/Names": "left, posed", "Handles/posed/Select": "region skin",
                 "Handles/posed/Follow pose": "bent.msh", "Handles/left/Components": "x, y, z", "Time/Increments": "1"}
        scene = {k: v for k, v in scene.items() if v is not None}
        scene["Handles/posed/Components"] = "x, y, z"
        scene["Handles/left/Select"] = "box -0.01 -1 -1  0.01 1 0.5"
        output = self.solve(scene)
        nodes = list(nodes_of(output / "final.msh").values())
        bent = [(x * 1e-3, y * 1e-3, 1 + 1e-3 * (z + 1e-3 * x * x)) for x, y, z in msh.nodes.values()]
        np.testing.assert_allclose(nodes[20:], bent, atol=1e-9)
        np.testing.assert_allclose(nodes[:20], list(read_msh(self.directory / "bone.msh").nodes.values()), atol=1e-6)
        whole = self.solve({**scene, "Examples/Poses": str(output / "final.msh"), "Handles/posed/Follow pose": str(output / "final.msh")},
                           output="whole", file="whole.prm")  # final.msh is a pose of the whole
        np.testing.assert_allclose(list(nodes_of(whole / "final.msh").values()), nodes, atol=1e-9)
        twice = {**SCENE, "Mesh/Files": "bone.msh, bone.msh", "Examples/Poses": "bone.msh"}
        run = self.attempt({k: v for k, v in twice.items() if "skin" not in k})
        self.assertIn("bone.msh is no pose of", run.stderr)
        self.assertIn("it fits 'bone' and 'bone 2' alike", run.stderr)

    def test_resume_processes_and_validate(self):
        whole = self.solve({**SCENE, "Time/End": "0.2"}, output="whole")
        self.solve({**SCENE, "Time/End": "0.1"}, output="half")
        self.solve({**SCENE, "Time/End": "0.2"}, "--resume", output="half")
        self.assertEqual((whole / "final.msh").read_bytes(), (self.directory / "half/final.msh").read_bytes())
        self.assertEqual(timeless_statistics(whole), timeless_statistics(self.directory / "half"))
        digest = json.loads((whole / "summary.json").read_text())["mesh_sha256"]
        self.assertEqual(len(digest), 64)
        run = self.attempt(SCENE)
        shared = launch(2, self.directory / "scene.prm", "--output", self.directory / "shared", "--quiet")
        self.assertEqual(shared[0], 0, shared[1])
        np.testing.assert_allclose([list(x) for x in nodes_of(run.output / "final.msh").values()],
                                   [list(x) for x in nodes_of(self.directory / "shared/final.msh").values()], atol=2e-5)
        self.assertEqual(self.call("--validate", self.directory / "scene.prm").status, 0)

    def test_a_changed_file_is_not_resumed(self):
        self.solve({**SCENE, "Time/End": "0.1"})
        write_boxes(self.directory / "skin.msh", Box((0, 0, 0), (1000, 300, 210), (3, 1, 1)))
        run = self.attempt({**SCENE, "Time/End": "0.2"}, "--resume")
        self.assertEqual(run.status, 1)
        self.assertIn("skin.msh has changed since", run.stderr)

    def test_what_is_refused(self):
        (self.directory / "body.obj").write_text("v 0 0 0\n")
        (self.directory / "part.geo").write_text("Point(1) = {0, 0, 0};\n")
        Path(self.directory / "more").mkdir()
        write_boxes(self.directory / "more/bone.msh", SMALL)
        plain = {k: v for k, v in SCENE.items() if "skin" not in k}
        for files, words in (("bone.msh, body.obj", "body.obj is a surface. Fill it with cells"),
                             ("bone.msh, part.geo", "part.geo is a geometry. Mesh it"),
                             ("bone.msh, more/bone.msh", "two files are called bone"),
                             ("bone.msh, nothing.msh", "Mesh/Files: "),
                             ("bone.msh, scene.prm", "scene.prm")):
            with self.subTest(files):
                run = self.attempt({**plain, "Mesh/Files": files})
                self.assertEqual(run.status, 1)
                self.assertIn(words, run.stderr)
                self.assertFalse(run.output.exists())
        run = self.attempt({**SCENE, "Mesh/File": "bone.msh"})
        self.assertIn("both Files and File are given", run.stderr)


if __name__ == "__main__":
    unittest.main()
