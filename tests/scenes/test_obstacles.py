# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies that meet obstacles: closed forms, an implementation of its own, what may not be passed, and what is refused."""

import unittest
from math import sqrt

import numpy as np
from bad_inputs import BadInputTest
from contact_reference import Reference
from exemplar_runner import SceneTest, needs_trilinos, nodes_of, prm, read_csv, read_msh, read_summary, read_vtu, results
from piece_boxes import Box, write_boxes

G = 9.81
BAR = {
    "Scene": "dynamic",
    "Mesh/Generator": "box",
    "Mesh/Box size": "1, 0.2, 0.2",
    "Mesh/Box cells": "6, 2, 2",
    "Material/Young's modulus": "1e5",
    "Material/Poisson's ratio": "0.3",
    "Material/Density": "1000",
    "Loads/Gravity": f"0, 0, {-G}",
    "Obstacles/Names": "floor",
    "Obstacles/floor/Shape": "plane 0 0 -0.2  0 0 1",
    "Time/Step": "0.01",
    "Time/End": "0.5",
    "Solver/Maximum iterations": "400",
    "Output/Every": "0",
}
CUBE = {**BAR, "Mesh/Box size": "0.1, 0.1, 0.1", "Mesh/Box cells": "2, 2, 2", "Material/Young's modulus": "1e7",
        "Obstacles/floor/Shape": "plane 0 0 -0.05 0 0 1"}
WEIGHT = 1000 * 0.04 * G
SHAPES = {
    "plane": "plane 0 0 -0.2  0.2 0 1",
    "sphere": "sphere 0.4 0.02 -0.8 0.6",
    "capsule": "capsule -1 0.1 -0.5  1.5 0.2 -0.6  0.3",
    "along": "capsule -1 0 -0.5  1.5 0 -0.5  0.3",
    "box": "box 0.3 -1 -1  1 1 -0.2",
    "beam": "box 0.45 -1 -1  0.55 1 -0.2",
    "inside": "inside box -1 -1 -0.2  3 1 3",
    "surface": "surface tent.obj",
    "sheet": "surface sheet.obj",
}
TENT = "v -2 -2 -1\nv 2 -2 -1\nv 2 2 -1\nv -2 2 -1\nv 0.43 -1.5 -0.2\nv 0.43 1.5 -0.2\n" \
       "f 4 3 2 1\nf 1 2 5\nf 3 4 6\nf 2 3 6 5\nf 4 1 5 6\n"
SHEET = "v -2 -2 -0.2\nv 2 -2 -0.25\nv 2 2 -0.2\nv -2 2 -0.3\nf 1 2 3\nf 1 3 4\n"


def worked(rows, name="floor"):
    """By the contact forces in each step, less what the barrier's energy falls by."""
    return [after[f"contact_{name}_work"] - before[f"contact_{name}_work"] + after["energy_contact"] - before["energy_contact"]
            for before, after in zip(rows, rows[1:])]


class ObstacleTest(SceneTest):
    def setUp(self):
        super().setUp()
        self.write("tent.obj", TENT)
        self.write("sheet.obj", SHEET)


