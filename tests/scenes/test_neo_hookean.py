# SPDX-License-Identifier: GPL-3.0-or-later
"""A neo-Hookean background: a closed form, small strains, examples, inverted cells, and what is refused."""

import unittest

from exemplar_runner import TENSED, SceneTest, read_csv, read_msh, results

E, NU = 1e6, 0.3
BOX = {"Scene": "static", "Mesh/Generator": "box", "Mesh/Box size": "4, 1, 1", "Mesh/Box cells": "4, 1, 1",
       "Material/Young's modulus": str(E), "Material/Poisson's ratio": str(NU), "Model/Background": "neo-hookean"}
# a bar in tension, free to become thinner
TENSION = {
    **BOX,
    **TENSED,
}
CELLS = {"Model/Dilatation": "cells"}
EXAMPLES = {"Examples/Pose functions": "1.3*x; y; z | x; y; z+0.05*x^2", "Examples/Energy": "blended",
            "Examples/Importance": "0.5"}
# held at one end, lifted at the other
LIFTED = {**BOX, "Mesh/Box cells": "6, 2, 2", "Handles/Names": "left, right", "Handles/left/Select": "boundary 1",
          "Handles/right/Select": "boundary 2", "Handles/right/Motion": "0; 0; 1.5*t", "Output/Every": "0"}


def tension(s):
    """Force over the area at rest, and lateral stretch, of a bar stretched by s."""
    mu, lam = E / 2 / (1 + NU), E * NU / (1 + NU) / (1 - 2 * NU)
    mu_s, lam_s = 4 / 3 * mu, lam + 5 / 6 * mu
    alpha = 1 + 0.75 * mu_s / lam_s

    def factor(r):
        return mu_s * (1 - 1 / (s * s + 2 * r * r + 1))

    low, high = 0.0, 2.0
    for _ in range(100):
        r = (low + high) / 2
        low, high = (r, high) if factor(r) + lam_s * (s * r * r - alpha) * s < 0 else (low, r)
    return factor(low) * (s - low * low / s), low


