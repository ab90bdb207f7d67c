# SPDX-License-Identifier: GPL-3.0-or-later
"""Cells with a yield stress: closed forms, the balance of energy, what resumed runs remember, and what is refused."""

import unittest
from math import cos, log, pi, sin, sqrt

from exemplar_runner import TENSED, SceneTest, read_csv, read_msh, read_summary, read_vtu, results, write_msh

E, YIELD, KINEMATIC, ISOTROPIC = 1e6, 1e3, 5e4, 3e4
ALPHA = 5e5
BOX = {"Mesh/Generator": "box", "Mesh/Box size": "4, 1, 1", "Mesh/Box cells": "4, 1, 1"}
STEEL = {
    "Material/Young's modulus": str(E),
    "Material/Poisson's ratio": "0.3",
    "Material/Yield stress": str(YIELD),
    "Material/Kinematic hardening": str(KINEMATIC),
    "Material/Isotropic hardening": str(ISOTROPIC),
}
# a bar in tension, free to become thinner
TENSION = {
    "Scene": "static",
    **BOX,
    **STEEL,
    **TENSED,
}
# a bar of which one end is bent up and let go
BENT = {
    "Scene": "static",
    "Mesh/Generator": "box",
    "Mesh/Box size": "4, 1, 1",
    "Mesh/Box cells": "8, 2, 2",
    **STEEL,
    "Time/Increments": "20",
    "Handles/Names": "left",
    "Handles/left/Select": "boundary 1",
    "Loads/Names": "pull",
    "Loads/pull/Select": "boundary 2",
    "Loads/pull/Force": "0; 0; 240*min(t,1-t)",
    "Output/Keep states": "true",
    "Output/Every": "5",
}
DYNAMIC = {**BENT, "Scene": "dynamic", "Time/Increments": None, "Time/Step": "0.02", "Time/End": "1",
           "Material/Density": "10", "Time/Mass damping": "4"}
EXAMPLES = {"Examples/Pose functions": "1.3*x; y; z | x; y; z+0.05*x^2", "Examples/Energy": "blended",
            "Examples/Importance": "0.5"}
FIBRES = {"Material/Fibre stiffness": str(ALPHA), "Material/Fibre direction": "1; 0; 0"}
WOUND = {**FIBRES, "Material/Fibre direction": "0.5; -z; y"}


def plastic_strains(output, step):
    return read_vtu(output / f"frame_{step:04}.vtu")[0]["CellData", "plastic_strain"]


class Rod:
    """Tension with hardening, by the radial return in one dimension."""

    def __init__(self):
        self.plastic = self.accumulated = 0.0

    def stress(self, strain):
        driving = E * (strain - self.plastic) - KINEMATIC * self.plastic
        excess = max(abs(driving) - YIELD - ISOTROPIC * self.accumulated, 0) / (E + KINEMATIC + ISOTROPIC)
        self.plastic += excess if driving > 0 else -excess
        self.accumulated += excess
        return E * (strain - self.plastic)


