# SPDX-License-Identifier: GPL-3.0-or-later
"""Steps 1 to 3 of doc/tutorial show what their pages say."""

import unittest
from math import cos, dist, hypot, pi, sin

import test_prm_tutorial_dynamics  # noqa: F401, for the files that it shows
from exemplar_runner import REPOSITORY, bent, nodes_of, read_csv, read_msh, read_vtu, twisted
from tutorial import FOLDER, SHOWN, Tutorial, edges, shows, volume


class TutorialStatics(Tutorial):
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

    @shows("step11_arm")
    def test_muscles_flex_and_extend_the_arm(self):
        output = self.scene("step11_arm", "arm", "Output/Every=5", "Output/Formats=vtu")
        rows = read_csv(output)
        flexed, extended = ([row[f"weight_{i}"] for row in rows] for i in (1, 2))
        for weights in (flexed[:6], extended[10:16]):
            self.assert_grows(weights)
            self.assertEqual(weights[-1], 1)
        for half in (rows[:11], rows[10:]):  # it comes back the same way
            for there, back in zip(half, half[::-1]):
                self.assertAlmostEqual(there["weight_1"], back["weight_1"], delta=5e-3)
                self.assertAlmostEqual(there["weight_2"], back["weight_2"], delta=5e-3)
        places = [list(zip(*[iter(read_vtu(output / f"frame_{step:04}.vtu")[0]["Points", "Points"])] * 3)) for step in (0, 5, 15)]
        hand = max(range(len(places[0])), key=lambda node: places[0][node])
        self.assertGreater(places[1][hand][2], 0.2)
        self.assertLess(places[2][hand][2], -0.1)
        still = self.scene("step11_arm", "still", "Material/region biceps/Fibre tension=0", "Material/region triceps/Fibre tension=0",
                           "Time/Increments=2")
        self.assertLess(max(max(row["weight_1"], row["weight_2"]) for row in read_csv(still)), 0.05)

    @shows("step12_strip")
    def test_a_strip_rolls_up_against_its_weight(self):
        ends = {}
        for at in (.05, .5, .55, 1.):
            output = self.scene("step12_strip", f"strip_{at}", f"Examples/Prescribed weights=1-{at}*t; {at}*t", "Time/Increments=5")
            end = max(place for number, place in nodes_of(output / "final.msh").items() if number % 26 == 0)
            ends[at] = end[2]
        self.assertAlmostEqual(ends[.05], -0.1541, delta=1e-3)
        self.assertLess(ends[.5], 0)
        self.assertGreater(ends[.55], 0)
        self.assertAlmostEqual(ends[1.], 0.1877, delta=1e-3)

    @shows("step12_importance")
    def test_importance_rolls_up_a_strip(self):
        rows = self.study("step12_importance", "Time/Increments=10")
        self.assertEqual({row["status"] for row in rows}, {"converged"})
        light, heavy = self.of(rows, Density="1e-6"), self.of(rows, Density="1000")
        for row in light[1:]:  # a circle's arc that turns by the importance times pi
            turn = float(row["Examples/Importance"]) * pi
            self.assertAlmostEqual(float(row["probe_z"]), 0.3 / turn * (1 - cos(turn)), delta=0.0015)
            self.assertAlmostEqual(0.3 + float(row["probe_x"]), 0.3 / turn * sin(turn), delta=0.0025)
        self.assert_grows(self.numbers(heavy, "probe_z"))
        self.assertLess(float(heavy[1]["probe_z"]), 0)
        self.assertGreater(float(heavy[2]["probe_z"]), 0)

    @shows("step12_hinges")
    def test_hinges_are_as_the_mesh_is(self):
        rows = self.study("step12_hinges", shorter={"../../meshes": str(REPOSITORY / "meshes")})
        closed_form = 1.5 * 1000 * 0.0981 * 0.3 ** 4 / (2e9 * 5e-4 ** 2)
        for value in self.numbers(self.of(rows, Shell="plate"), "probe_z"):
            self.assertAlmostEqual(-value / closed_form, 1, delta=0.003)
        for value in self.numbers(self.of(rows, Shell="hinges"), "probe_z"):
            self.assertGreater(-value / closed_form, 1.2)

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
        blended, mixed = (self.of(rows, Weights="simplex", Energy=energy) for energy in ("blended", "mixed"))
        free, ridge = (self.of(rows, Weights="free", penalty=penalty) for penalty in ("0", "auto"))
        for group in (simplex, blended, mixed):
            for row in group[1:]:
                self.assertTrue(all(0 <= float(row[f"weight_{i}"]) <= 1 for i in range(3)))
            self.assert_grows(self.numbers(group, "probe_z"))
        self.assertEqual(float(simplex[1]["weight_1"]), 1)
        for group in (blended, mixed):
            self.assert_grows(self.numbers(group[1:], "weight_1"))
        for slow, between, fast in zip(blended[1:-1], mixed[1:-1], simplex[1:-1]):
            self.assert_grows(self.numbers((slow, between, fast), "probe_z"))
        for group in (free, ridge):
            self.assertGreater(float(group[1]["weight_1"]), 1)
            self.assertLess(float(group[1]["weight_0"]), 0)
        # without a ridge only the product of importance and weight counts
        for row in free[1:]:
            for column in ("weight_1", "weight_2"):
                self.assertAlmostEqual(float(row["Examples/Importance"]) * float(row[column]), float(free[-1][column]),
                                       delta=1e-5)
            self.assertAlmostEqual(float(row["probe_z"]), float(free[-1]["probe_z"]), delta=1e-5)
        for row in (simplex[-1], blended[-1], mixed[-1]):
            self.assertAlmostEqual(float(row["weight_1"]), float(free[-1]["weight_1"]), delta=1e-5)
        self.assertEqual(len({row["probe_z"] for row in (simplex[0], free[0], ridge[0], blended[0], mixed[0])}), 1)


if __name__ == "__main__":
    unittest.main()
