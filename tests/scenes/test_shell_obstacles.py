# SPDX-License-Identifier: GPL-3.0-or-later
"""Shells that meet obstacles: half of their thickness from them, on both sides, with friction; and what is refused."""

import unittest
from math import sqrt

import numpy as np
from exemplar_runner import SceneTest, nodes_of, read_csv, read_vtu
from shell_meshes import grid, obj_text, strip
from triangle_distances import samples_of_box, samples_of_triangles, to_triangles

G = 9.81
THICKNESS, WIDTH, SIDE = 2e-3, 5e-3, .4
SHEET = {
    "Scene": "dynamic",
    "Mesh/Kind": "shell",
    "Mesh/File": "sheet.obj",
    "Material/Thickness": str(THICKNESS),
    "Material/Young's modulus": "1e6",
    "Material/Poisson's ratio": "0.3",
    "Material/Density": "500",
    "Loads/Gravity": f"0, 0, {-G}",
    "Obstacles/Names": "thing",
    "Obstacles/thing/Shape": "plane 0 0 -0.02  0 0 1",
    "Obstacles/Distance": str(WIDTH),
    "Time/Step": "0.01",
    "Time/End": "0.3",
    "Solver/Maximum iterations": "400",
    "Output/Every": "0",
}
WEIGHT = 500 * THICKNESS * SIDE ** 2 * G
TENT = ((-.5, -.5, -.2), (.5, -.5, -.2), (.5, .5, -.2), (-.5, .5, -.2), (.03, -.4, -.02), (.03, .4, -.02))
TENT_FACES = ((3, 2, 1), (3, 1, 0), (0, 1, 4), (2, 3, 5), (1, 2, 5), (1, 5, 4), (3, 0, 4), (3, 4, 5))
METHODS = ("newton", "quasi newton")


class ShellObstacleTest(SceneTest):
    def setUp(self):
        super().setUp()
        self.write_sheet()
        self.write("tent.obj", obj_text(TENT, TENT_FACES))

    def write_sheet(self, n=10, height=lambda x, y: 0.):
        points, self.triangles = grid(n, n, "alternating")
        self.write("sheet.obj", obj_text([(SIDE * (x - .5), SIDE * (y - .5), height(x, y)) for x, y in points], self.triangles))

    def places(self, output):
        return np.array([place for _, place in sorted(nodes_of(output / "final.msh").items())])

    def frames(self, output):
        """Corners of the triangles in each frame, (m, 3, 3)."""
        for file in sorted(output.glob("frame_*.vtu")):
            if "obstacles" not in file.name:
                points = np.reshape(read_vtu(file)[0]["Points", "Points"], (-1, 3))
                yield points[np.array(self.triangles)]