class Obstacles(ObstacleTest):
    def test_a_body_that_has_come_to_rest_is_borne_with_its_weight(self):
        rows = read_csv(self.solve({**BAR, "Time/Mass damping": "20", "Time/End": "4", "Solver/Step tolerance": "1e-9"}))
        self.assertAlmostEqual(rows[-1]["contact_floor_z"] / WEIGHT, 1, delta=1e-6)
        self.assertLess(abs(rows[-1]["contact_floor_x"]), 1e-6 * WEIGHT)
        # about the plane's point, below the bar's end: gravity pulls at x = .5 m
        self.assertAlmostEqual(rows[-1]["contact_floor_torque_y"] / WEIGHT, -0.5, delta=1e-5)

    def test_forces_work_no_more_than_their_barrier_falls(self):
        for name in ("plane", "inside"):
            with self.subTest(name):
                rows = read_csv(self.solve({**BAR, "Obstacles/floor/Shape": SHAPES[name], "Initial/Velocity": "0; 1; -5"}))
                most = max(row["energy_kinetic"] for row in rows)
                self.assertLess(max(row["least_gap"] for row in rows[5:]), 0.0052)
                self.assertLess(max(worked(rows)), 1e-12 * most)

    def test_every_shape_is_met_and_none_is_passed(self):
        for name, shape in SHAPES.items():
            for speed, young in ((3, "1e5"), (30, "1e6"), (10, "1e4")):
                with self.subTest(name, speed=speed):
                    run = self.attempt({**BAR, "Obstacles/floor/Shape": shape, "Initial/Velocity": f"0; 0; {-speed}",
                                        "Material/Young's modulus": young, "Time/End": "0.2"})
                    self.assertEqual(run.status, 0, run.stderr)  # cells may be inverted by such impacts
                    rows = read_csv(run.output)
                    self.assertGreater(min(row["least_gap"] for row in rows), 0)
                    self.assertGreater(max(row["contact_floor_z"] for row in rows), WEIGHT)
                    self.assertGreater(max(row["contact_pairs"] for row in rows), 0)

    def test_what_stands_is_not_passed_while_something_else_moves(self):
        without_floor = {key: value for key, value in BAR.items() if "floor" not in key}
        for step in ("box -1 -2 -2  1 2 -1", "box -1 -2 -2  1 2 -0.5", "sphere 1 0 -2 1", "capsule 1 -2 -2  1 2 -2  1",
                     "plane 0 0 -1  0 0 1", "inside box -5 -5 -1  6 5 5"):
            with self.subTest(step):
                rows = read_csv(self.solve({
                    **without_floor, "Mesh/Box size": "4, 1, 1", "Mesh/Box cells": "8, 2, 2", "Obstacles/Names": "step, roller",
                    "Obstacles/step/Shape": step, "Obstacles/roller/Shape": "sphere 3 0 -2 0.5",
                    "Obstacles/roller/Motion": "-t; 0; 0", "Time/End": "0.4"}))
                self.assertGreater(min(row["least_gap"] for row in rows), 0)
                self.assertGreater(max(row["contact_step_z"] for row in rows), 1000 * G)

    def test_a_handle_moves_a_static_body_onto_every_shape(self):
        static = {"Scene": "static", "Mesh/Generator": "box", "Mesh/Box size": "3, 1, 1", "Mesh/Box cells": "12, 4, 4",
                  "Material/Young's modulus": "1e5", "Material/Density": "900", "Loads/Gravity": "0, 0, -0.5", "Handles/Names": "hand",
                  "Handles/hand/Select": "box -1 -1 -1  0.01 1 1", "Handles/hand/Motion": "0; 0; -0.02*t", "Obstacles/Names": "thing"}
        for more in ({"Obstacles/thing/Shape": "box -2 -2 -3  6 2 -0.56"}, {"Obstacles/thing/Shape": "box 1 -1 -1  4 1 -0.56"},
                     {"Obstacles/thing/Shape": "sphere 2.5 0 -1.56 1"}, {"Obstacles/thing/Shape": "capsule 2.5 -2 -1.56  2.5 2 -1.56  1"},
                     {"Obstacles/thing/Shape": "sphere 2.5 0 -1.56 1", "Model/Element": "P2", "Mesh/Box cells": "6, 2, 2",
                      "Handles/hand/Motion": "0; 0; -1e-5*t"},
                     {"Obstacles/thing/Shape": "box 1 -1 -1  4 1 -0.56", "Obstacles/Distance": "0.05", "Mesh/Box cells": "6, 2, 2",
                      "Handles/hand/Motion": "0; 0; -0.06*t"},
                     {"Obstacles/thing/Shape": "surface tent.obj", "Obstacles/thing/Motion": "0; 0; -0.36"}):
            with self.subTest(**more):
                rows = read_csv(self.solve({**static, **more, "Time/Increments": "2"}))
                self.assertGreater(min(row["least_gap"] for row in rows), 0)
                self.assertGreater(rows[-1]["contact_thing_z"], 0)

    def test_a_surface_that_deforms_carries_a_static_body_as_one_that_moves(self):
        ridge = lambda z: TENT.replace("0.43 -1.5 -0.2", f"0.43 -1.5 {z}").replace("0.43 1.5 -0.2", f"0.43 1.5 {z}")
        self.write("rig_0000.obj", ridge(-0.11))
        self.write("rig_0001.obj", ridge(-0.01))
        static = {"Scene": "static", "Mesh/Generator": "box", "Mesh/Box size": "1, 0.2, 0.2", "Mesh/Box cells": "10, 2, 2",
                  "Material/Young's modulus": "1e5", "Loads/Gravity": "0, 0, -0.1", "Handles/Names": "hand",
                  "Handles/hand/Select": "box -1 -1 -1  0.01 1 1",
                  "Obstacles/Names": "thing", "Obstacles/thing/Shape": "surface rig_0000.obj", "Time/Increments": "1"}
        forces = []
        for name, more in (("rigid", {"Obstacles/thing/Motion": "0; 0; 0.1*t"}),
                           ("deforms", {"Obstacles/thing/Follow cache": "rig_*.obj", "Obstacles/thing/Frames per second": "1"})):
            rows = read_csv(self.solve({**static, **more}, output=name))
            self.assertGreater(rows[-1]["least_gap"], 0)
            forces.append(rows[-1]["contact_thing_z"])
        self.assertGreater(forces[0], 1)
        self.assertLess(abs(forces[1] / forces[0] - 1), 0.01)

    def test_a_handle_that_is_driven_into_a_box_is_told_in_words(self):
        run = self.attempt({"Scene": "static", "Mesh/Generator": "box", "Mesh/Box size": "3, 1, 1", "Mesh/Box cells": "6, 2, 2",
                            "Material/Young's modulus": "1e5", "Handles/Names": "hand", "Handles/hand/Select": "box -1 -1 -1  0.01 1 1",
                            "Handles/hand/Motion": "0; 0; -0.2*t", "Obstacles/Names": "thing",
                            "Obstacles/thing/Shape": "box -2 -2 -3  6 2 -0.56", "Time/Increments": "1"})
        self.assertEqual(run.status, 2)
        self.assertIn("handle 'hand' and the obstacle 'thing' meet", run.stderr)

    def test_an_edge_between_nodes_bears(self):
        # a beam on its edge under the middle of long cells: nodes alone would let it in by half a cell
        output = self.solve({**BAR, "Mesh/Box cells": "2, 1, 1", "Obstacles/floor/Shape": SHAPES["beam"].replace("0.45", "0.2")
                             .replace("0.55", "0.3"), "Time/End": "0.3"})
        x = nodes_of(output / "final.msh")
        lower = sorted(tuple(x[n]) for n in x)
        self.assertGreater(min(row["least_gap"] for row in read_csv(output)), 0)
        self.assertTrue(lower)

    def test_what_touches_at_the_start_stands(self):
        output = self.attempt({**BAR, "Obstacles/floor/Shape": "plane 0 0 -0.1 0 0 1", "Time/End": "0.05"})
        self.assertEqual((output.status, output.stderr), (0, ""))
        self.assertIn("Obstacles/floor touches the body near (", output.stdout)
        self.assertIn("it is set back by", output.stdout)
        rows = read_csv(output.output)
        self.assertLess(max(row["energy_kinetic"] for row in rows), 0.5)

    def test_only_what_neither_moves_nor_falls_is_told_that_nothing_will_happen(self):
        still = {**BAR, "Loads/Gravity": None, "Time/End": "0.02"}
        for more, expected in (({}, True), ({"Obstacles/floor/Motion": "0; 0; 0.1*t"}, False), ({"Loads/Gravity": "0, 0, -1"}, False)):
            with self.subTest(more):
                run = self.attempt({**still, **more})
                self.assertEqual((run.status, "nothing will happen" in run.stdout), (0, expected), run.stdout)

    def test_frames_show_forces_and_pressures(self):
        output = self.solve({**BAR, "Time/End": "0.16", "Output/Every": "16"})
        arrays = read_vtu(output / "frame_0016.vtu")[0]
        force = np.reshape(arrays["PointData", "contact_force"], (-1, 3))
        pressure = np.array(arrays["PointData", "contact_pressure"])
        row = read_csv(output)[-1]
        self.assertGreater(row["contact_floor_z"], 1)
        self.assertAlmostEqual(force.sum(0)[2] / row["contact_floor_z"], 1, places=9)
        self.assertEqual(((force ** 2).sum(1) > 0).tolist(), (pressure > 0).tolist())
        self.assertIn("obstacles", read_summary(output)["used"])

    def test_others_know_nothing_of_obstacles(self):
        output = self.solve({key: value for key, value in BAR.items() if not key.startswith("Obstacles")})
        self.assertIn("obstacles", read_summary(output)["left_out"])
        self.assertNotIn("energy_contact", read_csv(output)[0])


