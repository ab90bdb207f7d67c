# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that are tied to places of another piece, against closed forms: two bars are one, springs in series, bodies that fly."""

import unittest

import numpy as np
from exemplar_runner import SceneTest, nodes_of, read_csv, read_summary, timeless_statistics
from mpirun import launch
from piece_boxes import Box, write_boxes

E, A = 1e6, 0.04
FIRST, SECOND = Box((0, 0, 0), (1, 0.2, 0.2), (4, 1, 1)), Box((1, 0, 0), (2, 0.2, 0.2), (4, 1, 1))
PULLED = {"Scene": "static", "Mesh/Files": "first.msh, second.msh", "Material/Young's modulus": f"{E}", "Material/Poisson's ratio": "0",
          "Material/Density": "1000", "Ties/Names": "glue", "Ties/glue/Select": "box 0.99 -1 -1  1.01 1 1", "Ties/glue/To": "region first",
          "Handles/Names": "left, right", "Handles/left/Select": "box -0.01 -1 -1  0.01 1 1",
          "Handles/right/Select": "box 1.99 -1 -1  2.01 1 1", "Handles/right/Motion": "0.02*t; 0; 0", "Time/Increments": "1",
          "Solver/Tolerance": "1e-12", "Output/Every": "0"}
GLUED = {**PULLED, "Ties/glue/Select": "region second"}
FLYING = {**{k: v for k, v in PULLED.items() if "Handles" not in k and k != "Time/Increments"}, "Scene": "dynamic", "Time/Step": "0.002",
          "Time/End": "0.2", "Initial/Velocity": "sin(3*x); x>1 ? 1 : 0; 0.5*x*y", "Solver/Step tolerance": "1e-10"}