class Obstacles(ShellObstacleTest):
    def test_it_rests_half_of_its_thickness_above_the_floor(self):
        for method in METHODS:
            with self.subTest(method):
                output = self.solve({**SHEET, "Time/Mass damping": "20", "Time/End": "2", "Solver/Step tolerance": "1e-9",
                                     "Solver/Method": method})
                last = read_csv(output)[-1]
                self.assertAlmostEqual(last["contact_thing_z"] / WEIGHT, 1, delta=1e-6)
                heights = self.places(output)[:, 2] + .02
                self.assertGreater(heights.min(), .5 * THICKNESS)
                self.assertLess(heights.max(), .5 * THICKNESS + WIDTH)
                self.assertAlmostEqual(heights.min() - .5 * THICKNESS, last["least_gap"], delta=1e-9)

    def test_each_region_has_its_own_thickness(self):
        points, triangles = grid(10, 10, "alternating")
        text = obj_text([(SIDE * (x - .5), SIDE * (y - .5), 0.) for x, y in points], []).rstrip("\n") + "\n"
        offset = np.zeros(len(points))
        for name, thickness, is_in in (("thin", 1e-3, lambda x: x < .5), ("thick", 8e-3, lambda x: x > .5)):
            text += f"g {name}\n"
            for t in triangles:
                if is_in(sum(points[v][0] for v in t) / 3):
                    text += "f " + " ".join(str(v + 1) for v in t) + "\n"
                    offset[list(t)] = np.maximum(offset[list(t)], .5 * thickness)
        self.write("sheet.obj", text)
        output = self.solve({**SHEET, "Material/Thickness": "1e-3", "Material/region thin/Thickness": "1e-3",
                             "Material/region thick/Thickness": "8e-3", "Time/Mass damping": "20", "Time/End": "1",
                             "Obstacles/Distance": "1e-3"})
        gaps = self.places(output)[:, 2] + .02 - offset
        self.assertGreater(gaps.min(), 0)
        self.assertLess(gaps[offset == .5e-3].min(), 1e-3)
        self.assertLess(gaps[offset == 4e-3].max(), 2e-3)

    def shapes(self):
        """Texts, points that a shell stays away from, and by how much more than half of its thickness."""
        tent = samples_of_triangles(np.array([[TENT[v] for v in face] for face in TENT_FACES]), 24)
        axis = np.linspace((-.3, .02, -.08), (.3, .05, -.1), 200)
        yield "sphere 0.03 0.02 -0.15 0.12", np.array([(.03, .02, -.15)]), .12
        yield "capsule -0.3 0.02 -0.08  0.3 0.05 -0.1  0.06", axis, .06
        yield "box -0.03 -0.07 -0.3  0.05 0.11 -0.02", samples_of_box((-.03, -.07, -.3), (.05, .11, -.02), 24), 0.
        yield "surface tent.obj", tent, 0.

    def test_it_drapes_over_every_shape_and_passes_none(self):
        for shape, points, radius in self.shapes():
            for method in METHODS:
                with self.subTest(shape, method=method):
                    output = self.solve({**SHEET, "Obstacles/thing/Shape": shape, "Solver/Method": method, "Output/Every": "2",
                                         "Initial/Velocity": "0; 0; -1", "Obstacles/thing/Friction": "0.3"})
                    self.assertGreater(max(row["contact_thing_z"] for row in read_csv(output)), WEIGHT)
                    n_frames = 0
                    for x in self.frames(output):
                        n_frames += 1
                        # frames are of single precision
                        self.assertGreater(to_triangles(points, x).min() - radius, .5 * THICKNESS - 1e-7)
                    self.assertEqual(n_frames, 16)

    def test_both_sides_touch(self):
        # what falls up on the mirrored shape, with the other side of its triangles ahead, moves as the mirrored one
        keys = {**SHEET, "Solver/Tolerance": "1e-10", "Solver/Method": "newton", "Time/End": "0.2"}
        for shape, mirrored in (("sphere 0.03 0.02 -0.15 0.12", "sphere 0.03 0.02 0.15 0.12"),
                                ("plane 0 0 -0.02  0 0 1", "plane 0 0 0.02  0 0 -1"),
                                ("inside box -1 -1 -0.02  1 1 1", "inside box -1 -1 -1  1 1 0.02")):
            with self.subTest(shape):
                down = self.places(self.solve({**keys, "Obstacles/thing/Shape": shape}, output="down"))
                up = self.places(self.solve({**keys, "Obstacles/thing/Shape": mirrored, "Loads/Gravity": f"0, 0, {G}"}, output="up"))
                self.assertGreater(np.abs(down[:, 2]).max(), .01)
                np.testing.assert_allclose(up * (1, 1, -1), down, atol=1e-6)

    def test_what_is_inside_of_a_closed_shell_pushes_it(self):
        # a box of card with a ball in it, which moves out through a side and takes the box along
        corners = [(x, y, z) for z in (-.1, .1) for y in (-.1, .1) for x in (-.1, .1)]
        faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        text = "".join(f"v {x} {y} {z}\n" for x, y, z in corners)
        self.write("sheet.obj", text + "".join("f " + " ".join(str(v + 1) for v in f) + "\n" for f in faces))
        output = self.solve({**SHEET, "Obstacles/thing/Shape": "sphere 0 0 0 0.08", "Loads/Gravity": None, "Time/End": "0.5",
                             "Obstacles/thing/Motion": "0.5*t; 0; 0", "Time/Mass damping": "1"})
        rows = read_csv(output)
        self.assertGreater(min(row["least_gap"] for row in rows), 0)
        self.assertGreater(self.places(output)[:, 0].max(), .1 + .2)

    def test_a_static_strip_bends_over_an_edge(self):
        flat, triangles = strip(1., .25, 20, 5)
        self.write("sheet.obj", obj_text(flat, triangles))
        output = self.solve({**SHEET, "Scene": "static", "Time/Step": None, "Time/End": None, "Time/Increments": "5",
                             "Handles/Names": "hand", "Handles/hand/Select": "box -1 -1 -1  0.06 1 1",
                             "Material/Young's modulus": "1e8", "Solver/Tolerance": "1e-9",
                             "Obstacles/thing/Shape": "box 0.35 -1 -1  0.6 1 -0.01"})
        last = read_csv(output)[-1]
        self.assertGreater(last["least_gap"], 0)
        self.assertAlmostEqual((last["contact_thing_z"] + last["reaction_hand_z"]) / (500 * THICKNESS * .25 * G), 1, delta=1e-6)
        x = self.places(output)
        over = (x[:, 0] > .35) & (x[:, 0] < .6)
        self.assertGreater(x[over, 2].min(), -.01 + .5 * THICKNESS)
        self.assertLess(x[:, 2].min(), -.015)  # beyond the box

    def test_friction_holds_a_static_sheet(self):
        slope = np.array([.2, 0, -1]) * G / sqrt(1.04)
        output = self.solve({**SHEET, "Scene": "static", "Time/Step": None, "Time/End": None, "Time/Increments": "2",
                             "Obstacles/Free": "friction", "Obstacles/thing/Friction": "0.5", "Solver/Tolerance": "1e-10",
                             "Obstacles/Lag tolerance": "1e-9",
                             "Obstacles/thing/Shape": "plane 0 0 -0.0011  0 0 1", "Loads/Gravity": ", ".join(f"{g:.17g}" for g in slope)})
        last = read_csv(output)[-1]
        self.assertAlmostEqual(last["contact_thing_z"] / (WEIGHT / sqrt(1.04)), 1, delta=1e-6)
        # a spring of 1e-6 E times the diameter is left, which pulls while friction creeps
        self.assertAlmostEqual(last["contact_thing_x"] / (-.2 * WEIGHT / sqrt(1.04)), 1, delta=2e-4)

    def test_a_sheet_on_a_slope_slides_as_it_should(self):
        tangent, friction = .5, .2
        slope = np.array([tangent, 0, -1]) * G / sqrt(1 + tangent ** 2)
        rows = read_csv(self.solve({**SHEET, "Loads/Gravity": ", ".join(f"{g:.17g}" for g in slope), "Obstacles/thing/Friction": str(friction),
                                    "Obstacles/Lag tolerance": "1e-8", "Solver/Tolerance": "1e-10", "Time/End": "1",
                                    "Obstacles/thing/Shape": "plane 0 0 -0.002  0 0 1"}))
        mass = WEIGHT / G
        expected = G * (tangent - friction) / sqrt(1 + tangent ** 2)
        found = (rows[-1]["momentum_x"] - rows[-26]["momentum_x"]) / (mass * .25)
        self.assertAlmostEqual(found / expected, 1, delta=.005)
        self.assertAlmostEqual(rows[-1]["energy_dissipated"] / rows[-1]["heat_friction"], 1, places=12)

    def test_forces_work_no_more_than_their_barrier_falls(self):
        for method in METHODS:
            rows = read_csv(self.solve({**SHEET, "Initial/Velocity": "0.3*y; 1; -3 + x", "Solver/Method": method}))
            most = max(row["energy_kinetic"] for row in rows)
            work = [b["contact_thing_work"] - a["contact_thing_work"] + b["energy_contact"] - a["energy_contact"] for a, b in zip(rows, rows[1:])]
            self.assertGreater(max(row["energy_contact"] for row in rows), 0)
            self.assertLess(max(work), 1e-12 * most)

    def test_frames_show_forces_and_pressures(self):
        output = self.solve({**SHEET, "Time/End": "0.1", "Output/Every": "10"})
        arrays = read_vtu(output / "frame_0010.vtu")[0]
        force = np.reshape(arrays["PointData", "contact_force"], (-1, 3))
        pressure = np.array(arrays["PointData", "contact_pressure"])
        self.assertEqual(len(force), len(self.places(output)))
        row = read_csv(output)[-1]
        self.assertGreater(row["contact_thing_z"], 1e-3)
        self.assertAlmostEqual(force.sum(0)[2] / row["contact_thing_z"], 1, places=9)
        self.assertEqual(((force ** 2).sum(1) > 0).tolist(), (pressure > 0).tolist())

    def test_threads_and_resume_keep_bytes(self):
        for method in METHODS:
            with self.subTest(method):
                keys = {**SHEET, "Obstacles/thing/Shape": "sphere 0.03 0.02 -0.15 0.12", "Obstacles/thing/Friction": "0.3",
                        "Solver/Method": method, "Time/End": "0.2"}
                one = self.solve(keys, "--threads", "1", output=f"one_{method[0]}")
                two = self.solve(keys, "--threads", "2", output=f"two_{method[0]}")
                self.assertEqual((one / "final.msh").read_bytes(), (two / "final.msh").read_bytes())
                half = self.solve({**keys, "Time/End": "0.16"}, output=f"half_{method[0]}")
                self.assertEqual(self.attempt(keys, "--resume", output=f"half_{method[0]}").status, 0)
                self.assertEqual((one / "final.msh").read_bytes(), (half / "final.msh").read_bytes())


    def test_a_factor_takes_the_place_of_multigrid(self):
        keys = {**SHEET, "Obstacles/thing/Shape": "sphere 0.03 0.02 -0.15 0.12", "Obstacles/thing/Friction": "0.3", "Time/End": "0.2"}
        iterative = self.attempt({**keys, "Solver/Linear solver": "iterative"}, output="iterative")
        self.assertEqual(iterative.status, 0)
        self.assertIn("cholesky is used instead", iterative.stderr)
        factor = self.solve({**keys, "Solver/Linear solver": "cholesky"}, output="factor")
        self.assertEqual((factor / "final.msh").read_bytes(), (iterative.output / "final.msh").read_bytes())

    def test_a_sheet_has_room_between_two_rollers(self):
        """A gap of 7 mm for a sheet of 5 mm: the automatic distance leaves 1 mm at both sides, as a distance that is given does."""
        points, triangles = grid(12, 4, "alternating")
        self.write("sheet.obj", obj_text([(.6 * x, .2 * y, 0.) for x, y in points], triangles))
        keys = {**SHEET, "Material/Thickness": "0.005", "Material/Young's modulus": "1e7", "Handles/Names": "pull", "Handles/pull/Select": "box -1 -1 -1 1e-6 1 1",
                "Handles/pull/Motion": "-0.5*t; 0; 0", "Obstacles/Names": "low, high", "Obstacles/Distance": "auto", "Obstacles/thing/Shape": None,
                "Obstacles/low/Shape": "capsule 0.1 -0.3 -0.0535  0.1 0.6 -0.0535  0.05", "Obstacles/high/Shape": "capsule 0.1 -0.3 0.0535  0.1 0.6 0.0535  0.05",
                "Time/End": "0.2"}
        found = self.attempt(keys, output="found")
        self.assertEqual(found.status, 0)
        self.assertIn("Obstacles/Distance = auto is 0.001 m instead of", found.stdout)
        given = self.attempt({**keys, "Obstacles/Distance": "0.001"}, output="given")
        self.assertNotIn("instead of", given.stdout)
        self.assertLess(np.abs(self.places(found.output) - self.places(given.output)).max(), 1e-6)
        # rollers that are as far apart as that distance needs, that touch, or that move apart have the usual one
        for high, motion in (.0735, "0; 0; 0"), (.0465, "0; 0; 0"), (.0535, "0; 0; 0.1*t"):
            away = self.attempt({**keys, "Obstacles/high/Shape": f"capsule 0.7 -0.3 {high}  0.7 0.6 {high}  0.05", "Obstacles/low/Shape": "capsule 0.7 -0.3 -0.0535  0.7 0.6 -0.0535  0.05",
                                 "Obstacles/high/Motion": motion, "Time/End": "0.02"}, output="away")
            self.assertEqual(away.status, 0)
            self.assertNotIn("instead of", away.stdout)