class Frictional(ObstacleTest):
    def slope(self, tangent, friction, **more):
        """A cube on a slope, which gravity makes, after some steps."""
        g = np.array([tangent, 0, -1]) * G / sqrt(1 + tangent ** 2)
        return read_csv(self.solve({**CUBE, "Obstacles/floor/Friction": friction, "Loads/Gravity": ", ".join(f"{x:.17g}" for x in g),
                                    "Obstacles/Lag tolerance": "1e-8", "Solver/Step tolerance": "1e-9", **more}))

    def test_on_a_slope_it_creeps_or_slides(self):
        mass = 1.0
        slip_speed = 1e-3 * 0.1 * sqrt(3)
        for part in (0.9, 0.995):
            rows = self.slope(part * 0.5, "0.5", **{"Time/End": "1", "Time/Step": "0.02"})
            creep = rows[-1]["momentum_x"] / mass
            self.assertAlmostEqual(creep / slip_speed, 1 - sqrt(1 - part), delta=0.01)
        rows = self.slope(0.5 * 1.005, "0.5", **{"Time/End": "2", "Time/Step": "0.02"})
        expected = G * (0.5 * 1.005 - 0.5) / sqrt(1 + (0.5 * 1.005) ** 2)
        speeds = [row["momentum_x"] / mass for row in rows]
        self.assertAlmostEqual((speeds[-1] - speeds[-26]) / (25 * 0.02) / expected, 1, delta=0.005)

    def uniformly_accelerated(self, acceleration, step, n, scheme):
        """The displacement of a rigid body that begins at rest, by the scheme itself."""
        way, speed = [0.0], [0.0]
        for i in range(n):
            second = scheme == "bdf2" and i > 0
            v, x = ((4 * values[-1] - values[-2]) / 3 if second else values[-1] for values in (speed, way))
            gamma = 2 * step / 3 if second else step
            speed.append(v + gamma * acceleration)
            way.append(x + gamma * speed[-1])
        return way[-1]

    def test_friction_acts_from_the_first_step(self):
        """A stiff block, whose waves take 0.1 ms: it stays, or slides as a rigid body does."""
        self.write("ground.obj", SHEET.replace("-0.25", "-0.05").replace("-0.2", "-0.05").replace("-0.3", "-0.05"))
        for shape, scheme, method, step in (("plane 0 0 -0.05 0 0 1", "implicit euler", "quasi newton", 0.001),
                                            ("box -9 -9 -9 9 9 -0.05", "bdf2", "newton", 0.002), ("surface ground.obj", "implicit euler", "newton", 0.01)):
            for part in (0.98, 1.1):
                with self.subTest(shape=shape, part=part):
                    friction = 0.45
                    rows = self.slope(part * friction, str(friction), **{
                        "Material/Young's modulus": "1e9", "Mesh/Box cells": "2, 2, 1", "Obstacles/floor/Shape": shape, "Time/Scheme": scheme,
                        "Solver/Method": method, "Time/Step": str(step), "Time/End": "0.1", "Obstacles/Lag tolerance": "1e-4",
                        "Solver/Step tolerance": "1e-5"})
                    nodes = np.array(list(nodes_of(self.directory / "out" / "final.msh").values()))
                    way = nodes[:, 0].mean() - 0.05
                    tangent = part * friction
                    expected = self.uniformly_accelerated(G * (tangent - friction) / sqrt(1 + tangent**2), step, len(rows) - 1, scheme)
                    if part < 1:
                        self.assertLess(abs(way), 1e-4)
                    else:
                        self.assertAlmostEqual(way / expected, 1, delta=0.01)

    def test_a_block_that_begins_in_its_equilibrium(self):
        """A soft block whose statics have been solved: its weight is borne from the first step, and it stays or slides without a swing."""
        for part, friction in ((0.98, 0.4), (1.1, 0.4)):
            with self.subTest(part=part):
                tangent = part * friction
                cosine = 1 / sqrt(1 + tangent**2)
                block = {**CUBE, "Mesh/Box size": "0.5, 0.5, 0.5", "Mesh/Box cells": "3, 3, 3", "Material/Young's modulus": "3e6",
                         "Obstacles/floor/Shape": "plane 0 0 -0.25 0 0 1", "Loads/Gravity": f"{G * tangent * cosine}, 0, {-G * cosine}"}
                stands = self.solve({**block, "Scene": "static", "Time/Step": None, "Time/End": None, "Time/Increments": "1",
                                     "Obstacles/Free": "friction", "Obstacles/floor/Friction": "10"}, output="stands")
                moves = self.solve({**block, "Initial/Pose": str(stands / "final.msh"), "Obstacles/floor/Friction": str(friction),
                                    "Time/Step": "0.006", "Time/End": "0.6"}, output="moves")
                borne = [row["contact_floor_z"] / (125 * G * cosine) for row in read_csv(moves)[1:]]
                self.assertLess(max(abs(one - 1) for one in borne), 0.05)
                ends = [np.array(list(nodes_of(output / "final.msh").values()))[:, 0].mean() for output in (stands, moves)]
                way = ends[1] - ends[0]
                expected = self.uniformly_accelerated(G * (tangent - friction) * cosine, 0.006, 100, "implicit euler")
                if part < 1:
                    self.assertLess(abs(way), 2e-3)
                else:
                    self.assertAlmostEqual(way / expected, 1, delta=0.02)

    def test_a_cube_that_slides_stops_where_it_should(self):
        rows = read_csv(self.solve({**CUBE, "Obstacles/floor/Friction": "0.3", "Initial/Velocity": "10; 0; 0", "Time/End": "3.6",
                                    "Time/Step": "0.02"}))
        way = 0.02 * sum(row["momentum_x"] for row in rows[1:])
        expected = 100 / (2 * 0.3 * G) - 0.02 * 10 / 2
        self.assertAlmostEqual(way / expected, 1, delta=0.01)
        heats = [row["heat_friction"] for row in rows]
        self.assertTrue(all(a <= b for a, b in zip(heats, heats[1:])))
        self.assertAlmostEqual(rows[-1]["energy_dissipated"] / heats[-1], 1, places=12)

    def test_a_floor_of_many_triangles_is_as_smooth_as_a_plane(self):
        rng, n = np.random.default_rng(3), 12
        lines = []
        for i in range(n + 1):
            for j in range(n + 1):
                x, y = -0.3 + 1.2 * i / n, -0.4 + 1.2 * j / n
                if 0 < i < n and 0 < j < n:
                    x, y = np.array([x, y]) + rng.uniform(-0.03, 0.03, 2)
                lines.append(f"v {x} {y} -0.05\n")
        for i in range(n):
            for j in range(n):
                a = i * (n + 1) + j + 1
                lines.append(f"f {a} {a + n + 1} {a + n + 2}\nf {a} {a + n + 2} {a + 1}\n")
        self.write("ground.obj", "".join(lines))
        ends = []
        for shape in ("plane 0 0 -0.05  0 0 1", "surface ground.obj"):
            output = self.solve({**CUBE, "Obstacles/floor/Shape": shape, "Obstacles/floor/Friction": "0.3", "Initial/Velocity": "1.5; 0.5; 0",
                                 "Time/Step": "0.002", "Time/End": "0.5", "Solver/Step tolerance": "1e-8"})
            ends.append(np.array(list(nodes_of(output / "final.msh").values())))
        way = ends[0][0] - np.array([0, 0, 0])
        print("slides by", way, "and differs by", np.abs(ends[1] - ends[0]).max())
        self.assertGreater(way[0], 0.2)
        self.assertLess(np.abs(ends[1] - ends[0]).max(), 1e-6)

    def test_an_oblique_impact_has_the_ratio_of_friction(self):
        rows = read_csv(self.solve({**CUBE, "Obstacles/floor/Friction": "0.2", "Obstacles/floor/Shape": "plane 0 0 -0.06 0 0 1",
                                    "Initial/Velocity": "5; 0; -2", "Time/Step": "0.001", "Time/End": "0.03", "Loads/Gravity": None,
                                    "Obstacles/Lag tolerance": "1e-6"}))
        tangential = rows[0]["momentum_x"] - rows[-1]["momentum_x"]
        normal = rows[-1]["momentum_z"] - rows[0]["momentum_z"]
        self.assertGreater(normal, 2)
        self.assertAlmostEqual(tangential / normal, 0.2, delta=0.002)

    def test_a_run_warns_where_friction_has_not_settled(self):
        slides = {**CUBE, "Obstacles/floor/Friction": "0.3", "Initial/Velocity": "1; 0; 0", "Time/End": "0.1"}
        remedy = "Set Obstacles/Lag tolerance to 1e-10 or more"
        for tolerance, expected in (("0.1", False), ("1e-14", True), ("1e-10", False)):
            with self.subTest(tolerance):
                run = self.attempt({**slides, "Obstacles/Lag tolerance": tolerance})
                self.assertEqual((run.status, "Friction had not settled in " in run.stderr, remedy in run.stderr), (0, expected, expected), run.stderr)


