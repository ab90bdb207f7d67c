# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes and studies of prm/tutorial, made small, show what the pages of doc/tutorial say."""

import csv
import itertools
import re
import unittest
from math import cos, dist, hypot, log2, pi, sin

from exemplar_runner import REPOSITORY, SceneTest, greatest_distance, read_csv, read_msh

FOLDER = REPOSITORY / "prm/tutorial"
SHOWN = {}  # the test of each file


def shows(*files):
    """Names the files of prm/tutorial that a test is about."""
    def note(test):
        SHOWN.update({file: test.__name__ for file in files})
        return test
    return note


def nodes_of(file):
    return read_msh(file).nodes


def tetrahedra(mesh):
    return [element[-4:] for element in mesh.elements if element[1] == 4]


def edges(mesh):
    return sorted({tuple(sorted(edge)) for cell in tetrahedra(mesh) for edge in itertools.combinations(cell, 2)})


def volume(mesh, nodes=None):
    total = 0
    for cell in tetrahedra(mesh):
        o, a, b, c = ((nodes or mesh.nodes)[number] for number in cell)
        a, b, c = ([p - q for p, q in zip(x, o)] for x in (a, b, c))
        total += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                  a[2] * (b[0] * c[1] - b[1] * c[0])) / 6
    return total


def bent(x, y, z):
    """The half circle of step 2."""
    return (4 / pi - z) * sin(pi * x / 4), y, 4 / pi - (4 / pi - z) * cos(pi * x / 4)


def twisted(x, y, z):
    """By 360 degrees over the length 4."""
    return x, y * cos(pi * x / 2) - z * sin(pi * x / 2), y * sin(pi * x / 2) + z * cos(pi * x / 2)


def bow(t):
    """The weight of the bow in step 4: up until 1, down from 2 to 3."""
    rise = (1 - cos(pi * min(t, 1))) / 2
    return rise - (1 - cos(pi * min(max(t - 2, 0), 1))) / 2