class Starts(ShellObstacleTest):
    def test_what_is_drawn_on_an_obstacle_stands(self):
        # with its middle, as sheets are drawn, or with its side
        for shape in ("plane 0 0 0  0 0 1", f"plane 0 0 {-.5 * THICKNESS}  0 0 1", "box -1 -1 -1  1 1 0", f"box -1 -1 -1  1 1 {-.5 * THICKNESS}",
                      "inside box -1 -1 0  1 1 1", f"sphere 0 0 {-.2 - .5 * THICKNESS} 0.2"):
            with self.subTest(shape):
                run = self.attempt({**SHEET, "Obstacles/thing/Shape": shape, "Time/End": "0.05"})
                self.assertEqual((run.status, run.stderr), (0, ""))
                self.assertIn("Obstacles/thing touches the body near (", run.stdout)
                rows = read_csv(run.output)
                self.assertGreater(min(row["least_gap"] for row in rows), 0)
                self.assertLess(max(row["energy_kinetic"] for row in rows), .02 * WEIGHT)
                if "sphere" not in shape:
                    self.assertGreater(self.places(run.output)[:, 2].min(), -1e-4)

    def test_what_begins_near_is_not_pushed(self):
        for gap in (.9, .2, .05):
            keys = {**SHEET, "Loads/Gravity": None, "Time/End": "0.05",
                    "Obstacles/thing/Shape": f"plane 0 0 {-.5 * THICKNESS - gap * WIDTH!r}  0 0 1"}
            rows = read_csv(self.solve(keys))
            self.assertLess(max(row["energy_kinetic"] for row in rows), 1e-20)

    def test_the_side_of_an_open_surface_must_be_clear(self):
        # which lies in the sheet, or beside it
        for height, words in ((0., "The body begins inside of Obstacles/thing"), (-.5 * THICKNESS, ""), (.5 * THICKNESS, "")):
            with self.subTest(height):
                self.write("ground.obj", obj_text([(x, y, height) for x, y in ((-.5, -.5), (.5, -.5), (.5, .5), (-.5, .5))], [(0, 1, 2), (0, 2, 3)]))
                run = self.attempt({**SHEET, "Obstacles/thing/Shape": "surface ground.obj", "Time/End": "0.05"})
                self.assertEqual(run.status, 1 if words else 0, run.stderr)
                self.assertIn(words, run.stderr)
                if height < 0:
                    self.assertGreater(self.places(run.output)[:, 2].min(), -1e-4)

    def test_what_begins_deeper_is_refused(self):
        for shape, words in (("plane 0 0 0.002  0 0 1", "A displacement of the body by (0, 0, 0.003) m would mend it"),
                             ("sphere 0 0 -0.17 0.2", "m deep"), ("capsule -1 0 -0.17  1 0 -0.17  0.2", "m deep"),
                             ("box -1 -1 -1  1 1 0.01", "so that they do not meet"), ("box 0 0 -1  1 1 1", "so that they do not meet"),
                             ("surface tent.obj", "so that they do not meet")):
            with self.subTest(shape):
                run = self.attempt({**SHEET, "Obstacles/thing/Shape": shape, "Obstacles/thing/Motion": "0; 0; 0.05" if "tent" in shape else None})
                self.assertEqual(run.status, 1)
                self.assertIn("The body begins inside of Obstacles/thing, near (", run.stderr)
                self.assertIn(words, run.stderr)


class Refused(ShellObstacleTest):
    def refuse(self, words, keys):
        run = self.attempt({**SHEET, **keys})
        self.assertEqual(run.status, 1)
        self.assertIn(words, run.stderr)

    def test_what_is_not_there(self):
        self.refuse("Contact/Bodies and Self", {"Contact/Self": "true"})
        self.refuse("Contact/Bodies and Self", {"Contact/Bodies": "true"})
        self.refuse("Ties are not for shells", {"Ties/Names": "a", "Ties/a/Select": "box 0 0 0 1 1 1", "Ties/a/To": "box 0 0 0 1 1 1"})
        self.refuse("Obstacles/Free = weak springs", {"Scene": "static", "Time/Step": None, "Time/End": None, "Obstacles/Free": "weak springs"})


if __name__ == "__main__":
    unittest.main()