class Statics(ObstacleTest):
    CUBE = {**CUBE, "Scene": "static", "Time/Step": None, "Time/End": None, "Time/Increments": "2", "Solver/Tolerance": "1e-10"}
    WEIGHT = 1000 * 0.001 * G
    PRESSED = {**CUBE, "Material/Young's modulus": "1e5", "Material/Poisson's ratio": "0", "Loads/Gravity": None,
               "Obstacles/Names": "below, above", "Obstacles/floor/Shape": None, "Obstacles/below/Shape": "plane 0 0 -0.05  0 0 1",
               "Obstacles/above/Shape": "plane 0 0 0.05  0 0 -1", "Obstacles/above/Motion": "0; 0; -0.04*t", "Time/Increments": "5"}

    def test_weak_springs_hold_what_a_floor_does_not(self):
        last = read_csv(self.solve({**self.CUBE, "Obstacles/Free": "weak springs"}))[-1]
        springs = last["weak_springs_z"]
        self.assertAlmostEqual((last["contact_floor_z"] + springs) / self.WEIGHT, 1, places=8)
        # 1e-6 E L times how far it has sunk, at most the width
        self.assertLess(abs(springs), 1e-6 * 1e7 * 0.1 * sqrt(3) * 5e-3 * 0.1 * sqrt(3))

    def test_friction_alone_bears_what_it_can(self):
        tangent = 0.25
        cosine = 1 / sqrt(1 + tangent**2)
        down = G * tangent * cosine
        for young in ("1e7", "1e10"):  # springs that stayed would bear 4e-5 and 4e-2 of the load along the slope
            last = read_csv(self.solve({**self.CUBE, "Obstacles/Free": "friction", "Obstacles/floor/Friction": 2 * tangent,
                                        "Time/Increments": "1", "Obstacles/Lag tolerance": "1e-6", "Material/Young's modulus": young,
                                        "Loads/Gravity": f"{down}, 0, {-G * cosine}"}, output=young))[-1]
            self.assertAlmostEqual(-last["contact_floor_x"] / down, 1, delta=1e-5)  # of 1 kg

    def test_two_plates_press_a_body_that_nothing_else_holds(self):
        # without Poisson's effect and friction the strain is the same everywhere
        for free, friction, changes in (("weak springs", "0", {}), ("friction", "0.5", {}),
                                        ("weak springs", "0", {"Model/Element": "P2", "Obstacles/above/Motion": "0; 0; -0.03*t"}),
                                        ("friction", "0.5", {"Model/Element": "P2"})):
            with self.subTest(free, **changes):
                self.check_pressed({"Obstacles/Free": free, "Obstacles/above/Friction": friction, "Obstacles/below/Friction": friction, **changes})

    @needs_trilinos
    def test_two_plates_press_a_body_whose_linear_systems_are_solved_by_iterations(self):
        for free, friction in (("weak springs", "0"), ("friction", "0.5")):
            with self.subTest(free):
                self.check_pressed({"Solver/Linear solver": "iterative", "Obstacles/Free": free, "Obstacles/above/Friction": friction,
                                    "Obstacles/below/Friction": friction})

    def check_pressed(self, changes):
        output = self.solve({**self.PRESSED, **changes}, output="pressed")
        rows, places = read_csv(output), np.array(list(nodes_of(output / "final.msh").values()))
        height = places[:, 2].max() - places[:, 2].min()
        self.assertLess(height, 0.0725)
        self.assertLessEqual(max(row["iterations"] for row in rows), 40)
        force = 1e5 * 0.01 * (1 - height / 0.1)
        self.assertAlmostEqual(rows[-1]["contact_above_z"] / -force, 1, delta=1e-3)
        self.assertAlmostEqual(rows[-1]["contact_below_z"] / force, 1, delta=1e-3)

    def test_friction_carries_a_stiff_body_with_the_floor(self):
        # by half of its size; springs to where it was would bear its weight
        moved = {**self.CUBE, "Obstacles/Free": "friction", "Obstacles/floor/Friction": "0.5", "Material/Young's modulus": "1e9",
                 "Time/Increments": "5", "Obstacles/floor/Motion": "0.05*t; 0.01*t; 0"}
        output = self.solve(moved)
        rest = nodes_of(self.solve({**moved, "Obstacles/floor/Motion": "0; 0; 0"}, output="rest") / "final.msh")
        ways = np.array([np.subtract(end, rest[node]) for node, end in nodes_of(output / "final.msh").items()])
        self.assertLess(np.abs(ways - [0.05, 0.01, 0]).max(), 1e-5)
        self.assertLess(abs(read_csv(output)[-1]["contact_floor_x"]), 1e-3 * self.WEIGHT)

    def test_a_body_that_lies_on_another_is_pressed(self):
        write_boxes(self.directory / "two.msh", Box((0, 0, 0), (.1, .1, .06), (2, 2, 1)), Box((.02, .03, .061), (.07, .08, .1), (1, 1, 1)))
        for free in ("friction", "weak springs"):
            with self.subTest(free):
                run = self.attempt({**self.PRESSED, "Mesh/Generator": None, "Mesh/Box size": None, "Mesh/Box cells": None,
                                    "Mesh/File": "two.msh", "Contact/Bodies": "true", "Contact/Friction": "0.5",
                                    "Obstacles/below/Shape": "plane 0 0 0  0 0 1", "Obstacles/above/Shape": "plane 0 0 0.1  0 0 -1",
                                    "Obstacles/above/Motion": "0; 0; -0.01*t", "Obstacles/below/Friction": "0.5",
                                    "Obstacles/above/Friction": "0.5", "Obstacles/Free": free}, output=free)
                self.assertEqual(run.status, 0, run.stderr)  # friction of the pair may not settle, which a warning says
                rows = read_csv(run.output)
                self.assertLess(rows[-1]["contact_above_z"], -1)
                self.assertAlmostEqual(rows[-1]["contact_below_z"] / -rows[-1]["contact_above_z"], 1, delta=1e-3)

    def test_a_body_that_an_obstacle_presses_is_loaded(self):
        pressed = {**self.CUBE, "Loads/Gravity": None, "Handles/Names": "soles", "Handles/soles/Select": "boundary 5",
                   "Obstacles/floor/Shape": "plane 0 0 0.06 0 0 -1", "Obstacles/floor/Motion": "0; 0; -0.02*t"}
        run = self.attempt(pressed)
        self.assertEqual((run.status, "Nothing loads the body" in run.stderr), (0, False), run.stderr)
        self.assertLess(read_csv(run.output)[-1]["contact_floor_z"], -1)

    def test_friction_holds_a_body_on_a_slope(self):
        for tan in (0, 0.1, 0.4):
            cos = 1 / sqrt(1 + tan**2)
            scene = {**self.CUBE, "Loads/Gravity": f"{-G * tan * cos}, 0, {-G * cos}", "Obstacles/Free": "friction",
                     "Obstacles/floor/Friction": "0.5"}
            last = read_csv(self.solve(scene, output=f"slope{tan}"))[-1]
            self.assertAlmostEqual(last["contact_floor_z"] / (cos * self.WEIGHT), 1, delta=1e-5)
            self.assertAlmostEqual(last["contact_floor_x"] / (cos * self.WEIGHT), tan, delta=1e-5)


