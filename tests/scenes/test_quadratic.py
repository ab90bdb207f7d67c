# SPDX-License-Identifier: GPL-3.0-or-later
"""Quadratic elements: fields that they hold exactly, loads, handles, examples, and their files."""

import unittest

from exemplar_runner import (BAR, SceneTest, distance, nodes_of, read_csv, read_msh, read_summary, read_vtu, results,
                             write_msh)

P2 = {"Model/Element": "P2", "Output/Final pose": "quadratic"}
CUBE = {**P2, "Scene": "static", "Mesh/Generator": "box", "Mesh/Box size": "1, 1, 1", "Mesh/Box cells": "2, 2, 2",
        "Time/Increments": "1", "Material/Young's modulus": "1e6", "Material/Poisson's ratio": "0.3"}
WHOLE_BOUNDARY = {"Handles/Names": "all", "Handles/all/Select": "nodes boundary.txt"}
BENT = "(8/pi-z)*sin(pi*x/8); y; 8/pi-(8/pi-z)*cos(pi*x/8)"
# by the corners at their ends
GMSH_EDGES = [(0, 1), (1, 2), (2, 0), (3, 0), (2, 3), (1, 3)]
VTK_EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
TETRAHEDRON_4, TETRAHEDRON_10, TRIANGLE_6 = 4, 11, 9


def middle(a, b):
    return tuple((p + q) / 2 for p, q in zip(a, b))


