# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes of prm/ show what they say: every one is valid, the poses are what their scenes make,
interpolations end at their examples, and examples change what the same drag does.

The drags take longest, and are the same with other paws and hooves: the first half of one stands for them, and one pose for
the others, which are in a class of their own.
"""

import unittest

import numpy as np
from contact_reference import boundary
from exact_crossings import crossings
from exemplar_runner import REPOSITORY, SceneTest, bent, distance, greatest_distance, nodes_of, read_csv, read_vtu, twisted, \
    without_what_is_meant

PAPER = REPOSITORY / "prm/paper"
FIRST_POSE, FIRST_DRAG = "cat_paw", "fig2a_cat"


def files(pattern):
    """Those of the repository, of which there must be some."""
    found = sorted(REPOSITORY.glob(pattern))
    assert found, pattern
    return found


class PrmTest(SceneTest):
    def check_pose(self, scene):
        made = nodes_of(self.run_file(scene, scene.stem) / "final.msh")
        committed = nodes_of(REPOSITORY / f"meshes/poses/{scene.stem}.msh")
        self.assertLess(greatest_distance(made, committed), 1e-4)
        rest = nodes_of(REPOSITORY / f"meshes/{scene.stem.split('_')[0]}.msh")
        self.assertGreater(greatest_distance(made, rest), 0.2)

    def check_drag(self, scene, *settings):
        examples = self.run_file(scene, scene.stem, *settings)
        plain = self.run_file(scene, scene.stem + "_plain", "Examples/Importance=0", *settings)
        rows = read_csv(examples)
        self.assertGreaterEqual(len(rows), 51)
        self.assertEqual({row["inverted_cells"] for row in rows}, {0})
        weights = [rows[-1][f"weight_{i}"] for i in range(3)]
        self.assertAlmostEqual(sum(weights), 1, places=9)
        self.assertGreater(max(weights[1:]), 0.9, "an example is chosen")
        ends = [nodes_of(output / "final.msh") for output in (examples, plain)]
        self.assertGreater(greatest_distance(*ends), 0.3)

    def check_bodies_meet(self, scene, every):
        """They do, and in no frame an edge of the surface passes through a triangle."""
        output = self.run_file(REPOSITORY / f"prm/contact/{scene}.prm", scene, f"Output/Every={every}", "Output/Formats=vtu")
        self.assertGreater(max(row["body_pairs"] for row in read_csv(output)), 20)
        frames = sorted(output.glob("frame_*[0-9].vtu"))[1:]
        self.assertGreater(len(frames), 2)
        for file in frames:
            arrays, n, _ = read_vtu(file)
            triangles = boundary(np.array(arrays["Cells", "connectivity"]).reshape(-1, 4))
            self.assertEqual(crossings(np.array(arrays["Points", "Points"]).reshape(n, 3), triangles), [], file.name)


class PrmScenes(PrmTest):
    def test_every_scene_is_valid_and_says_what_to_expect(self):
        for scene in files("prm/**/*.prm"):
            with self.subTest(scene.name):
                run = self.call("--validate", scene)
                self.assertEqual((run.status, without_what_is_meant(run.stderr.splitlines())), (0, []))
                opening = scene.read_text().split("\n\n")[0]
                self.assertTrue(opening.startswith("#") and "Expect" in opening, opening)

    def test_a_pose_is_what_its_scene_makes(self):
        self.check_pose(REPOSITORY / f"prm/poses/{FIRST_POSE}.prm")

    def test_interpolations_end_at_their_examples(self):
        # strains to 1e-6, by the lengths of the edges of the generated box, x fastest
        rest = {1 + i + 17 * (j + 5 * k): (i / 4, j / 4 - 0.5, k / 4 - 0.5)
                for i in range(17) for j in range(5) for k in range(5)}
        edges = [(a, a + step) for a in rest for step in (1, 17, 18, 85, 86, 102, 103)
                 if a + step in rest and distance(rest[a], rest[a + step]) < 0.5]
        for name, example in (("fig1_twist", twisted), ("fig1_bend", bent), ("fig1_twist_to_bend", bent)):
            with self.subTest(name):
                end = nodes_of(self.run_file(PAPER / f"{name}.prm", name) / "final.msh")
                pose = {number: example(*position) for number, position in rest.items()}
                errors = [abs(distance(end[a], end[b]) / distance(pose[a], pose[b]) - 1) for a, b in edges]
                print(f"{name}: greatest relative error of an edge at the end {max(errors):.1e}")
                self.assertGreater(len(errors), 2000)
                self.assertLess(max(errors), 1e-6)

    def test_two_cats_run_into_each_other(self):
        self.check_bodies_meet("two_cats", 10)

    def test_examples_change_what_the_first_drag_does(self):
        self.check_drag(PAPER / f"{FIRST_DRAG}.prm", "Time/End=1")  # when the paw has come to rest


class OtherPrmScenes(PrmTest):
    def test_poses_are_what_their_scenes_make(self):
        for scene in files("prm/poses/*.prm"):
            if scene.stem != FIRST_POSE:
                with self.subTest(scene.stem):
                    self.check_pose(scene)

    def test_bodies_meet(self):
        for scene, every in (("cat_washes", 28), ("folded_plate", 35), ("eye_in_socket", 25)):
            with self.subTest(scene):
                self.check_bodies_meet(scene, every)

    def test_examples_change_what_a_drag_does(self):
        for scene in files("prm/paper/fig[23]*.prm"):
            with self.subTest(scene.stem):
                self.check_drag(scene)


if __name__ == "__main__":
    unittest.main()