class Reproducible(ObstacleTest):
    SCENE = {**BAR, "Obstacles/floor/Friction": "0.5", "Obstacles/floor/Shape": SHAPES["sphere"], "Initial/Velocity": "1; 0; -2",
             "Time/End": "0.3", "Output/Every": "10"}

    def test_the_number_of_threads_changes_nothing(self):
        one = results(self.solve(self.SCENE, "--threads", "1", output="one"))
        self.assertEqual(one, results(self.solve(self.SCENE, "--threads", "3", output="three")))

    def test_a_run_goes_on_in_contact_as_if_it_had_not_stopped(self):
        whole = self.solve(self.SCENE, output="whole")
        self.solve({**self.SCENE, "Time/End": "0.15"}, output="parts")
        run = self.call("scene.prm", "--output", "parts", "--resume", "--set", "Time/End=0.3")
        self.assertEqual(run.status, 0, run.stderr)
        parts = results(self.directory / "parts")
        for name, content in results(whole).items():
            if name != "frame_0015.vtu":
                self.assertEqual(parts[name], content, name)


class AgainstAReference(ObstacleTest):
    KEYS = {**BAR, "Mesh/Box size": "0.4, 0.2, 0.2", "Mesh/Box cells": "2, 1, 1", "Solver/Tolerance": "1e-12",
            "Solver/Step tolerance": "1e-12", "Model/Dilatation": "cells", "Initial/Velocity": "0; 0; -2", "Time/End": "0.2",
            "Obstacles/Distance": "0.005", "Material/Mass matrix": "consistent"}

    def check(self, shape, contact_of):
        output = self.solve({**self.KEYS, "Obstacles/floor/Shape": shape})
        mesh = read_msh(self.solve({**self.KEYS, "Obstacles/Names": None, "Obstacles/floor/Shape": None, "Obstacles/Distance": None,
                                    "Initial/Velocity": None, "Loads/Gravity": None, "Time/End": "0.01"}, output="rest")
                        / "final.msh")
        numbers = sorted(mesh.nodes)
        rest = np.round([mesh.nodes[n] for n in numbers], 12)
        cells = np.array([element[-4:] for element in mesh.elements if element[1] == 4]) - 1
        volumes = np.linalg.det(rest[cells][:, 1:] - rest[cells][:, :1])
        cells[volumes < 0] = cells[volumes < 0][:, [0, 2, 1, 3]]
        body = Reference(rest, cells, 1e5, 0.3, 1000, (0, 0, -G), 0.005)
        x, v = rest, np.tile((0.0, 0.0, -2.0), (len(rest), 1))
        contact = contact_of(body)
        for _ in range(20):
            x, v = body.step(x, v, 0.01, contact)
        end = nodes_of(output / "final.msh")
        error = max(np.abs(np.subtract(end[n], x[i])).max() for i, n in enumerate(numbers))
        print(f"{shape}: greatest difference to the reference {error:.1e} m")
        self.assertGreater(max(row["contact_floor_z"] for row in read_csv(output)), 10)
        self.assertLess(error, 1e-8)

    def test_a_half_space(self):
        self.check("plane 0 0 -0.13  0.1 0.2 1", lambda body: body.plane((0, 0, -0.13), (0.1, 0.2, 1)))

    def test_a_sphere(self):
        self.check("sphere 0.15 0.02 -0.6 0.45", lambda body: body.sphere(np.array((0.15, 0.02, -0.6)), 0.45))