class QuadraticElements(SceneTest):
    def rest(self, keys):
        """The rest pose with the middles of edges, as a run leaves it."""
        still = {**keys, "Scene": "dynamic", "Time/End": "1e-9", "Time/Step": "1e-9", "Solver/Method": "one pass",
                 "Handles/Names": "", "Loads/Gravity": None, "Initial/Pose": None, "Time/Increments": None}
        kept = {key: value for key, value in still.items()
                if value is not None and not key.startswith(("Handles/", "Loads/", "Examples/"))}
        return nodes_of(self.solve(kept, output="rest", file="rest.prm") / "final.msh")

    def check_field(self, scene, field, tolerance=1e-9):
        """That a run ends where `field` takes the nodes, those in the middles of edges included."""
        rest = self.rest(scene)
        found = nodes_of(self.solve(scene) / "final.msh")
        self.assertGreater(len(found), 27 + 50)
        for number, x in rest.items():
            self.assertLess(distance(found[number], field(*x)), tolerance)

    def hold_boundary(self):
        box = read_msh(self.solve({**CUBE, "Output/Final pose": "linear", "Handles/Names": "left",
                                   "Handles/left/Select": "boundary 1"}, output="box", file="box.prm") / "final.msh")
        on_faces = [str(n) for n, x in box.nodes.items() if any(abs(abs(c - m) - 0.5) < 1e-6 for c, m in zip(x, (.5, 0, 0)))]
        self.write("boundary.txt", " ".join(on_faces))

    def test_affine_motion_of_the_boundary_gives_the_affine_field(self):
        self.hold_boundary()
        for strain in "linear", "green", "corotational":
            scene = {**CUBE, **WHOLE_BOUNDARY, "Model/Strain": strain, "Handles/all/Motion": "0.1*x+0.2*z; 0.1*x; -0.05*y"}
            self.check_field(scene, lambda x, y, z: (1.1 * x + .2 * z, y + .1 * x, z - .05 * y))

    def test_quadratic_displacements_are_exact_with_the_force_that_belongs_to_them(self):
        # u = (0, 0, k x^2 / 2) has sigma_xz = mu k x, which the body force -mu k balances. Middles of held edges
        # follow the formula, too.
        self.hold_boundary()
        k, mu, rho = .4, 1e6 / 2.6, 1000
        scene = {**CUBE, **WHOLE_BOUNDARY, "Model/Strain": "linear", "Handles/all/Motion": f"0; 0; {k / 2}*x^2",
                 "Loads/Gravity": f"0, 0, {-mu * k / rho!r}"}
        self.check_field(scene, lambda x, y, z: (x, y, z + k / 2 * x * x))

    def test_a_force_on_a_boundary_is_a_constant_traction(self):
        # uniaxial stretch: the force per area over Young's modulus
        scene = {**CUBE, "Model/Strain": "linear", "Handles/Names": "x, y, z",
                 "Handles/x/Select": "boundary 1", "Handles/x/Components": "x",
                 "Handles/y/Select": "boundary 3", "Handles/y/Components": "y",
                 "Handles/z/Select": "boundary 5", "Handles/z/Components": "z",
                 "Loads/Names": "pull", "Loads/pull/Select": "boundary 2", "Loads/pull/Force": "1e5; 0; 0"}
        self.check_field(scene, lambda x, y, z: (1.1 * x, y - .03 * (y + .5), z - .03 * (z + .5)))

    def test_reactions_carry_loads_of_every_kind_of_selection(self):
        for select in "boundary 2", "region 1", "box 0.4 -1 -1 3 1 1", "sphere 1 0.5 0.5 0.1":
            scene = {**BAR, **P2, "Mesh/Box size": "1, 1, 1", "Loads/Gravity": "0, 0, -1", "Loads/Names": "tip",
                     "Loads/tip/Select": select, "Loads/tip/Force": "0; 30; 0"}
            row = read_csv(self.solve(scene))[-1]
            self.assertAlmostEqual(row["reaction_left_y"], -30, delta=1e-6)
            self.assertAlmostEqual(row["reaction_left_z"], 1000, delta=1e-5)

    def test_the_pose_of_an_example_is_recovered(self):
        for strain in "linear", "green", "corotational":
            scene = {**BAR, **P2, "Scene": "interpolation", "Handles/Names": None, "Handles/left/Select": None,
                     "Loads/Gravity": None, "Model/Strain": strain, "Examples/Pose functions": BENT,
                     "Time/Increments": "4", "Solver/Tolerance": "1e-12"}
            run = self.attempt(scene)
            row = read_csv(run.output)[-1]
            self.assertLess(abs(row["energy_elastic"] + row["energy_example"]), 1e-9 * row["energy_elastic"])
            # linear strain does not know a turn, so that another state has the strains of the pose
            self.assertEqual("ends beside example" in run.stderr, strain == "linear")
            self.assertEqual(row["inverted_cells"], 0)

    def test_free_fall_and_turning_keep_what_they_should(self):
        free = {**BAR, **P2, "Scene": "dynamic", "Handles/Names": None, "Handles/left/Select": None, "Time/Increments": None,
                "Time/Step": "0.01", "Time/End": "0.05", "Initial/Velocity": "0; -z; y", "Solver/Tolerance": "1e-11"}
        for mass in "consistent", "lumped":
            first, *_, last = read_csv(self.solve({**free, "Material/Mass matrix": mass}))
            self.assertAlmostEqual(last["momentum_z"], -2000 * .05, delta=1e-5)
            self.assertAlmostEqual(last["angular_momentum_x"] / first["angular_momentum_x"], 1, delta=.01)
            falling = read_csv(self.solve({**free, "Initial/Velocity": None, "Material/Mass matrix": mass}))[-1]
            self.assertLess(falling["energy_elastic"], 1e-9)
            # 1/2 J omega^2, J = m (1 + 1) / 12 of the consistent mass
            if mass == "consistent":
                self.assertAlmostEqual(first["energy_kinetic"], 2000 / 12, delta=1e-9)

    def test_files(self):
        output = self.solve({**BAR, **P2, "Loads/Gravity": "0, 0, -40"})
        final, rest = read_msh(output / "final.msh"), self.rest({**BAR, **P2})
        linear = read_msh(self.solve({**BAR, **P2, "Output/Final pose": "linear", "Loads/Gravity": "0, 0, -40",
                                      }, output="linear") / "final.msh")
        self.assertEqual(dict(list(final.nodes.items())[:len(linear.nodes)]), linear.nodes)
        types = [element[1] for element in final.elements]
        self.assertEqual(set(types), {TRIANGLE_6, TETRAHEDRON_10})
        for ten, four in zip(final.elements, linear.elements):
            n = 4 if ten[1] == TETRAHEDRON_10 else 3
            self.assertEqual(ten[5:5 + n], four[5:])
            for (a, b), node in zip(GMSH_EDGES, ten[5 + n:]):
                self.assertLess(distance(rest[node], middle(rest[ten[5 + a]], rest[ten[5 + b]])), 1e-9)
        arrays, n_points, n_cells = read_vtu(output / "frame_0000.vtu")
        cells = arrays["Cells", "connectivity"]
        points = list(zip(*[iter(arrays["Points", "Points"])] * 3))
        self.assertEqual((n_points, n_cells), (len(final.nodes), types.count(TETRAHEDRON_10)))
        self.assertEqual(set(arrays["Cells", "types"]), {24})  # VTK_QUADRATIC_TETRA
        self.assertEqual(arrays["Cells", "offsets"], [10 * (c + 1) for c in range(n_cells)])
        for cell in zip(*[iter(cells)] * 10):
            for (a, b), node in zip(VTK_EDGES, cell[4:]):
                self.assertLess(distance(points[node], middle(points[cell[a]], points[cell[b]])), 1e-12)
        for name in "strain_energy_density", "det_F", "von_mises_stress", "region":
            self.assertEqual(len(arrays["CellData", name]), n_cells)
        summary = read_summary(output)
        self.assertEqual((summary["element"], summary["nodes"], summary["dofs"]), ("P2", n_points, 3 * n_points))
        self.assertIn("quadratic elements", summary["used"])

    def test_a_pose_with_curved_edges_comes_back(self):
        bent = {**BAR, **P2, "Loads/Gravity": "0, 0, -40"}
        first = self.solve(bent, output="first")
        energy = read_csv(first)[-1]["energy_elastic"]
        self.write("curved.msh", (first / "final.msh").read_text())
        dynamic = {**bent, "Scene": "dynamic", "Time/Increments": None, "Time/Step": "0.01", "Time/End": "0.01",
                   "Initial/Pose": "curved.msh"}
        self.assertAlmostEqual(read_csv(self.solve(dynamic))[0]["energy_elastic"] / energy, 1, delta=1e-12)
        # its corners alone are another pose
        self.write("straight.msh", (self.solve({**bent, "Output/Final pose": "linear"}, output="linear")
                                    / "final.msh").read_text())
        straight = read_csv(self.solve({**dynamic, "Initial/Pose": "straight.msh"}))[0]["energy_elastic"]
        self.assertGreater(abs(straight / energy - 1), .01)
        refused = self.attempt({**dynamic, **{"Model/Element": "P1", "Output/Final pose": "linear"}})
        self.assertEqual(refused.status, 1)
        self.assertIn("curved edges, but Model/Element = P1", refused.stderr)

    def test_meshes_of_ten_node_tetrahedra(self):
        rest = read_msh(self.solve({**BAR, **P2, "Scene": "dynamic", "Time/Increments": None, "Time/Step": "1e-9",
                                    "Time/End": "1e-9", "Time/Step": "1e-9"}, output="box") / "final.msh")
        exact = rest._replace(nodes={n: tuple(round(c, 6) for c in x) for n, x in rest.nodes.items()})
        write_msh(self.directory / "ten.msh", exact)
        scene = {**BAR, **P2, "Mesh/Generator": None, "Mesh/Box size": None, "Mesh/Box cells": None, "Mesh/File": "ten.msh"}
        found = self.attempt(scene)
        self.assertEqual(found.status, 0, found.stderr)
        self.assertIn("of which the corners are taken", found.stderr)
        of_box = self.solve({**BAR, **P2}, output="of box")
        self.assertAlmostEqual(read_csv(found.output)[-1]["energy_elastic"]
                               / read_csv(of_box)[-1]["energy_elastic"], 1, delta=1e-9)
        far = max(exact.nodes)
        write_msh(self.directory / "ten.msh", exact._replace(
            nodes={**exact.nodes, far: tuple(c + .01 for c in exact.nodes[far])}))
        refused = self.attempt(scene)
        self.assertEqual(refused.status, 1)
        self.assertIn("has a curved edge", refused.stderr)
        self.assertIn("Mesh.ElementOrder = 1", refused.stderr)

    def test_what_cannot_be_is_refused(self):
        refused = self.attempt({**BAR, "Output/Final pose": "quadratic"})
        self.assertEqual(refused.status, 1)
        self.assertIn("Set Model/Element = P2", refused.stderr)

    def test_threads_and_resumed_runs_leave_the_same_bytes(self):
        scene = {**BAR, **P2, "Scene": "dynamic", "Time/Increments": None, "Time/Step": "0.01", "Time/End": "0.1",
                 "Examples/Pose functions": BENT, "Mesh/Box cells": "8, 3, 3"}
        whole = results(self.solve(scene, "--threads", "1", output="whole"))
        self.assertEqual(results(self.solve(scene, "--threads", "2", output="two")), whole)
        self.solve({**scene, "Time/End": "0.05"}, output="part")
        other = self.attempt({**scene, "Model/Element": "P1", "Output/Final pose": "linear"}, "--resume-from", "5", output="part")
        self.assertEqual(other.status, 1)
        self.assertIn("Model/Element", other.stderr)
        self.assertEqual(results(self.solve(scene, "--resume", output="part")), whole)


if __name__ == "__main__":
    unittest.main()