class NeoHookean(SceneTest):
    def test_tension(self):
        for change in {}, CELLS, {"Model/Element": "P2"}, {"Time/Increments": "1"}:
            with self.subTest(**change):
                output = self.solve({**TENSION, "Time/Increments": "4", "Handles/pull/Motion": "4*t; 0; 0", **change})
                for row in read_csv(output):
                    force = tension(1 + row["time"])[0]
                    self.assertAlmostEqual(row["reaction_pull_x"], force, delta=1e-6 * E)
                width = max(y for _, y, _ in read_msh(output / "final.msh").nodes.values()) + 0.5
                self.assertAlmostEqual(width, tension(2)[1], delta=1e-7)

    def test_small_strains_see_the_material(self):
        output = self.solve({**TENSION, "Time/Increments": "1", "Handles/pull/Motion": "4e-7*t; 0; 0"})
        row = read_csv(output)[-1]
        self.assertAlmostEqual(row["reaction_pull_x"] / (1e-7 * E), 1, delta=1e-6)
        self.assertAlmostEqual(row["energy_elastic"] / (2 * 1e-14 * E), 1, delta=1e-6)
        width = max(y for _, y, _ in read_msh(output / "final.msh").nodes.values()) + 0.5
        self.assertAlmostEqual((1 - width) / 1e-7, NU, delta=1e-6)

    def test_a_block_in_the_strain_of_its_example(self):
        force, width = tension(1.3)  # the example is what the body would be without it
        output = self.solve({**TENSION, **EXAMPLES, "Handles/pull/Motion": "1.2*t; 0; 0", "Time/Increments": "4",
                             "Examples/Weight penalty": "0", "Examples/Pose functions": f"1.3*x; {width}*y; {width}*z"})
        row = read_csv(output)[-1]
        self.assertAlmostEqual(row["weight_1"], 1, delta=1e-6)
        self.assertAlmostEqual(row["reaction_pull_x"], 0.5 * force, delta=1e-6 * force)
        self.assertAlmostEqual(row["energy_example"], -0.5 * row["energy_elastic"], delta=1e-6 * row["energy_elastic"])

    def test_an_inverted_body_recovers(self):
        for change in {}, CELLS, {"Model/Element": "P2"}, EXAMPLES, {**EXAMPLES, **CELLS}:
            with self.subTest(**change):
                scene = {**BOX, **change, "Mesh/Box cells": "4, 2, 2", "Handles/Names": "left",
                         "Handles/left/Select": "boundary 1", "Time/Increments": "1", "Solver/Maximum iterations": "200",
                         "Initial/Pose function": "x<0.5 ? x : -0.3*x; 0.5*y; 1.4*z"}
                rows = read_csv(self.solve(scene))
                self.assertGreater(rows[0]["inverted_cells"], 0)
                self.assertEqual(rows[-1]["inverted_cells"], 0)
                self.assertLess(rows[-1]["energy_elastic"], 1e-8 * rows[0]["energy_elastic"])

    def test_iterations_are_those_of_the_corotational_body(self):
        for change in {}, CELLS, {**EXAMPLES, **CELLS}, EXAMPLES, {"Model/Element": "P2"}:
            with self.subTest(**change):
                iterations = []
                for background in "corotational", "neo-hookean":
                    output = self.solve({**LIFTED, **change, "Time/Increments": "5",
                                         "Model/Background": background}, output=background)
                    iterations.append(sum(row["iterations"] for row in read_csv(output)))
                self.assertLessEqual(iterations[1], 1.5 * iterations[0])

    def lift(self, **changes):
        return read_csv(self.solve({**LIFTED, "Mesh/Box cells": "8, 2, 2", "Time/Increments": "5", **changes}))[-1]["reaction_right_z"]

    def test_patches_do_not_lock(self):
        for nu in "0.49", "0.499":
            material = {"Material/Poisson's ratio": nu}
            quadratic = self.lift(**material, **{"Model/Element": "P2"})
            self.assertGreater(self.lift(**material, **CELLS), 2 * quadratic)
            self.assertLess(self.lift(**material), 1.12 * quadratic)
            # nearly at rest they are those of the corotational body
            small = {**material, "Handles/right/Motion": "0; 0; 1e-7*t", "Time/Increments": "1"}
            corotational = self.lift(**small, **{"Model/Background": "corotational"})
            self.assertAlmostEqual(self.lift(**small) / corotational, 1, delta=1e-6)

    def test_a_damped_body_in_patches_by_any_number_of_threads(self):
        scene = {**LIFTED, **EXAMPLES, "Scene": "dynamic", "Material/Density": "1000", "Time/Step": "0.02", "Time/End": "0.2",
                 "Time/Stiffness damping": "0.01", "Output/Every": "5"}
        one, three = (results(self.solve(scene, "--threads", n, output=n)) for n in "13")
        self.assertEqual([name for name in one if one[name] != three[name]], [])

    def test_a_ratio_at_which_rest_is_not_lowest_is_warned_of(self):
        for nu, warns in ("-0.9", True), ("-0.88", False):
            run = self.attempt({**LIFTED, "Material/Poisson's ratio": nu, "Handles/right/Motion": "0; 0; 0.01*t", "Time/Increments": "1"})
            self.assertEqual(run.status, 0)
            self.assertEqual("turned inside out" in run.stdout + run.stderr, warns)

    def test_resumed_dynamics(self):
        scene = {**LIFTED, **EXAMPLES, "Scene": "dynamic", "Material/Density": "1000", "Time/Step": "0.02", "Time/End": "0.4",
                 "Time/Stiffness damping": "0.01", "Output/Every": "5", "Output/Keep states": "true"}
        whole = results(self.solve(scene, output="whole"))
        self.solve(scene)
        resumed = results(self.solve(scene, "--resume-from", "10"))
        self.assertEqual([name for name in whole if resumed[name] != whole[name]], [])

    def test_what_is_refused(self):
        for change, words in (
                ({"Model/Strain": "green"}, ["Model/Background", "Model/Strain = corotational"]),
                ({"Model/Gradient": "frozen"}, ["Model/Background", "Model/Gradient = consistent"]),
                ({**EXAMPLES, "Examples/Energy": "scaled"}, ["Model/Background", "Examples/Energy = blended"]),
                ({"Material/Yield stress": "1"}, ["Model/Background", "Yield stress = 0"]),
                ({"Material/Fibre stiffness": "1", "Material/Fibre direction": "1, 0, 0"}, ["Model/Background", "Fibre stiffness"]),
                ({**EXAMPLES, "Scene": "interpolation", "Examples/Prescribed weights": "1-t; t; 0"}, ["Model/Background", "interpolation"])):
            with self.subTest(**change):
                run = self.attempt({**(BOX if "Scene" in change else LIFTED), **change})
                self.assertEqual(run.status, 1)
                for word in words:
                    self.assertIn(word, run.stderr)


if __name__ == "__main__":
    unittest.main()