class Plasticity(SceneTest):
    def check_rod(self, motion, place, alpha=0, **change):
        """With fibres along the rod, which bear alpha times the whole strain beside what yields."""
        rod = Rod()
        output = self.solve({**TENSION, "Time/Increments": "24", "Handles/pull/Motion": f"{motion}; 0; 0", **change})
        for row in read_csv(output):
            strain = place(row["time"]) / 4
            stress = rod.stress(strain)
            self.assertAlmostEqual(row["reaction_pull_x"], stress + alpha * strain, delta=1e-6 * YIELD)
            self.assertAlmostEqual(row["energy_elastic"], 2 * stress**2 / E + 2 * alpha * strain**2,
                                   delta=1e-6 * 2 * YIELD**2 / E)
        return output, rod

    def test_tension_with_hardening(self):
        for change in {}, {"Model/Dilatation": "cells"}, {"Model/Element": "P2"}:
            with self.subTest(**change):
                output, rod = self.check_rod("0.04*t", lambda t: 0.04 * t, **change)
                for strain in plastic_strains(output, 24):
                    self.assertAlmostEqual(strain, rod.accumulated, delta=1e-6 * rod.accumulated)

    def test_a_cyclic_loop(self):
        for change in {}, {"Model/Element": "P2"}:
            with self.subTest(**change):
                self.check_rod("0.04*sin(4*pi*t)", lambda t: 0.04 * sin(4 * pi * t), **change)

    def test_fibres_bear_the_whole_strain(self):
        for change in {}, {"Model/Dilatation": "cells"}, {"Model/Element": "P2"}:
            with self.subTest(**change):
                output, rod = self.check_rod("0.04*sin(4*pi*t)", lambda t: 0.04 * sin(4 * pi * t), ALPHA, **FIBRES, **change)
                self.assertGreater(rod.accumulated, 1e-2)
                for strain in plastic_strains(output, 24):
                    self.assertAlmostEqual(strain, rod.accumulated, delta=1e-6 * rod.accumulated)

    def test_free_fibres_pull_back_what_has_yielded(self):
        """Without hardening a free end goes to where fibres and the body hold each other: sigma + alpha eps = 0."""
        change = {"Material/Kinematic hardening": None, "Material/Isotropic hardening": None, **FIBRES,
                  "Handles/Names": "x0, y0, z0", **{f"Handles/pull/{key}": None for key in ("Select", "Components")},
                  "Loads/Names": "pull", "Loads/pull/Select": "boundary 2", "Loads/pull/Force": "4000*min(t,1-t); 0; 0",
                  "Time/Increments": "20"}
        # at 2,000 Pa the fibres have 1,000 of it, eps = .002, and the body keeps eps_p = .001; let go,
        # E (eps - eps_p) + alpha eps = 0
        last = read_msh(self.solve({**TENSION, **change}) / "final.msh").nodes
        self.assertAlmostEqual(max(x for x, _, _ in last.values()), 4 * (1 + E * 0.001 / (E + ALPHA)), delta=1e-8)

    def test_energy_is_elastic_or_dissipated(self):
        for fibres in {}, WOUND:
            with self.subTest(**fibres):
                self.check_balance(fibres)

    def check_balance(self, fibres):
        errors = []
        for increments in 50, 100, 200:
            output = self.solve({"Scene": "static", **BOX, **STEEL, **fibres, "Mesh/Box cells": "4, 2, 2",
                                 "Time/Increments": str(increments), "Output/Every": "0",
                                 "Handles/Names": "left, right", "Handles/left/Select": "boundary 1",
                                 "Handles/right/Select": "boundary 2",
                                 "Handles/right/Motion": "0; 0.3*sin(2*pi*t); 0.4*t"})
            rows, work = read_csv(output), 0.0
            for before, row in zip(rows, rows[1:]):
                y = 0.3 * (sin(2 * pi * row["time"]) - sin(2 * pi * before["time"]))
                z = 0.4 * (row["time"] - before["time"])
                work += 0.5 * (before["reaction_right_y"] + row["reaction_right_y"]) * y
                work += 0.5 * (before["reaction_right_z"] + row["reaction_right_z"]) * z
            spent = rows[-1]["energy_elastic"] + rows[-1]["energy_dissipated"]
            self.assertGreater(rows[-1]["energy_dissipated"], (0.1 if fibres else 1) * rows[-1]["energy_elastic"])
            errors.append(abs(work - spent) / work)
        self.assertLess(errors[2], 1e-3)
        self.assertLess(errors[2], 0.7 * errors[0])

    def test_a_thick_cylinder_bears_what_theory_says(self):
        a, b, height = 1.0, 2.0, 0.2
        limit = 2 * YIELD * log(b / a) / sqrt(3)

        def ring(x, y, z):
            r, angle = a * (b / a) ** x, (y + 0.5) * pi / 2
            return r * cos(angle), r * sin(angle), z

        for change, cells, tolerance in ({"Model/Element": "P2"}, "8, 12, 1", 0.01), ({}, "14, 20, 1", 0.03):
            self.write_box({**BOX, "Mesh/Box size": f"1, 1, {height}", "Mesh/Box cells": cells}, "ring.msh", ring)
            output = self.solve({
                "Scene": "static", "Mesh/File": "ring.msh", "Time/Increments": "6",
                "Material/Young's modulus": str(10 * E), "Material/Poisson's ratio": "0.3", "Material/Yield stress": str(YIELD),
                "Handles/Names": "wall, x0, y0, sides", "Handles/wall/Select": "boundary 1",
                "Handles/wall/Components": "x, y", "Handles/wall/Motion": "0.0006*t*x/sqrt(x^2+y^2); 0.0006*t*y/sqrt(x^2+y^2); 0",
                "Handles/x0/Select": "box -1e-9 1e-9 -1 1e-9 3 1", "Handles/x0/Components": "x",
                "Handles/y0/Select": "box 1e-9 -1e-9 -1 3 1e-9 1", "Handles/y0/Components": "y",
                "Handles/sides/Select": "box 0 0 -1 3 3 1", "Handles/sides/Components": "z", **change})
            pressure = read_csv(output)[-1]["reaction_wall_x"] / (a * height)
            self.assertAlmostEqual(pressure, limit, delta=tolerance * limit)

    def test_a_region_that_yields_beside_one_that_does_not(self):
        box = self.write_box(BENT, "box.msh")
        cells = [element for element in box.elements if element[1] == 4]
        left = [sum(box.nodes[node][0] for node in cell[-4:]) < 8 for cell in cells]
        regions = iter(2 if is_left else 1 for is_left in left)
        write_msh(self.directory / "two.msh", box._replace(elements=[
            (*element[:3], next(regions), *element[4:]) if element[1] == 4 else element for element in box.elements]))
        names = "Yield stress", "Kinematic hardening", "Isotropic hardening"
        scene = {**BENT, "Mesh/Generator": None, "Mesh/Box size": None, "Mesh/Box cells": None, "Mesh/File": "two.msh",
                 **{f"Material/{name}": None for name in names},
                 **{f"Material/region 2/{name}": BENT[f"Material/{name}"] for name in names}}
        for change in {}, {"Model/Dilatation": "cells"}, {"Model/Element": "P2"}:
            with self.subTest(**change):
                output = self.solve({**scene, **change})
                strains = plastic_strains(output, 20)
                self.assertEqual(max(strain for strain, is_left in zip(strains, left) if not is_left), 0)
                self.assertGreater(max(strains), 5e-4)
                # the rest of the bar would not have yielded, either
                everywhere = self.solve({**BENT, **change}, output="everywhere")
                self.assertAlmostEqual(read_csv(output)[-1]["energy_dissipated"],
                                       read_csv(everywhere)[-1]["energy_dissipated"],
                                       delta=0.2 * read_csv(everywhere)[-1]["energy_dissipated"])

    def check_resumed(self, scene, state):
        whole = results(self.solve(scene, output="whole"))
        self.solve(scene)
        resumed = results(self.solve(scene, "--resume-from", state))
        self.assertEqual([name for name in whole if resumed[name] != whole[name]], [])

    def test_resumed_runs_know_what_cells_remember(self):
        for change in {}, EXAMPLES, {"Model/Element": "P2"}, {**WOUND, **EXAMPLES}:
            with self.subTest(**change):
                self.check_resumed({**BENT, **change}, "15")

    def test_resumed_dynamics(self):
        for change in ({"Material/Flow viscosity": "20"}, {"Time/Stiffness damping": "0.01", "Time/Scheme": "bdf2"},
                       {"Solver/Method": "newton"}, EXAMPLES, {**WOUND, "Time/Stiffness damping": "0.01"}):
            with self.subTest(**change):
                self.check_resumed({**DYNAMIC, **change}, "25")

    def test_threads_leave_the_bytes_of_fibres_that_yield(self):
        for change in {"Mesh/Box cells": "12, 4, 4"}, {"Model/Element": "P2"}:
            with self.subTest(**change):
                scene = {**DYNAMIC, **WOUND, **EXAMPLES, "Time/End": "0.5", **change}
                one = self.solve(scene, "--threads", "1", output="one")
                self.assertGreater(read_csv(one)[-1]["energy_dissipated"], 0)
                self.assertEqual(results(self.solve(scene, "--threads", "3")), results(one))

    def test_regions_with_fibres_and_without(self):
        """Four rods in a row that yield or do not, with fibres or without, and cannot become thinner: one force in all."""
        box = self.write_box(BOX, "box.msh")
        cells = [element for element in box.elements if element[1] == 4]
        regions = iter([1 + int(sum(box.nodes[node][0] for node in cell[-4:]) / 4) for cell in cells])
        write_msh(self.directory / "four.msh", box._replace(elements=[
            (*element[:3], next(regions), *element[4:]) if element[1] == 4 else element for element in box.elements]))
        force, hardening, length = 2 * YIELD, 2 / 3 * KINEMATIC, 0
        for region_yields, alpha in ((True, ALPHA), (False, ALPHA), (True, 0), (False, 0)):
            stiffness, flowing = E + alpha, E + alpha - 2 / 3 * E * E / (E + hardening)
            at_yield = min(stiffness * YIELD / E, force) if region_yields else force
            length += at_yield / stiffness + (force - at_yield) / flowing
        scene = {**TENSION, **FIBRES, **{key: None for key in BOX}, "Mesh/File": "four.msh", "Time/Increments": "4",
                 "Material/Poisson's ratio": "0", "Material/Isotropic hardening": None,
                 "Handles/y0/Select": "box 0 -1 -1 4 1 1", "Handles/z0/Select": "box 0 -1 -1 4 1 1",
                 "Handles/pull/Motion": f"{length}*t; 0; 0", "Material/region 2/Yield stress": "0",
                 "Material/region 3/Fibre stiffness": "0",
                 "Material/region 4/Yield stress": "0", "Material/region 4/Fibre stiffness": "0"}
        for change in {}, {"Model/Dilatation": "cells"}, {"Model/Element": "P2"}:
            with self.subTest(**change):
                last = read_csv(self.solve({**scene, **change}))[-1]
                self.assertAlmostEqual(last["reaction_pull_x"], force, delta=1e-6 * YIELD)

    def test_what_is_kept_is_bounded(self):
        output = self.solve({**BENT, "Material/Greatest plastic strain": "0.01", "Loads/pull/Force": "0; 0; 300*min(t,1-t)"})
        self.assertLess(max(plastic_strains(output, 20)), 0.05)
        self.assertGreater(read_csv(output)[-1]["energy_dissipated"], 0)

    def test_only_a_body_that_may_yield_has_what_this_takes(self):
        scene = {**BENT, "Material/Kinematic hardening": None, "Material/Isotropic hardening": None}
        elastic = self.solve({**scene, "Material/Yield stress": "0"})
        self.assertIn("plastic cells", read_summary(elastic)["left_out"])
        self.assertNotIn("energy_dissipated", read_csv(elastic)[0])
        never = self.solve({**scene, "Material/Yield stress": "1e9"}, output="never")
        self.assertIn("plastic cells", read_summary(never)["used"])
        top = [max(z for x, y, z in read_msh(output / "final.msh").nodes.values()) for output in (elastic, never)]
        self.assertAlmostEqual(top[0], top[1], delta=1e-7)

    def test_what_is_refused(self):
        for change, words in (
                ({"Model/Strain": "green"}, ["Material/Yield stress", "Model/Strain = corotational"]),
                ({"Model/Gradient": "frozen"}, ["Model/Gradient = consistent"]),
                ({**EXAMPLES, "Examples/Energy": "scaled"}, ["Examples/Energy = blended"]),
                ({"Material/Flow viscosity": "10"}, ["Flow viscosity", "Scene = dynamic"]),
                ({"Material/Greatest plastic strain": "2"}, ["Greatest plastic strain", "0.95"]),
                ({**EXAMPLES, "Material/Importance factor": "0.5"}, ["Material/Yield stress", "Material/Importance factor = 1"]),
                ({"Material/Orthotropy": "3e5, 1e5, 1e5, 0.3, 0.3, 0.3, 4e4, 4e4, 4e4", "Material/Fibre direction": "1; 0; 0",
                  "Material/Cross direction": "0; 1; 0"},
                 ["Material/Yield stress", "without orthotropy", "different regions"]),
                ({"Material/Yield stress": "-1"}, ["Yield stress"])):
            with self.subTest(**change):
                run = self.attempt({**BENT, **change})
                self.assertEqual(run.status, 1)
                for word in words:
                    self.assertIn(word, run.stderr)


if __name__ == "__main__":
    unittest.main()
