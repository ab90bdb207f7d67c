# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole scenes against closed forms."""

import math
import unittest

from exemplar_runner import SceneTest, distance, greatest_distance, read_csv, read_msh, read_vtu

E, DENSITY, G = 1e5, 800., 9.81

# 2 x 1 x 1 m
BLOCK = {
    "Mesh/Generator": "box",
    "Mesh/Box size": "2, 1, 1",
    "Mesh/Box cells": "2, 2, 1",
    "Material/Young's modulus": str(E),
    "Material/Poisson's ratio": "0",
    "Material/Density": str(DENSITY),
    "Solver/Tolerance": "1e-11",
    "Output/Every": "0",
}
# Symmetry planes at the lower sides: the block may stretch, but not move.
ROLLERS = {f"Handles/{name}/{key}": value
           for name, side, component in (("x-", 1, "x"), ("y-", 3, "y"), ("z-", 5, "z"))
           for key, value in (("Select", f"boundary {side}"), ("Components", component))}
STATIC = {**BLOCK, "Scene": "static", "Time/Increments": "2", "Handles/Names": "x-, y-, z-",
          **ROLLERS}
STRAIN = 0.1
STRETCHED = {**STATIC, "Handles/Names": "x-, y-, z-, x+", "Handles/x+/Select": "boundary 2",
             "Handles/x+/Components": "x", "Handles/x+/Motion": f"{STRAIN}*2*t; 0; 0"}
FREE_BODY = {**BLOCK, "Scene": "dynamic", "Time/Increments": None, "Time/Step": "0.05", "Time/End": "0.5"}
BENT = "(1.3*z+1.5)*sin(x/1.5); y+0.1*x; (1.3*z+1.5)*cos(x/1.5)-1.5"


