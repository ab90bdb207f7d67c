# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies pulled far beyond what their material can mean: that they converge, to what, and what the program says."""

import math
import unittest

from exemplar_runner import REPOSITORY, SceneTest, read_csv

YOUNG = 1e5


def energy_density(stretches, nu):
    """Eqs. (5), (24), (25) and (26) of doc/model.md for cells of these principal stretches that make a patch."""
    lam, mu = YOUNG * nu / ((1 + nu) * (1 - 2 * nu)), YOUNG / (2 * (1 + nu))
    a, b, c = stretches
    norm = math.sqrt(a * a + b * b + c * c)
    slope, margin = lam * (norm - 3) - 2 * mu, 0.4 * (lam + mu)
    y, y_0 = (a + b) * (b + c) * (c + a) / norm ** 2, 0.4
    r = y_0 / 3 * (1 - y / y_0) ** 3 if y < y_0 else 0.  # by which the trace of thin cells is continued
    psi = mu * sum((s - 1) ** 2 for s in stretches) + lam / 2 * (sum(stretches) - 3 + r) ** 2
    if slope <= -margin:
        return psi
    q = slope if slope >= margin else (slope + margin) ** 2 / (4 * margin)
    return psi + 4 * q * r


def lateral_stretch(stretch, nu):
    """Of a bar that may contract freely: the least energy, by golden section."""
    ratio = (math.sqrt(5) - 1) / 2
    low, high = 0., 1.
    for _ in range(100):
        left, right = high - ratio * (high - low), low + ratio * (high - low)
        if energy_density((stretch, left, left), nu) < energy_density((stretch, right, right), nu):
            high = right
        else:
            low = left
    return (low + high) / 2


def bar(length, nu, **changes):
    """A clamped bar 4:1:1, drawn by `length` times its length while t goes from 0 to 1."""
    return {"Mesh/Generator": "box", "Mesh/Box size": "4, 1, 1", "Mesh/Box cells": "8, 2, 2",
            "Material/Young's modulus": str(YOUNG), "Material/Poisson's ratio": str(nu), "Material/Density": "1000",
            "Handles/Names": "left, right", "Handles/left/Select": "boundary 1",
            "Handles/right/Select": "boundary 2", "Handles/right/Motion": f"{4 * length}*t; 0; 0",
            "Output/Every": "0", **changes}


STATIC = {"Scene": "static", "Time/Increments": "10"}
DYNAMIC = {"Scene": "dynamic", "Time/Step": "0.02", "Time/End": "1"}


class Pulls(SceneTest):
    def converge(self, scene):
        """The rows of a scene that must converge, whatever the program warns of."""
        run = self.attempt(scene)
        self.assertEqual(run.status, 0, run.stderr)
        rows = read_csv(run.output)
        self.assertEqual({row["status"] for row in rows[1:]}, {"converged"})
        return rows

    def test_bars_drawn_by_ten_lengths_and_less(self):
        for length in (1, 3, 10):
            for nu in (0.3, 0.45, 0.49):
                for kind in (STATIC, DYNAMIC):
                    with self.subTest(length=length, nu=nu, kind=kind["Scene"]):
                        self.converge(bar(length, nu, **kind))

    def test_a_horse_drawn_by_its_head(self):
        """By its height, which is more than its length."""
        scene = {**STATIC, "Mesh/File": str(REPOSITORY / "meshes/horse.msh"), "Material/Young's modulus": "1e6",
                 "Material/Poisson's ratio": "0.45", "Handles/Names": "feet, head",
                 "Handles/feet/Select": "box -1 -1 -0.01  1 1 0.08", "Handles/head/Select": "box -9 -9 1.4  9 9 9",
                 "Handles/head/Motion": "0; 0; 1.7*t", "Output/Every": "0"}
        self.converge(scene)

    def test_a_free_bar_has_the_least_energy(self):
        """Drawn on rollers, all of it has one strain: that of the least energy."""
        nu = 0.45
        rollers = {f"Handles/{side}/{key}": value
                   for side, boundary, component in (("x-", 1, "x"), ("y-", 3, "y"), ("z-", 5, "z"), ("x+", 2, "x"))
                   for key, value in (("Select", f"boundary {boundary}"), ("Components", component))}
        for stretch in (2., 3., 1 + 1 / nu, 4., 8.):
            with self.subTest(stretch):
                scene = {**STATIC, "Mesh/Generator": "box", "Mesh/Box size": "1, 1, 1", "Mesh/Box cells": "2, 1, 1",
                         "Material/Young's modulus": str(YOUNG), "Material/Poisson's ratio": str(nu),
                         "Handles/Names": "x-, y-, z-, x+", **rollers, "Handles/x+/Motion": f"{stretch - 1}*t; 0; 0",
                         "Solver/Tolerance": "1e-11", "Output/Every": "0"}
                row = self.converge(scene)[-1]
                lateral = lateral_stretch(stretch, nu)
                # the golden section finds the place to half the digits, and the energy to all of them
                self.assertAlmostEqual(row["min_det_F"], stretch * lateral ** 2, delta=1e-6)
                self.assertAlmostEqual(row["energy_elastic"] / energy_density((stretch, lateral, lateral), nu), 1.,
                                       delta=1e-9)

    def test_the_warning_names_the_elements(self):
        run = self.attempt(bar(3, 0.45, **STATIC))
        self.assertRegex(run.stderr, r"cells are stretched to more than 1 \+ 1/nu = 3\.22 times their length at the end: "
                                     r"element \d+, \d+")
        self.solve(bar(0.5, 0.45, **STATIC))  # says nothing

    def test_where_nothing_moves_the_iterations_go_on(self):
        """From a crumpled start a single increment takes more than the default of 50 iterations."""
        scene = {key: value for key, value in bar(0, 0.45, **STATIC).items() if not key.startswith("Handles/right")}
        scene |= {"Time/Increments": "1", "Handles/Names": "left",
                  "Initial/Pose function": "x*cos(40*x*y+z); y*sin(90*z*x+1)+x; z*cos(50*y)*sin(70*x)"}
        row = self.converge({**scene, "Solver/Maximum iterations": "10"})[-1]
        self.assertGreater(row["iterations"], 10)
        self.assertLess(row["iterations"], 150)


if __name__ == "__main__":
    unittest.main()
