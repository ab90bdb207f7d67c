# SPDX-License-Identifier: GPL-3.0-or-later
"""Output/Space error: how far a mesh is from ever finer ones."""

import csv
import json
import unittest
from pathlib import Path

from exemplar_runner import SceneTest, read_msh, read_pvd, read_vtu, results

LIMITS = Path(__file__).resolve().parents[2] / "doc/studies/space_limits.csv"

# the body of prm/studies/space_bar.prm
WEIGHT = {
    "Scene": "static",
    "Mesh/Generator": "box",
    "Mesh/Box size": "4, 1, 1",
    "Mesh/Box cells": "8, 2, 2",
    "Material/Young's modulus": "1e8",
    "Material/Density": "1000",
    "Handles/Names": "left",
    "Handles/left/Select": "boundary 1",
    "Loads/Gravity": "0, 0, -1",
    "Time/Increments": "1",
    "Output/Every": "0",
}
# moving, with an example of unknown weight
SWING = {
    "Scene": "dynamic",
    "Mesh/Generator": "box",
    "Mesh/Box size": "4, 1, 1",
    "Mesh/Box cells": "4, 1, 1",
    "Material/Young's modulus": "1e6",
    "Material/Poisson's ratio": "0.45",
    "Examples/Pose functions": "(8/pi-z)*sin(pi*x/8); y; 8/pi - (8/pi-z)*cos(pi*x/8)",
    "Examples/Weights": "free",
    "Examples/Importance": "0.8",
    "Handles/Names": "left",
    "Handles/left/Select": "boundary 1",
    "Handles/left/Motion": "0; 0; 0.3*sin(4*t)",
    "Loads/Gravity": "0, 0, -9.81",
    "Time/Step": "0.02",
    "Time/End": "0.2",
    "Output/Every": "5",
}


def errors(output):
    return json.loads((output / "summary.json").read_text()).get("space_error")


def energy(output):
    with open(output / "statistics.csv", newline="") as file:
        return float(list(csv.DictReader(file))[-1]["energy_elastic"])