class FromTheBeginning(ObstacleTest):
    def test_what_touches_far_obstacles_comes_to_rest(self):
        # distances from a centre, corners or an axis that are far away are rounded as these coordinates are
        for shape in ("sphere 0.05 0 -100.05 100", "inside box -3 -3 -.05 3 3 20", "inside box -.5 -.5 -.05 .5 .5 5",
                      "box -50 -50 -50 50 50 -.05", "capsule -50 0 -10.05 50 0 -10.05 10"):
            for young in ("1e7", "1e8"):
                with self.subTest(shape=shape, young=young):
                    run = self.attempt({**CUBE, "Material/Young's modulus": young, "Obstacles/floor/Shape": shape, "Obstacles/floor/Friction": "0.5",
                                        "Loads/Gravity": f"2, 0, {-G}", "Time/Step": "0.002", "Time/End": "0.06"})
                    self.assertEqual(run.status, 0, run.stderr)
                    self.assertAlmostEqual(read_csv(run.output)[-1]["contact_floor_z"], G, delta=.05 * G)

    def test_an_obstacle_that_is_not_there_yet_does_not_count(self):
        lid = {"Obstacles/floor/Shape": "plane 0 0 0 0 0 1", "Obstacles/floor/Motion": "0; 0; t < 0.02 ? 0 : -1", "Obstacles/floor/From": "0.03",
               "Time/End": "0.05"}
        run = self.attempt({**BAR, **lid})
        self.assertEqual(run.status, 0, run.stderr)
        self.assertIn("No step ends near Obstacles/floor", " ".join(read_summary(run.output)["warnings"]))
        stays = self.attempt({**BAR, **lid, "Obstacles/floor/Motion": None})
        self.assertEqual(stays.status, 2)
        self.assertIn("Obstacles/floor appears at t = 0.03 s where the body is, near (", stays.stderr)
        self.assertEqual(read_summary(stays.output)["status"], "failed")
        self.assertTrue((stays.output / "final.msh").exists())

    def test_a_floor_that_was_raised_into_the_body_stops_a_resume(self):
        fall = {**BAR, "Obstacles/floor/Shape": "plane 0 0 -0.13 0 0 1", "Time/End": "0.1"}
        run = self.attempt(fall)
        self.assertEqual(run.status, 0, run.stderr)
        raised = self.write("raised.prm", prm({**fall, "Obstacles/floor/Shape": "plane 0 0 -0.11 0 0 1", "Time/End": "0.2"}))
        before = (run.output / "statistics.csv").read_bytes()
        again = self.call(raised, "--output", run.output, "--resume-from", "10")
        self.assertEqual(again.status, 1, again.stderr)
        self.assertIn("At t = 0.1 s the body is inside of Obstacles/floor, near (", again.stderr)
        self.assertEqual((run.output / "statistics.csv").read_bytes(), before)


