# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies that may not pass through themselves or each other: nothing crosses by exact arithmetic, an implementation of its own,
closed forms, and what is refused."""

import json
import unittest
from math import cos, pi, sin

import numpy as np
from bad_inputs import BadInputTest
from contact_reference import Reference, boundary, pairs
from exact_crossings import crossings
from exemplar_runner import BAR, SceneTest, nodes_of, prm, read_csv, read_vtu, results
from mpirun import launch
from piece_boxes import Box, write_boxes

G = 9.81
FREE = {"Scene": "dynamic", "Mesh/File": "pieces.msh", "Material/Young's modulus": "1e5", "Material/Poisson's ratio": "0.3",
        "Material/Density": "1000", "Contact/Bodies": "true", "Time/Step": "0.01", "Time/End": "0.3",
        "Solver/Maximum iterations": "400", "Output/Every": "1"}
CROSS = (Box((0, -0.1, -0.1), (1, 0.1, 0.1), (6, 1, 1)), Box((0.4, -0.5, 0.12), (0.6, 0.5, 0.32), (1, 6, 1)))


def horseshoe(x, y, z):
    """A bar along x from 0 to 4, bent: its ends lie beside each other, .5 m apart at least."""
    angle, radius = 0.9 * 2 * pi * (x / 4 - 0.5), 0.75 - z
    return radius * sin(angle), y, -radius * cos(angle)


class BodyContactTest(SceneTest):
    def write_pieces(self, *boxes):
        places, cells, self.owners = write_boxes(self.directory / "pieces.msh", *boxes)
        self.rest, self.cells = np.array(places), np.array(cells)
        self.triangles = boundary(self.cells)

    def frames(self, output):
        for file in sorted(output.glob("frame_*.vtu")):
            arrays, n, _ = read_vtu(file)
            yield np.array(arrays["Points", "Points"]).reshape(n, 3), arrays

    def flat_triangles(self, arrays):
        """Of the surface: those of linear cells, or the four of each face of quadratic ones."""
        cells = np.array(arrays["Cells", "connectivity"]).reshape(len(self.cells), -1)
        if cells.shape[1] == 4:
            return self.triangles
        middle = {frozenset((int(cell[a]), int(cell[b]))): cell[4 + k] for cell in cells
                  for k, (a, b) in enumerate(((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)))}
        flat = []
        for a, b, c in boundary(cells[:, :4]):
            p, q, r = (middle[frozenset(map(int, side))] for side in ((a, b), (b, c), (c, a)))
            flat += [(a, p, r), (p, b, q), (r, q, c), (p, q, r)]
        return np.array(flat)

    def last(self, output):
        end = nodes_of(output / "final.msh")
        return np.array([end[i + 1] for i in range(len(end))])

    def assert_apart(self, output, also_self=False):
        """No frame has an edge that passes through a triangle of another piece or, if so, of its own one."""
        n = 0
        for x, arrays in self.frames(output):
            piece = {node: self.owners[cell[0]] for cell in np.array(arrays["Cells", "connectivity"]).reshape(len(self.cells), -1)
                     for node in cell}
            found = crossings(x, self.flat_triangles(arrays))
            self.assertEqual([pair for pair in found if also_self or piece[pair[0][0]] != piece[pair[1][0]]], [], n)
            n += 1
        self.assertGreater(n, 1)


class Bodies(BodyContactTest):
    def test_two_bars_that_cross_never_meet(self):
        self.write_pieces(*CROSS)
        for speed, more in ((3, {}), (3, {"Solver/Method": "newton"}), (10, {"Material/Young's modulus": "1e6"}),
                            (10, {}), (3, {"Material/Young's modulus": "1e7", "Time/Step": "0.005"}),
                            (3, {"Time/Scheme": "bdf2"}), (3, {"Model/Element": "P2", "Time/End": "0.15"})):
            with self.subTest(speed=speed, **more):
                output = self.solve({**FREE, "Initial/Velocity": f"0; 0; (z > 0.11 ? {-speed} : 0)", **more})
                self.assert_apart(output)
                rows = read_csv(output)
                self.assertGreater(max(row["body_pairs"] for row in rows), 0)
                self.assertGreater(min(row["least_body_gap"] for row in rows), 0)

    def test_a_pose_in_which_pieces_cross_is_warned_of(self):
        self.write_pieces(*CROSS)
        scene = {**FREE, "Contact/Bodies": "true", "Time/End": "0.01", "Time/Step": "0.01"}
        for pose, words in (("x; y; z > 0.11 ? z - 0.1 : z", "the surface meets itself or another piece in this pose, near ("),
                            ("x; y; z > 0.11 ? z + 0.1 : z", "")):
            run = self.attempt({**scene, "Examples/Pose functions": pose})
            self.assertEqual(run.status, 0, run.stderr)
            self.assertIn(words, run.stderr)
            self.assertEqual("meets itself" in run.stderr, bool(words))

    def test_momentum_is_kept_and_energy_not_gained(self):
        self.write_pieces(*CROSS)
        rows = read_csv(self.solve({**FREE, "Initial/Velocity": "0.3; 0; (z > 0.11 ? -3 : 0)", "Solver/Step tolerance": "1e-10",
                                    "Solver/Tolerance": "1e-12"}))
        energies = [row["energy_kinetic"] + row["energy_elastic"] + row["energy_body_contact"] for row in rows]
        momenta = [np.array([row[f"momentum_{c}"] for c in "xyz"]) for row in rows]
        print("momentum", max(np.abs(p - momenta[0]).max() for p in momenta) / np.abs(momenta[0]).max(),
              "gain", (max(energies) - energies[0]) / max(row["energy_kinetic"] for row in rows))
        for momentum in momenta:
            np.testing.assert_allclose(momentum, momenta[0], atol=1e-9 * np.abs(momenta[0]).max())
        self.assertLess(max(energies), energies[0] + 0.02 * max(row["energy_kinetic"] for row in rows))

    def test_the_numpy_reference(self):
        self.write_pieces(Box((0, -0.1, -0.1), (0.4, 0.1, 0.1), (2, 1, 1)), Box((0.12, -0.22, 0.115), (0.3, 0.18, 0.3), (1, 2, 1)))
        body = Reference(self.rest, self.cells, 1e5, 0.3, 1000, (0, 0, 0), 0.005)
        v = np.array([(0.0, 0.1, -0.4) if owner else (0.0, 0.0, 0.0) for owner in self.owners])
        x, contact, touched = self.rest, pairs(body, self.owners), 0
        for _ in range(12):
            x, v = body.step(x, v, 0.01, contact)
            touched += contact(x)[0] > 0
            self.assertEqual(crossings(x, self.triangles), [])  # it has no bound on steps of its own
        self.assertGreater(touched, 2)
        for method in ("quasi newton", "newton"):
            output = self.solve({**FREE, "Solver/Tolerance": "1e-12", "Model/Dilatation": "cells", "Material/Mass matrix": "consistent",
                                 "Contact/Distance": "0.005", "Initial/Velocity": "0; (z > 0.11 ? 0.1 : 0); (z > 0.11 ? -0.4 : 0)",
                                 "Time/End": "0.12", "Solver/Method": method,
                                 **({"Solver/Step tolerance": "1e-12"} if method == "quasi newton" else {})})
            error = np.abs(self.last(output) - x).max()
            print(f"{method}: greatest difference to the reference {error:.1e} m")
            self.assertLess(error, 1e-7)

    def test_a_block_bears_the_weight_of_another(self):
        self.write_pieces(Box((0, 0, 0), (0.2, 0.2, 0.2), (2, 2, 2)), Box((0.03, 0.04, 0.2015), (0.15, 0.16, 0.3), (2, 2, 2)))
        output = self.solve({**FREE, "Loads/Gravity": f"0, 0, {-G}", "Handles/Names": "base",
                             "Handles/base/Select": "box -1 -1 -1  1 1 0.001", "Time/End": "3", "Solver/Tolerance": "1e-12",
                             "Contact/Friction": "0.5",
                             "Time/Step": "0.02", "Solver/Step tolerance": "1e-10", "Output/Every": "150"})
        *_, (x, arrays) = self.frames(output)
        force = np.array(arrays["PointData", "body_contact_force"]).reshape(-1, 3)
        weight = 1000 * 0.12 * 0.12 * 0.0985 * G
        of_upper = force[np.array(self.owners) == 1].sum(0)
        print("force over weight - 1", of_upper / weight - [0, 0, 1])
        np.testing.assert_allclose(of_upper / weight, [0, 0, 1], atol=1e-6)
        np.testing.assert_allclose(force.sum(0), 0, atol=1e-9 * weight)

    def test_a_stack_stays_where_it_stands(self):
        self.write_pieces(*(Box((0.01 * (k % 2), 0.007 * (k % 3), 0.2015 * k), (0.2 + 0.01 * (k % 2), 0.2 + 0.007 * (k % 3), 0.2 + 0.2015 * k),
                                (2, 2, 2)) for k in range(5)))
        output = self.solve({**FREE, "Material/Young's modulus": "1e7", "Loads/Gravity": f"0, 0, {-G}", "Contact/Friction": "0.5",
                             "Handles/Names": "base", "Handles/base/Select": "box -1 -1 -1  1 1 0.001", "Time/Step": "0.02", "Time/End": "11",
                             "Output/Every": "50"})
        owners = np.array(self.owners)
        middles = np.array([[x[owners == k].mean(0) for k in range(5)] for x, _ in self.frames(output)])
        drift = np.abs(middles[2:] - middles[1]).max() / 0.2  # it has come to rest after a second
        print("drift of a stack in 10 s, of a side", drift)
        self.assertLess(drift, 1e-3)

    def test_a_handle_presses_a_static_block_into_another(self):
        self.write_pieces(Box((0, 0, 0), (1, 1, 0.4), (4, 4, 2)), Box((0.3, 0.3, 0.42), (0.7, 0.7, 0.8), (2, 2, 2)))
        static = {"Scene": "static", "Mesh/File": "pieces.msh", "Contact/Bodies": "true", "Material/Young's modulus": "1e5",
                  "Handles/Names": "base, hand", "Handles/base/Select": "box -1 -1 -1  2 2 0.001",
                  "Handles/hand/Select": "box -1 -1 0.799  2 2 2", "Handles/hand/Motion": "0; 0; -0.12*t", "Time/Increments": "4",
                  "Output/Every": "1"}
        output = self.solve(static)
        self.assert_apart(output)
        last = read_csv(output)[-1]
        self.assertAlmostEqual(last["reaction_hand_z"] / last["reaction_base_z"], -1, delta=1e-6)
        self.assertGreater(abs(last["reaction_hand_z"]), 100)

    def test_a_handle_that_would_be_driven_through_another_is_told_in_words(self):
        self.write_pieces(Box((0, 0, 0), (1, 1, 0.4), (2, 2, 1)), Box((0.3, 0.3, 0.5), (0.7, 0.7, 0.8), (1, 1, 1)))
        run = self.attempt({"Scene": "static", "Mesh/File": "pieces.msh", "Contact/Bodies": "true", "Handles/Names": "base, hand",
                            "Handles/base/Select": "box -1 -1 -1  2 2 0.401", "Handles/hand/Select": "box -1 -1 0.499  2 2 0.51",
                            "Handles/hand/Motion": "0; 0; -0.5*t", "Time/Increments": "4"})
        self.assertEqual(run.status, 2)
        self.assertRegex(run.stderr, r"At t = [0-9.]+ s handle 'hand' and the surface near \([-0-9., e]+\) m meet")
        self.assertTrue((run.output / "final.msh").exists())

    def test_the_same_bytes_by_threads_and_resumed(self):
        self.write_pieces(*CROSS)
        for method in ("quasi newton", "newton"):
            scene = {**FREE, "Initial/Velocity": "0.5; 0; (z > 0.11 ? -3 : 0)", "Solver/Method": method, "Contact/Friction": "0.3",
                     "Output/Every": "5"}
            whole = self.solve(scene, output=f"{method} whole")
            self.assertGreater(read_csv(whole)[15]["body_pairs"], 0)
            self.assertEqual(results(whole), results(self.solve(scene, "--threads", "2", output=f"{method} two")))
            self.solve({**scene, "Time/End": "0.15"}, output="parts")
            run = self.call("scene.prm", "--output", "parts", "--resume", "--set", "Time/End=0.3")
            self.assertEqual((run.status, run.stderr), (0, ""))
            self.assertEqual(results(whole), results(self.directory / "parts"))

    def test_what_is_left_out_passes_and_what_is_not_does_not(self):
        self.write_pieces(*CROSS)
        lower, upper = "box -1 -1 -1  2 1 0.11", "box -1 -1 0.11  2 1 1"
        for left_out, passes in ((f"{lower}; {upper}", True), ("box -1 -1 -1  2 1 1", True), (f"{lower}; {lower}", False),
                                 (f"box -1 -1 -1  0.3 1 0.11; {upper}", False)):
            for element in ("P2", "P1"):
                with self.subTest(left_out=left_out, element=element):
                    output = self.solve({**FREE, "Contact/Leave out": left_out, "Model/Element": element, "Time/End": "0.08",
                                         "Initial/Velocity": "0; 0; (z > 0.11 ? -3 : 0)"})
                    pairs = max(row["body_pairs"] for row in read_csv(output))
                    *_, (x, arrays) = self.frames(output)
                    crossed = crossings(x, self.flat_triangles(arrays))
                    self.assertEqual((pairs == 0, crossed != []), (passes, passes))
                    self.assertEqual(json.loads((output / "summary.json").read_text())["pairs_left_out"], 0)
        words = " ".join((output / "log.txt").read_text().split())
        self.assertIn(f"Contact leaves out what never touches each other: 10 faces and 8 nodes in 'box -1 -1 -1 0.3 1 0.11', "
                      f"52 faces and 28 nodes in '{' '.join(upper.split())}'", words)

    def test_a_block_slips_on_a_tilted_block_or_stays(self):
        self.write_pieces(Box((0, 0, 0), (0.6, 0.2, 0.1), (6, 2, 1)), Box((0.05, 0.05, 0.104), (0.15, 0.15, 0.2), (1, 1, 1)))
        for tangent, friction in ((0.3, 0.2), (0.19, 0.2)):
            with self.subTest(tangent=tangent, friction=friction):
                slope = np.arctan(tangent)
                output = self.solve({**FREE, "Material/Young's modulus": "1e6", "Contact/Friction": str(friction),
                                     "Contact/Distance": "1e-3", "Loads/Gravity": f"{G * sin(slope)}, 0, {-G * cos(slope)}", "Handles/Names": "base",
                                     "Handles/base/Select": "box -1 -1 -1  1 1 0.1005", "Time/Step": "0.005", "Time/End": "0.6",
                                     "Solver/Step tolerance": "1e-7", "Contact/Slip speed": "1e-4"})
                x = np.array([np.mean(x[np.array(self.owners) == 1, 0]) for x, _ in self.frames(output)])
                if tangent < friction:
                    creep = 1e-4 * (1 - np.sqrt(1 - tangent / friction))
                    print("creeps by", (x[-1] - x[-21]) / 0.1, "of", creep)
                    self.assertLess(x[-1] - x[-21], 1.2 * 0.1 * creep)
                else:
                    rate = G * (sin(slope) - friction * cos(slope))
                    measured = (x[-1] - 2 * x[-21] + x[-41]) / 0.1 ** 2
                    print("slides by", measured, "of", rate)
                    self.assertAlmostEqual(measured / rate, 1, delta=0.005)


def open_trefoil(n):
    """Places, across them two directions, and along them one, of n + 1 sections of a rope with an overhand knot."""
    t = np.linspace(-2.15, 2.15, 4001)
    line = 0.2 * np.stack([t ** 3 - 3 * t, t ** 4 - 4 * t ** 2, t ** 5 / 5 - 2 * t], 1)
    way = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    places = np.stack([np.interp(np.linspace(0, way[-1], n + 1), way, line[:, c]) for c in range(3)], 1)
    along = np.gradient(places, axis=0)
    along /= np.linalg.norm(along, axis=1)[:, None]
    across, frames = np.cross(along[0], [0, 0, 1]), []
    for tangent in along:
        across = across - (across @ tangent) * tangent
        across /= np.linalg.norm(across)
        frames.append((across, np.cross(tangent, across)))
    return places, frames, along


class Self(BodyContactTest):
    JAWS = {"Scene": "static", "Mesh/File": "pieces.msh", "Contact/Self": "true", "Material/Young's modulus": "1e5",
            "Handles/Names": "lower, upper", "Time/Increments": "6", "Output/Every": "1",
            "Handles/lower/Select": "box -2 -2 0  -0.55 2 0.45", "Handles/upper/Select": "box 0.55 -2 0  2 2 0.45"}

    def test_a_knot_is_pulled_tight(self):
        n, half = 110, 0.02
        places, frames, along = open_trefoil(n)

        def place(s, y, z):
            return tuple(places[round(s)] + y * frames[round(s)][0] + z * frames[round(s)][1])
        self.write_pieces(Box((0, -half, -half), (n, half, half), (n, 1, 1), place))
        ends = {name: (places[i], sign * 0.8 * along[i]) for name, i, sign in (("first", 0, -1), ("last", n, 1))}
        scene = {**FREE, "Contact/Bodies": "false", "Contact/Self": "true", "Contact/Distance": "2e-3", "Material/Young's modulus": "1e6",
                 "Time/Mass damping": "5", "Time/Step": "0.02", "Time/End": "2.4", "Output/Every": "6", "Handles/Names": "first, last"}
        for name, (at, velocity) in ends.items():
            scene[f"Handles/{name}/Select"] = "sphere " + " ".join(f"{x:.6g}" for x in (*at, 0.032))
            scene[f"Handles/{name}/Motion"] = "; ".join(f"{v:.6g}*t" for v in velocity)
        output = self.solve(scene)
        self.assert_apart(output, also_self=True)
        self.assertGreater(read_csv(output)[-1]["body_pairs"], 0)
        self.assertEqual(json.loads((output / "summary.json").read_text())["pairs_left_out"], 0)

    def test_a_horseshoe_is_closed_over_itself(self):
        self.write_pieces(Box((0, -0.25, -0.125), (4, 0.25, 0.125), (16, 2, 1), horseshoe))
        ends = {"Handles/lower/Motion": "0.35*t; 0; 0", "Handles/upper/Motion": "-0.35*t; 0; 0.1*t"}
        for more in ({}, {"Scene": "dynamic", "Time/Increments": None, "Time/Step": "0.05", "Time/End": "1",
                          "Material/Density": "1000"}):
            with self.subTest(**more):
                scene = {key: value for key, value in {**self.JAWS, **ends, **more}.items() if value is not None}
                output = self.solve(scene)
                self.assert_apart(output, also_self=True)
                self.assertGreater(read_csv(output)[-1]["body_pairs"], 0)
        free = {**self.JAWS, **ends}
        del free["Contact/Self"]
        frames = [x for x, _ in self.frames(self.solve(free, output="free"))]
        self.assertNotEqual(crossings(frames[-1], self.triangles), [])


class Refused(BadInputTest):
    SCENE = {**BAR, "Contact/Self": "true"}
    INTERPOLATION = {"Scene": "interpolation", "Handles/Names": None, "Handles/left/Select": None, "Loads/Gravity": None,
                     "Examples/Pose functions": "x; y; 2*z"}
    CASES = (
        ({"Contact/Distance": "1"}, "Contact/Distance = 1 m is above a tenth of the body's diameter"),
        ({"Contact/Distance": "near"}, "Contact/Distance = 'near' is not allowed. Allowed: auto, or a positive number [m]"),
        ({"Contact/Slip speed": "0", "Contact/Friction": "1"}, "Contact/Slip speed = '0' is not allowed"),
        ({"Contact/Friction": "-1"}, "Contact/Friction = -1 is not allowed"),
        ({"Contact/Self": "false", "Contact/Bodies": "true"}, "but it is in one piece"),
        ({"Contact/Leave out": "boundary 1; "}, "has a selection without a word"),
        ({"Contact/Leave out": "boundary 1; cube 1"}, "Contact/Leave out = 'cube 1'"),
        ({"Contact/Leave out": "boundary 1; box 9 9 9  10 10 10"}, "Contact/Leave out = 'box 9 9 9  10 10 10' selects no node"),
        ({"Contact/Leave out": "boundary 1; box 0.9 -0.1 -0.1  1.1 0.1 0.1", "Mesh/Box cells": "4, 2, 2"},
         "Contact/Leave out: 'box 0.9 -0.1 -0.1  1.1 0.1 0.1' has no node of the body's surface"),
        ({"Solver/Method": "fixed point"}, "Contact/Self = true keeps surfaces of the body out of each other, but Model/Gradient = frozen and"),
        ({"Output/Space error": "true"}, "but Output/Space error"),
        ({"Loads/Balanced": "true"}, "but Loads/Balanced"),
        (INTERPOLATION, "an interpolation follows"),
        ({"Initial/Pose function": "(x > 1 ? 1.5 - x : x); y; z + (x > 1 ? 0.1 : 0)"}, "where the scene begins, but not at rest"),
    )

    def test_every_mistake_is_named(self):
        for changes, expected in self.CASES:
            with self.subTest(**changes):
                scene = {key: value for key, value in {**self.SCENE, **changes}.items() if value is not None}
                self.write("scene.prm", prm(scene))
                before = self.tree()
                self.check(self.call("scene.prm", "--output", "out"), [expected], before)

    def test_several_processes_are_refused(self):
        self.write("scene.prm", prm(self.SCENE))
        status, words, _ = launch(2, self.directory / "scene.prm", "--output", self.directory / "out")
        self.assertEqual(status, 1)
        self.assertIn("are not for several processes yet", "".join(words))
        self.assertFalse((self.directory / "out").exists())

    def test_keys_without_effect_are_named(self):
        for keys in ({"Contact/Self": "false", "Contact/Distance": "0.1"}, {"Contact/Self": "false", "Contact/Leave out": "boundary 1"}, {"Contact/Slip speed": "0.1"}):
            self.assertIn("Contact/", self.attempt({**self.SCENE, **keys}).stderr)


if __name__ == "__main__":
    unittest.main()