class Tutorial(SceneTest):
    def scene(self, name, output, *settings):
        """Run a scene; its output directory."""
        words = [word for setting in ("Output/Every=0", *settings) for word in ("--set", setting)]
        run = self.call(FOLDER / f"{name}.prm", "--quiet", "--output", output, *words)
        self.assertEqual(run.status, 0, run.stderr)
        return self.directory / output

    def study(self, name, base="", shorter=None):
        """Run a study with more in its Base, and with parts of the file in other words; its rows."""
        text = (FOLDER / f"{name}.prm").read_text()
        for words, others in {"\\\n": "", **(shorter or {})}.items():
            self.assertTrue(words in text or words == "\\\n", f"{name}.prm has no '{words}'")
            text = text.replace(words, others)
        for words, others in ((r"^set Scene *= *", f"\\g<0>{FOLDER}/"), (r"^(set Repeats *=).*", r"\g<1> 1")):
            text, places = re.subn("(?m)" + words, others, text)
            self.assertEqual(places, 1, words)
        if base:
            text, places = re.subn(r"(?m)^set Base *= *", f"\\g<0>{base}; ", text)
            text += "" if places else f"set Base = {base}\n"
        run = self.call("study", self.write(f"{name}.prm", text), "--quiet", "--output", name)
        self.assertEqual(run.status, 0, run.stderr)
        with open(self.directory / name / "study.csv", newline="") as file:
            return list(csv.DictReader(file))

    @staticmethod
    def of(rows, **wanted):
        """The rows in which some keys, named by their last word, have some values."""
        return [row for row in rows
                if all(row[next(key for key in row if key.split("/")[-1].split()[-1] == word)] == value
                       for word, value in wanted.items())]

    def numbers(self, rows, column):
        for row in rows:
            self.assertNotEqual(row[column], "", row)
        return [float(row[column]) for row in rows]

    def assert_grows(self, values):
        self.assertEqual(values, sorted(values))
        self.assertGreater(values[-1], values[0])

    def test_every_file_has_a_test(self):
        files = sorted(file.stem for file in FOLDER.glob("*.prm"))
        self.assertGreater(len(files), 10)
        self.assertEqual([file for file in files if file not in SHOWN], [])

    @shows("step1_bar")
    def test_linear_strain_swells(self):
        small = ("Mesh/Box cells=12, 2, 2", "Time/Increments=4")
        ends = {strain: self.scene("step1_bar", strain, f"Model/Strain={strain}", *small)
                for strain in ("linear", "corotational", "green")}
        for output in ends.values():
            # the wall carries the weight
            self.assertAlmostEqual(read_csv(output)[-1]["reaction_wall_z"], 40000, delta=1)
        volumes = {strain: volume(read_msh(output / "final.msh")) for strain, output in ends.items()}
        self.assertGreater(volumes["linear"], 1.3 * 4)
        self.assertAlmostEqual(volumes["corotational"], 4, delta=0.04)
        self.assertAlmostEqual(volumes["green"], 4, delta=0.12)
        half = self.scene("step1_bar", "half", "Model/Strain=linear", "Loads/weight/Force=0; 0; -20000*t", *small)
        whole, half = (nodes_of(output / "final.msh") for output in (ends["linear"], half))
        rest = nodes_of(self.scene("step1_bar", "rest", "Loads/weight/Force=0; 0; 0", *small) / "final.msh")
        for number, place in rest.items():
            for x, y, z in zip(place, half[number], whole[number]):
                self.assertAlmostEqual(z - x, 2 * (y - x), delta=1e-7)

    @shows("step1_load")
    def test_load_and_strain(self):
        rows = self.study("step1_load", "Mesh/Box cells=12, 2, 2; Time/Increments=2",
                          {'"0; 0; -20000*t" "0; 0; -40000*t" ': ""})
        self.assertEqual({row["status"] for row in rows}, {"converged"})
        linear, corotational, green = (self.of(rows, Strain=strain) for strain in ("linear", "corotational", "green"))
        forces = [400, 80000, 160000]
        for force, row in zip(forces, linear):
            self.assertAlmostEqual(float(row["probe_z"]) / force, float(linear[0]["probe_z"]) / 400, delta=1e-12)
        for other in (corotational, green):
            self.assertAlmostEqual(float(other[0]["probe_z"]) / float(linear[0]["probe_z"]), 1, delta=0.005)
        length = {name: [hypot(4 + x, z) for x, z in zip(self.numbers(group, "probe_x"), self.numbers(group, "probe_z"))]
                  for name, group in (("linear", linear), ("corotational", corotational))}
        self.assertGreater(length["linear"][-1], 8)
        # hanging straight down, with the greatest load, it would be longer by q L^2 / (2 E A) = 0.32
        self.assertLess(max(length["corotational"]), 4.32)
        self.assert_grows([-x for x in self.numbers(corotational, "probe_x")])  # back to the wall
        self.assertLess(float(corotational[-1]["probe_x"]), -1)
        self.assertLess(abs(float(linear[-1]["probe_x"])), 0.1)
        self.assertEqual({row["inverted_cells"] for row in corotational}, {"0"})
        self.assertGreater(int(green[-1]["inverted_cells"]), 0)

    @shows("step1_mesh")
    def test_bending_locks(self):
        rows = self.study("step1_mesh", shorter={"; 64, 16, 16": ""})
        tips = {}
        for nu in ("0", "0.3", "0.49"):
            k = 10 * (1 + float(nu)) / (12 + 11 * float(nu))
            exact = 100 * 4**4 / (8 * 1e6 / 12) + 100 * 4**2 / (2 * k * 1e6 / (2 * (1 + float(nu))))
            tips[nu] = [-tip / exact for tip in self.numbers(self.of(rows, ratio=nu), "probe_z")]
            self.assert_grows(tips[nu])
            self.assertLess(tips[nu][-1], 1)
        for nu in ("0", "0.3"):
            errors = [1 - tip for tip in tips[nu]]
            self.assertTrue(all(b < 0.6 * a for a, b in zip(errors, errors[1:])), errors)
            self.assertLess(errors[-1], 0.1)
        self.assertLess(tips["0.49"][-1], 0.65)
        self.assertTrue(all(a > b > c for a, b, c in zip(tips["0"], tips["0.3"], tips["0.49"])))

    @shows("step2_twist_to_bend")
    def test_strains_are_interpolated(self):
        small = ("Mesh/Box cells=12, 3, 3", "Time/Increments=6")
        end = read_msh(self.scene("step2_twist_to_bend", "end", *small) / "final.msh")
        # x fastest
        rest = {1 + i + 13 * (j + 4 * k): (i / 3, j / 3 - 0.5, k / 3 - 0.5)
                for i in range(13) for j in range(4) for k in range(4)}
        pose = {number: bent(*place) for number, place in rest.items()}
        other = {number: twisted(*place) for number, place in rest.items()}
        self.assertEqual(end.nodes.keys(), rest.keys())
        for a, b in edges(end):
            self.assertAlmostEqual(dist(end.nodes[a], end.nodes[b]), dist(pose[a], pose[b]), delta=1e-5)
        half = read_msh(self.scene("step2_twist_to_bend", "half", "Examples/Prescribed weights=1-t/2; t/2", *small) / "final.msh")
        self.assertAlmostEqual(volume(half), volume(half, rest), delta=0.1 * volume(half, rest))
        mean = {number: [(x + y) / 2 for x, y in zip(pose[number], other[number])] for number in rest}
        self.assertLess(volume(half, mean), 0.8 * volume(half, rest))

    @shows("step2_increments")
    def test_methods_and_increments(self):
        rows = self.study("step2_increments", "Mesh/Box cells=12, 3, 3", {"1 2 5 10 20 40": "1 20"})
        newton, fixed = self.of(rows, Method="newton"), self.of(rows, Method="fixed point", Gradient="frozen")
        self.assertEqual({row["status"] for row in newton + fixed}, {"converged"})
        right = float(newton[0]["energy_elastic"])
        for row in newton + fixed:
            # at the example: all of its elastic energy, and no distance from it
            self.assertAlmostEqual(float(row["energy_elastic"]) / right, 1, delta=1e-5)
            self.assertAlmostEqual(float(row["energy_example"]) / right, -1, delta=1e-5)
        for row, other in zip(newton, fixed):
            self.assertLess(int(row["iterations"]), int(other["iterations"]))
        self.assertEqual({row["status"] for row in self.of(rows, Method="fixed point", Gradient="consistent")},
                         {"iteration limit"})
        one_pass = self.of(rows, Method="one pass")
        excess = [(float(row["energy_elastic"]) + float(row["energy_example"])) / right for row in one_pass]
        self.assertGreater(excess[0], 1)
        self.assertLess(excess[-1], 1e-2)

    @shows("step2_two_turns")
    def test_the_fixed_point_fails_from_two_turns(self):
        rows = self.study("step2_two_turns", "Mesh/Box cells=16, 3, 3", {"1 2 5 10 20 40 80": "1 5"})
        self.assertEqual({row["status"] for row in self.of(rows, Method="newton")}, {"converged"})
        fixed = {row["Time/Increments"]: row["status"] for row in self.of(rows, Method="fixed point")}
        self.assertEqual((fixed["1"], fixed["5"]), ("converged", "iteration limit"))

    @shows("step3_cat")
    def test_the_cat_arches_its_back(self):
        arched = self.scene("step3_cat", "arched")
        plain = self.scene("step3_cat", "plain", "Examples/Importance=0", "Time/Increments=2")
        rest = nodes_of(REPOSITORY / "meshes/cat.msh")
        back = min(rest, key=lambda number: dist(rest[number], (0, 0, 0.62)))
        paws = [number for number, (x, y, z) in rest.items() if 0.26 <= x <= 0.5 and -0.01 <= z <= 0.08]
        self.assertGreater(len(paws), 10)
        rises = []
        for output in (arched, plain):
            end = nodes_of(output / "final.msh")
            rises.append(end[back][2] - rest[back][2])
            for paw in paws:
                moved = [x + u for x, u in zip(rest[paw], (-0.22, 0, 0.05))]
                self.assertLess(dist(end[paw], moved), 1e-9)
        self.assertGreater(rises[0], 2 * rises[1])
        weights = [[row[f"weight_{i}"] for i in range(3)] for row in read_csv(arched)]
        for row in weights:
            self.assertAlmostEqual(sum(row), 1, places=9)
            self.assertTrue(all(-1e-12 <= weight <= 1 + 1e-12 for weight in row), row)
        self.assert_grows([row[1] for row in weights])  # from rest to the arch
        self.assertEqual(weights[0][0], 1)
        self.assertGreater(weights[-1][1], 0.9)

    @shows("step3_importance")
    def test_importance_and_weights(self):
        rows = self.study("step3_importance", "Time/Increments=1", {"0 0.3 0.6 0.8 0.9 1": "0 0.3 1"})
        self.assertEqual({row["status"] for row in rows}, {"converged"})
        simplex = self.of(rows, Weights="simplex", Energy="scaled")
        blended = self.of(rows, Weights="simplex", Energy="blended")
        free, ridge = (self.of(rows, Weights="free", penalty=penalty) for penalty in ("0", "auto"))
        for group in (simplex, blended):
            for row in group[1:]:
                self.assertTrue(all(0 <= float(row[f"weight_{i}"]) <= 1 for i in range(3)))
            self.assert_grows(self.numbers(group, "probe_z"))
        self.assertEqual(float(simplex[1]["weight_1"]), 1)
        self.assert_grows(self.numbers(blended[1:], "weight_1"))
        for group in (free, ridge):
            self.assertGreater(float(group[1]["weight_1"]), 1)
            self.assertLess(float(group[1]["weight_0"]), 0)
        # without a ridge only the product of importance and weight counts
        for row in free[1:]:
            for column in ("weight_1", "weight_2"):
                self.assertAlmostEqual(float(row["Examples/Importance"]) * float(row[column]), float(free[-1][column]),
                                       delta=1e-5)
            self.assertAlmostEqual(float(row["probe_z"]), float(free[-1]["probe_z"]), delta=1e-5)
        for row in (simplex[-1], blended[-1]):
            self.assertAlmostEqual(float(row["weight_1"]), float(free[-1]["weight_1"]), delta=1e-5)
        self.assertEqual(len({row["probe_z"] for row in (simplex[0], free[0], ridge[0], blended[0])}), 1)

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


if __name__ == "__main__":
    unittest.main()