class Refused(BadInputTest):
    CASES = (
        ({"Obstacles/floor/Shape": None}, "Obstacles/floor/Shape is not set. Allowed: plane x y z nx ny nz"),
        ({"Obstacles/floor/Shape": "plane 0 0 1"}, "'plane' takes 6 numbers"),
        ({"Obstacles/floor/Shape": "plane 0 0 1 0 0 0"}, "its normal has no length"),
        ({"Obstacles/floor/Shape": "cone 0 0 1 0 0 0"}, "Allowed: plane"),
        ({"Obstacles/floor/Shape": "sphere 0 0 -2 -1"}, "radius must be positive"),
        ({"Obstacles/floor/Shape": "box 0 0 0 1 1 -1"}, "greater than the first one in z"),
        ({"Obstacles/floor/Shape": "plane 0 0 0 0 0 1"}, "m deep. A displacement of the body by (0, 0, 0.1"),
        ({"Obstacles/floor/Shape": "box -5 -5 -5 5 5 5"}, "The body begins inside of Obstacles/floor"),
        ({"Obstacles/floor/Shape": "surface nothing.obj"}, "nothing.obj"),
        ({"Obstacles/floor/Shape": "surface across.obj"}, "The body touches Obstacles/floor"),
        ({"Obstacles/floor/Shape": "surface crossing.obj"}, "intersects itself near"),
        ({"Obstacles/floor/Friction": "-0.1"}, "Obstacles/floor/Friction = -0.1 is not allowed"),
        ({"Obstacles/floor/Friction": "1e300"}, "Obstacles/floor/Friction = 1e+300 is not allowed. Allowed: 0 to 1e6."),
        ({"Obstacles/Sheep": "1"}, "a subsection each, such as Obstacles/NAME/Shape and Obstacles/NAME/Motion."),
        ({"Obstacles/Names": "floor, floor"}, "lists 'floor' twice"),
        ({"Obstacles/Distance": "1"}, "above a tenth of the body's diameter"),
        ({"Obstacles/Distance": "1e-9"}, "below a millionth"),
        ({"Obstacles/Distance": "near"}, "Allowed: auto, or a positive number"),
        ({"Obstacles/floor/Follow cache": "rig.mdd"}, "is no surface"),
        ({"Obstacles/floor/Motion": "10*t; 0"}, "Obstacles/floor/Motion"),
        ({"Obstacles/floor/Motion": "0; 0; 100*t"}, "more than a quarter of the body's diameter"),
        ({"Obstacles/floor/Motion": "0; 0; -1e3*max(t - 150, 0)", "Time/End": "160"}, "m in the step to t = 150.01"),
        ({"Obstacles/floor/Turn": "0; 150*t; 0"}, "Obstacles/floor turns by 1.5 rad in the step to t = 0.01 s, more than 1"),
        ({"Obstacles/floor/Turn": "0; 200*pi*t; 0"}, "Obstacles/floor turns by 2.4 rad in the step to t = 0.01 s, more than 1"),
        ({"Obstacles/Names": "floor, floor_torque", "Obstacles/floor_torque/Shape": "plane 0 0 -5 0 0 1"}, "Give one of them another name"),
        ({"Obstacles/floor/Until": "-1"}, "the obstacle would never be there"),
        ({"Model/Gradient": "frozen"}, "nothing keeps it out"),
        ({"Solver/Method": "fixed point"}, "nothing keeps it out"),
        ({"Output/Space error": "true"}, "Output/Space error"),
        ({"Loads/Balanced": "true"}, "Loads/Balanced"),
        ({"Scene": "static", "Time/Step": None, "Time/End": None}, "Obstacles/Free = friction or weak springs"),
        ({"Scene": "static", "Time/Step": None, "Time/End": None, "Obstacles/Free": "friction"}, "no obstacle has friction"),
        ({"Scene": "interpolation", "Loads/Gravity": None, "Time/Step": None, "Time/End": None,
          "Examples/Pose functions": "x; y; 2*z"}, "an interpolation follows"),
    )

    def test_every_mistake_is_named(self):
        self.write("across.obj", SHEET.replace("-0.2\n", "0\n").replace("-0.25", "0").replace("-0.3", "0"))
        self.write("crossing.obj", SHEET + "v 0.3 0.2 -5\nv 0.4 0.2 5\nv 0.3 0.4 -5\nf 5 6 7\n")
        for changes, expected in self.CASES:
            with self.subTest(expected):
                self.write("scene.prm", prm({**BAR, **changes}))
                before = self.tree()
                self.check(self.call("scene.prm", "--output", "out"), (expected,), before)


if __name__ == "__main__":
    unittest.main()