class Ties(SceneTest):
    def setUp(self):
        super().setUp()
        write_boxes(self.directory / "first.msh", FIRST)
        write_boxes(self.directory / "second.msh", SECOND)

    def places(self, output):
        return np.array(list(nodes_of(output / "final.msh").values()))

    def test_springs_in_series(self):
        for stiffness in (1e5, 1e7, 1e9):
            row = read_csv(self.solve({**GLUED, "Ties/glue/Stiffness": f"{stiffness}"}))[-1]
            force = 0.02 / (2 / (E * A) + 1 / (stiffness * A))
            self.assertAlmostEqual(row["reaction_right_x"] / force, 1, delta=1e-9)
            self.assertAlmostEqual(row["tie_glue_x"] / -force, 1, delta=1e-9)  # on the second bar
            self.assertAlmostEqual(row["energy_ties"] / (force ** 2 / (2 * stiffness * A)), 1, delta=1e-9)

    def test_two_bars_tied_end_to_end_are_one(self):
        write_boxes(self.directory / "one.msh", Box((0, 0, 0), (2, 0.2, 0.2), (8, 1, 1)))
        bent = {"Handles/right/Motion": "0; 0; 0.2*t", "Material/Poisson's ratio": "0.3", "Loads/Gravity": "0, 0, -1"}
        for more in ({}, {"Model/Element": "P2"}):
            one = {k: v for k, v in {**PULLED, **bent, **more}.items() if "Ties" not in k and k != "Mesh/Files"}
            single = self.solve({**one, "Mesh/File": "one.msh"}, output="single", file="single.prm")
            both = self.solve({**GLUED, **bent, **more})
            by_rest = {tuple(np.round(x, 9)): y for x, y in zip(np.array(write_boxes(self.directory / "again.msh",
                                                                                  Box((0, 0, 0), (2, 0.2, 0.2), (8, 1, 1)))[0]), self.places(single))}
            rest = np.vstack([write_boxes(self.directory / "again.msh", box)[0] for box in (FIRST, SECOND)])
            off = [np.linalg.norm(y - by_rest[tuple(np.round(x, 9))]) for x, y in zip(rest, self.places(both))]
            self.assertLess(max(off), 2e-4 * 0.2)  # rigid is 1e4 times as stiff as the softer side
            np.testing.assert_allclose(read_csv(both)[-1]["reaction_right_z"], read_csv(single)[-1]["reaction_right_z"], rtol=5e-4)

    def test_momentum_of_two_tied_free_bodies(self):
        for more in ({}, {"Solver/Method": "newton", "Solver/Tolerance": "1e-11"}, {"Ties/glue/Stiffness": "1e6"}):
            rows = read_csv(self.solve({**FLYING, **more}))
            momentum = np.array([[row[f"momentum_{c}"] for c in "xyz"] for row in rows])
            np.testing.assert_allclose(momentum, np.tile(momentum[0], (len(rows), 1)), atol=1e-8 * abs(momentum[0]).max())

    def test_newton_and_quasi_newton_agree(self):
        quasi = self.places(self.solve(FLYING))
        newton = self.places(self.solve({**FLYING, "Solver/Method": "newton", "Solver/Tolerance": "1e-12"}))
        np.testing.assert_allclose(quasi, newton, atol=1e-7)

    def test_a_tied_skin_turns_with_what_it_is_tied_to(self):
        """A gap between the two is kept, without force, where all turn together."""
        for element in ("P1", "P2"):
            write_boxes(self.directory / "first.msh", FIRST)
            write_boxes(self.directory / "second.msh", Box((0.1, 0.02, 0.22), (0.9, 0.18, 0.25), (3, 1, 1)))
            turn = "x*cos(t)-z*sin(t)-x; 0; x*sin(t)+z*cos(t)-z"
            scene = {**PULLED, "Model/Element": element, "Ties/glue/Select": "region second", "Handles/Names": "all",
                     "Handles/all/Select": "region first", "Handles/all/Motion": turn, "Time/Increments": "4", "Ties/glue/Reach": "0.03"}
            scene = {k: v for k, v in scene.items() if "/left/" not in k and "/right/" not in k}
            output = self.solve(scene)
            rest = np.vstack([write_boxes(self.directory / "again.msh", box)[0] for box in
                              (FIRST, Box((0.1, 0.02, 0.22), (0.9, 0.18, 0.25), (3, 1, 1)))])
            c, s = np.cos(1), np.sin(1)
            np.testing.assert_allclose(self.places(output), rest @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]), atol=1e-9)
            self.assertIn("Ties/glue ties", (output / "log.txt").read_text())  # the outer side looks away

    def test_no_tie_goes_through_the_body(self):
        """The upper side of a plate is nearer to what lies below than its reach, and is not tied to it."""
        write_boxes(self.directory / "second.msh", Box((0, 0, 0.21), (1, 0.2, 0.22), (4, 1, 1)))
        scene = {**PULLED, "Ties/glue/Reach": "0.1", "Handles/Names": "left", "Handles/left/Select": "region first"}
        scene = {k: v for k, v in scene.items() if "/right/" not in k}
        below = self.attempt({**scene, "Ties/glue/Select": "box -1 -1 0.205  2 1 0.215"})
        self.assertEqual(below.status, 0, below.stderr)
        above = self.attempt({**scene, "Ties/glue/Select": "box -1 -1 0.2195  2 1 0.23"})
        self.assertEqual(above.status, 1)
        self.assertIn("Ties/glue reaches nothing: 10 nodes of Select face nothing of To within 0.1 m, the first at (0.25, 0.2, 0.22) m", above.stderr)
        self.assertIn("which looks away from it", above.stderr)
        self.assertFalse((above.output / "summary.json").exists() and below.status)

    def test_what_is_tied_does_not_meet(self):
        write_boxes(self.directory / "second.msh", Box((1.001, 0, 0), (2, 0.2, 0.2), (4, 1, 1)))
        squeezed = {**GLUED, "Ties/glue/Stiffness": "1e6", "Handles/right/Motion": "-0.05*t; 0; 0", "Handles/right/Select": "box 1.99 -1 -1 2.1 1 1",
                    "Time/Increments": "5", "Contact/Bodies": "true"}
        row = read_csv(self.solve(squeezed))[-1]
        self.assertEqual((row["body_pairs"], row["body_contact_force"]), (0, 0))
        self.assertGreater(row["tie_glue_x"], 100)  # it is pushed through the tie alone

    def test_threads_and_resume_leave_the_bytes(self):
        whole = self.solve(FLYING, output="whole")
        self.assertEqual(timeless_statistics(whole), timeless_statistics(self.solve(FLYING, "--threads", "1", output="one")))
        self.solve({**FLYING, "Time/End": "0.1"}, output="half")
        half = self.solve(FLYING, "--resume", output="half")
        self.assertEqual(timeless_statistics(whole), timeless_statistics(half))
        self.assertEqual((whole / "final.msh").read_bytes(), (half / "final.msh").read_bytes())

    def test_what_a_run_says_of_ties(self):
        output = self.solve({**GLUED, "Ties/glue/Stiffness": "1e6", "Output/Every": "1"})
        self.assertIn(b'Name="tie_force"', (output / "frame_0001.vtu").read_bytes())
        self.assertIn("ties", read_summary(output)["used"])
        plain = self.solve({k: v for k, v in GLUED.items() if "Ties" not in k}, output="plain", file="plain.prm")
        self.assertIn("ties", read_summary(plain)["left_out"])
        self.assertNotIn("energy_ties", read_csv(plain)[-1])

    def test_statics_that_a_tie_holds(self):
        held = {k: v for k, v in {**GLUED, "Handles/Names": "left", "Loads/Gravity": "0, 0, -1"}.items() if "/right/" not in k}
        row = read_csv(self.solve(held))[-1]
        self.assertAlmostEqual(row["tie_glue_z"], 1000 * A, delta=1e-6 * 1000 * A)  # the weight of the second bar
        point = self.attempt({**held, "Ties/glue/Select": "box 0.99 -0.01 -0.01  1.01 0.01 0.01"})
        self.assertEqual(point.status, 1)
        self.assertIn("leave 6 of 6 rigid motions of the piece with element 101 free", point.stderr)

    def test_what_is_refused(self):
        write_boxes(self.directory / "far.msh", Box((1.5, 0, 0), (2.5, 0.2, 0.2), (4, 1, 1)))
        dynamic = {**FLYING, "Time/End": "0.01"}
        for scene, words in (
                ({**dynamic, "Mesh/Files": "first.msh, far.msh", "Ties/glue/Select": "box 1.49 -1 -1 1.51 1 1"},
                 "which faces it from 0.5 m away. Enlarge Reach"),
                ({**dynamic, "Ties/glue/Select": "box 5 5 5 6 6 6"}, "selects no node"),
                ({**dynamic, "Ties/glue/To": "box 0.99 -0.01 -0.01 1.01 0.01 0.01"}, "holds no triangle of the surface whole"),
                ({**dynamic, "Ties/glue/Stiffness": "1e20"}, "Ties/glue/Stiffness = 1e+20 is so great that forces would be the rounding of positions"),
                ({**dynamic, "Ties/glue/Stiffness": "-1"}, "Ties/glue/Stiffness = '-1' is not allowed. Allowed: rigid, or a positive number"),
                ({**dynamic, "Ties/glue/Reach": "far"}, "Ties/glue/Reach = 'far' is not allowed"),
                ({**dynamic, "Mesh/Files": "first.msh"}, "is in one piece. Leave Ties/Names empty"),
                ({**{k: v for k, v in dynamic.items() if "Ties/glue" not in k}, "Ties/clue/Select": "region first"}, "Did you mean Ties/glue?"),
                ({**PULLED, "Loads/Balanced": "true", "Loads/Gravity": "0, 0, -1"}, "Loads/Balanced = true lets handles bear the loads"),
                ({**PULLED, "Output/Space error": "true"}, "Output/Space error compares")):
            with self.subTest(words):
                run = self.attempt(scene, output="refused")
                self.assertEqual(run.status, 1)
                self.assertIn(words, run.stderr)
                self.assertFalse(run.output.exists())
        self.attempt(dynamic)
        shared = launch(2, self.directory / "scene.prm", "--output", self.directory / "shared", "--quiet")
        self.assertEqual(shared[0], 1)
        self.assertIn("Ties are not for several processes yet", "".join(shared[1]))


if __name__ == "__main__":
    unittest.main()