class Physics(SceneTest):
    def last_row(self, scene, **keywords):
        return read_csv(self.solve(scene, **keywords))[-1]

    def check(self, row, expected, relative=1e-9):
        """The values of a row; zeros on the scale of the others."""
        scale = max(abs(value) for value in expected.values())
        for name, value in expected.items():
            self.assertAlmostEqual(row[name], value, delta=relative * (abs(value) or scale),
                                   msg=name)

    def test_free_spin(self):
        """A stiff body that spins freely loses angular momentum by the law of implicit Euler alone.

        L_(n+1) = L_n + h sum v_(n+1) x M v_n (doc/dynamics.md) says of a rigid body that turns by the angle a_n in a
        step: tan a_(n+1) = sin a_n / (2 - cos a_n) and L_n = J sin a_n / h, first tan a_1 = h omega.
        """
        h, omega = 0.02, 6.
        scene = {**BLOCK, "Scene": "dynamic", "Time/Increments": None, "Material/Young's modulus": "1e10", "Time/Step": str(h),
                 "Time/End": "2", "Initial/Velocity": f"0; {-omega}*z; {omega}*y"}
        for method in ("newton", "quasi newton"):
            with self.subTest(method):
                rows = read_csv(self.solve({**scene, "Solver/Method": method}))
                moments = [row["angular_momentum_x"] / rows[0]["angular_momentum_x"] for row in rows]
                angle = math.atan(h * omega)
                for n, moment in enumerate(moments[1:], 1):
                    self.assertAlmostEqual(moment, math.sin(angle) / (h * omega), delta=2e-4, msg=n)
                    angle = math.atan(math.sin(angle) / (2 - math.cos(angle)))
                self.assertLess(moments[-1], 0.8)

    def test_free_fall(self):
        rest = self.write_box(BLOCK, "rest.msh").nodes
        for mass in ("consistent", "lumped"):
            with self.subTest(mass):
                scene = {**FREE_BODY, "Loads/Gravity": f"0, 0, {-G}", "Material/Mass matrix": mass,
                         "Initial/Velocity": "3; 0; 0"}
                output = self.solve(scene)
                h, n = 0.05, 10
                fall = G * h * h * n * (n + 1) / 2  # implicit Euler
                nodes = read_msh(output / "final.msh").nodes
                fallen = {number: (x + 3 * h * n, y, z - fall)
                          for number, (x, y, z) in rest.items()}
                self.assertLess(greatest_distance(nodes, fallen), 1e-12)
                row, v, m = read_csv(output)[-1], G * h * n, 2 * DENSITY
                self.check(row, {"momentum_x": 3 * m, "momentum_y": 0., "momentum_z": -m * v,
                                 "work_gravity": m * G * fall,
                                 "energy_kinetic": m * (v * v + 9) / 2}, 1e-11)
                # of the point mass at the centre, (x, 0, z)
                self.check(row, {"angular_momentum_x": 0., "angular_momentum_z": 0.,
                                 "angular_momentum_y": m * (-fall * 3 + (1 + 3 * h * n) * v)},
                           1e-11)
                self.assertLess(row["energy_elastic"], 1e-15 * E)

    def test_uniaxial_stretch(self):
        for name, axial in (("small", STRAIN), ("compression", -STRAIN)):
            with self.subTest(name):
                row = self.last_row({**STRETCHED, "Handles/x+/Motion": f"{axial}*2*t; 0; 0"})
                force = E * axial  # E (s - 1) A
                # forces of the ends of both increments, times their equal ways
                self.check(row, {"reaction_x+_x": force, "reaction_x-_x": -force,
                                 "reaction_x+_y": 0., "reaction_y-_y": 0., "reaction_z-_z": 0.,
                                 "energy_elastic": E * axial ** 2,
                                 "work_handles": 2 * E * axial ** 2 * (0.5 + 1) / 2,
                                 "min_det_F": 1 + axial})

    def test_lateral_contraction(self):
        output = self.solve({**STRETCHED, "Material/Poisson's ratio": "0.3", "Output/Every": "2"})
        self.check(read_csv(output)[-1], {"reaction_x+_x": E * STRAIN, "reaction_y-_y": 0.,
                                          "min_det_F": (1 + STRAIN) * (1 - 0.3 * STRAIN) ** 2})
        rest = self.write_box(BLOCK, "rest.msh").nodes
        thin = 1 - 0.3 * STRAIN
        expected = {number: ((1 + STRAIN) * x, thin * (y + 0.5) - 0.5, thin * (z + 0.5) - 0.5)
                    for number, (x, y, z) in rest.items()}
        self.assertLess(greatest_distance(read_msh(output / "final.msh").nodes, expected), 1e-10)
        arrays, _, n_cells = read_vtu(output / "frame_0002.vtu")
        for name, value in (("von_mises_stress", E * STRAIN),
                            ("strain_energy_density", E * STRAIN ** 2 / 2),
                            ("det_F", (1 + STRAIN) * thin ** 2)):
            for found in arrays["CellData", name]:
                self.assertAlmostEqual(found, value, delta=1e-9 * value)

    def test_regions(self):
        row = self.last_row({**STRETCHED, "Material/region 1/Young's modulus": str(3 * E)})
        self.check(row, {"reaction_x+_x": 3 * E * STRAIN})

    def test_standing_column(self):
        row = self.last_row({**STATIC, "Loads/Gravity": f"0, 0, {-G}"})
        weight = 2 * DENSITY * G
        self.check(row, {"reaction_z-_z": weight, "reaction_x-_x": 0., "reaction_y-_y": 0.})
        self.assertGreater(row["work_gravity"], 0.)
        self.assertGreater(row["energy_elastic"], 0.)
        self.assertLess(row["min_det_F"], 1.)  # it is compressed

    def test_loads_that_grow_with_the_increments(self):
        loads = {"Loads/Gravity": f"0, 0, {-G}", "Loads/Names": "pull", "Loads/pull/Select": "boundary 2",
                 "Loads/pull/Force": "1000; 0; 0"}
        half = {"Loads/Gravity": f"0, 0, {-G / 2}", "Loads/pull/Force": "500; 0; 0"}
        rows = read_csv(self.solve({**STATIC, **loads, "Loads/Ramp": "increments", "Time/Increments": "4"}))
        for row, scene in ((rows[2], {**loads, **half}), (rows[4], loads)):
            at_once = self.last_row({**STATIC, **scene})
            for column in ("energy_elastic", "reaction_z-_z", "reaction_x-_x", "min_det_F"):
                self.assertAlmostEqual(row[column], at_once[column], delta=1e-7 * abs(at_once[column]))
        # forces at the ends of four steps, of a body that is nearly linear: (1 + 2 + 3 + 4) / 16 of all at once
        self.assertAlmostEqual(rows[4]["work_gravity"] / at_once["work_gravity"], 10 / 16, delta=0.01)
        self.assertAlmostEqual(rows[4]["work_loads"] / at_once["work_loads"], 10 / 16, delta=0.01)

    def test_dead_force(self):
        # shared by area it strains the block evenly
        row = self.last_row({**STATIC, "Loads/Names": "pull", "Loads/pull/Select": "boundary 2",
                             "Loads/pull/Force": "1000*t; 0; 0"})
        strain = 1000 / E
        self.check(row, {"reaction_x-_x": -1000., "reaction_y-_y": 0., "min_det_F": 1 + strain,
                         "energy_elastic": E * strain ** 2,
                         "work_loads": 2 * 1000 * strain * (0.5 + 1) / 2})

    def turned(self, method):
        c, s = math.cos(2.5), math.sin(2.5)
        turned = self.write_box(BLOCK, "turned.msh",
                                lambda x, y, z: (c * x - s * y + 7, s * x + c * y, z)).nodes
        output = self.solve({**FREE_BODY, "Solver/Method": method,
                             "Initial/Pose function": "cos(2.5)*x-sin(2.5)*y+7; "
                                                      "sin(2.5)*x+cos(2.5)*y; z"})
        self.assertLess(greatest_distance(read_msh(output / "final.msh").nodes, turned), 1e-11)
        for row in read_csv(output):
            self.assertLess(row["energy_elastic"] + row["energy_kinetic"], 1e-20 * E)
            self.assertAlmostEqual(row["min_det_F"], 1., delta=1e-12)

    def test_turned_body_stays(self):
        self.turned("one pass")

    def test_turned_body_stays_with_convergence(self):
        self.turned("fixed point")

    def test_example_energy(self):
        example = {**STATIC, "Time/Increments": "1",
                   "Examples/Pose functions": f"{1 + STRAIN}*x; y; z"}
        there = {"Initial/Pose function": f"{1 + STRAIN}*x; y; z"}
        elastic = E * STRAIN ** 2
        for eta in (1., 0.5):
            scene = {**example, **there, "Loads/Gravity": "0, 0, -1",
                     "Examples/Importance": str(eta), "Examples/Weights": "prescribed",
                     "Examples/Prescribed weights": "0; 1"}
            row = read_csv(self.solve(scene))[0]
            # the block has the example's strain: (1 - eta)^2 of the elastic energy is left
            self.check(row, {"energy_elastic": elastic,
                             "energy_example": elastic * ((1 - eta) ** 2 - 1)})
        # free weights begin at the first example, so that of the example the ridge is left
        row = read_csv(self.solve({**example, "Examples/Weight penalty": "8",
                                   "Loads/Gravity": "0, 0, -1"}))[0]
        self.check(row, {"weight_0": 1., "weight_1": 0., "energy_example": 4.})

    def test_free_weights_follow_the_handles(self):
        # stretched to its example: the elastic stress vanishes, the rollers are not loaded
        row = self.last_row({**STRETCHED, "Examples/Pose functions": f"{1 + STRAIN}*x; y; z",
                             "Examples/Importance": "1", "Examples/Weight penalty": "0"})
        self.check(row, {"weight_0": 0., "weight_1": 1., "reaction_x+_x": 0.}, 1e-7)

    def test_interpolation_ends_in_the_example(self):
        edges = [(a, b) for element in self.write_box(BLOCK, "rest.msh").elements
                 if element[1] == 4 for a in element[-4:] for b in element[-4:] if a < b]
        self.assertEqual(len(edges), 6 * 24)

        def bent(x, y, z):
            r = 1.3 * z + 1.5
            return r * math.sin(x / 1.5), y + 0.1 * x, r * math.cos(x / 1.5) - 1.5

        example = self.write_box(BLOCK, "bent.msh", bent).nodes
        scene = {**BLOCK, "Scene": "interpolation", "Time/Increments": "4",
                 "Examples/Prescribed weights": "1-t; t", "Solver/Maximum iterations": "2000"}
        for pose in ({"Examples/Pose functions": BENT}, {"Examples/Poses": "bent.msh"}):
            output = self.solve({**scene, **pose})
            nodes = read_msh(output / "final.msh").nodes
            self.assertLess(max(abs(distance(nodes[a], nodes[b]) - distance(example[a], example[b]))
                                for a, b in edges), 1e-7)
            self.check(read_csv(output)[-1], {"weight_0": 0., "weight_1": 1.})
            self.assertGreater(greatest_distance(nodes, read_msh(
                self.directory / "rest.msh").nodes), 0.2)

    def test_a_free_body_follows_a_turned_handle(self):
        angle = math.radians(157)

        def turned(x, y, z):
            return (math.cos(angle) * x + math.sin(angle) * z + 1, y - 2,
                    math.cos(angle) * z - math.sin(angle) * x)

        (self.directory / "poses").mkdir()
        pose = self.write_box(BLOCK, "poses/turned.msh", turned).nodes
        scene = {**BLOCK, "Scene": "static", "Time/Increments": "3", "Handles/Names": "end",
                 "Handles/end/Select": "boundary 1"}
        output = self.solve({**scene, "Handles/end/Follow pose": "poses/turned.msh"})
        self.assertLess(greatest_distance(read_msh(output / "final.msh").nodes, pose), 1e-9)
        # again from what has been written down
        again = self.call(output / "parameters.prm", "--output", "again", "--quiet")
        self.assertEqual((again.status, again.stderr), (0, ""))
        self.assertEqual((self.directory / "again/final.msh").read_bytes(),
                         (output / "final.msh").read_bytes())

        # on straight lines it is warned of
        straight = (f"t*({math.cos(angle)}*x+{math.sin(angle)}*z+1-x); -2*t; "
                    f"t*({math.cos(angle)}*z-{math.sin(angle)}*x-z)")
        run = self.attempt({**scene, "Handles/end/Motion": straight}, "--validate")
        self.assertEqual(run.status, 0)
        self.assertRegex(run.stderr, r"^Warning: Handles/end/Motion .* 157 degrees .*"
                                     r"Handles/end/Follow pose.*\n$")

    def test_a_local_minimum_is_said_to_be_one(self):
        # both ends at rest and a full turn between them
        angle = "(2*pi*x/12)"
        turned = f"x; y*cos{angle}-z*sin{angle}; y*sin{angle}+z*cos{angle}"
        scene = {"Scene": "static", "Mesh/Generator": "box", "Mesh/Box size": "12, 1, 1",
                 "Mesh/Box cells": "24, 2, 2", "Handles/Names": "left, right",
                 "Handles/left/Select": "boundary 1", "Handles/right/Select": "boundary 2",
                 "Time/Increments": "1"}
        run = self.attempt({**scene, "Initial/Pose function": turned})
        self.assertEqual(run.status, 0)
        self.assertRegex(run.stderr, r"^Warning: .* local minimum .* J, .*\n$")
        self.assertEqual(self.attempt(scene).stderr, "")

    def test_umfpack_and_cholesky_agree(self):
        scene = {**STRETCHED, "Examples/Pose functions": f"1.2*x; y; z | {BENT}",
                 "Loads/Gravity": "0, 0, -1", "Material/Poisson's ratio": "0.3",
                 "Solver/Method": "fixed point", "Solver/Maximum iterations": "500",
                 "Examples/Weights": "free", "Examples/Weight penalty": "paper"}
        outputs = [self.solve({**scene, "Solver/Linear solver": solver}, output=solver)
                   for solver in ("cholesky", "umfpack")]
        poses = [read_msh(output / "final.msh").nodes for output in outputs]
        rows = [read_csv(output)[-1] for output in outputs]
        self.assertLess(greatest_distance(*poses), 1e-10)
        for i in range(3):
            self.assertAlmostEqual(rows[0][f"weight_{i}"], rows[1][f"weight_{i}"], delta=1e-10)
        self.assertGreater(abs(rows[0]["weight_2"]), 1e-3)
        self.assertGreater(abs(rows[0]["weight_1"]), 1e-3)


if __name__ == "__main__":
    unittest.main()