class SpaceError(SceneTest):
    def test_the_correction_is_the_quadratic_solution_where_all_is_linear(self):
        for strain in ("linear", "green"):
            with self.subTest(strain):
                # so small a load that Green's strain is linear, too
                scene = {**WEIGHT, "Model/Strain": strain, "Loads/Gravity": "0, 0, -0.1", "Model/Dilatation": "cells"}
                dilatation = "patches" if strain == "linear" else "cells"
                linear = self.solve({**scene, "Output/Space error": "true"}, output=strain)
                quadratic = self.solve({**scene, "Model/Element": "P2", "Model/Dilatation": dilatation}, output=strain + " P2")
                expected = 1 - energy(linear) / energy(quadratic)
                self.assertAlmostEqual(errors(linear)["energy"] / expected, 1., delta=1e-3)

    def test_effectivity(self):
        """Against the limits of doc/studies/space_limits.csv, which come from outside the program."""
        with open(LIMITS, newline="") as file:
            limits = {row["nu"]: float(row["energy"]) for row in csv.DictReader(file) if row["body"] == "bar"}
        for poisson in ("0.3", "0.45", "0.499"):
            for dilatation in ("cells", "patches"):
                with self.subTest(dilatation, poisson=poisson):
                    output = self.solve({**WEIGHT, "Material/Poisson's ratio": poisson, "Model/Dilatation": dilatation,
                                         "Output/Space error": "true"}, output=f"{dilatation} {poisson}")
                    true = 1 - energy(output) / limits[poisson]
                    found = errors(output)
                    self.assertEqual(set(found), {"displacement", "energy"})
                    self.assertAlmostEqual(found["energy"] / true, 1., delta=0.1)
                    self.assertAlmostEqual(found["displacement"] / self.distance(output, poisson), 1., delta=0.15)

    def distance(self, output, poisson):
        """Of the nodes from where quadratic elements on the same mesh have them, over the length of their way."""
        rest = self.solve({**WEIGHT, "Loads/Gravity": "0, 0, 0"}, output="rest")
        quadratic = self.solve({**WEIGHT, "Material/Poisson's ratio": poisson, "Model/Element": "P2", "Model/Dilatation": "patches"},
                               output="P2")
        x, x_rest, x_true = (read_msh(folder / "final.msh").nodes for folder in (output, rest, quadratic))

        def square(a, b):
            return sum((p - q) ** 2 for number in a for p, q in zip(a[number], b[number]))
        return (square(x, x_true) / square(x_rest, x_true)) ** 0.5

    def test_large_deflections(self):
        """Of half the length: there the energy is the difference from quadratic elements', which a second run has."""
        scene = {**WEIGHT, "Material/Young's modulus": "1e6", "Loads/Gravity": "0, 0, -9.81", "Time/Increments": "4"}
        for name, model in {"patches": {"Model/Dilatation": "patches"}, "green": {"Model/Strain": "green"}}.items():
            with self.subTest(name):
                found = errors(self.solve({**scene, **model, "Output/Space error": "true"}, output=name))
                elements = {"Model/Element": "P2", **model}
                potentials = [self.potential({**scene, **which}, f"{name} {i}") for i, which in enumerate((model, elements))]
                expected = abs(potentials[0][0] - potentials[1][0]) / potentials[1][1]
                self.assertAlmostEqual(found["energy"] / expected, 1., delta=0.02)

    def potential(self, scene, output):
        """Elastic energy less the work of the weight by nodal volumes, and the elastic energy [J]."""
        run = self.solve({**scene, "Output/Final pose": "quadratic"} if scene.get("Model/Element") == "P2" else scene, output=output)
        rest = self.solve({**scene, "Loads/Gravity": "0, 0, 0",
                           **({"Output/Final pose": "quadratic"} if scene.get("Model/Element") == "P2" else {})}, output=output + " rest")
        x, x_rest = read_msh(run / "final.msh"), read_msh(rest / "final.msh").nodes
        work = 0.
        for element in x.elements:
            if element[1] not in (4, 11):
                continue
            nodes = element[-10:] if element[1] == 11 else element[-4:]
            a, b, c, d = (x_rest[number] for number in nodes[:4])
            u, v, w = ([q[i] - a[i] for i in range(3)] for q in (b, c, d))
            volume = abs(u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2])
                         + u[2] * (v[0] * w[1] - v[1] * w[0])) / 6
            # integrals of quadratic shape functions: -V/20 at corners, V/5 in the middles
            shares = [0.25] * 4 if len(nodes) == 4 else [-0.05] * 4 + [0.2] * 6
            work -= 9.81 * 1000 * volume * sum(s * (x.nodes[n][2] - x_rest[n][2]) for s, n in zip(shares, nodes))
        return energy(run) - work, energy(run)

    def test_a_body_without_strain_has_no_error(self):
        fall = {**SWING, "Examples/Pose functions": None, "Examples/Weights": None, "Examples/Importance": None,
                "Handles/Names": None, "Handles/left/Select": None, "Handles/left/Motion": None}
        for name, scene in {"rest": {**WEIGHT, "Loads/Gravity": "0, 0, 0"}, "fall": fall}.items():
            with self.subTest(name):
                found = errors(self.solve({**scene, "Output/Space error": "true"}, output=name))
                self.assertLess(found["displacement"], 1e-8)
                self.assertLess(found["energy"], 1e-8)

    def test_where_the_exact_tangent_leads_nowhere(self):
        """Coarse cells that lock, with weights at a compromise: the estimate is like that of one brick less."""
        lifted = {"Scene": "static", "Mesh/Generator": "box", "Mesh/Box size": "4, 1, 1", "Examples/Importance": "0.8",
                  "Examples/Pose functions": SWING["Examples/Pose functions"], "Handles/Names": "left, right",
                  "Handles/left/Select": "boundary 1", "Handles/right/Select": "boundary 2", "Handles/right/Motion": "0; 0; t",
                  "Handles/right/Components": "z", "Model/Dilatation": "cells", "Output/Every": "0"}
        eight, ten = (errors(self.solve({**lifted, "Mesh/Box cells": f"{n}, 2, 2", "Output/Space error": "true"}, output=str(n))) for n in (8, 10))
        for kind in ("displacement", "energy", "weights"):
            self.assertLess(abs(ten[kind] / eight[kind] - 1), .25, kind)

    def test_it_shows_where_to_refine(self):
        output = self.solve({**WEIGHT, "Output/Space error": "true", "Output/Every": "1"})
        frame, _, n_cells = read_vtu(output / "frame_0001.vtu")
        density = frame["CellData", "space_error"]
        self.assertEqual(len(density), n_cells)
        rest = read_vtu(output / "frame_0000.vtu")[0]
        self.assertNotIn(("CellData", "space_error"), rest)
        points, cells = rest["Points", "Points"], rest["Cells", "connectivity"]
        middles = [sum(points[3 * node] for node in cells[4 * i:4 * i + 4]) / 4 for i in range(n_cells)]
        near = sum(d for d, x in zip(density, middles) if x < 1)
        self.assertGreater(near, 0.5 * sum(density))  # beside the clamped end
        self.assertGreater(min(density), 0.)

    def test_frames_have_it_and_nothing_else_changes(self):
        plain = self.solve(SWING, output="plain")
        asked = self.solve({**SWING, "Output/Space error": "frames"}, output="asked")
        self.assertIsNone(errors(plain))
        self.assertEqual(set(errors(asked)), {"displacement", "energy", "weights"})
        self.assertEqual(len(read_pvd(asked)), 3)
        for _, name in read_pvd(asked):
            shown, before = read_vtu(asked / name)[0], read_vtu(plain / name)[0]
            self.assertEqual({key: shown[key] for key in before}, before)
            self.assertEqual(set(shown) - set(before), {("CellData", "space_error")})
            self.assertIn('Name="space_error_displacement"', (asked / name).read_text())
        changed, unchanged = results(asked), results(plain)
        for name in ("final.msh", "statistics.csv"):
            self.assertEqual(changed[name], unchanged[name])

    def test_it_is_the_same_after_a_resume(self):
        scene = {**SWING, "Output/Space error": "true"}
        whole = self.solve(scene, output="out")
        expected = errors(whole)
        (whole / "summary.json").unlink()
        self.solve(scene, "--resume", output="out")
        found = errors(whole)
        for what, value in expected.items():
            self.assertGreater(value, 1e-4)
            self.assertAlmostEqual(found[what] / value, 1., delta=1e-9)

    def test_the_closing_table_names_both_errors(self):
        run = self.attempt({**WEIGHT, "Output/Space error": "true"})
        self.assertRegex(run.stdout, r"Errors\n  steps +residual up to \S+\n  space +displacement \S+ %, energy \S+ %\n")

    def test_a_failing_estimate_leaves_the_results(self):
        """The handle's motion is no number in the middles of edges, which only quadratic elements have."""
        scene = {**WEIGHT, "Handles/left/Motion": "0; 0; abs(abs(y-0.5)-0.25) < 0.01 ? sqrt(-1) : 0", "Output/Every": "1"}
        plain = self.solve(scene, output="plain")
        run = self.attempt({**scene, "Output/Space error": "frames"})
        self.assertEqual(run.status, 0)
        self.assertIn("no estimate: ", run.stdout)
        self.assertEqual(set(errors(run.output)), {"failure"})
        self.assertEqual(results(run.output), results(plain))

    def test_quadratic_elements_are_refused(self):
        run = self.attempt({**WEIGHT, "Model/Element": "P2", "Output/Space error": "true"})
        self.assertEqual(run.status, 1)
        self.assertIn("Output/Space error", run.stderr)
        self.assertIn("Model/Element = P1", run.stderr)


if __name__ == "__main__":
    unittest.main()
