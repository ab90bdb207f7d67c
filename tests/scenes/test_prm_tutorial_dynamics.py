# SPDX-License-Identifier: GPL-3.0-or-later
"""Steps 4 to 6 and 10 of doc/tutorial show what their pages say."""

import json
import unittest
from math import cos, log2, pi

from exemplar_runner import REPOSITORY, greatest_distance, nodes_of, read_csv
from tutorial import Tutorial, shows


def bow(t):
    """The weight of the bow in step 4: up until 1, down from 2 to 3."""
    rise = (1 - cos(pi * min(t, 1))) / 2
    return rise - (1 - cos(pi * min(max(t - 2, 0), 1))) / 2


class TutorialDynamics(Tutorial):
    @shows("step4_bow")
    def test_the_pose_is_what_its_scene_makes(self):
        output = self.scene("step4_bow", "bow")
        made = nodes_of(output / "final.msh")
        self.assertLess(greatest_distance(made, nodes_of(REPOSITORY / "meshes/poses/horse_bow.msh")), 1e-4)
        self.assertGreater(greatest_distance(made, nodes_of(REPOSITORY / "meshes/horse.msh")), 0.5)
        self.assertGreater(min(row["min_det_F"] for row in read_csv(output)), 0.5)

    @shows("step4_horse")
    def test_the_horse_bows_and_stands_up(self):
        rest, pose = (nodes_of(REPOSITORY / f"meshes/{name}.msh") for name in ("horse", "poses/horse_bow"))
        size = greatest_distance(rest, pose)
        whole = self.scene("step4_horse", "whole", "Time/Step=0.04")
        rows = read_csv(whole)
        for row in rows:
            self.assertAlmostEqual(row["weight_1"], bow(row["time"]), places=9)
        self.assertEqual({row["inverted_cells"] for row in rows}, {0})
        self.assertLess(greatest_distance(nodes_of(whole / "final.msh"), rest), 0.05 * size)
        down = self.scene("step4_horse", "down", "Time/Step=0.04", "Time/End=2")
        self.assertLess(greatest_distance(nodes_of(down / "final.msh"), pose), 0.15 * size)
        still = self.scene("step4_horse", "still", "Time/Step=0.1", "Time/End=1.5", "Material/Density=1e-6",
                           "Time/Stiffness damping=0")
        self.assertLess(greatest_distance(nodes_of(still / "final.msh"), pose), 1e-3 * size)

    @shows("step4_damping")
    def test_damping(self):
        rows = self.study("step4_damping", "Time/Step=0.05; Solver/Step tolerance=1e-2",
                          {"0.02 + 0, 0.05 + 0, ": "", "0.2 + 0, ": "", "0 + 1, ": "", ", 0 + 10": ""})
        by = {tuple(row[f"Time/{key}"] for key in ("End", "Stiffness damping", "Mass damping")):
              float(row["error_position_l2"]) for row in rows}
        energy = {time: self.numbers([row for row in rows if row["Time/End"] == time and row["Time/Mass damping"] == "0"],
                                     "energy_kinetic") for time in ("1", "2")}
        for time in ("1", "2"):
            self.assertLess(by[time, "0.1", "0"], by[time, "0", "0"] / 2)
            self.assertLess(by[time, "0", "3"], by[time, "0", "0"] / 2)
            self.assertGreater(by[time, "0", "0"], 0.2)
        self.assert_grows(energy["1"][::-1])
        self.assertGreater(by["1", "0.5", "0"], 0.4)  # late
        self.assertLess(by["2", "0.5", "0"], by["1", "0.5", "0"] / 4)
        muzzle = {row["Time/Stiffness damping"]: float(row["probe_z"])
                  for row in self.of(rows, End="1") if row["Time/Mass damping"] == "0"}
        self.assertGreater(muzzle["0.5"], muzzle["0.1"])
        self.assertGreater(muzzle["0.1"], muzzle["0"])

    @shows("step4_importance")
    def test_importance_and_weight(self):
        rows = self.study("step4_importance", "Time/Step=0.05; Solver/Step tolerance=1e-2", {"0 0.25 0.5 0.75 0.9 1": "0.5 1"})
        free = self.of(rows, Gravity="0, 0, 0")
        soft, stiff = (self.of(rows, Gravity="0, 0, -9.81", modulus=modulus) for modulus in ("1e6", "1e8"))
        errors = self.numbers(free, "error_position_l2")
        self.assert_grows(errors[::-1])
        self.assertLess(errors[-1], 0.03)
        self.assertGreater(errors[0], 0.3)
        for error, other in zip(errors, self.numbers(stiff, "error_position_l2")):
            self.assertAlmostEqual(other, error, delta=0.03)
        for row, other in zip(soft, free):
            self.assertLess(float(row["probe_z"]), float(other["probe_z"]) - 0.1)
        self.assertLess(float(soft[-1]["min_det_F"]), 0)

    @shows("step5_bar")
    def test_the_end_is_lifted(self):
        small = ("Time/Step=0.03", "Mesh/Box cells=4, 2, 2")
        ends = [nodes_of(self.scene("step5_bar", f"{time}", f"Time/End={time}", *small) / "final.msh") for time in ("0.6", "1")]
        lifted = [z - 0.5 for z in (max(z for x, y, z in end.values()) for end in ends)]
        for lift, time in zip(lifted, (0.6, 1)):
            self.assertAlmostEqual(lift, time**3 * (10 - 15 * time + 6 * time**2), delta=1e-6)

    def orders(self, rows, **wanted):
        errors = self.numbers(self.of(rows, **wanted), "error_position_l2")
        return errors, [log2(a / b) for a, b in zip(errors, errors[1:])]

    SHORT_STEPS = {"Time/Step=0.0005": "Time/Step=0.003", "0.06 0.03 0.015 0.0075 0.00375": "0.03 0.015"}

    @shows("step5_schemes", "step5_jerk")
    def test_orders_of_schemes(self):
        soft = self.study("step5_schemes", "Mesh/Box cells=4, 2, 2", self.SHORT_STEPS)
        jerk = self.study("step5_jerk", "Mesh/Box cells=4, 2, 2", self.SHORT_STEPS)
        for scheme, order in (("implicit euler", 1), ("bdf2", 2)):
            errors, observed = self.orders(soft, Scheme=scheme)
            self.assertAlmostEqual(observed[-1], order, delta=0.25 * order)
            worse, spoiled = self.orders(jerk, Scheme=scheme)
            self.assertGreater(worse[-1], errors[-1])
            self.assertLess(spoiled[-1], 0.6 * order)

    @shows("step5_methods")
    def test_methods_have_the_error_of_the_time_step(self):
        rows = self.study("step5_methods", "Mesh/Box cells=4, 2, 2", self.SHORT_STEPS)
        newton, observed = self.orders(rows, Method="newton")
        self.assertAlmostEqual(observed[-1], 1, delta=0.25)
        for method in ("fixed point", "quasi newton"):
            for error, other in zip(self.orders(rows, Method=method)[0], newton):
                self.assertAlmostEqual(error / other, 1, delta=0.03)
        for error, other in zip(self.orders(rows, Method="one pass")[0], newton):
            self.assertGreater(error, other)

    @shows("step10_slide", "step10_friction")
    def test_friction_makes_the_bar_slide_less(self):
        rows = self.study("step10_friction")
        by = {float(row["Obstacles/slope/Friction"]): row for row in rows}
        for friction, row in by.items():
            slides = max(0, 0.5 - friction) / 1.25 ** 0.5 * 9.81
            self.assertAlmostEqual(float(row["momentum_x"]) / 8, slides, delta=0.02 * 9.81, msg=friction)
            self.assertAlmostEqual(float(row["probe_x"]), slides / 2 * 1.01, delta=0.03, msg=friction)
        self.assertEqual(float(by[0]["heat_friction"] or 0), 0)

    @shows("step10_distance")
    def test_a_smaller_distance_errs_less(self):
        rows = self.study("step10_distance", "Time/End=0.3")
        errors = self.numbers(rows, "error_position_l2")
        self.assert_grows(errors[::-1])
        self.assertGreater(min(self.numbers(rows, "least_gap")), 0)

    @shows("step6_creature")
    def test_the_creature_crouches_and_reaches(self):
        output = self.scene("step6_creature", "creature", "Mesh/Cells=1500", "Time/Step=0.1", "Output/Every=1")
        rows = read_csv(output)
        self.assertEqual({row["inverted_cells"] for row in rows}, {0})
        self.assertGreater(max(row["weight_1"] for row in rows if row["time"] < 1), 0.6)
        self.assertGreater(max(row["weight_2"] for row in rows if row["time"] > 1), 0.6)
        poses = json.loads((output / "summary.json").read_text())["poses_carried"]
        self.assertEqual([pose["inverted_cells"] for pose in poses], [0, 0])
        surface = (REPOSITORY / "meshes/surfaces/creature/rest.obj").read_text()
        n_vertices = surface.count("v ")
        self.assertEqual((output / "animation.pc2").stat().st_size, 32 + 12 * n_vertices * len(rows))


if __name__ == "__main__":
    unittest.main()
